/* Pixels that see one surface uniformly: clusters without noise. Private to libretex. */
#ifndef RETEX_COMPACT_UNIFORM_H
#define RETEX_COMPACT_UNIFORM_H

#include <retex/host/uv_stats.h>

#include "compact/clusters.h"

/* All clusters of a pixel merged: mean UV, variances uu, uv and vv, and the effective number of samples, 0 where the
 * pixel is not a candidate. */
typedef struct RetexUniformPixel {
    double mean[2];
    float variances[3], samples;
} RetexUniformPixel;

/* Where pixels and their neighbours see a surface uniformly, the clusters are replaced by those of a smooth map of the
 * surface: one for the whole pixel, or its four quarters. For box pixel filters. noise: above 0, to 1: share of the
 * expected noise that may be removed. pixels[] is overwritten. */
int retex_compact_smooth_uniform(RetexCompactClusters *clusters, RetexUniformPixel *pixels, const int periodic[2],
                                 double noise, int nthreads, RetexError *err);

#endif
