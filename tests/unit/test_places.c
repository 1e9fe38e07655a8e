/* What merging two places changes, by lanes: the same bits with and without vector instructions, and as computed from
 * the mean and covariance of both, one pair after the other. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include <retex/host/uv_stats.h>
#include "lib_plain.h"

static double uniform(void)
{
    return rand() / (RAND_MAX + 1.0);
}

/* What two normal distributions see in common of a texture, times their light. */
static double in_common(const RetexUvStats *a, const RetexUvStats *b, double feature, const int periodic[2])
{
    double d[2], m[3], f = feature * feature;
    for (int i = 0; i < 2; i++) {
        d[i] = b->mean[i] - a->mean[i];
        d[i] -= periodic[i] ? round(d[i]) : 0;
    }
    for (int i = 0; i < 3; i++)
        m[i] = a->m2[i] / a->weight + b->m2[i] / b->weight + (i == 1 ? 0 : f);
    const double det = m[0] * m[2] - m[1] * m[1];
    const double distance2 = (m[2] * d[0] * d[0] - 2 * m[1] * d[0] * d[1] + m[0] * d[1] * d[1]) / det;
    return a->weight * b->weight * f / sqrt(det) * exp(-distance2 / 2);
}

/* A place of some paths: of one, on a line, or spread. */
static RetexUvStats some_place(double size, const int periodic[2])
{
    RetexUvStats place = {.weight = 0};
    const int paths = 1 + rand() % 4, is_line = rand() % 2;
    const double u = uniform(), v = uniform();
    for (int k = 0; k < paths; k++) {
        const double t = size * uniform(), uv[2] = {u + t, v + (is_line ? 2 * t : size * uniform())};
        retex_uv_stats_add(&place, 0.1 + uniform(), uv, periodic);
    }
    return place;
}

static void set(PlaceLanes *to, int lane, const RetexUvStats *a, double feature)
{
    static const int open[2] = {0, 0};
    to->weight[lane] = a->weight, to->variance[lane] = in_common(a, a, feature, open);
    for (int i = 0; i < 2; i++)
        to->mean[i][lane] = a->mean[i];
    for (int i = 0; i < 3; i++)
        to->m2[i][lane] = a->m2[i], to->covariance[i][lane] = a->m2[i] / a->weight;
}

static void lanes_are_pairs(void **state)
{
    (void)state;
    static const double features[] = {0.05, 0.1}, sizes[] = {1e-3, 0.1, 30};
    for (int n = 0; n < 3000; n++) {
        const int periodic[2] = {n % 2, n / 2 % 2};
        const double feature = features[n % 2], size = sizes[n % 3];
        RetexUvStats a[PLACE_LANES], b[PLACE_LANES];
        PlacePairs pairs = {.error2 = {0}}, plain;
        for (int k = 0; k < PLACE_LANES; k++) {
            a[k] = some_place(size, periodic), b[k] = k == 0 ? a[k] : some_place(size, periodic);
            set(&pairs.a, k, &a[k], feature), set(&pairs.b, k, &b[k], feature);
        }
        plain = pairs;
        place_pairs_errors(&pairs, feature, periodic);
        place_pairs_errors_plain(&plain, feature, periodic);
        assert_memory_equal(pairs.error2, plain.error2, sizeof pairs.error2);
        for (int k = 0; k < PLACE_LANES; k++) {
            RetexUvStats both = a[k];
            retex_uv_stats_merge(&both, &b[k], periodic);
            const double wanted =
                in_common(&a[k], &a[k], feature, periodic) + in_common(&b[k], &b[k], feature, periodic) +
                in_common(&both, &both, feature, periodic) + 2 * in_common(&a[k], &b[k], feature, periodic) -
                2 * in_common(&a[k], &both, feature, periodic) - 2 * in_common(&b[k], &both, feature, periodic);
            const double most = both.weight * both.weight;
            assert_true(fabs(pairs.error2[k] - wanted) < 1e-9 * most);
        }
    }
}

/* Light that is seen at one place with and without merging is the same; at two places far apart nothing is left. */
static void errors_are_between_nothing_and_all(void **state)
{
    (void)state;
    static const int open[2] = {0, 0};
    const RetexUvStats here = {1, {0.5, 0.5}, {0, 0, 0}}, there = {1, {1e6, 0.5}, {0, 0, 0}};
    PlacePairs pairs = {.error2 = {0}};
    for (int k = 0; k < PLACE_LANES; k++)
        set(&pairs.a, k, &here, 0.05), set(&pairs.b, k, k % 2 ? &there : &here, 0.05);
    place_pairs_errors(&pairs, 0.05, open);
    for (int k = 0; k < PLACE_LANES; k++)
        assert_true(k % 2 ? fabs(pairs.error2[k] - 2) < 1e-6 : fabs(pairs.error2[k]) < 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lanes_are_pairs),
        cmocka_unit_test(errors_are_between_nothing_and_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
