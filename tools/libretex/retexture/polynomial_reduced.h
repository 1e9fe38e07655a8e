/* What is smaller than the picture, made once before its rows. Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_REDUCED_H
#define RETEX_RETEXTURE_POLYNOMIAL_REDUCED_H

#include "retexture/polynomial.h"

/* Fill in those images of footprints, mixtures and gains that have pixels. */
int retex_polynomial_reduced_make(RetexPolynomial *polynomial, int nthreads, RetexError *err);

#endif
