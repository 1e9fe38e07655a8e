/* Sphere, plane, disc and cone, intersected exactly in their canonical space.
 *
 * A ray that starts on the surface must not meet it at its start. Which root is the start's is decided by the surface's
 * equation there: where its value is within rounding of 0, the root is 0 and dropped. Comparing t with a small number
 * instead fails at grazing angles, where a rounding error of the equation moves the root by far more. */
#include <float.h>
#include "shape/shapes.h"

double turn_of(double x, double y)
{
    double turn = atan2(y, x) / (2 * PI);

    return turn < 0 ? turn + 1 : turn;
}

static int in_range(const ShapeRay *ray, double t)
{
    return t > ray->tmin && t < ray->tmax;
}

/* It is the hit, if it is in range. */
static int accept(const ShapeRay *ray, double candidate, double *t)
{
    if (!in_range(ray, candidate))
        return 0;
    *t = candidate;
    return 1;
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

/* ---- sphere ---- */

int sphere_hit(const ShapeRay *ray, double *t)
{
    Vec3 o = ray->origin, d = ray->direction;
    double dd = vec_dot(d, d), b = vec_dot(o, d), oo = vec_dot(o, o), c = oo - 1, nearest = -b / dd, half;
    Vec3 closest = vec_mad(o, d, nearest);

    if (fabs(c) <= ray->slack * (2 + oo)) {
        return accept(ray, 2 * nearest, t);
    }
    /* From the point of closest approach: exact however far away the ray begins. */
    half = (1 - vec_dot(closest, closest)) / dd;
    if (!(half >= 0))
        return 0;
    half = sqrt(half);
    return accept(ray, nearest - half, t) || accept(ray, nearest + half, t);
}

void sphere_point(Vec3 p, ShapePoint *out)
{
    out->p = out->normal = vec_normalize(p);
}

void sphere_uv(Vec3 p, ShapeUv *out)
{
    double rho = hypot(p.x, p.z);

    out->uv.u = rho > 0 ? turn_of(p.x, p.z) : 0;
    out->uv.v = 0.5 + atan2(p.y, rho) / PI;
    out->natural = out->uv;
    out->has_uv = out->has_natural = 1;
}

/* ---- plane ---- */

int plane_hit(const ShapeRay *ray, double *t)
{
    if (fabs(ray->origin.y) <= ray->slack || ray->direction.y == 0)
        return 0;
    return accept(ray, -ray->origin.y / ray->direction.y, t);
}

void plane_point(Vec3 p, ShapePoint *out)
{
    out->p = vec3(p.x, 0, p.z);
    out->normal = vec3(0, 1, 0);
}

/* ---- disc ---- */

/* A ring in the plane z = height. */
static int ring_hit(const ShapeRay *ray, double height, double outer, double inner, double *t)
{
    double offset = height - ray->origin.z, candidate, x, y, rr;

    if (fabs(offset) <= ray->slack || ray->direction.z == 0)
        return 0;
    candidate = offset / ray->direction.z;
    x = ray->origin.x + candidate * ray->direction.x;
    y = ray->origin.y + candidate * ray->direction.y;
    rr = x * x + y * y;
    /* The rim belongs to both the cap and the side: no crack between them. */
    return rr <= outer * outer * (1 + 4 * DBL_EPSILON) && rr >= inner * inner && accept(ray, candidate, t);
}

int disc_hit(const Primitive *primitive, const ShapeRay *ray, double *t)
{
    return ring_hit(ray, 0, primitive->r0, primitive->r1, t);
}

static Vec2 square_round(Vec3 p, double radius)
{
    return radius > 0 ? (Vec2){0.5 + p.x / (2 * radius), 0.5 + p.y / (2 * radius)} : (Vec2){0.5, 0.5};
}

void disc_point(Vec3 p, ShapePoint *out)
{
    out->p = vec3(p.x, p.y, 0);
    out->normal = vec3(0, 0, 1);
}

void disc_uv(const Primitive *primitive, Vec3 p, ShapeUv *out)
{
    out->natural = square_round(p, primitive->r0);
    out->has_uv = 0;
    out->has_natural = 1;
}

/* ---- cone ---- */

/* The side: rho^2 = (r0 + slope z)^2 for z in 0..1. */
static int side_hit(const Primitive *primitive, const ShapeRay *ray, double *t)
{
    double r0 = primitive->r0, slope = primitive->r1 - r0, big = 1 + fmax(r0, primitive->r1);
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
        if (z >= 0 && z <= 1 && accept(ray, roots[i] + shift, t))
            return 1;
    }
    return 0;
}

int cone_hit(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    ShapeRay rest = *ray;
    int found = 0;

    if (side_hit(primitive, &rest, t)) {
        found = 1;
        *face = 0;
        rest.tmax = *t;
    }
    for (int cap = 0; cap < 2 && !primitive->open; cap++)
        if (ring_hit(&rest, cap, cap ? primitive->r1 : primitive->r0, 0, t)) {
            found = 1;
            *face = 1 + cap;
            rest.tmax = *t;
        }
    return found;
}

void cone_point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    double slope = primitive->r1 - primitive->r0, rho = hypot(p.x, p.y), radius;

    if (face) {
        out->p = vec3(p.x, p.y, face - 1);
        out->normal = vec3(0, 0, face == 1 ? -1 : 1);
        return;
    }
    p.z = fmin(fmax(p.z, 0), 1);
    radius = primitive->r0 + slope * p.z;
    if (rho > 0) {
        out->p = vec3(p.x * radius / rho, p.y * radius / rho, p.z);
        out->normal = vec3(p.x / rho, p.y / rho, -slope);
    } else {
        /* The tip: no side to lean to, so straight up or down. */
        out->p = p;
        out->normal = vec3(0, 0, slope < 0 ? 1 : -1);
    }
}

void cone_uv(const Primitive *primitive, Vec3 p, int face, ShapeUv *out)
{
    out->has_uv = 0;
    out->has_natural = 1;
    if (face)
        out->natural = square_round(p, face == 1 ? primitive->r0 : primitive->r1);
    else
        out->natural = (Vec2){turn_of(p.x, p.y), fmin(fmax(p.z, 0), 1)};
}
