/* The sky: its radiance, and an importance table over the sphere. */
#ifndef RENDERER_LIGHT_ENVIRONMENT_H
#define RENDERER_LIGHT_ENVIRONMENT_H

#include "scene/scene.h"

/* Radiance of sky and background in a direction: that they are seen with, or that surfaces are lit with. */
Rgb sky_radiance(const Scene *scene, Vec3 direction, int seen);
/* 0: it is black in all directions, as far as the table of the sky tells. Quick where it is not. */
int sky_shines(const Scene *scene);

typedef struct Environment Environment;
/* *environment is NULL where the sky is black. */
int environment_create(Environment **environment, const Scene *scene, RetexError *err);
void environment_close(Environment **environment);
Vec3 environment_sample(const Environment *environment, float u1, float u2, float *pdf);
float environment_pdf(const Environment *environment, Vec3 direction);
float environment_mean(const Environment *environment); /* mean luminance over the sphere */

#endif
