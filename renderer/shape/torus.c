/* The torus about y: major radius r0, minor r1. Natural parametrisation: POV-Ray's uv, u around y from -x towards +z, v
 * around the tube from the inner equator (0) over the bottom, the outer equator (.5) and the top (.75).
 *
 * Its quartic is solved by monotonic pieces: between two neighbouring critical points there is at
 * most one root, and a sign change finds it for certain. So no root is lost or made up but for grazing pairs closer
 * than rounding, and there is nothing to tune. */
#include <float.h>
#include "shape/shape.h"

/* s^4 + c2 s^2 + c1 s + c0: measured from the point of closest approach to the centre there is no cubic term. */
typedef struct Quartic {
    double c2, c1, c0;
} Quartic;

static double value(const Quartic *q, double s)
{
    return ((s * s + q->c2) * s + q->c1) * s + q->c0;
}
static double slope(const Quartic *q, double s)
{
    return (4 * s * s + 2 * q->c2) * s + q->c1;
}
static double curvature(const Quartic *q, double s)
{
    return 12 * s * s + 2 * q->c2;
}

typedef double Function(const Quartic *q, double s);

/* The root between low and high, where f has opposite signs: Newton's steps, halving where they leave the bracket. */
static double bracketed(Function *f, Function *derivative, const Quartic *q, double low, double high, int rising)
{
    double s = 0.5 * (low + high);

    for (int i = 0; i < 100; i++) {
        double v = f(q, s), d = derivative(q, s), next;
        if ((v > 0) == rising)
            high = s;
        else
            low = s;
        next = d != 0 ? s - v / d : low;
        if (!(next > low && next < high))
            next = 0.5 * (low + high);
        if (fabs(next - s) <= 4 * DBL_EPSILON * fabs(s) || next == s)
            return next;
        s = next;
    }
    return s;
}

/* Ascending critical points of the quartic within low..high. */
static int critical_points(const Quartic *q, double low, double high, double out[3])
{
    double ends[4] = {low, high}, bend;
    int pieces = 1, count = 0;

    if (q->c2 < 0) {
        bend = sqrt(-q->c2 / 6);
        pieces = 0;
        ends[0] = low;
        if (-bend > low && -bend < high)
            ends[++pieces] = -bend;
        if (bend > low && bend < high)
            ends[++pieces] = bend;
        ends[++pieces] = high;
    }
    for (int i = 0; i < pieces; i++) {
        double a = slope(q, ends[i]), b = slope(q, ends[i + 1]);
        if ((a > 0) != (b > 0))
            out[count++] = bracketed(slope, curvature, q, ends[i], ends[i + 1], b > 0);
    }
    return count;
}

/* Distance-like equation of the tube: better conditioned than the quartic, used for the last digits. */
static double polish(double major, double minor, Vec3 o, Vec3 d, double s)
{
    Vec3 p = vec_mad(o, d, s);
    double rho = hypot(p.x, p.z), pull = (p.x * d.x + p.z * d.z) / (rho > 0 ? rho : 1);
    double rest = p.y * p.y - minor * minor, outer = (rho - major) * (rho - major) + rest;
    double inner = (rho + major) * (rho + major) + rest, f, derivative, step;

    /* The second factor is the inner skin of a torus that overlaps itself. */
    if (fabs(inner) < fabs(outer)) {
        f = inner;
        derivative = 2 * ((rho + major) * pull + p.y * d.y);
    } else {
        f = outer;
        derivative = 2 * ((rho - major) * pull + p.y * d.y);
    }
    step = derivative != 0 ? f / derivative : 0;
    return fabs(step) < 1e-6 * (major + minor) ? s - step : s;
}

/* The part of the ray in the slab |y| <= minor within the sphere about all; 0 where there is none. */
static int clip(double major, double minor, Vec3 o, Vec3 d, double *low, double *high)
{
    double reach = (major + minor) * (major + minor) - vec_dot(o, o);

    if (!(reach > 0))
        return 0;
    reach = sqrt(reach) * (1 + 1e-9);
    *low = fmax(*low, -reach);
    *high = fmin(*high, reach);
    if (d.y != 0) {
        double middle = -o.y / d.y, half = fabs(minor / d.y) * (1 + 1e-9);
        *low = fmax(*low, middle - half);
        *high = fmin(*high, middle + half);
    } else if (fabs(o.y) > minor) {
        return 0;
    }
    return *low < *high;
}

/* Where the ray begins (at tmin) on the circle about the ring's point at that distance from the axis: 0 elsewhere, 1
 * leaving it, -1 entering it. */
static int circle_side(double ring, double minor, const ShapeRay *ray)
{
    Vec3 o = vec_mad(ray->origin, ray->direction, ray->tmin), d = ray->direction;
    double rho = hypot(o.x, o.z), f = (rho - ring) * (rho - ring) + o.y * o.y - minor * minor;
    /* Of the origin, of the way from there, and of the equation's own terms. */
    double slack = ray->slack + 8 * DBL_EPSILON * (ray->tmin * vec_length(d) + fabs(ring) + minor);

    if (!(fabs(f) <= 4 * slack * (fabs(rho - ring) + fabs(o.y) + minor)))
        return 0;
    return (rho - ring) * (rho > 0 ? (o.x * d.x + o.z * d.z) / rho : 0) + o.y * d.y >= 0 ? 1 : -1;
}

/* Where the ray begins (at tmin) on the surface, rounding must not decide the sign of the equation there: the direction
 * does. Returns 0 where it begins elsewhere, else the sign. */
static int start_side(double major, double minor, const ShapeRay *ray)
{
    int side = circle_side(major, minor, ray);

    /* The inner skin of a torus that overlaps itself: the equation is positive within it. */
    return side == 0 && minor > major ? -circle_side(-major, minor, ray) : side;
}

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    shape_bound_circle(low, high, &primitive->transform, vec3(0, 0, 0), 0, 2, primitive->shape.r0,
                       fabs(primitive->shape.r1));
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    double major = primitive->shape.r0, minor = fabs(primitive->shape.r1), length = vec_length(ray->direction), shift,
           low, high;
    Vec3 d = vec_scale(ray->direction, 1 / length), o;
    double begin, k, ends[5], previous;
    int count, start;
    Quartic q;

    (void)face;
    shift = -vec_dot(ray->origin, d);
    o = vec_mad(ray->origin, d, shift);
    begin = low = ray->tmin * length - shift;
    high = ray->tmax * length - shift;
    if (!clip(major, minor, o, d, &low, &high))
        return 0;
    k = vec_dot(o, o) + major * major - minor * minor;
    q.c2 = 2 * k - 4 * major * major * (d.x * d.x + d.z * d.z);
    q.c1 = -8 * major * major * (o.x * d.x + o.z * d.z);
    q.c0 = k * k - 4 * major * major * (o.x * o.x + o.z * o.z);
    count = critical_points(&q, low, high, ends + 1);
    ends[0] = low;
    ends[++count] = high;
    /* The start counts only where the search begins at it. */
    start = low == begin ? start_side(major, minor, ray) : 0;
    previous = start ? start : value(&q, low);
    for (int i = 1; i <= count; i++) {
        double next = value(&q, ends[i]);
        if ((previous > 0) != (next > 0)) {
            double s = bracketed(value, slope, &q, ends[i - 1], ends[i], next > 0);
            s = polish(major, minor, o, d, s);
            double found = (s + shift) / length;
            if (found > ray->tmin && found < ray->tmax) {
                *t = found;
                return 1;
            }
        }
        previous = next;
    }
    return 0;
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    double major = primitive->shape.r0, minor = fabs(primitive->shape.r1), rho = hypot(p.x, p.z), pull;
    Vec3 ring = rho > 0 ? vec3(p.x * major / rho, 0, p.z * major / rho) : vec3(major, 0, 0), arm = vec_sub(p, ring);

    (void)face;
    /* The inner skin of a torus that overlaps itself belongs to the far side of the ring. */
    if (minor > major && fabs(vec_length(arm) - minor) > 1e-6 * minor) {
        ring = vec_neg(ring);
        arm = vec_sub(p, ring);
    }
    pull = vec_length(arm);
    out->p = pull > 0 ? vec_mad(ring, arm, minor / pull) : p;
    out->normal = pull > 0 ? arm : vec3(0, 1, 0);
}

static void uv(const Surface *surface, ShapeUv *out)
{
    Vec3 p = shape_local_point(surface);
    double rho = hypot(p.x, p.z);

    /* POV-Ray counts from -x (measured); its torus image_map counts from x. */
    out->uv.u = rho > 0 ? shape_turn(-p.x, p.z) : 0;
    out->uv.v = 0.5 + atan2(p.y, rho - surface->primitive->shape.r0) / (2 * PI);
    out->natural = out->uv;
    out->has_uv = 1;
}

static void extent(const Primitive *primitive, int face, const Vec3 axes[3], ShapeExtent *out)
{
    const double r0 = primitive->shape.r0, r1 = fabs(primitive->shape.r1);

    (void)face;
    out->lengths[0] = shape_circumference(r0, axes[0], axes[2]);
    out->lengths[1] = (shape_circumference(r1, axes[0], axes[1]) + shape_circumference(r1, axes[2], axes[1])) / 2;
}

static int inside(const Shape *shape, Vec3 p)
{
    return hypot(hypot(p.x, p.z) - shape->r0, p.y) <= fabs(shape->r1);
}

/* ---- sampling ---- */

/* A point by its angles around the axis and around the tube, and the world area of a unit of both there. */
static double at_angles(const Primitive *primitive, double around, double tube, Vec3 *p)
{
    double r = fabs(primitive->shape.r1), ring = primitive->shape.r0 + r * cos(tube);
    Vec3 e = vec3(-ring * sin(around), 0, ring * cos(around));
    Vec3 f = vec3(-r * sin(tube) * cos(around), r * cos(tube), -r * sin(tube) * sin(around));

    *p = vec3(ring * cos(around), r * sin(tube), ring * sin(around));
    return shape_stretch(&primitive->transform, e, f);
}

/* 0 where the tube is wider than the ring and meets itself. */
static double area(const Primitive *primitive)
{
    double r0 = primitive->shape.r0, r1 = fabs(primitive->shape.r1), sum = 0;
    double scale = shape_similarity(&primitive->transform);
    const int turns = 64;
    Vec3 p;

    if (r1 > r0)
        return 0;
    if (scale > 0)
        return 4 * PI * PI * r0 * r1 * scale * scale;
    for (int i = 0; i < turns * turns; i++)
        sum += at_angles(primitive, 2 * PI * (i % turns) / turns, 2 * PI * (i / turns) / turns, &p);
    return 4 * PI * PI * sum / (turns * turns);
}

/* Both angles are chosen uniformly. */
static double density(const Primitive *primitive, Vec3 p, int face)
{
    double tube = atan2(p.y, hypot(p.x, p.z) - primitive->shape.r0), whole;

    (void)face;
    if (fabs(primitive->shape.r1) > primitive->shape.r0)
        return 0;
    whole = 4 * PI * PI * at_angles(primitive, atan2(p.z, p.x), tube, &p);
    return shape_inverse(whole);
}

static double sample(const Primitive *primitive, double u1, double u2, int *face, ShapePoint *out)
{
    Vec3 p;

    *face = 0;
    at_angles(primitive, 2 * PI * u2, 2 * PI * u1, &p);
    point(primitive, p, 0, out);
    return density(primitive, out->p, 0);
}

const ShapeOps shape_torus = {
    .name = "torus",
    .properties = SHAPE_U_PERIODIC | SHAPE_V_PERIODIC | SHAPE_UV_NATURAL,
    SHAPE_BOUNDED,
    .extent = extent,
    SHAPE_SAMPLED,
};
