/* Fog: what POV-Ray 3.7 shows of a shining wall behind it. */
#include "lib_scene_text.h"

#include <math.h>
#include <stdio.h>

#include <cmocka.h>

#include "medium/fog.h"
#include "path/path.h"

/* Red, green and blue of a wall at z = 2 with `emission 1` and `rgb <.8,.6,.4>`, seen from <0,2.5,0> towards <0,2.1,2>:
 * `povray +W1 +H1 -A +FE` of `camera{location y*2.5 look_at <0,2.1,2> angle 1}`, linear, to half floats. */
static const struct {
    const char *fogs;
    Rgb seen;
} cases[] = {
    {"fog{distance 3 rgb <.2,.3,.9>}", {0.50390f, 0.45190f, 0.64648f}},
    {"fog{fog_type 1 distance 3 rgbt <.2,.3,.9,.7>}", {0.62012f, 0.50977f, 0.54980f}},
    {"fog{}", {0.79980f, 0.60010f, 0.39990f}},
    {"fog{fog_type 2 distance 3 rgb <.2,.3,.9> fog_offset 1 fog_alt .7}", {0.71387f, 0.55713f, 0.47168f}},
    {"fog{fog_type 2 distance 3 rgb <.2,.3,.9> fog_offset 2.3 fog_alt .7}", {0.50684f, 0.45337f, 0.64453f}},
    {"fog{fog_type 2 distance 3 rgb <.2,.3,.9> fog_offset 3 fog_alt .7}", {0.50391f, 0.45190f, 0.64648f}},
    {"fog{fog_type 2 distance 3 rgb <.2,.3,.9> fog_alt .5}", {0.78174f, 0.59082f, 0.41528f}},
    {"fog{fog_type 2 distance 3 rgb <.2,.3,.9>}", {0.79980f, 0.60010f, 0.39990f}},
    {"fog{fog_type 2 distance 3 rgb <.2,.3,.9> fog_offset 1 fog_alt .7 up <.1,1,.3>*4}",
     {0.72949f, 0.56494f, 0.45874f}},
    {"fog{fog_type 2 distance 3 rgb <.2,.3,.9> fog_offset 1 fog_alt .7 scale <1,2,.3> rotate x*30}",
     {0.72852f, 0.56445f, 0.45947f}},
    {"fog{fog_type 2 distance 3 rgb <.2,.3,.9> fog_offset 1 fog_alt .7 rotate x*30 scale <1,2,.3>}",
     {0.72168f, 0.56104f, 0.46533f}},
    {"fog{distance 3 rgb <.2,.3,.9> turbulence <.3,.7,1.5> turb_depth .5}", {0.59277f, 0.49658f, 0.57275f}},
    {"fog{distance 3 rgb <.2,.3,.9> turbulence .8}", {0.57959f, 0.48975f, 0.58398f}},
    {"fog{distance 3 rgb <.2,.3,.9> turbulence <.3,.7,1.5> turb_depth .9 omega .3 lambda 3 octaves 3}",
     {0.62061f, 0.51025f, 0.54932f}},
    {"#declare F = fog{fog_type 2 distance 3 rgb <.2,.3,.9> fog_offset 1 fog_alt .7}"
     "fog{F turbulence <.3,.7,1.5> turb_depth .5}",
     {0.74512f, 0.57227f, 0.44604f}},
};

static Rgb seen_through(const char *fogs, Vec3 from, Vec3 to)
{
    char text[512];
    Rgb own;
    snprintf(text, sizeof text, V37 "%s sphere{99,1}", fogs);
    Scene *scene = parse(text);
    const Ray ray = {from, vec_normalize(vec_sub(to, from)), 0, INFINITY};
    const Rgb passing = fog_transmittance(scene, &ray, vec_length(vec_sub(to, from)), &own);
    scene_close(&scene);
    return rgb_add(rgb_mul(passing, rgb(0.8f, 0.6f, 0.4f)), own);
}

static void assert_rgb(Rgb a, Rgb b)
{
    assert_float_equal(a.r, b.r, 6e-4);
    assert_float_equal(a.g, b.g, 6e-4);
    assert_float_equal(a.b, b.b, 6e-4);
}

static void test_povray(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_rgb(seen_through(cases[k].fogs, vec3(0, 2.5, 0), vec3(0, 2.1, 2)), cases[k].seen);
}

/* The same way straight along z. */
static void test_several(void **state)
{
    (void)state;
    const Vec3 from = {0, 0, 0}, to = {0, 0, 2};
    assert_rgb(seen_through("fog{distance 3 rgbft <.2,.3,.9,.4,.7>}", from, to), rgb(0.44092f, 0.39233f, 0.53857f));
    assert_rgb(seen_through("fog{distance 3 rgb <.2,.3,.9>} fog{distance 5 rgbf <.7,.1,.3,.5>}", from, to),
               rgb(0.56201f, 0.29248f, 0.62646f));
    /* The sky is out of sight behind any fog. */
    assert_rgb(seen_through("fog{distance 1e7 rgb <.2,.3,.9>}", from, vec3(0, 0, 1e12)), rgb(0.2f, 0.3f, 0.9f));
}

/* The density of ground fog along a slanted ray, by a sum over 20000 points. */
static void test_ground_density(void **state)
{
    (void)state;
    for (int k = 0; k < 20; k++) {
        const Vec3 from = vec3(0, 3 - 0.31 * k, 0), to = vec3(1, -2 + 0.27 * k, 4);
        const double length = vec_length(vec_sub(to, from));
        double sum = 0;
        for (int i = 0; i < 20000; i++) {
            const double t = (i + 0.5) / 20000, h = (from.y + t * (to.y - from.y) - 0.4) / 0.9;
            sum += (h > 0 ? 1 / (1 + h * h) : 1) * length / 20000;
        }
        const Rgb seen = seen_through("fog{fog_type 2 distance 2.5 fog_offset .4 fog_alt .9}", from, to);
        assert_float_equal(seen.r / 0.8, exp(-sum / 2.5), 1e-5);
    }
}

/* A level ray has one density all its way. */
static void test_level_rays(void **state)
{
    (void)state;
    for (int k = 0; k < 20; k++) {
        const double y = -0.5 + 0.25 * k, h = (y - 0.4) / 0.9, density = h > 0 ? 1 / (1 + h * h) : 1;
        const Vec3 from = {0, y, 0}, to = {3, y, 4};
        const Rgb seen = seen_through("fog{fog_type 2 distance 2.5 fog_offset .4 fog_alt .9}", from, to);
        assert_float_equal(seen.r / 0.8, exp(-5 * density / 2.5), 1e-5);
    }
}

/* The pattern of turbulence is stretched by its vector: half of it at twice the place is the same. */
static void test_turbulence_is_stretched(void **state)
{
    (void)state;
    static const char *const fogs[] = {"fog{distance 3 rgb <.2,.3,.9> turbulence <.3,.7,1.5> turb_depth .9}",
                                       "fog{distance 3 rgb <.2,.3,.9> turbulence <.15,.7,1.5> turb_depth .9}",
                                       "fog{distance 3 rgb <.2,.3,.9> turbulence <.3,.35,1.5> turb_depth .9}",
                                       "fog{distance 3 rgb <.2,.3,.9> turbulence <.3,.7,.75> turb_depth .9}"};
    for (int k = 0; k < 3; k++) {
        double by[3] = {1, 1, 1};
        by[k] = 2;
        const double along[3] = {k == 0 ? 0 : 2, k == 1 ? 0 : k == 0 ? 2 : 1, k == 2 ? 0 : 1};
        const Vec3 from = {0.7, 1.3, 2.1}, there = {0.7 * by[0], 1.3 * by[1], 2.1 * by[2]};
        const Vec3 way = vec3(along[0], along[1], along[2]);
        const Rgb a = seen_through(fogs[0], from, vec_add(from, way));
        const Rgb b = seen_through(fogs[1 + k], there, vec_add(there, way));
        const Rgb elsewhere = seen_through(fogs[1 + k], from, vec_add(from, way));
        assert_rgb(a, b);
        assert_true(fabsf(a.r - elsewhere.r) > 2e-3f);
    }
}

/* Where the camera stands in something that is not hollow there is no fog. */
static void test_camera_inside(void **state)
{
    static const struct {
        const char *object;
        int solids;
    } objects[] = {{"sphere{0,4}", 1},
                   {"sphere{0,4 hollow}", 0},
                   {"sphere{0,4 inverse}", 0},
                   {"plane{y,1}", 1},
                   {"difference{sphere{0,4} sphere{0,2}}", 0},
                   {"difference{sphere{0,4} sphere{5*z,2}}", 1},
                   {"union{sphere{0,4} box{-1,1}}", 2},
                   {"disc{0,z,1}", 0}};
    (void)state;
    for (size_t k = 0; k < sizeof objects / sizeof *objects; k++) {
        char text[256];
        snprintf(text, sizeof text, V37 "fog{distance 1} %s", objects[k].object);
        Scene *scene = parse(text);
        assert_int_equal(media_at(scene, vec3(0.1, 0.2, 0.3)).solids, objects[k].solids);
        scene_close(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_povray),
        cmocka_unit_test(test_several),
        cmocka_unit_test(test_ground_density),
        cmocka_unit_test(test_level_rays),
        cmocka_unit_test(test_turbulence_is_stretched),
        cmocka_unit_test(test_camera_inside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
