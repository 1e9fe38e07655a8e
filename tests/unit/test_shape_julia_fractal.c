/* julia_fractal: crossings as POV-Ray's trace() finds them, inside() against iterations written out, and crossings
 * against inside(). */
#include "lib_scene_text.h"
#include "lib_shape.h"
#include "shape/surface.h"

#include <stdio.h>
#include <string.h>

/* Values of POV-Ray 3.7.0.10, which is as exact as a step of its search. */
static void test_against_povray(void **state)
{
    static const struct {
        const char *options;
        double x, y, z; /* where rays along the axes enter, from -6 */
    } cases[] = {{"hypercomplex sin max_iteration 2", -3.99375, -2.10775, -1.96775},
                 {"hypercomplex sin max_iteration 3", -3.99375, -1.54775, -1.14775},
                 {"hypercomplex exp max_iteration 3", -3.99375, -3.99175, -3.99375},
                 {"pwr(2.5,.5) max_iteration 4 hypercomplex", -.61575, -.74775, -1.24775}};
    (void)state;
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        char text[200];
        snprintf(text, sizeof text, V37 "julia_fractal{<.1,.2,-.3,.15> %s precision 500}", cases[n].options);
        Scene *scene = parse(text);
        const Ray rays[3] = {{vec3(-6, .1, .2), vec3(1, 0, 0), 0, 100},
                             {vec3(.1, -6, .2), vec3(0, 1, 0), 0, 100},
                             {vec3(.1, .2, -6), vec3(0, 0, 1), 0, 100}};
        const double expected[3] = {cases[n].x, cases[n].y, cases[n].z};
        for (int k = 0; k < 3; k++) {
            double t;
            int face;
            assert_true(shape_intersect(only(scene), &rays[k], &t, &face));
            if (fabs(t - 6 - expected[k]) > 0.0025)
                fail_msg("%s, axis %d: %.6f, not %.6f", cases[n].options, k, t - 6, expected[k]);
        }
        scene_close(&scene);
    }
}

/* Normals of trace() of POV-Ray 3.7.0.10. */
static void test_normals_against_povray(void **state)
{
    static const struct {
        const char *options;
        double x[3], y[3], z[3]; /* where rays along the axes enter, from -6 */
    } cases[] = {
        {"sqr max_iteration 4", {-.92377, -.25085, .28936}, {.31718, -.92577, .20579}, {.28197, .17553, -.94323}},
        {"cube max_iteration 3", {-.89989, .43156, -.06292}, {.02534, -.96523, .26016}, {.11544, .14632, -.98248}},
        {"hypercomplex sqr max_iteration 4",
         {-.88638, -.32567, .32905},
         {.08033, -.70485, .70479},
         {.12303, .70171, -.70176}}};
    (void)state;
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        char text[400];
        snprintf(text, sizeof text,
                 V37 "#declare J = julia_fractal{<.1,.2,-.3,.15> %s precision 2000} #declare N = <0,0,0>;"
                     "#declare P = trace(J, <-6,.1,.2>, x, N); light_source{N, 1}"
                     "#declare P = trace(J, <.1,-6,.2>, y, N); light_source{N, 1}"
                     "#declare P = trace(J, <.1,.2,-6>, z, N); light_source{N, 1}",
                 cases[n].options);
        Scene *scene = parse(text);
        const double *expected[3] = {cases[n].x, cases[n].y, cases[n].z};
        assert_int_equal(scene->nlights, 3);
        for (int k = 0; k < 3; k++) {
            const Vec3 is = scene->lights[k].location;
            const Vec3 wanted = vec3(expected[k][0], expected[k][1], expected[k][2]);
            if (vec_length(vec_sub(is, wanted)) > 0.005)
                fail_msg("%s, axis %d: %.5f %.5f %.5f", cases[n].options, k, is.x, is.y, is.z);
        }
        scene_close(&scene);
    }
}

/* Quaternions by their product. */
static void product(const double a[4], const double b[4], double out[4])
{
    out[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    out[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
    out[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
    out[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

static int stays_small(Vec3 p, int cube, int iterations)
{
    static const double c[4] = {.1, .2, -.3, .15};
    double z[4] = {p.x, p.y, p.z, (.25 - .1 * p.x - .2 * p.y - .3 * p.z) / .8}, radius = 1 + sqrt(.1625);
    for (int k = 0; k < iterations; k++) {
        double power[4], more[4];
        if (z[0] * z[0] + z[1] * z[1] + z[2] * z[2] + z[3] * z[3] > radius * radius)
            return 0;
        product(z, z, power);
        if (cube) {
            product(power, z, more);
            memcpy(power, more, sizeof power);
        }
        for (int i = 0; i < 4; i++)
            z[i] = power[i] + c[i];
    }
    return vec_length(p) <= radius;
}

static void test_iterations(void **state)
{
    uint32_t random = 9;
    (void)state;
    for (int cube = 0; cube < 2; cube++) {
        char text[200];
        int within = 0;
        snprintf(text, sizeof text, V37 "julia_fractal{<.1,.2,-.3,.15> %s max_iteration 5 slice <.1,.2,.3,.8>,.25}",
                 cube ? "cube" : "quaternion");
        Scene *scene = parse(text);
        for (int i = 0; i < 20000; i++) {
            const Vec3 p = vec_scale(test_direction(&random), 1.5 * test_random(&random));
            const int wanted = stays_small(p, cube, 5);
            assert_int_equal(test_inside(only(scene), p), wanted);
            within += wanted;
        }
        assert_true(within > 2000 && within < 18000);
        scene_close(&scene);
    }
}

/* Rays find as many crossings as inside() has changes along them. The search steps by a thousandth of a ray
 * (precision 1000), so the surfaces are ones that are smooth at that step; a crossing is right to two steps. */
static void expect_crossings(const char *kind, double size, double scale, double moved)
{
    enum { RAYS = 60 };
    uint32_t random = 3;
    char text[300];
    snprintf(text, sizeof text, V37 "julia_fractal{<.1,.2,-.3,.15> %s precision 1000 scale %g rotate 30 translate %g}",
             kind, scale, moved);
    Scene *scene = parse(text);
    const Primitive *p = only(scene);
    const Vec3 middle = transform_point(&p->transform, vec3(0, 0, 0));
    const int found = test_shape_crossings(p, middle, size * scale, RAYS, 2e-3, &random);
    if (found < RAYS / 3)
        fail_msg("%s, scale %g: %d crossings on %d rays", kind, scale, found, RAYS);
    scene_close(&scene);
}

/* At any scale, and away from the origin. */
static void test_crossings(void **state)
{
    static const double scales[] = {1e-4, 1, 1e5};
    (void)state;
    for (size_t k = 0; k < sizeof scales / sizeof *scales; k++) {
        expect_crossings("sqr max_iteration 5", 1.4, scales[k], 0);
        expect_crossings("sqr max_iteration 2", 1.4, scales[k], 0);
        expect_crossings("hypercomplex sinh max_iteration 3", 4, scales[k], 0);
    }
    expect_crossings("sqr max_iteration 5", 1.4, 1, 30);
}

/* How many points of the ray, a thousandth apart, are inside in a row. */
static int steps_inside(const Primitive *p, Ray ray)
{
    int run = 0, longest = 0;

    for (int k = 0; k < 6000; k++) {
        run = test_inside(p, vec_mad(ray.origin, ray.direction, 1e-3 * k)) ? run + 1 : 0;
        longest = run > longest ? run : longest;
    }
    return longest;
}

/* At the rim of a set of few iterations, which is larger than that of many: rays that are inside for four of the
 * shape's steps hit it. */
static void test_grazing_rays(void **state)
{
    (void)state;
    for (int iterations = 2; iterations <= 5; iterations++) {
        char text[200];
        Ray ray = {vec3(1.5, 0.7, -3), vec3(0, 0, 1), 0, INFINITY};
        int grazing = 0, face;
        double t;
        snprintf(text, sizeof text, V37 "julia_fractal{<.1,.2,-.3,.15> sqr max_iteration %d precision 1000}",
                 iterations);
        Scene *scene = parse(text);
        const Primitive *p = only(scene);
        while (!steps_inside(p, ray))
            ray.origin.x -= 0.005;
        for (int i = 0; i < 100; i++) {
            ray.origin.x += 1e-4 * (i < 50 ? 1 : -3);
            const int steps = steps_inside(p, ray);
            grazing += steps >= 4;
            if (steps >= 4 && !shape_intersect(p, &ray, &t, &face))
                fail_msg("%d iterations: a ray at %g misses, inside for %d steps", iterations, ray.origin.x, steps);
        }
        assert_true(grazing > 20);
        scene_close(&scene);
    }
}

static void test_errors(void **state)
{
    (void)state;
    expect_error(V37 "julia_fractal{<.1,.2,-.3,.15> sin}", "quaternions have sqr and cube only");
    expect_error(V37 "julia_fractal{<.1,.2,-.3,.15> max_iteration 0}", "max_iteration 0");
    expect_error(V37 "julia_fractal{<.1,.2,-.3,.15> precision 0}", "a precision of 0");
    expect_error(V37 "julia_fractal{<.1,.2,-.3,-1e308> cube}", "its numbers must be below 1e+09");
    expect_error(V37 "julia_fractal{<.1,.2,-.3,.15> slice <1,0,0,0>,1}", "the fourth number of slice");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_povray), cmocka_unit_test(test_normals_against_povray),
        cmocka_unit_test(test_iterations),     cmocka_unit_test(test_crossings),
        cmocka_unit_test(test_grazing_rays),   cmocka_unit_test(test_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
