/* One light path, from the camera on. */
#ifndef RENDERER_PATH_PATH_H
#define RENDERER_PATH_PATH_H

#include "accel/accel.h"
#include "base/color4.h"
#include "film/control.h"
#include "film/film.h"
#include "path/caustics.h"
#include "render/render.h"
#include "path/vertex_samples.h"
#include "light/lights.h"
#include "shade/bsdf.h"

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

/* One factor of a connection: a surface it scatters at or passes. */
typedef struct Factor {
    int target;          /* -1: none */
    Float4 d, i, albedo; /* it is d albedo + i */
    const Rgb *albedos; /* by variant, or NULL: the same in all */
    Vec2 uv;
    int reflects; /* light stays on its side of the surface */
    int sharp;    /* nothing on the way from the camera scattered widely */
} Factor;

static inline Float4 factor_whole(const Factor *f)
{
    return f->d * f->albedo + f->i;
}

/* Light that reached the ends of paths, in the order it came: what a control film gets when they end. */
typedef struct ControlLog {
    Rgb *lights; /* of so many variants each */
    int *next;   /* of the same path; -1: none */
    int count;
} ControlLog;

/* One thread's counters and scratch. */
typedef struct PathWorker {
    const PathContext *context;
    FilmPixel *pixel;
    const RenderVariant *variants;           /* or NULL: the original */
    ControlPixel *control;                   /* gets all variants, or NULL */
    struct PixelGuides *guides;              /* get what rays from the camera meet, or NULL */
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

/* Everything shading needs at a hit: the surface, its colour and its BSDF. */
typedef struct Shading {
    Surface surface;
    Rgb albedo;   /* the original's */
    int replaced; /* some variant has another one: by variant */
    Rgb albedos[VARIANTS_MAX];
    float filter, transmit;
    Vec2 uv; /* of a target: where a replacement is looked up */
    Bsdf bsdf;
} Shading;

/* Where a replacement texture is looked up on a surface, were it a target. */
Vec2 surface_target_uv(const Surface *surface);
/* Where an image is looked up on a surface: a point of its pattern space, if it is known already. */
typedef struct ImagePlace {
    int is_known;
    Vec3 point;
} ImagePlace;

/* The colours at a surface (shading->surface is filled), the original's and those of variants (NULL = none). place:
 * what shading_prefetch found, or NULL. */
void shading_color(Shading *shading, const ImagePlace *place, const RenderVariant *variants, int nvariants);
/* They will be asked for soon. */
ImagePlace shading_prefetch(const Surface *surface);
void shading_at(Shading *shading, const Scene *scene, const RenderVariant *variants, int nvariants, const Ray *ray,
                const Hit *hit);
static inline Rgb shading_albedo(const Shading *s, int variant)
{
    return s->replaced ? s->albedos[variant] : s->albedo;
}

/* AOV_ROUGHNESS and AOV_METALLIC of render.h. */
float shading_roughness(const Shading *shading);
float shading_metallic(const Shading *shading);

/* Which rays a path goes on with: light that bends in glass is still looked at by the camera. */
static inline RayKind path_next_kind(RayKind kind, const Bsdf *bsdf, int transmitted)
{
    return transmitted && bsdf->refracts ? kind : RAY_BOUNCE;
}

int path_worker_open(PathWorker *worker, RetexError *err); /* the rest is filled in */
void path_worker_close(PathWorker *worker);
/* Up to PATHS_MAX paths of one pixel, side by side; what they bring is the same as of one after the other. The first is
 * of the first half of the samples. One only where what happens is said. */
void path_trace(PathWorker *worker, const Ray *rays, const Sampler *samplers, int count);

#endif
