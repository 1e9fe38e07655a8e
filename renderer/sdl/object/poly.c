/* Parsers of surfaces of polynomials: quadric, cubic, quartic, poly, polynomial. An ellipsoid becomes a sphere under a
 * transform, which has bounds. */
#include "base/polynomial.h"
#include "sdl/object/shape.h"
#include "shape/poly.h"

static Poly *new_poly(Sdl *sdl, Object *object, int degree)
{
    Poly *poly = sdl_alloc(sdl, sizeof *poly + (size_t)poly_terms(degree) * sizeof *poly->c);
    poly->degree = degree;
    object->shape.ops = &shape_poly;
    object->shape.data = poly;
    return poly;
}

/* The place of x^i y^j z^k in the order of coefficients. */
static int place_of(int degree, int i, int j, int k)
{
    const int rest = degree - i, left = rest - j;
    return poly_terms(rest) - (rest + 1) * (rest + 2) / 2 + left * (left + 1) / 2 + left - k;
}

static double *term(Poly *poly, int i, int j, int k)
{
    return &poly->c[place_of(poly->degree, i, j, k)];
}

/* a is symmetric: lower becomes triangular, and lower times its transpose is a. 0 where a is not positive definite, or
 * too nearly not. */
static int cholesky(const double a[3][3], double lower[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j <= i; j++) {
            double sum = a[i][j];
            for (int k = 0; k < j; k++)
                sum -= lower[i][k] * lower[j][k];
            if (i == j && !(sum > 1e-10 * a[i][i]))
                return 0;
            lower[i][j] = i == j ? sqrt(sum) : sum / lower[j][j];
        }
    return 1;
}

/* p' A p + b p + c, with A = lower lower', is |lower' (p - m)|^2 - r^2: the unit sphere, moved. */
static int ellipsoid(Object *object, const double lower[3][3], const double b[3], double c)
{
    const double(*l)[3] = lower;
    double y[3], m[3], inverse[3][3] = {{0}}, radius2 = -c, radius;
    for (int i = 0; i < 3; i++) {
        y[i] = -b[i] / 2;
        for (int k = 0; k < i; k++)
            y[i] -= l[i][k] * y[k];
        y[i] /= l[i][i];
        radius2 += y[i] * y[i];
    }
    if (!(radius2 > 0))
        return 0;
    radius = sqrt(radius2);
    for (int i = 2; i >= 0; i--) {
        m[i] = y[i];
        for (int k = i + 1; k < 3; k++)
            m[i] -= l[k][i] * m[k];
        m[i] /= l[i][i];
        for (int column = 0; column < 3; column++) {
            double sum = i == column ? radius : 0;
            for (int k = i + 1; k < 3; k++)
                sum -= l[k][i] * inverse[k][column];
            inverse[i][column] = sum / l[i][i];
        }
    }
    return transform_from_axes(
        vec3(inverse[0][0], inverse[1][0], inverse[2][0]), vec3(inverse[0][1], inverse[1][1], inverse[2][1]),
        vec3(inverse[0][2], inverse[1][2], inverse[2][2]), vec3(m[0], m[1], m[2]), &object->transform);
}

/* The surface of degree 2, as a sphere where it is an ellipsoid; sign -1: of the negative polynomial. */
static int try_ellipsoid(Object *object, Poly *poly, double sign)
{
    double a[3][3], b[3], lower[3][3];
    for (int i = 0; i < 3; i++) {
        b[i] = sign * *term(poly, i == 0, i == 1, i == 2);
        for (int j = 0; j < 3; j++)
            a[i][j] =
                sign * *term(poly, (i == 0) + (j == 0), (i == 1) + (j == 1), (i == 2) + (j == 2)) / (i == j ? 1 : 2);
    }
    if (!cholesky(a, lower) || !ellipsoid(object, lower, b, sign * *term(poly, 0, 0, 0)))
        return 0;
    object->shape.ops = &shape_sphere; /* its data stays the polynomial: so uv_mapping is that of one */
    return 1;
}

/* By a power of 2 that makes the largest coefficient about 1: then nothing overflows. */
static void scale(Poly *poly)
{
    double most = 0;
    int exponent;
    for (int i = 0; i < poly_terms(poly->degree); i++)
        most = fmax(most, fabs(poly->c[i]));
    frexp(most, &exponent);
    for (int i = 0; i < poly_terms(poly->degree); i++)
        poly->c[i] = ldexp(poly->c[i], -exponent);
}

static void finish(Object *object, Poly *poly)
{
    scale(poly);
    if (poly->degree != 2 || try_ellipsoid(object, poly, 1))
        return;
    if (try_ellipsoid(object, poly, -1))
        object->flags ^= OBJECT_INVERSE;
}

void parse_quadric(Sdl *sdl, Object *object)
{
    Poly *poly = new_poly(sdl, object, 2);
    Vec3 v = sdl_vector(sdl);
    *term(poly, 2, 0, 0) = v.x, *term(poly, 0, 2, 0) = v.y, *term(poly, 0, 0, 2) = v.z;
    sdl_optional_comma(sdl);
    v = sdl_vector(sdl);
    *term(poly, 1, 1, 0) = v.x, *term(poly, 1, 0, 1) = v.y, *term(poly, 0, 1, 1) = v.z;
    sdl_optional_comma(sdl);
    v = sdl_vector(sdl);
    *term(poly, 1, 0, 0) = v.x, *term(poly, 0, 1, 0) = v.y, *term(poly, 0, 0, 1) = v.z;
    sdl_optional_comma(sdl);
    *term(poly, 0, 0, 0) = sdl_float(sdl);
    finish(object, poly);
}

static void coefficients(Sdl *sdl, Object *object, int degree)
{
    Poly *poly = new_poly(sdl, object, degree);
    sdl_expect(sdl, "<");
    for (int i = 0; i < poly_terms(degree); i++) {
        if (i > 0)
            sdl_optional_comma(sdl);
        poly->c[i] = sdl_float(sdl);
    }
    sdl_expect(sdl, ">");
    finish(object, poly);
}

void parse_cubic(Sdl *sdl, Object *object)
{
    coefficients(sdl, object, 3);
}

void parse_quartic(Sdl *sdl, Object *object)
{
    coefficients(sdl, object, 4);
}

static int degree(Sdl *sdl)
{
    double n = sdl_float(sdl);
    if (!(n >= 2 && n <= POLYNOMIAL_DEGREE) || n != floor(n))
        sdl_error(sdl, "the order of a polynomial is a whole number from 2 to %d", POLYNOMIAL_DEGREE);
    sdl_optional_comma(sdl);
    return (int)n;
}

void parse_poly(Sdl *sdl, Object *object)
{
    coefficients(sdl, object, degree(sdl));
}

/* xyz(i, j, k): coefficient, in any order; those not written are 0. */
void parse_polynomial(Sdl *sdl, Object *object)
{
    Poly *poly = new_poly(sdl, object, degree(sdl));
    while (sdl_accept(sdl, "xyz")) {
        double power[3];
        sdl_expect(sdl, "(");
        for (int k = 0; k < 3; k++) {
            if (k > 0)
                sdl_optional_comma(sdl);
            power[k] = sdl_float(sdl);
            if (!(power[k] >= 0) || power[k] != floor(power[k]))
                sdl_error(sdl, "powers are whole numbers from 0");
        }
        sdl_expect(sdl, ")");
        sdl_expect(sdl, ":");
        if (power[0] + power[1] + power[2] > poly->degree)
            sdl_error(sdl, "this term's powers add up to more than the order, %d", poly->degree);
        *term(poly, (int)power[0], (int)power[1], (int)power[2]) = sdl_float(sdl);
        sdl_optional_comma(sdl);
    }
    finish(object, poly);
}
