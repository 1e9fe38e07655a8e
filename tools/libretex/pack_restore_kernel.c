/* See pack_restore.h. Most planes are of codes that nothing predicts: those only have to be spread over the pixels
 * where they matter, run by run. Of the others the prediction is chosen once a plane. */
#include "pack_restore.h"

#include <string.h>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

void pack_find_present(unsigned char *restrict present, const int32_t *restrict numbers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        present[i] = numbers[i] != 0;
}

void pack_find_runs(PackRuns *runs, const unsigned char *present, int width, int rows)
{
    int count = 0;
    runs->pixels = 0;
    runs->first[0] = 0;
    for (int y = 0; y < rows; y++, present += width) {
        for (int end = 0; end < width;) {
            const unsigned char *begin = memchr(present + end, 1, (size_t)(width - end));
            if (!begin)
                break;
            const unsigned char *after = memchr(begin, 0, (size_t)(width - (begin - present)));
            end = after ? (int)(after - present) : width;
            runs->run[count++] = (PackRun){(int)(begin - present), end};
            runs->pixels += (size_t)(end - runs->run[count - 1].begin);
        }
        runs->first[y + 1] = count;
    }
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
            if (plane->present && !plane->present[row + (size_t)x])
                continue;
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

/* By runs where not all matter. */
static inline void spread(PackPlane *plane, const unsigned char *from, int bytes, int bits)
{
    const size_t width = (size_t)plane->width;
    if (!plane->present)
        spread_all(plane->numbers, width * (size_t)plane->rows, from, bytes, bits);
    for (size_t y = 0; plane->present && y < (size_t)plane->rows; y++)
        for (int k = plane->runs->first[y]; k < plane->runs->first[y + 1]; k++) {
            const PackRun run = plane->runs->run[k];
            const size_t count = (size_t)(run.end - run.begin);
            spread_all(plane->numbers + y * width + run.begin, count, from, bytes, bits);
            from += count * (size_t)bytes;
        }
}

/* ---- predicted, where they matter ---- */

/* How one number becomes the next: with shift, in steps. */
static inline int32_t step(int32_t guess, int shift, const unsigned char *from, int bytes, int bits)
{
    guess = add(guess, (1 << shift) >> 1) >> shift;
    return wrap((int32_t)((uint32_t)add(guess, from_unsigned(load(from, bytes))) << shift), bits);
}

/* A run of a row; above: the row above and what of it matters, or NULL. Returns the end of its residuals. */
static inline const unsigned char *restore_run(int32_t *n, PackRun run, const unsigned char *shift,
                                               const int32_t *above, const unsigned char *above_present,
                                               Predictor predictor, const unsigned char *from, int bytes, int bits,
                                               int32_t *last)
{
    int x = run.begin, has_corner = above && above_present[x];
    int32_t guess = predictor == BY_NOTHING ? 0 : has_corner ? above[x] : *last;
    int32_t left = n[x] = step(guess, shift ? shift[x] : 0, from, bytes, bits);
    for (x++, from += bytes; x < run.end; x++, from += bytes) {
        const int has_upper = above && above_present[x];
        guess = predictor == BY_NOTHING ? 0 : left;
        if (has_upper && has_corner)
            guess = predict(predictor, left, above[x], above[x - 1]);
        n[x] = left = step(guess, shift ? shift[x] : 0, from, bytes, bits);
        has_corner = has_upper;
    }
    *last = left;
    return from;
}

static inline void restore_runs_by(PackPlane *plane, Predictor predictor, const unsigned char *shift,
                                   const unsigned char *from, int bytes, int bits)
{
    const size_t width = (size_t)plane->width;
    int32_t last = 0;
    for (size_t y = 0; y < (size_t)plane->rows; y++) {
        const unsigned char *present = plane->present + y * width;
        int32_t *n = plane->numbers + y * width;
        for (int k = plane->runs->first[y]; k < plane->runs->first[y + 1]; k++)
            from = restore_run(n, plane->runs->run[k], shift ? shift + y * width : NULL, y ? n - width : NULL,
                               y ? present - width : NULL, predictor, from, bytes, bits, &last);
    }
}

static inline void restore_runs(PackPlane *plane, Predictor predictor, const unsigned char *shift,
                                const unsigned char *from, int bytes, int bits)
{
    switch (predictor) { /* so that the compiler sees each alone */
    case BY_LEFT:
        restore_runs_by(plane, BY_LEFT, shift, from, bytes, bits);
        break;
    case BY_UPPER:
        restore_runs_by(plane, BY_UPPER, shift, from, bytes, bits);
        break;
    case BY_GRADIENT:
        restore_runs_by(plane, BY_GRADIENT, shift, from, bytes, bits);
        break;
    case BY_MEDIAN:
        restore_runs_by(plane, BY_MEDIAN, shift, from, bytes, bits);
        break;
    default:
        restore_runs_by(plane, BY_NOTHING, shift, from, bytes, bits);
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
    const int bits = plane->bits;
    if (predictor == BY_NOTHING && !plane->shift && bytes == 1 && bits == 8)
        spread(plane, residuals, 1, 8);
    else if (predictor == BY_NOTHING && !plane->shift)
        spread(plane, residuals, bytes, bits);
    else if (plane->present && plane->shift && bits == 32 && bytes == 4)
        restore_runs(plane, predictor, plane->shift, residuals, 4, 32);
    else if (plane->present && plane->shift)
        restore_runs(plane, predictor, plane->shift, residuals, bytes, bits);
    else if (plane->present && bits == 8 && bytes == 1)
        restore_runs(plane, predictor, NULL, residuals, 1, 8);
    else if (plane->present)
        restore_runs(plane, predictor, NULL, residuals, bytes, bits);
    else if (plane->shift)
        pack_restore_plainly(plane, predictor, residuals, bytes);
    else
        restore_all(plane, predictor, residuals, bytes);
}
