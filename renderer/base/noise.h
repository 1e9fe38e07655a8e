/* POV-Ray's noise over space, of its three generators, to the last bit but for rounding. */
#ifndef RENDERER_BASE_NOISE_H
#define RENDERER_BASE_NOISE_H

#include "base/vec.h"

enum { NOISE_ORIGINAL = 1, NOISE_RANGE_CORRECTED = 2, NOISE_PERLIN = 3 }; /* generators; 2 is the default */

double noise_value(Vec3 p, int generator); /* 0 to 1; numbers that are no generator are the original one */
Vec3 noise_vector(Vec3 p);                 /* about 0; the same for all generators */
Vec3 noise_turbulence(Vec3 p, double lambda, double omega, double octaves); /* octaves of noise_vector */
int noise_octaves(double octaves); /* a number of octaves in POV-Ray's bounds, 1 to 10 */

/* Three numbers, 0 to 1, for each cell of the integer lattice. */
Vec3 noise_cell(Vec3 cell);

#endif
