/* Ray queries through Embree: the only file that knows it. Builds with Embree 3 and 4.
 *
 * Embree works in float; this renderer asks for double positions and for rays that never meet the surface they leave.
 * So Embree only proposes. A triangle it finds is checked in double against its plane: one that lies outside the ray's
 * own double range, or on whose plane the ray starts (within the rounding error of the plane's equation, however large
 * the triangle), is passed, and the ray goes on behind it. That happens rarely, for rays start off the surface they
 * leave by more than float's rounding (accel_offset). Occlusion, which stops at any triangle, asks a filter function
 * instead. Curved shapes are user geometry and double throughout. Boxes and meshes are one triangle geometry in world
 * space; planes, which have no bounds, are tested one by one. Visibility by kind of ray is decided in the same places:
 * Embree may be built without masks.
 *
 * The scene is ROBUST: it costs a quarter, but without it 6 in 100 rays aimed at an edge between two triangles, and 1
 * in 100 000 at random, pass through. */
#include <float.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if defined(RETEX_EMBREE4)
#include <embree4/rtcore.h>
typedef struct RTCRayQueryContext QueryContext;
#else
#include <embree3/rtcore.h>
typedef struct RTCIntersectContext QueryContext;
#endif
#include "accel/accel.h"
#include "shade/bsdf.h"
#include "shade/pigment.h"

#define TRANSPARENT 0x80u           /* in flags, beside the RayKinds that see the primitive */
#define FLOAT_DOUBT 1e-3            /* share by which a distance in float may be off, along grazing triangles too */
#define LARGEST_COORDINATE 1e18     /* Embree takes anything beyond about 1.8e18 as no geometry */
#define SPATIAL_SPLIT_LIMIT 4000000 /* triangles: beyond it building would take too long for what tracing gains */

typedef struct Triangle {
    Vec3 normal;   /* of unit length, outward */
    double offset; /* normal . p on its plane */
    int32_t primitive;
    uint32_t face : 31, interpolated : 1; /* interpolated: it has normals or UVs */
} Triangle;

struct Accel {
    RTCDevice device;
    RTCScene scene;
    const Scene *source;
    Vec3 *vertices; /* of all triangles, world space; Embree has them in float */
    uint32_t (*corners)[3];
    Triangle *triangles;
    size_t nvertices, ntriangles;
    int *curved, *planes; /* primitive indices */
    int ncurved, nplanes;
    unsigned triangle_geometry, curved_geometry;
    unsigned char *flags; /* of each primitive */
    int has_transparent, has_straight; /* among what throws shadows: of any kind, or that does not bend light */
    double reach; /* the triangles' largest coordinate */
    Vec3 low, high;
    RetexError error; /* Embree's first complaint */
};

/* Embree hands the context to every callback: ours carries the ray in double. */
typedef struct Query {
    QueryContext context;
    const Accel *accel;
    const Ray *ray;
    unsigned kind, refused; /* flags a primitive must and must not have */
    double rounding;        /* a plane whose height over the origin is this small goes through it */
    double t;               /* of the nearest curved shape so far */
    int face;
} Query;

static int visible(const Query *query, int primitive)
{
    unsigned flags = query->accel->flags[primitive];

    return (flags & query->kind) && !(flags & query->refused);
}

/* ---- triangles in double ---- */

/* Not fmax, which is a call where infinities have to be kept apart from NaN. */
static inline double larger(double a, double b)
{
    return a > b ? a : b;
}
static inline double largest(Vec3 a)
{
    return larger(fabs(a.x), larger(fabs(a.y), fabs(a.z)));
}

/* Distance to the triangle's plane; 0 where the ray runs along it or starts on it, or is not to see the triangle. */
static int triangle_distance(const Query *query, const Triangle *triangle, double *t)
{
    const Ray *ray = query->ray;
    Vec3 n = triangle->normal;
    double height = triangle->offset - vec_dot(n, ray->origin), fall = vec_dot(n, ray->direction);

    if (fabs(height) <= query->rounding * (fabs(n.x) + fabs(n.y) + fabs(n.z)) || fall == 0)
        return 0;
    *t = height / fall;
    return *t > ray->tmin && *t < ray->tmax && visible(query, triangle->primitive);
}

/* Barycentrics of where the ray meets the plane, pulled into the triangle: Embree has decided that it is inside. */
static void barycentrics(const Accel *accel, size_t triangle, const Ray *ray, double t, Hit *hit)
{
    const uint32_t *corner = accel->corners[triangle];
    Vec3 v0 = accel->vertices[corner[0]], e1 = vec_sub(accel->vertices[corner[1]], v0);
    Vec3 e2 = vec_sub(accel->vertices[corner[2]], v0), n = vec_cross(e1, e2);
    Vec3 q = vec_sub(vec_mad(ray->origin, ray->direction, t), v0);
    double nn = vec_dot(n, n), b1 = vec_dot(vec_cross(q, e2), n) / nn, b2 = vec_dot(vec_cross(e1, q), n) / nn;

    b1 = fmin(fmax(b1, 0), 1);
    b2 = fmin(fmax(b2, 0), 1);
    if (b1 + b2 > 1) {
        double sum = b1 + b2;
        b1 /= sum;
        b2 /= sum;
    }
    hit->b1 = b1;
    hit->b2 = b2;
}

/* ---- callbacks ---- */

/* Called for single rays only, so N is 1. */
static void filter_occluder(const struct RTCFilterFunctionNArguments *args)
{
    const Query *query = (const Query *)args->context;
    double t;

    if (!triangle_distance(query, &query->accel->triangles[((const struct RTCHit *)args->hit)->primID], &t))
        args->valid[0] = 0;
}

static void bound_curved(const struct RTCBoundsFunctionArguments *args)
{
    const Accel *accel = args->geometryUserPtr;
    const Primitive *primitive = &accel->source->primitives[accel->curved[args->primID]];
    struct RTCBounds *bounds = args->bounds_o;
    Vec3 low, high;
    double pad;

    shape_bounds(primitive, &low, &high);
    /* Room for Embree's rounding, in coordinates and in extent: flat shapes have none. */
    pad = 2e-6 * (largest(low) + largest(high));
    bounds->lower_x = (float)(low.x - pad);
    bounds->lower_y = (float)(low.y - pad);
    bounds->lower_z = (float)(low.z - pad);
    bounds->upper_x = (float)(high.x + pad);
    bounds->upper_y = (float)(high.y + pad);
    bounds->upper_z = (float)(high.z + pad);
}

static int meet_curved(const Query *query, unsigned index, float tfar, double *t, int *face)
{
    const Accel *accel = query->accel;
    int primitive = accel->curved[index];
    Ray ray = *query->ray;

    if (!visible(query, primitive))
        return 0;
    ray.tmax = fmin(ray.tmax, tfar);
    return shape_intersect(&accel->source->primitives[primitive], &ray, t, face);
}

static void intersect_curved(const struct RTCIntersectFunctionNArguments *args)
{
    Query *query = (Query *)args->context;
    struct RTCRayHit *rayhit = (struct RTCRayHit *)args->rayhit;
    double t;
    int face;

    if (!args->valid[0] || !meet_curved(query, args->primID, rayhit->ray.tfar, &t, &face))
        return;
    query->t = t;
    query->face = face;
    rayhit->ray.tfar = (float)t;
    rayhit->hit.geomID = query->accel->curved_geometry;
    rayhit->hit.primID = args->primID;
    rayhit->hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

static void occlude_curved(const struct RTCOccludedFunctionNArguments *args)
{
    struct RTCRay *ray = (struct RTCRay *)args->ray;
    double t;
    int face;

    if (args->valid[0] && meet_curved((const Query *)args->context, args->primID, ray->tfar, &t, &face))
        ray->tfar = -INFINITY;
}

static int code_of(enum RTCError error)
{
    switch (error) {
    case RTC_ERROR_OUT_OF_MEMORY:
        return RETEX_ENOMEM;
    case RTC_ERROR_UNSUPPORTED_CPU:
        return RETEX_EUNSUPPORTED;
    default:
        return RETEX_EINTERNAL;
    }
}

static void complain(void *context, enum RTCError code, const char *text)
{
    Accel *accel = context;

    if (accel->error.code == 0)
        retex_fail(&accel->error, code_of(code), "Embree: %s", text ? text : "unknown error");
}

/* ---- building ---- */

static int is_curved(ShapeKind kind)
{
    return kind == SHAPE_SPHERE || kind == SHAPE_CONE || kind == SHAPE_TORUS || kind == SHAPE_DISC;
}

static int lets_through(const Texture *texture)
{
    return texture && ((texture->finish && finish_transmits(texture->finish)) || !pigment_is_opaque(texture->pigment));
}

static unsigned char primitive_flags(const Primitive *primitive)
{
    unsigned flags = (primitive->no_image ? 0u : RAY_CAMERA) | (primitive->no_shadow ? 0u : RAY_SHADOW) |
                     (primitive->no_reflection ? 0u : RAY_BOUNCE);
    int through = lets_through(primitive->texture) || lets_through(primitive->interior_texture);

    if (primitive->kind == SHAPE_MESH)
        for (int i = 0; i < primitive->mesh->ntextures; i++)
            through |= lets_through(primitive->mesh->textures[i]);
    return (unsigned char)(flags | (through ? TRANSPARENT : 0));
}

/* Has the primitive one texture, and does that bend what it lets through? */
static int always_bends(const Primitive *primitive)
{
    const Finish *finish = primitive->texture->finish;
    double ior = finish_transmits(finish) ? finish->retex.ior : primitive->interior ? primitive->interior->ior : 1;
    int several = primitive->interior_texture || (primitive->kind == SHAPE_MESH && primitive->mesh->ntextures > 0);

    return !several && ior != 1 && ior > 0;
}

static void grow(Accel *accel, Vec3 low, Vec3 high)
{
    accel->low = vec3(fmin(accel->low.x, low.x), fmin(accel->low.y, low.y), fmin(accel->low.z, low.z));
    accel->high = vec3(fmax(accel->high.x, high.x), fmax(accel->high.y, high.y), fmax(accel->high.z, high.z));
}

/* Sort primitives into kinds, count what they need, and refuse what cannot be traced. */
static int survey(Accel *accel, RetexError *err)
{
    const Scene *scene = accel->source;

    accel->low = accel->high = scene->camera.location;
    for (int i = 0; i < scene->nprimitives; i++) {
        const Primitive *primitive = &scene->primitives[i];
        Vec3 low, high;
        accel->flags[i] = primitive_flags(primitive);
        if ((accel->flags[i] & TRANSPARENT) && (accel->flags[i] & RAY_SHADOW)) {
            accel->has_transparent = 1;
            accel->has_straight |= !always_bends(primitive);
        }
        if (!shape_bounds(primitive, &low, &high)) {
            accel->planes[accel->nplanes++] = i;
            continue;
        }
        if (primitive->kind == SHAPE_MESH && primitive->mesh->nfaces == 0)
            continue;
        if (!(largest(low) < LARGEST_COORDINATE && largest(high) < LARGEST_COORDINATE))
            return retex_fail_at(err, RETEX_EINVAL, scene->path, primitive->line, 0,
                                 "this object has coordinates that are not finite or beyond %g", LARGEST_COORDINATE);
        grow(accel, low, high);
        if (is_curved(primitive->kind)) {
            accel->curved[accel->ncurved++] = i;
        } else {
            int mesh = primitive->kind == SHAPE_MESH;
            accel->nvertices += mesh ? (size_t)primitive->mesh->nvertices : 8;
            accel->ntriangles += mesh ? (size_t)primitive->mesh->nfaces : 12;
        }
    }
    return 0;
}

/* Bounds take the smaller and the larger of numbers, and so overlook NaN among others. */
static int finite_point(Vec3 p)
{
    return isfinite(p.x) && isfinite(p.y) && isfinite(p.z);
}

/* Left out where it has no area. */
static void add_triangle(Accel *accel, size_t *count, size_t base, const int corner[3], int index, int face)
{
    const Primitive *primitive = &accel->source->primitives[index];
    const MeshFace *f = primitive->kind == SHAPE_MESH ? &primitive->mesh->faces[face] : NULL;
    uint32_t *out = accel->corners[*count];
    Vec3 at[3], n;

    for (int k = 0; k < 3; k++) {
        out[k] = (uint32_t)(base + (size_t)corner[k]);
        at[k] = accel->vertices[out[k]];
    }
    n = vec_cross(vec_sub(at[1], at[0]), vec_sub(at[2], at[0]));
    if (!(vec_dot(n, n) > 0))
        return;
    n = triangle_normal(primitive, face, at);
    accel->triangles[*count] = (Triangle){.normal = n,
                                          .offset = vec_dot(n, at[0]),
                                          .primitive = index,
                                          .face = (uint32_t)face,
                                          .interpolated = f && (mesh_face_has_normals(f) || mesh_face_has_uvs(f))};
    ++*count;
}

/* Boxes and meshes into one list of triangles; those without area are left out. */
static int collect_triangles(Accel *accel, RetexError *err)
{
    const Scene *scene = accel->source;
    size_t base = 0, count = 0;

    for (int i = 0; i < scene->nprimitives; i++) {
        const Primitive *primitive = &scene->primitives[i];
        const Mesh *mesh = primitive->kind == SHAPE_MESH ? primitive->mesh : NULL;
        int nvertices = mesh ? mesh->nvertices : 8;
        if ((!mesh && primitive->kind != SHAPE_BOX) || (mesh && mesh->nfaces == 0))
            continue;
        for (int k = 0; k < nvertices; k++) {
            Vec3 p = transform_point(&primitive->transform, mesh ? mesh->vertices[k] : box_corner(k));
            if (!finite_point(p))
                return retex_fail_at(err, RETEX_EINVAL, scene->path, primitive->line, 0,
                                     "vertex %d of this object is not finite", k);
            accel->vertices[base + (size_t)k] = p;
            accel->reach = larger(accel->reach, largest(p));
        }
        for (int k = 0; k < (mesh ? mesh->nfaces : 12); k++)
            add_triangle(accel, &count, base, mesh ? mesh->faces[k].vertex : box_triangles[k], i, mesh ? k : k / 2);
        base += (size_t)nvertices;
    }
    accel->ntriangles = count;
    return 0;
}

static int add_triangle_geometry(Accel *accel, RetexError *err)
{
    RTCGeometry geometry = rtcNewGeometry(accel->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *vertex = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                            accel->nvertices);

    if (!vertex) {
        rtcReleaseGeometry(geometry);
        return retex_fail(err, RETEX_ENOMEM, "no memory for %zu vertices", accel->nvertices);
    }
    for (size_t i = 0; i < accel->nvertices; i++, vertex += 3) {
        vertex[0] = (float)accel->vertices[i].x;
        vertex[1] = (float)accel->vertices[i].y;
        vertex[2] = (float)accel->vertices[i].z;
    }
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, accel->corners, 0,
                               3 * sizeof(uint32_t), accel->ntriangles);
    rtcSetGeometryOccludedFilterFunction(geometry, filter_occluder);
    rtcCommitGeometry(geometry);
    accel->triangle_geometry = rtcAttachGeometry(accel->scene, geometry);
    rtcReleaseGeometry(geometry);
    return 0;
}

static void add_curved_geometry(Accel *accel)
{
    RTCGeometry geometry = rtcNewGeometry(accel->device, RTC_GEOMETRY_TYPE_USER);

    rtcSetGeometryUserPrimitiveCount(geometry, (unsigned)accel->ncurved);
    rtcSetGeometryUserData(geometry, accel);
    rtcSetGeometryBoundsFunction(geometry, bound_curved, NULL);
    rtcSetGeometryIntersectFunction(geometry, intersect_curved);
    rtcSetGeometryOccludedFunction(geometry, occlude_curved);
    rtcCommitGeometry(geometry);
    accel->curved_geometry = rtcAttachGeometry(accel->scene, geometry);
    rtcReleaseGeometry(geometry);
}

static int build(Accel *accel, int nthreads, RetexError *err)
{
    char config[64];
    int status;

    snprintf(config, sizeof(config), "threads=%d", nthreads > 0 ? nthreads : 0);
    accel->device = rtcNewDevice(config);
    if (!accel->device)
        return retex_fail(err, code_of(rtcGetDeviceError(NULL)), "Embree does not start");
    rtcSetDeviceErrorFunction(accel->device, complain, accel);
    if (!rtcGetDeviceProperty(accel->device, RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED))
        return retex_fail(err, RETEX_EUNSUPPORTED, "this Embree is built without filter functions");
    accel->scene = rtcNewScene(accel->device);
    rtcSetSceneFlags(accel->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(accel->scene, accel->ntriangles <= SPATIAL_SPLIT_LIMIT ? RTC_BUILD_QUALITY_HIGH
                                                                                   : RTC_BUILD_QUALITY_MEDIUM);
    accel->triangle_geometry = accel->curved_geometry = RTC_INVALID_GEOMETRY_ID;
    if (accel->ntriangles > 0) {
        status = add_triangle_geometry(accel, err);
        if (status < 0)
            return status;
    }
    if (accel->ncurved > 0)
        add_curved_geometry(accel);
    rtcCommitScene(accel->scene);
    return accel->error.code ? retex_fail(err, accel->error.code, "%s", accel->error.message) : 0;
}

int accel_create(Accel **out, const Scene *scene, int nthreads, RetexError *err)
{
    size_t count = (size_t)scene->nprimitives + 1;
    Accel *accel = calloc(1, sizeof(*accel));
    int status = 0;

    *out = NULL;
    if (!accel)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the scene's geometry");
    accel->source = scene;
    accel->flags = calloc(count, 1);
    accel->curved = calloc(count, sizeof(int));
    accel->planes = calloc(count, sizeof(int));
    if (!accel->flags || !accel->curved || !accel->planes)
        status = retex_fail(err, RETEX_ENOMEM, "no memory for the scene's geometry");
    if (status == 0)
        status = survey(accel, err);
    if (status == 0) {
        accel->vertices = malloc((accel->nvertices + 1) * sizeof(Vec3));
        accel->corners = malloc((accel->ntriangles + 1) * sizeof(*accel->corners));
        accel->triangles = malloc((accel->ntriangles + 1) * sizeof(Triangle));
        if (!accel->vertices || !accel->corners || !accel->triangles || accel->nvertices > UINT32_MAX)
            status = retex_fail(err, RETEX_ENOMEM, "no memory for %zu triangles", accel->ntriangles);
    }
    if (status == 0)
        status = collect_triangles(accel, err);
    if (status == 0)
        status = build(accel, nthreads, err);
    if (status < 0)
        accel_close(&accel);
    *out = accel;
    return status;
}

void accel_close(Accel **accel)
{
    Accel *a = accel ? *accel : NULL;

    if (!a)
        return;
    if (a->scene)
        rtcReleaseScene(a->scene);
    if (a->device)
        rtcReleaseDevice(a->device);
    free(a->vertices);
    free(a->corners);
    free(a->triangles);
    free(a->curved);
    free(a->planes);
    free(a->flags);
    free(a);
    *accel = NULL;
}

/* ---- queries ---- */

/* Embree may stop the program over a ray that is not finite; no such ray meets anything. */
static inline int can_be_traced(const Ray *ray, double origin_size)
{
    const Vec3 *d = &ray->direction;

    return origin_size < LARGEST_COORDINATE && fabs(d->x) + fabs(d->y) + fabs(d->z) < LARGEST_COORDINATE &&
           ray->tmin == ray->tmin && ray->tmax == ray->tmax;
}

/* Embree gets the ray in float, its range widened by what float may be off; the double one decides. Returns 0 where
 * the ray meets nothing for certain. */
static inline int start_query(Query *query, struct RTCRay *to, const Accel *accel, const Ray *ray, RayKind kind,
                              int skip_transparent)
{
    double origin_size = fabs(ray->origin.x) + fabs(ray->origin.y) + fabs(ray->origin.z);
    double start = ray->tmin > 0 ? ray->tmin - FLOAT_DOUBT * (ray->tmin + origin_size) : 0;

    if (!can_be_traced(ray, origin_size))
        return 0;
#if defined(RETEX_EMBREE4)
    rtcInitRayQueryContext(&query->context);
#else
    rtcInitIntersectContext(&query->context);
    query->context.flags =
        kind == RAY_CAMERA ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
#endif
    query->accel = accel;
    query->ray = ray;
    query->kind = (unsigned)kind;
    query->refused = skip_transparent ? TRANSPARENT : 0;
    /* Every coordinate that goes into the height is at most the sum of both. */
    query->rounding = 16 * DBL_EPSILON * (accel->reach + origin_size);
    query->t = INFINITY;
    query->face = 0;
    to->org_x = (float)ray->origin.x;
    to->org_y = (float)ray->origin.y;
    to->org_z = (float)ray->origin.z;
    to->dir_x = (float)ray->direction.x;
    to->dir_y = (float)ray->direction.y;
    to->dir_z = (float)ray->direction.z;
    to->tnear = start > 0 ? (float)start : 0;
    to->tfar = (float)(ray->tmax + FLOAT_DOUBT * (ray->tmax + origin_size));
    to->time = 0;
    to->mask = 0xffffffffu;
    to->id = to->flags = 0;
    return 1;
}

static void trace(Query *query, struct RTCRayHit *rayhit)
{
#if defined(RETEX_EMBREE4)
    struct RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.context = &query->context;
    args.flags = query->kind == RAY_CAMERA ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
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

/* The nearest plane before limit; any plane will do where any is set. Returns its primitive or -1. */
static int nearest_plane(const Query *query, double *limit, int any)
{
    const Accel *accel = query->accel;
    Ray ray = *query->ray;
    int found = -1, face;
    double t;

    ray.tmax = fmin(ray.tmax, *limit);
    for (int i = 0; i < accel->nplanes; i++) {
        int primitive = accel->planes[i];
        if (!visible(query, primitive) || !shape_intersect(&accel->source->primitives[primitive], &ray, &t, &face))
            continue;
        found = primitive;
        *limit = ray.tmax = t;
        if (any)
            break;
    }
    return found;
}

/* Is the triangle that Embree found one that the ray meets? */
static int accept_triangle(const Query *query, unsigned index, Hit *hit)
{
    const Accel *accel = query->accel;
    const Triangle *triangle = &accel->triangles[index];

    if (!triangle_distance(query, triangle, &hit->t))
        return 0;
    hit->primitive = triangle->primitive;
    hit->face = (int)triangle->face;
    hit->normal = triangle->normal;
    hit->b1 = hit->b2 = 0;
    if (triangle->interpolated)
        barycentrics(accel, index, query->ray, hit->t, hit);
    return 1;
}

/* Let the ray look for what is further away than what it found. */
static void go_behind(struct RTCRayHit *rayhit, float end)
{
    rayhit->ray.tnear = nextafterf(rayhit->ray.tfar, INFINITY);
    rayhit->ray.tfar = end;
    rayhit->hit.geomID = RTC_INVALID_GEOMETRY_ID;
}

int accel_intersect(const Accel *accel, const Ray *ray, RayKind kind, Hit *hit)
{
    Query query;
    struct RTCRayHit rayhit;
    double limit = ray->tmax;
    float end;
    int plane;

    hit->primitive = -1;
    if (!start_query(&query, &rayhit.ray, accel, ray, kind, 0))
        return 0;
    end = rayhit.ray.tfar;
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    for (trace(&query, &rayhit); rayhit.hit.geomID != RTC_INVALID_GEOMETRY_ID; trace(&query, &rayhit)) {
        unsigned index = rayhit.hit.primID;
        if (rayhit.hit.geomID == accel->curved_geometry) {
            hit->t = query.t, hit->primitive = accel->curved[index], hit->face = query.face;
            break;
        }
        if (accept_triangle(&query, index, hit))
            break;
        go_behind(&rayhit, end);
    }
    if (hit->primitive >= 0)
        limit = hit->t;
    plane = accel->nplanes ? nearest_plane(&query, &limit, 0) : -1;
    if (plane >= 0)
        hit->t = limit, hit->primitive = plane, hit->face = 0;
    return hit->primitive >= 0;
}

int accel_occluded(const Accel *accel, const Ray *ray, RayKind kind, int skip_transparent)
{
    Query query;
    struct RTCRay occluded;
    double limit = ray->tmax;

    if (!start_query(&query, &occluded, accel, ray, kind, skip_transparent))
        return 0;
    if (accel->nplanes && nearest_plane(&query, &limit, 1) >= 0)
        return 1;
    trace_occluded(&query, &occluded);
    return occluded.tfar < 0;
}

int accel_has_transparent(const Accel *accel, int light_source)
{
    return light_source ? accel->has_transparent : accel->has_straight;
}

int accel_is_transparent(const Accel *accel, int primitive)
{
    return (accel->flags[primitive] & TRANSPARENT) != 0;
}

void accel_bounds(const Accel *accel, Vec3 *low, Vec3 *high)
{
    *low = accel->low;
    *high = accel->high;
}
