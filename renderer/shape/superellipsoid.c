/* The superellipsoid in the box from -1 to 1: (|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) = 1, with e in r0 and n in r1.
 * Natural parametrisation: u around z from x towards y, v from the lower pole to the upper, both by the angles of the
 * point itself.
 *
 * As nested p-norms: N = |(|(x, y)|_p, z)|_q with p = 2/e, q = 2/n, and N = 1 on the surface. Norms are convex, with p
 * and q from 1; below 1 the surface is hollow between the axes, and crossings are found by halving intervals, which end
 * where bounds of N tell that there is none. */
#include <float.h>
#include "base/polynomial.h"
#include "shape/shape.h"

/* |(a, b)|_p of a, b >= 0, and its derivatives. */
static double norm(double a, double b, double p, double *da, double *db)
{
    const double most = a > b ? a : b, least = a > b ? b : a;
    double ratio, power, root, dmost, dleast;

    if (!(most > 0)) {
        *da = *db = 0;
        return 0;
    }
    ratio = least / most;
    if (p == 2) {
        root = sqrt(1 + ratio * ratio);
        dmost = 1 / root;
        dleast = ratio / root;
    } else {
        power = pow(ratio, p);
        root = pow(1 + power, 1 / p);
        dmost = root / (1 + power);
        dleast = ratio > 0 ? fmin(dmost * power / ratio, 1e30) : p < 1 ? 1e30 : p == 1 ? dmost : 0;
    }
    *da = a > b ? dmost : dleast;
    *db = a > b ? dleast : dmost;
    return most * root;
}

static double value(const Shape *shape, Vec3 p, Vec3 *gradient)
{
    double dh, dx, dy, dz, h, n;

    h = norm(fabs(p.x), fabs(p.y), 2 / shape->r0, &dx, &dy);
    n = norm(h, fabs(p.z), 2 / shape->r1, &dh, &dz);
    *gradient = vec3(copysign(dh * dx, p.x), copysign(dh * dy, p.y), copysign(dz, p.z));
    return n - 1;
}

static int is_convex(const Shape *shape)
{
    return shape->r0 <= 2 && shape->r1 <= 2;
}

/* ---- bounds: the support of a norm's ball is the dual norm ---- */

static double dual(double a, double b, double p)
{
    double da, db;

    return p <= 1 ? fmax(a, b) : norm(a, b, p / (p - 1), &da, &db);
}

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    const Transform *t = &primitive->transform;
    double extent[3];
    Vec3 centre = vec3(t->m[0][3], t->m[1][3], t->m[2][3]), half;

    for (int k = 0; k < 3; k++) {
        double flat = dual(fabs(t->m[k][0]), fabs(t->m[k][1]), 2 / primitive->shape.r0);
        extent[k] = dual(flat, fabs(t->m[k][2]), 2 / primitive->shape.r1);
    }
    half = vec3(extent[0], extent[1], extent[2]);
    shape_bound_point(low, high, vec_sub(centre, half));
    shape_bound_point(low, high, vec_add(centre, half));
}

/* ---- where it is hollow ---- */

typedef struct Hollow {
    const Shape *shape;
    const ShapeLine *line;
    ShapeCrossings *crossings;
} Hollow;

static Vec3 absolute(Vec3 p)
{
    return vec3(fabs(p.x), fabs(p.y), fabs(p.z));
}

static double on_line(const void *data, double s, double *slope)
{
    const Hollow *hollow = data;
    Vec3 gradient;
    double v = value(hollow->shape, vec_mad(hollow->line->origin, hollow->line->direction, s), &gradient);

    *slope = vec_dot(gradient, hollow->line->direction);
    return v;
}

/* Within a..b no coordinate changes its sign: N is bounded by its values at the least and the largest coordinates. */
static void search(const Hollow *hollow, double a, double b, int depth)
{
    Vec3 p = absolute(vec_mad(hollow->line->origin, hollow->line->direction, a)),
         q = absolute(vec_mad(hollow->line->origin, hollow->line->direction, b)), gradient;
    Vec3 least = vec_min(p, q), most = vec_max(p, q);

    if (value(hollow->shape, least, &gradient) > 0 || value(hollow->shape, most, &gradient) < 0)
        return;
    if (depth > 0) {
        search(hollow, a, 0.5 * (a + b), depth - 1);
        search(hollow, 0.5 * (a + b), b, depth - 1);
        return;
    }
    const double ends[2] = {a, b};
    double root;
    if (roots_between_points(on_line, hollow, ends, 2, &root))
        shape_add_crossing(hollow->crossings, shape_line_t(hollow->line, root), 0);
}

static void hollow_crossings(const Hollow *hollow, double low, double high)
{
    const double o[3] = {hollow->line->origin.x, hollow->line->origin.y, hollow->line->origin.z},
                 d[3] = {hollow->line->direction.x, hollow->line->direction.y, hollow->line->direction.z};
    double ends[5] = {low};
    int count = 1;

    for (int k = 0; k < 3; k++) {
        double s = d[k] != 0 ? -o[k] / d[k] : low;
        int i = count;
        if (!(s > low && s < high))
            continue;
        for (; ends[i - 1] > s; i--)
            ends[i] = ends[i - 1];
        ends[i] = s;
        count++;
    }
    ends[count] = high;
    for (int i = 0; i < count; i++)
        search(hollow, ends[i], ends[i + 1], 18);
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    const Vec3 corner = vec3(1.001, 1.001, 1.001);
    ShapeLine line = shape_line(ray, vec3(0, 0, 0));
    ShapeCrossings crossings = shape_crossings(ray);
    double low = -INFINITY, high = INFINITY;

    if (!shape_line_clip(&line, vec_neg(corner), corner, &low, &high))
        return 0;
    if (shape_line_t(&line, high) <= ray->tmin || shape_line_t(&line, low) >= ray->tmax)
        return 0;
    if (!is_convex(&primitive->shape))
        hollow_crossings(&(Hollow){&primitive->shape, &line, &crossings}, low, high);
    else if (!shape_add_convex(&crossings, &primitive->shape, value, &line, low, high))
        return 0;
    return shape_crossings_end(&crossings, primitive, 1, t, face);
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    double size = value(&primitive->shape, p, &out->normal) + 1;

    (void)face;
    out->p = size > 0 ? vec_scale(p, 1 / size) : vec3(0, 0, 1);
    if (!(size > 0))
        out->normal = out->p;
}

static void uv(const Surface *surface, ShapeUv *out)
{
    Vec3 p = shape_local_point(surface);

    out->natural = shape_angles(vec3(p.x, p.z, p.y));
}

static int inside(const Shape *shape, Vec3 p)
{
    Vec3 gradient;

    return value(shape, p, &gradient) < 0;
}

const ShapeOps shape_superellipsoid = {
    .name = "superellipsoid",
    .properties = SHAPE_U_PERIODIC,
    SHAPE_BOUNDED,
};
