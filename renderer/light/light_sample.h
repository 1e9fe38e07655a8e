/* A sample of light that comes to a point: one point of one light. */
#ifndef RENDERER_LIGHT_LIGHT_SAMPLE_H
#define RENDERER_LIGHT_LIGHT_SAMPLE_H

#include "scene/scene.h"
#include "shape/surface.h"

typedef struct LightSample {
    Vec3 direction;      /* from the lit point, unit length */
    double distance;     /* INFINITY for the sky */
    Rgb radiance;        /* not divided by pick_probability and pdf. Of a light source: irradiance on a surface that
                            faces it. Of an emitting shape the caller evaluates it at `surface` */
    float pick_probability; /* of having picked this light */
    float pdf;           /* per solid angle, without pick_probability; 0 for a light source */
    int shadowless;
    int lamp;            /* of the scene's lamps */
    /* NULL, or the light source that it is, which no path hits; and where its shadow ray goes: to a point of the grid
     * of an area_light, while its light comes from the middle. */
    const Light *source;
    Vec3 shadow_direction;
    double shadow_distance;
    Surface surface;     /* of an emitting shape; surface.primitive is NULL for all other lights */
} LightSample;

static inline int light_sample_is_emitter(const LightSample *sample)
{
    return sample->surface.primitive != NULL;
}

#endif
