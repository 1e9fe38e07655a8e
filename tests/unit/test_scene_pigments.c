/* Pigments as the scene language builds them: colours of tests/data/pigments.txt, which POV-Ray gave
 * (tests/lib/povray_pigments.py), the space in which colours blend, and what maps of pigments must bear. */
#include "lib_scene_text.h"

#include <retex/color.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "shade/pigment.h"

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
    assert_true(bodies >= 5);
    assert_int_equal(wrong, 0);
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
        cmocka_unit_test(colors_are_povray),
        cmocka_unit_test(blends_in_the_working_space),
        cmocka_unit_test(large_maps_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
