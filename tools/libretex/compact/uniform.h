/* Pixels that see one surface uniformly: clusters without noise. Private to libretex. */
#ifndef RETEX_COMPACT_UNIFORM_H
#define RETEX_COMPACT_UNIFORM_H

#include <retex/host/uv_stats.h>

#include "compact/clusters.h"

/* A pixel as the footprint of whole pixels may have it: all its clusters merged, mean UV, variances uu, uv and vv, and
 * the effective number of samples. 0: it is no candidate; RETEX_UNIFORM_EXACT: the set says that it is a parallelogram,
 * and the footprint has it already. */
typedef struct RetexUniformPixel {
    double mean[2];
    float variances[3], samples;
} RetexUniformPixel;
#define RETEX_UNIFORM_EXACT 1e9f

/* Where candidates and their neighbours see a surface uniformly, the clusters are replaced by a whole pixel of a smooth
 * map of the surface. For box pixel filters. noise: above 0, to 1: share of the expected noise that may be removed.
 * pixels[] is overwritten. */
int retex_compact_smooth_uniform(RetexCompactClusters *clusters, RetexUniformPixel *pixels, const int periodic[2],
                                 double noise, int nthreads, RetexError *err);

/* Whole pixels whose axes are not the steps to their neighbours (set/steps.h) become clusters: four quarters, or one if
 * there is no room. */
int retex_compact_split_uneven(RetexCompactClusters *clusters, const int periodic[2], int nthreads, RetexError *err);

#endif
