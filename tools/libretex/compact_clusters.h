/* Clusters of blocks of pixels. Private to libretex. */
#ifndef RETEX_LIBRETEX_COMPACT_CLUSTERS_H
#define RETEX_LIBRETEX_COMPACT_CLUSTERS_H

#include "compact_light.h"

/* Footprints of a kind at a scale: one pixel for a block of scale x scale of the picture's. */
typedef struct CompactClusters {
    int count;
    RetexImage uv[RETEX_SHARES_MAX], spread[RETEX_SHARES_MAX], weight[RETEX_SHARES_MAX];
    RetexImage albedo; /* of all of them */
} CompactClusters;

/* Merge the clusters of each block into no more than the kind has in a pixel, by the light they weigh. Blocks without
 * light take the clusters of a neighbour, for enlarging reaches as far. */
int compact_clusters_make(CompactClusters *clusters, const CompactLight *light, const CompactKind *kind, int scale,
                          int nthreads, RetexError *err);
void compact_clusters_free(CompactClusters *clusters);

#endif
