/* Noise over space. */
#ifndef RENDERER_BASE_NOISE_H
#define RENDERER_BASE_NOISE_H

#include "base/vec.h"

double noise_scalar(Vec3 p); /* 0 to 1 */
Vec3 noise_turbulence(Vec3 p, double lambda, double omega, double octaves);

#endif
