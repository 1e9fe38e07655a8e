/* Sets to denoise whose noise is known: two surfaces that meet at a silhouette, the left one the target T0, with a
 * shadow on it that no guide tells of. */
#ifndef LIB_DENOISE_H
#define LIB_DENOISE_H

#include "lib_test.h"
#include "set/signals.h"

/* Layout plain, paper (21 terms, two targets of three hits each, the second seen nowhere) or footprints (two clusters
 * of either kind, light that meets the target again, shares in it), with what denoising reads; without noise, the
 * beauty black but in layout plain. */
RetexSet *denoise_set(const char *layout, int width, int height);

/* Light as two halves of set->spp samples would have seen it, each drawn independently: every sample is the truth times
 * an exponentially distributed number of mean 1. The noise parts are what the halves then differ by. */
void denoise_add_noise(RetexSet *set, uint32_t seed);

/* A signal's noise_ part and its members' weighted sum. */
RetexSignals denoise_signals(const RetexSet *set);
const char *denoise_signal_name(const RetexSet *set, const RetexSignal *signal);
double denoise_total(const RetexSet *set, const RetexSignal *signal, int x, int y, int channel);
/* The mean of that over the picture. */
double denoise_mean(const RetexSet *set, const RetexSignal *signal, int channel);

/* Parts of the picture. How far a pixel's middle is from the silhouette, to the right of it above 0; and from the edge
 * of the shadow, above 0 outside. */
double denoise_from_silhouette(const RetexSet *set, int x, int y);
double denoise_from_shadow(const RetexSet *set, int x, int y);

/* What coefficients of a pixel may be rounded by, at most: half a step in layout footprints, else 0. */
double denoise_half_step(const RetexSet *set, int x, int y);

/* retex_denoise that must succeed; params may be NULL. */
void denoise_all(RetexSet *set, const RetexDenoiseParams *params, int nthreads);
/* Every bit of every part, and the names. */
void denoise_expect_same(const RetexSet *a, const RetexSet *b);
/* No part has NaN or infinities. */
void denoise_expect_finite(const RetexSet *set);

#endif
