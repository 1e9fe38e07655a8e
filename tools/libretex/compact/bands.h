/* A set, one band of rows after the other, so that it need not fit into memory. Private to libretex. */
#ifndef RETEX_COMPACT_BANDS_H
#define RETEX_COMPACT_BANDS_H

#include "compact/light.h"

#define RETEX_COMPACT_BAND_ROWS 64 /* a multiple of all scales, and of a tile of distortion.c */

/* Process a band of light->set->height rows; first: the picture's row of its first row. The band has rows of the parts
 * of the picture's size only. */
typedef int RetexCompactBandJob(void *context, const RetexCompactLight *light, int first, RetexError *err);

/* Call job for all bands, in order. */
int retex_compact_bands(const RetexCompactLight *light, RetexCompactBandJob *job, void *context, int nthreads,
                        RetexError *err);

#endif
