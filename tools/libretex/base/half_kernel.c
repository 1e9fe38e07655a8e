/* Conversion between float and half: a scalar reference and, with F16C, eight values at a time. */
#include <string.h>

#include <retex/host/cpu.h>

#include "base/half.h"

enum { HALF_LARGEST = 0x7bff, HALF_INFINITY = 0x7c00, HALF_QUIET = 0x0200 };

static uint16_t half_from_float(float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof bits);
    const uint16_t sign = (uint16_t)(bits >> 16 & 0x8000);
    bits &= 0x7fffffff;

    if (bits > 0x7f800000) /* NaN: keep the upper bits, and make it quiet as the hardware does */
        return (uint16_t)(sign | HALF_INFINITY | HALF_QUIET | (bits >> 13 & 0x3ff));
    if (bits == 0x7f800000)
        return sign | HALF_INFINITY;
    if (bits >= 0x477fe000) /* 65504 and above */
        return sign | HALF_LARGEST;
    if (bits >= 0x38800000) { /* normal: rebias the exponent, round the 13 bits that fall off to even */
        bits -= (uint32_t)(127 - 15) << 23;
        return (uint16_t)(sign | (bits + 0xfff + (bits >> 13 & 1)) >> 13);
    }
    if (bits < 0x33000000) /* less than half the smallest subnormal */
        return sign;
    /* subnormal: units of 2^-24, rounded to even */
    const uint32_t mantissa = (bits & 0x7fffff) | 0x800000;
    const uint32_t shift = 126 - (bits >> 23); /* 14..24 */
    const uint32_t upper = mantissa >> shift, rest = mantissa & ((1u << shift) - 1), tie = 1u << (shift - 1);
    return (uint16_t)(sign | (upper + (rest > tie || (rest == tie && (upper & 1)))));
}

static float half_to_float(uint16_t half)
{
    const uint32_t sign = (uint32_t)(half & 0x8000) << 16;
    const uint32_t exponent = half >> 10 & 0x1f, mantissa = half & 0x3ff;
    uint32_t bits;
    float value;

    if (exponent == 0) {
        value = (float)mantissa * 0x1p-24f;
        memcpy(&bits, &value, sizeof bits);
        bits |= sign;
    } else if (exponent == 31) {
        bits = sign | 0x7f800000 | mantissa << 13 | (mantissa ? 0x400000 : 0);
    } else {
        bits = sign | (exponent + (127 - 15)) << 23 | mantissa << 13;
    }
    memcpy(&value, &bits, sizeof value);
    return value;
}

void retex_half_from_float_scalar(uint16_t *restrict dst, const float *restrict src, size_t count)
{
    for (size_t i = 0; i < count; i++)
        dst[i] = half_from_float(src[i]);
}

void retex_half_to_float_scalar(float *restrict dst, const uint16_t *restrict src, size_t count)
{
    for (size_t i = 0; i < count; i++)
        dst[i] = half_to_float(src[i]);
}

#if RETEX_CPU_X86
#include <immintrin.h>

RETEX_CPU_TARGET_AVX2 static void from_float_f16c(uint16_t *restrict dst, const float *restrict src, size_t count)
{
    const __m256 magnitude = _mm256_castsi256_ps(_mm256_set1_epi32(0x7fffffff));
    const __m256 largest = _mm256_set1_ps(65504.0f), infinity = _mm256_set1_ps(__builtin_inff());
    size_t i = 0;

    for (; i + 8 <= count; i += 8) {
        const __m256 value = _mm256_loadu_ps(src + i);
        const __m256 size = _mm256_and_ps(value, magnitude);
        /* finite and too large: 65504 with the value's sign (comparisons with NaN are false) */
        const __m256 over =
            _mm256_and_ps(_mm256_cmp_ps(size, largest, _CMP_GT_OQ), _mm256_cmp_ps(size, infinity, _CMP_LT_OQ));
        const __m256 clamped = _mm256_or_ps(largest, _mm256_andnot_ps(magnitude, value));
        const __m256 in_range = _mm256_blendv_ps(value, clamped, over);
        _mm_storeu_si128((__m128i *)(dst + i), _mm256_cvtps_ph(in_range, _MM_FROUND_TO_NEAREST_INT));
    }
    _mm256_zeroupper(); /* which the compiler leaves out before a last call */
    retex_half_from_float_scalar(dst + i, src + i, count - i);
}

RETEX_CPU_TARGET_AVX2 static void to_float_f16c(float *restrict dst, const uint16_t *restrict src, size_t count)
{
    size_t i = 0;

    for (; i + 8 <= count; i += 8)
        _mm256_storeu_ps(dst + i, _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(src + i))));
    retex_half_to_float_scalar(dst + i, src + i, count - i);
}

#endif

RETEX_CPU_TABLE(from_float, (uint16_t *restrict, const float *restrict, size_t), retex_half_from_float_scalar,
                from_float_f16c, from_float_f16c)
RETEX_CPU_TABLE(to_float, (float *restrict, const uint16_t *restrict, size_t), retex_half_to_float_scalar,
                to_float_f16c, to_float_f16c)

void retex_half_from_float(uint16_t *restrict dst, const float *restrict src, size_t count)
{
    from_float_by_level[retex_cpu_level()](dst, src, count);
}

void retex_half_to_float(float *restrict dst, const uint16_t *restrict src, size_t count)
{
    to_float_by_level[retex_cpu_level()](dst, src, count);
}
