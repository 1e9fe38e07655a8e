/* Reduced factors: footprints, mixtures and images that are smaller than the picture, made once before its rows.
 * Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_REDUCED_H
#define RETEX_RETEXTURE_POLYNOMIAL_REDUCED_H

#include "retexture/polynomial_terms.h"

/* Compute the images that are allocated. */
int retex_polynomial_reduced_make(RetexPolynomial *polynomial, int nthreads, RetexError *err);

#endif
