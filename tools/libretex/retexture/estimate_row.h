/* The error to be expected of one row of a retexture: the formula of estimate.c. Private to libretex. */
#ifndef RETEX_RETEXTURE_ESTIMATE_ROW_H
#define RETEX_RETEXTURE_ESTIMATE_ROW_H

#include "retexture/polynomial.h"

/* Numbers of scratch for a set. */
size_t estimate_scratch(const RetexSet *set);

/* Row y, RGB interleaved, into out: of a row of a polynomial whose terms are apart, made for that y. variances: of each
 * footprint how far its texture scatters there, RGB, at the footprint's own size, or NULL: not at all. */
int estimate_row(const PolynomialRow *row, int y, const float *const *variances, float *scratch, float *out,
                 RetexError *err);

#endif
