/* Choosing the scales of a compact set. Private to libretex. */
#ifndef RETEX_COMPACT_CHOOSE_H
#define RETEX_COMPACT_CHOOSE_H

#include "compact/params.h"
#include "compact/scales.h"

/* Choose all: the coarsest of each image that loses at most what the parameters allow (detail.h); those that they fix
 * are kept. The caller frees scales->lamps. */
int retex_compact_choose(RetexCompactScales *scales, const RetexCompactLight *light, const RetexCompactParams *params,
                         int nthreads, RetexError *err);

#endif
