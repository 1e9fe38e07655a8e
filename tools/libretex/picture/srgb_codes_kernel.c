/* Codes are monotonic in the value. So each code has a smallest float, found once by evaluating the curve near its
 * inverse; the code of any value is the highest whose smallest float is not above it. A table by the value's exponent
 * and upper bits gives a first guess. */
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color.h>
#include <retex/host/cpu.h>

#include "picture/srgb_codes.h"

enum {
    STEP_BITS = 15,    /* a bucket has floats that differ in these bits only; at 8 bits at most two codes meet in one */
    EXPONENTS_8 = 13,  /* 2^-13 is below the smallest float of code 1 */
    EXPONENTS_16 = 21, /* the same of 16 bits */
    BUCKETS_OF_ONE = 1 << (23 - STEP_BITS),
    CODES_8 = 256,
    CODES_16 = 65536
};

static struct {
    pthread_once_t once_8, once_16;
    float smallest_8[CODES_8 + 1], smallest_16[CODES_16 + 1]; /* the smallest float of each code; a last one beyond
                                                                 all */
    uint8_t first_8[EXPONENTS_8 * BUCKETS_OF_ONE + 3];        /* code of a bucket's first float; 4 bytes are loaded
                                                                 at once */
    float first_16[EXPONENTS_16 * BUCKETS_OF_ONE + 1];        /* the same, not rounded */
} tables = {.once_8 = PTHREAD_ONCE_INIT, .once_16 = PTHREAD_ONCE_INIT};

unsigned retex_linear_code(float value, int bits)
{
    const unsigned top = (1u << bits) - 1;

    if (!(value > 0)) /* NaN too */
        return 0;
    return value >= 1 ? top : (unsigned)(value * (float)top + 0.5f);
}

unsigned retex_srgb_code(float value, int bits)
{
    return retex_linear_code(retex_srgb_encodef(value), bits);
}

static void find_smallest(float *smallest, int bits)
{
    const unsigned codes = 1u << bits;

    smallest[0] = 0;
    for (unsigned code = 1; code < codes; code++) {
        float value = (float)retex_srgb_decode((code - 0.5) / (codes - 1));
        while (retex_srgb_code(value, bits) < code)
            value = nextafterf(value, 2);
        for (float less; (less = nextafterf(value, 0)), retex_srgb_code(less, bits) >= code;)
            value = less;
        smallest[code] = value;
    }
    smallest[codes] = INFINITY;
}

static uint32_t bits_of(float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float float_of(uint32_t bits)
{
    float value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

#define LOWEST(exponents) ((uint32_t)(127 - (exponents)) << 23) /* the bits of 2^-exponents */

static void make_8(void)
{
    find_smallest(tables.smallest_8, 8);
    for (uint32_t i = 0; i < EXPONENTS_8 * BUCKETS_OF_ONE; i++)
        tables.first_8[i] = (uint8_t)retex_srgb_code(float_of(LOWEST(EXPONENTS_8) + (i << STEP_BITS)), 8);
}

static void make_16(void)
{
    find_smallest(tables.smallest_16, 16);
    for (uint32_t i = 0; i < sizeof tables.first_16 / sizeof tables.first_16[0]; i++) {
        const float value = float_of(LOWEST(EXPONENTS_16) + (i << STEP_BITS));
        tables.first_16[i] = (float)(retex_srgb_encode((double)value) * (CODES_16 - 1));
    }
}

/* Clamps between the lowest float of the tables and the highest below 1, which have the codes of all values beyond. NaN
 * becomes the lowest. */
static inline uint32_t clamped_bits(float value, int exponents)
{
    const float low = float_of(LOWEST(exponents)), high = 0x1.fffffep-1f;

    value = value > low ? value : low;
    return bits_of(value < high ? value : high);
}

static void codes_8_plain(uint8_t *restrict codes, const float *restrict values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint32_t bits = clamped_bits(values[i], EXPONENTS_8);
        const unsigned code = tables.first_8[(bits - LOWEST(EXPONENTS_8)) >> STEP_BITS];
        codes[i] = (uint8_t)(code + (float_of(bits) >= tables.smallest_8[code + 1]));
    }
}

#if RETEX_CPU_X86
#include <immintrin.h>

RETEX_CPU_TARGET_AVX2 static inline __m256i eight_codes(const float *values)
{
    const __m256 low = _mm256_castsi256_ps(_mm256_set1_epi32(LOWEST(EXPONENTS_8)));
    /* of NaN and a number the second is the larger one */
    const __m256 value = _mm256_min_ps(_mm256_max_ps(_mm256_loadu_ps(values), low), _mm256_set1_ps(0x1.fffffep-1f));
    const __m256i bucket =
        _mm256_srli_epi32(_mm256_sub_epi32(_mm256_castps_si256(value), _mm256_castps_si256(low)), STEP_BITS);
    const __m256i first = _mm256_i32gather_epi32((const int *)(const void *)tables.first_8, bucket, 1);
    const __m256i code = _mm256_and_si256(first, _mm256_set1_epi32(255));
    const __m256 next = _mm256_i32gather_ps(tables.smallest_8 + 1, code, 4);
    return _mm256_sub_epi32(code, _mm256_castps_si256(_mm256_cmp_ps(value, next, _CMP_GE_OQ)));
}

RETEX_CPU_TARGET_AVX2 static void codes_8_avx2(uint8_t *restrict codes, const float *restrict values, size_t count)
{
    const __m256i order = _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7);
    size_t i = 0;
    for (; i + 32 <= count; i += 32) {
        const __m256i a = _mm256_packus_epi32(eight_codes(values + i), eight_codes(values + i + 8));
        const __m256i b = _mm256_packus_epi32(eight_codes(values + i + 16), eight_codes(values + i + 24));
        const __m256i bytes = _mm256_permutevar8x32_epi32(_mm256_packus_epi16(a, b), order);
        _mm256_storeu_si256((__m256i *)(void *)(codes + i), bytes);
    }
    _mm256_zeroupper(); /* which the compiler leaves out before a last call */
    codes_8_plain(codes + i, values + i, count - i);
}

#endif

RETEX_CPU_TABLE(codes_8, (uint8_t *restrict, const float *restrict, size_t), codes_8_plain, codes_8_avx2, codes_8_avx2)

void retex_srgb_codes_8(uint8_t *restrict codes, const float *restrict values, size_t count)
{
    pthread_once(&tables.once_8, make_8);
    codes_8_by_level[retex_cpu_level()](codes, values, count);
}

void retex_srgb_codes_16(uint16_t *restrict codes, const float *restrict values, size_t count)
{
    pthread_once(&tables.once_16, make_16);
    for (size_t i = 0; i < count; i++) {
        const uint32_t bits = clamped_bits(values[i], EXPONENTS_16);
        const float *first = &tables.first_16[(bits - LOWEST(EXPONENTS_16)) >> STEP_BITS], value = float_of(bits);
        const float part = (float)(bits & ((1u << STEP_BITS) - 1)) * (1.0f / (1 << STEP_BITS));
        unsigned code = (unsigned)(first[0] + (first[1] - first[0]) * part + 0.5f);
        while (value < tables.smallest_16[code])
            code--;
        while (value >= tables.smallest_16[code + 1])
            code++;
        codes[i] = (uint16_t)code;
    }
}
