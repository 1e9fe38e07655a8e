/* The guide to caustics: its density integrates to one over the sphere and is that of its directions, the guide is the
 * same for any number of threads, and the mean of a picture does not depend on it. */
#include "lib_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "path/caustics.h"
#include "render/render.h"
#include "path/sampler.h"

static const char LENS[] =
    "#version 3.7; global_settings { assumed_gamma 1 } camera { location <0, 3, -4> look_at 0 angle 40 }"
    "#default { finish { ambient 0 diffuse 1 } }"
    "plane { y, 0 texture { pigment { rgb .5 } } }"
    "sphere { 0, .5 texture { pigment { rgbt 1 } finish { diffuse 0 reflection { 0, 1 fresnel on } conserve_energy } }"
    " interior { ior 1.5 } translate <0, .9, 0> }"
    "disc { <0, 5, 0>, y, .6 texture { pigment { rgb 1 } finish { diffuse 0 emission 20 } } }";
static const char NO_GLASS[] = "#version 3.7; camera { location -4*z look_at 0 } sphere { 0, 1 pigment { rgb 1 } }"
                               "disc { 5*y, y, .3 texture { pigment { rgb 1 } finish { diffuse 0 emission 9 } } }";

static Caustics *make_guide(const Scene *scene, int nthreads)
{
    Caustics *caustics;
    Accel *accel;
    Lights *lights;
    assert_int_equal(accel_create(&accel, scene, nthreads, NULL), 0);
    assert_int_equal(lights_create(&lights, scene, NULL), 0);
    assert_int_equal(caustics_create(&caustics, scene, accel, lights, 1 << 20, nthreads, NULL, NULL), 0);
    lights_close(&lights);
    accel_close(&accel);
    return caustics;
}

/* A budget that is stopped ends the tracing of photons. */
static void budget_ends_it(void **state)
{
    (void)state;
    Scene *scene = test_scene(LENS);
    Caustics *caustics;
    Accel *accel;
    Lights *lights;
    RetexBudget *budget;
    assert_int_equal(retex_budget_create(&budget, NULL), 0);
    retex_budget_stop(budget);
    assert_int_equal(accel_create(&accel, scene, 1, NULL), 0);
    assert_int_equal(lights_create(&lights, scene, NULL), 0);
    assert_int_equal(caustics_create(&caustics, scene, accel, lights, 1L << 40, 2, budget, NULL), RETEX_ESTOPPED);
    assert_null(caustics);
    lights_close(&lights);
    accel_close(&accel);
    scene_close(&scene);
    retex_budget_close(&budget);
}

/* Points on the floor below the ball that have a cell; returns how many. */
static int guided_points(const Caustics *caustics, Vec3 *points, int most)
{
    int n = 0;
    for (int k = 0; k < 400 && n < most; k++) {
        Vec3 p = vec3(-1 + 0.1 * (k % 20), 0, -1 + 0.1 * (double)(k / 20));
        if (caustics_find(caustics, p))
            points[n++] = p;
    }
    return n;
}

/* A direction of a grid of equal solid angles. */
static Vec3 grid_direction(int i, int j, int n)
{
    double z = 1 - 2 * (i + 0.5) / n, turn = 2 * PI * (j + 0.5) / n, r = sqrt(1 - z * z);
    return vec3(r * cos(turn), z, r * sin(turn));
}

/* In quarters of the sphere; lobes are made broad enough for a grid. */
static void density_is_that_of_samples(void **state)
{
    (void)state;
    enum { N = 600, SAMPLES = 20000, PARTS = 4 };
    Scene *scene = test_scene(LENS);
    Caustics *caustics = make_guide(scene, 2);
    Vec3 points[400];
    int n, seen = 0;
    assert_non_null(caustics);
    n = guided_points(caustics, points, 400);
    assert_true(n > 20);
    for (int k = 0; k < n; k += n / 6) {
        CausticsCell cell = *caustics_find(caustics, points[k]);
        double sum[PARTS] = {0}, total = 0;
        int found[PARTS] = {0};
        Sampler sampler = sampler_start(3, (uint32_t)k, 0, 0);
        for (int l = 0; l < cell.nlobes; l++)
            cell.concentration[l] = fminf(cell.concentration[l], 300);
        for (int i = 0; i < N; i++)
            for (int j = 0; j < N; j++) {
                Vec3 d = grid_direction(i, j, N);
                double density = caustics_density(&cell, points[k], d) * 4 * PI / (N * N);
                sum[(d.x > 0) + 2 * (d.z > 0)] += density, total += density;
            }
        for (uint32_t s = 0; s < SAMPLES; s++) {
            float u[4];
            sampler.sample = s;
            sampler_pair(&sampler, 0, &u[0], &u[1]);
            sampler_pair(&sampler, 1, &u[2], &u[3]);
            Vec3 d = caustics_sample(&cell, points[k], u[0], u[2], u[3]);
            assert_true(fabs(vec_dot(d, d) - 1) < 1e-9);
            found[(d.x > 0) + 2 * (d.z > 0)]++;
        }
        if (fabs(total - 1) > 0.01)
            fail_msg("point %d: the density adds up to %.5f", k, total);
        for (int p = 0; p < PARTS; p++)
            if (fabs(sum[p] - (double)found[p] / SAMPLES) > 0.02)
                fail_msg("point %d: %.4f of the density, %.4f of the samples", k, sum[p], (double)found[p] / SAMPLES);
        seen++;
    }
    assert_true(seen >= 6);
    caustics_close(&caustics);
    scene_close(&scene);
}

static void same_for_any_threads(void **state)
{
    (void)state;
    Scene *scene = test_scene(LENS);
    Caustics *one = make_guide(scene, 1), *seven = make_guide(scene, 7);
    Vec3 points[400];
    int n = guided_points(one, points, 400);
    for (int k = 0; k < n; k++) {
        const CausticsCell *a = caustics_find(one, points[k]), *b = caustics_find(seven, points[k]);
        assert_non_null(b);
        assert_memory_equal(a, b, sizeof *a);
        assert_true(a->share > 0 && a->share <= 0.5f);
    }
    caustics_close(&one);
    caustics_close(&seven);
    scene_close(&scene);
}

static void nothing_without_glass(void **state)
{
    (void)state;
    Scene *scene = test_scene(NO_GLASS);
    assert_null(make_guide(scene, 1));
    scene_close(&scene);
}

static RetexSet *render(const Scene *scene, int spp, int without, int nthreads)
{
    RenderParams p = RENDER_PARAMS_INIT;
    RetexSet *set = NULL;
    RetexError err = {0};
    p.width = 32, p.height = 24, p.spp = spp, p.plain = 1, p.nthreads = nthreads, p.caustics_guide = !without;
    if (render_scene(&set, scene, &p, NULL, &err))
        fail_msg("%s", err.message);
    return set;
}

static double mean_of(const RetexSet *set)
{
    const RetexImage *image = &set->parts[0].image;
    double sum = 0;
    for (size_t i = 0; i < (size_t)32 * 24 * 3; i++)
        sum += image->pixels[i] / (32.0 * 24 * 3);
    return sum;
}

static void mean_stays(void **state)
{
    (void)state;
    Scene *scene = test_scene(LENS);
    RetexSet *guided = render(scene, 2048, 0, 0), *chance = render(scene, 2048, 1, 0);
    double a = mean_of(guided), b = mean_of(chance);
    if (fabs(a - b) > 0.004 * b)
        fail_msg("mean %.5f with the guide, %.5f without", a, b);
    retex_set_close(&guided);
    retex_set_close(&chance);
    guided = render(scene, 16, 0, 1), chance = render(scene, 16, 0, 7);
    assert_memory_equal(guided->parts[0].image.pixels, chance->parts[0].image.pixels, 32 * 24 * 3 * sizeof(float));
    retex_set_close(&guided);
    retex_set_close(&chance);
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(density_is_that_of_samples),
        cmocka_unit_test(same_for_any_threads),
        cmocka_unit_test(nothing_without_glass),
        cmocka_unit_test(budget_ends_it),
        cmocka_unit_test(mean_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
