/* The error to be expected of one row of a retexture: the formula of estimate.c. Private to libretex. */
#ifndef RETEX_RETEXTURE_ESTIMATE_ROW_H
#define RETEX_RETEXTURE_ESTIMATE_ROW_H

#include "retexture/polynomial.h"

/* Numbers of scratch for a set. */
size_t retex_estimate_scratch(const RetexSet *set);

/* Row y, RGB interleaved, into out: of a row of a polynomial whose terms are apart, made for that y. variances: of each
 * footprint how far its texture scatters there, RGB, at the footprint's own size, or NULL: not at all. */
int retex_estimate_row(const RetexPolynomialRow *row, int y, const float *const *variances, float *scratch, float *out,
                       RetexError *err);

#endif
