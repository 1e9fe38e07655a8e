/* Filtering all tiles of a set in memory, and finishing the set when all are filtered. Private to libretex. */
#ifndef RETEX_DENOISE_FILTER_H
#define RETEX_DENOISE_FILTER_H

#include "denoise/passed.h"

/* The result of filtering besides new pixels. */
typedef struct RetexDenoiseResult {
    RetexSignalSums *sums;  /* by signal of the set: of all pixels that were filtered */
    unsigned char *written; /* by part: 1 = it has new pixels */
} RetexDenoiseResult;

int retex_denoise_result_open(RetexDenoiseResult *result, const RetexDenoiser *denoiser, RetexError *err);
void retex_denoise_result_close(RetexDenoiseResult *result);

/* The largest distance of pixels that influence a pixel, in either pass. */
enum { DENOISE_REACH = DENOISE_MARGIN + DENOISE_HALO };

/* The signals of all light, or of one lamp, are a bundle: they are filtered together, and without the parts of others.
 * *bundle becomes `all`, limited to the bundle that begins with signal `first`. Returns how many it has; 0 after the
 * last one. */
int retex_denoise_bundle(RetexDenoiser *bundle, const RetexDenoiser *all, int first);

/* The first pass: filter the region of denoiser->set, in steps of DENOISE_STEP rows, into the set and denoiser->passed;
 * adds to the sums of result what signals were before. */
int retex_denoise_filter(RetexDenoiser *denoiser, RetexDenoiseResult *result, int nthreads, RetexError *err);

/* Finish the new pixels of the set: multiply them by the factors of the second pass, scale them to the old means of
 * signals, round them, and compute the beauty as their
 * recombination. result is that of the whole region; the set may be some of its rows. */
int retex_denoise_finish(const RetexDenoiser *denoiser, const RetexDenoiseResult *result, int nthreads,
                         RetexError *err);

#endif
