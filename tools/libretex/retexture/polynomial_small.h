/* What is smaller than the picture, made once before its rows. Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_SMALL_H
#define RETEX_RETEXTURE_POLYNOMIAL_SMALL_H

#include "retexture/polynomial.h"

/* Fill in those images of footprints, mixtures and gains that have pixels. */
int small_images_make(Polynomial *polynomial, int nthreads, RetexError *err);

#endif
