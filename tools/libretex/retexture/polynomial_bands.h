/* Computes a picture from a polynomial in bands of RETEX_PICTURE_BAND rows, on all threads. The picture is never
 * complete in memory. Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_BANDS_H
#define RETEX_RETEXTURE_POLYNOMIAL_BANDS_H

#include "retexture/polynomial.h"

/* Computes rows y0 <= y < y1 of the picture, RGB interleaved. `row` belongs to this call alone. */
typedef int RetexPolynomialBand(const void *context, RetexPolynomialRow *row, int y0, int y1, float *rgb,
                                RetexError *err);

/* Compute rows y0 <= y < y1 and give them to the sink. */
int retex_polynomial_bands(const RetexPolynomial *polynomial, int y0, int y1, RetexPolynomialBand *make,
                           const void *context, RetexRowSink *sink, void *sink_context, int nthreads, RetexError *err);

#endif
