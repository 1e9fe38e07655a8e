/* What pictures of a compact set lose, measured. Private to libretex. */
#ifndef RETEX_COMPACT_DISTORTION_H
#define RETEX_COMPACT_DISTORTION_H

#include "compact/build.h"

#define RETEX_COMPACT_TRIALS                                                                                           \
    (RETEX_COMPACT_WAVES + 1) /* pictures: with waves or one colour on all targets, and the originals */
#define RETEX_COMPACT_TILES 16

/* A set, or tiles of it where it is large, with its pictures. */
typedef struct RetexCompactReference {
    RetexSet *set;
    int tile; /* pixels of a tile's side, with margins that do not count; 0: the set is whole */
    double weights[RETEX_COMPACT_TILES];       /* how many of the picture's tiles each stands for */
    RetexImage pictures[RETEX_COMPACT_TRIALS]; /* sRGB-encoded */
    double noise; /* of the picture, mean square, by what denoising reads; 0 where that is not there */
} RetexCompactReference;

int retex_compact_reference_open(RetexCompactReference *reference, const RetexCompactLight *light, int nthreads,
                                 RetexError *err);
void retex_compact_reference_close(RetexCompactReference *reference);

/* Pictures, linear, of a kind's terms in compact form: see retex_compact_build_kind. Light is of reference->set. */
int retex_compact_trial_pictures(RetexImage pictures[RETEX_COMPACT_TRIALS], const RetexCompactLight *light, int kind,
                                 const RetexCompactScales *scales, RetexCompactCache *cache, int nthreads,
                                 RetexError *err);

/* Mean squared differences of the pictures that parts of light add up to, sRGB-encoded. */
int retex_compact_distortions(const RetexCompactReference *reference, const RetexImage *const parts[], int count,
                              double squares[RETEX_COMPACT_TRIALS], int nthreads, RetexError *err);

#endif
