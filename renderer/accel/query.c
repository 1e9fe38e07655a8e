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
#include <retex/host/assert.h>
#include "accel/lanes.h"
#include "shape/csg.h"
#include "shape/shape.h"

/* A ray in double and its nearest hit so far. */
typedef struct QueryRay {
    Ray ray;            /* tmax is just behind the nearest hit, so that hits at the same distance are found */
    Hit *hit;           /* the nearest hit so far; NULL if any hit ends the query */
    double size;        /* sum of the magnitudes of the origin's coordinates */
    double rounding;    /* a plane with a distance from the origin below this counts as containing it */
    unsigned kind;      /* flag that a primitive must have to be visible to this ray */
    unsigned passes;    /* flags of primitives that let this ray pass */
    unsigned inherited; /* flags of the instance that the query is in */
    int passed;         /* 1 if the ray has passed such a primitive */
} QueryRay;

typedef enum HitField { HIT_U = 3, HIT_V, HIT_PRIMITIVE, HIT_GEOMETRY, HIT_INSTANCE, HIT_HITS = 12 } HitField;

/* The context that Embree hands to every callback, with the rays in double. Ray ids are indices into it. */
typedef struct Query {
    QueryContext context;
    const Accel *accel;
    QueryRay *rays;
} Query;

static inline int is_visible(const Accel *accel, const QueryRay *query_ray, int primitive)
{
    return (accel->flags[primitive] & query_ray->kind) != 0;
}

/* 1 if the primitive lets the ray pass. */
static inline int passes_through(const Accel *accel, QueryRay *query_ray, int primitive)
{
    unsigned flags = accel->flags[primitive];

    if (flags & INHERITS)
        flags |= query_ray->inherited;
    if (!(flags & query_ray->passes))
        return 0;
    query_ray->passed = 1;
    return 1;
}

/* ---- intersection in double ---- */

/* Distance along the ray to the triangle's plane, if it is before the ray's end. 0 if the ray is parallel to the
 * plane or starts on it. */
static inline int triangle_distance(const QueryRay *query_ray, const Triangle *triangle, double end, double *t)
{
    const Ray *ray = &query_ray->ray;
    Vec3 n = triangle->normal;
    double height = triangle->offset - vec_dot(n, ray->origin), fall = vec_dot(n, ray->direction), distance;

    if (fabs(height) <= query_ray->rounding || fall == 0)
        return 0;
    distance = height / fall;
    if (!(distance > ray->tmin && distance < end))
        return 0;
    *t = distance;
    return 1;
}

/* Store a hit if it is the nearest. Of two hits at the same distance the primitive that comes first in the scene
 * wins, so the result does not depend on the order of traversal. */
static inline int record_hit(QueryRay *query_ray, double t, int primitive, int face)
{
    Hit *hit = query_ray->hit;
    RETEX_ASSERT(hit && primitive >= 0); /* not an item, as those of CSG are */
    const int later = primitive > hit->primitive || (primitive == hit->primitive && face >= hit->face);

    if (hit->primitive >= 0 && (t > hit->t || (t == hit->t && !hit->instance && later)))
        return 0;
    hit->t = t, hit->primitive = primitive, hit->face = face;
    hit->instance = NULL;
    query_ray->ray.tmax = t * (1 + DBL_EPSILON);
    return 1;
}

/* Barycentric coordinates are in float, which is exact enough for interpolation. Embree keeps them in range. */
static inline void record_triangle_hit(QueryRay *query_ray, const Triangle *triangle, double t, float b1, float b2)
{
    if (!record_hit(query_ray, t, triangle->primitive, triangle->face))
        return;
    query_ray->hit->normal = triangle->normal;
    query_ray->hit->b1 = b1, query_ray->hit->b2 = b2;
}

/* What a query in a shared Accel has of the one that led there. */
typedef struct Outer {
    double moved;       /* by how much the ray was moved when it was put into the shared space */
    unsigned inherited; /* flags of the instance */
} Outer;
static const Outer no_outer = {0, 0};

/* Single rays, below. */
static int intersect_from(const Accel *accel, const Ray *ray, RayKind kind, Outer outer, Hit *hit);
static Visibility trace_visibility(const Accel *accel, const Ray *ray, RayKind kind, unsigned passes, Outer outer);

static Outer outer_of(const Transform *transform, unsigned inherited)
{
    const double(*m)[4] = transform->inverse;

    return (Outer){fabs(m[0][3]) + fabs(m[1][3]) + fabs(m[2][3]), inherited};
}

typedef struct Operands {
    const Accel *accel;
    QueryRay *query_ray;
} Operands;

static int is_visible_operand(void *context, int primitive)
{
    const Operands *of = context;

    return is_visible(of->accel, of->query_ray, primitive);
}

static int is_blocking_operand(void *context, int primitive)
{
    const Operands *of = context;

    return is_visible(of->accel, of->query_ray, primitive) && !passes_through(of->accel, of->query_ray, primitive);
}

static __attribute__((noinline)) int test_csg(const Accel *accel, QueryRay *query_ray, int index)
{
    Operands operands = {accel, query_ray};
    CsgQuery query = {.ray = query_ray->ray, .accept = is_visible_operand, .context = &operands};

    if (!csg_intersect(accel->source->csgs[index], &query) ||
        !record_hit(query_ray, query.t, query.leaf->index, query.face))
        return 0;
    shape_complete_hit(query.leaf->primitive, &query_ray->ray, query_ray->hit);
    return 1;
}

static __attribute__((noinline)) int csg_blocks(const Accel *accel, QueryRay *query_ray, int index)
{
    Operands operands = {accel, query_ray};
    CsgQuery query = {.ray = query_ray->ray, .accept = is_blocking_operand, .context = &operands, .any = 1};

    return csg_intersect(accel->source->csgs[index], &query);
}

/* The ray in a shared space. Lengths along it are a power of two longer: so they go there and back without
 * rounding, and a ray that goes on from a hit does not meet it again. */
static Ray ray_into(const Transform *transform, const Ray *ray, double *scale)
{
    Vec3 d = transform_inverse_vector(transform, ray->direction);
    int exponent;

    frexp(vec_length(d), &exponent);
    *scale = ldexp(1, exponent);
    return (Ray){transform_inverse_point(transform, ray->origin), vec_scale(d, 1 / *scale), ray->tmin * *scale,
                 ray->tmax * *scale};
}

static __attribute__((noinline)) int test_copy(const Accel *accel, QueryRay *query_ray, int index)
{
    const Primitive *primitive = &accel->source->primitives[index];
    double scale;
    Ray ray = ray_into(&primitive->transform, &query_ray->ray, &scale);
    Hit hit;

    if (!intersect_from(accel->shared[index]->accel, &ray, RAY_CAMERA, outer_of(&primitive->transform, 0), &hit) ||
        !record_hit(query_ray, hit.t / scale, index, hit.face))
        return 0;
    query_ray->hit->normal = shape_world_normal(primitive, hit.normal);
    query_ray->hit->b1 = hit.b1, query_ray->hit->b2 = hit.b2;
    return 1;
}

static __attribute__((noinline)) int copy_blocks(const Accel *accel, QueryRay *query_ray, int index)
{
    const Primitive *primitive = &accel->source->primitives[index];
    double scale;
    Ray ray = ray_into(&primitive->transform, &query_ray->ray, &scale);

    return trace_visibility(accel->shared[index]->accel, &ray, RAY_CAMERA, 0, outer_of(&primitive->transform, 0)) !=
               VISIBILITY_CLEAR &&
           !passes_through(accel, query_ray, index);
}

/* Of two hits at the same distance that in the first instance wins. */
static int record_instance_hit(QueryRay *query_ray, double t, const Instance *instance, const Hit *hit)
{
    Hit *nearest = query_ray->hit;

    if (nearest->primitive >= 0 && t == nearest->t && nearest->instance != instance) {
        if (!nearest->instance || nearest->instance < instance)
            return 0;
        nearest->primitive = -1;
    }
    RETEX_ASSERT(hit->primitive < instance->prototype->count); /* of the prototype's, not of the scene's */
    if (!record_hit(query_ray, t, instance->prototype->first + hit->primitive, hit->face))
        return 0;
    nearest->instance = instance;
    nearest->normal = vec_normalize(transform_normal(&instance->transform, hit->normal));
    nearest->b1 = hit->b1, nearest->b2 = hit->b2;
    return 1;
}

static __attribute__((noinline)) int test_instance(const Accel *accel, QueryRay *query_ray, int item)
{
    const Instance *instance = &accel->source->instances[item - accel->source->nprimitives];
    const Accel *prototype = accel->prototypes[instance->prototype->number]->accel;
    double scale;
    Ray ray = ray_into(&instance->transform, &query_ray->ray, &scale);
    Hit hit = {.normal = {0, 0, 0}};

    return intersect_from(prototype, &ray, (RayKind)query_ray->kind, outer_of(&instance->transform, 0), &hit) &&
           record_instance_hit(query_ray, hit.t / scale, instance, &hit);
}

static __attribute__((noinline)) int instance_blocks(const Accel *accel, QueryRay *query_ray, int item)
{
    const Instance *instance = &accel->source->instances[item - accel->source->nprimitives];
    const Accel *prototype = accel->prototypes[instance->prototype->number]->accel;
    double scale;
    Ray ray = ray_into(&instance->transform, &query_ray->ray, &scale);
    Visibility visibility = trace_visibility(prototype, &ray, (RayKind)query_ray->kind, query_ray->passes,
                                             outer_of(&instance->transform, accel->flags[item]));

    query_ray->passed |= visibility == VISIBILITY_TRANSPARENT;
    return visibility == VISIBILITY_BLOCKED;
}

/* What is not made of triangles, as an item of the Accel. Stores the nearest hit; returns 1 if that is new. */
static inline int test_shape(const Accel *accel, QueryRay *query_ray, int item)
{
    double t;
    int face;

    if (item < 0)
        return test_csg(accel, query_ray, ~item);
    if (item >= accel->source->nprimitives)
        return test_instance(accel, query_ray, item);
    if (accel->shared && accel->shared[item])
        return is_visible(accel, query_ray, item) && test_copy(accel, query_ray, item);
    return is_visible(accel, query_ray, item) &&
           shape_intersect(&accel->source->primitives[item], &query_ray->ray, &t, &face) &&
           record_hit(query_ray, t, item, face);
}

/* 1 if it ends the ray, which is not asked where. */
static inline int shape_blocks(const Accel *accel, QueryRay *query_ray, int item)
{
    double t;
    int face;

    if (item < 0)
        return csg_blocks(accel, query_ray, ~item);
    if (item >= accel->source->nprimitives)
        return instance_blocks(accel, query_ray, item);
    if (accel->shared && accel->shared[item])
        return is_visible(accel, query_ray, item) && copy_blocks(accel, query_ray, item);
    return is_visible(accel, query_ray, item) &&
           shape_intersect(&accel->source->primitives[item], &query_ray->ray, &t, &face) &&
           !passes_through(accel, query_ray, item);
}

/* A distance for Embree, rounded outward so that Embree tests all candidates that may be as near. */
static inline float rounded_outward(const QueryRay *query_ray, double t)
{
    return (float)(t + FLOAT_ERROR_BOUND * (t + query_ray->size));
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
        QueryRay *query_ray = &query->rays[ray_id(args->ray, args->N, i)];
        const Triangle *triangle = &query->accel->triangles[*hit_field(args->hit, args->N, i, HIT_PRIMITIVE)];
        if (!triangle_distance(query_ray, triangle, query_ray->ray.tmax, &t) ||
            !is_visible(query->accel, query_ray, triangle->primitive)) {
            args->valid[i] = 0;
        } else if (query_ray->hit) {
            record_triangle_hit(query_ray, triangle, t, hit_number(args->hit, args->N, i, HIT_U),
                                hit_number(args->hit, args->N, i, HIT_V));
            args->valid[i] = 0;
        } else if (passes_through(query->accel, query_ray, triangle->primitive)) {
            args->valid[i] = 0;
        }
    }
}

void accel_intersect_curved(const struct RTCIntersectFunctionNArguments *args)
{
    const Query *query = (const Query *)args->context;
    const void *rays = args->rayhit, *hits = (const unsigned *)rays + HIT_HITS * args->N;
    int item = query->accel->curved[args->primID];

    for (unsigned i = 0; i < args->N; i++) {
        QueryRay *query_ray = &query->rays[ray_id(rays, args->N, i)];
        if (!args->valid[i] || !test_shape(query->accel, query_ray, item))
            continue;
        /* A triangle at the same distance in float remains Embree's hit. The nearer one is chosen at the end, in
         * double. */
        float end = rounded_outward(query_ray, query_ray->hit->t);
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
    int item = query->accel->curved[args->primID];

    for (unsigned i = 0; i < args->N; i++) {
        QueryRay *query_ray = &query->rays[ray_id(args->ray, args->N, i)];
        if (!args->valid[i])
            continue;
        if (query_ray->hit)
            test_shape(query->accel, query_ray, item);
        else if (shape_blocks(query->accel, query_ray, item))
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
    (void)side_by_side; /* goes along with each query */
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
static inline int start_ray(QueryRay *query_ray, const Accel *accel, const Ray *ray, RayKind kind, unsigned passes,
                            Outer outer, Hit *hit, float *tnear, float *tfar)
{
    double size = fabs(ray->origin.x) + fabs(ray->origin.y) + fabs(ray->origin.z);
    double start = ray->tmin > 0 ? ray->tmin - FLOAT_ERROR_BOUND * (ray->tmin + size) : 0;

    query_ray->ray = *ray;
    query_ray->size = size;
    /* Each coordinate in the distance to the plane is at most reach + size. The normal's components sum to 1.8 at
     * most. */
    query_ray->rounding = 28 * DBL_EPSILON * (accel->reach + size + outer.moved);
    query_ray->hit = hit;
    if (hit)
        hit->primitive = -1;
    query_ray->kind = (unsigned)kind;
    query_ray->passes = passes;
    query_ray->inherited = outer.inherited;
    query_ray->passed = 0;
    *tnear = start > 0 ? (float)start : 0;
    *tfar = rounded_outward(query_ray, ray->tmax);
    return can_be_traced(ray, size);
}

static inline int start_single(QueryRay *query_ray, struct RTCRay *to, const Accel *accel, const Ray *ray, RayKind kind,
                               unsigned passes, Outer outer, Hit *hit)
{
    to->org_x = (float)ray->origin.x, to->org_y = (float)ray->origin.y, to->org_z = (float)ray->origin.z;
    to->dir_x = (float)ray->direction.x, to->dir_y = (float)ray->direction.y, to->dir_z = (float)ray->direction.z;
    to->time = 0, to->mask = 0xffffffffu, to->id = to->flags = 0;
    return start_ray(query_ray, accel, ray, kind, passes, outer, hit, &to->tnear, &to->tfar);
}

/* 1 if something opaque that is unbounded occludes the ray. */
static int unbounded_blocks(const Accel *accel, QueryRay *query_ray)
{
    for (int i = 0; i < accel->nunbounded; i++)
        if (shape_blocks(accel, query_ray, accel->unbounded[i]))
            return 1;
    return 0;
}

static inline void test_unbounded(const Accel *accel, QueryRay *query_ray)
{
    for (int i = 0; i < accel->nunbounded; i++)
        test_shape(accel, query_ray, accel->unbounded[i]);
}

/* ---- single rays ---- */

static void embree_intersect(Query *query, struct RTCRayHit *rayhit)
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

static void embree_occluded(Query *query, struct RTCRay *ray)
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
static inline int refine_triangle_hit(const Accel *accel, QueryRay *query_ray, const Ray *ray, unsigned geometry,
                                      unsigned index, float tfar, float u, float v)
{
    double t, tolerance;

    if (geometry == RTC_INVALID_GEOMETRY_ID || geometry == accel->curved_geometry)
        return 1;
    RETEX_ASSERT(geometry == accel->triangle_geometry && index < accel->ntriangles);
    const Triangle *triangle = &accel->triangles[index];
    if (!triangle_distance(query_ray, triangle, ray->tmax, &t) || !is_visible(accel, query_ray, triangle->primitive))
        return 0;
    tolerance = FLOAT_ERROR_TYPICAL * (t + query_ray->size);
    /* The distance is too inaccurate, or too near the origin, or too near a curved shape: other triangles may be
     * nearer. */
    if (fabs(t - tfar) > tolerance || t < tolerance ||
        (query_ray->hit->primitive >= 0 && fabs(t - query_ray->hit->t) <= tolerance))
        return 0;
    record_triangle_hit(query_ray, triangle, t, u, v);
    return 1;
}

/* The second trace: the nearest of all triangles and curved shapes along the ray, in double. */
static int intersect_in_double(const Accel *accel, const Ray *ray, RayKind kind, Outer outer, Hit *hit)
{
    Query query;
    QueryRay query_ray;
    struct RTCRay along;

    start_query(&query, accel, 0, &query_ray);
    if (start_single(&query_ray, &along, accel, ray, kind, 0, outer, hit)) {
        embree_occluded(&query, &along);
        test_unbounded(accel, &query_ray);
    }
    return hit->primitive >= 0;
}

static int intersect_from(const Accel *accel, const Ray *ray, RayKind kind, Outer outer, Hit *hit)
{
    Query query;
    QueryRay query_ray;
    struct RTCRayHit rayhit;

    start_query(&query, accel, 0, &query_ray);
    if (!start_single(&query_ray, &rayhit.ray, accel, ray, kind, 0, outer, hit))
        return 0;
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree_intersect(&query, &rayhit);
    if (!refine_triangle_hit(accel, &query_ray, ray, rayhit.hit.geomID, rayhit.hit.primID, rayhit.ray.tfar,
                             rayhit.hit.u, rayhit.hit.v))
        return intersect_in_double(accel, ray, kind, outer, hit);
    test_unbounded(accel, &query_ray);
    return hit->primitive >= 0;
}

int accel_intersect(const Accel *accel, const Ray *ray, RayKind kind, Hit *hit)
{
    return intersect_from(accel, ray, kind, no_outer, hit);
}

static Visibility trace_visibility(const Accel *accel, const Ray *ray, RayKind kind, unsigned passes, Outer outer)
{
    Query query;
    QueryRay query_ray;
    struct RTCRay occluded;

    start_query(&query, accel, 0, &query_ray);
    if (!start_single(&query_ray, &occluded, accel, ray, kind, passes, outer, NULL))
        return VISIBILITY_CLEAR;
    if (unbounded_blocks(accel, &query_ray))
        return VISIBILITY_BLOCKED;
    embree_occluded(&query, &occluded);
    return occluded.tfar < 0 ? VISIBILITY_BLOCKED : query_ray.passed ? VISIBILITY_TRANSPARENT : VISIBILITY_CLEAR;
}

int accel_occluded(const Accel *accel, const Ray *ray, RayKind kind, int skip_transparent)
{
    return trace_visibility(accel, ray, kind, skip_transparent ? TRANSPARENT : 0, no_outer) == VISIBILITY_BLOCKED;
}

Visibility accel_visibility(const Accel *accel, const Ray *ray, int light_source)
{
    return trace_visibility(accel, ray, RAY_SHADOW, light_source ? TRANSPARENT : STRAIGHT, no_outer);
}

/* ---- packets ---- */

typedef struct Packet {
    _Alignas(64) struct RTCRayHit16 rays;
    _Alignas(64) int valid[ACCEL_PACKET];
    LaneRays lanes;
    QueryRay query_rays[ACCEL_PACKET];
} Packet;

/* Embree skips invalid lanes only if it has packets of this width. With narrower packets it traces every lane that
 * has a range, so invalid lanes get an empty range. */
static void start_packet(Packet *p, const Accel *accel, const Ray *rays, int count)
{
    lanes_take(&p->lanes, rays, count);
    lanes_start(&p->lanes, accel->reach, &p->rays.ray, p->valid);
}

/* For callbacks and what is unbounded. */
static void make_query_ray(Packet *p, int i, const Ray *ray, RayKind kind, unsigned passes, Hit *hit)
{
    p->query_rays[i] = (QueryRay){.ray = *ray,
                                  .hit = hit,
                                  .size = p->lanes.size[i],
                                  .rounding = p->lanes.rounding[i],
                                  .kind = (unsigned)kind,
                                  .passes = passes};
}

static void intersect_lanes(Packet *p, const Accel *accel, Query *query, int side_by_side)
{
    for (int i = 0; i < ACCEL_PACKET; i++)
        p->rays.hit.geomID[i] = p->rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
#if defined(RETEX_EMBREE4)
    struct RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.context = &query->context;
    args.flags = side_by_side ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcIntersect16(p->valid, accel->scene, &p->rays, &args);
#else
    (void)side_by_side;
    rtcIntersect16(p->valid, accel->scene, &query->context, &p->rays);
#endif
}

static int has_triangle(const Packet *p, const Accel *accel, int i)
{
    return p->rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID && p->rays.hit.geomID[i] != accel->curved_geometry;
}

/* As refine_triangle_hit, of lanes that have a triangle. */
static void refine_lanes(const Packet *p, const Accel *accel, int count, LaneTriangles *to)
{
    for (int i = 0; i < count; i++)
        if (has_triangle(p, accel, i))
            __builtin_prefetch(&accel->triangles[p->rays.hit.primID[i]]);
    for (int i = 0; i < ACCEL_PACKET; i++) {
        static const Triangle none = {.normal = {0, 0, 0}};
        const int is_one = i < count && has_triangle(p, accel, i);
        const Triangle *triangle = is_one ? &accel->triangles[p->rays.hit.primID[i]] : &none;
        to->normal[0][i] = triangle->normal.x, to->normal[1][i] = triangle->normal.y;
        to->normal[2][i] = triangle->normal.z;
        to->offset[i] = triangle->offset, to->reported[i] = p->rays.ray.tfar[i];
    }
    lanes_refine(&p->lanes, to);
}

/* Whether a lane's triangle is its nearest hit, which is recorded. */
static int is_nearest(const Packet *p, const Accel *accel, const LaneTriangles *triangles, int i, RayKind kind,
                      Hit *hit)
{
    const Triangle *triangle = &accel->triangles[p->rays.hit.primID[i]];
    if (!triangles->sure[i] || !(accel->flags[triangle->primitive] & (unsigned)kind) ||
        (hit->primitive >= 0 && fabs(triangles->t[i] - hit->t) <= triangles->tolerance[i]))
        return 0;
    if (hit->primitive >= 0 && triangles->t[i] > hit->t)
        return 1;
    *hit = (Hit){.t = triangles->t[i],
                 .primitive = triangle->primitive,
                 .face = triangle->face,
                 .normal = triangle->normal,
                 .b1 = p->rays.hit.u[i],
                 .b2 = p->rays.hit.v[i]};
    return 1;
}

void accel_intersect_packet(const Accel *accel, const Ray *rays, const RayKind *kinds, int count, int side_by_side,
                            Hit *hits)
{
    const int has_shapes = accel->ncurved + accel->nunbounded > 0;
    RETEX_ASSERT(count <= ACCEL_PACKET);
    Packet p;
    Query query;
    LaneTriangles triangles;

    start_query(&query, accel, side_by_side, p.query_rays);
    start_packet(&p, accel, rays, count);
    for (int i = 0; i < count; i++)
        hits[i].primitive = -1;
    for (int i = 0; i < count && has_shapes; i++)
        make_query_ray(&p, i, &rays[i], kinds[i], 0, &hits[i]);
    intersect_lanes(&p, accel, &query, side_by_side);
    refine_lanes(&p, accel, count, &triangles);
    for (int i = 0; i < count; i++) {
        if (!p.valid[i])
            continue;
        if (has_triangle(&p, accel, i) && !is_nearest(&p, accel, &triangles, i, kinds[i], &hits[i])) {
            intersect_in_double(accel, &rays[i], kinds[i], no_outer, &hits[i]);
            continue;
        }
        if (accel->nunbounded && hits[i].primitive >= 0)
            p.query_rays[i].ray.tmax = hits[i].t * (1 + DBL_EPSILON);
        if (accel->nunbounded)
            test_unbounded(accel, &p.query_rays[i]);
    }
}

void accel_visibility_packet(const Accel *accel, const Ray *rays, const int *light_sources, int count,
                             Visibility *visibilities)
{
    Packet p;
    Query query;

    /* one by one: most go to different lights, and even those to one point gain at most a twentieth side by side */
    start_query(&query, accel, 0, p.query_rays);
    start_packet(&p, accel, rays, count);
    for (int i = 0; i < count; i++)
        make_query_ray(&p, i, &rays[i], RAY_SHADOW, light_sources[i] ? TRANSPARENT : STRAIGHT, NULL);
#if defined(RETEX_EMBREE4)
    struct RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.context = &query.context;
    args.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcOccluded16(p.valid, accel->scene, &p.rays.ray, &args);
#else
    rtcOccluded16(p.valid, accel->scene, &query.context, &p.rays.ray);
#endif
    for (int i = 0; i < count; i++) {
        int blocked = p.valid[i] && (p.rays.ray.tfar[i] < 0 || unbounded_blocks(accel, &p.query_rays[i]));
        visibilities[i] = blocked                 ? VISIBILITY_BLOCKED
                          : p.query_rays[i].passed ? VISIBILITY_TRANSPARENT
                                                  : VISIBILITY_CLEAR;
    }
}
