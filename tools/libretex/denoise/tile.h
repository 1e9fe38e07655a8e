/* Filtering one tile: the input of the kernels, and the pixels made from their sums. Private to libretex. */
#ifndef RETEX_DENOISE_TILE_H
#define RETEX_DENOISE_TILE_H

#include "denoise/denoiser.h"

/* Scratch memory of one thread. */
typedef struct RetexDenoiseScratch RetexDenoiseScratch;
int retex_denoise_scratch_create(RetexDenoiseScratch **work, const RetexDenoiser *denoiser, RetexError *err);
void retex_denoise_scratch_close(RetexDenoiseScratch **work);

/* Filter DENOISE_STEP x DENOISE_STEP pixels from (x0, out->first) on, as far as they are in out's rows and the region,
 * into out and denoiser->passed. Adds to the sums of before the second pass; sums has an entry for each signal. */
void retex_denoise_tile(const RetexDenoiser *denoiser, RetexDenoiseScratch *work, int x0, RetexDenoisedRows *out,
                        RetexSignalSums *sums);

#endif
