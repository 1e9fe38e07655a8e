/* How large a unit of u and v is on a target: so that a texture can be asked for by its width in scene units. */
#ifndef RENDERER_RENDER_UV_SCALE_H
#define RENDERER_RENDER_UV_SCALE_H

#include "accel/accel.h"

/* For each target of the scene the median of |dP/du| and of |dP/dv|, P in scene units and u, v as textures are looked
 * up at, over the points that the camera sees in a coarse grid of pixels; of a target that it does not see, over points
 * hit by rays that start anywhere within the scene's bounds. 0, 0 where nothing was found. A sphere's dP/du, for one,
 * goes from 2 pi r at the equator to 0 at the poles: the median is that of what is seen. */
int uv_scale_measure(const Scene *scene, const Accel *accel, double scale[][2], RetexError *err);

#endif
