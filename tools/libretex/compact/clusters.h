/* Clusters of blocks of pixels. Private to libretex. */
#ifndef RETEX_COMPACT_CLUSTERS_H
#define RETEX_COMPACT_CLUSTERS_H

#include <retex/host/uv_stats.h>

#include "compact/light.h"
#include "compact/merged.h"

/* Merge the clusters of each block, weighted by light, into at most as many as the kind has in a pixel. Blocks without
 * light copy the clusters of a neighbour, because enlarging interpolates between them. Interreflected light has weights
 * of its own on sharp footprints, where textures show every detail, and on broad ones where no noise may be removed.
 * That is done in strips of rows: light->set has rows of the picture from `first` on, a multiple of the scale except at
 * the end. */
int retex_compact_clusters_begin(RetexCompactClusters *clusters, const RetexCompactLight *light,
                                 const RetexCompactKind *kind, int scale, RetexError *err);
void retex_compact_clusters_rows(RetexCompactClusters *clusters, const RetexCompactLight *light,
                                 const RetexCompactKind *kind, int first, int nthreads);
int retex_compact_clusters_end(RetexCompactClusters *clusters, const RetexCompactLight *light,
                               const RetexCompactKind *kind, int nthreads, RetexError *err);
void retex_compact_clusters_free(RetexCompactClusters *clusters);

#endif
