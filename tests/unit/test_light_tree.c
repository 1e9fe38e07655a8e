/* The tree of lights: probabilities add up to one, are those of the selected light, omit none, and follow the angles of
 * its paper. */
#include "lib_random_light.h"
#include "lib_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "light/light_tree.h"

/* One of each kind: points, spots, faces seen from one or both sides, shapes, light without fading. */
static LightBounds random_light(int kind)
{
    Vec3 p = random_point(5);
    double size = kind == 0 ? 0 : 0.1;
    LightBounds b = {
        .low = p, .high = vec_add(p, vec3(size, size, size)), .axis = random_direction(), .theta_e = PI / 2};
    b.intensity = random_between(0.1, 1.1), b.peak = 10;
    b.theta_o = kind == 0 || kind == 3 ? PI : 0;
    b.back_share = kind == 2 ? 1 : kind == 4 ? 0.1 : 0;
    if (kind == 1)
        b.theta_e = 0.3;
    if (kind == 5)
        b.constant = b.intensity, b.intensity = b.peak = 0;
    return b;
}

/* May the middle of a light shine on a point? */
static int reaches(const LightBounds *l, const LightSampleContext *p)
{
    Vec3 to = vec_normalize(vec_sub(vec_scale(vec_add(l->low, l->high), 0.5), p->position));
    if (vec_dot(p->normal, p->normal) > 0 && vec_dot(to, p->normal) <= 0)
        return 0;
    double cosine = -vec_dot(to, l->axis);
    return l->theta_o == PI || cosine > cos(l->theta_e) || (l->back_share > 0 && -cosine > cos(l->theta_e));
}

static void tree_probabilities(void **state)
{
    (void)state;
    static const int counts[] = {1, 2, 7, 8, 9, 60, 700};
    static LightBounds lights[700];
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        LightTree *tree;
        int n = counts[c];
        for (int k = 0; k < n; k++)
            lights[k] = random_light(k % 6);
        assert_int_equal(light_tree_create(&tree, lights, n, NULL), 0);
        for (int j = 0; j < 40; j++) {
            LightSampleContext p = random_lit(j);
            double sum = 0;
            for (int k = 0; k < n; k++) {
                float probability = light_tree_probability(tree, &p, k);
                assert_true(probability > 0 || !reaches(&lights[k], &p));
                sum += probability;
            }
            if (fabs(sum - 1) > 1e-4)
                fail_msg("probabilities of %d lights add up to %.6f", n, sum);
            for (int k = 0; k < 20; k++) {
                double u = random_between(0, 1);
                float probability;
                int light = light_tree_pick(tree, &p, &u, &probability);
                assert_true(u >= 0 && u < 1 && probability > 0);
                assert_true(fabsf(probability - light_tree_probability(tree, &p, light)) <= 1e-4f * probability);
            }
        }
        light_tree_close(&tree);
    }
}

/* As often as they say. */
static void tree_frequencies(void **state)
{
    (void)state;
    enum { N = 40, SAMPLES = 1 << 16 };
    LightBounds lights[N];
    int found[N] = {0};
    LightTree *tree;
    for (int k = 0; k < N; k++)
        lights[k] = random_light(k % 6);
    assert_int_equal(light_tree_create(&tree, lights, N, NULL), 0);
    LightSampleContext p = random_lit(1);
    for (int k = 0; k < SAMPLES; k++) {
        double u = (k + 0.5) / SAMPLES;
        float probability;
        found[light_tree_pick(tree, &p, &u, &probability)]++;
    }
    for (int k = 0; k < N; k++) {
        double wanted = light_tree_probability(tree, &p, k);
        if (fabs((double)found[k] / SAMPLES - wanted) > 4.0 / SAMPLES)
            fail_msg("light %d: chosen %.5f of the time, should be %.5f", k, (double)found[k] / SAMPLES, wanted);
    }
    light_tree_close(&tree);
}

/* Lights all in one place still make a tree. */
static void tree_of_one_place(void **state)
{
    (void)state;
    enum { N = 1000 };
    static LightBounds lights[N];
    LightTree *tree;
    for (int k = 0; k < N; k++)
        lights[k] =
            (LightBounds){.axis = {0, 0, 1}, .theta_o = PI, .theta_e = PI / 2, .intensity = 1, .peak = INFINITY};
    assert_int_equal(light_tree_create(&tree, lights, N, NULL), 0);
    LightSampleContext there = {{0, 0, 0}, {0, 0, 0}, NULL}, away = {{1, 0, 0}, {0, 0, 0}, NULL};
    for (int k = 0; k < N; k++) {
        assert_true(fabsf(light_tree_probability(tree, &there, k) - 1.0f / N) < 0.001f / N);
        assert_true(fabsf(light_tree_probability(tree, &away, k) - 1.0f / N) < 0.001f / N);
    }
    light_tree_close(&tree);
}

/* Weight of a light at a point by angles, which the tree has by cosines (Conty Estevez and Kulla, section 2). Negative
 * where an angle is close to a limit of the tree, which has slack. */
static double weight_by_angles(const LightBounds *l, const LightSampleContext *p)
{
    const Vec3 to = vec_sub(vec_scale(vec_add(l->low, l->high), 0.5), p->position);
    const double radius = vec_length(vec_sub(l->high, l->low)) / 2, d = vec_length(to);
    const double seen = d > radius * 1.0001 ? asin(radius * 1.0001 / d) : PI;
    double from_axis = acos(-vec_dot(to, l->axis) / d), shines, lit = 1;
    if (l->back_share == 1)
        from_axis = fmin(from_axis, PI - from_axis);
    from_axis = fmax(0, from_axis - l->theta_o - seen);
    shines = from_axis < l->theta_e ? cos(from_axis) : 0;
    if (fabs(cos(from_axis) - cos(l->theta_e)) < 0.02 || fabs(cos(from_axis)) < 0.02)
        return -1;
    if (l->back_share < 1)
        shines = fmax(shines, l->back_share);
    if (vec_dot(p->normal, p->normal) > 0) {
        const double from_normal = fmax(0, acos(vec_dot(to, p->normal) / d) - seen);
        if (fabs(cos(from_normal)) < 0.02)
            return -1;
        lit = fmax(0, cos(from_normal));
    }
    return shines * lit * (l->constant + l->intensity / (d * d + radius * radius + l->intensity / l->peak));
}

/* Of two lights each is chosen by its weight; the estimate of one alone is its weight. */
static void tree_weighs_by_angles(void **state)
{
    (void)state;
    int compared = 0, cones = 0;
    for (int n = 0; n < 20000; n++) {
        LightBounds lights[2];
        LightTree *tree;
        double weights[2];
        const LightSampleContext p = random_lit(n);
        for (int k = 0; k < 2; k++) {
            lights[k] = random_light((n / 2 + k * (n % 5 + 1)) % 6);
            lights[k].high = vec_add(lights[k].low, vec_scale(vec3(1, 1, 1), random_between(0.1, 2)));
            lights[k].peak = fmax(lights[k].peak, 1);
            if (n % 3 && lights[k].theta_o == 0)
                lights[k].theta_o = random_between(0.1, 1.5), cones++;
            weights[k] = weight_by_angles(&lights[k], &p);
        }
        if (!(fmin(weights[0], weights[1]) >= 0 && weights[0] + weights[1] > 1e-3))
            continue;
        compared++;
        assert_int_equal(light_tree_create(&tree, lights, 2, NULL), 0);
        const double wanted = weights[0] / (weights[0] + weights[1]);
        const double found = (double)light_tree_probability(tree, &p, 0);
        if (fabs(found - wanted) > 1e-3)
            fail_msg("pair %d: a light is chosen by %.5f, should be by %.5f", n, found, wanted);
        light_tree_close(&tree);
        assert_int_equal(light_tree_create(&tree, lights, 1, NULL), 0);
        const double estimate = (double)light_tree_estimate(tree, &p);
        if (fabs(estimate - weights[0]) > 1e-3 * (weights[0] + 0.01))
            fail_msg("light %d: estimated %.5f, should be %.5f", n, estimate, weights[0]);
        light_tree_close(&tree);
    }
    printf("# %d pairs, %d cones\n", compared, cones);
    assert_true(compared > 5000 && cones > 5000);
}

/* How far the choice is from the best one, which is by each light's weight: the mean square of what one sample gives,
 * over the square of the mean, less 1. Walls of small faces, that one would cut by place and by direction, in a thin
 * box. */
static double variance_of_choice(int points)
{
    enum { N = 480 };
    static LightBounds lights[N];
    LightTree *tree;
    double sum = 0;
    for (int k = 0; k < N; k++) {
        const int wall = k % 4;
        const double u = random_between(-4, 4), v = random_between(0, 1);
        const Vec3 at = wall < 2 ? vec3(u, v, wall ? 4 : -4) : vec3(wall == 2 ? -4 : 4, v, u);
        const Vec3 axis = wall < 2 ? vec3(0, 0, wall ? -1 : 1) : vec3(wall == 2 ? 1 : -1, 0, 0);
        lights[k] = (LightBounds){.low = at, .high = vec_add(at, vec3(0.01, 0.01, 0.01)), .axis = axis};
        lights[k].theta_e = PI / 2, lights[k].intensity = k % 7 ? 0.01 : 1, lights[k].peak = 100;
    }
    assert_int_equal(light_tree_create(&tree, lights, N, NULL), 0);
    for (int n = 0; n < points; n++) {
        LightSampleContext p = {.position = vec3(random_between(-3.5, 3.5), random_between(0, 1), 0)};
        p.position.z = random_between(-3.5, 3.5);
        if (n % 2)
            p.normal = random_direction();
        double whole = 0, square = 0;
        for (int k = 0; k < N; k++) {
            const double weight = fmax(0, weight_by_angles(&lights[k], &p));
            whole += weight;
            square += weight > 0 ? weight * weight / (double)light_tree_probability(tree, &p, k) : 0;
        }
        sum += whole > 0 ? square / (whole * whole) - 1 : 0;
    }
    light_tree_close(&tree);
    return sum / points;
}

static void tree_is_near_the_best_choice(void **state)
{
    (void)state;
    const double variance = variance_of_choice(4000);
    printf("# variance %.4f\n", variance);
    assert_true(variance < 0.42);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tree_probabilities),
        cmocka_unit_test(tree_frequencies),
        cmocka_unit_test(tree_of_one_place),
        cmocka_unit_test(tree_weighs_by_angles),
        cmocka_unit_test(tree_is_near_the_best_choice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
