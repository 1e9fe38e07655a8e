/* Light distributions: the reader of IES LM-63, each symmetry, what broken files say, and how a luminaire hangs. */
#include "lib_folder.h"
#include "lib_ies.h"
#include "lib_scene_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "light/ies.h"
#include "light/source.h"

static const TestAngles DOWN = {0, 90, 10}, ALL = {0, 180, 19}, ONE = {0, 0, 1};

/* A light at the origin that has the distribution of a file. */
static Scene *lit_by(const char *path, const char *more)
{
    char text[1024];
    snprintf(text, sizeof text, V37 "light_source{0, 1 retex{ies \"%s\"} %s}", path, more);
    return parse(text);
}

/* ---- symmetries ---- */

static double turn(double degrees)
{
    return degrees * PI / 180;
}

static double axial(double v, double h)
{
    (void)h;
    return 10 + v;
}

static double quarters(double v, double h)
{
    return (10 + v) * (2 + cos(turn(2 * h)));
}

static double halves(double v, double h)
{
    return (10 + v) * (2 + cos(turn(h)));
}

static double across(double v, double h)
{
    return (10 + v) * (2 + sin(turn(h)));
}

static double none(double v, double h)
{
    return (10 + v) * (2 + cos(turn(h - 45)));
}

/* Linear between multiples of 10 and of 15 degrees; the intensity itself says what is beyond the file's angles. */
static double between(TestIntensity *f, double v, double h)
{
    const double v0 = 10 * floor(v / 10), h0 = 15 * floor(h / 15), s = (v - v0) / 10, t = (h - h0) / 15;
    return (1 - s) * ((1 - t) * f(v0, h0) + t * f(v0, h0 + 15)) +
           s * ((1 - t) * f(v0 + 10, h0) + t * f(v0 + 10, h0 + 15));
}

static void symmetries(void **state)
{
    static const struct {
        TestAngles horizontal;
        TestIntensity *f;
        double most;
    } cases[] = {{{0, 0, 1}, axial, 190},     {{30, 30, 1}, axial, 190},    {{0, 90, 7}, quarters, 570},
                 {{0, 180, 13}, halves, 570}, {{90, 270, 13}, across, 570}, {{0, 360, 25}, none, 570},
                 {{0, 345, 24}, none, 570}};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Scene *scene = lit_by(test_ies("s.ies", ALL, cases[k].horizontal, cases[k].f), "");
        for (double v = 0; v <= 180; v += 2.5)
            for (double h = 0; h <= 360; h += 3.75) {
                const double wanted = between(cases[k].f, fmin(v, 179.999999), h) / cases[k].most,
                             found = ies_share(scene->lights[0].ies, v, h);
                if (!(fabs(found - wanted) < 1e-6))
                    fail_msg("case %zu, at %g and %g: %.7f, not %.7f", k, v, h, found, wanted);
            }
        scene_close(&scene);
    }
}

/* Beyond the file's vertical angles it is dark, and the cone holds all light. */
static void vertical_ranges(void **state)
{
    static const struct {
        TestAngles vertical;
        double first, last;
    } cases[] = {{{0, 90, 10}, 0, 90}, {{90, 180, 10}, 90, 180}, {{0, 180, 19}, 0, 180}};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Scene *scene = lit_by(test_ies("v.ies", cases[k].vertical, ONE, axial), "");
        const Light *light = &scene->lights[0];
        Vec3 axis;
        const double cone = ies_light_cone(light, &axis);
        for (double v = 0; v <= 180; v += 5) {
            const double found = ies_share(light->ies, v, 0), least = cos(cone) - 1e-9;
            const int lit = v >= cases[k].first && v <= cases[k].last;
            assert_near(found, lit ? (10 + v) / (10 + cases[k].last) : 0);
            assert_true(!lit || vec_dot(axis, vec3(sin(turn(v)), -cos(turn(v)), 0)) >= least);
        }
        assert_near(cone, turn(k < 2 ? 90 : 180));
        scene_close(&scene);
    }
}

static double beam(double v, double h)
{
    (void)h;
    return v == 10 ? 2 : v == 0 ? 1 : 0;
}

static double beam_up(double v, double h)
{
    return beam(180 - v, h);
}

static void cones_end_where_light_does(void **state)
{
    Vec3 axis;
    (void)state;
    Scene *scene = lit_by(test_ies("b.ies", ALL, ONE, beam), "");
    assert_near(ies_light_cone(&scene->lights[0], &axis), turn(20));
    assert_vec(axis, 0, -1, 0);
    scene_close(&scene);
    scene = lit_by(test_ies("b.ies", ALL, ONE, beam_up), "");
    assert_near(ies_light_cone(&scene->lights[0], &axis), turn(20));
    assert_vec(axis, 0, 1, 0);
    scene_close(&scene);
}

/* ---- texts ---- */

#define NUMBERS "1 -1 1 3 1 1 2 0 0 0 1 1 10\n0 45 90\n0\n25 100 50\n"

static void spellings(void **state)
{
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"TILT=NONE\n" NUMBERS, NULL},
        {"a lamp\nof 1986\nTILT=NONE\n" NUMBERS, NULL},
        {"IESNA91\n[TEST] 1\n[MANUFAC] 2\nTILT=NONE\n" NUMBERS, NULL},
        {"IES:LM-63-2019\r\n[TEST] TILT=x\r\nTILT=NONE\r\n1 -1 1 3 1 1 2\r\n0 0 0\r\n1 1 10\r\n0,45,90\r\n0\r\n"
         "25,\r\n100\r\n50\r\n",
         NULL},
        {"IESNA:LM-63-1995\ntilt=none \n1, 900, 7.5, 3, 1, 1, 1, -.1, 0, 0, .5, 1, 0, 0, 45, 90, 0, 2.5e1, 1.e2, +50",
         NULL},
        {"TILT=INCLUDE\n1\n2\n0 90\n1 1.0\n" NUMBERS, NULL},
        {"TILT=INCLUDE\n1\n2\n0 90\n1 .8\n" NUMBERS, "TILT=INCLUDE"},
        {"TILT=INCLUDE 1 0\n" NUMBERS "\x1a", NULL},
        {"TILT=NONE\n" NUMBERS "7\n", "line 6: what follows"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Scene *scene = lit_by(test_ies_text("t.ies", cases[k].text), "");
        if (cases[k].message ? !strstr(messages, cases[k].message) : strstr(messages, "t.ies") != NULL)
            fail_msg("case %zu says `%s`", k, messages);
        assert_near(ies_share(scene->lights[0].ies, 0, 0), 0.25);
        assert_near(ies_share(scene->lights[0].ies, 45, 123), 1);
        assert_near(ies_share(scene->lights[0].ies, 60, 300), 1 - 0.5 / 3);
        assert_near(ies_share(scene->lights[0].ies, 90, 0), 0.5);
        scene_close(&scene);
    }
}

static const struct {
    const char *text, *message;
} BROKEN[] = {
    {"", "no line TILT="},
    {"IESNA91\n[TEST]\n TILT=NONE\n" NUMBERS, "no line TILT="},
    {"TILT=tilt.txt\n" NUMBERS, "line 1: TILT= with a file"},
    {"TILT=NONEXISTENT\n" NUMBERS, "TILT= with a file"},
    {"TILT=INCLUDE\n1\n9999999\n0 90\n1 1\n" NUMBERS, "line 3: it cannot have 1e+07 tilt angles"},
    {"TILT=NONE\n1 -1 1 -3 1 1 2 0 0 0 1 1 10\n", "line 2: it cannot have -3 vertical angles"},
    {"TILT=NONE\n1 -1 1 1 1 1 2 0 0 0 1 1 10 0 0 1 1 1\n", "it cannot have 1 vertical angles"},
    {"TILT=NONE\n1 -1 1 3 0 1 2 0 0 0 1 1 10\n0 45 90\n", "it cannot have 0 horizontal angles"},
    {"TILT=NONE\n1 -1 1 3 1.5 1 2 0 0 0 1 1 10\n0 45 90\n", "it cannot have 1.5 horizontal angles"},
    {"TILT=NONE\n1 -1 1 3 2e9 1 2 0 0 0 1 1 10\n0 45 90\n", "it cannot have 2e+09 horizontal angles"},
    {"TILT=NONE\n1 -1 1 12 12 1 2 0 0 0 1 1 10\n0 45 90\n", "too short for luminous intensities at 12 by 12"},
    {"TILT=NONE\n1 -1 1 3 1 2 2 0 0 0 1 1 10\n0 45 90\n0\n25 100 50\n", "type B"},
    {"TILT=NONE\n1 -1 1 3 1 3 2 0 0 0 1 1 10\n0 45 90\n0\n25 100 50\n", "type A"},
    {"TILT=NONE\n1 -1 1 3 1 4 2 0 0 0 1 1 10\n0 45 90\n0\n25 100 50\n", "only type C"},
    {"TILT=NONE\n1 -1 1 3 1 1 2 0 0 0 1 1 10\n0 45 90\n0\n25 100\n", "ends early, in line 6"},
    {"TILT=NONE\n1 -1 1 3 1 1 2 0 0 0 1 1 10\n0 45 90\n0\n25 nan 50\n", "line 5: a number is expected"},
    {"TILT=NONE\n1 -1 1 3 1 1 2 0 0 0 1 1 10\n0 45 90\n0\n25 -nan 50\n", "line 5: a number is expected"},
    {"TILT=NONE\n1 -1 1 3 1 1 2 0 0 0 1 1 10\n0 45 90\n0\n25 1e999 50\n", "line 5: a number is expected"},
    {"TILT=NONE\n1 -1 1 3 1 1 2 0 0 0 1 1 10\n0 45 90\n0\n25 12x 50\n", "line 5: a number is expected"},
    {"TILT=NONE\n1 -1 one 3 1 1 2 0 0 0 1 1 10\n0 45 90\n0\n25 12 50\n", "line 2: a number is expected"},
    {"TILT=NONE\n1 -1 1 3 1 1 2 0 0 0 1 1 10\n0 90 45\n0\n25 100 50\n", "line 3: the vertical angles do not rise"},
    {"TILT=NONE\n1 -1 1 3 1 1 2 0 0 0 1 1 10\n0 45 45\n0\n25 100 50\n", "line 3: the vertical angles do not rise"},
    {"TILT=NONE\n1 -1 1 3 1 1 2 0 0 0 1 1 10\n0 90 200\n0\n25 100 50\n", "line 3: a vertical angle of 200"},
    {"TILT=NONE\n1 -1 1 3 1 1 2 0 0 0 1 1 10\n-90 0 90\n0\n25 100 50\n", "line 3: a vertical angle of -90"},
    {"TILT=NONE\n1 -1 1 2 2 1 2 0 0 0 1 1 10\n0 90\n0 0\n1 2 3 4\n", "line 4: the horizontal angles do not rise"},
    {"TILT=NONE\n1 -1 1 2 2 1 2 0 0 0 1 1 10\n0 90\n0 361\n1 2 3 4\n", "a horizontal angle of 361"},
    {"TILT=NONE\n1 -1 1 2 2 1 2 0 0 0 1 1 10\n0 90\n0 120\n1 2 3 4\n", "horizontal angles from 0 to 120"},
    {"TILT=NONE\n1 -1 1 2 2 1 2 0 0 0 1 1 10\n0 90\n90 180\n1 2 3 4\n", "horizontal angles from 90 to 180"},
    {"TILT=NONE\n1 -1 1 3 1 1 2 0 0 0 1 1 10\n0 45 90\n0\n25 -1 50\n", "line 5: a luminous intensity is below 0"},
    {"TILT=NONE\n1 -1 1 3 1 1 2 0 0 0 1 1 10\n0 45 90\n0\n0 0 0\n", "all luminous intensities are 0"},
};

static void broken_files_say_why(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof BROKEN / sizeof *BROKEN; k++) {
        char text[512];
        snprintf(text, sizeof text, "\nlight_source{0, 1 retex{ies \"%s\"}}", test_ies_text("x.ies", BROKEN[k].text));
        expect_error(text, BROKEN[k].message);
        expect_error(text, "x.ies");
    }
    expect_error("light_source{0, 1 retex{ies \"nowhere.ies\"}}", "cannot find the light distribution `nowhere.ies`");
}

/* What a light cannot be. */
static void refused_lights(void **state)
{
    static const struct {
        const char *more, *message;
    } cases[] = {{"parallel point_at y", "cannot be parallel"},
                 {"cylinder point_at y", "cannot be cylinder"},
                 {"point_at 0", "no axis"},
                 {"retex{ies 3}", "string"},
                 {"retex{turn 3}", "radius, ies or }"}};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[512];
        snprintf(text, sizeof text, "light_source{0, 1 retex{ies \"%s\"} %s}", test_ies("r.ies", DOWN, ONE, axial),
                 cases[k].more);
        expect_error(text, cases[k].message);
    }
}

/* Any damage is an error that names the file, or shares from 0 to 1. */
static void damage(void **state)
{
    size_t size;
    uint32_t seed = 11;
    SdlOptions options = SDL_OPTIONS_INIT;
    int failed = 0;
    (void)state;
    options.max_memory = (size_t)64 << 20;
    char *whole = (char *)test_read_file(test_ies("d.ies", DOWN, (TestAngles){0, 90, 4}, quarters), &size), text[4096];
    assert_true(size < sizeof text);
    for (int k = 0; k < 1500; k++) {
        static const char letters[] = "0123456789.-,eE nx\n\t\x7f";
        Scene *scene;
        RetexError err = {0};
        char source[256];
        const size_t length = k < 500 ? size * (size_t)k / 500 : size;
        memcpy(text, whole, length);
        text[length] = 0;
        for (int i = 0; k >= 500 && i < 1 + k % 3; i++)
            text[(size_t)(test_random(&seed) * (double)size)] =
                letters[(size_t)(test_random(&seed) * (sizeof letters - 1))];
        snprintf(source, sizeof source, "light_source{0, 1 retex{ies \"%s\"}}", test_ies_text("d.ies", text));
        if (parse_with(&scene, source, &options, &err)) {
            assert_non_null(strstr(err.message, "d.ies"));
            failed++;
            continue;
        }
        for (double v = 0; v <= 180; v += 30)
            for (double h = 0; h <= 360; h += 40) {
                const double share = ies_share(scene->lights[0].ies, v, h);
                assert_true(share >= 0 && share <= 1);
            }
        scene_close(&scene);
    }
    assert_true(failed > 600 && failed < 1450);
    free(whole);
}

/* A file is read once, and is part of what a render is told from others by. */
static void files_are_read_once(void **state)
{
    char text[512];
    (void)state;
    const char *path = test_ies("o.ies", DOWN, ONE, axial);
    snprintf(text, sizeof text, "#for(I,1,9) light_source{I, 1 retex{ies \"%s\"}} #end", path);
    Scene *scene = parse(text);
    for (int k = 1; k < 9; k++)
        assert_ptr_equal(scene->lights[k].ies, scene->lights[0].ies);
    const uint64_t digest = scene->digest;
    scene_close(&scene);
    test_ies("o.ies", DOWN, ONE, beam);
    scene = parse(text);
    assert_true(scene->digest != digest);
    scene_close(&scene);
}

/* ---- how it hangs ---- */

/* Each quarter of the circle has its own light: 1 at horizontal angle 0, .75 at 90, .5 at 180, .25 at 270. */
static double compass(double v, double h)
{
    (void)v;
    return h == 360 ? 4 : 4 - h / 90;
}

/* The share of a light's irradiance in a direction away from it; all that else changes it is left out of scenes. */
static double share_towards(const Light *light, Vec3 direction)
{
    Vec3 back;
    double distance;
    const Vec3 at = vec_add(light->location, direction);
    return (double)source_irradiance(light, at, light->location, &back, &distance).r / PI;
}

static void luminaires_hang(void **state)
{
    static const struct {
        const char *light;
        Vec3 toward_0, toward_90;
    } cases[] = {
        {"light_source{L}", {1, 0, 0}, {0, 0, 1}},
        {"light_source{L point_at -3*y}", {1, 0, 0}, {0, 0, 1}},
        {"light_source{L point_at 2*y}", {1, 0, 0}, {0, 0, -1}}, /* about x */
        {"light_source{L point_at 2*x}", {0, 1, 0}, {0, 0, 1}},  /* about z */
        {"light_source{L point_at -x}", {0, -1, 0}, {0, 0, 1}},
        {"light_source{L point_at z}", {1, 0, 0}, {0, 1, 0}},
        {"light_source{L translate 3*x point_at -z}", {1, 0, 0}, {0, -1, 0}},
        {"light_source{L retex{ies PATH turn 90}}", {0, 0, 1}, {-1, 0, 0}},
        {"light_source{L point_at 2*x retex{ies PATH turn -90}}", {0, 0, -1}, {0, 1, 0}},
        {"light_source{L rotate 90*y}", {0, 0, -1}, {1, 0, 0}}, /* y turns x to -z in POV-Ray */
        {"light_source{L rotate 90*z translate 5*y}", {0, 1, 0}, {0, 0, 1}},
        {"light_source{L scale <-2,2,2>}", {-1, 0, 0}, {0, 0, 1}}, /* mirrored */
        {"light_source{L scale <3,1,1>}", {1, 0, 0}, {0, 0, 1}},
        {"light_source{L matrix <0,0,1,1,0,0,0,1,0,7,8,9>}", {0, 0, 1}, {0, 1, 0}},
        {"union{light_source{L translate 2*z} rotate 90*y}", {0, 0, -1}, {1, 0, 0}},
        {"light_source{L spotlight radius 80 falloff 89.9 point_at -y}", {1, 0, 0}, {0, 0, 1}},
        {"light_source{L spotlight radius 80 falloff 89.9}", {1, 0, 0}, {0, 1, 0}}, /* its own axis, z */
    };
    char text[1024];
    const char *path = test_ies("c.ies", (TestAngles){0, 90, 2}, (TestAngles){0, 360, 5}, compass);
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        snprintf(text, sizeof text, V37 "#declare PATH = \"%s\"; #declare L = light_source{0, 1 retex{ies PATH}} %s",
                 path, cases[k].light);
        Scene *scene = parse(text);
        const Vec3 zero = cases[k].toward_0, quarter = cases[k].toward_90;
        const Vec3 up = vec_cross(quarter, zero); /* opposite to the axis, but where the light source is mirrored */
        const Vec3 axis = strstr(cases[k].light, "-2") ? up : vec_neg(up);
        const Vec3 sides[] = {zero, quarter, vec_neg(zero), vec_neg(quarter)};
        for (int i = 0; i < 4; i++) {
            const Vec3 d = vec_normalize(vec_add(sides[i], axis)), away = vec_normalize(vec_sub(sides[i], axis));
            const double found = share_towards(&scene->lights[0], d);
            if (!(fabs(found - (1 - 0.25 * i)) < 1e-6))
                fail_msg("%s, side %d: %.4f", cases[k].light, i, found);
            assert_near(share_towards(&scene->lights[0], away), 0);
        }
        scene_close(&scene);
    }
}

/* The shares of a spotlight and of its distribution are multiplied. */
static void spots_multiply(void **state)
{
    static const char SPOT[] = "spotlight radius 10 falloff 60 tightness 2 point_at <0,-1,1>";
    (void)state;
    Scene *with = lit_by(test_ies("m.ies", DOWN, ONE, axial), SPOT);
    Light plain = with->lights[0];
    plain.ies = NULL;
    for (double v = 0; v < 80; v += 5) {
        const Vec3 d = vec3(sin(turn(v)), -cos(turn(v)) * sqrt(0.5), cos(turn(v)) * sqrt(0.5));
        assert_near(share_towards(&with->lights[0], d), share_towards(&plain, d) * (10 + v) / 100);
    }
    scene_close(&with);
}

/* Each light of an illuminating grid sends what its own direction has. */
static void grids_shine_from_their_places(void **state)
{
    (void)state;
    Scene *scene = lit_by(test_ies("g.ies", DOWN, ONE, axial), "area_light 2*x, z, 3, 1 area_illumination");
    const Light *light = &scene->lights[0];
    for (int i = 0; i < 3; i++) {
        LightSample sample;
        assert_true(source_sample(light, vec3(1, -1, 0), ((float)i + 0.5f) / 3, 0.5f, &sample));
        const double v = atan(fabs(i - 2.0)) * 180 / PI;
        assert_near((double)sample.radiance.r, PI * (10 + v) / 100);
    }
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(symmetries),
        cmocka_unit_test(vertical_ranges),
        cmocka_unit_test(cones_end_where_light_does),
        cmocka_unit_test(spellings),
        cmocka_unit_test(broken_files_say_why),
        cmocka_unit_test(refused_lights),
        cmocka_unit_test(damage),
        cmocka_unit_test(files_are_read_once),
        cmocka_unit_test(luminaires_hang),
        cmocka_unit_test(spots_multiply),
        cmocka_unit_test(grids_shine_from_their_places),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
