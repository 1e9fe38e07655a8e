/* How small the images of a compact set can be. Private to libretex. */
#ifndef RETEX_COMPACT_SEARCH_H
#define RETEX_COMPACT_SEARCH_H

#include <retex/compact.h>

#include "compact/build.h"

/* As small as params->psnr allows, where params do not say it. */
int retex_compact_search(RetexCompactScales *scales, const RetexCompactLight *light, const RetexCompactParams *params,
                         int nthreads, RetexError *err);

#endif
