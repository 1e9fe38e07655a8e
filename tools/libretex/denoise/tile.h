/* Denoising one tile: what is prepared for the kernels, and what their sums become. Private to libretex. */
#ifndef RETEX_DENOISE_TILE_H
#define RETEX_DENOISE_TILE_H

#include <retex/denoise.h>
#include "denoise/denoise_kernel.h"
#include "set/signals.h"

/* The guides of a set, in the order in which features take them. */
enum {
    GUIDE_SEEN_NORMAL,
    GUIDE_SEEN_POSITION,
    GUIDE_SEEN_ALBEDO,
    GUIDE_SEEN_MATERIAL,
    GUIDE_NORMAL,
    GUIDE_POSITION,
    GUIDE_SPECULAR,
    GUIDE_COUNT
};

/* Rows of results, by part of the set: NULL where a part stays as it is. */
typedef struct RetexDenoisedRows {
    int first, rows;
    float **parts;
} RetexDenoisedRows;

/* All of one call. */
typedef struct RetexDenoiser {
    RetexSet *set;
    RetexDenoiseParams params;
    RetexRoi roi;
    int guides[GUIDE_COUNT]; /* parts */
    RetexSignals signals;
    struct RetexDenoiseFootprints *footprints;
} RetexDenoiser;

/* Sums over pixels of a signal's totals, before and after. */
typedef struct RetexSignalSums {
    double before[3], after[3];
} RetexSignalSums;

/* Scratch memory of one thread. */
typedef struct RetexDenoiseScratch RetexDenoiseScratch;
int retex_denoise_scratch_create(RetexDenoiseScratch **work, const RetexDenoiser *denoiser, RetexError *err);
void retex_denoise_scratch_close(RetexDenoiseScratch **work);

/* Filter the DENOISE_STEP pixels a side from (x0, band->first) on, as far as they are of the band and the region, into
 * band; sums has an entry for each signal. */
void retex_denoise_tile(const RetexDenoiser *denoiser, RetexDenoiseScratch *work, int x0, RetexDenoisedRows *band,
                        RetexSignalSums *sums);

#endif
