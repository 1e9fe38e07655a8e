/* Subsurface scattering: furnaces of many shapes, the edge of a shadow against a random walk of the test's own, and the
 * identity of retexturing. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdio.h>
#include "lib_identity.h"
#include "path/sampler.h"

#define HEAD "#version 3.7; global_settings { assumed_gamma 1 mm_per_unit 20 subsurface {} }\n"

static void expect(double value, double wanted, double tolerance, const char *what)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%s: %.6f, should be %.6f within %g", what, value, wanted, tolerance);
}

/* All that goes in comes out: white shapes vanish under a white sky, closed or not. */
static void furnace_is_white(void **state)
{
    static const char *const shapes[] = {
        "sphere { 0, 1",
        "box { <-1,-1,-.02>, <1,1,.02>",
        "plane { -z, 0",
        "disc { 0, -z, 1",
        "union { sphere { -.4*x, .8 } sphere { .4*x, .8 }",
        "mesh { triangle { <-1,-1,0>, <1,-1,0>, <0,1,0> }",
    };
    char text[1024];
    double mean[3];
    (void)state;
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++) {
        snprintf(text, sizeof text,
                 HEAD "camera { location <1,2,-5> look_at 0 angle 20 } background { rgb 1 }\n"
                      "%s pigment { rgb 1 } finish { ambient 0 diffuse 1 subsurface { translucency <6,2,1> } } }\n",
                 shapes[k]);
        RetexSet *set = render_text(text, 16, 12, 256, 1, 200);
        mean_color(set, mean);
        for (int c = 0; c < 3; c++)
            expect(mean[c], 1, 0.012, shapes[k]);
        retex_set_close(&set);
    }
}

/* ---- the edge of a shadow ---- */

enum { WALKS = 200000 };
static uint32_t counter;
static double number(void)
{
    return (double)unit_float(hash_mix(++counter * 2654435761u));
}

/* Where a walk in a half-space comes out along x, in mean free paths, from where it went in; or NAN. */
static double walk_out(void)
{
    double x = 0, y = 0, angle = 2 * PI * number();
    double cosine = -sqrt(1 - number()), sine = sqrt(1 - cosine * cosine);
    for (;;) {
        const double length = -log(1 - number());
        if (y + length * cosine >= 0)
            return x - y / cosine * sine * cos(angle);
        x += length * sine * cos(angle), y += length * cosine;
        if (number() > 0.9901)
            return NAN;
        cosine = 1 - 2 * number(), sine = sqrt(1 - cosine * cosine), angle = 2 * PI * number();
    }
}

/* A plane under parallel light, half of it in the shadow of a box. What is seen at x is the share of walks from there
 * that come out where light is. Mean free paths are .2, .1 and .05. */
static void shadows_are_soft_by_the_walk(void **state)
{
    static const double lengths[3] = {0.2, 0.1, 0.05};
    enum { WIDTH = 8 };
    double *out = malloc(WALKS * sizeof *out);
    int count = 0;
    (void)state;
    for (int k = 0; k < WALKS; k++) {
        out[count] = walk_out();
        count += !isnan(out[count]);
    }
    expect((double)count / WALKS, 0.8, 0.01, "albedo of a half-space"); /* NEUTRAL_ALBEDO */
    RetexSet *set = render_text(
        HEAD "camera { orthographic location y direction -y right .8*x up .1*z }\n"
             "light_source { 9*y, 1 parallel point_at 0 }\n"
             "box { <-9,2,-9>, <0,3,9> pigment { rgb 0 } finish { diffuse 0 } no_image }\n"
             "plane { y, 0 pigment { rgb .5 } finish { ambient 0 diffuse 1 subsurface { translucency <4,2,1> } } }\n",
        WIDTH, 1, 32768, 1, 3);
    const RetexImage *image = &set->parts[0].image;
    for (int x = 0; x < WIDTH; x++) {
        double wanted[3] = {0};
        for (int k = 0; k < count; k++) /* pixels are filtered: walks begin anywhere in one */
            for (int c = 0; c < 3; c++)
                wanted[c] += ((x + (k + 0.5) / count) / WIDTH - 0.5) * 0.8 + out[k] * lengths[c] > 0;
        for (int c = 0; c < 3; c++)
            expect((double)image->pixels[retex_image_index(image, x, 0) + (size_t)c], 0.5 * wanted[c] / count, 0.01,
                   "near the edge of a shadow");
    }
    retex_set_close(&set);
    free(out);
}

/* The texture is as sharp as without: black is where the pigment is black. */
static void color_is_where_light_leaves_to_the_eye(void **state)
{
    (void)state;
    RetexSet *set =
        render_text(HEAD "camera { orthographic location y direction -y right .8*x up .6*z } background { rgb 1 }\n"
                         "plane { y, 0 pigment { gradient x color_map { [.5 rgb 1] [.5 rgb 0] } }\n"
                         "  finish { ambient 0 diffuse 1 subsurface { translucency 2 } } }\n",
                    8, 6, 64, 1, 3);
    const RetexImage *image = &set->parts[0].image;
    for (int y = 0; y < 6; y++)
        for (int x = 0; x < 8; x++) /* gradient from x = -.4 on: black above .5 of each unit */
            expect((double)image->pixels[retex_image_index(image, x, y)], x < 4 ? 0 : 1, 0.3, "half of the plane");
    expect((double)image->pixels[retex_image_index(image, 2, 3)], 0, 0, "black half");
    retex_set_close(&set);
}

static void is_off_without_the_block(void **state)
{
    static const char *const heads[] = {"subsurface {}", "", "mm_per_unit 40 subsurface { samples 9, 9 }"};
    static const float wanted[] = {0.3f, 0, 0.075f};
    char text[512];
    (void)state;
    for (int k = 0; k < 3; k++) {
        snprintf(text, sizeof text,
                 "#version 3.7; global_settings { %s } camera { location -5*z } light_source { -9*z, 1 }\n"
                 "sphere { 0, 1 pigment { rgb 1 } finish { subsurface { translucency 3 } } }",
                 heads[k]);
        Scene *scene = test_scene(text);
        const Finish *finish = scene->primitives[0].texture->finish;
        assert_float_equal(finish->mean_free_path.g, wanted[k], 1e-6);
        assert_int_equal(finish->matte, k == 1);
        scene_close(&scene);
    }
}

static void sets_recombine(void **state)
{
    (void)state;
    assert_identity(HEAD "camera { location <0,1,-4> look_at 0 angle 50 } background { rgb <.6,.7,1> }\n"
                         "light_source { <3,5,-4>, 1 }\n"
                         "#declare Skin = pigment { rgb <.7,.5,.3> }\n"
                         "#declare Soft = finish { diffuse .8 specular .3 subsurface { translucency <6,3,2> } }\n"
                         "plane { y, -1 pigment { Skin } }\n"
                         "sphere { 0, 1 pigment { Skin } finish { Soft } }\n"
                         "box { <1,-1,-1>, <1.2,1,1> pigment { rgb .7 } finish { Soft } }\n",
                    "Skin", 32, 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(furnace_is_white),
        cmocka_unit_test(shadows_are_soft_by_the_walk),
        cmocka_unit_test(color_is_where_light_leaves_to_the_eye),
        cmocka_unit_test(is_off_without_the_block),
        cmocka_unit_test(sets_recombine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
