/* Noise over space, for vturbulence and f_noise3d: each point of the integer lattice has a random value and a random
 * gradient, blended by smooth steps between them. As smooth as POV-Ray's and of the same range and spread, but not the
 * same numbers: those come out of POV-Ray's own tables. */
#include <math.h>
#include <stdint.h>
#include "base/noise.h"

/* Chosen so that the mean square is that of POV-Ray's, .0162 about .5 and .065 about 0. */
#define SCALAR_SPREAD 0.308
#define VECTOR_SPREAD 0.621

static uint32_t mix(uint32_t h)
{
    h = (h ^ h >> 16) * 0x7feb352du;
    h = (h ^ h >> 15) * 0x846ca68bu;
    return h ^ h >> 16;
}

/* The next of a corner's random numbers, -1 to 1. */
static double next(uint32_t *h)
{
    *h = mix(*h + 0x9e3779b9u);
    return *h / 2147483647.5 - 1;
}

static uint32_t lattice(double x)
{
    return (uint32_t)(int64_t)fmod(x, 4294967296.0);
}

/* Without scale; each salt another noise. */
static double noise(Vec3 p, uint32_t salt)
{
    const double cell[3] = {floor(p.x), floor(p.y), floor(p.z)};
    const double at[3] = {p.x - cell[0], p.y - cell[1], p.z - cell[2]};
    double sum = 0;
    for (int corner = 0; corner < 8; corner++) {
        uint32_t h = salt;
        double weight = 1, away[3];
        for (int k = 0; k < 3; k++) {
            int up = corner >> k & 1;
            h = mix(h ^ lattice(cell[k] + up)) + (uint32_t)k;
            away[k] = at[k] - up;
            double s = 1 - fabs(away[k]);
            weight *= s * s * (3 - 2 * s);
        }
        double value = next(&h);
        for (int k = 0; k < 3; k++)
            value += next(&h) * away[k];
        sum += weight * value;
    }
    return sum;
}

static int is_finite(Vec3 p)
{
    return isfinite(p.x) && isfinite(p.y) && isfinite(p.z);
}

double noise_scalar(Vec3 p)
{
    return is_finite(p) ? fmin(1, fmax(0, 0.5 + SCALAR_SPREAD * noise(p, 1))) : 0;
}

static Vec3 noise_vector(Vec3 p)
{
    return is_finite(p) ? vec_scale(vec3(noise(p, 2), noise(p, 3), noise(p, 4)), VECTOR_SPREAD) : vec3(0, 0, 0);
}

Vec3 noise_turbulence(Vec3 p, double lambda, double omega, double octaves)
{
    const int count = octaves >= 10 ? 10 : octaves >= 1 ? (int)octaves : 1; /* POV-Ray's bounds */
    Vec3 sum = noise_vector(p);
    double frequency = lambda, share = omega;
    for (int i = 1; i < count; i++) {
        sum = vec_mad(sum, noise_vector(vec_scale(p, frequency)), share);
        frequency *= lambda;
        share *= omega;
    }
    return sum;
}
