/* The sky: its radiance, and an importance table over the sphere. */
#ifndef RENDERER_LIGHT_ENVIRONMENT_H
#define RENDERER_LIGHT_ENVIRONMENT_H

#include "light/sky_table.h"
#include "scene/scene.h"

/* Radiance of sky and background in a direction: that they are seen with, or that surfaces are lit with. */
Rgb sky_radiance(const Scene *scene, Vec3 direction, int seen);
/* 0: it is black in all directions, as far as the table of the sky tells. Quick where it is not. */
int sky_shines(const Scene *scene);

/* *table is NULL where the sky is black. for_mis: as of sky_table_create. */
int sky_table_of(SkyTable **table, const Scene *scene, int for_mis, RetexError *err);

#endif
