/* Denoising a set that stays in its file, some rows after the other. Private to libretex. */
#ifndef RETEX_DENOISE_STRIPS_H
#define RETEX_DENOISE_STRIPS_H

#include "denoise/tile.h"

/* Whether a set can be: it is open, and no part of it is in a band store. */
int retex_denoise_can_use_strips(const RetexSet *set);

/* All of denoiser->set, which then has a band store instead of its source. The same to the bit as in memory. */
int retex_denoise_strips(const RetexDenoiser *denoiser, int nthreads, RetexError *err);

#endif
