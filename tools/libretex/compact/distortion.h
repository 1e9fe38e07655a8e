/* The distortion of pictures of a compact set, measured with trial textures. Private to libretex. */
#ifndef RETEX_COMPACT_DISTORTION_H
#define RETEX_COMPACT_DISTORTION_H

#include "compact/build.h"

/* Trial pictures: with each trial texture on all targets, and with the originals; then two for each of up to three
 * parts of the lamps, which are off in these. Sets without lamps have only the first ones; others lose 0. */
#define RETEX_COMPACT_TEXTURE_TRIALS (RETEX_COMPACT_WAVES + 1)
#define RETEX_COMPACT_LAMP_PARTS 3
#define RETEX_COMPACT_TRIALS (RETEX_COMPACT_TEXTURE_TRIALS + 2 * RETEX_COMPACT_LAMP_PARTS)
#define RETEX_COMPACT_TILES 16

/* A set, or sample tiles of a large set, with its pictures, which those of compact sets are compared with. */
typedef struct RetexCompactReference {
    RetexSet *set;
    int tile; /* side of a tile in pixels, with margins that do not count; 0: the set is not tiled */
    double weights[RETEX_COMPACT_TILES];       /* how many of the picture's tiles each represents */
    RetexImage pictures[RETEX_COMPACT_TRIALS]; /* sRGB-encoded */
    double noise; /* mean square noise of the picture, from the denoising data; 0 without these */
} RetexCompactReference;

int retex_compact_reference_open(RetexCompactReference *reference, const RetexCompactLight *light, int nthreads,
                                 RetexError *err);
void retex_compact_reference_close(RetexCompactReference *reference);
/* The weight of a row of the tiled set, 0 in margins; and how many columns on each side are margins. */
double retex_compact_row_weight(const RetexCompactReference *reference, int y);
int retex_compact_margin(const RetexCompactReference *reference);

/* Linear pictures of a kind's terms in compact form: see retex_compact_build_kind. light is that of reference->set. */
int retex_compact_trial_pictures(RetexImage pictures[RETEX_COMPACT_TRIALS], const RetexCompactLight *light, int kind,
                                 const RetexCompactScales *scales, RetexCompactCache *cache, int nthreads,
                                 RetexError *err);

/* Mean squared errors of the sums of these pictures, sRGB-encoded, one for each trial. */
int retex_compact_distortions(const RetexCompactReference *reference, const RetexImage *const parts[], int count,
                              double squares[RETEX_COMPACT_TRIALS], int nthreads, RetexError *err);

#endif
