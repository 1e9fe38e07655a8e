/* Elementwise arithmetic on planes, see denoise_kernel.h. Private to libretex. */
#ifndef RETEX_DENOISE_PLANES_KERNEL_H
#define RETEX_DENOISE_PLANES_KERNEL_H

#include "denoise/denoise_kernel.h"

/* Adds values to plane, and weight times them to total. */
void retex_denoise_add_plane(float *plane, float *total, const float *values, float weight);

/* Both halves of a plane `first`, which has the total, divided by the modulation. noise: half of the difference of the
 * halves, not divided. most: 1 = noise is limited to the total, so that no half is less than 0. weights: by how many
 * times the noise the halves differ from the total. */
void retex_denoise_split_plane(float *first, float *second, const float *modulation, const float *noise,
                               const float weights[2], int limited);

/* The variance of a half, by the squared difference of both, averaged over 5x5 pixels; spare is scratch. */
void retex_denoise_variance_plane(float *variance, const float *first, const float *second, float *spare);

/* The squared change from pixel to pixel along both axes, added: to strict the smaller of both sides, so that an edge
 * does not count as a slope, to loose the larger. */
void retex_denoise_add_gradient(float *strict, float *loose, const float *plane);

/* Each becomes 1 / (factor * the larger of least and itself). */
void retex_denoise_invert_plane(float *plane, float least, float factor);

/* 1 if all are 0. */
int retex_denoise_plane_is_zero(const float *plane);

#endif
