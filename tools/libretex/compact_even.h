/* Pixels that see one surface evenly. Private to libretex. */
#ifndef RETEX_LIBRETEX_COMPACT_EVEN_H
#define RETEX_LIBRETEX_COMPACT_EVEN_H

#include <retex/uv_stats.h>

#include "compact_clusters.h"

/* Whether clusters, of one pixel and box filter, may be even parts of one place, with their sum then. */
int compact_even_sum(UvStats *sum, const UvStats *const parts[], int count, const int periodic[2]);

/* Where pixels and those around them see a surface evenly, as whole[] holds their sums, weight 0 where they do not:
 * clusters become those of the surface's map, one or the four quarters of the pixel, without noise. */
int compact_even_smooth(CompactClusters *clusters, const UvStats *whole, const int periodic[2], int nthreads,
                        RetexError *err);

#endif
