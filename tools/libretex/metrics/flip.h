/* The FLIP error map. Private to libretex. */
#ifndef RETEX_METRICS_FLIP_H
#define RETEX_METRICS_FLIP_H

#include <retex/image.h>

/* map (1 channel, unallocated) = FLIP of two scene-linear Rec.709 pictures of 3 channels and one size, clipped to
 * [0,1], seen at 67 pixels a degree; 0 = no difference, 1 = the largest. A sample that is not finite in either counts
 * as 0 in both. */
int retex_flip_map(RetexImage *map, const RetexImage *image, const RetexImage *reference, int nthreads,
                   RetexError *err);

#endif
