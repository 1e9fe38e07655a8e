/* See projection.h. */
#include <math.h>
#include <stdlib.h>
#include "path/projection.h"
#include "faces/faces.h"
#include "shape/shape.h"

#define FLOOR_COSINE 0.9659258262890683 /* of 15 degrees */
enum { COPIED_FACES_MAX = 1 << 24 };    /* of instances that are looked at: more of them change little */

/* ---- the faces of a target ---- */

typedef void VisitFace(void *context, const Face *face);

typedef struct Visit {
    const Scene *scene;
    int target;
    VisitFace *face;
    void *context;
    long copied;
} Visit;

static int texture_is(const Texture *texture, int whole, int target)
{
    for (int k = 0; texture->tree && k < texture->tree->nleaves; k++)
        if (first_target(texture->tree->leaves[k]->target, whole) == target)
            return 1;
    return !texture->tree && whole == target;
}

/* Whether the face is of the target, as surface_at finds it; of textures that are blended by the first corner's. */
static int face_is(const Primitive *p, const Instance *instance, int face, int target)
{
    const int own = p->shape.mesh && p->shape.textures ? p->shape.mesh->faces[face].texture : -1;
    const Texture *texture = own >= 0 ? p->shape.textures->list[own] : p->texture;
    int whole = own >= 0 && p->face_targets ? p->face_targets[own] : p->target;
    if (p->faces)
        whole = first_target(whole, p->faces->of[face]);
    if (instance && p->inherits && own < 0)
        texture = instance->texture, whole = first_target(whole, instance->texture_target);
    if (instance)
        whole = first_target(whole, instance->target);
    return texture_is(texture, whole, target);
}

/* What has no faces counts by the box around it. */
static void visit_bounds(const Visit *visit, const Primitive *p, const Instance *instance)
{
    Vec3 low, high;
    Face corner = {.ncorners = 1};
    if (!shape_bounds(p, &low, &high))
        return;
    for (int k = 0; k < 8; k++) {
        const Vec3 at = vec3(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z);
        corner.corners[0] = instance ? transform_point(&instance->transform, at) : at;
        visit->face(visit->context, &corner);
    }
}

static void visit_primitive(Visit *visit, const Primitive *p, const Instance *instance)
{
    const int count = faces_count(p);
    Face face;
    visit->copied += instance ? count : 0;
    for (int k = 0; k < count; k++)
        if (face_is(p, instance, k, visit->target) && faces_placed(p, instance, k, &face))
            visit->face(visit->context, &face);
    if (!count && face_is(p, instance, 0, visit->target))
        visit_bounds(visit, p, instance);
}

static void visit_faces(const Scene *scene, int target, VisitFace *face, void *context)
{
    Visit visit = {scene, target, face, context, 0};
    for (int k = 0; k < scene->nprimitives; k++)
        if (!scene->primitives[k].prototype)
            visit_primitive(&visit, &scene->primitives[k], NULL);
    for (int k = 0; k < scene->ninstances && visit.copied < COPIED_FACES_MAX; k++) {
        const Prototype *prototype = scene->instances[k].prototype;
        for (int i = 0; i < prototype->count && visit.copied < COPIED_FACES_MAX; i++)
            visit_primitive(&visit, &scene->primitives[prototype->first + i], &scene->instances[k]);
    }
}

/* ---- the directions in which they lie ---- */

typedef struct Directions {
    Vec3 sum;            /* of normals, weighted by areas */
    double spread[3][3]; /* of their products with themselves, likewise */
    double turn[2];      /* sum of the directions of four times the angle of upright faces about y */
    double area, upright;
    Vec3 middle;         /* sum of the middles of faces, weighted as these */
} Directions;

static void add_direction(void *context, const Face *face)
{
    Directions *d = context;
    const double area = isfinite(face->area) ? face->area : 1, across = hypot(face->normal.x, face->normal.z);
    const Vec3 n = face->normal;
    if (!(area > 0))
        return;
    d->area += area;
    d->sum = vec_mad(d->sum, n, area);
    const double of[3] = {n.x, n.y, n.z};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            d->spread[i][j] += area * of[i] * of[j];
    for (int k = 0; k < face->ncorners; k++)
        d->middle = vec_mad(d->middle, face->corners[k], area / face->ncorners);
    if (across < sqrt(0.75))
        return;
    const double angle = 4 * atan2(n.z, n.x);
    d->turn[0] += area * cos(angle), d->turn[1] += area * sin(angle), d->upright += area;
}

/* The mean normal; of what is closed, or has normals on either side, the direction along which most of it is seen: the
 * main axis of the spread of normals. */
static Vec3 main_normal(const Directions *d)
{
    const double(*m)[3] = d->spread;
    Vec3 rows[3], n = m[2][2] > m[1][1] ? vec3(0, 0, -1) : vec3(0, 1, 0);
    if (vec_length(d->sum) > 0.1 * d->area)
        return vec_normalize(d->sum);
    if (m[0][0] > m[1][1] && m[0][0] > m[2][2])
        n = vec3(-1, 0, 0);
    for (int i = 0; i < 3; i++)
        rows[i] = vec3(m[i][0], m[i][1], m[i][2]);
    for (int k = 0; k < 100; k++)
        n = vec_normalize(vec3(vec_dot(rows[0], n), vec_dot(rows[1], n), vec_dot(rows[2], n)));
    return n;
}

/* ---- the outline of a floor ---- */

typedef struct Outline {
    Vec3 s, t; /* that its points are counted along */
    size_t count, capacity;
    Vec2 *points;
    int failed;
} Outline;

static void add_outline(void *context, const Face *face)
{
    Outline *o = context;
    if (o->count + 4 > o->capacity) {
        const size_t capacity = 2 * o->capacity + 256;
        Vec2 *points = realloc(o->points, capacity * sizeof *points);
        o->failed |= !points;
        if (!points)
            return;
        o->points = points, o->capacity = capacity;
    }
    for (int k = 0; k < face->ncorners; k++)
        o->points[o->count++] = (Vec2){vec_dot(face->corners[k], o->s), vec_dot(face->corners[k], o->t)};
}

static int compare_points(const void *a, const void *b)
{
    const Vec2 *p = a, *q = b;
    if (p->u != q->u)
        return p->u < q->u ? -1 : 1;
    return (p->v > q->v) - (p->v < q->v);
}

/* Positive where c lies to the left of the line from a to b, by more than rounding. */
static int is_left(Vec2 a, Vec2 b, Vec2 c)
{
    const double u = b.u - a.u, v = b.v - a.v, p = c.u - a.u, q = c.v - a.v;
    return u * q - v * p > 1e-9 * hypot(u, v) * (hypot(u, v) + hypot(p, q));
}

/* The lower or upper half of the convex hull of points in order, as indices' points; returns their number. */
static size_t half_hull(const Vec2 *points, size_t count, int upper, Vec2 *hull)
{
    size_t n = 0;
    for (size_t k = 0; k < count; k++) {
        const Vec2 p = points[upper ? count - 1 - k : k];
        while (n > 1 && !is_left(hull[n - 2], hull[n - 1], p))
            n--;
        hull[n++] = p;
    }
    return n;
}

/* How far points reach along a direction. */
static double extent(const Vec2 *points, size_t count, Vec2 along)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t k = 0; k < count; k++) {
        const double at = points[k].u * along.u + points[k].v * along.v;
        low = fmin(low, at), high = fmax(high, at);
    }
    return high - low;
}

/* The longer side of the smallest rectangle around a hull, one of whose sides lies along an edge: the direction of the
 * walls, also where a floor has bays and corners. Of equal ones the one next to the first axis. */
static Vec2 main_direction(const Vec2 *hull, size_t count)
{
    Vec2 best = {0, 0};
    double smallest = INFINITY;
    const size_t step = count / 1024 + 1; /* of what is round, edges far apart are enough */
    for (size_t k = 0; k + 1 < count; k += step) {
        const double u = hull[k + 1].u - hull[k].u, v = hull[k + 1].v - hull[k].v, length = hypot(u, v);
        if (!(length > 0))
            continue;
        Vec2 along = {u / length, v / length}, beside = {-v / length, u / length};
        const double wide = extent(hull, count, along), deep = extent(hull, count, beside), area = wide * deep;
        const int is_square = fabs(wide - deep) <= 1e-6 * wide;
        if (is_square ? fabs(beside.u) > fabs(along.u) : deep > wide)
            along = beside;
        if (area < smallest * (1 - 1e-6) || (area < smallest * (1 + 1e-6) && fabs(along.u) > fabs(best.u)))
            best = along, smallest = fmin(area, smallest);
    }
    return best;
}

/* The direction of u on a floor: along the longer side of its outline, to the right. */
static int along_floor(const Scene *scene, int target, Vec3 normal, Vec3 *u)
{
    const Vec3 s = vec_normalize(vec_mad(vec3(1, 0, 0), normal, -normal.x));
    Outline o = {.s = s, .t = vec_cross(s, normal)};
    Vec2 longest = {0, 0};
    size_t count = 0;
    visit_faces(scene, target, add_outline, &o);
    Vec2 *hull = malloc((2 * o.count + 1) * sizeof *hull);
    const int made = hull && !o.failed;
    if (made && o.count > 1) {
        qsort(o.points, o.count, sizeof *o.points, compare_points);
        for (int upper = 0; upper < 2; upper++)
            count += half_hull(o.points, o.count, upper, hull + count);
        longest = main_direction(hull, count);
    }
    const double length = hypot(longest.u, longest.v), right = length * 1e-6;
    if (length > 0 && (longest.u < -right || (longest.u <= right && longest.v < 0)))
        longest.u = -longest.u, longest.v = -longest.v;
    *u = length > 0 ? vec_normalize(vec_mad(vec_scale(s, longest.u), o.t, longest.v)) : s;
    free(o.points);
    free(hull);
    return made;
}

/* ---- the projection of a target ---- */

static void add_bounds(void *context, const Face *face)
{
    TargetProjection *p = context;
    for (int k = 0; k < face->ncorners; k++)
        for (int axis = 0; axis < 3; axis++) {
            const double at = isfinite(face->area) ? vec_dot(face->corners[k], p->axes[axis]) : INFINITY;
            p->low[axis] = fmin(p->low[axis], isfinite(at) ? at : -INFINITY);
            p->high[axis] = fmax(p->high[axis], at);
        }
}

static void set_bounds(TargetProjection *p, const Scene *scene, int target)
{
    for (int axis = 0; axis < 3; axis++)
        p->low[axis] = INFINITY, p->high[axis] = -INFINITY;
    visit_faces(scene, target, add_bounds, p);
    for (int axis = 0; axis < 3; axis++)
        if (!isfinite(p->low[axis]) || !isfinite(p->high[axis]))
            p->low[axis] = p->high[axis] = 0;
}

static int set_planar(TargetProjection *p, const Scene *scene, int target, const Directions *d)
{
    const Vec3 middle = vec_scale(d->middle, shape_inverse(d->area));
    Vec3 n = main_normal(d);
    if (vec_dot(vec_sub(scene->camera.location, middle), n) < 0)
        n = vec_neg(n);
    p->axes[2] = n;
    if (fabs(n.y) > FLOOR_COSINE) {
        if (!along_floor(scene, target, n, &p->axes[0]))
            return 0;
        p->axes[1] = vec_cross(p->axes[0], n);
        return 1;
    }
    p->axes[1] = vec_normalize(vec_mad(vec3(0, 1, 0), n, -n.y));
    p->axes[0] = vec_cross(n, p->axes[1]);
    return 1;
}

static void set_upright(TargetProjection *p, const Directions *d)
{
    const int agree = p->kind == UV_BOX && hypot(d->turn[0], d->turn[1]) > 0.5 * d->upright && d->upright > 0;
    const double angle = agree ? atan2(d->turn[1], d->turn[0]) / 4 : 0;
    p->axes[0] = vec3(cos(angle), 0, sin(angle));
    p->axes[1] = vec3(0, 1, 0);
    p->axes[2] = vec3(-sin(angle), 0, cos(angle));
}

/* A target that is pointed at, of meshes that have no UV of any kind. */
static int lacks_uv(const Scene *scene, int t)
{
    int any = 0;
    for (int k = 0; k < scene->nprimitives && scene->targets[t].is_pointed_at; k++) {
        const Texture *texture = primitive_target_texture(&scene->primitives[k], t);
        const Mesh *mesh = scene->primitives[k].shape.mesh;
        if (!texture)
            continue;
        if (!mesh || mesh->nuvs || texture->pigment->uv_mapping || texture->pigment->kind == PIGMENT_IMAGE)
            return 0;
        any = 1;
    }
    return any;
}

int projection_choose(Scene *scene, double unit, RetexError *err)
{
    for (int t = 0; t < scene->ntargets; t++) {
        Target *target = &scene->targets[t];
        TargetProjection *p = &target->projection;
        Directions d = {.area = 0};
        *p = (TargetProjection){.kind = target->uv, .unit = unit};
        if (target->uv == UV_UNSAID)
            p->kind = target->nselections ? UV_PLANAR : lacks_uv(scene, t) ? UV_BOX : UV_MODEL;
        if (p->kind == UV_MODEL)
            continue;
        visit_faces(scene, t, add_direction, &d);
        if (p->kind != UV_PLANAR)
            set_upright(p, &d);
        else if (!set_planar(p, scene, t, &d))
            return retex_fail(err, RETEX_ENOMEM, "no memory for the UV of target `%s`", target->name);
        set_bounds(p, scene, t);
    }
    return RETEX_OK;
}

/* ---- UV ---- */

static Vec2 scaled(const TargetProjection *p, double u, double v)
{
    return (Vec2){u * p->unit, v * p->unit};
}

/* at: along the axes. n: the side that is seen, likewise. */
static Vec2 box_uv(const TargetProjection *p, const double at[3], const double n[3])
{
    const double from[3] = {at[0] - p->low[0], at[1] - p->low[1], at[2] - p->low[2]},
                 to[3] = {p->high[0] - at[0], p->high[1] - at[1], p->high[2] - at[2]};
    if (fabs(n[0]) > fabs(n[1]) && fabs(n[0]) > fabs(n[2]))
        return scaled(p, n[0] > 0 ? from[2] : to[2], from[1]);
    if (fabs(n[2]) > fabs(n[1]))
        return scaled(p, n[2] > 0 ? to[0] : from[0], from[1]);
    return scaled(p, from[0], n[1] > 0 ? from[2] : to[2]);
}

static Vec2 cylinder_uv(const TargetProjection *p, const double at[3], const double n[3])
{
    const double x = at[0] - (p->low[0] + p->high[0]) / 2, z = at[2] - (p->low[2] + p->high[2]) / 2;
    const double radius = (p->high[0] - p->low[0] + p->high[2] - p->low[2]) / 4, angle = PI + atan2(x, -z);
    const int from_inside = x * n[0] + z * n[2] < 0;
    return scaled(p, radius * (from_inside ? 2 * PI - angle : angle), at[1] - p->low[1]);
}

Vec2 projection_uv(const TargetProjection *p, const Surface *surface)
{
    const Vec3 normal = surface->backside ? vec_neg(surface->geometric_normal) : surface->geometric_normal;
    double at[3], n[3];
    for (int k = 0; k < 3; k++)
        at[k] = vec_dot(surface->position, p->axes[k]), n[k] = vec_dot(normal, p->axes[k]);
    if (p->kind == UV_PLANAR)
        return scaled(p, at[0] - p->low[0], at[1] - p->low[1]);
    if (p->kind == UV_CYLINDER && fabs(n[1]) < sqrt(0.5))
        return cylinder_uv(p, at, n);
    return box_uv(p, at, n);
}
