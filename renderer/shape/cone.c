/* The cone about z, from z = 0 with radius r0 to z = 1 with radius r1; `open` has no caps. Cylinders too. Faces: 0 the
 * side, 1 the cap at z = 0, 2 the cap at z = 1. Natural parametrisation: of the side u is the angle from x towards y, v
 * the height from the base; of caps x and y, the unit square round the cap's circle. */
#include <float.h>
#include "shape/shape.h"

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    const Transform *t = &primitive->transform;

    shape_bound_circle(low, high, t, vec3(0, 0, 0), 0, 1, primitive->shape.r0, 0);
    shape_bound_circle(low, high, t, vec3(0, 0, 1), 0, 1, primitive->shape.r1, 0);
}

/* The roots of a t^2 + 2 b t + c, ascending; without cancellation. on_surface: c is 0 but for rounding, and the root
 * there is left out. Returns how many. */
static int quadratic(double a, double b, double c, int on_surface, double roots[2])
{
    double discriminant, q, r0, r1;

    if (on_surface) {
        roots[0] = -2 * b / a;
        return a != 0;
    }
    discriminant = b * b - a * c;
    if (!(discriminant >= 0))
        return 0;
    q = -(b + copysign(sqrt(discriminant), b));
    if (q == 0 && a == 0)
        return 0;
    if (a == 0) {
        roots[0] = c / q;
        return 1;
    }
    r0 = q / a;
    r1 = q != 0 ? c / q : r0;
    roots[0] = fmin(r0, r1);
    roots[1] = fmax(r0, r1);
    return 2;
}

/* The side: rho^2 = (r0 + slope z)^2 for z in 0..1. */
static int intersect_side(const Primitive *primitive, const ShapeRay *ray, double *t)
{
    double r0 = primitive->shape.r0, r1 = primitive->shape.r1, slope = r1 - r0, big = 1 + fmax(r0, r1);
    Vec3 o = ray->origin, d = ray->direction;
    double shift = 0, radius, a, b, c, roots[2];
    int on_surface = 0, count;

    /* Far rays are moved near first: squares of large coordinates would swamp the radius. */
    if (vec_dot(o, o) > 100 * big * big) {
        shift = -vec_dot(o, d) / vec_dot(d, d);
        o = vec_mad(o, d, shift);
    }
    radius = r0 + slope * o.z;
    a = d.x * d.x + d.y * d.y - slope * slope * d.z * d.z;
    b = o.x * d.x + o.y * d.y - slope * radius * d.z;
    c = o.x * o.x + o.y * o.y - radius * radius;
    if (shift == 0)
        on_surface = fabs(c) <= ray->slack * (o.x * o.x + o.y * o.y + 2 * big * fabs(radius) + DBL_EPSILON);
    count = quadratic(a, b, c, on_surface, roots);
    for (int i = 0; i < count; i++) {
        double z = o.z + roots[i] * d.z;
        if (z >= 0 && z <= 1 && shape_accept(ray, roots[i] + shift, t))
            return 1;
    }
    return 0;
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    ShapeRay rest = *ray;
    int found = 0;

    if (intersect_side(primitive, &rest, t)) {
        found = 1;
        *face = 0;
        rest.tmax = *t;
    }
    for (int cap = 0; cap < 2 && !primitive->shape.open; cap++)
        if (shape_intersect_ring(&rest, cap, cap ? primitive->shape.r1 : primitive->shape.r0, 0, t)) {
            found = 1;
            *face = 1 + cap;
            rest.tmax = *t;
        }
    return found;
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    double slope = primitive->shape.r1 - primitive->shape.r0, rho = hypot(p.x, p.y), radius;

    if (face) {
        out->p = vec3(p.x, p.y, face - 1);
        out->normal = vec3(0, 0, face == 1 ? -1 : 1);
        return;
    }
    p.z = fmin(fmax(p.z, 0), 1);
    radius = primitive->shape.r0 + slope * p.z;
    if (rho > 0) {
        out->p = vec3(p.x * radius / rho, p.y * radius / rho, p.z);
        out->normal = vec3(p.x / rho, p.y / rho, -slope);
    } else {
        /* The tip: no side to lean to, so straight up or down. */
        out->p = p;
        out->normal = vec3(0, 0, slope < 0 ? 1 : -1);
    }
}

static void uv(const Surface *surface, ShapeUv *out)
{
    const Shape *shape = &surface->primitive->shape;
    Vec3 p = shape_local_point(surface);

    if (surface->face)
        out->natural = shape_circle_uv(p, surface->face == 1 ? shape->r0 : shape->r1);
    else
        out->natural = (Vec2){shape_turn(p.x, p.y), fmin(fmax(p.z, 0), 1)};
}

static void extent(const Primitive *primitive, int face, const Vec3 axes[3], ShapeExtent *out)
{
    const double r0 = primitive->shape.r0, r1 = primitive->shape.r1, radius = face == 1 ? r0 : r1;

    out->is_flat = face > 0;
    out->u = vec3(2 * radius, 0, 0);
    out->v = vec3(0, 2 * radius, 0);
    out->lengths[0] = shape_circumference((r0 + r1) / 2, axes[0], axes[1]);
    out->lengths[1] = hypot(vec_length(axes[2]), shape_circumference(r1 - r0, axes[0], axes[1]) / (2 * PI));
}

/* As if it had its caps. */
static int inside(const Shape *shape, Vec3 p)
{
    return p.z >= 0 && p.z <= 1 && hypot(p.x, p.y) <= shape->r0 + (shape->r1 - shape->r0) * p.z;
}

/* ---- sampling ---- */

/* World area of d angle d z at angle, for radius 1. */
static double side_stretch(const Primitive *primitive, double c, double s)
{
    double slope = primitive->shape.r1 - primitive->shape.r0;

    return shape_stretch(&primitive->transform, vec3(-s, c, 0), vec3(slope * c, slope * s, 1));
}

/* The same all round: a circle about an axis that stands on it, of any height. */
static int is_round(const Transform *t)
{
    Vec3 x = shape_axis(t, 0), y = shape_axis(t, 1), z = shape_axis(t, 2);
    double xx = vec_dot(x, x), bound = 1e-12 * xx, upright = 1e-12 * sqrt(xx * vec_dot(z, z));

    return fabs(vec_dot(x, y)) <= bound && fabs(vec_dot(y, y) - xx) <= bound && fabs(vec_dot(x, z)) <= upright &&
           fabs(vec_dot(y, z)) <= upright;
}

/* Areas of the faces; returns their sum. */
static double face_areas(const Primitive *primitive, double areas[3])
{
    double r0 = primitive->shape.r0, r1 = primitive->shape.r1, cap, sum = 0;
    int turns = is_round(&primitive->transform) ? 1 : 64;

    for (int i = 0; i < turns; i++)
        sum += side_stretch(primitive, cos(2 * PI * i / turns), sin(2 * PI * i / turns));
    areas[0] = PI * (r0 + r1) * sum / turns;
    cap = primitive->shape.open ? 0 : PI * shape_stretch(&primitive->transform, vec3(1, 0, 0), vec3(0, 1, 0));
    areas[1] = cap * r0 * r0;
    areas[2] = cap * r1 * r1;
    return areas[0] + areas[1] + areas[2];
}

static double area(const Primitive *primitive)
{
    double areas[3];

    return face_areas(primitive, areas);
}

static double density(const Primitive *primitive, Vec3 p, int face)
{
    double areas[3], total = face_areas(primitive, areas), rho = hypot(p.x, p.y), here;

    if (face || rho == 0)
        return 1 / total;
    /* The side is chosen by its area, then a ring by its radius, then the angle uniformly. */
    here = side_stretch(primitive, p.x / rho, p.y / rho) * PI * (primitive->shape.r0 + primitive->shape.r1);
    return here > 0 ? areas[0] / (total * here) : 0;
}

static double sample(const Primitive *primitive, double u1, double u2, int *face, ShapePoint *out)
{
    double r0 = primitive->shape.r0, r1 = primitive->shape.r1, areas[3], radius;
    double pick = u1 * face_areas(primitive, areas), angle = 2 * PI * u2;
    Vec3 p;

    *face = 0;
    while (*face < 2 && pick >= areas[*face])
        pick -= areas[(*face)++];
    u1 = areas[*face] > 0 ? fmin(pick / areas[*face], 1) : 0;
    if (*face) {
        radius = (*face == 1 ? r0 : r1) * sqrt(u1);
        p = vec3(radius * cos(angle), radius * sin(angle), *face - 1);
    } else {
        radius = sqrt(r0 * r0 + u1 * (r1 * r1 - r0 * r0));
        p = vec3(radius * cos(angle), radius * sin(angle), radius + r0 > 0 ? u1 * (r0 + r1) / (radius + r0) : u1);
    }
    point(primitive, p, *face, out);
    return density(primitive, out->p, *face);
}

const ShapeOps shape_cone = {
    .name = "cone",
    .properties = SHAPE_U_PERIODIC,
    SHAPE_BOUNDED,
    .extent = extent,
    SHAPE_SAMPLED,
};
