/* Clusters of UV, compared with sums in two passes; merging, periodic axes, and the cost of merging. */
#include "lib_test.h"

#include <math.h>
#include <string.h>

#include <cmocka.h>

#include <retex/host/uv_stats.h>

#define COUNT 400

static const int open_axes[2] = {0, 0}, closed_axes[2] = {1, 1};

typedef struct Point {
    double weight, uv[2];
} Point;

/* A tilted cloud of the given size about a place. */
static void make_points(Point *points, int count, double u, double v, double size, uint32_t seed)
{
    for (int i = 0; i < count; i++) {
        double a = test_random(&seed) - 0.5, b = test_random(&seed) - 0.5;
        points[i] = (Point){0.01 + pow(test_random(&seed), 6) * 100, {u + size * (a + 0.3 * b), v + size * b}};
    }
}

static RetexUvStats add_all(const Point *points, int count, const int periodic[2])
{
    RetexUvStats stats = {0};
    for (int i = 0; i < count; i++)
        retex_uv_stats_add(&stats, points[i].weight, points[i].uv, periodic);
    return stats;
}

/* In two passes, relative to the first point so that nothing cancels. */
static RetexUvStats sum_directly(const Point *points, int count)
{
    RetexUvStats s = {0};
    double mean[2] = {0, 0};
    for (int i = 0; i < count; i++) {
        s.weight += points[i].weight;
        for (int k = 0; k < 2; k++)
            mean[k] += points[i].weight * (points[i].uv[k] - points[0].uv[k]);
    }
    for (int k = 0; k < 2; k++)
        mean[k] /= s.weight, s.mean[k] = points[0].uv[k] + mean[k];
    for (int i = 0; i < count; i++) {
        double u = points[i].uv[0] - points[0].uv[0] - mean[0], v = points[i].uv[1] - points[0].uv[1] - mean[1];
        s.m2[0] += points[i].weight * u * u;
        s.m2[1] += points[i].weight * u * v;
        s.m2[2] += points[i].weight * v * v;
    }
    return s;
}

static void expect_equal(const RetexUvStats *a, const RetexUvStats *b, double size)
{
    double spread = b->weight * size * size;
    assert_true(fabs(a->weight - b->weight) < 1e-12 * b->weight);
    for (int k = 0; k < 2; k++)
        assert_true(fabs(a->mean[k] - b->mean[k]) < 1e-6 * size);
    for (int k = 0; k < 3; k++)
        assert_true(fabs(a->m2[k] - b->m2[k]) < 1e-6 * spread);
}

static void sums_agree_with_two_passes(void **state)
{
    (void)state;
    static const double places[] = {0, 0.5, -3.25, 1000}, sizes[] = {1e-4, 0.01, 1, 50};
    Point points[COUNT];
    for (uint32_t i = 0; i < 16; i++) {
        double size = sizes[i / 4];
        make_points(points, COUNT, places[i % 4], -2 * places[i % 4], size, i + 1);
        RetexUvStats stats = add_all(points, COUNT, open_axes), want = sum_directly(points, COUNT);
        expect_equal(&stats, &want, size);
    }
}

static void one_point_has_no_spread(void **state)
{
    (void)state;
    const Point point = {3, {17.25, -0.75}};
    RetexUvStats stats = add_all(&point, 1, open_axes);
    assert_true(stats.weight == 3 && stats.mean[0] == 17.25 && stats.mean[1] == -0.75);
    assert_true(stats.m2[0] == 0 && stats.m2[1] == 0 && stats.m2[2] == 0);
    stats = add_all(&point, 1, closed_axes); /* brought into the first period */
    assert_true(stats.mean[0] == 0.25 && stats.mean[1] == 0.25);
}

static void merging_is_adding_all(void **state)
{
    (void)state;
    Point points[COUNT];
    for (uint32_t seed = 1; seed <= 20; seed++) {
        int split = 1 + (int)seed * 19;
        make_points(points, split, 900, 0.3, 1e-4, seed);
        make_points(points + split, COUNT - split, 900.0003, 0.2999, 1e-4, seed + 100);
        RetexUvStats stats = add_all(points, split, open_axes),
                     rest = add_all(points + split, COUNT - split, open_axes);
        RetexUvStats other = rest, want = sum_directly(points, COUNT);
        retex_uv_stats_merge(&other, &stats, open_axes);
        retex_uv_stats_merge(&stats, &rest, open_axes);
        expect_equal(&stats, &want, 1e-4);
        expect_equal(&other, &want, 1e-4);
    }
}

/* Distance on a circle of length 1. */
static double around(double a, double b)
{
    return fabs(a - b - rint(a - b));
}

static void a_seam_is_no_distance(void **state)
{
    (void)state;
    const Point points[2] = {{1, {0.99, 0.99}}, {1, {0.01, 0.01}}};
    RetexUvStats closed = add_all(points, 2, closed_axes), open = add_all(points, 2, open_axes);
    for (int k = 0; k < 2; k++) {
        assert_true(around(closed.mean[k], 0) < 1e-12);
        assert_true(fabs(open.mean[k] - 0.5) < 1e-12);
    }
    for (int k = 0; k < 3; k++) {
        assert_true(fabs(closed.m2[k] - 2 * 0.01 * 0.01) < 1e-12);
        assert_true(fabs(open.m2[k] - 2 * 0.49 * 0.49) < 1e-12);
    }
    const int only_v[2] = {0, 1};
    RetexUvStats mixed = add_all(points, 2, only_v);
    assert_true(fabs(mixed.mean[0] - 0.5) < 1e-12 && around(mixed.mean[1], 0) < 1e-12);
}

/* A cloud across the seam has the spread it has elsewhere, however it is added up, and its mean lies in [0,1). */
static void a_cloud_may_lie_across_a_seam(void **state)
{
    (void)state;
    Point points[COUNT];
    for (uint32_t seed = 1; seed <= 20; seed++) {
        make_points(points, COUNT, -0.01 + 0.001 * seed, 7, 0.05, seed);
        RetexUvStats want = sum_directly(points, COUNT);
        for (int i = 0; i < COUNT; i++)
            for (int k = 0; k < 2; k++)
                points[i].uv[k] -= floor(points[i].uv[k]);
        RetexUvStats all = add_all(points, COUNT, closed_axes), half = add_all(points, 150, closed_axes),
                     rest = add_all(points + 150, COUNT - 150, closed_axes);
        retex_uv_stats_merge(&half, &rest, closed_axes);
        const RetexUvStats *both[2] = {&all, &half};
        for (int i = 0; i < 2; i++) {
            for (int k = 0; k < 2; k++) {
                assert_true(both[i]->mean[k] >= 0 && both[i]->mean[k] < 1);
                assert_true(around(both[i]->mean[k], want.mean[k]) < 1e-9);
            }
            for (int k = 0; k < 3; k++)
                assert_true(fabs(both[i]->m2[k] - want.m2[k]) < 1e-9 * want.weight);
        }
    }
}

/* What is stored comes back: each axis to a 32nd of its own deviation, deviations to a 128th, and the correlation with
 * its sign. */
static void what_is_stored_comes_back(void **state)
{
    (void)state;
    for (int k = 0; k < 64; k++) {
        const double deviation[2] = {k & 1 ? 0.4 : 0.004, k & 2 ? 0.3 : 0.003}, sign = k & 4 ? -1 : 1;
        const double correlation = sign * (k >> 3) / 8.0, weight = 1.5;
        RetexUvStats from = {weight, {0.123456 + k, 7.654321}, {0, 0, 0}}, to;
        float mean[2], spread[3];
        from.m2[0] = weight * deviation[0] * deviation[0], from.m2[2] = weight * deviation[1] * deviation[1];
        from.m2[1] = weight * correlation * deviation[0] * deviation[1];
        retex_uv_stats_store(&from, mean, spread);
        retex_uv_stats_load(&to, weight, mean, spread);
        for (int axis = 0; axis < 2; axis++) {
            assert_true(fabs((double)mean[axis] - from.mean[axis]) <= deviation[axis] / 64 + 1e-6 * from.mean[axis]);
            assert_true(fabs((double)spread[axis] / deviation[axis] - 1) <= 1.0 / 128);
        }
        assert_true(fabs(to.m2[0] / from.m2[0] - 1) < 0.02 && fabs(to.m2[2] / from.m2[2] - 1) < 0.02);
        assert_true(fabs(to.m2[1] - from.m2[1]) < 0.04 * sqrt(from.m2[0] * from.m2[2]));
    }
}

/* A place below 0 by less than a double can tell from 1 is no 1 either. */
static void the_end_of_a_period_is_its_beginning(void **state)
{
    (void)state;
    const Point below = {1, {-1e-18, -1e-300}}, above = {1, {1e-18, 0}};
    RetexUvStats stats = add_all(&below, 1, closed_axes), other = add_all(&above, 1, closed_axes);
    assert_true(stats.mean[0] == 0 && stats.mean[1] == 0);
    other.mean[0] = -3e-18;
    retex_uv_stats_merge(&stats, &other, closed_axes);
    assert_true(stats.mean[0] == 0 && stats.mean[1] == 0);
    stats = add_all(&below, 1, open_axes);
    assert_true(stats.mean[0] == -1e-18 && stats.mean[1] == -1e-300);
}

/* Ward's cost is by how much the sum of squared deviations along both axes grows. */
static void the_cost_is_what_merging_adds(void **state)
{
    (void)state;
    Point points[40];
    for (uint32_t seed = 1; seed <= 40; seed++) {
        const int *periodic = seed % 2 ? closed_axes : open_axes;
        make_points(points, 20, 0.95, 0.2, 0.02, seed);
        make_points(points + 20, 20, 0.95 + 0.004 * seed, 0.25, 0.02, seed + 50);
        RetexUvStats a = add_all(points, 20, periodic), b = add_all(points + 20, 20, periodic), both = a;
        double cost = retex_uv_stats_ward(&a, &b, periodic);
        assert_true(cost >= 0);
        assert_true(fabs(cost - retex_uv_stats_ward(&b, &a, periodic)) < 1e-12 * cost);
        retex_uv_stats_merge(&both, &b, periodic);
        double growth = both.m2[0] + both.m2[2] - a.m2[0] - a.m2[2] - b.m2[0] - b.m2[2];
        assert_true(fabs(cost - growth) < 1e-9 * (cost + both.m2[0] + both.m2[2]));
        b = a;
        b.weight *= 3;
        assert_true(retex_uv_stats_ward(&a, &b, periodic) == 0);
    }
    const RetexUvStats low = {1, {0.01, 0.5}, {0, 0, 0}}, high = {1, {0.99, 0.5}, {0, 0, 0}};
    assert_true(fabs(retex_uv_stats_ward(&low, &high, closed_axes) - 0.5 * 0.02 * 0.02) < 1e-12);
    assert_true(fabs(retex_uv_stats_ward(&low, &high, open_axes) - 0.5 * 0.98 * 0.98) < 1e-12);
}

/* A single point costs what it costs as a cluster, to the bit. */
static void a_point_costs_what_its_cluster_does(void **state)
{
    (void)state;
    Point points[20];
    for (uint32_t seed = 1; seed <= 40; seed++) {
        const int *periodic = seed % 2 ? closed_axes : open_axes;
        make_points(points, 20, 0.95, 0.2, 0.02 * seed, seed);
        for (int n = 1; n < 20; n++) {
            RetexUvStats a = add_all(points, n, periodic);
            const RetexUvStats one = {points[n].weight, {points[n].uv[0], points[n].uv[1]}, {0, 0, 0}};
            assert_true(retex_uv_stats_point_ward(&a, one.weight, one.mean, periodic) ==
                        retex_uv_stats_ward(&a, &one, periodic));
            assert_true(retex_uv_stats_merged_variation(&a, one.weight, one.mean, 0, periodic) -
                            retex_uv_stats_variation(&a) ==
                        retex_uv_stats_variation_gain(&a, &one, periodic));
        }
    }
}

/* A cluster of the given variance in all, half of it along each axis. */
static RetexUvStats blob(double weight, double u, double v, double variance)
{
    return (RetexUvStats){weight, {u, v}, {0.5 * weight * variance, 0, 0.5 * weight * variance}};
}

/* Merging never makes a texture vary less, whatever is merged; and either may be called the first. */
static void variation_never_falls(void **state)
{
    (void)state;
    uint32_t seed = 5;
    for (int k = 0; k < 20000; k++) {
        const int *periodic = k % 2 ? closed_axes : open_axes;
        RetexUvStats c[2];
        for (int i = 0; i < 2; i++) {
            double weight = pow(10, 12 * test_random(&seed) - 6), size = pow(10, 10 * test_random(&seed) - 5);
            c[i] = blob(weight, size * test_random(&seed), test_random(&seed), k % 5 == i ? 0 : size * size);
        }
        double gain = retex_uv_stats_variation_gain(&c[0], &c[1], periodic), all = c[0].weight + c[1].weight;
        assert_true(gain >= -1e-12 * all && gain <= all * (1 + 1e-12));
        assert_true(fabs(gain - retex_uv_stats_variation_gain(&c[1], &c[0], periodic)) <= 1e-12 * all);
    }
}

/* As long as clusters lie within a small part of what a texture changes in, it is Ward's rule. */
static void small_clusters_merge_by_ward(void **state)
{
    (void)state;
    uint32_t seed = 9;
    for (int k = 0; k < 1000; k++) {
        const int *periodic = k % 2 ? closed_axes : open_axes;
        double size = 0.05 * RETEX_UV_FEATURE * pow(10, -2 * test_random(&seed));
        RetexUvStats a = blob(0.1 + test_random(&seed), 0.99, 0.4, k % 3 ? size * size : 0);
        RetexUvStats b = blob(0.1 + test_random(&seed), 0.99 + 2 * size, 0.4 - size, k % 3 == 2 ? size * size : 0);
        double ward = retex_uv_stats_ward(&a, &b, periodic) / (RETEX_UV_FEATURE * RETEX_UV_FEATURE);
        assert_true(fabs(retex_uv_stats_variation_gain(&a, &b, periodic) - ward) < 0.05 * ward);
    }
}

/* Where both see the texture's mean nothing is lost, however far they lie from each other; where one of them sees a
 * place, that place is lost, even where it is the middle of the other. */
static void wide_clusters_cost_nothing_but_to_tight_ones(void **state)
{
    (void)state;
    for (double far = 0; far <= 1e6; far = 10 * far + 1) {
        RetexUvStats wide = blob(3, 0, 0, 400), other = blob(1, far, -far, 900), tight = blob(1, far, -far, 1e-6);
        assert_true(retex_uv_stats_variation_gain(&wide, &other, open_axes) < 0.001 * 4);
        assert_float_equal(retex_uv_stats_variation_gain(&wide, &tight, open_axes), 1, 0.01); /* all of its weight */
    }
    RetexUvStats wide = blob(3, 0.5, 0.5, 400), same = blob(1, 0.5, 0.5, 0);
    assert_true(retex_uv_stats_ward(&wide, &same, open_axes) == 0);
    assert_float_equal(retex_uv_stats_variation_gain(&wide, &same, open_axes), 1, 0.01);
}

/* What merging two places costs has an end: the weight of both. */
static void far_points_do_not_claim_more_and_more(void **state)
{
    (void)state;
    const RetexUvStats here = blob(1, 0, 0, 0);
    double before = 0;
    for (double far = 0.01; far < 1e9; far *= 10) {
        RetexUvStats there = blob(1, far, 0, 0);
        double gain = retex_uv_stats_variation_gain(&here, &there, open_axes);
        assert_true(gain > before || (far > 1e6 && gain >= before));
        assert_true(gain <= 2);
        before = gain;
    }
    assert_float_equal(before, 2, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_agree_with_two_passes),
        cmocka_unit_test(one_point_has_no_spread),
        cmocka_unit_test(merging_is_adding_all),
        cmocka_unit_test(a_seam_is_no_distance),
        cmocka_unit_test(a_cloud_may_lie_across_a_seam),
        cmocka_unit_test(what_is_stored_comes_back),
        cmocka_unit_test(the_end_of_a_period_is_its_beginning),
        cmocka_unit_test(the_cost_is_what_merging_adds),
        cmocka_unit_test(a_point_costs_what_its_cluster_does),
        cmocka_unit_test(variation_never_falls),
        cmocka_unit_test(small_clusters_merge_by_ward),
        cmocka_unit_test(wide_clusters_cost_nothing_but_to_tight_ones),
        cmocka_unit_test(far_points_do_not_claim_more_and_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
