/* The egg about y: a sphere of radius r0 about the origin, one of radius r1 about y = r0, and between them an arc that
 * continues both without a bend. Natural parametrisation: u around y from x towards z, v from the lowest point to
 * the highest, by the angle of the point seen from the middle.
 *
 * The distance from it is that from one of the spheres or from the arc's circle, by the side of the two lines from the
 * arc's centre through the spheres' centres. It is convex. */
#include <float.h>
#include "shape/shape.h"

/* In the half plane of rho and y: the centre of the arc at (-ring, height), beyond the axis, and its radius. */
typedef struct Arc {
    double ring, height, radius;
} Arc;

static Arc arc_of(const Shape *shape)
{
    const double r0 = shape->r0, r1 = shape->r1, radius = 2 * fmax(r0, r1), a = radius - r0, b = radius - r1;
    const double height = (a * a - b * b + r0 * r0) / (2 * r0);

    return (Arc){sqrt(fmax(0, a * a - height * height)), height, radius};
}

/* -1: (rho, y) belongs to the lower sphere, 1: to the upper one, 0: to the arc. Also of directions. */
static int part(const Shape *shape, const Arc *arc, double rho, double y, double from_upper)
{
    if (arc->ring * y + arc->height * rho < 0)
        return -1;
    return arc->ring * from_upper - (shape->r0 - arc->height) * rho > 0;
}

static double distance(const Shape *shape, Vec3 p, Vec3 *gradient)
{
    const Arc arc = arc_of(shape);
    const double rho = hypot(p.x, p.z);
    const int of = part(shape, &arc, rho, p.y, p.y - shape->r0);
    const double x = of ? rho : rho + arc.ring,
                 y = p.y - (of < 0   ? 0
                            : of > 0 ? shape->r0
                                     : arc.height),
                 size = hypot(x, y),
                 radius = of < 0   ? shape->r0
                          : of > 0 ? shape->r1
                                   : arc.radius,
                 outward = size > 0 ? x / size : 0;

    *gradient = rho > 0 ? vec3(outward * p.x / rho, 0, outward * p.z / rho) : vec3(outward, 0, 0);
    gradient->y = size > 0 ? y / size : 1;
    return size - radius;
}

/* How far it reaches along a row of the transform. */
static double support(const Shape *shape, const Arc *arc, const double row[4])
{
    const double across = hypot(row[0], row[2]), along = row[1], size = hypot(across, along);
    const int of = part(shape, arc, across, along, along);

    if (of)
        return (of < 0 ? 0 : along * shape->r0) + size * (of < 0 ? shape->r0 : shape->r1);
    return along * arc->height - across * arc->ring + size * arc->radius;
}

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    const Arc arc = arc_of(&primitive->shape);
    double ends[2][3];

    for (int k = 0; k < 3; k++) {
        const double *row = primitive->transform.m[k], opposite[4] = {-row[0], -row[1], -row[2], 0};
        ends[0][k] = row[3] - support(&primitive->shape, &arc, opposite);
        ends[1][k] = row[3] + support(&primitive->shape, &arc, row);
    }
    for (int i = 0; i < 2; i++)
        shape_bound_point(low, high, vec3(ends[i][0], ends[i][1], ends[i][2]));
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    const Shape *shape = &primitive->shape;
    const Arc arc = arc_of(shape);
    const double size = shape->r0 + shape->r1, wide = 1.01 * fmax(arc.radius - arc.ring, fmax(shape->r0, shape->r1));
    ShapeLine line = shape_line(ray, vec3(0, shape->r1 / 2, 0));
    ShapeCrossings crossings = shape_crossings(ray);
    double low = -INFINITY, high = INFINITY;

    if (!shape_line_clip(&line, vec3(-wide, -1.01 * shape->r0, -wide), vec3(wide, 1.01 * size, wide), &low, &high))
        return 0;
    return shape_add_convex(&crossings, shape, distance, &line, low, high) &&
           shape_crossings_end(&crossings, primitive, size, t, face);
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    double far = distance(&primitive->shape, p, &out->normal);

    (void)face;
    out->p = vec_mad(p, out->normal, -far);
}

static void uv(const Surface *surface, ShapeUv *out)
{
    Vec3 p = shape_local_point(surface);

    p.y -= surface->primitive->shape.r1 / 2;
    out->uv = out->natural = shape_angles(p);
    out->has_uv = 1;
}

static int inside(const Shape *shape, Vec3 p)
{
    Vec3 gradient;

    return distance(shape, p, &gradient) < 0;
}

const ShapeOps shape_ovus = {
    .name = "ovus",
    .properties = SHAPE_U_PERIODIC,
    SHAPE_BOUNDED,
};
