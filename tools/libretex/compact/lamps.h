/* The scales of gains of single lamps. Private to libretex. */
#ifndef RETEX_COMPACT_LAMPS_H
#define RETEX_COMPACT_LAMPS_H

#include "compact/distortion.h"

/* Choose them, after all others: of each lamp the fewest numbers by which its own picture, as bright as that by all
 * lamps but at most 20 times as bright as with its `kept` value, with textures of RETEX_COMPACT_GREY, is off by `bound`
 * at most, a mean squared error of sRGB-encoded colours. light is that of reference->set. */
int retex_compact_lamps_choose(RetexCompactScales *scales, const RetexCompactReference *reference,
                               const RetexCompactLight *light, double bound, int nthreads, RetexError *err);

#endif
