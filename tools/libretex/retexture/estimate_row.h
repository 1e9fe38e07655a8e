/* The expected error of one row of a retexture: the formula of estimate.c. Private to libretex. */
#ifndef RETEX_RETEXTURE_ESTIMATE_ROW_H
#define RETEX_RETEXTURE_ESTIMATE_ROW_H

#include "retexture/polynomial.h"

/* Number of scratch floats that a set needs. */
size_t retex_estimate_scratch(const RetexSet *set);

/* Compute row y of the error, RGB interleaved. row: row y of a polynomial opened with apart = 1. variances: by
 * footprint the variance of its texture, RGB, at the footprint's own size; NULL: 0. means: the same of its colour; only
 * read where the texture has a map of finishes. */
int retex_estimate_row(const RetexPolynomialRow *row, int y, const float *const *variances, const float *const *means,
                       float *scratch, float *out, RetexError *err);

#endif
