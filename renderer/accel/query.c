/* Ray queries through Embree.
 *
 * Embree computes in float. This renderer needs hit positions in double, and rays that do not intersect the surface
 * they start on. Embree therefore finds candidates, and this file computes their distances in double.
 *
 * Curved shapes are user geometry and are intersected in double only; the nearest one is kept beside Embree's ray.
 * The triangle that Embree reports is intersected again in double and compared with the nearest curved shape. The
 * ray is traced a second time, with every candidate along it tested in double, if one of these holds: the triangle
 * is outside the ray's range in double; the ray starts on the triangle's plane, within the rounding error of the
 * plane equation; the triangle is invisible to this kind of ray; Embree's distance is so inaccurate that it may have
 * missed a nearer primitive. The second trace is rare, because rays start off their surface by more than the
 * rounding of float (accel_offset). A filter function for every triangle of every ray would make packets slower by a
 * fifth. Occlusion queries stop at any triangle, so they always use a filter function.
 *
 * Distances passed to Embree (ends of rays, hits of curved shapes) are rounded outward by more than the error of
 * float. Embree therefore skips nothing that is nearer in double. Float still decides three things: whether a ray
 * intersects a triangle at all; on which side of the ray's origin the triangle is; and which of two triangles is
 * nearer, if their separation is within float's rounding of their coordinates.
 *
 * Boxes and meshes are one triangle geometry in world space. Visibility by kind of ray is tested in this file too,
 * because Embree may be built without ray masks. Rays are traced singly or in packets; packets are faster for
 * coherent rays. */
#include <float.h>
#include <string.h>
#include "accel/embree.h"

#define FLOAT_DOUBT 1e-3 /* bound of the relative error of a distance in float, for grazing triangles too */
#define FLOAT_TRUST 1e-6 /* usual relative error of a distance in float */

/* A ray in double and its nearest hit so far. */
typedef struct QueryRay {
    Ray ray;         /* tmax is just behind the nearest hit, so that hits at the same distance are found */
    Hit *hit;        /* the nearest hit so far; NULL if any hit ends the query */
    double size;     /* sum of the magnitudes of the origin's coordinates */
    double rounding; /* a plane with a distance from the origin below this counts as containing it */
    unsigned kind;   /* flag that a primitive must have to be visible to this ray */
    unsigned passes; /* flags of primitives that let this ray pass */
    int passed;      /* 1 if the ray has passed such a primitive */
} QueryRay;

typedef enum HitField { HIT_U = 3, HIT_V, HIT_PRIMITIVE, HIT_GEOMETRY, HIT_INSTANCE, HIT_HITS = 12 } HitField;

/* The context that Embree hands to every callback, with the rays in double. Ray ids are indices into it. */
typedef struct Query {
    QueryContext context;
    const Accel *accel;
    QueryRay *rays;
} Query;

static inline int visible(const Accel *accel, const QueryRay *of, int primitive)
{
    return (accel->flags[primitive] & of->kind) != 0;
}

/* 1 if the primitive lets the ray pass. */
static inline int pass(const Accel *accel, QueryRay *of, int primitive)
{
    if (!(accel->flags[primitive] & of->passes))
        return 0;
    of->passed = 1;
    return 1;
}

/* ---- intersection in double ---- */

/* Distance along the ray to the triangle's plane, if it is before the ray's end. 0 if the ray is parallel to the
 * plane or starts on it. */
static inline int triangle_distance(const QueryRay *of, const Triangle *triangle, double end, double *t)
{
    const Ray *ray = &of->ray;
    Vec3 n = triangle->normal;
    double height = triangle->offset - vec_dot(n, ray->origin), fall = vec_dot(n, ray->direction), distance;

    if (fabs(height) <= of->rounding || fall == 0)
        return 0;
    distance = height / fall;
    if (!(distance > ray->tmin && distance < end))
        return 0;
    *t = distance;
    return 1;
}

/* Store a hit if it is the nearest. Of two hits at the same distance the primitive that comes first in the scene
 * wins, so the result does not depend on the order of traversal. */
static inline int take(QueryRay *of, double t, int primitive, int face)
{
    Hit *hit = of->hit;

    if (hit->primitive >= 0 && (t > hit->t || (t == hit->t && (primitive > hit->primitive ||
                                                               (primitive == hit->primitive && face >= hit->face)))))
        return 0;
    hit->t = t, hit->primitive = primitive, hit->face = face;
    of->ray.tmax = t * (1 + DBL_EPSILON);
    return 1;
}

/* Barycentric coordinates are in float, which is exact enough for interpolation. Embree keeps them in range. */
static inline void take_triangle(QueryRay *of, const Triangle *triangle, double t, float b1, float b2)
{
    if (!take(of, t, triangle->primitive, triangle->face))
        return;
    of->hit->normal = triangle->normal;
    of->hit->b1 = b1, of->hit->b2 = b2;
}

/* 1 if the ray intersects a curved shape or a plane. */
static inline int meet_shape(const Accel *accel, const QueryRay *of, int primitive, double *t, int *face)
{
    return visible(accel, of, primitive) && shape_intersect(&accel->source->primitives[primitive], &of->ray, t, face);
}

static inline int take_shape(const Accel *accel, QueryRay *of, int primitive)
{
    double t;
    int face;

    return meet_shape(accel, of, primitive, &t, &face) && take(of, t, primitive, face);
}

/* A distance for Embree, rounded outward so that Embree tests all candidates that may be as near. */
static inline float outward(const QueryRay *of, double t)
{
    return (float)(t + FLOAT_DOUBT * (t + of->size));
}

/* ---- callbacks ---- */

/* Embree stores N rays or hits as structures of arrays (RTCRay, RTCHit). Its accessors are for C++ only. */
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
static inline float hit_number(const void *hits, unsigned n, unsigned i, HitField field)
{
    return ((const float *)hits)[(unsigned)field * n + i];
}

/* Filter function: tests a triangle in double. An occlusion query ends at the first opaque triangle. The second
 * trace keeps the nearest hit and continues to all other candidates. */
void accel_filter_occluder(const struct RTCFilterFunctionNArguments *args)
{
    const Query *query = (const Query *)args->context;
    double t;

    for (unsigned i = 0; i < args->N; i++) {
        if (!args->valid[i])
            continue;
        QueryRay *of = &query->rays[ray_id(args->ray, args->N, i)];
        const Triangle *triangle = &query->accel->triangles[*hit_field(args->hit, args->N, i, HIT_PRIMITIVE)];
        if (!triangle_distance(of, triangle, of->ray.tmax, &t) || !visible(query->accel, of, triangle->primitive)) {
            args->valid[i] = 0;
        } else if (of->hit) {
            take_triangle(of, triangle, t, hit_number(args->hit, args->N, i, HIT_U),
                          hit_number(args->hit, args->N, i, HIT_V));
            args->valid[i] = 0;
        } else if (pass(query->accel, of, triangle->primitive)) {
            args->valid[i] = 0;
        }
    }
}

void accel_intersect_curved(const struct RTCIntersectFunctionNArguments *args)
{
    const Query *query = (const Query *)args->context;
    const void *rays = args->rayhit, *hits = (const unsigned *)rays + HIT_HITS * args->N;
    int primitive = query->accel->curved[args->primID];

    for (unsigned i = 0; i < args->N; i++) {
        QueryRay *of = &query->rays[ray_id(rays, args->N, i)];
        if (!args->valid[i] || !take_shape(query->accel, of, primitive))
            continue;
        /* A triangle at the same distance in float remains Embree's hit. The nearer one is chosen at the end, in
         * double. */
        float end = outward(of, of->hit->t);
        if (!(end < *ray_tfar(rays, args->N, i)))
            continue;
        *ray_tfar(rays, args->N, i) = end;
        *hit_field(hits, args->N, i, HIT_GEOMETRY) = query->accel->curved_geometry;
        *hit_field(hits, args->N, i, HIT_PRIMITIVE) = args->primID;
        *hit_field(hits, args->N, i, HIT_INSTANCE) = RTC_INVALID_GEOMETRY_ID;
    }
}

void accel_occlude_curved(const struct RTCOccludedFunctionNArguments *args)
{
    const Query *query = (const Query *)args->context;
    int primitive = query->accel->curved[args->primID], face;
    double t;

    for (unsigned i = 0; i < args->N; i++) {
        QueryRay *of = &query->rays[ray_id(args->ray, args->N, i)];
        if (!args->valid[i])
            continue;
        if (of->hit)
            take_shape(query->accel, of, primitive);
        else if (meet_shape(query->accel, of, primitive, &t, &face) && !pass(query->accel, of, primitive))
            *ray_tfar(args->ray, args->N, i) = -INFINITY;
    }
}

/* ---- start of a query ---- */

/* Embree may abort on a ray that is not finite. Such a ray has no hits. */
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

/* Embree gets the ray in float, with its range widened by the error of float. The ray in double decides. Returns 0
 * if the ray certainly has no hit. */
static inline int start_ray(QueryRay *of, const Accel *accel, const Ray *ray, RayKind kind, unsigned passes, Hit *hit,
                            float *tnear, float *tfar)
{
    double size = fabs(ray->origin.x) + fabs(ray->origin.y) + fabs(ray->origin.z);
    double start = ray->tmin > 0 ? ray->tmin - FLOAT_DOUBT * (ray->tmin + size) : 0;

    of->ray = *ray;
    of->size = size;
    /* Each coordinate in the distance to the plane is at most reach + size. The normal's components sum to 1.8 at
     * most. */
    of->rounding = 28 * DBL_EPSILON * (accel->reach + size);
    of->hit = hit;
    if (hit)
        hit->primitive = -1;
    of->kind = (unsigned)kind;
    of->passes = passes;
    of->passed = 0;
    *tnear = start > 0 ? (float)start : 0;
    *tfar = outward(of, ray->tmax);
    return can_be_traced(ray, size);
}

static inline int start_single(QueryRay *of, struct RTCRay *to, const Accel *accel, const Ray *ray, RayKind kind,
                               unsigned passes, Hit *hit)
{
    to->org_x = (float)ray->origin.x, to->org_y = (float)ray->origin.y, to->org_z = (float)ray->origin.z;
    to->dir_x = (float)ray->direction.x, to->dir_y = (float)ray->direction.y, to->dir_z = (float)ray->direction.z;
    to->time = 0, to->mask = 0xffffffffu, to->id = to->flags = 0;
    return start_ray(of, accel, ray, kind, passes, hit, &to->tnear, &to->tfar);
}

/* 1 if an opaque plane occludes the ray. */
static int plane_blocks(const Accel *accel, QueryRay *of)
{
    double t;
    int face;

    for (int i = 0; i < accel->nplanes; i++)
        if (meet_shape(accel, of, accel->planes[i], &t, &face) && !pass(accel, of, accel->planes[i]))
            return 1;
    return 0;
}

static inline void take_planes(const Accel *accel, QueryRay *of)
{
    for (int i = 0; i < accel->nplanes; i++)
        take_shape(accel, of, accel->planes[i]);
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

/* Embree's hit, if it is a triangle, becomes the nearest hit unless a curved shape is nearer. Returns 0 if the ray
 * needs the second trace. */
static inline int accept(const Accel *accel, QueryRay *of, const Ray *ray, unsigned geometry, unsigned index,
                         float tfar, float u, float v)
{
    double t, trust;

    if (geometry == RTC_INVALID_GEOMETRY_ID || geometry == accel->curved_geometry)
        return 1;
    const Triangle *triangle = &accel->triangles[index];
    if (!triangle_distance(of, triangle, ray->tmax, &t) || !visible(accel, of, triangle->primitive))
        return 0;
    trust = FLOAT_TRUST * (t + of->size);
    /* The distance is too inaccurate, or too near the origin, or too near a curved shape: other triangles may be
     * nearer. */
    if (fabs(t - tfar) > trust || t < trust || (of->hit->primitive >= 0 && fabs(t - of->hit->t) <= trust))
        return 0;
    take_triangle(of, triangle, t, u, v);
    return 1;
}

/* The second trace: the nearest of all triangles and curved shapes along the ray, in double. */
static int look_closely(const Accel *accel, const Ray *ray, RayKind kind, Hit *hit)
{
    Query query;
    QueryRay of;
    struct RTCRay along;

    start_query(&query, accel, 0, &of);
    if (start_single(&of, &along, accel, ray, kind, 0, hit)) {
        trace_occluded(&query, &along);
        take_planes(accel, &of);
    }
    return hit->primitive >= 0;
}

int accel_intersect(const Accel *accel, const Ray *ray, RayKind kind, Hit *hit)
{
    Query query;
    QueryRay of;
    struct RTCRayHit rayhit;

    start_query(&query, accel, 0, &of);
    if (!start_single(&of, &rayhit.ray, accel, ray, kind, 0, hit))
        return 0;
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    trace(&query, &rayhit);
    if (!accept(accel, &of, ray, rayhit.hit.geomID, rayhit.hit.primID, rayhit.ray.tfar, rayhit.hit.u, rayhit.hit.v))
        return look_closely(accel, ray, kind, hit);
    take_planes(accel, &of);
    return hit->primitive >= 0;
}

static Visibility look_along(const Accel *accel, const Ray *ray, RayKind kind, unsigned passes)
{
    Query query;
    QueryRay of;
    struct RTCRay occluded;

    start_query(&query, accel, 0, &of);
    if (!start_single(&of, &occluded, accel, ray, kind, passes, NULL))
        return VISIBILITY_CLEAR;
    if (plane_blocks(accel, &of))
        return VISIBILITY_BLOCKED;
    trace_occluded(&query, &occluded);
    return occluded.tfar < 0 ? VISIBILITY_BLOCKED : of.passed ? VISIBILITY_TRANSPARENT : VISIBILITY_CLEAR;
}

int accel_occluded(const Accel *accel, const Ray *ray, RayKind kind, int skip_transparent)
{
    return look_along(accel, ray, kind, skip_transparent ? TRANSPARENT : 0) == VISIBILITY_BLOCKED;
}

Visibility accel_visibility(const Accel *accel, const Ray *ray, int light_source)
{
    return look_along(accel, ray, RAY_SHADOW, light_source ? TRANSPARENT : STRAIGHT);
}

/* ---- packets ---- */

typedef struct Packet {
    _Alignas(64) struct RTCRayHit16 rays;
    _Alignas(64) int valid[ACCEL_PACKET];
    QueryRay of[ACCEL_PACKET];
} Packet;

/* Embree skips invalid lanes only if it has packets of this width. With narrower packets it traces every lane that
 * has a range, so invalid lanes get an empty range. */
static void blank_lane(Packet *p, int i)
{
    struct RTCRay16 *to = &p->rays.ray;

    to->org_x[i] = to->org_y[i] = to->org_z[i] = to->dir_x[i] = to->dir_y[i] = to->dir_z[i] = 1;
    to->time[i] = to->tnear[i] = 0, to->tfar[i] = -1, to->mask[i] = to->id[i] = to->flags[i] = 0;
    p->valid[i] = 0;
}

static void start_lane(Packet *p, int i, const Accel *accel, const Ray *ray, RayKind kind, unsigned passes, Hit *hit)
{
    struct RTCRay16 *to = &p->rays.ray;

    if (!start_ray(&p->of[i], accel, ray, kind, passes, hit, &to->tnear[i], &to->tfar[i])) {
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
        start_lane(&p, i, accel, &rays[i], kinds[i], 0, &hits[i]);
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
        if (!p.valid[i])
            continue;
        if (accept(accel, &p.of[i], &rays[i], p.rays.hit.geomID[i], p.rays.hit.primID[i], p.rays.ray.tfar[i],
                   p.rays.hit.u[i], p.rays.hit.v[i]))
            take_planes(accel, &p.of[i]);
        else
            look_closely(accel, &rays[i], kinds[i], &hits[i]);
    }
}

void accel_visibility_packet(const Accel *accel, const Ray *rays, const int *light_sources, int count, Visibility *ways)
{
    Packet p;
    Query query;

    start_query(&query, accel, 1, p.of);
    for (int i = 0; i < count; i++)
        start_lane(&p, i, accel, &rays[i], RAY_SHADOW, light_sources[i] ? TRANSPARENT : STRAIGHT, NULL);
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
        int blocked = p.valid[i] && (p.rays.ray.tfar[i] < 0 || plane_blocks(accel, &p.of[i]));
        ways[i] = blocked ? VISIBILITY_BLOCKED : p.of[i].passed ? VISIBILITY_TRANSPARENT : VISIBILITY_CLEAR;
    }
}
