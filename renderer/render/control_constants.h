/* A second control variate: every target in a constant colour, one for each pixel.
 *
 * A set recombines exactly with constant textures, in each pixel with other constants if need be. So the picture with
 * constants is known from the set as well as the original picture is. With the mean of the new textures as the constant
 * of a pixel, the error of that picture is nearly that of the new one. */
#ifndef RENDERER_RENDER_CONTROL_CONSTANTS_H
#define RENDERER_RENDER_CONTROL_CONSTANTS_H

#include "render/first_hit.h"

/* 1 if the set has all targets of the scene and recombines exactly with constants. */
int control_constants_fit(const Scene *scene, const RetexSet *set);
/* colors[t] (unallocated, RGB): for each pixel the mean colour of target t, with the window's variant, over the pixel's
 * first hits on it; in other pixels the mean over the target. No random numbers are used, so that the colours are
 * independent of all samples. */
int control_constants(RetexImage *colors, const FirstHitWindow *window, const RetexSet *set, RetexError *err);
/* dst (unallocated): the set recombined with these colours. */
int control_constants_combine(RetexImage *dst, RetexSet *set, const Scene *scene, const RetexImage *colors,
                              int nthreads, RetexError *err);

#endif
