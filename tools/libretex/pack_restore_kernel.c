/* See pack_restore.h. Most planes are of codes that nothing predicts: those only have to be spread over the pixels
 * where they matter. Of the others the prediction is chosen once a plane, and what neighbours a number has by runs. */
#include "pack_restore.h"

#include <string.h>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

size_t pack_count_present(const unsigned char *present, size_t count)
{
    size_t sum = 0;
    for (size_t begin = 0; begin < count; begin += 255) { /* sums of bytes that fit into a byte */
        const size_t n = count - begin < 255 ? count - begin : 255;
        unsigned char part = 0;
        for (size_t i = 0; i < n; i++)
            part = (unsigned char)(part + (present[begin + i] != 0));
        sum += part;
    }
    return sum;
}

void pack_find_present(unsigned char *restrict present, const int32_t *restrict numbers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        present[i] = numbers[i] != 0;
}

static inline uint32_t load(const unsigned char *from, int bytes)
{
    return bytes == 1   ? from[0]
           : bytes == 2 ? from[0] | (uint32_t)from[1] << 8
                        : from[0] | (uint32_t)from[1] << 8 | (uint32_t)from[2] << 16 | (uint32_t)from[3] << 24;
}

void pack_restore_plainly(PackPlane *plane, Predictor predictor, const unsigned char *from, int bytes)
{
    int32_t last = 0;
    for (int y = 0; y < plane->rows; y++)
        for (int x = 0; x < plane->width; x++) {
            const size_t row = (size_t)y * (size_t)plane->width;
            int32_t *number = &plane->numbers[row + (size_t)x];
            if (plane->present && !plane->present[row + (size_t)x]) {
                *number = 0;
                continue;
            }
            const int shift = plane->shift ? plane->shift[row + (size_t)x] : 0;
            const int32_t guess = in_steps(predict_at(plane, predictor, row, x, last), shift);
            const int32_t sum = add(guess, from_unsigned(load(from, bytes)));
            *number = last = wrap((int32_t)((uint32_t)sum << shift), plane->bits);
            from += bytes;
        }
}

/* ---- nothing predicts them ---- */

/* A byte's number: of codes from 0, or with a sign. */
static inline int32_t number_of_byte(unsigned char residual, int bits)
{
    const int32_t number = from_unsigned(residual);
    return bits == 8 ? (uint8_t)number : number;
}

/* Numbers of 8 residuals of a byte. */
static inline void widen8(int32_t *numbers, const unsigned char *from, int bits)
{
#ifdef __SSE2__
    const __m128i zero = _mm_setzero_si128(), one = _mm_set1_epi16(1);
    const __m128i code = _mm_unpacklo_epi8(_mm_loadl_epi64((const __m128i *)(const void *)from), zero);
    const __m128i sign = _mm_sub_epi16(zero, _mm_and_si128(code, one));
    __m128i number = _mm_xor_si128(_mm_srli_epi16(code, 1), sign), high;
    if (bits == 8) {
        number = _mm_and_si128(number, _mm_set1_epi16(255));
        high = zero;
    } else {
        high = _mm_srai_epi16(number, 15);
    }
    _mm_storeu_si128((__m128i *)(void *)numbers, _mm_unpacklo_epi16(number, high));
    _mm_storeu_si128((__m128i *)(void *)(numbers + 4), _mm_unpackhi_epi16(number, high));
#else
    for (int i = 0; i < 8; i++)
        numbers[i] = number_of_byte(from[i], bits);
#endif
}

static inline int32_t wide_number(const unsigned char *from, int bytes, int bits)
{
    return bytes == 1 ? number_of_byte(*from, bits) : wrap(from_unsigned(load(from, bytes)), bits);
}

static inline void spread_all(int32_t *numbers, size_t count, const unsigned char *from, int bytes, int bits)
{
    size_t i = 0;
    for (; bytes == 1 && i + 8 <= count; i += 8)
        widen8(numbers + i, from + i, bits);
    for (; i < count; i++)
        numbers[i] = wide_number(from + i * (size_t)bytes, bytes, bits);
}

/* Eight at a time, of which often all or none matter. */
static inline void spread_present(int32_t *numbers, const unsigned char *present, size_t count,
                                  const unsigned char *from, int bytes, int bits)
{
    static const unsigned char all[8] = {1, 1, 1, 1, 1, 1, 1, 1}, none[8];
    size_t i = 0;
    for (; i + 8 <= count; i += 8) {
        if (memcmp(present + i, none, 8) == 0) {
            memset(numbers + i, 0, 8 * sizeof *numbers);
        } else if (memcmp(present + i, all, 8) == 0) {
            spread_all(numbers + i, 8, from, bytes, bits);
            from += 8 * bytes;
        } else {
            for (size_t k = i; k < i + 8; k++) { /* without jumps, which nobody could foretell */
                const int there = present[k] != 0;
                numbers[k] = wide_number(from, bytes, bits) & -there;
                from += there * bytes;
            }
        }
    }
    for (; i < count; i++) {
        numbers[i] = present[i] ? wide_number(from, bytes, bits) : 0;
        from += present[i] ? bytes : 0;
    }
}

static inline void spread(PackPlane *plane, const unsigned char *from, int bytes)
{
    const size_t count = (size_t)plane->width * (size_t)plane->rows;
    if (plane->present && plane->bits == 8)
        spread_present(plane->numbers, plane->present, count, from, bytes, 8);
    else if (plane->present)
        spread_present(plane->numbers, plane->present, count, from, bytes, plane->bits);
    else if (plane->bits == 8)
        spread_all(plane->numbers, count, from, bytes, 8);
    else
        spread_all(plane->numbers, count, from, bytes, plane->bits);
}

/* ---- numbers of steps, where they matter ---- */

/* A row of 32 bits; above: the row above and what of it matters, or NULL. Returns the end of its residuals. */
static inline const unsigned char *restore_steps_row(int32_t *n, const unsigned char *present,
                                                     const unsigned char *shift, const int32_t *above,
                                                     const unsigned char *above_present, int width, Predictor predictor,
                                                     const unsigned char *from, int bytes, int32_t *last)
{
    int32_t left = *last;
    int has_left = 0;
    for (int x = 0; x < width; x++) {
        if (!present[x]) {
            n[x] = 0;
            has_left = 0;
            continue;
        }
        const int has_upper = above && above_present[x];
        int32_t guess = left; /* or the last one met */
        if (has_left && has_upper && above_present[x - 1])
            guess = predict(predictor, left, above[x], above[x - 1]);
        else if (predictor == BY_NOTHING)
            guess = 0;
        else if (!has_left && has_upper)
            guess = above[x];
        const int s = shift[x];
        guess = add(guess, (1 << s) >> 1) >> s;
        left = (int32_t)((uint32_t)add(guess, from_unsigned(load(from, bytes))) << s);
        n[x] = left;
        has_left = 1;
        from += bytes;
    }
    *last = left;
    return from;
}

static inline void restore_steps_by(PackPlane *plane, Predictor predictor, const unsigned char *from, int bytes)
{
    const int width = plane->width;
    int32_t last = 0;
    for (int y = 0; y < plane->rows; y++) {
        const size_t row = (size_t)y * (size_t)width;
        const unsigned char *present = plane->present + row;
        int32_t *n = plane->numbers + row;
        from = restore_steps_row(n, present, plane->shift + row, y ? n - width : NULL, y ? present - width : NULL,
                                 width, predictor, from, bytes, &last);
    }
}

static inline void restore_steps(PackPlane *plane, Predictor predictor, const unsigned char *from, int bytes)
{
    switch (predictor) { /* so that the compiler sees each alone */
    case BY_LEFT:
        restore_steps_by(plane, BY_LEFT, from, bytes);
        break;
    case BY_UPPER:
        restore_steps_by(plane, BY_UPPER, from, bytes);
        break;
    case BY_GRADIENT:
        restore_steps_by(plane, BY_GRADIENT, from, bytes);
        break;
    case BY_MEDIAN:
        restore_steps_by(plane, BY_MEDIAN, from, bytes);
        break;
    default:
        restore_steps_by(plane, BY_NOTHING, from, bytes);
    }
}

/* ---- all numbers, of steps of 1 ---- */

/* All numbers of a row but the first, by one predictor: what most of the time goes to. */
static inline void restore_row(int32_t *n, const int32_t *above, Predictor predictor, const unsigned char *from,
                               int bytes, int width, int bits)
{
    int32_t left = n[0];
    for (int x = 1; x < width; x++) {
        const int32_t guess = predict(predictor, left, above[x], above[x - 1]);
        n[x] = left = wrap(add(guess, from_unsigned(load(from + x * bytes, bytes))), bits);
    }
}

/* Where all numbers matter and have steps of 1. */
static void restore_all(PackPlane *plane, Predictor predictor, const unsigned char *from, int bytes)
{
    const int width = plane->width, bits = plane->bits;
    int32_t last = 0;
    for (int y = 0; y < plane->rows; y++) {
        const size_t row = (size_t)y * (size_t)width;
        int32_t *n = plane->numbers + row;
        for (int x = 0; x < (y == 0 ? width : 1); x++) {
            const int32_t guess = predict_at(plane, predictor, row, x, last);
            n[x] = last = wrap(add(guess, from_unsigned(load(from + x * bytes, bytes))), bits);
        }
        if (y > 0 && bytes == 1)
            restore_row(n, n - width, predictor, from, 1, width, bits);
        else if (y > 0 && bytes == 2)
            restore_row(n, n - width, predictor, from, 2, width, bits);
        else if (y > 0)
            restore_row(n, n - width, predictor, from, 4, width, bits);
        from += (size_t)width * (size_t)bytes;
    }
}

void pack_restore(PackPlane *plane, Predictor predictor, const unsigned char *residuals, int bytes)
{
    if (predictor == BY_NOTHING && !plane->shift && bytes == 1)
        spread(plane, residuals, 1);
    else if (predictor == BY_NOTHING && !plane->shift)
        spread(plane, residuals, bytes);
    else if (plane->present && plane->shift && plane->bits == 32 && bytes == 4)
        restore_steps(plane, predictor, residuals, 4);
    else if (plane->present && plane->shift && plane->bits == 32)
        restore_steps(plane, predictor, residuals, bytes);
    else if (plane->present || plane->shift)
        pack_restore_plainly(plane, predictor, residuals, bytes);
    else
        restore_all(plane, predictor, residuals, bytes);
}
