/* Surfaces where a polynomial in x, y and z is 0: POV-Ray's quadric, cubic, quartic, poly and polynomial. Inside it is
 * negative. They have no bounds and no natural parametrisation, and cannot be sampled. */
#include <float.h>
#include <stdlib.h>
#include "base/polynomial.h"
#include "shape/poly.h"
#include "shape/shape.h"

enum { MOST = POLYNOMIAL_DEGREE + 2 }; /* coefficients, and one to carry to */

static void add_polynomial(double *sum, int *degree, const double *c, int more)
{
    while (*degree < more)
        sum[++*degree] = 0;
    for (int i = 0; i <= more; i++)
        sum[i] += c[i];
}

static inline void add_constant(double *sum, int *degree, double c)
{
    if (*degree >= 0)
        sum[0] += c;
    else if (c != 0)
        sum[ *degree = 0] = c;
}

/* Of degree 2, written out: quadrics are the most. */
static int quadric_along_line(const double *c, Vec3 o, Vec3 d, double *out)
{
    out[0] = ((c[0] * o.x + c[1] * o.y + c[2] * o.z + c[3]) * o.x) + (c[4] * o.y + c[5] * o.z + c[6]) * o.y +
             (c[7] * o.z + c[8]) * o.z + c[9];
    out[1] = (2 * c[0] * o.x + c[1] * o.y + c[2] * o.z + c[3]) * d.x +
             (c[1] * o.x + 2 * c[4] * o.y + c[5] * o.z + c[6]) * d.y +
             (c[2] * o.x + c[5] * o.y + 2 * c[7] * o.z + c[8]) * d.z;
    out[2] = (c[0] * d.x + c[1] * d.y + c[2] * d.z) * d.x + (c[4] * d.y + c[5] * d.z) * d.y + c[7] * d.z * d.z;
    return 2;
}

/* The polynomial along o + s d, in s: Horner's rule with x, y and z linear in s; most terms of most scenes are 0.
 * Returns its degree. */
static int along_line(const Poly *poly, Vec3 o, Vec3 d, double *out)
{
    const double *c = poly->c;
    double of_y[MOST], of_z[MOST];
    int nx = -1, ny, nz;

    if (poly->degree == 2)
        return quadric_along_line(c, o, d, out);
    for (int i = poly->degree; i >= 0; i--) {
        ny = -1;
        for (int j = poly->degree - i; j >= 0; j--) {
            nz = -1;
            for (int k = poly->degree - i - j; k >= 0; k--) {
                nz = polynomial_times_linear(of_z, nz, o.z, d.z);
                add_constant(of_z, &nz, *c++);
            }
            ny = polynomial_times_linear(of_y, ny, o.y, d.y);
            add_polynomial(of_y, &ny, of_z, nz);
        }
        nx = polynomial_times_linear(out, nx, o.x, d.x);
        add_polynomial(out, &nx, of_y, ny);
    }
    if (nx < 0)
        out[nx = 0] = 0;
    return nx;
}

/* The value at p, its gradient, and the sum of the terms' magnitudes, which rounding is a share of. */
static double evaluate(const Poly *poly, Vec3 p, Vec3 *gradient, double *magnitude)
{
    const double *c = poly->c;
    double f = 0, m = 0;
    Vec3 g = {0, 0, 0};

    for (int i = poly->degree; i >= 0; i--) {
        double fy = 0, gy = 0, gyz = 0, my = 0;
        for (int j = poly->degree - i; j >= 0; j--) {
            double fz = 0, gz = 0, mz = 0;
            for (int k = poly->degree - i - j; k >= 0; k--) {
                gz = gz * p.z + fz;
                fz = fz * p.z + *c;
                mz = mz * fabs(p.z) + fabs(*c++);
            }
            gy = gy * p.y + fy;
            gyz = gyz * p.y + gz;
            fy = fy * p.y + fz;
            my = my * fabs(p.y) + mz;
        }
        g = vec3(g.x * p.x + f, g.y * p.x + gy, g.z * p.x + gyz);
        f = f * p.x + fy;
        m = m * fabs(p.x) + my;
    }
    *gradient = g;
    *magnitude = m;
    return f;
}

/* Whether the ray begins on the surface, but for rounding. */
static int starts_on(const Poly *poly, const ShapeRay *ray, const double *c, int degree, double start)
{
    double value = polynomial_value(c, degree, start), sum = 0, power = 1, magnitude;
    Vec3 gradient;

    for (int i = 0; i <= degree; i++, power *= fabs(start))
        sum += fabs(c[i]) * power;
    if (fabs(value) > 1e-6 * sum)
        return 0;
    value = evaluate(poly, ray->origin, &gradient, &magnitude);
    return fabs(value) <= ray->slack * vec_length(gradient) + 4 * DBL_EPSILON * (degree + 2) * magnitude;
}

/* The first root in range. Others are not computed: only their pieces, which are the same in every call. */
static int first_root(const double *c, int degree, const ShapeRay *ray, const ShapeLine *line, double *t)
{
    double points[MOST], start = shape_line_start(line, ray);
    int count, before;

    if (degree <= 2) {
        count = polynomial_roots(c, degree, start, INFINITY, points);
        return shape_first_crossing(ray, line, points, count, t) >= 0;
    }
    count = polynomial_pieces(c, degree, start, INFINITY, points);
    before = polynomial_value(c, degree, points[0]) > 0;
    for (int i = 1; i < count && shape_line_t(line, points[i - 1]) < ray->tmax; i++) {
        const int now = polynomial_value(c, degree, points[i]) > 0;
        if (now != before && shape_line_t(line, points[i]) > ray->tmin) {
            double at = shape_line_t(line, polynomial_root_between(c, degree, points[i - 1], points[i], now));
            if (at > ray->tmin)
                return shape_accept(ray, at, t);
        }
        before = now;
    }
    return 0;
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    const Poly *poly = primitive->shape.data;
    ShapeLine line = shape_line(ray, vec3(0, 0, 0));
    double c[MOST];
    int degree = along_line(poly, line.origin, line.direction, c);

    (void)face;
    if (!starts_on(poly, ray, c, degree, -line.shift))
        return first_root(c, degree, ray, &line, t);
    /* One root is where the ray begins: divided by it, the polynomial has the others. */
    line.origin = ray->origin;
    line.shift = 0;
    degree = along_line(poly, line.origin, line.direction, c);
    return first_root(c + 1, degree - 1, ray, &line, t);
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    const Poly *poly = primitive->shape.data;
    double value, magnitude, size;

    (void)face;
    for (int i = 0; i < 3; i++) {
        value = evaluate(poly, p, &out->normal, &magnitude);
        size = vec_dot(out->normal, out->normal);
        /* Where the surface meets itself it has no normal to go along. */
        if (i == 2 || !(size > 0) || value * value > 1e-6 * size * vec_dot(p, p))
            break;
        p = vec_mad(p, out->normal, -value / size);
    }
    out->p = p;
    if (!(size > 0))
        out->normal = vec3(0, 1, 0);
}

static int inside(const Shape *shape, Vec3 p)
{
    double magnitude;
    Vec3 gradient;

    return evaluate(shape->data, p, &gradient, &magnitude) < 0;
}

const ShapeOps shape_poly = {
    .name = "poly",
    .intersect = intersect,
    .point = point,
    .inside = inside,
};
