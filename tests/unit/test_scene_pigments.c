/* Pigments as the scene language builds them: colours of tests/data/pigments.txt, which POV-Ray gave
 * (tests/lib/povray_pigments.py), and of its pictures; the space in which colours blend; and what maps of pigments and
 * nested patterns must bear. */
#include "lib_scene_text.h"

#include <retex/color.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "shade/pigment.h"
#include "shape/surface.h"

/* POV-Ray prints floats. */
static int same_color(const double *expected, Rgbft c)
{
    const float got[5] = {c.r, c.g, c.b, c.filter, c.transmit};
    for (int i = 0; i < 5; i++)
        if (!(fabs(got[i] - expected[i]) <= 2e-6 * (1 + fabs(expected[i]))))
            return 0;
    return 1;
}

static void colors_are_povray(void **state)
{
    static char line[4096], text[8192];
    char body[4096] = "";
    Scene *scene = NULL;
    int bodies = 0, wrong = 0;
    FILE *file = fopen("tests/data/pigments.txt", "r");
    (void)state;
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        if (strncmp(line, "pigment ", 8) == 0) {
            scene_close(&scene);
            snprintf(body, sizeof body, "%s", line + 8);
            snprintf(text, sizeof text, V37 "sphere { 0, 1 pigment { %s } }", body);
            scene = parse(text);
            bodies++;
            if (messages[0])
                fail_msg("%s: %s", body, messages);
            continue;
        }
        double v[8];
        char *end = line;
        for (int i = 0; i < 8; i++)
            v[i] = strtod(end, &end);
        const Rgbft c = color_at(only(scene), v[5], v[6], v[7]);
        if (!same_color(v, c) && wrong++ < 20)
            print_message("%s    at %g %g %g: %.8g %.8g %.8g %.8g %.8g, POV-Ray %s", body, v[5], v[6], v[7],
                          (double)c.r, (double)c.g, (double)c.b, (double)c.filter, (double)c.transmit, line);
    }
    fclose(file);
    scene_close(&scene);
    assert_true(bodies >= 50);
    assert_int_equal(wrong, 0);
}

/* Pixels of POV-Ray's picture of the unit sphere, seen along z by parallel rays (+Q1, 16 bits). */
static void patterns_that_see_normals(void **state)
{
    static const struct {
        const char *body;
        Vec3 p;
        double value;
    } cases[] = {
        {"slope { <1,2,-1> altitude y,-1,1 } scale 2", {0.634146, 0.731707, -0.249926}, 0.84262},
        {"slope { <1,2,-1> altitude y,-1,1 } scale 2", {-0.243902, 0.146341, -0.958695}, 0.60642},
        {"slope { y, .3, .8 }", {0.634146, 0.731707, -0.249926}, 0.92255},
        {"slope { y, .3, .8 }", {0.292683, -0.341463, -0.893163}, 0.17815},
        {"aoi", {0.634146, 0.731707, -0.249926}, 0.58041},
        {"aoi", {-0.243902, 0.146341, -0.958695}, 0.90819},
        {"gradient y pigment_map { [0 slope x] [1 aoi] } scale 2", {0.634146, 0.731707, -0.249926}, 0.66807},
        {"gradient y pigment_map { [0 slope x] [1 aoi] } scale 2", {0.292683, -0.341463, -0.893163}, 0.80764},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[300];
        snprintf(text, sizeof text, V37 "sphere { 0, 1 pigment { %s } }", cases[i].body);
        Scene *scene = parse(text);
        const PatternPoint at = {cases[i].p, cases[i].p, vec3(0, 0, 1)};
        const double got = (double)pigment_eval_at(only(scene)->texture->pigment, &at, (Vec2){0, 0}).r;
        if (fabs(got - cases[i].value) > 2e-5)
            fail_msg("%s: %.6f is not %.6f", cases[i].body, got, cases[i].value);
        scene_close(&scene);
    }
}

/* What moves a texture with uv_mapping, as seen in POV-Ray's pictures: transforms where it says uv_mapping itself, or
 * in a pigment that does, and none outside of these. */
static void uv_mapping_is_moved_within(void **state)
{
    static const struct {
        const char *texture;
        double value; /* of gradient x at u = .6 */
    } cases[] = {
        {"pigment { uv_mapping gradient x scale .5 }", 0.2},
        {"texture { uv_mapping pigment { gradient x } scale .5 }", 0.2},
        {"texture { uv_mapping pigment { gradient x } translate .25*x }", 0.35},
        {"texture { uv_mapping pigment { gradient x scale .5 } }", 0.2},
        {"texture { pigment { uv_mapping gradient x } scale .5 }", 0.6},
        {"texture { uv_mapping pigment { uv_mapping gradient x scale .5 } translate .25*x }", 0.2},
        {"texture { T scale .5 }", 0.6},
        {"texture { Scaled }", 0.2},
        {"texture { Scaled translate .25*x }", 0.2},
        {"texture { T } scale .5", 0.6},
        {"texture { uv_mapping pigment { gradient x } scale .5 } translate .1*x scale 3", 0.2},
        {"pigment { uv_mapping gradient x } scale .5", 0.6},
        {"material { texture { T } scale .5 }", 0.6},
        {"material { texture { Scaled } } scale 2", 0.2},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[600];
        snprintf(text, sizeof text,
                 V37 "#declare T = texture { uv_mapping pigment { gradient x } };"
                     "#declare Scaled = texture { uv_mapping pigment { gradient x } normal { bumps } scale .5 };"
                     "sphere { 0, 1 %s }",
                 cases[i].texture);
        Scene *scene = parse(text);
        const Texture *texture = only(scene)->texture;
        const double got = (double)pigment_eval(texture->pigment, vec3(9, 9, 9), (Vec2){0.6, 0}).r;
        if (fabs(got - cases[i].value) > 1e-6)
            fail_msg("%s: %.6f is not %.6f", cases[i].texture, got, cases[i].value);
        if (texture->normal)
            assert_true(texture->normal->uv_mapping &&
                        transform_point(&texture->normal->transform, vec3(1, 0, 0)).x == 0.5);
        scene_close(&scene);
    }
}

/* An ovus has the UV of a sphere about its middle; POV-Ray's picture has .77, .40 at the first point. */
static void uv_mapping_of_an_ovus(void **state)
{
    static const double cases[2][2] = {{0.05, -0.05}, {0.35, -0.3}};
    (void)state;
    Scene *scene = parse(V37 "ovus { .6, .3 pigment { uv_mapping rgb 1 } }");
    for (int i = 0; i < 2; i++) {
        const double x = cases[i][0], y = cases[i][1], z = -sqrt(0.36 - x * x - y * y); /* of the lower sphere */
        const Ray ray = {{x, y, -5}, {0, 0, 1}, 0, INFINITY};
        const Hit hit = {.t = 5 + z, .primitive = 0};
        Surface surface;
        surface_at(&surface, scene, &ray, &hit);
        const Vec2 uv = surface_uv(&surface).uv;
        assert_near(uv.u, 1 + atan2(z, x) / (2 * PI));
        assert_near(uv.v, 0.5 + atan2(y - 0.15, hypot(x, z)) / PI);
        assert_true(i || (fabs(uv.u - 0.77) < 0.01 && fabs(uv.v - 0.40) < 0.01));
    }
    scene_close(&scene);
}

/* A function in a pattern in a function, and so on: nothing is so deep that the stack ends. */
static void nested_patterns_end(void **state)
{
    char text[16000];
    int used = snprintf(text, sizeof text, V37 "#declare F0 = function { x }\n");
    (void)state;
    for (int i = 0; i < 100; i++)
        used += snprintf(text + used, sizeof text - (size_t)used,
                         "#declare F%d = function { pattern { function { F%d(x, y, z) } } }\n", i + 1, i);
    snprintf(
        text + used, sizeof text - (size_t)used,
        "sphere { 0, 1 pigment { function { F15(x, y, z) } } } sphere { 0, 1 pigment { function { F100(x, y, z) } } }");
    Scene *scene = parse(text);
    assert_near(color_at(&scene->primitives[0], 0.5, 0, 0).r, 0.5);
    assert_near(color_at(&scene->primitives[1], 0.5, 0, 0).r, 0);
    scene_close(&scene);
}

static void density_files_are_checked(void **state)
{
    (void)state;
    expect_error(V37 "sphere { 0, 1 pigment { density_file df3 \"tests/data/palette.png\" } }", "ends early");
    expect_error(V37 "sphere { 0, 1 pigment { density_file df3 \"none.df3\" } }", "none.df3");
    expect_error(V37 "sphere { 0, 1 pigment { pavement number_of_sides 4 number_of_tiles 3 pattern 3 } }",
                 "pattern 3 of a pavement of 3 polygons of 4 sides: it has 2");
    expect_error(V37 "sphere { 0, 1 pigment { pavement number_of_tiles 7 } }", "number_of_tiles 7");
    expect_error(V37 "sphere { 0, 1 pigment { pavement number_of_tiles 6 pattern 13 } }",
                 "pattern 13 of a pavement of 6 polygons of 3 sides: it has 12");
    expect_error(V37 "sphere { 0, 1 pigment { pavement number_of_sides 6 number_of_tiles 6 } }",
                 "pattern 1 of a pavement of 6 polygons of 6 sides: it has 0");
    expect_error(V37 "sphere { 0, 1 pigment { pavement number_of_sides 5 } }", "it is 3, 4 or 6");
}

/* Half of black and white is .5 of whatever the scene computes in. */
static void blends_in_the_working_space(void **state)
{
    static const struct {
        const char *head;
        double half;
    } spaces[] = {{V37, 0.5},
                  {"#version 3.7; global_settings{assumed_gamma srgb} ", -1},
                  {"#version 3.5; ", -1},
                  {"#version 3.7; global_settings{assumed_gamma 2} ", 0.25}};
    (void)state;
    for (size_t i = 0; i < sizeof spaces / sizeof *spaces; i++) {
        char text[500];
        const double half = spaces[i].half < 0 ? retex_srgb_decode(0.5) : spaces[i].half;
        snprintf(text, sizeof text,
                 "%s sphere{0,1 pigment{gradient x color_map{[0 rgb 0][1 rgb 1]}}}"
                 "sphere{0,1 pigment{gradient x pigment_map{[0 rgb 0][1 gradient y]}}}"
                 "sphere{0,1 pigment{average pigment_map{[1 gradient y][1 rgb 0]}}}"
                 "sphere{0,1 pigment{gradient x color_map{[0 rgb .5][1 rgb .5]}}}",
                 spaces[i].head);
        Scene *scene = parse(text);
        for (int k = 0; k < 4; k++)
            assert_near(color_at(&scene->primitives[k], 0.5, k == 1 ? 1 : 0.999999999, 0).r, half);
        scene_close(&scene);
    }
}

/* Identifiers in maps of identifiers are as many pigments as were they written out. */
static void large_maps_are_refused(void **state)
{
    char text[4000];
    int used = snprintf(text, sizeof text, V37 "#declare P0 = pigment{gradient x}\n");
    (void)state;
    for (int i = 0; i < 20; i++)
        used += snprintf(text + used, sizeof text - (size_t)used,
                         "#declare P%d = pigment{gradient x pigment_map{[0 P%d][1 P%d]}}\n", i + 1, i, i);
    expect_error(text, "pigment_map of more than 20000 pigments");
    used = snprintf(text, sizeof text, V37 "#declare P0 = pigment{gradient x}\n");
    for (int i = 0; i < 70; i++)
        used += snprintf(text + used, sizeof text - (size_t)used,
                         "#declare P%d = pigment{average pigment_map{[0 P%d]}}\n", i + 1, i);
    expect_error(text, "nested more than 64 deep");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colors_are_povray),           cmocka_unit_test(patterns_that_see_normals),
        cmocka_unit_test(uv_mapping_is_moved_within),  cmocka_unit_test(uv_mapping_of_an_ovus),
        cmocka_unit_test(nested_patterns_end),         cmocka_unit_test(density_files_are_checked),
        cmocka_unit_test(blends_in_the_working_space), cmocka_unit_test(large_maps_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
