/* Planes of a tile and what tells its pixels apart without noise. Private to libretex. */
#ifndef RETEX_DENOISE_FEATURES_H
#define RETEX_DENOISE_FEATURES_H

#include "denoise/tile.h"

/* A channel of a part of the set around the tile at (x0, y0); what lies outside the picture is as its border, what is
 * not finite 0. */
void retex_denoise_load_plane(float *restrict plane, const RetexSet *set, int part, int channel, int x0, int y0);

/* Room for features: planes, two scales a group, and valid. */
enum { DENOISE_FEATURES_SCRATCH = DENOISE_FEATURES_MAX + 2 * DENOISE_GROUPS_MAX + 1 };

/* Fill memory, DENOISE_FEATURES_SCRATCH planes, and have features point to it. */
void retex_denoise_load_features(RetexDenoiseFeatures *features, float *memory, const RetexDenoiser *denoiser, int x0,
                                 int y0);

#endif
