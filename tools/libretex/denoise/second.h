/* The second pass of denoising: spots larger than the first pass' window, which it leaves on even surfaces, are
 * smoothed by an edge-avoiding a-trous wavelet transform (Dammertz et al. 2010), each half for itself. Up to three
 * levels are taken where each half then agrees better with what the first pass made of the other half. Private to
 * libretex. */
#ifndef RETEX_DENOISE_SECOND_H
#define RETEX_DENOISE_SECOND_H

#include "denoise/passed.h"

/* Find the factors by which members are to be multiplied: they take the place of the totals. Pixels are those of the
 * region; those around count as far as they are in `passed`. Adds to the sums of signals what their totals become. */
int retex_denoise_second(const RetexDenoiser *denoiser, RetexDenoisePassed *passed, RetexSignalSums *sums, int nthreads,
                         RetexError *err);

#endif
