/* Reduced images: footprints, mixtures and gains that are smaller than the picture, made once before its rows. Private
 * to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_REDUCED_H
#define RETEX_RETEXTURE_POLYNOMIAL_REDUCED_H

#include "retexture/polynomial.h"

/* Compute the allocated images of footprints, mixtures and gains. */
int retex_polynomial_reduced_make(RetexPolynomial *polynomial, int nthreads, RetexError *err);

#endif
