/* Computes a picture from a polynomial in strips of RETEX_PICTURE_STRIP rows, on all threads. The picture is never
 * complete in memory. Private to libretex. */
#ifndef RETEX_RETEXTURE_POLYNOMIAL_STRIPS_H
#define RETEX_RETEXTURE_POLYNOMIAL_STRIPS_H

#include "retexture/polynomial.h"

/* Computes rows y0 <= y < y1 of the picture, RGB interleaved. `row` belongs to this call alone. */
typedef int RetexPolynomialStrip(const void *context, RetexPolynomialRow *row, int y0, int y1, float *rgb,
                                 RetexError *err);

/* Compute rows y0 <= y < y1 and give them to the sink. */
int retex_polynomial_strips(const RetexPolynomial *polynomial, int y0, int y1, RetexPolynomialStrip *make,
                            const void *context, RetexRowSink *sink, void *sink_context, int nthreads, RetexError *err);

#endif
