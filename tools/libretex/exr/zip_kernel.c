/* See zip_kernel.h. */
#include "exr/zip_kernel.h"

#include <stdint.h>
#include <string.h>

#include <retex/host/cpu.h>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

void retex_exr_zip_regroup(unsigned char *restrict out, const unsigned char *restrict raw, size_t bytes)
{
    unsigned char *restrict odd = out + (bytes + 1) / 2;

    for (size_t i = 0; i < bytes / 2; i++) {
        out[i] = raw[2 * i];
        odd[i] = raw[2 * i + 1];
    }
    if (bytes & 1)
        out[bytes / 2] = raw[bytes - 1];
}

void retex_exr_zip_difference(unsigned char *restrict out, const unsigned char *restrict in, size_t bytes)
{
    out[0] = in[0];
    for (size_t i = 1; i < bytes; i++)
        out[i] = (unsigned char)(in[i] - in[i - 1] + 128);
}

/* The rest of the bytes, from i on. */
static void accumulate_from(unsigned char *data, size_t i, size_t bytes)
{
    unsigned previous = i ? data[i - 1] : 128;
    for (; i < bytes; i++) {
        previous = (previous + data[i] - 128) & 255;
        data[i] = (unsigned char)previous;
    }
}

#ifdef __SSE2__
/* Each byte becomes the sum of those up to it. */
static inline __m128i sum_within(__m128i v)
{
    v = _mm_add_epi8(v, _mm_slli_si128(v, 1));
    v = _mm_add_epi8(v, _mm_slli_si128(v, 2));
    v = _mm_add_epi8(v, _mm_slli_si128(v, 4));
    return _mm_add_epi8(v, _mm_slli_si128(v, 8));
}

static void accumulate_baseline(unsigned char *data, size_t bytes)
{
    const __m128i bias = _mm_set1_epi8((char)-128);
    __m128i before = bias;
    size_t i = 0;
    for (; i + 16 <= bytes; i += 16) {
        const __m128i sum = sum_within(_mm_add_epi8(_mm_loadu_si128((const __m128i *)(data + i)), bias));
        __m128i last = _mm_unpackhi_epi8(sum, sum); /* the last byte everywhere */
        last = _mm_shuffle_epi32(_mm_shufflehi_epi16(last, 0xff), 0xff);
        _mm_storeu_si128((__m128i *)(data + i), _mm_add_epi8(sum, before));
        before = _mm_add_epi8(before, last); /* all that the next bytes wait for */
    }
    accumulate_from(data, i, bytes);
}
#else
static void accumulate_baseline(unsigned char *data, size_t bytes)
{
    accumulate_from(data, 0, bytes);
}
#endif

#if RETEX_CPU_X86
#include <immintrin.h>

RETEX_CPU_TARGET_AVX2 static void accumulate_avx2(unsigned char *data, size_t bytes)
{
    const __m256i bias = _mm256_set1_epi8((char)-128), fifteen = _mm256_set1_epi8(15);
    __m256i before = bias;
    size_t i = 0;
    for (; i + 32 <= bytes; i += 32) {
        __m256i sum = _mm256_add_epi8(_mm256_loadu_si256((const __m256i *)(data + i)), bias);
        sum = _mm256_add_epi8(sum, _mm256_slli_si256(sum, 1)); /* within each half */
        sum = _mm256_add_epi8(sum, _mm256_slli_si256(sum, 2));
        sum = _mm256_add_epi8(sum, _mm256_slli_si256(sum, 4));
        sum = _mm256_add_epi8(sum, _mm256_slli_si256(sum, 8));
        const __m256i lasts = _mm256_shuffle_epi8(sum, fifteen);
        sum = _mm256_add_epi8(sum, _mm256_permute2x128_si256(lasts, lasts, 0x08)); /* the lower half's to the upper */
        _mm256_storeu_si256((__m256i *)(data + i), _mm256_add_epi8(sum, before));
        before = _mm256_add_epi8(before, _mm256_add_epi8(lasts, _mm256_permute4x64_epi64(lasts, 0x4e)));
    }
    _mm256_zeroupper();
    accumulate_from(data, i, bytes);
}
#endif

RETEX_CPU_TABLE(accumulate, (unsigned char *, size_t), accumulate_baseline, accumulate_avx2, accumulate_avx2)

void retex_exr_zip_accumulate(unsigned char *data, size_t bytes)
{
    accumulate_by_level[retex_cpu_level()](data, bytes);
}

void retex_exr_zip_interleave(unsigned char *restrict raw, const unsigned char *restrict in, size_t bytes)
{
    const unsigned char *restrict odd = in + (bytes + 1) / 2;
    size_t i = 0;

#ifdef __SSE2__
    for (; i + 16 <= bytes / 2; i += 16) {
        const __m128i low = _mm_loadu_si128((const __m128i *)(in + i));
        const __m128i high = _mm_loadu_si128((const __m128i *)(odd + i));
        _mm_storeu_si128((__m128i *)(raw + 2 * i), _mm_unpacklo_epi8(low, high));
        _mm_storeu_si128((__m128i *)(raw + 2 * i + 16), _mm_unpackhi_epi8(low, high));
    }
#endif
    for (; i < bytes / 2; i++) {
        raw[2 * i] = in[i];
        raw[2 * i + 1] = odd[i];
    }
    if (bytes & 1)
        raw[bytes - 1] = in[bytes / 2];
}

void retex_exr_pxr24_difference(unsigned char *restrict out, const unsigned char *restrict raw, size_t width)
{
    uint32_t previous = 0;
    for (size_t i = 0; i < width; i++) {
        uint32_t value;
        memcpy(&value, raw + 4 * i, 4);
        value >>= 8;
        const uint32_t difference = value - previous;
        previous = value;
        out[i] = (unsigned char)(difference >> 16);
        out[width + i] = (unsigned char)(difference >> 8);
        out[2 * width + i] = (unsigned char)difference;
    }
}

void retex_exr_pxr24_accumulate(unsigned char *restrict raw, const unsigned char *restrict in, size_t width)
{
    size_t i = 0;
    uint32_t value = 0;
#ifdef __SSE2__
    const __m128i zero = _mm_setzero_si128();
    __m128i before = zero;
    for (; i + 16 <= width; i += 16) {
        const __m128i high = _mm_loadu_si128((const __m128i *)(in + i));
        const __m128i middle = _mm_loadu_si128((const __m128i *)(in + width + i));
        const __m128i low = _mm_loadu_si128((const __m128i *)(in + 2 * width + i));
        const __m128i upper[2] = {_mm_unpacklo_epi8(middle, high), _mm_unpackhi_epi8(middle, high)};
        const __m128i lower[2] = {_mm_unpacklo_epi8(zero, low), _mm_unpackhi_epi8(zero, low)};
        for (int k = 0; k < 4; k++) {
            __m128i v =
                k % 2 ? _mm_unpackhi_epi16(lower[k / 2], upper[k / 2]) : _mm_unpacklo_epi16(lower[k / 2], upper[k / 2]);
            v = _mm_add_epi32(v, _mm_slli_si128(v, 4));
            v = _mm_add_epi32(v, _mm_slli_si128(v, 8));
            _mm_storeu_si128((__m128i *)(raw + 4 * i + 16 * (size_t)k), _mm_add_epi32(v, before));
            before = _mm_add_epi32(before, _mm_shuffle_epi32(v, 0xff)); /* all that the next floats wait for */
        }
    }
    value = (uint32_t)_mm_cvtsi128_si32(before);
#endif
    for (; i < width; i++) { /* with 8 more bits, so that values overflow where 24 bits do */
        value += (uint32_t)in[i] << 24 | (uint32_t)in[width + i] << 16 | (uint32_t)in[2 * width + i] << 8;
        memcpy(raw + 4 * i, &value, 4);
    }
}
