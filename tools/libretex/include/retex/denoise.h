/* Denoising: the coefficients of a set hold no detail of any texture, so they are filtered once, and every retexture
 * is clean.
 *
 * The renderer leaves with a set what the filter needs, as parts of the set's size that recombination does not read:
 *
 *     noise_NAME           RGB, half   by signal, see below: half of the difference between the mean of the first half
 *                                      of the samples (spp / 2, rounded down) and that of the rest. Its square
 *                                      estimates the variance of the mean of all (Rousselle et al. 2012)
 *     guide_normal         RGB, half   mean shading normal at the first hit, world space, camera's side; 0 = nothing
 *     guide_position       RGB, float  mean position of the first hit, world space, over those places that hit
 *     guide_specular       R, half     share of the pixel, 0..1, whose first hit is a mirror or clear glass
 *     guide_seen_normal    RGB, half   the same at the first hit that is neither: what is seen in mirrors and through
 *     guide_seen_position  RGB, float  glass; the first hit where it is none of these
 *     guide_seen_albedo    RGB, half   its pigment, scene-linear; white on targets, whose texture is not known, and
 *                                      where nothing is hit
 *     guide_seen_material  RGB, half   roughness, metallic (as the AOVs of these names), share that hits nothing
 *     guide_cover_TARGET   R, half     how much of the target is seen there: share of the pixel times the luminance
 *                                      that the mirrors and glass before it leave, 0..1
 *
 * Guides are taken at the first 16 of the pixel's samples, or the first 64 where those do not all see the same, along
 * the likelier way at each mirror and glass: they are free of noise, but for how samples are spread. A signal is what
 * is filtered with weights of its own: a picture that is the sum of terms,
 *
 *     total = sum over the terms t of the signal of  C_t / 2^(factors of t - 1)
 *
 * as if each further hit had albedo 1/2. Signals are `indep`, the terms without factors; by target and kind of the
 * first factor's footprint TARGET_sharp and TARGET_broad, in layout paper TARGET_hit; `beauty` where there are no
 * terms at all.
 *
 * Sources: Rousselle, Knaus, Zwicker, 'Adaptive Rendering with Non-Local Means Filtering', 2012: weights from patches
 * of one half of the samples for the other half. Rousselle, Manzi, Zwicker, 'Robust Denoising using Feature and Color
 * Information', 2013: weights no larger than features allow. */
#ifndef RETEX_DENOISE_H
#define RETEX_DENOISE_H

#include <retex/budget.h>
#include <retex/set.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Begin with RETEX_DENOISE_INIT. */
typedef struct RetexDenoiseParams {
    size_t size;
    float strength;      /* how unlike, in standard deviations of their noise, pixels may be and still help each other:
                            0.1..10, default 1 */
    int radius;          /* of the window in which they are looked for, 1..10 pixels; default 5 */
    int footprints;      /* 1 (default): pool broad and later footprints of pixels; 0: leave all as they are */
    int scalar;          /* 1: plain code instead of the machine's vector unit, the same to the bit; default 0 */
    void (*progress)(void *context, double done); /* 0..1, from the calling thread; NULL = none */
    void *progress_context;
    const char *near;    /* of a set that is open: path of a file beside which temporary ones, without names, may lie;
                            NULL, the default: in $TMPDIR or /tmp */
    const RetexBudget *budget; /* may stop it; NULL, the default = nothing does */
} RetexDenoiseParams;
#define RETEX_DENOISE_INIT { sizeof(RetexDenoiseParams), 1, 5, 1, 0, NULL, NULL, NULL, NULL }

/* Filter a set in place. A set that is open (retex_set_open) is filtered strip by strip into a band store if roi is
 * NULL. Filtered are terms, with `footprints` also broad footprints and, as far as they are near to each other,
 * interreflections; the beauty becomes the recombination with the original textures. The mean of each signal over roi
 * (NULL = all) is preserved. Pixels outside roi keep their terms and footprints. The data that only denoising reads are
 * removed from the set, and set->denoised is 1. RETEX_ENOTFOUND where the set has no such data. The same to the bit for
 * every nthreads. */
int retex_denoise(RetexSet *set, const RetexDenoiseParams *params /* NULL = defaults */, const RetexRoi *roi,
                  int nthreads, RetexError *err);

/* 1 if the set has all data that retex_denoise reads. */
int retex_denoise_has_data(const RetexSet *set);
/* Remove these data. */
void retex_denoise_drop_data(RetexSet *set);

#ifdef __cplusplus
}
#endif
#endif
