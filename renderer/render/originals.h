/* The original textures that a set contains, one part for each target. */
#ifndef RENDERER_RENDER_ORIGINALS_H
#define RENDERER_RENDER_ORIGINALS_H

#include "scene/scene.h"

/* Longest side of a stored original in pixels: a compromise between detail and size. */
#define ORIGINAL_SIZE 1024

/* Add a part `original_NAME` for each target of the scene: its image map over (0,0)-(1,1), or any other pigment baked
 * over the range of UV that paths have hit. For a target of several pigments it is the first one.
 * nthreads: as of retex_parallel. */
int originals_add(RetexSet *set, const Scene *scene, int nthreads, RetexError *err);

/* The mean luminance of a target's original, of the brightest one where it has several pigments, 1/2 to 1. Patterns are
 * looked at in some points. It depends on the scene alone, not on paths: all parts of a picture have the same. */
float original_brightness(const Scene *scene, int target);

#endif
