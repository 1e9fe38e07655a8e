/* The light of lamps after filtering adds up to that of the whole. Private to libretex. */
#ifndef RETEX_DENOISE_RESIDUAL_H
#define RETEX_DENOISE_RESIDUAL_H

#include "denoise/denoiser.h"

/* In row y of the region: what the total of a signal of all light has more, or less, than the sum of the lamps' totals
 * times their values in it is added to these products by their variance. None becomes negative, and none changes where
 * the value is 0. */
void retex_denoise_share_residual(const RetexDenoiser *denoiser, int y);

#endif
