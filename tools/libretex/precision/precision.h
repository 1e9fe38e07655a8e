/* How precisely the numbers of a set are stored: each to a fraction of what it is known to. Private to libretex.
 *
 * What a number is known to follows from the noise of the light that it multiplies: of what light has on average at so
 * many samples, and of what the set's noise parts tell of the pixel (see <retex/host/denoise_data.h>). Nothing but a
 * pixel's own numbers counts, so that a part of a picture is that part of the whole. Where a signal has no noise in the
 * pixel its light is left as it is. Where the set has no noise parts, every number gets its finest step.
 */
#ifndef RETEX_SET_PRECISION_H
#define RETEX_SET_PRECISION_H

#include <retex/set.h>

/* Which numbers of a set are of which kind. */
typedef struct RetexPrecision RetexPrecision;

/* remaining: the share of the noise in the noise parts that the light still has: 1, or less after denoising. */
int retex_precision_open(RetexPrecision **precision, const RetexSet *set, double remaining, RetexError *err);
void retex_precision_close(RetexPrecision **precision); /* NULL and pointers to NULL are fine */

/* Round the pixels of roi in a set of the same parts, which are in memory. The set may be some rows of the whole. The
 * same for every nthreads. */
int retex_precision_round(const RetexPrecision *precision, RetexSet *rows, const RetexRoi *roi, int nthreads,
                          RetexError *err);

#endif
