/* Light sources of the scene language. No path hits them, unless they have caustics. A kind of light source is a row of
 * operations; fading, the grid of an area_light, projected_through and light groups are the same for all kinds.
 *
 * A light source is seen from a position by light that leaves a point of it: its location, or a place of its grid. */
#ifndef RENDERER_LIGHT_SOURCE_H
#define RENDERER_LIGHT_SOURCE_H

#include "light/sources.h"
#include "shape/surface.h"

/* Light that comes to a point from one point of a light, of whatever kind. */
typedef struct LightSample {
    Vec3 direction;      /* from the lit point, unit length */
    double distance;     /* INFINITY for the sky */
    Rgb radiance;        /* not divided by pick_probability and pdf. Of a light source: irradiance on a surface that
                            faces it. Of an emitting shape the caller evaluates it at `surface`, and that of the sky
                            once nothing blocks its ray: is_sky tells that it is still to be looked up */
    float pick_probability; /* of having picked this light */
    float pdf;           /* per solid angle, without pick_probability; 0 for a light source */
    int shadowless, is_sky;
    int lamp;            /* of the scene's lamps */
    /* NULL, or the light source that it is, which no path hits; and where its shadow ray goes: to a point of the grid
     * of an area_light, while its light comes from the middle. */
    const Light *source;
    Vec3 shadow_direction;
    double shadow_distance;
    Surface surface;     /* of an emitting shape; surface.primitive is NULL for all other lights */
} LightSample;

static inline int light_sample_is_shape(const LightSample *sample)
{
    return sample->surface.primitive != NULL;
}

typedef enum LightProperty {
    LIGHT_BEAM = 1,      /* its light comes from infinitely far, from point_at towards location */
    LIGHT_SHADOWLESS = 2 /* it may be shadowless: POV-Ray has other kinds so not */
} LightProperty;

struct LightOps {
    const char *name;
    const char *yields_to; /* the kind that it is where both are written, in either order; NULL: the last one written */
    unsigned properties;   /* bits of LightProperty */
    /* What differs from a light_source's defaults, before its own modifiers are read; and what must hold of its numbers
     * once it is placed. Each may be NULL. */
    void (*set_defaults)(Light *light);
    void (*settle)(Light *light);
    /* The direction to the light, of unit length, its distance, and the share of its colour that comes from there: 0
     * where it does not shine. Where the distance is 0 there is no direction. */
    double (*shine)(const Light *light, Vec3 position, Vec3 place, Vec3 *direction, double *distance);
    /* Whether a ray meets the light source, where it has caustics: as source_meet. */
    int (*meet)(const Light *light, const Ray *ray, Rgb *radiance, double *distance);
    /* Narrow begin and end, distances along a line `from` the light's location, to where the light may shine. Returns 0
     * where it shines nowhere between. NULL: it shines everywhere. */
    int (*lit_part)(const Light *light, Vec3 from, Vec3 direction, double *begin, double *end);
    /* Half-angle in radians of the cone about its axis out of which no light comes; 0, or above PI / 2: there is none.
     * NULL: it shines in all directions, or is a beam. */
    double (*cone)(const Light *light);
};

/* From location to point_at. */
static inline Vec3 light_axis(const Light *light)
{
    return vec_normalize(vec_sub(light->point_at, light->location));
}
static inline int light_is_beam(const Light *light)
{
    return light->ops->properties & LIGHT_BEAM;
}

/* Irradiance on a surface that faces it, in its fading; shadows are not looked at. */
Rgb source_irradiance(const Light *light, Vec3 position, Vec3 place, Vec3 *direction, double *distance);
/* The most irradiance that it may give on a ray from its tmin on, up to a distance; as if spots shone everywhere. */
float source_most_irradiance(const Light *light, const Ray *ray, double distance);
/* The part of a ray, from its tmin on and up to a distance, where it may shine. Returns 0 where there is none. */
int source_lit_part(const Light *light, const Ray *ray, double distance, double *begin, double *end);
/* Whether a ray meets a light source that has caustics: a small sphere, the plane of an area_light, a small cone of
 * directions for beams. All such rays together have source_irradiance where they come from. Fills what source_sample
 * fills. */
int source_meet(const Light *light, const Ray *ray, LightSample *sample);
/* A point of it that shines on a position. */
Vec3 source_point(const Light *light, Vec3 position, float u1, float u2);
/* Sample a light source; returns 0 where it gives no light. Shadows are not looked at. */
int source_sample(const Light *light, Vec3 position, float u1, float u2, LightSample *sample);

/* For rows: */

/* LightOps.shine of a point. */
double point_shine(const Light *light, Vec3 position, Vec3 place, Vec3 *direction, double *distance);
/* LightOps.meet of what shines from a place: a sphere, or the plane of its grid. */
int point_meet(const Light *light, const Ray *ray, Rgb *radiance, double *distance);
/* 0 below low, 1 above high, a smooth cubic between. */
static inline double light_smooth_step(double low, double high, double x)
{
    if (x <= low)
        return 0;
    if (x >= high)
        return 1;
    double t = (x - low) / (high - low);
    return (3 - 2 * t) * t * t;
}

#endif
