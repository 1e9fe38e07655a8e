/* The state of one call of retex_denoise, and the rows that it makes. Private to libretex. */
#ifndef RETEX_DENOISE_DENOISER_H
#define RETEX_DENOISE_DENOISER_H

#include <retex/denoise.h>
#include <retex/host/denoise_data.h>
#include "denoise/denoise_kernel.h"
#include "set/signals.h"

/* Rows of results, by part of the set; NULL for a part that is not changed. */
typedef struct RetexDenoisedRows {
    int first, rows;
    float **parts;
} RetexDenoisedRows;

typedef struct RetexDenoisePassed RetexDenoisePassed; /* see passed.h */

/* Brightness that is assumed of a target in light that its texture does not multiply; guides show targets white. */
#define DENOISE_TARGET_BRIGHTNESS 0.3f

/* Totals of signals that another denoiser filtered, whole pictures of three floats a pixel: see totals.h. */
typedef struct RetexDenoiseTotals {
    float share; /* of them in the total that is used, above 0 */
    int count;   /* of signals */
    size_t width;
    float **of; /* by signal of the set */
} RetexDenoiseTotals;

/* The state of one call of retex_denoise. */
typedef struct RetexDenoiser {
    RetexSet *set;
    RetexDenoiseParams params;
    RetexRoi roi;
    int features[RETEX_FEATURE_COUNT];         /* parts */
    RetexSignals signals;                      /* of the set, or of a bundle of those: see retex_denoise_bundle */
    int first_signal, nsignals;                /* the number of the bundle's first one, and of all that the set has */
    struct RetexDenoiseFootprints *footprints; /* NULL where the signals are a lamp's */
    RetexDenoisePassed *passed;                /* rows of the region, of the signals */
    RetexDenoiseTotals *totals;                /* or NULL */
    int uses_originals;                        /* 0: albedos of footprints stay as they are */
    struct RetexDenoiseOriginals *originals;   /* or NULL */
    int first_row;                             /* of the set's rows in the totals: above 0 where the set is a strip */
} RetexDenoiser;

/* Sums over the pixels of a signal's total: as rendered but for what fireflies were lowered by, that, the variance of
 * the former, and after the second pass. */
typedef struct RetexSignalSums {
    double before[3], lost[3], variance[3], after[3];
    double lit; /* pixels with light */
} RetexSignalSums;

#endif
