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

/* The polynomial along o + s d, in s: Horner's rule with x, y and z linear in s. Returns its degree. */
static int along_line(const Poly *poly, Vec3 o, Vec3 d, double *out)
{
    const double *c = poly->c;
    double of_y[MOST], of_z[MOST];
    int nx = -1, ny, nz;

    for (int i = poly->degree; i >= 0; i--) {
        ny = -1;
        for (int j = poly->degree - i; j >= 0; j--) {
            of_z[0] = *c++;
            nz = 0;
            for (int k = poly->degree - i - j; k > 0; k--) {
                nz = polynomial_times_linear(of_z, nz, o.z, d.z);
                of_z[0] += *c++;
            }
            ny = polynomial_times_linear(of_y, ny, o.y, d.y);
            add_polynomial(of_y, &ny, of_z, nz);
        }
        nx = polynomial_times_linear(out, nx, o.x, d.x);
        add_polynomial(out, &nx, of_y, ny);
    }
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

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    const Poly *poly = primitive->shape.data;
    ShapeLine line = shape_line(ray, vec3(0, 0, 0));
    double c[MOST], roots[MOST];
    int degree = along_line(poly, line.origin, line.direction, c), count;

    (void)face;
    if (!starts_on(poly, ray, c, degree, -line.shift)) {
        count = polynomial_roots(c, degree, shape_line_start(&line, ray), INFINITY, roots);
    } else {
        /* One root is where the ray begins: divided by it, the polynomial has the others. */
        line.origin = ray->origin;
        line.shift = 0;
        degree = along_line(poly, line.origin, line.direction, c);
        count = polynomial_roots(c + 1, degree - 1, shape_line_start(&line, ray), INFINITY, roots);
    }
    return shape_first_crossing(ray, &line, roots, count, t) >= 0;
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
