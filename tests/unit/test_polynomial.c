/* Roots of polynomials, compared with dense sampling in long double, and with what the polynomials were made of. */
#include "lib_test.h"
#include <cmocka.h>
#include <float.h>
#include <math.h>
#include <string.h>
#include "base/polynomial.h"

static uint32_t state = 7;

static double between(double low, double high)
{
    return low + (high - low) * test_random(&state);
}

static long double long_value(const double *c, int degree, long double x)
{
    long double v = 0;

    for (int i = degree; i >= 0; i--)
        v = v * x + c[i];
    return v;
}

/* Product of (x - root) and of as many quadratics without real roots as there is room for. Returns the real roots. */
static int random_polynomial(int degree, double size, double *c)
{
    long double a[POLYNOMIAL_DEGREE + 2] = {1};
    double roots[POLYNOMIAL_DEGREE];
    int n = 0, count = 0;

    while (n < degree) {
        const int real = degree - n == 1 || test_random(&state) < 0.7;
        double b[3] = {1, 0, 0};
        if (real) {
            double r = between(-1, 1);
            for (int i = 0; i < count; i++)
                if (fabs(roots[i] - r) < 0.02)
                    r = between(-1, 1), i = -1;
            roots[count++] = r;
            b[0] = -r, b[1] = 1;
        } else {
            double re = between(-1, 1), im = between(0.05, 1);
            b[0] = re * re + im * im, b[1] = -2 * re, b[2] = 1;
        }
        n += real ? 1 : 2;
        for (int i = n; i >= 0; i--)
            a[i] = a[i] * b[0] + (i > 0 ? a[i - 1] * b[1] : 0) + (i > 1 && !real ? a[i - 2] * b[2] : 0);
    }
    for (int i = 0; i <= degree; i++)
        c[i] = (double)(a[i] * powl(size, degree - i));
    return count;
}

/* Every change of sign among dense samples is one root, and there are no others. */
static int check_against_samples(const double *c, int degree, double low, double high)
{
    const int steps = 4000;
    double roots[POLYNOMIAL_DEGREE];
    int count = polynomial_roots(c, degree, low, high, roots), next = 0;
    long double before = long_value(c, degree, low), h = ((long double)high - low) / steps;

    for (int i = 1; i <= steps; i++) {
        long double a = low + (i - 1) * h, b = i == steps ? high : low + i * h, now = long_value(c, degree, b);
        if ((before > 0) != (now > 0)) {
            assert_true(next < count);
            for (int k = 0; k < 70; k++) {
                long double m = (a + b) / 2;
                if ((long_value(c, degree, m) > 0) == (now > 0))
                    b = m;
                else
                    a = m;
            }
            /* As good as the value's own rounding lets it be. */
            long double slope = 0, sum = 0, x = 1;
            for (int k = 0; k <= degree; k++) {
                slope += k > 0 ? k * c[k] * powl(a, k - 1) : 0;
                sum += fabsl(c[k] * x);
                x *= a;
            }
            long double error = 4 * degree * DBL_EPSILON * (fabsl(a) + sum / fabsl(slope));
            assert_true(fabsl(roots[next] - a) <= error);
            next++;
        }
        before = now;
    }
    assert_int_equal(next, count);
    for (int i = 1; i < count; i++)
        assert_true(roots[i] > roots[i - 1]);
    return count;
}

static void roots_match_dense_samples(void **unused)
{
    const double sizes[] = {1e-4, 1e-2, 1, 1e3, 1e5};

    (void)unused;
    for (int i = 0; i < 3000; i++) {
        double c[POLYNOMIAL_DEGREE + 1], size = sizes[i % 5];
        int degree = 1 + i % 15, known = random_polynomial(degree, size, c);
        assert_int_equal(check_against_samples(c, degree, -1.1 * size, 1.2 * size), known);
        check_against_samples(c, degree, -0.3 * size, 0.61 * size);
        check_against_samples(c, degree, 0, 0.3 * size);
    }
}

static void infinite_intervals_have_all_roots(void **unused)
{
    (void)unused;
    for (int i = 0; i < 3000; i++) {
        double c[POLYNOMIAL_DEGREE + 1], all[POLYNOMIAL_DEGREE], some[POLYNOMIAL_DEGREE];
        int degree = 1 + i % 15, known = random_polynomial(degree, 1, c), positive = 0, count;
        assert_int_equal(polynomial_roots(c, degree, -INFINITY, INFINITY, all), known);
        for (int k = 0; k < known; k++)
            positive += all[k] > 0;
        count = polynomial_roots(c, degree, 0, INFINITY, some);
        assert_int_equal(count, positive);
        for (int k = 0; k < count; k++)
            assert_true(fabs(some[k] - all[known - count + k]) < 1e-6);
        assert_int_equal(polynomial_roots(c, degree, 2, INFINITY, some), 0);
    }
}

/* Touching is no crossing, an odd multiplicity is one, and leading zeros are no terms. */
static void multiple_roots(void **unused)
{
    const double touching[] = {0.25, -1, 1}, cubed[] = {-0.125, 0.75, -1.5, 1}, power[6] = {0, 0, 0, 0, 0, 1},
                 short_one[] = {-0.5, 1, 0, 0, 0}, constant[] = {3, 0, 0, 0};
    double roots[8];

    (void)unused;
    assert_int_equal(polynomial_roots(touching, 2, -1, 1, roots), 0);
    assert_int_equal(polynomial_roots(cubed, 3, -INFINITY, INFINITY, roots), 1);
    assert_true(fabs(roots[0] - 0.5) < 1e-5);
    assert_int_equal(polynomial_roots(power, 5, -INFINITY, INFINITY, roots), 1);
    assert_true(fabs(roots[0]) < 1e-3);
    assert_int_equal(polynomial_roots(short_one, 4, -1, 1, roots), 1);
    assert_true(roots[0] == 0.5);
    assert_int_equal(polynomial_roots(constant, 3, -1, 1, roots), 0);
}

/* Of intervals that join, each root belongs to one, also where they join. */
static void joined_intervals_share_no_root(void **unused)
{
    (void)unused;
    for (int i = 0; i < 2000; i++) {
        double c[POLYNOMIAL_DEGREE + 1], roots[POLYNOMIAL_DEGREE], parts[POLYNOMIAL_DEGREE];
        int degree = 3 + i % 10, count, sum = 0;
        random_polynomial(degree, 1, c);
        count = polynomial_roots(c, degree, -1.5, 1.5, roots);
        for (int k = 0; k <= count; k++)
            sum += polynomial_roots(c, degree, k ? roots[k - 1] : -1.5, k < count ? roots[k] : 1.5, parts);
        assert_int_equal(sum, count);
    }
}

/* Within 0..1, with and without Bernstein's coefficients. */
static void unit_pieces_have_all_roots(void **unused)
{
    int none = 0, one = 0;

    (void)unused;
    for (int i = 0; i < 6000; i++) {
        double c[POLYNOMIAL_DEGREE + 1], roots[POLYNOMIAL_DEGREE], points[POLYNOMIAL_DEGREE + 1], magnitude = 0;
        int degree = 2 + i % 9, count, pieces, changes = 0;
        random_polynomial(degree, 1, c);
        for (int k = 0; k <= degree; k++)
            magnitude += fabs(c[k]);
        count = polynomial_roots(c, degree, 0, 1, roots);
        pieces = polynomial_unit_pieces(c, degree, magnitude, points);
        for (int k = 1; k < pieces; k++)
            changes += (polynomial_value(c, degree, points[k]) > 0) != (polynomial_value(c, degree, points[k - 1]) > 0);
        assert_int_equal(changes, count);
        none += pieces == 0;
        one += pieces == 2;
    }
    assert_true(none > 200 && one > 200);
}

static void products_with_linear_terms(void **unused)
{
    double c[8] = {2, 0, 0, 0, 0, 0, 0, 0};
    int degree = 0;

    (void)unused;
    degree = polynomial_times_linear(c, degree, 1, 3);
    degree = polynomial_times_linear(c, degree, -2, 1);
    assert_int_equal(degree, 2);
    assert_true(c[0] == -4 && c[1] == -10 && c[2] == 6);
    assert_true(polynomial_value(c, 2, 2) == -4 - 20 + 24);
}

/* A difference of squares: near its root the value is rounding alone. */
static int evaluations;

static double difference_of_squares(const void *data, double x, double *slope)
{
    const double root = *(const double *)data, a = 1 + x, b = 1 + root;
    evaluations++;
    *slope = 2 * a;
    return a * a - b * b;
}

static void few_steps_end_at_rounding(void **unused)
{
    enum { ROOTS = 1000 };

    (void)unused;
    evaluations = 0;
    for (int i = 0; i < ROOTS; i++) {
        const double root = between(0.3, 0.9);
        const double found = root_between(difference_of_squares, &root, 0, 1, 1);
        assert_true(fabs(found - root) <= 8 * DBL_EPSILON);
    }
    assert_true(evaluations < 8 * ROOTS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roots_match_dense_samples),
        cmocka_unit_test(infinite_intervals_have_all_roots),
        cmocka_unit_test(multiple_roots),
        cmocka_unit_test(joined_intervals_share_no_root),
        cmocka_unit_test(unit_pieces_have_all_roots),
        cmocka_unit_test(products_with_linear_terms),
        cmocka_unit_test(few_steps_end_at_rounding),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
