/* POV-Ray's fog: it dims light and adds its own colour, and is not lit. */
#ifndef RENDERER_MEDIUM_FOG_H
#define RENDERER_MEDIUM_FOG_H

#include "shape/surface.h"

/* What light is multiplied by over a distance along a ray, from its tmin on; INFINITY: to the sky. *own gets the light
 * that fog adds. */
Rgb fog_transmittance(const Scene *scene, const Ray *ray, double distance, Rgb *own);

#endif
