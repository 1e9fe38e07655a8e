/* Putting a compact set together. Private to libretex. */
#ifndef RETEX_COMPACT_BUILD_H
#define RETEX_COMPACT_BUILD_H

#include "compact/clusters.h"
#include "compact/light.h"

#define RETEX_COMPACT_STEPS 4 /* scales: 1, 2, 4, 8 */
#define RETEX_COMPACT_WAVES                                                                                            \
    5 /* textures of waves that trials put on targets: of three lengths, and two of one colour */

/* How much smaller than the picture the images of each kind are. */
typedef struct RetexCompactScales {
    int clusters[RETEX_COMPACT_KINDS]; /* footprints and weights; those of later ones must be the same */
    int gains[RETEX_COMPACT_KINDS];
    RetexCompactMixed mixed[RETEX_COMPACT_KINDS];
} RetexCompactScales;

int retex_compact_build(RetexSet **result, const RetexCompactLight *light, const RetexCompactScales *scales,
                        int nthreads, RetexError *err);

/* What trials of the same light have in common: clusters by kind and scale (its logarithm), with their waves
 * (distortion.h); sums of light by kind; gains by kind, scale and place among its terms, 0 for the clusters alone.
 * Begin with {0}. */
typedef struct RetexCompactCache {
    RetexCompactClusters clusters[RETEX_COMPACT_KINDS][RETEX_COMPACT_STEPS];
    RetexImage waves[RETEX_COMPACT_KINDS][RETEX_COMPACT_STEPS][RETEX_COMPACT_WAVES][RETEX_SHARES_MAX];
    RetexImage sums[RETEX_COMPACT_KINDS];
    RetexImage *gains[RETEX_COMPACT_KINDS][RETEX_COMPACT_STEPS][RETEX_COMPACT_CHOICES];
} RetexCompactCache;
void retex_compact_cache_free(RetexCompactCache *cache, const RetexCompactLight *light);

/* The terms of one kind alone, with what they need, or, kind -1, those without factors. of: for each footprint its
 * clusters' waves in the cache, still to be made where they are unallocated. */
int retex_compact_build_kind(RetexSet **result, RetexImage *of[][RETEX_COMPACT_WAVES], const RetexCompactLight *light,
                             int kind, const RetexCompactScales *scales, RetexCompactCache *cache, int nthreads,
                             RetexError *err);

/* Everything but what only denoising reads. */
int retex_compact_copy_set(RetexSet **copy, const RetexSet *set, RetexError *err);
/* A new set with all that another says of itself, and no parts. */
int retex_compact_copy_head(RetexSet **copy, const RetexSet *set, RetexError *err);
int retex_compact_copy_part(RetexSet *set, const RetexSet *from, int part, int *index, RetexError *err);

#endif
