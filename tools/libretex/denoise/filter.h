/* Tile after tile of a set in memory, and what is done to the whole when all are filtered. Private to libretex. */
#ifndef RETEX_DENOISE_FILTER_H
#define RETEX_DENOISE_FILTER_H

#include "denoise/tile.h"

/* What filtering tells besides new pixels. */
typedef struct RetexDenoiseResult {
    RetexSignalSums *sums;       /* by signal: of all pixels that were filtered */
    unsigned char *written; /* by part: 1 = it has new pixels */
} RetexDenoiseResult;

int retex_denoise_result_open(RetexDenoiseResult *result, const RetexDenoiser *denoiser, RetexError *err);
void retex_denoise_result_close(RetexDenoiseResult *result);

/* How far from a pixel others may lie that decide on it. */
enum { DENOISE_REACH = DENOISE_MARGIN + DENOISE_HALO };

/* The region of denoiser->set, from its first row in steps of DENOISE_STEP rows; sums are added to. */
int retex_denoise_filter(RetexDenoiser *denoiser, RetexDenoiseResult *result, int nthreads, RetexError *err);

/* Make the new pixels of the set what is stored: with the means that signals had, rounded; and the beauty their
 * recombination. result is of the whole region, of which the set may be some rows. */
int retex_denoise_finish(const RetexDenoiser *denoiser, const RetexDenoiseResult *result, int nthreads,
                         RetexError *err);

#endif
