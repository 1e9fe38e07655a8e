/* Building a compact set with given scales. Private to libretex. */
#ifndef RETEX_COMPACT_BUILD_H
#define RETEX_COMPACT_BUILD_H

#include "compact/clusters.h"
#include "compact/scales.h"

#define RETEX_COMPACT_WAVES 5 /* trial textures: waves of three lengths, and two flat colours */

int retex_compact_build(RetexSet **result, const RetexCompactLight *light, const RetexCompactScales *scales,
                        int nthreads, RetexError *err);

/* Results that trials of the same light share: clusters by kind and scale (its logarithm), with their trial textures
 * (distortion.h); sums of light by kind and lamps; gains by kind, scale and term (gains.h). Start with {0}. */
typedef struct RetexCompactCache {
    RetexCompactClusters clusters[RETEX_COMPACT_KINDS][RETEX_COMPACT_STEPS];
    RetexImage waves[RETEX_COMPACT_KINDS][RETEX_COMPACT_STEPS][RETEX_COMPACT_WAVES][RETEX_SHARES_MAX];
    RetexImage *sums[RETEX_COMPACT_KINDS];
    RetexImage *gains[RETEX_COMPACT_KINDS][RETEX_COMPACT_STEPS][RETEX_COMPACT_CHOICES];
} RetexCompactCache;
void retex_compact_cache_free(RetexCompactCache *cache, const RetexCompactLight *light);

/* A set of one kind's terms and footprints; kind -1: of the terms without factors. of: for each footprint, its trial
 * textures in the cache, unallocated where they are not made yet. */
int retex_compact_build_kind(RetexSet **result, RetexImage *of[][RETEX_COMPACT_WAVES], const RetexCompactLight *light,
                             int kind, const RetexCompactScales *scales, RetexCompactCache *cache, int nthreads,
                             RetexError *err);

/* Copy footprints, mixtures and terms of a set whose parts have the same numbers; but not the term of role PICTURE, as
 * what is stored with losses is no longer the sum that part 0 stands for. */
int retex_compact_copy_terms(RetexSet *copy, const RetexSet *set, RetexError *err);
/* A copy of a set without the denoising data. */
int retex_compact_copy_set(RetexSet **copy, const RetexSet *set, RetexError *err);
/* A copy of a set's properties, without parts, footprints, mixtures and terms. */
int retex_compact_copy_head(RetexSet **copy, const RetexSet *set, RetexError *err);
int retex_compact_copy_part(RetexSet *set, const RetexSet *from, int part, int *index, RetexError *err);

#endif
