/* One light path, from the camera on. */
#ifndef RENDERER_INTEGRATE_PATH_H
#define RENDERER_INTEGRATE_PATH_H

#include "accel/accel.h"
#include "film/film.h"
#include "integrate/render.h"
#include "integrate/sampler.h"
#include "light/lights.h"
#include "shade/bsdf.h"

typedef struct PathContext {
    const Scene *scene;
    const Accel *accel;
    const Lights *lights;
    int max_depth, orders;
    int split;            /* keep target hits apart */
    int has_no_shadow;    /* some primitive throws no shadow: what blocks shadow rays and paths is not the same */
    FILE *trace;          /* say what happens, or NULL */
} PathContext;

/* One thread's counters and scratch. */
typedef struct PathWorker {
    const PathContext *context;
    FilmPixel *pixel;
    Expansion scratch;    /* a path's expansion with a connection's own hits */
    long segments, shadow_rays;
} PathWorker;

/* Everything shading needs at a hit: the surface, its colour and its BSDF. */
typedef struct Shading {
    Surface surface;
    Rgb albedo;           /* with a replacement texture: that one's */
    float filter, transmit;
    Vec2 uv;              /* of a target: where a replacement is looked up */
    Bsdf bsdf;
} Shading;

/* Where a replacement texture is looked up on a surface, were it a target. */
Vec2 surface_target_uv(const Surface *surface);
/* The colour at a surface (shading->surface is filled), with its replacement. */
void shading_color(Shading *shading, const Scene *scene);
void shading_at(Shading *shading, const Scene *scene, const Ray *ray, const Hit *hit);

void path_trace(PathWorker *worker, Ray ray, const Sampler *sampler);

#endif
