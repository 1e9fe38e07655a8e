/* Everything that gives light, sampled one light at a time: POV-Ray's light sources (never seen or hit), shapes that
 * emit, and the sky. Nothing here looks at a pigment's colour: powers are estimated with NEUTRAL_ALBEDO. */
#ifndef RENDERER_LIGHT_LIGHTS_H
#define RENDERER_LIGHT_LIGHTS_H

#include "light/light_tree.h"
#include "scene/scene.h"
#include "shape/surface.h"

typedef struct Lights Lights;

typedef enum LightSampleKind {
    LIGHT_SAMPLE_SOURCE, /* a light source: radiance is irradiance on a surface facing it; pdf is 0 */
    LIGHT_SAMPLE_EMITTER, /* a point of an emitting shape: surface is filled, the caller evaluates its emission */
    LIGHT_SAMPLE_SKY     /* radiance of the sky */
} LightSampleKind;

typedef struct LightSample {
    LightSampleKind kind;
    Vec3 direction;      /* from the lit point, unit length */
    double distance;     /* INFINITY for the sky */
    Rgb radiance;        /* not divided by pick_probability and pdf */
    float pick_probability; /* of having picked this light */
    float pdf;           /* per solid angle, without pick_probability; 0 for a light source */
    int shadowless;
    /* LIGHT_SAMPLE_SOURCE: the light; and where its shadow ray goes: to a point of the grid of an area_light, while its
     * light comes from the middle */
    const Light *source;
    Vec3 shadow_direction;
    double shadow_distance;
    Surface surface;     /* LIGHT_SAMPLE_EMITTER */
} LightSample;

int lights_create(Lights **lights, const Scene *scene, RetexError *err);
void lights_close(Lights **lights);
int lights_count(const Lights *lights);

/* The light that was chosen. */
typedef struct LightPick {
    int entry; /* -1: there is no light */
    int face;  /* of its mesh light, or -1: not chosen yet */
    float probability;
    float u_part; /* the random number for the part, uniform again */
} LightPick;

/* Sample light for a point: u_pick chooses the light, u_part the part of it (of many lights, both together), u1 and u2
 * the point on it. Returns 0 where no light reaches the point. */
LightPick lights_pick(const Lights *lights, const LightSampleContext *point, float u_pick, float u_part);
/* The light source that was picked; NULL: a light of another kind, or none. */
const Light *lights_picked_source(const Lights *lights, const LightPick *pick);
int lights_sample(const Lights *lights, const LightSampleContext *point, const LightPick *pick, float u1, float u2,
                  LightSample *sample);
/* The picked face of a mesh, if its radiance is uniform and rays of paths see it; else NULL. Such a face is sampled by
 * the matte kernel (path/matte.h) instead of lights_sample. *density: of points on the face, by area. */
const struct MeshLightFace *lights_uniform_face(const Lights *lights, const LightPick *pick, double *density);
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
int lights_emission(const Lights *lights, float u_pick, float u_part, float u1, float u2, EmissionPoint *point);
/* Estimate of the irradiance of all lights on a surface that faces them. */
float lights_estimate(const Lights *lights, const LightSampleContext *point);

/* Radiance of sky and background in a direction: that they are seen with, or that surfaces are lit with. */
Rgb sky_radiance(const Scene *scene, Vec3 direction, int seen);
/* 0: it is black in all directions, as far as the table of the sky tells. Quick where it is not. */
int sky_shines(const Scene *scene);

/* environment.c: importance table of the sky */
typedef struct Environment Environment;
/* *environment is NULL where the sky is black. */
int environment_create(Environment **environment, const Scene *scene, RetexError *err);
void environment_close(Environment **environment);
Vec3 environment_sample(const Environment *environment, float u1, float u2, float *pdf);
float environment_pdf(const Environment *environment, Vec3 direction);
float environment_mean(const Environment *environment); /* mean luminance over the sphere */

/* source.c: one of POV-Ray's light sources seen from a point: direction, distance, irradiance on a facing surface. */
Rgb source_irradiance(const Light *light, Vec3 position, Vec3 light_point, Vec3 *direction, double *distance);
/* The most irradiance that it may give on a ray from its tmin on, up to a distance; as if spots shone everywhere. */
float source_most_irradiance(const Light *light, const Ray *ray, double distance);
/* The part of a ray, from its tmin on and up to a distance, where the light may shine, by its cone or cylinder.
 * Returns 0 where there is none. */
int source_lit_part(const Light *light, const Ray *ray, double distance, double *begin, double *end);
int source_is_beam(const Light *light); /* parallel light, that comes from infinitely far */
/* Whether a ray meets a light source that has caustics: a small sphere, the plane of an area_light, a small cone of
 * directions for beams. All such rays together have source_irradiance where they come from. Fills what source_sample
 * fills. */
int source_meet(const Light *light, const Ray *ray, LightSample *sample);
/* For the tree; not for beams. */
LightBounds source_bounds(const Light *light);
Vec3 source_point(const Light *light, Vec3 position, float u1, float u2);
/* Sample a light source; returns 0 where it gives no light. Shadows are not looked at. */
int source_sample(const Light *light, Vec3 position, float u1, float u2, LightSample *sample);

#endif
