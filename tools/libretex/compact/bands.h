/* A set a band of rows at a time, so that not all of it has to be in memory. Private to libretex. */
#ifndef RETEX_COMPACT_BANDS_H
#define RETEX_COMPACT_BANDS_H

#include "compact/light.h"

#define RETEX_COMPACT_BAND_ROWS 64 /* a multiple of all scales, and of a tile of distortion.c */

/* Light of a band, which has as many rows as light->set->height says; first: the picture's row that it begins with.
 * Of parts that are no larger or smaller than the picture it has the rows, of others nothing. */
typedef int RetexCompactBandJob(void *context, const RetexCompactLight *light, int first, RetexError *err);

/* From the first row to the last, one after the other. */
int retex_compact_bands(const RetexCompactLight *light, RetexCompactBandJob *job, void *context, int nthreads,
                        RetexError *err);

#endif
