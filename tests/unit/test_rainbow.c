/* Rainbows: what POV-Ray 3.7 shows, and the identity of retexturing. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdio.h>
#include "lib_identity.h"
#include "lib_scene_text.h"
#include "medium/rainbow.h"

/* Before the sky, or a wall as far away as that; seen at angles from the z axis and round it from y to x, in degrees.
 * Pixels of `povray +W401 +H401 -A +FE` of `camera{location 0 direction z right 2*x up 2*y}`, linear, to half floats:
 * the sky is rgb <.2,.4,.6>, the wall rgb .8. */
static const struct {
    const char *bows;
    double angle, round, distance;
    Rgb seen;
} cases[] = {
    {"rainbow{B color_map{[0 rgb x][1 rgb y]}}", 24.884, 90, INFINITY, {0.2f, 0.4f, 0.6f}},
    {"rainbow{B color_map{[0 rgb x][1 rgb y]}}", 25.585, 90, INFINITY, {0.94141f, 0.05853f, 0}},
    {"rainbow{B color_map{[0 rgb x][1 rgb y]}}", 30.265, 90, INFINITY, {0.47339f, 0.52637f, 0}},
    {"rainbow{B color_map{[0 rgb x][1 rgb y]}}", 34.539, 90, INFINITY, {0.04611f, 0.95410f, 0}},
    {"rainbow{B color_map{[0 rgb x][1 rgb y]}}", 35.116, 90, INFINITY, {0.2f, 0.4f, 0.6f}},
    {"rainbow{B color_map{[0 rgbt <1,0,.5,.3>]}}", 30.901, 90, INFINITY, {0.75977f, 0.12f, 0.52979f}},
    {"rainbow{B color_map{[0 rgbf <1,0,.5,.3>]}}", 30.901, 90, INFINITY, {1, 0, 0.5f}},
    {"rainbow{B color_map{[0 rgbft <1,0,.5,.3,.2>]}}", 30.901, 90, INFINITY, {0.83984f, 0.06079f, 0.50537f}},
    {"rainbow{B distance 10 color_map{[0 rgb <1,0,.5>]}}", 30.901, 90, 8, {0.92139f, 0.31494f, 0.61816f}},
    {"rainbow{B distance 10 color_map{[0 rgbft <1,0,.5,.3,.2>]}}", 30.901, 90, 8, {0.92139f, 0.25757f, 0.58936f}},
    {"rainbow{B color_map{[0 rgbt <1,0,.5,.3>]}} rainbow{B color_map{[0 rgbt <0,1,.1,.6>]}}",
     30.901,
     90,
     INFINITY,
     {0.43994f, 0.37988f, 0.46509f}},
    {"rainbow{B color_map{[0 rgbft <1,0,.5,.3,.2>]}} rainbow{B color_map{[0 rgbft <0,1,.1,.6,.3>]}}",
     30.901,
     90,
     INFINITY,
     {0.4375f, 0.44043f, 0.34375f}},
    {"rainbow{B arc_angle 120 falloff_angle 30 color_map{[0 rgb <1,0,.5>]}}", 30, 9.95, INFINITY, {1, 0, 0.5f}},
    {"rainbow{B arc_angle 120 falloff_angle 30 color_map{[0 rgb <1,0,.5>]}}",
     30,
     25.02,
     INFINITY,
     {0.89893f, 0.05063f, 0.51270f}},
    {"rainbow{B arc_angle 120 falloff_angle 30 color_map{[0 rgb <1,0,.5>]}}",
     30,
     -45,
     INFINITY,
     {0.40747f, 0.29639f, 0.57422f}},
    {"rainbow{B arc_angle 120 falloff_angle 30 color_map{[0 rgb <1,0,.5>]}}", 30, 64.98, INFINITY, {0.2f, 0.4f, 0.6f}},
    {"rainbow{B arc_angle 120 color_map{[0 rgb <1,0,.5>]}}", 30, 59.89, INFINITY, {1, 0, 0.5f}},
    {"rainbow{B arc_angle 120 color_map{[0 rgb <1,0,.5>]}}", 30, 64.98, INFINITY, {0.2f, 0.4f, 0.6f}},
    {"rainbow{B arc_angle 360 falloff_angle 180 color_map{[0 rgbft <1,0,.5,.4,.3>]}}",
     30,
     135,
     INFINITY,
     {0.47998f, 0.22363f, 0.53760f}},
    {"rainbow{B color_map{[0 rgb <1,0,.5>]}}", 30, 180, INFINITY, {1, 0, 0.5f}},
};

/* In front of the wall or the sky; u for jitter. */
static Rgb seen(const Scene *scene, double angle, double around, double distance, double u)
{
    const double a = angle * PI / 180, r = around * PI / 180;
    const Ray ray = {{0, 0, 0}, {sin(a) * sin(r), sin(a) * cos(r), cos(a)}, 0, INFINITY};
    Rgb passing, own, behind = isfinite(distance) ? rgb_grey(0.8f) : rgb(0.2f, 0.4f, 0.6f);
    if (!rainbow_transmittance(scene, &ray, distance / cos(a), u, &passing, &own))
        return behind;
    return rgb_add(rgb_mul(passing, behind), own);
}

static void assert_rgb(Rgb a, Rgb b, double tolerance)
{
    assert_float_equal(a.r, b.r, tolerance);
    assert_float_equal(a.g, b.g, tolerance);
    assert_float_equal(a.b, b.b, tolerance);
}

#define BOW "#declare B = rainbow{direction 3*z angle 30 width 10};"

static void rainbows_are_those_of_povray(void **state)
{
    char text[1024];
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        snprintf(text, sizeof text, V37 BOW "%s sphere{99,1}", cases[k].bows);
        Scene *scene = parse(text);
        assert_rgb(seen(scene, cases[k].angle, cases[k].round, cases[k].distance, 0.5), cases[k].seen, 8e-4);
        scene_close(&scene);
    }
}

/* The place in the map varies by as much as jitter to either side. */
static void jitter_moves_the_color(void **state)
{
    (void)state;
    Scene *scene = parse(V37 BOW "rainbow{B jitter .2 color_map{[0 rgb x][1 rgb y]}} sphere{99,1}");
    assert_rgb(seen(scene, 30, 0, INFINITY, 0.5), rgb(0.5f, 0.5f, 0), 1e-4);
    assert_rgb(seen(scene, 30, 0, INFINITY, 0), rgb(0.7f, 0.3f, 0), 1e-4);
    assert_rgb(seen(scene, 30, 0, INFINITY, 1), rgb(0.3f, 0.7f, 0), 1e-4);
    assert_rgb(seen(scene, 34, 0, INFINITY, 0.9), rgb(0.2f, 0.4f, 0.6f), 1e-6);
    scene_close(&scene);
}

/* None shows where it has no colours or no width, nor behind the viewer. */
static void some_are_not_there(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "rainbow{direction z angle 30 width 10} rainbow{direction z color_map{[0 rgb 1]}}"
                             "rainbow{direction z width 9 distance 0 color_map{[0 rgb 1]}} sphere{99,1}");
    assert_null(scene->rainbows);
    scene_close(&scene);
    scene = parse(V37 "rainbow{direction z angle 100 width 40 color_map{[0 rgb 1]}} sphere{99,1}");
    assert_rgb(seen(scene, 89, 30, INFINITY, 0.5), rgb_grey(1), 1e-6);
    assert_rgb(seen(scene, 91, 30, INFINITY, 0.5), rgb(0.2f, 0.4f, 0.6f), 1e-6);
    scene_close(&scene);
    expect_error(V37 "rainbow{angle 30 width 10 color_map{[0 rgb 1]}}", "a rainbow needs a direction");
    expect_error(V37 "rainbow{direction y angle 30 width 10 color_map{[0 rgb 1]}}", "lies along its direction");
    expect_error(V37 "rainbow{direction z arc_angle 120 falloff_angle 150}", "falloff_angle is larger than arc_angle");
}

/* Over a wall and a mirror that shows it: what is seen of a target through a rainbow keeps its coefficients. */
static void sets_recombine(void **state)
{
    (void)state;
    assert_identity("#version 3.7; global_settings { assumed_gamma 1 }\n"
                    "camera { location <0,1,-4> look_at 0 angle 60 } background { rgb <.6,.7,1> }\n"
                    "light_source { <3,5,-4>, 1 }\n"
                    "rainbow { direction z angle 12 width 20 distance 4 jitter .1\n"
                    "  color_map { [0 rgbf <1,.2,.1,.5>] [1 rgbt <.1,.3,1,.2>] } }\n"
                    "#declare Floor = pigment { rgb <.3,.5,.7> }\n"
                    "plane { y, -1 pigment { Floor } }\n"
                    "plane { -z, -2 pigment { rgb .5 } finish { diffuse .3 reflection .5 } }\n",
                    "Floor", 32, 7);
}

/* Mirrors show it, and light that scatters widely does not see it. */
static void mirrors_show_it(void **state)
{
    static const char *const finishes[] = {"diffuse 0 reflection 1", "diffuse 1"};
    double mean[3];
    char text[1024];
    (void)state;
    for (int k = 0; k < 2; k++) {
        snprintf(text, sizeof text,
                 "#version 3.7; global_settings { assumed_gamma 1 }\n"
                 "camera { orthographic location 0 direction z right .1*x up .1*y } background { rgb .5 }\n"
                 "rainbow { direction -z width 170 angle 42 distance 1e7 color_map { [0 rgb x] [1 rgb x] } }\n"
                 "plane { -z, -2 pigment { rgb 1 } finish { %s } }\n",
                 finishes[k]);
        RetexSet *set = render_text(text, 4, 3, 256, 1, 4);
        mean_color(set, mean);
        assert_float_equal(mean[0], k ? 0.5 : 1, 0.02);
        assert_float_equal(mean[1], k ? 0.5 : 0, 0.02);
        retex_set_close(&set);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rainbows_are_those_of_povray),
        cmocka_unit_test(jitter_moves_the_color),
        cmocka_unit_test(some_are_not_there),
        cmocka_unit_test(sets_recombine),
        cmocka_unit_test(mirrors_show_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
