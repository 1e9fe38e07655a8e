/* Denoising a set that stays in its file, strip by strip. Private to libretex. */
#ifndef RETEX_DENOISE_STRIPS_H
#define RETEX_DENOISE_STRIPS_H

#include "denoise/denoiser.h"

/* 1 if the set can be denoised so: it is open, and no part of it is in a band store. */
int retex_denoise_can_use_strips(const RetexSet *set);

/* Denoise all of denoiser->set, which then has a band store instead of its source. The result is the same to the bit as
 * in memory. */
int retex_denoise_strips(const RetexDenoiser *denoiser, int nthreads, RetexError *err);

#endif
