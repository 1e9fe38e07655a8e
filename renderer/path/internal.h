/* What a path is made of; private to path.c, contributions.c, shadow_ray.c and vertex.c. */
#ifndef RENDERER_PATH_INTERNAL_H
#define RENDERER_PATH_INTERNAL_H

#include "base/color4.h"
#include "path/path.h"

#define STRAIGHT_MAX 128 /* surfaces a path or shadow ray may pass without bending */

/* The fading interiors a ray is in. */
typedef struct Media {
    const Interior *interiors[MEDIA_MAX];
    int count;
} Media;

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

/* Light arrives, or the path goes on. */
typedef struct Path {
    Float4 beta;          /* throughput */
    Rgb *betas;           /* by variant, from the second on: the first one's is beta */
    Float4 outside;       /* throughput but for target hits: where it is black no texture brings light back */
    float neutral;        /* throughput with NEUTRAL_ALBEDO everywhere: for Russian roulette */
    float pdf;            /* density of the direction, 0 after a delta */
    LitPoint from;        /* where that direction was sampled */
    int segments, passed; /* so far; passed: surfaces that did not bend the path, which are no segments of their own */
    int sharp;            /* so far every bounce was specular, or nearly so */
    RayKind kind;
    uint32_t sample; /* in its half of the pixel's */
    int half;
    Media media;
    double light[3];             /* that arrived */
    int first_light, last_light; /* in the worker's log, or -1 */
    /* In sets: */
    HitCounts size;    /* of the hits that it came by */
    int folded;            /* a target hit beyond the last order kept its albedo */
    PathHits hits;         /* and those that only light came by */
    PathHit *from_hit;     /* the last that it came by, or NULL, */
    Float4 from_d, from_i; /* and what that does to it */
    PathHit *here;         /* the hit where the path is, once light came by it; or NULL */
} Path;

/* Light picked for a vertex, before it is known whether anything is in the way. */
typedef struct LightTry {
    int found;  /* 0: none that could give any */
    int looked; /* way is known */
    AccelWay way;
    LightSample light;
    Ray ray;        /* to the light */
    int other_side; /* of the surface */
    float pdf;      /* with which the BSDF would find the direction */
    Factor factors[2];
    int nfactors;
} LightTry;

/* Where a ray met the scene, and what is chosen there. */
typedef struct Vertex {
    int met, last; /* last: the path does not go on but where it passes straight */
    double distance;
    Shading s;
    ImagePlace place;
    const VertexSamples *numbers; /* of the packet, this one's in a lane of it */
    int lane;
    int picked; /* a light was */
    LightPick pick;
    LightTry light;
    const CausticsCell *cell; /* where caustics come from, or NULL: none, or nothing scatters widely */
} Vertex;

/* ---- contributions.c: what reaches the film ---- */

/* d times the colour at a surface, and i. */
Factor shading_factor(const Shading *s, Float4 d, Float4 i);
void path_start(PathWorker *worker, Path *path, const Ray *ray, const Sampler *sampler);
/* Can any light come by it? */
static inline int path_is_alive(const PathWorker *w, const Path *path)
{
    const PathContext *c = w->context;
    if (c->split)
        return !is_black4(path->outside);
    int alive = !is_black4(path->beta);
    for (int v = 1; v < c->nvariants && !alive; v++)
        alive = !rgb_is_black(path->betas[v]);
    return alive;
}
/* By what no target did. Returns 0 where no light can come by it. */
static inline int path_scale(PathWorker *w, Path *path, Rgb by)
{
    path->beta *= colour4(by);
    path->outside *= colour4(by);
    for (int v = 1; v < w->context->nvariants; v++)
        path->betas[v] = rgb_mul(path->betas[v], by);
    return path_is_alive(w, path);
}
/* A bounce, of which the surface makes d times its colour, and i. Returns 0 likewise. */
int path_scatter(PathWorker *worker, Path *path, const Shading *s, Float4 d, Float4 i, int reflects);
/* Light reaches the path's end through some more factors. */
void path_connect(PathWorker *worker, Path *path, Rgb light, const Factor *factors, int nfactors);
/* By variant, through no factor of a target: all are in it. */
void path_bring(PathWorker *worker, Path *path, const Rgb *lights);
void path_end(PathWorker *worker, Path *path);
/* May a surface's factors go into a scale or light as they are? */
static inline int path_sees_plain(const PathContext *c, const Shading *s)
{
    return !c->split || s->surface.target < 0;
}

/* ---- shadow_ray.c: what is on the way ---- */

Rgb media_fade(const Media *media, double distance, const Surface *met);
void media_cross(Media *media, const Surface *surface);
/* Colours of variants for a factor that outlives its shading. */
const Rgb *keep_albedos(const PathContext *context, Rgb *room, const Shading *s);
/* What the way to a picked light does to it goes into its radiance and, where targets do it, into factors. Returns how
 * many of these there are, or -1 where the way is blocked. */
int way_to_light(PathWorker *worker, const Path *path, const Surface *from, LightTry *light, Factor *factors, int room);
/* Density with which the path itself finds what a shadow ray found, given that of its direction: 0 where it cannot, for
 * the ways of the two are not blocked by the same things. -1: nobody should. */
float path_density(const PathContext *context, const Ray *ray, RayKind kind, const LightSample *light, float pdf);

/* ---- vertex.c: what is chosen at a surface ---- */

LitPoint lit_point(const Shading *s);
/* Radiance over albedo: what is not there does not shine. */
Split emitted(const Shading *s);
const CausticsCell *guide_cell(const PathContext *context, const Shading *s);
void pick_light(PathWorker *worker, Vertex *vertex);
/* Choose a direction by the BSDF or the guide: first between deltas and the rest. The sample's weight and density are
 * the BSDF's own; *pdf gets that of both ways. */
int sample_direction(const Vertex *vertex, BsdfSample *sample, float *pdf);

static inline float mis_weight(float a, float b)
{
    float ratio = b / a; /* the squares of densities may be too large for a float */
    return 1 / (1 + ratio * ratio);
}

#endif
