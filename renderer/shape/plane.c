/* The plane y = 0, inside below it. It has no bounds, no UVs, and cannot be sampled. */
#include "shape/shape.h"

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    (void)primitive, (void)face;
    if (fabs(ray->origin.y) <= ray->slack || ray->direction.y == 0)
        return 0;
    return shape_accept(ray, -ray->origin.y / ray->direction.y, t);
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    (void)primitive, (void)face;
    out->p = vec3(p.x, 0, p.z);
    out->normal = vec3(0, 1, 0);
}

static int inside(const Shape *shape, Vec3 p)
{
    (void)shape;
    return p.y < 0;
}

static void solid_bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    shape_bound_half_space(primitive, 1, low, high);
}

const ShapeOps shape_plane = {
    .name = "plane",
    .properties = SHAPE_FLAT,
    .solid_bounds = solid_bounds,
    .intersect = intersect,
    .point = point,
    .inside = inside,
};
