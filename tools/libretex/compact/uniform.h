/* Pixels that see one surface uniformly: clusters without noise. Private to libretex. */
#ifndef RETEX_COMPACT_UNIFORM_H
#define RETEX_COMPACT_UNIFORM_H

#include <retex/host/uv_stats.h>

#include "compact/merged.h"

/* Where candidates and their neighbours see a surface uniformly, the clusters are replaced by a whole pixel of a smooth
 * map of the surface. For box pixel filters. noise: above 0, to 1: share of the expected noise that may be removed.
 * pixels[] is overwritten. */
int retex_compact_smooth_uniform(RetexCompactClusters *clusters, RetexUniformPixel *pixels, const int periodic[2],
                                 double noise, int nthreads, RetexError *err);

/* Whole pixels whose axes are not the steps to their neighbours (set/steps.h) become clusters: four quarters, or one if
 * there is no room. */
int retex_compact_split_uneven(RetexCompactClusters *clusters, const int periodic[2], int nthreads, RetexError *err);

#endif
