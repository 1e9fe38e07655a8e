/* Sets with known noise, for tests of denoising. Two surfaces meet at a silhouette. The left one is the target T0. It
 * has a shadow that is in no guide. */
#ifndef LIB_DENOISE_H
#define LIB_DENOISE_H

#include <retex/denoise.h>

#include "lib_test.h"
#include "set/signals.h"

/* Layout plain, paper (21 terms, two targets of three hits each, the second one visible nowhere) or footprints (two
 * clusters of each kind, light with further hits, shares of it), with denoising data and without noise. The beauty is
 * black except in layout plain. */
RetexSet *denoise_set(const char *layout, int width, int height);

/* Give T0 an original of 512 x 4 texels: red is 0.25 at u = min[0] and 0.75 at max[0], green half of that, blue 0. */
void denoise_add_original(RetexSet *set, const double min[2], const double max[2]);

/* Add the noise of set->spp independent samples in two halves: every sample is the true light times an exponentially
 * distributed number of mean 1. The noise parts become half of the difference between the halves. */
void denoise_add_noise(RetexSet *set, uint32_t seed);

/* The noise_ part of a signal, and the weighted sum of its terms. */
RetexSignals denoise_signals(const RetexSet *set);
const char *denoise_signal_name(const RetexSet *set, const RetexSignal *signal);
double denoise_total(const RetexSet *set, const RetexSignal *signal, int x, int y, int channel);
/* The mean of that over all pixels. */
double denoise_mean(const RetexSet *set, const RetexSignal *signal, int channel);

/* Regions of the picture: the distance of a pixel's centre from the silhouette, above 0 to its right, and from the edge
 * of the shadow, above 0 outside. */
double denoise_from_silhouette(const RetexSet *set, int x, int y);
double denoise_from_shadow(const RetexSet *set, int x, int y);

/* The defaults, but in full precision. */
extern const RetexDenoiseParams denoise_exactly;

/* Calls retex_denoise, which must succeed; params may be NULL. */
void denoise_all(RetexSet *set, const RetexDenoiseParams *params, int nthreads);
/* Every bit of every part is the same, and the names. */
void denoise_expect_same(const RetexSet *a, const RetexSet *b);
/* No part has NaN or infinities. */
void denoise_expect_finite(const RetexSet *set);

#endif
