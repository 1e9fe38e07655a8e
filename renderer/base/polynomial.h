/* Real roots of polynomials, and of other functions, as changes of sign.
 *
 * Between two neighbouring critical points a function has at most one root, and a change of sign tells whether it has
 * one. Critical points of a polynomial are the roots of its derivative, found in the same way, down to a quadratic. So
 * no root is lost or made up but for pairs that lie closer than rounding, and nothing is to be tuned. A double root is
 * no change of sign, and no root here; the number of roots in an interval is even or odd as the signs at its ends say.
 *
 * Coefficients ascend: c[0] + c[1] x + c[2] x^2 + … */
#ifndef RENDERER_BASE_POLYNOMIAL_H
#define RENDERER_BASE_POLYNOMIAL_H

enum { POLYNOMIAL_DEGREE = 35 }; /* the highest */

/* The value at x, and the slope there. */
typedef double RootFunction(const void *data, double x, double *slope);

/* Catmull and Rom's cubic through four values, by how far the point is from the second. */
static inline void cubic_weights(double t, double weights[4])
{
    weights[0] = t * (-0.5 + t * (1 - 0.5 * t));
    weights[1] = 1 + t * t * (-2.5 + 1.5 * t);
    weights[2] = t * (0.5 + t * (2 - 1.5 * t));
    weights[3] = t * t * (-0.5 + 0.5 * t);
}

double polynomial_value(const double *c, int degree, double x);

/* The root between low and high, where f has opposite signs; rising: it is positive at high. Newton's steps, halving
 * where they leave the bracket or are slow. */
double root_between(RootFunction *f, const void *data, double low, double high, int rising);

double polynomial_root_between(const double *c, int degree, double low, double high, int rising);

/* Roots of f, which is monotonic between points that follow each other; they ascend. Of a point at which f is 0 it
 * counts as negative there. Returns how many: fewer than points. */
int roots_between_points(RootFunction *f, const void *data, const double *points, int count, double *roots);

/* Ascending roots in low..high, which may be infinite. Returns how many, at most degree. */
int polynomial_roots(const double *c, int degree, double low, double high, double *roots);

/* low, the ascending critical points within low..high, and high: what roots_between_points takes. Returns how many, at
 * most degree + 1. */
int polynomial_pieces(const double *c, int degree, double low, double high, double *points);

/* The same within 0..1, but 0 points where there is no root for certain, and 0 and 1 alone where there is one: by the
 * signs of Bernstein's coefficients. magnitude: of what c was computed from, which rounding is a share of. */
int polynomial_unit_pieces(const double *c, int degree, double magnitude, double *points);

/* Polynomial times a + b x, in place: returns the new degree. degree -1 is the polynomial 0. */
static inline int polynomial_times_linear(double *c, int degree, double a, double b)
{
    double carry = 0;

    for (int i = 0; i <= degree; i++) {
        double next = c[i];
        c[i] = next * a + carry * b;
        carry = next;
    }
    if (degree >= 0)
        c[degree + 1] = carry * b;
    return degree < 0 ? -1 : degree + 1;
}

#endif
