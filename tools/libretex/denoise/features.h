/* Loads the guides around a tile as features. Private to libretex. */
#ifndef RETEX_DENOISE_FEATURES_H
#define RETEX_DENOISE_FEATURES_H

#include <math.h>

#include "denoise/denoiser.h"

/* A number of a set as denoising takes it. */
static inline float retex_denoise_finite(float v)
{
    return fabsf(v) < 1e30f ? v : 0;
}

/* Load one channel of a part of the set around the tile at (x0, y0). Pixels outside of the picture repeat its border;
 * values that are not finite become 0. */
void retex_denoise_load_plane(float *restrict plane, const RetexSet *set, int part, int channel, int x0, int y0);

/* Coverage of a target below which it counts as not seen. */
#define DENOISE_LEAST_COVER 0.02f
/* Load which pixels may be compared, around the tile: 1, or -1 where the signal is of what is seen sharply, and its
 * target is not. */
void retex_denoise_load_kind(float *restrict kind, const RetexDenoiser *denoiser, const RetexSignal *signal, int x0,
                             int y0);

/* Planes of memory for the features: the guides, two scales a feature, and valid. */
enum { DENOISE_FEATURES_SCRATCH = DENOISE_FEATURE_PLANES_MAX + 2 * DENOISE_FEATURES_MAX + 1 };

/* Load the features into memory, which has DENOISE_FEATURES_SCRATCH planes; features points into it. */
void retex_denoise_load_features(RetexDenoiseFeatures *features, float *memory, const RetexDenoiser *denoiser, int x0,
                                 int y0);

#endif
