/* The prism: closed curves in x and z, swept along y from r0 to r1; as conic_sweep a cone from the origin, which has
 * the curves at y = 1. Inside by the even-odd rule. Faces: 0 the cap at r0, 1 that at r1, from 2 on the sides by
 * segment. Natural parametrisation: of sides u along the curve, by segments, v the height; of caps x and z within the
 * bounds. */
#include <float.h>
#include "shape/profile.h"
#include "shape/shape.h"

static const Profile *profile_of(const Shape *shape)
{
    return shape->data;
}

/* How much larger than the curve the section at height y is. */
static double scale_at(const Shape *shape, double y)
{
    return profile_of(shape)->conic ? y : 1;
}

/* In canonical space. */
static void box_of(const Shape *shape, Vec3 *low, Vec3 *high)
{
    const Profile *profile = profile_of(shape);

    *low = vec3(INFINITY, INFINITY, INFINITY);
    *high = vec_neg(*low);
    for (int i = 0; i < 4; i++) {
        double y = i & 1 ? shape->r1 : shape->r0, k = scale_at(shape, y);
        Vec2 p = i & 2 ? profile->high : profile->low;
        shape_bound_point(low, high, vec3(k * p.u, y, k * p.v));
    }
}

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    Vec3 a, b;

    box_of(&primitive->shape, &a, &b);
    shape_bound_box(low, high, &primitive->transform, a, b);
}

/* Sides: seen along the sweep, the line is a line in the curve's plane. */
static void intersect_sides(const Shape *shape, const ShapeLine *line, ShapeCrossings *crossings)
{
    const Profile *profile = profile_of(shape);
    const Vec3 o = line->origin, d = line->direction, n = vec_cross(o, d);
    const double flat = d.x * d.x + d.z * d.z;
    double a = d.z, b = -d.x, c = d.x * o.z - d.z * o.x;

    if (profile->conic)
        a = n.x, b = n.z, c = n.y;
    if (a == 0 && b == 0)
        return;
    for (int i = 0; i < profile->count; i++) {
        double roots[PROFILE_DEGREE], s, y;
        const int count = profile_crossings(profile, &profile->segments[i], a, b, c, roots);
        for (int k = 0; k < count; k++) {
            Vec2 p = profile_at(&profile->segments[i], roots[k]);
            if (profile->conic) {
                Vec3 w = vec3(p.u, 1, p.v), turned = vec_cross(d, w);
                s = -vec_dot(vec_cross(o, w), turned) / vec_dot(turned, turned);
            } else {
                s = ((p.u - o.x) * d.x + (p.v - o.z) * d.z) / flat;
            }
            y = o.y + s * d.y;
            if (y >= shape->r0 && y <= shape->r1)
                shape_add_crossing(crossings, shape_line_t(line, s), 2 + i);
        }
    }
}

static void intersect_caps(const Shape *shape, const ShapeLine *line, ShapeCrossings *crossings)
{
    const ShapeRay *ray = crossings->ray;

    for (int cap = 0; cap < 2; cap++) {
        double y = cap ? shape->r1 : shape->r0, k = scale_at(shape, y), s;
        Vec3 p;
        if (fabs(ray->origin.y - y) <= ray->slack || line->direction.y == 0 || k == 0)
            continue;
        s = (y - line->origin.y) / line->direction.y;
        p = vec_mad(line->origin, line->direction, s);
        if (profile_contains(profile_of(shape), (Vec2){p.x / k, p.z / k}))
            shape_add_crossing(crossings, shape_line_t(line, s), cap);
    }
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    const Shape *shape = &primitive->shape;
    ShapeCrossings crossings = shape_crossings(ray);
    double low = -INFINITY, high = INFINITY;
    ShapeLine line;
    Vec3 a, b, pad;

    box_of(shape, &a, &b);
    pad = vec_scale(vec_sub(b, a), 1e-9);
    a = vec_sub(a, pad);
    b = vec_add(b, pad);
    line = shape_line(ray, vec_scale(vec_add(a, b), 0.5));
    if (!shape_line_clip(&line, a, b, &low, &high))
        return 0;
    intersect_sides(shape, &line, &crossings);
    if (!shape->open)
        intersect_caps(shape, &line, &crossings);
    return shape_crossings_end(&crossings, primitive, profile_of(shape)->size, t, face);
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    const Shape *shape = &primitive->shape;
    const Profile *profile = profile_of(shape);

    if (face < 2) {
        out->p = vec3(p.x, face ? shape->r1 : shape->r0, p.z);
        out->normal = vec3(0, face ? 1 : -1, 0);
        return;
    }
    const ProfileSegment *segment = &profile->segments[face - 2];
    double k = scale_at(shape, p.y), u;
    if (k == 0)
        k = 1e-100;
    u = profile_nearest(profile, segment, (Vec2){p.x / k, p.z / k});
    Vec2 at = profile_at(segment, u), n = profile_normal(profile, segment, u);
    out->p = vec3(k * at.u, p.y, k * at.v);
    out->normal = vec3(n.u, 0, n.v);
    if (profile->conic)
        out->normal = vec_scale(vec3(n.u, -(n.u * at.u + n.v * at.v), n.v), k < 0 ? -1 : 1);
}

static void uv(const Surface *surface, ShapeUv *out)
{
    const Shape *shape = &surface->primitive->shape;
    const Profile *profile = profile_of(shape);
    Vec3 p = shape_local_point(surface);
    double k = scale_at(shape, p.y);
    Vec2 at = {k != 0 ? p.x / k : 0, k != 0 ? p.z / k : 0};
    int i = surface->face - 2;

    if (i < 0)
        out->natural = (Vec2){(at.u - profile->low.u) / (profile->high.u - profile->low.u),
                              (at.v - profile->low.v) / (profile->high.v - profile->low.v)};
    else
        out->natural = (Vec2){(i + profile_nearest(profile, &profile->segments[i], at)) / profile->count,
                              (p.y - shape->r0) / (shape->r1 - shape->r0)};
}

/* As if it had its caps. */
static int inside(const Shape *shape, Vec3 p)
{
    double k = scale_at(shape, p.y);

    return p.y >= shape->r0 && p.y <= shape->r1 && k != 0 &&
           profile_contains(profile_of(shape), (Vec2){p.x / k, p.z / k});
}

const ShapeOps shape_prism = {
    .name = "prism",
    SHAPE_BOUNDED,
};
