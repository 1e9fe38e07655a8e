/* The arithmetic of jpeg.c: an 8 x 8 cosine transform in floating point, by even and odd halves, and the way from
 * luma and chroma over levels to values. */
#include "pack/jpeg_kernel.h"

#include <math.h>
#include <string.h>

/* cos(k pi / 16) / 2 */
#define C1 0.490392640201615f
#define C2 0.461939766255643f
#define C3 0.415734806151273f
#define C4 0.353553390593274f
#define C5 0.277785116509801f
#define C6 0.191341716182545f
#define C7 0.0975451610080642f

/* Eight interleaved transforms of eight: out[k][i] = sum over n of in[n][i] cos((2n + 1) k pi / 16) / 2, orthonormal.
 */
static void forward8(float out[restrict 8][8], float in[restrict 8][8])
{
    for (int i = 0; i < 8; i++) {
        const float s0 = in[0][i] + in[7][i], s1 = in[1][i] + in[6][i], s2 = in[2][i] + in[5][i],
                    s3 = in[3][i] + in[4][i], d0 = in[0][i] - in[7][i], d1 = in[1][i] - in[6][i],
                    d2 = in[2][i] - in[5][i], d3 = in[3][i] - in[4][i];
        const float e0 = s0 + s3, e1 = s1 + s2, f0 = s0 - s3, f1 = s1 - s2;
        out[0][i] = C4 * (e0 + e1);
        out[4][i] = C4 * (e0 - e1);
        out[2][i] = C2 * f0 + C6 * f1;
        out[6][i] = C6 * f0 - C2 * f1;
        out[1][i] = C1 * d0 + C3 * d1 + C5 * d2 + C7 * d3;
        out[3][i] = C3 * d0 - C7 * d1 - C1 * d2 - C5 * d3;
        out[5][i] = C5 * d0 - C1 * d1 + C7 * d2 + C3 * d3;
        out[7][i] = C7 * d0 - C5 * d1 + C3 * d2 - C1 * d3;
    }
}

static void inverse8(float out[restrict 8][8], float in[restrict 8][8])
{
    for (int i = 0; i < 8; i++) {
        const float a = C4 * (in[0][i] + in[4][i]), b = C4 * (in[0][i] - in[4][i]), c = C2 * in[2][i] + C6 * in[6][i],
                    d = C6 * in[2][i] - C2 * in[6][i];
        const float e0 = a + c, e3 = a - c, e1 = b + d, e2 = b - d;
        const float o0 = C1 * in[1][i] + C3 * in[3][i] + C5 * in[5][i] + C7 * in[7][i],
                    o1 = C3 * in[1][i] - C7 * in[3][i] - C1 * in[5][i] - C5 * in[7][i],
                    o2 = C5 * in[1][i] - C1 * in[3][i] + C7 * in[5][i] + C3 * in[7][i],
                    o3 = C7 * in[1][i] - C5 * in[3][i] + C3 * in[5][i] - C1 * in[7][i];
        out[0][i] = e0 + o0;
        out[7][i] = e0 - o0;
        out[1][i] = e1 + o1;
        out[6][i] = e1 - o1;
        out[2][i] = e2 + o2;
        out[5][i] = e2 - o2;
        out[3][i] = e3 + o3;
        out[4][i] = e3 - o3;
    }
}

static void transpose8(float out[restrict 8][8], float in[restrict 8][8])
{
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
            out[x][y] = in[y][x];
}

/* A coefficient below this share of a step above a whole number of steps is rounded down: what it costs in error it
 * saves in bits. */
static const float ROUNDING = 0.44f;

/* Both ways: to coefficients in natural order. */
static void forward(float a[restrict 8][8], const float *samples, int stride)
{
    float b[8][8];
    for (int y = 0; y < 8; y++)
        memcpy(a[y], samples + y * stride, sizeof a[y]);
    forward8(b, a);
    transpose8(a, b);
    forward8(b, a);
    transpose8(a, b);
}

void retex_pack_block_largest(float *largest, const float *samples, int stride)
{
    float a[8][8];
    forward(a, samples, stride);
    for (int i = 0; i < 64; i++)
        largest[i] = fmaxf(largest[i], fabsf(a[i / 8][i % 8]));
}

void retex_pack_block_forward(int16_t *coefficients, const float *samples, int stride, const float *inverse_steps)
{
    float a[8][8];
    forward(a, samples, stride);
    for (int i = 0; i < 64; i++) {
        const float c = a[i / 8][i % 8] * inverse_steps[i];
        const float size = floorf(fabsf(c) + (i ? ROUNDING : 0.5f));
        coefficients[i] = (int16_t)copysignf(fminf(size, 1023), c);
    }
}

/* --- back: the reference --- */

static void inverse_plain(float *samples, int stride, const int16_t *coefficients, int blocks, const float *steps)
{
    for (int block = 0; block < blocks; block++, coefficients += 64, samples += 8) {
        float a[8][8], b[8][8];
        for (int i = 0; i < 64; i++)
            a[i / 8][i % 8] = (float)coefficients[i] * steps[i];
        inverse8(b, a);
        transpose8(a, b);
        inverse8(b, a);
        transpose8(a, b);
        for (int y = 0; y < 8; y++)
            memcpy(samples + y * stride, a[y], sizeof a[y]);
    }
}

static inline float value_of(float level, const RetexPackLevels *levels)
{
    const float scaled = level * levels->scale, place = scaled > 0 ? scaled : 0;
    const int entry = place < RETEX_PACK_LEVEL_ENTRIES ? (int)place : RETEX_PACK_LEVEL_ENTRIES;
    const float low = levels->share[entry];
    return low + (levels->share[entry + 1] - low) * (place - (float)entry);
}

static void colors_plain(float *restrict values, const float *y, const float *cb, const float *cr, int count,
                         const RetexPackLevels *levels)
{
    for (int i = 0; i < count; i++) {
        const float level = y[i] + 128;
        values[3 * i] = value_of(level + 1.402f * cr[i], levels) * levels->white[0];
        values[3 * i + 1] =
            value_of(level - 0.344136286f * cb[i] - 0.714136286f * cr[i], levels) * levels->white[1];
        values[3 * i + 2] = value_of(level + 1.772f * cb[i], levels) * levels->white[2];
    }
}

static void greys_plain(float *restrict values, const float *y, int count, const RetexPackLevels *levels)
{
    for (int i = 0; i < count; i++)
        values[i] = value_of(y[i] + 128, levels) * levels->white[0];
}

/* --- back: eight at a time --- */

#if RETEX_CPU_X86
#include <immintrin.h>

RETEX_CPU_BEGIN_AVX2

/* inverse8 of vectors, in the same order of operations. */
#define DEFINE_INVERSE8(name, Vector)                                                                                  \
    RETEX_CPU_INLINE void name(Vector v[8])                                                                            \
    {                                                                                                                  \
        const Vector a = C4 * (v[0] + v[4]), b = C4 * (v[0] - v[4]), c = C2 * v[2] + C6 * v[6],                        \
                     d = C6 * v[2] - C2 * v[6];                                                                        \
        const Vector e0 = a + c, e3 = a - c, e1 = b + d, e2 = b - d;                                                   \
        const Vector o0 = C1 * v[1] + C3 * v[3] + C5 * v[5] + C7 * v[7],                                               \
                     o1 = C3 * v[1] - C7 * v[3] - C1 * v[5] - C5 * v[7],                                               \
                     o2 = C5 * v[1] - C1 * v[3] + C7 * v[5] + C3 * v[7],                                               \
                     o3 = C7 * v[1] - C5 * v[3] + C3 * v[5] - C1 * v[7];                                               \
        v[0] = e0 + o0, v[7] = e0 - o0, v[1] = e1 + o1, v[6] = e1 - o1;                                                \
        v[2] = e2 + o2, v[5] = e2 - o2, v[3] = e3 + o3, v[4] = e3 - o3;                                                \
    }

DEFINE_INVERSE8(inverse8_avx2, __m256)

RETEX_CPU_INLINE void transpose8_avx2(__m256 v[8])
{
    __m256 pairs[8], fours[8];
    for (int i = 0; i < 4; i++) {
        pairs[2 * i] = _mm256_unpacklo_ps(v[2 * i], v[2 * i + 1]);
        pairs[2 * i + 1] = _mm256_unpackhi_ps(v[2 * i], v[2 * i + 1]);
    }
    for (int i = 0; i < 8; i += 4)
        for (int k = 0; k < 2; k++) {
            fours[i + 2 * k] = _mm256_shuffle_ps(pairs[i + k], pairs[i + k + 2], 0x44);
            fours[i + 2 * k + 1] = _mm256_shuffle_ps(pairs[i + k], pairs[i + k + 2], 0xee);
        }
    for (int i = 0; i < 4; i++) {
        v[i] = _mm256_permute2f128_ps(fours[i], fours[i + 4], 0x20);
        v[i + 4] = _mm256_permute2f128_ps(fours[i], fours[i + 4], 0x31);
    }
}

/* 1 if no coefficient but the first is there: such a block is even. */
static inline int is_even(const int16_t *coefficients)
{
    const __m256i *c = (const __m256i *)(const void *)coefficients;
    const __m256i rest = _mm256_or_si256(_mm256_or_si256(_mm256_loadu_si256(c + 1), _mm256_loadu_si256(c + 2)),
                                         _mm256_loadu_si256(c + 3));
    const __m256i first = _mm256_and_si256(_mm256_loadu_si256(c), _mm256_set_epi32(-1, -1, -1, -1, -1, -1, -1, -65536));
    const __m256i all = _mm256_or_si256(rest, first);
    return _mm256_testz_si256(all, all);
}

static void inverse_avx2(float *samples, int stride, const int16_t *coefficients, int blocks, const float *steps)
{
    for (int block = 0; block < blocks; block++, coefficients += 64, samples += 8) {
        __m256 v[8];
        if (is_even(coefficients)) {
            v[0] = _mm256_set1_ps(C4 * (C4 * ((float)coefficients[0] * steps[0])));
            for (int y = 0; y < 8; y++)
                _mm256_storeu_ps(samples + y * stride, v[0]);
            continue;
        }
        for (int y = 0; y < 8; y++) {
            const __m128i row = _mm_loadu_si128((const __m128i *)(const void *)(coefficients + 8 * y));
            v[y] = _mm256_mul_ps(_mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(row)), _mm256_loadu_ps(steps + 8 * y));
        }
        inverse8_avx2(v);
        transpose8_avx2(v);
        inverse8_avx2(v);
        transpose8_avx2(v);
        for (int y = 0; y < 8; y++)
            _mm256_storeu_ps(samples + y * stride, v[y]);
    }
}

/* value_of; an entry and the next one lie side by side and come at once. */
RETEX_CPU_INLINE __m256 values_of(__m256 level, const RetexPackLevels *levels)
{
    const __m256 place = _mm256_max_ps(levels->scale * level, _mm256_setzero_ps());
    const __m256i entry = _mm256_cvttps_epi32(_mm256_min_ps(place, _mm256_set1_ps(RETEX_PACK_LEVEL_ENTRIES)));
    const __m256i halves = _mm256_permute4x64_epi64(entry, 0xd8); /* 0, 1, 4, 5 and 2, 3, 6, 7 */
    const long long *from = (const long long *)(const void *)levels->share;
    const __m256 a = _mm256_castsi256_ps(_mm256_i32gather_epi64(from, _mm256_castsi256_si128(halves), 4)),
                 b = _mm256_castsi256_ps(_mm256_i32gather_epi64(from, _mm256_extracti128_si256(halves, 1), 4));
    const __m256 low = _mm256_shuffle_ps(a, b, 0x88), high = _mm256_shuffle_ps(a, b, 0xdd);
    return low + (high - low) * (place - _mm256_cvtepi32_ps(entry));
}

static void colors_avx2(float *restrict values, const float *y, const float *cb, const float *cr, int count,
                        const RetexPackLevels *levels)
{
    const __m256i reds = _mm256_setr_epi32(0, 3, 6, 1, 4, 7, 2, 5), greens = _mm256_setr_epi32(5, 0, 3, 6, 1, 4, 7, 2),
                  blues = _mm256_setr_epi32(2, 5, 0, 3, 6, 1, 4, 7);
    int i = 0;
    for (; i + 8 <= count; i += 8) {
        const __m256 level = _mm256_loadu_ps(y + i) + 128;
        const __m256 b = _mm256_loadu_ps(cb + i), r = _mm256_loadu_ps(cr + i);
        const __m256 red = _mm256_permutevar8x32_ps(values_of(level + 1.402f * r, levels) * levels->white[0], reds);
        const __m256 green = _mm256_permutevar8x32_ps(
            values_of(level - 0.344136286f * b - 0.714136286f * r, levels) * levels->white[1], greens);
        const __m256 blue = _mm256_permutevar8x32_ps(values_of(level + 1.772f * b, levels) * levels->white[2], blues);
        float *to = values + 3 * (size_t)i;
        _mm256_storeu_ps(to, _mm256_blend_ps(_mm256_blend_ps(red, green, 0x92), blue, 0x24));
        _mm256_storeu_ps(to + 8, _mm256_blend_ps(_mm256_blend_ps(red, green, 0x24), blue, 0x49));
        _mm256_storeu_ps(to + 16, _mm256_blend_ps(_mm256_blend_ps(red, green, 0x49), blue, 0x92));
    }
    _mm256_zeroupper(); /* which the compiler leaves out before a last call */
    colors_plain(values + 3 * (size_t)i, y + i, cb + i, cr + i, count - i, levels);
}

static void greys_avx2(float *restrict values, const float *y, int count, const RetexPackLevels *levels)
{
    int i = 0;
    for (; i + 8 <= count; i += 8)
        _mm256_storeu_ps(values + i, values_of(_mm256_loadu_ps(y + i) + 128, levels) * levels->white[0]);
    _mm256_zeroupper();
    greys_plain(values + i, y + i, count - i, levels);
}
RETEX_CPU_END

/* --- back: sixteen at a time --- */

RETEX_CPU_BEGIN_AVX512

/* Of two blocks side by side. */
DEFINE_INVERSE8(inverse8_avx512, __m512)

/* Each half by itself. */
RETEX_CPU_INLINE void transpose8_avx512(__m512 v[8])
{
    const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13),
                  high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    __m512 pairs[8], fours[8];
    for (int i = 0; i < 4; i++) {
        pairs[2 * i] = _mm512_unpacklo_ps(v[2 * i], v[2 * i + 1]);
        pairs[2 * i + 1] = _mm512_unpackhi_ps(v[2 * i], v[2 * i + 1]);
    }
    for (int i = 0; i < 8; i += 4)
        for (int k = 0; k < 2; k++) {
            fours[i + 2 * k] = _mm512_shuffle_ps(pairs[i + k], pairs[i + k + 2], 0x44);
            fours[i + 2 * k + 1] = _mm512_shuffle_ps(pairs[i + k], pairs[i + k + 2], 0xee);
        }
    for (int i = 0; i < 4; i++) {
        const __m512d a = _mm512_castps_pd(fours[i]), b = _mm512_castps_pd(fours[i + 4]);
        v[i] = _mm512_castpd_ps(_mm512_permutex2var_pd(a, low, b));
        v[i + 4] = _mm512_castpd_ps(_mm512_permutex2var_pd(a, high, b));
    }
}

static void inverse_avx512(float *samples, int stride, const int16_t *coefficients, int blocks, const float *steps)
{
    int block = 0;
    for (; block + 2 <= blocks; block += 2, coefficients += 128, samples += 16) {
        __m512 v[8];
        if (is_even(coefficients) && is_even(coefficients + 64)) {
            const __m256 a = _mm256_set1_ps(C4 * (C4 * ((float)coefficients[0] * steps[0]))),
                         b = _mm256_set1_ps(C4 * (C4 * ((float)coefficients[64] * steps[0])));
            for (int y = 0; y < 8; y++)
                _mm512_storeu_ps(samples + y * stride, _mm512_insertf32x8(_mm512_castps256_ps512(a), b, 1));
            continue;
        }
        for (int y = 0; y < 8; y++) {
            const __m128i a = _mm_loadu_si128((const __m128i *)(const void *)(coefficients + 8 * y)),
                          b = _mm_loadu_si128((const __m128i *)(const void *)(coefficients + 64 + 8 * y));
            const __m256i row = _mm256_inserti128_si256(_mm256_castsi128_si256(a), b, 1);
            v[y] = _mm512_mul_ps(_mm512_cvtepi32_ps(_mm512_cvtepi16_epi32(row)),
                                 _mm512_broadcast_f32x8(_mm256_loadu_ps(steps + 8 * y)));
        }
        inverse8_avx512(v);
        transpose8_avx512(v);
        inverse8_avx512(v);
        transpose8_avx512(v);
        for (int y = 0; y < 8; y++)
            _mm512_storeu_ps(samples + y * stride, v[y]);
    }
    _mm256_zeroupper();
    inverse_avx2(samples, stride, coefficients, blocks - block, steps);
}
RETEX_CPU_END

#endif

const RetexPackJpegKernels retex_pack_jpeg_kernels[RETEX_CPU_LEVELS] = {
    {inverse_plain, colors_plain, greys_plain},
#if RETEX_CPU_X86
    {inverse_avx2, colors_avx2, greys_avx2},
    {inverse_avx512, colors_avx2, greys_avx2},
#endif
};
