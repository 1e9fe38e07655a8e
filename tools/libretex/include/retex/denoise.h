/* Denoising: the coefficients of a set hold no detail of any texture, so they are filtered once, and every retexture
 * is clean.
 *
 * What it reads, <retex/host/denoise_data.h>, the renderer leaves with the set.
 *
 * Sources: Rousselle, Knaus, Zwicker, 'Adaptive Rendering with Non-Local Means Filtering', 2012: weights from patches
 * of one half of the samples for the other half. Rousselle, Manzi, Zwicker, 'Robust Denoising using Feature and Color
 * Information', 2013: weights no larger than features allow. Dammertz, Sewtz, Hanika, Lensch, 'Edge-Avoiding A-Trous
 * Wavelet Transform for Fast Global Illumination Filtering', 2010: the second pass. */
#ifndef RETEX_DENOISE_H
#define RETEX_DENOISE_H

#include <retex/budget.h>
#include <retex/set.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Begin with RETEX_DENOISE_INIT. */
typedef struct RetexDenoiseParams {
    size_t size;
    float strength;      /* how unlike, in standard deviations of their noise, pixels may be and still help each other:
                            0.1..10, default 1 */
    int radius;          /* of the window in which they are looked for, 1..10 pixels; default 5 */
    int footprints;      /* 1 (default): pool broad and later footprints of pixels, and take their albedos from original
                            textures; 0: leave all as they are */
    int scalar;          /* 1: plain code instead of the machine's vector unit, the same to the bit; default 0 */
    void (*progress)(void *context, double done); /* 0..1, from the calling thread; NULL = none */
    void *progress_context;
    const char *near;    /* of a set that is open: path of a file beside which temporary ones, without names, may lie;
                            NULL, the default: in $TMPDIR or /tmp */
    const RetexBudget *budget; /* may stop it; NULL, the default = nothing does */
    int full_precision;  /* 1: the new pixels are rounded to halves only; 0 (default): also to what they are known to,
                            see retex-set(5) */
    const char *denoiser; /* of the light: "nlm", "oidn", which is Open Image Denoise 2, or "both", the mean of the two;
                             NULL, the default: nlm. oidn and both filter the light of the whole picture at once */
    const char *quality; /* "final", or "preview": a radius of at most 2, footprints 0 but for albedos, and
                            full_precision 1, in two thirds of the time; NULL, the default: final */
} RetexDenoiseParams;
#define RETEX_DENOISE_INIT { sizeof(RetexDenoiseParams), 1, 5, 1, 0, NULL, NULL, NULL, NULL, 0, NULL, NULL }

/* Filter a set in place. A set that is open (retex_set_open) is filtered strip by strip into a band store if roi is
 * NULL. Filtered are terms, with `footprints` also broad footprints and, as far as they are near to each other,
 * interreflections; the beauty becomes the recombination with the original textures. The mean of each signal over roi
 * (NULL = all) is preserved, apart from rounding and what fireflies have beyond 3% of the rest. Pixels
 * outside roi keep their terms and footprints. The data that only denoising reads are removed from the set, and
 * set->denoised is 1. RETEX_ENOTFOUND where the set has no such data. With denoiser oidn or both, RETEX_EUNSUPPORTED
 * where Open Image Denoise 2 cannot be opened or fails. The same to the bit for every nthreads, as far as that
 * library's result is. */
int retex_denoise(RetexSet *set, const RetexDenoiseParams *params /* NULL = defaults */, const RetexRoi *roi,
                  int nthreads, RetexError *err);

/* 1 if the set has all data that retex_denoise reads. */
int retex_denoise_has_data(const RetexSet *set);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
