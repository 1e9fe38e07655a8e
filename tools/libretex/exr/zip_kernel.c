/* See zip_kernel.h. */
#include "exr/zip_kernel.h"

#include <stdint.h>
#include <string.h>

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

void retex_exr_zip_accumulate(unsigned char *data, size_t bytes)
{
    unsigned previous = 128;
    size_t i = 0;

#ifdef __SSE2__
    const __m128i bias = _mm_set1_epi8((char)-128);
    for (; i + 16 <= bytes; i += 16) {
        __m128i sum = _mm_add_epi8(_mm_loadu_si128((const __m128i *)(data + i)), bias);
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 1));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 2));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 4));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 8));
        sum = _mm_add_epi8(sum, _mm_set1_epi8((char)previous));
        _mm_storeu_si128((__m128i *)(data + i), sum);
        previous = data[i + 15];
    }
#endif
    for (; i < bytes; i++) {
        previous = (previous + data[i] - 128) & 255;
        data[i] = (unsigned char)previous;
    }
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
    uint32_t value = 0; /* with 8 more bits, so that it overflows where 24 bits do */
    for (size_t i = 0; i < width; i++) {
        value += (uint32_t)in[i] << 24 | (uint32_t)in[width + i] << 16 | (uint32_t)in[2 * width + i] << 8;
        memcpy(raw + 4 * i, &value, 4);
    }
}
