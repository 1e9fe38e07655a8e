/* Pictures that a polynomial gives, in bands of RETEX_PICTURE_BAND rows on all cores; nothing of the picture's size is
 * in memory. Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_BANDS_H
#define RETEX_RETEXTURE_POLYNOMIAL_BANDS_H

#include "retexture/polynomial.h"

/* Makes rows y0 <= y < y1 of the picture, RGB interleaved, by a row that is this call's alone. */
typedef int RetexPolynomialBand(const void *context, RetexPolynomialRow *row, int y0, int y1, float *rgb,
                                RetexError *err);

/* Rows y0 <= y < y1, made and given to the sink. */
int retex_polynomial_bands(const RetexPolynomial *polynomial, int y0, int y1, RetexPolynomialBand *make,
                           const void *context, RetexRowSink *sink, void *sink_context, int nthreads, RetexError *err);

#endif
