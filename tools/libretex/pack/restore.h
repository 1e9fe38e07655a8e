/* The numbers of planes, as they are predicted from their neighbours, and from their residuals. Private to libretex. */
#ifndef RETEX_PACK_RESTORE_H
#define RETEX_PACK_RESTORE_H

#include "pack/planes.h"

/* How a number is predicted where its left, upper and upper left neighbours matter. At an edge of what matters it is by
 * the left one, else the upper one, else the last one that was met in the row. */
typedef enum RetexPackPredictor {
    BY_NOTHING,
    BY_LEFT,
    BY_UPPER,
    BY_GRADIENT,
    BY_MEDIAN,
    PREDICTORS
} RetexPackPredictor;

/* Signed residuals as unsigned numbers, small ones of either sign as small numbers. */
static inline uint32_t zigzag_encode(int32_t residual)
{
    return ((uint32_t)residual << 1) ^ (uint32_t)(residual >> 31);
}

static inline int32_t zigzag_decode(uint32_t code)
{
    return (int32_t)(code >> 1 ^ (0u - (code & 1)));
}

static inline int32_t add(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a + (uint32_t)b);
}

static inline int32_t subtract(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a - (uint32_t)b);
}

/* The gradient, kept between the left and the upper neighbour. */
static inline int32_t median(int32_t left, int32_t upper, int32_t corner)
{
    const int32_t low = left < upper ? left : upper, high = left < upper ? upper : left;
    return corner >= high ? low : corner <= low ? high : add(left, subtract(upper, corner));
}

static inline int32_t predict(RetexPackPredictor predictor, int32_t left, int32_t upper, int32_t corner)
{
    switch (predictor) {
    case BY_LEFT:
        return left;
    case BY_UPPER:
        return upper;
    case BY_GRADIENT:
        return add(left, subtract(upper, corner));
    case BY_MEDIAN:
        return median(left, upper, corner);
    default:
        return 0;
    }
}

/* Numbers of 8 bits are codes from 0, others have a sign. */
static inline int32_t wrap(int32_t value, int bits)
{
    return bits == 8 ? (uint8_t)value : bits == 16 ? (int16_t)value : value;
}

/* The prediction of number x of the row at `row`, which has one above it unless it is the first. */
static inline int32_t predict_at(const RetexPackPlane *plane, RetexPackPredictor predictor, size_t row, int x,
                                 int32_t last)
{
    const int32_t *n = plane->numbers + row;
    const unsigned char *present = plane->present ? plane->present + row : NULL;
    const ptrdiff_t above = -(ptrdiff_t)plane->width;
    const int left = x > 0 && (!present || present[x - 1]), upper = row > 0 && (!present || present[above + x]);
    if (left && upper && (!present || present[above + x - 1]))
        return predict(predictor, n[x - 1], n[above + x], n[above + x - 1]);
    if (predictor == BY_NOTHING)
        return 0;
    return left ? n[x - 1] : upper ? n[above + x] : last;
}

/* The multiple of 2^shift nearest to it, in those units. */
static inline int32_t in_steps(int32_t number, int shift)
{
    return shift ? add(number, 1 << (shift - 1)) >> shift : number;
}

/* 1 where codes are not 0, else 0. */
void retex_pack_find_present(unsigned char *restrict present, const unsigned char *restrict codes, size_t count);
/* Runs of what is present; runs->run has room for retex_pack_runs_bound. */
void retex_pack_find_runs(RetexPackRuns *runs, const unsigned char *present, int width, int rows);

/* The plane's numbers, or codes, from the residuals of those that matter, each of so many bytes, codes' of one. Those
 * that do not matter are left alone. The second is the reference, which needs no runs, and puts codes too into
 * numbers. */
void retex_pack_restore(const RetexPackPlane *plane, RetexPackPredictor predictor, const unsigned char *residuals,
                        int bytes);
void retex_pack_restore_reference(const RetexPackPlane *plane, RetexPackPredictor predictor,
                                  const unsigned char *residuals, int bytes);

#endif
