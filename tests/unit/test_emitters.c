/* Emitters of shapes that are not sampled by area: paths find them by themselves, and the light is that of the same
 * shape where it is sampled. */
#include <stdio.h>
#include "lib_scene_text.h"
#include <cmocka.h>
#include "render/render.h"

enum { SIDE = 24, SAMPLES = 1024 };

/* The mean of a floor and a wall; the lamp itself is behind the camera. */
static double mean_light(const char *lamp)
{
    char text[2048];
    RenderParams params = RENDER_PARAMS_INIT;
    RenderStats stats = {0};
    RetexSet *set = NULL;
    RetexError err = {0};
    double sum = 0;

    snprintf(text, sizeof text,
             V37 "camera{location <0,1.5,0> look_at <0,-2,4>} plane{y,-2 pigment{rgb .5}} plane{-z,-5 pigment{rgb .7}}"
                 "object{%s pigment{rgb 1} finish{emission 3 diffuse 0} translate <0,1.5,-2.5>}",
             lamp);
    Scene *scene = parse(text);
    params.width = params.height = SIDE;
    params.spp = SAMPLES;
    params.nthreads = 1;
    test_must(render_scene(&set, scene, &params, &stats, &err), &err);
    for (int i = 0; i < SIDE * SIDE; i++)
        sum += (double)set->parts[0].image.pixels[(size_t)i * (size_t)set->parts[0].image.channels];
    retex_set_close(&set);
    scene_close(&scene);
    return sum / (SIDE * SIDE);
}

static void light_is_that_of_a_sampled_shape(void **unused)
{
    static const char *const balls[] = {
        "superellipsoid{<1,1>",
        "blob{threshold .5 sphere{0,1.8477590650225735,1}",
        ("lathe{bezier_spline 8, <0,-1>,<0.5522847498,-1>,<1,-0.5522847498>,<1,0>,"
         "<1,0>,<1,0.5522847498>,<0.5522847498,1>,<0,1>"),
        "isosurface{function{x*x+y*y+z*z-1} contained_by{box{-1.1,1.1}} max_gradient 4",
    };
    const double expected = mean_light("sphere{0,1}");

    (void)unused;
    for (size_t i = 0; i < sizeof balls / sizeof *balls; i++) {
        char lamp[512];
        snprintf(lamp, sizeof lamp, "%s}", balls[i]);
        const double mean = mean_light(lamp);
        print_message("# %.20s %.5f, sampled %.5f\n", balls[i], mean, expected);
        assert_true(fabs(mean - expected) < 0.015 * expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_is_that_of_a_sampled_shape),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
