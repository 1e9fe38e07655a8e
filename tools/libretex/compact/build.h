/* Putting a compact set together. Private to libretex. */
#ifndef RETEX_COMPACT_BUILD_H
#define RETEX_COMPACT_BUILD_H

#include "compact/clusters.h"
#include "compact/light.h"

#define COMPACT_STEPS 4 /* scales: 1, 2, 4, 8 */
#define COMPACT_WAVES 5 /* textures of waves that trials put on targets: of three lengths, and two of one colour */

/* How much smaller than the picture the images of each kind are. */
typedef struct CompactScales {
    int clusters[COMPACT_KINDS]; /* footprints and weights; those of later ones must be the same */
    int gains[COMPACT_KINDS];
    CompactMixed mixed[COMPACT_KINDS];
} CompactScales;

int compact_build(RetexSet **result, const CompactLight *light, const CompactScales *scales, int nthreads,
                  RetexError *err);

/* What trials of the same light have in common: clusters by kind and scale (its logarithm), with their waves
 * (meter.h); sums of light by kind; gains by kind, scale and place among its terms, 0 for the clusters alone.
 * Begin with {0}. */
typedef struct CompactCache {
    CompactClusters clusters[COMPACT_KINDS][COMPACT_STEPS];
    RetexImage waves[COMPACT_KINDS][COMPACT_STEPS][COMPACT_WAVES][RETEX_SHARES_MAX];
    RetexImage sums[COMPACT_KINDS];
    RetexImage *gains[COMPACT_KINDS][COMPACT_STEPS][COMPACT_CHOICES];
} CompactCache;
void compact_cache_free(CompactCache *cache, const CompactLight *light);

/* The terms of one kind alone, with what they need, or, kind -1, those without factors. of: for each footprint its
 * clusters' waves in the cache, still to be made where they are unallocated. */
int compact_build_kind(RetexSet **result, RetexImage *of[][COMPACT_WAVES], const CompactLight *light, int kind,
                       const CompactScales *scales, CompactCache *cache, int nthreads, RetexError *err);

/* Everything but what only denoising reads. */
int compact_copy_set(RetexSet **copy, const RetexSet *set, RetexError *err);
/* A new set with all that another says of itself, and no parts. */
int compact_copy_head(RetexSet **copy, const RetexSet *set, RetexError *err);
int compact_copy_part(RetexSet *set, const RetexSet *from, int part, int *index, RetexError *err);

#endif
