/* To what the numbers of a set of layout footprints are rounded: steps that no one sees, and numbers of few bits, which
 * compress. Whatever makes such a set, the renderer's film or denoising, rounds here. */
#ifndef RETEX_ROUNDING_H
#define RETEX_ROUNDING_H

#ifdef __cplusplus
extern "C" {
#endif

/* To a multiple of the largest power of two that is no more than step; as it is where step is not above 0. */
double retex_round_to(double value, double step);
/* To so many significant bits, at least 1; zeros, infinities and what is not a number stay as they are. */
double retex_round_bits(double value, int bits);

/* The step for retex_round_to of a pixel's coefficients, radiance that some texture multiplies. white: the sum of all
 * of the pixel's terms, of its largest channel: what it would be were its targets white. */
double retex_coefficient_step(double white);
/* A footprint's weight in a mixture, above 0..1; never to 0. */
float retex_round_share(double share);
/* A footprint's coverage, 0..1. */
float retex_round_coverage(double coverage);

#ifdef __cplusplus
}
#endif
#endif
