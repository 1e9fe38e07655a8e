/* The rate-distortion search for the scales of a compact set. Private to libretex. */
#ifndef RETEX_COMPACT_SEARCH_H
#define RETEX_COMPACT_SEARCH_H

#include "compact/build.h"
#include "compact/params.h"

/* The scales with the lowest rate at params->psnr; scales that params fix are kept. */
int retex_compact_search(RetexCompactScales *scales, const RetexCompactLight *light, const RetexCompactParams *params,
                         int nthreads, RetexError *err);

#endif
