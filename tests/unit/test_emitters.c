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

/* Irradiance at 0, with normal y, of a polygon of radiance 1: Lambert's formula. */
static double polygon_light(const Vec3 *corners, int count)
{
    double sum = 0;
    for (int k = 0; k < count; k++) {
        const Vec3 a = vec_normalize(corners[k]), b = vec_normalize(corners[(k + 1) % count]), n = vec_cross(a, b);
        sum += acos(vec_dot(a, b)) * n.y / vec_length(n);
    }
    return fabs(sum) / 2;
}

/* A mesh shines as far as its pigment is opaque, as POV-Ray's finishes do. */
static void transparent_meshes_shine_less(void **unused)
{
    static const struct {
        const char *pigment;
        double opacity, color[3];
    } cases[] = {{"rgb <1,.5,.25>", 1, {1, 0.5, 0.25}},
                 {"rgbt <1,.5,.25,.6>", 0.4, {1, 0.5, 0.25}},
                 {"rgbf <.8,.5,1,.3>", 0.7, {0.8, 0.5, 1}},
                 {"rgbft <1,.5,.25,.3,.2>", 0.5, {1, 0.5, 0.25}}};
    const Vec3 corners[4] = {vec3(-1, 2, -1), vec3(1, 2, -1), vec3(1, 2, 1.5), vec3(-1, 2, 1.5)};
    const double irradiance = polygon_light(corners, 4), albedo = 0.5, emission = 3;
    (void)unused;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[1024];
        RenderParams params = RENDER_PARAMS_INIT;
        RenderStats stats = {0};
        RetexError err = {0};
        RetexSet *set = NULL;
        snprintf(text, sizeof text,
                 V37 "camera{orthographic location <0,.5,-4> look_at 0 right .001*x up .001*y}"
                     "plane{y,0 pigment{rgb .5} finish{diffuse 1 ambient 0}}"
                     "mesh{triangle{<-1,2,-1>,<1,2,-1>,<1,2,1.5>} triangle{<-1,2,-1>,<1,2,1.5>,<-1,2,1.5>}"
                     "  pigment{%s} finish{emission 3 diffuse 0 ambient 0}}",
                 cases[k].pigment);
        Scene *scene = parse(text);
        params.width = params.height = 1, params.spp = 16384, params.max_depth = 2, params.nthreads = 1;
        params.plain = 1;
        test_must(render_scene(&set, scene, &params, &stats, &err), &err);
        for (int c = 0; c < 3; c++) {
            const double light = emission * cases[k].opacity * cases[k].color[c] * irradiance * albedo / PI;
            assert_float_equal((double)set->parts[0].image.pixels[c] / light, 1, 0.01);
        }
        retex_set_close(&set);
        scene_close(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_is_that_of_a_sampled_shape),
        cmocka_unit_test(transparent_meshes_shine_less),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
