/* The size of a unit of u and of v on a target, for textures whose width is given in scene units. */
#ifndef RENDERER_RENDER_UV_SCALE_H
#define RENDERER_RENDER_UV_SCALE_H

#include "accel/accel.h"

/* For each target of the scene, the median of |dP/du| and of |dP/dv|, where P is the position and u, v are the texture
 * coordinates. The median is over points that a coarse grid of camera rays hits; for a target that none of them hits,
 * over points hit by random rays within the scene's bounds. 0, 0 where no point was found. The size may vary over a
 * target: on a sphere |dP/du| is 2 pi r at the equator and 0 at the poles. */
int uv_scale_measure(const Scene *scene, const Accel *accel, double scale[][2], RetexError *err);

#endif
