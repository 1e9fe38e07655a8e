/* What paths are traced with and by: the scene and its helpers, and a thread's state. */
#ifndef RENDERER_PATH_CONTEXT_H
#define RENDERER_PATH_CONTEXT_H

#include <stdio.h>
#include "film/control.h"
#include "film/split.h"
#include "light/lights.h"
#include "path/sampler.h"
#include "path/shading.h"

#define SHADOW_FACTORS_MAX 16 /* factors of targets on one shadow ray */
#define LIGHT_FACTORS_MAX 8   /* of an emitter that is sampled: its own, and of layers above it that are targets */
#define MEDIA_MAX 4           /* fading interiors that a path may be in at once */
#define FILLED_MAX 8          /* interiors with participating media that a path may be in at once */
#define PATHS_MAX 128         /* that are traced side by side */

/* What a ray is in. */
typedef struct Media {
    const Interior *interiors[MEDIA_MAX]; /* those that fade light */
    int count;
    int solids; /* how many things that are not hollow: neither fog nor media are in them */
    const Interior *filled[FILLED_MAX]; /* those with participating media; the same one as often as it was entered */
    int nfilled;
} Media;

typedef struct PathContext {
    const Scene *scene;
    const Accel *accel;
    const Lights *lights;
    const struct Caustics *caustics; /* or NULL */
    int max_depth;
    int split;         /* keep hits on targets apart */
    int places;        /* samples are spread evenly over pixels: with split, tell the film where in its pixel each is */
    int matte;         /* packets may sample matte surfaces together, see matte.h */
    int nvariants;     /* 1..VARIANTS_MAX: sets of textures that each path is evaluated with; 1 where split */
    float exposure;    /* by which light becomes values of the picture */
    int halves;        /* of a pixel's samples: 1, or 2 with sample numbers of their own, in turn */
    int caustic_sources; /* light sources that paths may meet, for they have caustics */
    int white;         /* first hits are white diffuse surfaces that do not emit */
    int has_no_shadow; /* some primitive throws no shadow: shadow rays and paths see different primitives */
    int has_air;       /* the scene has fog or rainbows */
    Media camera;      /* what the camera is in */
    int is_beyond;     /* paths go on beyond the maximum depth, only to tell how much light it leaves out */
    double reach;      /* how far media of the air that vary from place to place are looked at */
    FILE *trace;       /* print every step, or NULL */
} PathContext;

/* Is told what a ray from the camera meets: hit->primitive is -1, or the shading has its BSDF. pixel: of FirstHits.
 * Returns how many more of the pixel it wants to be told. */
typedef int FirstHitObserver(void *pixel, const Ray *ray, const Hit *hit, const Shading *shading);

/* What a pixel is told of first hits. */
typedef struct FirstHits {
    void *pixel; /* the observer's */
    int wanted;  /* 0: there is no observer, or it has enough */
} FirstHits;

/* What a path brought. */
typedef struct PathResult {
    double light[3]; /* the sum of its contributions */
    double cut;      /* luminance that the maximum depth left out, an estimate */
    TargetTree hits; /* of sets; it borrows memory of the worker, until that traces the next paths */
} PathResult;

/* One thread's counters and scratch. */
typedef struct PathWorker {
    const PathContext *context;
    FilmPixel *pixel;
    ControlPixel *control;                   /* or NULL: there is no control film */
    const RenderVariant *variants;           /* or NULL: the original */
    FirstHitObserver *observe;
    FirstHits first_hits[PATHS_MAX];         /* of the pixels whose paths are traced side by side */
    RenderVariant own[CONTROL_VARIANTS_MAX]; /* the variants, where the last one has constants by pixel */
    Rgb constants[RETEX_MAX_TARGETS];        /* of the current pixel */
    SplitSink split; /* of sets */
    uint32_t draws; /* random numbers that the current path took in media */
    long segments, shadow_rays;
    /* By variant: colours at the lights sampled for a packet and at the surfaces on a shadow ray; what all paths have
     * that are traced side by side. */
    Rgb light_albedos[ACCEL_PACKET][LIGHT_FACTORS_MAX][VARIANTS_MAX], shadow_albedos[SHADOW_FACTORS_MAX][VARIANTS_MAX];
    ControlPath controls[PATHS_MAX];
} PathWorker;

#endif
