/* To what the numbers of a set of layout footprints are rounded: steps that no one sees, and numbers of few bits, which
 * compress. Whatever makes such a set, the renderer's film or denoising, rounds here. */
#ifndef RETEX_ROUNDING_H
#define RETEX_ROUNDING_H

#include <math.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The largest power of two that is no more than step; 0 where that is not above 0, or beyond floats. */
double retex_round_unit(double step);
/* To a multiple of that, ties to even; as it is where unit is 0. */
static inline double retex_round_by(double value, double unit)
{
    const double large = 0x1.8p52 * unit; /* below it and as large, multiples of unit are all there are */
    return fabs(value) < 0x1p51 * unit ? copysign((fabs(value) + large) - large, value)
           : unit > 0                  ? rint(value / unit) * unit
                                       : value;
}
/* Both in one. */
static inline double retex_round_to(double value, double step)
{
    return retex_round_by(value, retex_round_unit(step));
}
/* To so many significant bits, at least 1; zeros, infinities and what is not a number stay as they are. */
double retex_round_bits(double value, int bits);

/* The unit for retex_round_by of a pixel's coefficients, radiance that some texture multiplies. white: the sum of all
 * of the pixel's terms, of its largest channel: what it would be were its targets white. */
double retex_coefficient_unit(double white);
/* A footprint's weight in a mixture, above 0..1; never to 0. */
float retex_round_share(double share);
/* A footprint's coverage, 0..1. */
float retex_round_coverage(double coverage);

#ifdef __cplusplus
}
#endif
#endif
