/* Clusters of blocks of pixels. Private to libretex. */
#ifndef RETEX_COMPACT_CLUSTERS_H
#define RETEX_COMPACT_CLUSTERS_H

#include <retex/uv_stats.h>

#include "compact/light.h"

/* Footprints of a kind at a scale: one pixel for a block of scale x scale of the picture's. */
typedef struct RetexCompactClusters {
    int count;
    RetexImage uv[RETEX_SHARES_MAX], spread[RETEX_SHARES_MAX];
    RetexImage weight[RETEX_SHARES_MAX]; /* in all light, or, where there is `again`, in that which meets no other */
    RetexImage interreflected[RETEX_SHARES_MAX]; /* in light that goes on; unallocated where not wanted */
    RetexImage albedo;                           /* of all of them */
    int scale, split;
    unsigned char *lit;               /* while they are made: blocks that have any; */
    struct RetexUniformPixel *pixels; /* what pixels see, where that may be a surface evenly (uniform.h); or NULL */
} RetexCompactClusters;

/* Merge the clusters of each block into no more than the kind has in a pixel, by the light they weigh. Blocks without
 * light take the clusters of a neighbour, for enlarging reaches as far. Interreflected light has weights of its own on
 * sharp footprints, where textures show every letter, and on broad ones where no noise may be removed. */
int retex_compact_clusters_make(RetexCompactClusters *clusters, const RetexCompactLight *light,
                                const RetexCompactKind *kind, int scale, int nthreads, RetexError *err);
/* The same by rows of the picture, `first` and as many as light->set has, a multiple of the scale but for the last. */
int retex_compact_clusters_begin(RetexCompactClusters *clusters, const RetexCompactLight *light,
                                 const RetexCompactKind *kind, int scale, RetexError *err);
void retex_compact_clusters_rows(RetexCompactClusters *clusters, const RetexCompactLight *light,
                                 const RetexCompactKind *kind, int first, int nthreads);
int retex_compact_clusters_end(RetexCompactClusters *clusters, const RetexCompactLight *light,
                               const RetexCompactKind *kind, int nthreads, RetexError *err);
void retex_compact_clusters_free(RetexCompactClusters *clusters);

#endif
