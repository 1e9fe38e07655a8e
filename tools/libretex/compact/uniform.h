/* Pixels that see one surface evenly. Private to libretex. */
#ifndef RETEX_COMPACT_UNIFORM_H
#define RETEX_COMPACT_UNIFORM_H

#include <retex/uv_stats.h>

#include "compact/clusters.h"

/* What a pixel sees, as one place: its mean UV, the variances uu, uv and vv, and how many samples of equal light tell
 * as much; 0 where it is not to be looked at. */
typedef struct RetexUniformPixel {
    double mean[2];
    float variances[3], samples;
} RetexUniformPixel;

/* Where pixels and those around them see a surface evenly, as whole[] tells: clusters become those of the surface's
 * map, one or the four quarters of the pixel, without noise. The filter is a box. noise: above 0, to 1,
 * of what chance lets expect, how far they may be off. whole[] is used up. */
int retex_compact_smooth_uniform(RetexCompactClusters *clusters, RetexUniformPixel *pixels, const int periodic[2],
                                 double noise, int nthreads, RetexError *err);

#endif
