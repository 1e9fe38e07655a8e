/* Ray queries through Embree.
 *
 * Embree works in float; this renderer asks for double positions and for rays that never meet the surface they leave.
 * So Embree only proposes. A triangle it finds is checked in double against its plane: one that lies outside the ray's
 * own double range, or on whose plane the ray starts (within the rounding error of the plane's equation, however large
 * the triangle), is passed, and the ray goes on behind it. That happens rarely, for rays start off the surface they
 * leave by more than float's rounding (accel_offset). Occlusion, which stops at any triangle, asks a filter function
 * instead. Curved shapes are user geometry and double throughout. Boxes and meshes are one triangle geometry in world
 * space. Visibility by kind of ray is decided in the same places: Embree may be built without masks.
 *
 * Rays come one by one or in packets, which pay where they run side by side. */
#include <float.h>
#include <string.h>
#include "accel/embree.h"

#define FLOAT_DOUBT 1e-3 /* share by which a distance in float may be off, along grazing triangles too */

/* A ray in double, and the nearest curved shape on it so far. */
typedef struct QueryRay {
    const Ray *ray;
    double rounding; /* a plane whose height over the origin is this small goes through it */
    double t;
    int face;
    unsigned kind;   /* flag that a primitive must have to be seen */
    unsigned passes; /* flags of those that are passed */
    int passed;      /* one was */
} QueryRay;

typedef enum HitField { HIT_PRIMITIVE = 5, HIT_GEOMETRY, HIT_INSTANCE, HIT_HITS = 12 /* after a ray's */ } HitField;

/* Embree hands the context to every callback: ours carries the rays in double, by the rays' ids. */
typedef struct Query {
    QueryContext context;
    const Accel *accel;
    QueryRay *rays;
} Query;

static inline int visible(const Accel *accel, const QueryRay *of, int primitive)
{
    return (accel->flags[primitive] & of->kind) != 0;
}

/* Something on the ray is met: is it passed? */
static inline int pass(const Accel *accel, QueryRay *of, int primitive)
{
    if (!(accel->flags[primitive] & of->passes))
        return 0;
    of->passed = 1;
    return 1;
}

/* ---- triangles in double ---- */

/* Distance to the triangle's plane; 0 where the ray runs along it or starts on it, or is not to see the triangle. */
static inline int triangle_distance(const Accel *accel, const QueryRay *of, const Triangle *triangle, double *t)
{
    const Ray *ray = of->ray;
    Vec3 n = triangle->normal;
    double height = triangle->offset - vec_dot(n, ray->origin), fall = vec_dot(n, ray->direction);

    if (fabs(height) <= of->rounding || fall == 0)
        return 0;
    *t = height / fall;
    return *t > ray->tmin && *t < ray->tmax && visible(accel, of, triangle->primitive);
}

/* ---- callbacks ---- */

/* N rays or hits lie field by field, as in RTCRay and RTCHit; Embree has accessors for C++ only. */
static inline float *ray_tfar(const void *rays, unsigned n, unsigned i)
{
    return (float *)rays + (8 * n + i);
}
static inline unsigned ray_id(const void *rays, unsigned n, unsigned i)
{
    return ((const unsigned *)rays)[10 * n + i];
}
static inline unsigned *hit_field(const void *hits, unsigned n, unsigned i, HitField field)
{
    return (unsigned *)hits + ((unsigned)field * n + i);
}

void accel_filter_occluder(const struct RTCFilterFunctionNArguments *args)
{
    const Query *query = (const Query *)args->context;
    double t;

    for (unsigned i = 0; i < args->N; i++) {
        if (!args->valid[i])
            continue;
        QueryRay *of = &query->rays[ray_id(args->ray, args->N, i)];
        const Triangle *triangle = &query->accel->triangles[*hit_field(args->hit, args->N, i, HIT_PRIMITIVE)];
        if (!triangle_distance(query->accel, of, triangle, &t) || pass(query->accel, of, triangle->primitive))
            args->valid[i] = 0;
    }
}

static int meet_curved(const Query *query, const QueryRay *of, unsigned index, float tfar, double *t, int *face)
{
    const Accel *accel = query->accel;
    int primitive = accel->curved[index];
    Ray ray = *of->ray;

    if (!visible(accel, of, primitive))
        return 0;
    ray.tmax = ray.tmax < tfar ? ray.tmax : tfar;
    return shape_intersect(&accel->source->primitives[primitive], &ray, t, face);
}

void accel_intersect_curved(const struct RTCIntersectFunctionNArguments *args)
{
    Query *query = (Query *)args->context;
    const void *rays = args->rayhit, *hits = (const unsigned *)rays + HIT_HITS * args->N;

    for (unsigned i = 0; i < args->N; i++) {
        QueryRay *of = &query->rays[ray_id(rays, args->N, i)];
        if (!args->valid[i] || !meet_curved(query, of, args->primID, *ray_tfar(rays, args->N, i), &of->t, &of->face))
            continue;
        *ray_tfar(rays, args->N, i) = (float)of->t;
        *hit_field(hits, args->N, i, HIT_GEOMETRY) = query->accel->curved_geometry;
        *hit_field(hits, args->N, i, HIT_PRIMITIVE) = args->primID;
        *hit_field(hits, args->N, i, HIT_INSTANCE) = RTC_INVALID_GEOMETRY_ID;
    }
}

void accel_occlude_curved(const struct RTCOccludedFunctionNArguments *args)
{
    const Query *query = (const Query *)args->context;
    const Accel *accel = query->accel;
    double t;
    int face;

    for (unsigned i = 0; i < args->N; i++) {
        QueryRay *of = &query->rays[ray_id(args->ray, args->N, i)];
        float *tfar = ray_tfar(args->ray, args->N, i);
        if (args->valid[i] && meet_curved(query, of, args->primID, *tfar, &t, &face) &&
            !pass(accel, of, accel->curved[args->primID]))
            *tfar = -INFINITY;
    }
}

/* ---- starting ---- */

/* Embree may stop the program over a ray that is not finite; no such ray meets anything. */
static inline int can_be_traced(const Ray *ray, double origin_size)
{
    const Vec3 *d = &ray->direction;

    return origin_size < LARGEST_COORDINATE && fabs(d->x) + fabs(d->y) + fabs(d->z) < LARGEST_COORDINATE &&
           ray->tmin == ray->tmin && ray->tmax == ray->tmax;
}

static inline void start_query(Query *query, const Accel *accel, int side_by_side, QueryRay *rays)
{
#if defined(RETEX_EMBREE4)
    rtcInitRayQueryContext(&query->context);
#else
    rtcInitIntersectContext(&query->context);
    query->context.flags = side_by_side ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
#endif
    query->accel = accel;
    query->rays = rays;
}

/* Embree gets the ray in float, its range widened by what float may be off; the double one decides. Returns 0 where
 * the ray meets nothing for certain. */
static inline int start_ray(QueryRay *of, const Accel *accel, const Ray *ray, RayKind kind, unsigned passes,
                            float *tnear, float *tfar)
{
    double size = fabs(ray->origin.x) + fabs(ray->origin.y) + fabs(ray->origin.z);
    double start = ray->tmin > 0 ? ray->tmin - FLOAT_DOUBT * (ray->tmin + size) : 0;

    of->ray = ray;
    /* Every coordinate that goes into the height is at most the sum of both; the normal's are 1.8 together. */
    of->rounding = 28 * DBL_EPSILON * (accel->reach + size);
    of->t = INFINITY;
    of->face = 0;
    of->kind = (unsigned)kind;
    of->passes = passes;
    of->passed = 0;
    *tnear = start > 0 ? (float)start : 0;
    *tfar = (float)(ray->tmax + FLOAT_DOUBT * (ray->tmax + size));
    return can_be_traced(ray, size);
}

static inline int start_single(QueryRay *of, struct RTCRay *to, const Accel *accel, const Ray *ray, RayKind kind,
                               unsigned passes)
{
    to->org_x = (float)ray->origin.x, to->org_y = (float)ray->origin.y, to->org_z = (float)ray->origin.z;
    to->dir_x = (float)ray->direction.x, to->dir_y = (float)ray->direction.y, to->dir_z = (float)ray->direction.z;
    to->time = 0, to->mask = 0xffffffffu, to->id = to->flags = 0;
    return start_ray(of, accel, ray, kind, passes, &to->tnear, &to->tfar);
}

/* The nearest plane before limit, of those that are not passed; any plane will do where any is set. Returns its
 * primitive or -1. */
static int nearest_plane(const Accel *accel, QueryRay *of, double *limit, int any)
{
    Ray ray = *of->ray;
    int found = -1, face;
    double t;

    ray.tmax = fmin(ray.tmax, *limit);
    for (int i = 0; i < accel->nplanes; i++) {
        int primitive = accel->planes[i];
        if (!visible(accel, of, primitive) ||
            !shape_intersect(&accel->source->primitives[primitive], &ray, &t, &face) || pass(accel, of, primitive))
            continue;
        found = primitive;
        *limit = ray.tmax = t;
        if (any)
            break;
    }
    return found;
}

/* ---- single rays ---- */

static void trace(Query *query, struct RTCRayHit *rayhit)
{
#if defined(RETEX_EMBREE4)
    struct RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.context = &query->context;
    args.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcIntersect1(query->accel->scene, rayhit, &args);
#else
    rtcIntersect1(query->accel->scene, &query->context, rayhit);
#endif
}

static void trace_occluded(Query *query, struct RTCRay *ray)
{
#if defined(RETEX_EMBREE4)
    struct RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.context = &query->context;
    args.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcOccluded1(query->accel->scene, ray, &args);
#else
    rtcOccluded1(query->accel->scene, &query->context, ray);
#endif
}

/* What Embree found, as a hit; 0 where the ray does not meet that triangle. */
static inline int accept(const Accel *accel, const QueryRay *of, unsigned geometry, unsigned index, float u, float v,
                         Hit *hit)
{
    const Triangle *triangle = &accel->triangles[index];

    if (geometry == accel->curved_geometry) {
        hit->t = of->t, hit->primitive = accel->curved[index], hit->face = of->face;
        return 1;
    }
    if (!triangle_distance(accel, of, triangle, &hit->t))
        return 0;
    hit->primitive = triangle->primitive;
    hit->face = triangle->face;
    hit->normal = triangle->normal;
    hit->b1 = u, hit->b2 = v; /* in float, which is enough to interpolate; Embree keeps them inside */
    return 1;
}

/* Let the ray look for what is further away than what it found. */
static void go_behind(struct RTCRayHit *rayhit, float end)
{
    rayhit->ray.tnear = nextafterf(rayhit->ray.tfar, INFINITY);
    rayhit->ray.tfar = end;
    rayhit->hit.geomID = RTC_INVALID_GEOMETRY_ID;
}

static int add_planes(const Accel *accel, QueryRay *of, Hit *hit)
{
    double limit = hit->primitive >= 0 ? hit->t : of->ray->tmax;
    int plane = accel->nplanes ? nearest_plane(accel, of, &limit, 0) : -1;

    if (plane >= 0)
        hit->t = limit, hit->primitive = plane, hit->face = 0;
    return hit->primitive >= 0;
}

int accel_intersect(const Accel *accel, const Ray *ray, RayKind kind, Hit *hit)
{
    Query query;
    QueryRay of;
    struct RTCRayHit rayhit;
    float end;

    hit->primitive = -1;
    start_query(&query, accel, 0, &of);
    if (!start_single(&of, &rayhit.ray, accel, ray, kind, 0))
        return 0;
    end = rayhit.ray.tfar;
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    for (trace(&query, &rayhit); rayhit.hit.geomID != RTC_INVALID_GEOMETRY_ID; trace(&query, &rayhit)) {
        if (accept(accel, &of, rayhit.hit.geomID, rayhit.hit.primID, rayhit.hit.u, rayhit.hit.v, hit))
            break;
        go_behind(&rayhit, end);
    }
    return add_planes(accel, &of, hit);
}

static AccelWay look_along(const Accel *accel, const Ray *ray, RayKind kind, unsigned passes)
{
    Query query;
    QueryRay of;
    struct RTCRay occluded;
    double limit = ray->tmax;

    start_query(&query, accel, 0, &of);
    if (!start_single(&of, &occluded, accel, ray, kind, passes))
        return WAY_FREE;
    if (accel->nplanes && nearest_plane(accel, &of, &limit, 1) >= 0)
        return WAY_BLOCKED;
    trace_occluded(&query, &occluded);
    return occluded.tfar < 0 ? WAY_BLOCKED : of.passed ? WAY_PASSABLE : WAY_FREE;
}

int accel_occluded(const Accel *accel, const Ray *ray, RayKind kind, int skip_transparent)
{
    return look_along(accel, ray, kind, skip_transparent ? TRANSPARENT : 0) == WAY_BLOCKED;
}

AccelWay accel_way(const Accel *accel, const Ray *ray, int light_source)
{
    return look_along(accel, ray, RAY_SHADOW, light_source ? TRANSPARENT : STRAIGHT);
}

/* ---- packets ---- */

typedef struct Packet {
    _Alignas(64) struct RTCRayHit16 rays;
    _Alignas(64) int valid[ACCEL_PACKET];
    QueryRay of[ACCEL_PACKET];
} Packet;

/* Embree does not look at lanes that are not valid where it has packets as wide; where it has narrower ones it looks at
 * all with a range, whatever it is told. */
static void blank_lane(Packet *p, int i)
{
    struct RTCRay16 *to = &p->rays.ray;

    to->org_x[i] = to->org_y[i] = to->org_z[i] = to->dir_x[i] = to->dir_y[i] = to->dir_z[i] = 1;
    to->time[i] = to->tnear[i] = 0, to->tfar[i] = -1, to->mask[i] = to->id[i] = to->flags[i] = 0;
    p->valid[i] = 0;
}

static void start_lane(Packet *p, int i, const Accel *accel, const Ray *ray, RayKind kind, unsigned passes)
{
    struct RTCRay16 *to = &p->rays.ray;

    if (!start_ray(&p->of[i], accel, ray, kind, passes, &to->tnear[i], &to->tfar[i])) {
        blank_lane(p, i);
        return;
    }
    to->org_x[i] = (float)ray->origin.x, to->org_y[i] = (float)ray->origin.y, to->org_z[i] = (float)ray->origin.z;
    to->dir_x[i] = (float)ray->direction.x, to->dir_y[i] = (float)ray->direction.y;
    to->dir_z[i] = (float)ray->direction.z;
    to->time[i] = 0, to->mask[i] = 0xffffffffu, to->id[i] = (unsigned)i, to->flags[i] = 0;
    p->valid[i] = -1;
}

static void fill_up(Packet *p, int count)
{
    for (int i = count; i < ACCEL_PACKET; i++)
        blank_lane(p, i);
}

void accel_intersect_packet(const Accel *accel, const Ray *rays, const RayKind *kinds, int count, int side_by_side,
                            Hit *hits)
{
    Packet p;
    Query query;

    start_query(&query, accel, side_by_side, p.of);
    for (int i = 0; i < count; i++)
        start_lane(&p, i, accel, &rays[i], kinds[i], 0);
    fill_up(&p, count);
    for (int i = 0; i < ACCEL_PACKET; i++)
        p.rays.hit.geomID[i] = p.rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
#if defined(RETEX_EMBREE4)
    struct RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.context = &query.context;
    args.flags = side_by_side ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcIntersect16(p.valid, accel->scene, &p.rays, &args);
#else
    rtcIntersect16(p.valid, accel->scene, &query.context, &p.rays);
#endif
    for (int i = 0; i < count; i++)
        if (p.rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID && p.rays.hit.geomID[i] != accel->curved_geometry)
            __builtin_prefetch(&accel->triangles[p.rays.hit.primID[i]]);
    for (int i = 0; i < count; i++) {
        hits[i].primitive = -1;
        if (!p.valid[i])
            continue;
        if (p.rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID &&
            !accept(accel, &p.of[i], p.rays.hit.geomID[i], p.rays.hit.primID[i], p.rays.hit.u[i], p.rays.hit.v[i],
                    &hits[i]))
            accel_intersect(accel, &rays[i], kinds[i], &hits[i]); /* seldom: it takes another look behind that */
        else
            add_planes(accel, &p.of[i], &hits[i]);
    }
}

void accel_way_packet(const Accel *accel, const Ray *rays, const int *light_sources, int count, AccelWay *ways)
{
    Packet p;
    Query query;

    start_query(&query, accel, 1, p.of);
    for (int i = 0; i < count; i++)
        start_lane(&p, i, accel, &rays[i], RAY_SHADOW, light_sources[i] ? TRANSPARENT : STRAIGHT);
    fill_up(&p, count);
#if defined(RETEX_EMBREE4)
    struct RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.context = &query.context;
    args.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcOccluded16(p.valid, accel->scene, &p.rays.ray, &args);
#else
    rtcOccluded16(p.valid, accel->scene, &query.context, &p.rays.ray);
#endif
    for (int i = 0; i < count; i++) {
        double limit = rays[i].tmax;
        int behind = p.valid[i] &&
                     (p.rays.ray.tfar[i] < 0 || (accel->nplanes && nearest_plane(accel, &p.of[i], &limit, 1) >= 0));
        ways[i] = behind ? WAY_BLOCKED : p.of[i].passed ? WAY_PASSABLE : WAY_FREE;
    }
}
