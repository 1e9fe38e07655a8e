/* Compacting: the same set in far fewer numbers, for storage. Private to libretex. */
#ifndef RETEX_COMPACT_COMPACT_H
#define RETEX_COMPACT_COMPACT_H

#include <retex/set.h>

/* Begin with RETEX_COMPACT_INIT. */
typedef struct RetexCompactParams {
    double psnr; /* dB, 20 to 120: what pictures of the compact set should have at least against the set's own, measured
                    as retex_metrics does it, but in part of the set and with waves for textures, and not counting noise
                    that averages away; default 55 */
    int broad;   /* How many times smaller than the picture broad footprints are, 1, 2, 4 or 8, */
    int interreflection; /* later ones, */
    int gain;            /* and gains. 0, the default: as many times as psnr allows. */
    double noise; /* 0 to 1: how freely noise of the set is taken away, by which pictures of the compact set differ from
                     the set's more than by psnr, but not from the truth; default 1 */
    double lamps; /* dB: the same of pictures by one lamp, looked at as brightly as the whole; default 0: some less than
                     psnr */
    RetexWarn *warn; /* told, in the calling thread, why a set of layout footprints stays as it is; NULL = nobody */
    void *warn_context;
} RetexCompactParams;
#define RETEX_COMPACT_INIT { 55, 0, 0, 0, 1, 0, NULL, NULL }

/* *compact is created: the set without what only denoising reads. In layout footprints, for each target and kind of
 * cluster, sharp and broad, all light is one image, what it would be if further hits met a texture of 0.6 everywhere;
 * a gain for each of few terms says what share of it is theirs, and a mixture which share is which cluster's. Clusters
 * that no texture tells apart are merged, those of pixels that see a surface evenly are made without noise, footprints
 * are of the picture's size only where they are sharp, and one image of albedo serves all footprints of a kind.
 * Light of single lamps is gains of all light, and their pictures are left out. Sets of
 * other layouts, and those that are compact already, come out as they are. Corrections are rounded to coarser steps in
 * all of them, or left out where psnr is below 45, and no term is of role PICTURE. Output is the same to the bit for
 * every nthreads. */
int retex_set_compact(RetexSet **compact, const RetexSet *set, const RetexCompactParams *params /* NULL = defaults */,
                      int nthreads /* 0 = all cores */, RetexError *err);

#endif
