/* One light path, from the camera on. */
#ifndef RENDERER_PATH_PATH_H
#define RENDERER_PATH_PATH_H

#include <stdio.h>
#include "film/control.h"
#include "film/film.h"
#include "path/caustics.h"
#include "path/shading.h"
#include "path/vertex_samples.h"

#define SHADOW_FACTORS_MAX 16 /* targets a shadow ray may pass */
#define MEDIA_MAX 4           /* fading interiors that a path may be in at once */
#define PATHS_MAX 128         /* that are traced side by side */

typedef struct PathContext {
    const Scene *scene;
    const Accel *accel;
    const Lights *lights;
    const Caustics *caustics; /* or NULL */
    int max_depth, orders;
    int most_hits;     /* of all targets together */
    int split;         /* keep target hits apart */
    int matte;         /* matte surfaces may be looked at a packet at a time, see matte.h */
    int nvariants;     /* 1..VARIANTS_MAX: what the same path brings with different textures; 1 where split */
    int halves;        /* of a pixel's samples, which take turns: 1, or 2 with numbers of their own */
    int white;         /* the first hit is a white diffuse surface instead, that gives no light itself */
    int has_no_shadow; /* some primitive throws no shadow: what blocks shadow rays and paths is not the same */
    FILE *trace;       /* say what happens, or NULL */
} PathContext;

/* Light that reached the ends of paths, in the order it came: what a control film gets when they end. */
typedef struct ControlLog {
    Rgb *lights; /* of so many variants each */
    int *next;   /* of the same path; -1: none */
    int count;
} ControlLog;

/* Is told what a ray from the camera meets: hit->primitive is -1, or the shading has its BSDF. Returns how many more of
 * the pixel it wants to be told. */
typedef int FirstHitObserver(void *context, const Ray *ray, const Hit *hit, const Shading *shading);

/* One thread's counters and scratch. */
typedef struct PathWorker {
    const PathContext *context;
    FilmPixel *pixel;
    const RenderVariant *variants;           /* or NULL: the original */
    ControlPixel *control;                   /* gets all variants, or NULL */
    FirstHitObserver *first_hit;
    void *first_hit_context;
    int first_hits_wanted;                   /* of the pixel in hand; 0: there is no observer, or it has enough */
    RenderVariant own[CONTROL_VARIANTS_MAX]; /* variants, where they have constants by pixel */
    Rgb constants[RETEX_MAX_TARGETS];        /* of the pixel in hand */
    PathHit *hits;                           /* of sets: those of all paths that are traced side by side */
    int nhits;
    ControlLog log; /* where there is a control film: likewise */
    PixelKeys keys[2];
    uint32_t key[2]; /* of the sample numbers of the paths in hand, by half of the samples */
    long segments, shadow_rays;
    /* By variant: colours at the lights sampled for a packet and at what a shadow ray passes; throughputs of all paths
     * that are traced side by side. */
    Rgb light_albedos[ACCEL_PACKET][VARIANTS_MAX], shadow_albedos[SHADOW_FACTORS_MAX][VARIANTS_MAX];
    Rgb betas[PATHS_MAX][VARIANTS_MAX];
} PathWorker;

int path_worker_open(PathWorker *worker, RetexError *err); /* the rest is filled in */
void path_worker_close(PathWorker *worker);
/* Up to PATHS_MAX paths of one pixel, side by side; what they bring is the same as of one after the other. The first is
 * of the first half of the samples. One only where what happens is said. */
void path_trace(PathWorker *worker, const Ray *rays, const Sampler *samplers, int count);

#endif
