/* A second control variate: every target in a constant colour, one for each pixel.
 *
 * A set recombines exactly with constants, and each pixel is a polynomial of its own: so the picture with other
 * constants in each pixel is known from it as well as the original is. With the new textures' mean in a pixel as its
 * constant, what such a render is off by is nearly all of what the new one is off by. */
#ifndef RENDERER_RENDER_CONTROL_CONSTANTS_H
#define RENDERER_RENDER_CONTROL_CONSTANTS_H

#include "render/first_hit.h"

/* Whether the set has the scene's targets and recombines exactly. */
int control_constants_fit(const Scene *scene, const RetexSet *set);
/* colors[t] (unallocated, RGB): for each pixel the mean over it of the colour of scene target t, with the window's
 * variant, where the camera's rays meet it first; elsewhere the mean over the target. No random numbers are
 * used: the colours are independent of all samples. */
int control_constants(RetexImage *colors, const FirstHitWindow *window, const RetexSet *set, RetexError *err);
/* dst (unallocated): the set recombined with these colours. */
int control_constants_combine(RetexImage *dst, const RetexSet *set, const Scene *scene, const RetexImage *colors,
                              int nthreads, RetexError *err);

#endif
