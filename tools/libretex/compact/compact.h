/* Compacting: the same set in far fewer numbers, for storage. Private to libretex. */
#ifndef RETEX_COMPACT_COMPACT_H
#define RETEX_COMPACT_COMPACT_H

#include "compact/params.h"

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
