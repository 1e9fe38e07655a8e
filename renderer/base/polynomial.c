/* Real roots of polynomials in an interval. */
#include <float.h>
#include <math.h>
#include "base/polynomial.h"

/* How far from a root, as a share of it, a search ends. Critical points only keep roots apart: by what a value differs
 * there, which is the square of that. */
#define ROOT_SHARE (4 * DBL_EPSILON)
#define CRITICAL_SHARE 1e-9

typedef struct Polynomial {
    const double *c;
    int degree;
} Polynomial;

double polynomial_value(const double *c, int degree, double x)
{
    double v = c[degree];

    for (int i = degree - 1; i >= 0; i--)
        v = v * x + c[i];
    return v;
}

static double evaluate(const void *data, double x, double *slope)
{
    const Polynomial *p = data;
    double v = p->c[p->degree], d = 0;

    for (int i = p->degree - 1; i >= 0; i--) {
        d = d * x + v;
        v = v * x + p->c[i];
    }
    *slope = d;
    return v;
}

/* Newton's steps, halving where they leave the bracket or are slow; to this share of the root. */
static inline double bracketed(RootFunction *f, const void *data, double low, double high, int rising, double share)
{
    double s = 0.5 * (low + high), step = high - low;

    for (int i = 0; i < 200; i++) {
        double d, v = f(data, s, &d), next;
        if ((v > 0) == rising)
            high = s;
        else
            low = s;
        next = s - v / d;
        /* The value is rounding alone: the bracket's other end may be far, and halving would take long. */
        if (fabs(v) <= share * fabs(s * d) && isfinite(d))
            return fmin(fmax(next, low), high);
        if (!(next > low && next < high && fabs(next - s) <= 0.5 * step))
            next = 0.5 * (low + high);
        step = fabs(next - s);
        if (step <= share * fabs(s) || next <= low || next >= high)
            return next;
        s = next;
    }
    return s;
}

double root_between(RootFunction *f, const void *data, double low, double high, int rising)
{
    return bracketed(f, data, low, high, rising, ROOT_SHARE);
}

int roots_between_points(RootFunction *f, const void *data, const double *points, int count, double *roots)
{
    double slope;
    int found = 0, before = count > 0 && f(data, points[0], &slope) > 0;

    for (int i = 1; i < count; i++) {
        int now = f(data, points[i], &slope) > 0;
        if (now != before)
            roots[found++] = root_between(f, data, points[i - 1], points[i], now);
        before = now;
    }
    return found;
}

double polynomial_root_between(const double *c, int degree, double low, double high, int rising)
{
    const Polynomial p = {c, degree};

    return bracketed(evaluate, &p, low, high, rising, ROOT_SHARE);
}

/* Of a linear or quadratic polynomial, without cancellation. */
static int closed_form(const double *c, int degree, double low, double high, double *roots)
{
    double half = 0.5 * c[1], discriminant, q, r[2];
    int count = 0;

    if (degree == 1) {
        r[0] = -c[0] / c[1];
        r[1] = INFINITY;
    } else {
        discriminant = half * half - c[2] * c[0];
        if (!(discriminant > 0))
            return 0;
        q = -(half + copysign(sqrt(discriminant), half));
        r[0] = fmin(q / c[2], c[0] / q);
        r[1] = fmax(q / c[2], c[0] / q);
    }
    for (int i = 0; i < 2; i++)
        if (r[i] > low && r[i] < high)
            roots[count++] = r[i];
    return count;
}

/* roots_between_points of a polynomial, each to this share of it. */
static int between_points(const double *c, int degree, const double *points, int count, double share, double *roots)
{
    const Polynomial p = {c, degree};
    int found = 0, before = polynomial_value(c, degree, points[0]) > 0;

    for (int i = 1; i < count; i++) {
        int now = polynomial_value(c, degree, points[i]) > 0;
        if (now != before)
            roots[found++] = bracketed(evaluate, &p, points[i - 1], points[i], now, share);
        before = now;
    }
    return found;
}

static int roots_within(const double *c, int degree, double low, double high, double share, double *roots);

static int pieces(const double *c, int degree, double low, double high, double *points)
{
    double derivative[POLYNOMIAL_DEGREE];
    int count;

    for (int i = 1; i <= degree; i++)
        derivative[i - 1] = i * c[i];
    points[0] = low;
    count = 1 + roots_within(derivative, degree - 1, low, high, CRITICAL_SHARE, points + 1);
    points[count++] = high;
    return count;
}

static int roots_within(const double *c, int degree, double low, double high, double share, double *roots)
{
    double points[POLYNOMIAL_DEGREE + 1];

    while (degree > 0 && c[degree] == 0)
        degree--;
    if (degree < 1)
        return 0;
    if (degree <= 2)
        return closed_form(c, degree, low, high, roots);
    return between_points(c, degree, points, pieces(c, degree, low, high, points), share, roots);
}

/* The binary exponent of x, rounded up. */
static int exponent(double x)
{
    int e;

    frexp(x, &e);
    return x == 0 ? -2000 : e;
}

/* No root, nor one of a derivative, is farther from 0: by powers of 2 above Fujiwara's bound (1916), and by the theorem
 * of Gauss and Lucas. Where values would overflow it is as far as they stay finite. */
static double reach(const double *c, int degree)
{
    int leading, most, bound = 0;

    while (degree > 0 && c[degree] == 0)
        degree--;
    most = leading = exponent(c[degree]);
    for (int i = 0; i < degree; i++) {
        const int e = exponent(c[i]), over = e - leading + 1;
        most = e > most ? e : most;
        if (over > bound * (degree - i))
            bound = over / (degree - i) + 1;
    }
    most = (1000 - most) / (degree + 1);
    return ldexp(2, bound < most ? bound : most);
}

static void make_finite(const double *c, int degree, double *low, double *high)
{
    double far;

    if (isfinite(*low) && isfinite(*high))
        return;
    far = reach(c, degree);
    *low = fmax(*low, fmin(-far, *high));
    *high = fmin(*high, fmax(far, *low));
}

int polynomial_roots(const double *c, int degree, double low, double high, double *roots)
{
    if (degree > 2)
        make_finite(c, degree, &low, &high);
    return low < high ? roots_within(c, degree, low, high, ROOT_SHARE, roots) : 0;
}

int polynomial_pieces(const double *c, int degree, double low, double high, double *points)
{
    make_finite(c, degree, &low, &high);
    while (degree > 1 && c[degree] == 0)
        degree--;
    return pieces(c, degree, low, high, points);
}

int polynomial_unit_pieces(const double *c, int degree, double magnitude, double *points)
{
    double b[POLYNOMIAL_DEGREE + 1], choices = 1;
    int certain = 1, changes = 0;

    for (int i = 0; i <= degree; i++) {
        b[i] = c[i] / choices;
        choices = choices * (degree - i) / (i + 1);
    }
    for (int k = 1; k <= degree; k++)
        for (int j = degree; j >= k; j--)
            b[j] += b[j - 1];
    for (int i = 0; i <= degree && certain; i++) {
        certain = fabs(b[i]) > 64 * DBL_EPSILON * magnitude;
        changes += i > 0 && (b[i] > 0) != (b[i - 1] > 0);
    }
    if (!certain || changes > 1)
        return polynomial_pieces(c, degree, 0, 1, points);
    points[0] = 0;
    points[1] = 1;
    return 2 * changes;
}
