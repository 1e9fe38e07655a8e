/* The original textures a set carries, one part a target. */
#ifndef RENDERER_RENDER_ORIGINALS_H
#define RENDERER_RENDER_ORIGINALS_H

#include "scene/scene.h"

/* Longest side of a stored original: enough to show it and to put it back, small enough not to weigh. */
#define ORIGINAL_SIZE 1024

/* Add a part `original_NAME` for each target of the scene: its image map over (0,0)-(1,1), or any other pigment baked
 * over the UV that was met. A target of several pigments shows the first.
 * nthreads: as of retex_parallel. */
int originals_add(RetexSet *set, const Scene *scene, int nthreads, RetexError *err);

#endif
