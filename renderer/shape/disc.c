/* The disc z = 0, x^2 + y^2 <= r0^2, with a hole of radius r1; inside below it. Natural
 * parametrisation: x and y, the unit square round the outer circle. */
#include <float.h>
#include "shape/shape.h"

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    shape_bound_circle(low, high, &primitive->transform, vec3(0, 0, 0), 0, 1, primitive->shape.r0, 0);
}

int shape_intersect_ring(const ShapeRay *ray, double height, double outer, double inner, double *t)
{
    double offset = height - ray->origin.z, candidate, x, y, rr;

    if (fabs(offset) <= ray->slack || ray->direction.z == 0)
        return 0;
    candidate = offset / ray->direction.z;
    x = ray->origin.x + candidate * ray->direction.x;
    y = ray->origin.y + candidate * ray->direction.y;
    rr = x * x + y * y;
    /* The rim belongs to both the cap and the side: no crack between them. */
    return rr <= outer * outer * (1 + 4 * DBL_EPSILON) && rr >= inner * inner && shape_accept(ray, candidate, t);
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    (void)face;
    return shape_intersect_ring(ray, 0, primitive->shape.r0, primitive->shape.r1, t);
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    (void)primitive, (void)face;
    out->p = vec3(p.x, p.y, 0);
    out->normal = vec3(0, 0, 1);
}

Vec2 shape_circle_uv(Vec3 p, double radius)
{
    return radius > 0 ? (Vec2){0.5 + p.x / (2 * radius), 0.5 + p.y / (2 * radius)} : (Vec2){0.5, 0.5};
}

static void uv(const Surface *surface, ShapeUv *out)
{
    out->natural = shape_circle_uv(shape_local_point(surface), surface->primitive->shape.r0);
}

static void extent(const Primitive *primitive, int face, const Vec3 axes[3], ShapeExtent *out)
{
    (void)face, (void)axes;
    out->is_flat = 1;
    out->u = vec3(2 * primitive->shape.r0, 0, 0);
    out->v = vec3(0, 2 * primitive->shape.r0, 0);
}

static int inside(const Shape *shape, Vec3 p)
{
    (void)shape;
    return p.z < 0;
}

static void solid_bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    shape_bound_half_space(primitive, 2, low, high);
}

/* ---- sampling ---- */

static double area(const Primitive *primitive)
{
    double r0 = primitive->shape.r0, r1 = fmin(primitive->shape.r1, r0);

    return PI * (r0 * r0 - r1 * r1) * shape_stretch(&primitive->transform, vec3(1, 0, 0), vec3(0, 1, 0));
}

static double sample(const Primitive *primitive, double u1, double u2, int *face, ShapePoint *out)
{
    double r0 = primitive->shape.r0, r1 = fmin(primitive->shape.r1, r0), angle = 2 * PI * u2;
    double radius = sqrt(r1 * r1 + u1 * (r0 * r0 - r1 * r1));

    *face = 0;
    point(primitive, vec3(radius * cos(angle), radius * sin(angle), 0), 0, out);
    return shape_even_density(primitive, out->p, 0);
}

const ShapeOps shape_disc = {
    .name = "disc",
    .properties = SHAPE_FLAT,
    SHAPE_BOUNDED,
    .solid_bounds = solid_bounds,
    .extent = extent,
    .area = area,
    .sample = sample,
    .density = shape_even_density,
};
