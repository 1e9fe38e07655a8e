/* Phase functions: how a medium scatters light by the angle between its directions before and after. */
#ifndef RENDERER_MEDIUM_PHASE_H
#define RENDERER_MEDIUM_PHASE_H

#include "scene/scene.h"

/* Per steradian; its integral over all directions is 1. */
double phase_density(const Medium *medium, double cosine);
/* Of POV-Ray's light sources, whose irradiance is pi times their colour: POV-Ray's own function over pi. It is about
 * four times the other one, as POV-Ray gives media light that its surfaces do not get. */
double phase_of_sources(const Medium *medium, double cosine);
/* That over phase_density; it is the same for all angles. */
double phase_source_scale(const Medium *medium);
/* Sample a direction after scattering by phase_density. */
Vec3 phase_sample(const Medium *medium, Vec3 before, float u, float v, double *density);

#endif
