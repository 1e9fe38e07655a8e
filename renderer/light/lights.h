/* Everything that gives light, sampled one light at a time: light sources, shapes that emit, and the sky. Nothing here
 * looks at a pigment's colour: powers are estimated with NEUTRAL_ALBEDO. */
#ifndef RENDERER_LIGHT_LIGHTS_H
#define RENDERER_LIGHT_LIGHTS_H

#include "light/entry.h"

typedef struct Lights Lights;

/* lamp_share: of scenes with lamps: with this probability, 0..1, a lamp is chosen first, each alike, so that dim ones
 * have little noise. */
int lights_create(Lights **lights, const Scene *scene, double lamp_share, RetexError *err);
void lights_close(Lights **lights);
/* Whether the lights of a scene whose camera is at a are others than where it is at b. */
int lights_differ(const Scene *scene, Vec3 a, Vec3 b);
int lights_count(const Lights *lights);

/* Sample light for a point: u_pick chooses the light (of many, with u_more for what a float cannot tell), u1 and u2 the
 * point on it. Returns 0 where no light reaches the point. */
LightPick lights_pick(const Lights *lights, const LightSampleContext *point, float u_pick, float u_more);
int lights_sample(const Lights *lights, const LightSampleContext *point, const LightPick *pick, float u1, float u2,
                  LightSample *sample);
/* Ask memory for what lights_sample will read of the sky, where it is one of few lights. count: at most
 * SKY_TABLE_PREFETCH. */
void lights_prefetch(const Lights *lights, const float *u1, const float *u2, int count);
int lights_lamp(const Lights *lights, const LightPick *pick); /* of the light that was picked */
/* The point on a picked mesh, if the radiance of its face is uniform and rays of paths see it: returns 0 elsewhere. The
 * matte kernel (path/matte.h) goes on with it instead of lights_sample. */
int lights_uniform_point(const Lights *lights, const LightPick *pick, float u1, float u2, MeshLightPoint *point);
/* Density with which lights_pick and lights_sample together sample a direction that met an emitter, or the sky: for
 * multiple importance sampling. */
float lights_emitter_pdf(const Lights *lights, const LightSampleContext *from, int primitive, const Surface *surface);
float lights_sky_pdf(const Lights *lights, const LightSampleContext *from, Vec3 direction);

/* A point of an emitting shape, where photons start. */
typedef struct EmissionPoint {
    Vec3 position, normal;
    float power; /* luminance of its radiance, with NEUTRAL_ALBEDO, over the density of the point: area is in it */
} EmissionPoint;
int lights_emit(const Lights *lights); /* 1: there are shapes that do */
/* Whether much of their power is that of shapes that look small from a point. */
int lights_small_emitter(const Lights *lights, Vec3 from);
/* Shapes are chosen by their power. Returns 0 where there is none. */
int lights_emission(const Lights *lights, float u_pick, float u1, float u2, EmissionPoint *point);
/* Estimate of the irradiance of all lights on a surface that faces them. */
float lights_estimate(const Lights *lights, const LightSampleContext *point);

#endif
