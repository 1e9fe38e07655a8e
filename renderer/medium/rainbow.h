/* POV-Ray's rainbows: bows at an angle round a direction, mixed with what is behind them like fog. */
#ifndef RENDERER_MEDIUM_RAINBOW_H
#define RENDERER_MEDIUM_RAINBOW_H

#include "shape/surface.h"

/* What light is multiplied by over a distance along a ray, INFINITY: from the sky; *own gets the light that rainbows
 * add. u: of [0, 1), for jitter. Returns 0 where there is no rainbow. */
int rainbow_transmittance(const Scene *scene, const Ray *ray, double distance, double u, Rgb *passing, Rgb *own);

#endif
