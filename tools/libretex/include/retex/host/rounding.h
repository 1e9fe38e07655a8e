/* What numbers are rounded to before they are stored: those of few bits compress better. retex_set_round rounds a set
 * as retex-set(5) describes, and retex_denoise does so too. */
#ifndef RETEX_HOST_ROUNDING_H
#define RETEX_HOST_ROUNDING_H

#include <math.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* The rounding unit for a step: the largest power of two that is at most step; 0 where step is not above 0, or beyond
 * floats. */
double retex_round_unit(double step);
/* Round to a multiple of unit, ties to even; unit 0 leaves the value as it is. */
static inline double retex_round_by(double value, double unit)
{
    const double large = 0x1.8p52 * unit; /* adding this leaves multiples of unit only */
    return fabs(value) < 0x1p51 * unit ? copysign((fabs(value) + large) - large, value)
           : unit > 0                  ? rint(value / unit) * unit
                                       : value;
}
/* Round with the unit of a step. */
static inline double retex_round_to(double value, double step)
{
    return retex_round_by(value, retex_round_unit(step));
}
/* Round to so many significant bits, at least 1; zeros, infinities and NaN stay as they are. */
double retex_round_bits(double value, int bits);

/* The unit, for retex_round_by, of a pixel's coefficients: radiance that a texture multiplies. white: the sum of all
 * terms of the pixel in its largest channel, which is its value with white targets. */
double retex_coefficient_unit(double white);
#define RETEX_LEAST_SHARE 1e-5f /* of a footprint in a mixture; a half holds it */
/* Round a footprint's weight in a mixture, above 0 to 1; never to 0. */
float retex_round_share(double share);
/* Round a footprint's coverage, 0..1. */
float retex_round_coverage(double coverage);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
