/* Linear prediction: a number is predicted as a weighted sum of numbers that are coded before it. Weights are fitted to
 * the strip by least squares. Private to libretex; retex-pack(5) lists the neighbours used. */
#ifndef RETEX_PACK_FIT_H
#define RETEX_PACK_FIT_H

#include <stddef.h>
#include <stdint.h>

enum {
    RETEX_PACK_FIT_OWN = 4,    /* terms from the channel itself */
    RETEX_PACK_FIT_OTHER = 5,  /* terms from each earlier channel */
    RETEX_PACK_FIT_OTHERS = 2, /* most earlier channels used */
    RETEX_PACK_FIT_WEIGHTS = RETEX_PACK_FIT_OWN + RETEX_PACK_FIT_OTHERS * RETEX_PACK_FIT_OTHER,
    RETEX_PACK_FIT_SHIFT = 12 /* weights are fixed-point: units of 1/4096 */
};

/* A channel of a strip while it is coded. Rows have margins, so that all neighbours exist. */
typedef struct RetexPackFitChannel {
    int width, rows;
    int32_t *numbers;     /* holes have the last number before them */
    int32_t *sizes;       /* magnitudes of residuals */
    unsigned char *holes; /* 1: this number is 0 */
    int has_holes, by_fit;
    int32_t mean;
    int nweights;
    int16_t weights[RETEX_PACK_FIT_WEIGHTS];
    const struct RetexPackFitChannel *others[RETEX_PACK_FIT_OTHERS]; /* earlier channels, or NULL */
} RetexPackFitChannel;

enum { RETEX_PACK_FIT_LEFT = 3, RETEX_PACK_FIT_MARGIN = 4 };

static inline ptrdiff_t retex_pack_fit_place(const RetexPackFitChannel *channel, int x, int y)
{
    return (ptrdiff_t)(channel->width + RETEX_PACK_FIT_MARGIN) * y + RETEX_PACK_FIT_LEFT + x;
}

/* Index of the number above; in the first row, the second number to the left is used instead. */
static inline ptrdiff_t retex_pack_fit_above(const RetexPackFitChannel *channel, ptrdiff_t at, int y)
{
    return y > 0 ? at - channel->width - RETEX_PACK_FIT_MARGIN : at - 2;
}

/* The terms that weights multiply: differences between a neighbour and the left neighbour of the same channel. */
static inline void retex_pack_fit_terms(int64_t terms[RETEX_PACK_FIT_WEIGHTS], const RetexPackFitChannel *channel,
                                        ptrdiff_t at, ptrdiff_t above, int nweights)
{
    const int32_t *n = channel->numbers;
    const int64_t left = n[at - 1];
    terms[0] = n[above] - left;
    terms[1] = n[above - 1] - left;
    terms[2] = n[above + 1] - left;
    terms[3] = channel->mean - left;
    terms += RETEX_PACK_FIT_OWN;
    for (int k = 0; RETEX_PACK_FIT_OWN + k * RETEX_PACK_FIT_OTHER < nweights; k++, terms += RETEX_PACK_FIT_OTHER) {
        const int32_t *o = channel->others[k]->numbers;
        const int64_t its = o[at - 1];
        terms[0] = o[at] - its;
        terms[1] = o[above] - its;
        terms[2] = o[above - 1] - its;
        terms[3] = o[above + 1] - its;
        terms[4] = channel->others[k]->mean - its;
    }
}

/* The median predictor of JPEG-LS: left + upper - upper left, clamped between left and upper. */
static inline int64_t retex_pack_fit_median(const int32_t *n, ptrdiff_t at, ptrdiff_t above)
{
    const int64_t left = n[at - 1], upper = n[above], corner = n[above - 1];
    const int64_t low = left < upper ? left : upper, high = left < upper ? upper : left;
    return corner >= high ? low : corner <= low ? high : left + upper - corner;
}

/* Predict with `nweights` weights (a compile-time constant is faster), or with the median predictor if 0. */
static inline int64_t retex_pack_fit_guess_by(const RetexPackFitChannel *channel, ptrdiff_t at, ptrdiff_t above,
                                              int nweights)
{
    int64_t terms[RETEX_PACK_FIT_WEIGHTS], sum = 1 << (RETEX_PACK_FIT_SHIFT - 1);
    if (nweights == 0)
        return retex_pack_fit_median(channel->numbers, at, above);
    retex_pack_fit_terms(terms, channel, at, above, nweights);
#pragma GCC unroll 14
    for (int i = 0; i < nweights; i++)
        sum += channel->weights[i] * terms[i];
    return channel->numbers[at - 1] + (sum >> RETEX_PACK_FIT_SHIFT);
}

static inline int64_t retex_pack_fit_guess(const RetexPackFitChannel *channel, ptrdiff_t at, ptrdiff_t above)
{
    return retex_pack_fit_guess_by(channel, at, above, channel->by_fit ? channel->nweights : 0);
}

/* Fill the margins that coding row y reads: numbers, sizes and holes. Row y - 1 must be complete. */
void retex_pack_fit_begin_row(RetexPackFitChannel *channel, int y);

/* Fit the weights, or choose the median predictor if it is better. shifts: numbers are multiples of 2^shift; or
 * NULL. */
void retex_pack_fit(RetexPackFitChannel *channel, const unsigned char *shifts);

#endif
