/* Building what Embree traces.
 *
 * Shapes that have triangles (boxes, meshes) are one triangle geometry in world space; other shapes with bounds are
 * user geometry; those without bounds (planes, polynomials) are tested beside Embree. The scene is ROBUST: it costs a
 * tenth, but without it 6 in 100 rays aimed at an edge between two triangles, and 1 in 100 000 at random, pass
 * through. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <retex/host/assert.h>
#include "accel/embree.h"
#include "shade/texture.h"
#include "shape/csg.h"
#include "shape/shape.h"

#define SPATIAL_SPLIT_LIMIT 4000000 /* triangles: above it, building takes longer than tracing gains */

/* Of a copy of what is shared: round that one's own box. */
static int copy_bounds(const Accel *shared, const Transform *transform, Vec3 *low, Vec3 *high)
{
    Bounds all = bounds_empty();

    if (shared->nunbounded > 0)
        return 0;
    for (int k = 0; k < 8; k++) {
        Vec3 corner = vec3(k & 1 ? shared->high.x : shared->low.x, k & 2 ? shared->high.y : shared->low.y,
                           k & 4 ? shared->high.z : shared->low.z);
        bounds_add(&all, transform_point(transform, corner));
    }
    *low = all.low;
    *high = all.high;
    return 1;
}

/* 0: there are none. */
static int item_bounds(const Accel *accel, int item, Vec3 *low, Vec3 *high)
{
    RETEX_ASSERT(item >= -accel->source->ncsgs && item < accel->source->nprimitives + accel->source->ninstances);
    if (item >= accel->source->nprimitives) {
        const Instance *instance = &accel->source->instances[item - accel->source->nprimitives];
        return copy_bounds(accel->prototypes[instance->prototype->number]->accel, &instance->transform, low, high);
    }
    if (item >= 0 && accel->shared && accel->shared[item])
        return copy_bounds(accel->shared[item]->accel, &accel->source->primitives[item].transform, low, high);
    if (item >= 0)
        return shape_bounds(&accel->source->primitives[item], low, high);
    const Csg *csg = accel->source->csgs[~item];
    *low = csg->surface.low;
    *high = csg->surface.high;
    return bounds_is_finite(&csg->surface);
}

static void bound_curved(const struct RTCBoundsFunctionArguments *args)
{
    const Accel *accel = args->geometryUserPtr;
    struct RTCBounds *bounds = args->bounds_o;
    Vec3 low, high;
    double pad;

    item_bounds(accel, accel->curved[args->primID], &low, &high);
    /* Room for Embree's rounding, in coordinates and in extent: flat shapes have none. And for that of rays that start
     * elsewhere in the scene, as far as it does not make the bounds larger to speak of. */
    pad = 2e-6 * (vec_largest(low) + vec_largest(high)) +
          fmin(1e-6 * fmax(accel->eye, fmax(vec_largest(accel->low), vec_largest(accel->high))),
               0.01 * vec_largest(vec_sub(high, low)));
    bounds->lower_x = (float)(low.x - pad);
    bounds->lower_y = (float)(low.y - pad);
    bounds->lower_z = (float)(low.z - pad);
    bounds->upper_x = (float)(high.x + pad);
    bounds->upper_y = (float)(high.y + pad);
    bounds->upper_z = (float)(high.z + pad);
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

static void record_error(void *context, enum RTCError code, const char *text)
{
    Accel *accel = context;

    if (accel->error.code == 0)
        retex_fail(&accel->error, code_of(code), "Embree: %s", text ? text : "unknown error");
}

/* ---- building ---- */

static int may_transmit(const Texture *texture)
{
    return texture && !texture_is_opaque(texture);
}

/* Whether the primitive has one texture, which refracts what it lets through. */
static int always_refracts(const Primitive *primitive)
{
    const Finish *finish = primitive->texture->finish;
    const int bends = finish && finish_transmits(finish)
                          ? finish->retex.ior != 1 || interior_disperses(primitive->interior)
                          : !(finish && finish->retex.present) && interior_bends(primitive->interior);
    int several = primitive->interior_texture || primitive->shape.textures || primitive->texture->tree;

    return !several && bends;
}

static unsigned char primitive_flags(const Primitive *primitive)
{
    unsigned flags = (primitive->no_image ? 0u : RAY_CAMERA) | (primitive->no_shadow ? 0u : RAY_SHADOW) |
                     (primitive->no_reflection ? 0u : RAY_BOUNCE);
    int through = may_transmit(primitive->texture) || may_transmit(primitive->interior_texture);

    flags |= primitive->inherits ? INHERITS : 0u;

    for (int i = 0; primitive->shape.textures && i < primitive->shape.textures->count; i++)
        through |= may_transmit(primitive->shape.textures->list[i]);
    if (!through)
        return (unsigned char)flags;
    return (unsigned char)(flags | TRANSPARENT | (always_refracts(primitive) ? 0 : STRAIGHT));
}

static int is_traceable(Vec3 low, Vec3 high)
{
    return vec_largest(low) < LARGEST_COORDINATE && vec_largest(high) < LARGEST_COORDINATE;
}

static int fail_untraceable(const Scene *scene, int line, RetexError *err)
{
    return retex_fail_at(err, RETEX_EINVAL, scene->path, line, 0,
                         "this object has coordinates that are not finite or beyond %g", LARGEST_COORDINATE);
}

/* Whether it is found through a tree of CSG or an instance. */
static int is_elsewhere(const Accel *accel, const Primitive *primitive)
{
    return primitive->csg || (primitive->prototype && !accel->parent);
}

/* Whether an item is a primitive whose triangles are the scene's. */
static int is_by_triangles(const Accel *accel, int item)
{
    if (item < 0 || item >= accel->source->nprimitives)
        return 0;
    const Primitive *primitive = &accel->source->primitives[item];

    return primitive->shape.ops->triangles && !is_elsewhere(accel, primitive) &&
           !(accel->shared && accel->shared[item]);
}

/* Sort an item to triangles, to user geometry, or to what is tested beside Embree, and count what it needs. line: of
 * the scene file, for what cannot be traced. */
static int add_item(Accel *accel, int item, int line, RetexError *err)
{
    ShapeTriangles triangles = {0, 0, NULL, NULL, 0, 0};
    Vec3 low, high;

    if (!item_bounds(accel, item, &low, &high)) {
        accel->unbounded[accel->nunbounded++] = item;
        return 0;
    }
    if (is_by_triangles(accel, item)) {
        const Shape *shape = &accel->source->primitives[item].shape;
        shape->ops->triangles(shape, &triangles);
        if (triangles.ntriangles == 0)
            return 0;
    }
    if (!is_traceable(low, high))
        return fail_untraceable(accel->source, line, err);
    accel->low = vec_min(accel->low, low), accel->high = vec_max(accel->high, high);
    if (triangles.ntriangles == 0)
        accel->curved[accel->ncurved++] = item;
    accel->nvertices += (size_t)triangles.nvertices;
    accel->ntriangles += (size_t)triangles.ntriangles;
    return 0;
}

static int is_empty(const Accel *accel)
{
    return accel->nunbounded + accel->ncurved == 0 && accel->ntriangles == 0;
}

static int add_primitives(Accel *accel, RetexError *err)
{
    const Scene *scene = accel->source;
    int code = 0;

    for (int i = 0; i < scene->nprimitives && code == 0; i++) {
        const Primitive *primitive = &scene->primitives[i];
        accel->flags[i] = primitive_flags(primitive);
        if (!is_elsewhere(accel, primitive))
            code = add_item(accel, i, primitive->line, err);
    }
    return code;
}

/* CSGs are user geometry as curved shapes are. Their operands are no geometry by themselves. */
static int add_csgs(Accel *accel, RetexError *err)
{
    const Scene *scene = accel->source;
    int code = 0;

    for (int i = 0; i < scene->ncsgs && code == 0; i++)
        if (!bounds_is_empty(&scene->csgs[i]->surface))
            code = add_item(accel, ~i, scene->csgs[i]->line, err);
    return code;
}

/* Primitives of prototypes are where the instances are. */
static int add_instances(Accel *accel, RetexError *err)
{
    const Scene *scene = accel->source;
    int code = 0;

    for (int i = 0; i < scene->ninstances && code == 0; i++) {
        const Instance *instance = &scene->instances[i];
        const int item = scene->nprimitives + i;
        /* Whether what is let through is bent is asked of the hit. */
        accel->flags[item] = (unsigned char)(may_transmit(instance->texture) ? TRANSPARENT | STRAIGHT : 0u);
        if (!is_empty(accel->prototypes[instance->prototype->number]->accel))
            code = add_item(accel, item, instance->line, err);
    }
    return code;
}

/* Sort all items, and refuse what cannot be traced. */
static int add_items(Accel *accel, RetexError *err)
{
    const Bounds none = bounds_empty();
    accel->low = none.low, accel->high = none.high;
    /* no camera is in what has a parent */
    accel->eye = accel->parent ? 0 : vec_largest(accel->source->camera.location);
    int code = add_primitives(accel, err);

    if (code == 0)
        code = add_csgs(accel, err);
    return code ? code : add_instances(accel, err);
}

/* Bounds are made by minimum and maximum, which pass over NaN: so vertices are checked. */
static int finite_point(Vec3 p)
{
    return isfinite(p.x) && isfinite(p.y) && isfinite(p.z);
}

/* Add a triangle, unless it has no area. */
static void add_triangle(Accel *accel, size_t *count, size_t base, const int corner[3], int index, int face)
{
    const Primitive *primitive = &accel->source->primitives[index];
    uint32_t *out = accel->corners[*count];
    Vec3 at[3], n;

    for (int k = 0; k < 3; k++) {
        out[k] = (uint32_t)(base + (size_t)corner[k]);
        at[k] = accel->vertices[out[k]];
    }
    n = vec_cross(vec_sub(at[1], at[0]), vec_sub(at[2], at[0]));
    if (!(vec_dot(n, n) > 0))
        return;
    n = primitive->shape.ops->face_normal(primitive, face, at);
    accel->triangles[*count] = (Triangle){n, vec_dot(n, at[0]), index, face};
    ++*count;
}

/* Shapes that are traced as triangles into one list; those without area are left out. */
static int collect_triangles(Accel *accel, RetexError *err)
{
    const Scene *scene = accel->source;
    size_t base = 0, count = 0;

    for (int i = 0; i < scene->nprimitives; i++) {
        const Primitive *primitive = &scene->primitives[i];
        ShapeTriangles shape;
        if (!is_by_triangles(accel, i))
            continue;
        primitive->shape.ops->triangles(&primitive->shape, &shape);
        if (shape.ntriangles == 0)
            continue;
        for (int k = 0; k < shape.nvertices; k++) {
            Vec3 p = transform_point(&primitive->transform, shape.vertices[k]);
            if (!finite_point(p))
                return retex_fail_at(err, RETEX_EINVAL, scene->path, primitive->line, 0,
                                     "vertex %d of this object is not finite", k);
            accel->vertices[base + (size_t)k] = p;
            accel->reach = fmax(accel->reach, vec_largest(p));
        }
        for (int k = 0; k < shape.ntriangles; k++)
            add_triangle(accel, &count, base, shape.corners + (size_t)k * shape.stride, i, k / shape.per_face);
        base += (size_t)shape.nvertices;
    }
    RETEX_ASSERT(base == accel->nvertices && count <= accel->ntriangles); /* what add_item has counted */
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
    rtcSetGeometryOccludedFilterFunction(geometry, accel_filter_occluder);
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
    rtcSetGeometryIntersectFunction(geometry, accel_intersect_curved);
    rtcSetGeometryOccludedFunction(geometry, accel_occlude_curved);
    rtcCommitGeometry(geometry);
    accel->curved_geometry = rtcAttachGeometry(accel->scene, geometry);
    rtcReleaseGeometry(geometry);
}

/* Called by threads of Embree before it takes memory and after it gives some back; a refusal ends the build. */
static bool charge_embree(void *context, ssize_t bytes, bool after)
{
    Accel *accel = context;

    (void)after;
    if (bytes <= 0) {
        retex_budget_release(accel->budget, (uint64_t)-bytes);
        return true;
    }
    if (!retex_budget_charge(accel->budget, (uint64_t)bytes, "", NULL))
        return true;
    atomic_store(&accel->over_budget, 1);
    return false;
}

static bool monitor_build(void *context, double done)
{
    const Accel *accel = context;

    (void)done;
    return !retex_budget_is_stopped(accel->budget);
}

/* Whose fields Embree's callbacks of the device change. */
static Accel *device_owner(Accel *accel)
{
    return accel->parent ? accel->parent : accel;
}

/* An error of Embree is one of the budget, if that is used up. */
static int build_error(Accel *accel, RetexError *err)
{
    int code = retex_budget_check(accel->budget, err);

    if (!code && atomic_load(&accel->over_budget))
        code = retex_budget_charge(accel->budget, UINT64_MAX, "the scene's geometry", err);
    return code ? code : retex_fail(err, accel->error.code, "%s", accel->error.message);
}

static int open_device(Accel *accel, int nthreads, RetexError *err)
{
    char config[64];

    snprintf(config, sizeof(config), "threads=%d", nthreads > 0 ? nthreads : 0);
    accel->device = rtcNewDevice(config);
    if (!accel->device)
        return retex_fail(err, code_of(rtcGetDeviceError(NULL)), "Embree does not start");
    rtcSetDeviceErrorFunction(accel->device, record_error, accel);
    if (accel->budget)
        rtcSetDeviceMemoryMonitorFunction(accel->device, charge_embree, accel);
    if (!rtcGetDeviceProperty(accel->device, RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED))
        return retex_fail(err, RETEX_EUNSUPPORTED, "this Embree is built without filter functions");
    return 0;
}

static int build(Accel *accel, RetexError *err)
{
    int code;

    accel->scene = rtcNewScene(accel->device);
    rtcSetSceneFlags(accel->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(accel->scene, accel->ntriangles <= SPATIAL_SPLIT_LIMIT ? RTC_BUILD_QUALITY_HIGH
                                                                                   : RTC_BUILD_QUALITY_MEDIUM);
    accel->triangle_geometry = accel->curved_geometry = RTC_INVALID_GEOMETRY_ID;
    if (accel->ntriangles > 0) {
        code = add_triangle_geometry(accel, err);
        if (code < 0)
            return code;
    }
    if (accel->ncurved > 0)
        add_curved_geometry(accel);
    if (accel->budget)
        rtcSetSceneProgressMonitorFunction(accel->scene, monitor_build, accel);
    rtcCommitScene(accel->scene);
    return device_owner(accel)->error.code ? build_error(device_owner(accel), err) : 0;
}

static int reserve_geometry(Accel *accel, RetexError *err)
{
    const size_t vertices = (accel->nvertices + 1) * sizeof(Vec3),
                 corners = (accel->ntriangles + 1) * sizeof(*accel->corners),
                 triangles = (accel->ntriangles + 1) * sizeof(Triangle), all = vertices + corners + triangles;
    int code = retex_budget_charge(accel->budget, all, "the scene's geometry", err);

    if (code < 0)
        return code;
    accel->charged = all;
    accel->vertices = malloc(vertices);
    accel->corners = malloc(corners);
    accel->triangles = malloc(triangles);
    if (!accel->vertices || !accel->corners || !accel->triangles || accel->nvertices > UINT32_MAX)
        return retex_fail(err, RETEX_ENOMEM, "no memory for %zu triangles", accel->ntriangles);
    return 0;
}

int accel_create(Accel **out, const Scene *scene, int nthreads, RetexError *err)
{
    return accel_create_within(out, scene, nthreads, NULL, err);
}

static int fill(Accel *accel, RetexError *err)
{
    const size_t count =
        (size_t)accel->source->nprimitives + (size_t)accel->source->ncsgs + (size_t)accel->source->ninstances + 1;
    int code = 0;

    accel->flags = calloc(count, 1);
    accel->curved = calloc(count, sizeof(int));
    accel->unbounded = calloc(count, sizeof(int));
    if (!accel->flags || !accel->curved || !accel->unbounded)
        code = retex_fail(err, RETEX_ENOMEM, "no memory for the scene's geometry");
    if (code == 0)
        code = add_items(accel, err);
    if (code == 0)
        code = reserve_geometry(accel, err);
    if (code == 0)
        code = collect_triangles(accel, err);
    if (code == 0)
        code = build(accel, err);
    free(accel->vertices);
    accel->vertices = NULL;
    return code;
}

/* Each of what is shared, with the device and the budget of the whole. */
static int create_shared(Accel *accel, RetexError *err)
{
    int code = accel_find_shared(accel, err);

    for (Shared *shared = accel->all_shared; shared && code == 0; shared = shared->next) {
        shared->accel = calloc(1, sizeof(*shared->accel));
        if (!shared->accel)
            return retex_fail(err, RETEX_ENOMEM, "no memory for the scene's geometry");
        shared->accel->source = shared->scene;
        shared->accel->budget = accel->budget;
        shared->accel->parent = accel;
        shared->accel->device = accel->device;
        rtcRetainDevice(accel->device);
        code = fill(shared->accel, err);
    }
    return code;
}

int accel_create_within(Accel **out, const Scene *scene, int nthreads, RetexBudget *budget, RetexError *err)
{
    Accel *accel = calloc(1, sizeof(*accel));
    int code;

    *out = NULL;
    if (!accel)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the scene's geometry");
    accel->source = scene;
    accel->budget = budget;
    code = open_device(accel, nthreads, err);
    if (code == 0)
        code = create_shared(accel, err);
    if (code == 0)
        code = fill(accel, err);
    if (code < 0)
        accel_close(&accel);
    *out = accel;
    return code;
}

void accel_close(Accel **accel)
{
    Accel *a = accel ? *accel : NULL;

    if (!a)
        return;
    for (Shared *shared = a->all_shared; shared; shared = shared->next)
        accel_close(&shared->accel);
    accel_free_shared(a);
    if (a->scene)
        rtcReleaseScene(a->scene);
    if (a->device)
        rtcReleaseDevice(a->device);
    free(a->corners);
    free(a->triangles);
    free(a->curved);
    free(a->unbounded);
    free(a->flags);
    retex_budget_release(a->budget, a->charged);
    free(a);
    *accel = NULL;
}

int accel_is_transparent(const Accel *accel, const Hit *hit)
{
    const Scene *scene = accel->source;
    RETEX_ASSERT(hit->primitive >= 0);
    RETEX_ASSERT(!hit->instance == !scene->primitives[hit->primitive].prototype);
    unsigned flags = accel->flags[hit->primitive];

    if (hit->instance && flags & INHERITS)
        flags |= accel->flags[scene->nprimitives + (hit->instance - scene->instances)];
    return (flags & TRANSPARENT) != 0;
}

void accel_bounds(const Accel *accel, Vec3 eye, Vec3 *low, Vec3 *high)
{
    *low = vec3(fmin(accel->low.x, eye.x), fmin(accel->low.y, eye.y), fmin(accel->low.z, eye.z));
    *high = vec3(fmax(accel->high.x, eye.x), fmax(accel->high.y, eye.y), fmax(accel->high.z, eye.z));
}
