/* Participating media: phase functions, and single scattering in a ball against values of POV-Ray. */
#include "lib_scene_text.h"

#include <math.h>
#include <stdio.h>

#include <cmocka.h>

#include "medium/medium.h"
#include "medium/phase.h"
#include "path/path.h"
#include "render/render.h"

static const Medium media[] = {
    {.phase = PHASE_ISOTROPIC},
    {.phase = PHASE_MIE_HAZY},
    {.phase = PHASE_MIE_MURKY},
    {.phase = PHASE_RAYLEIGH},
    {.phase = PHASE_HENYEY_GREENSTEIN, .eccentricity = 0.7},
    {.phase = PHASE_HENYEY_GREENSTEIN, .eccentricity = -0.4},
    {.phase = PHASE_HENYEY_GREENSTEIN, .eccentricity = 5e-4},
};
enum { PHASES = sizeof media / sizeof *media, STEPS = 20000 };

/* The integral over the sphere, and the mean cosine. */
static void test_normalised(void **state)
{
    (void)state;
    for (int k = 0; k < PHASES; k++) {
        double sum = 0, mean = 0;
        for (int i = 0; i < STEPS; i++) {
            const double c = (i + 0.5) * 2 / STEPS - 1, p = phase_density(&media[k], c) * 2 * PI * 2 / STEPS;
            sum += p, mean += p * c;
        }
        assert_float_equal(sum, 1, 1e-4);
        if (media[k].phase == PHASE_HENYEY_GREENSTEIN)
            assert_float_equal(mean, media[k].eccentricity, 1e-4);
    }
}

/* Sampled cosines fall into ten bins as the density says. */
static void test_sampled(void **state)
{
    (void)state;
    const Vec3 before = vec_normalize(vec3(0.3, -0.7, 0.2));
    for (int k = 0; k < PHASES; k++) {
        double bins[10] = {0}, wanted[10] = {0}, density;
        for (int i = 0; i < STEPS; i++) {
            const float u = ((float)i + 0.5f) / STEPS, v = (float)fmod(i * 0.618034, 1);
            const Vec3 after = phase_sample(&media[k], before, u, v, &density);
            const double c = fmax(-1, fmin(vec_dot(before, after), 1 - 1e-9));
            assert_float_equal(vec_length(after), 1, 1e-6);
            assert_float_equal(density / phase_density(&media[k], c), 1, 1e-3);
            bins[(int)((c + 1) * 5)] += 1.0 / STEPS;
        }
        for (int i = 0; i < STEPS; i++) {
            const double c = (i + 0.5) * 2 / STEPS - 1;
            wanted[i * 10 / STEPS] += phase_density(&media[k], c) * 4 * PI / STEPS;
        }
        for (int i = 0; i < 10; i++)
            assert_float_equal(bins[i], wanted[i], 3e-3);
    }
}

/* Light of light sources: POV-Ray's formulas of its manual and its source, which a scale makes of the density. */
static void test_light_sources(void **state)
{
    (void)state;
    for (int k = 0; k < PHASES; k++) {
        const double g = media[k].eccentricity;
        for (int i = 0; i <= 20; i++) {
            const double c = i * 0.1 - 1, x = (1 + c) / 2;
            const double wanted[] = {1, 0.576655375 * (1 + 9 * pow(x, 8)), 0.495714547 * (1 + 50 * pow(x, 32)),
                                     0.799372013 * (1 + c * c), (1 - g * g) / pow(1 + g * g - 2 * g * c, 1.5)};
            const double value = phase_of_sources(&media[k], c);
            assert_true(fabs(value * PI / wanted[k < 4 ? k : 4] - 1) < 1e-9);
            assert_true(fabs(phase_source_scale(&media[k]) * phase_density(&media[k], c) / value - 1) < 1e-9);
        }
    }
}

static void assert_sums(const MediumSums *sums, double share)
{
    for (int c = 0; c < 3; c++) {
        const double density[] = {0.25, 0.5, 1}, absorption[] = {0.1, 0.2, 0.3}, scattering[] = {0.8, 0.4, 0.2};
        assert_float_equal(sums->density[0][c], share * density[c], 1e-6);
        assert_float_equal(sums->extinction[c], share * density[c] * (absorption[c] + 0.75 * scattering[c]), 1e-6);
        assert_float_equal(sums->scattering[c], share * density[c] * 0.75 * scattering[c], 1e-6);
        assert_float_equal(sums->emission[c], share * density[c] * (c + 1), 1e-6);
    }
}

/* The density multiplies all coefficients; all are scaled down to a bound, if there is one. */
static void test_coefficients(void **state)
{
    (void)state;
    const Pigment density = {.kind = PIGMENT_COLOR, .color = {0.25f, 0.5f, 1, 0, 0}}, *const densities[] = {&density};
    const Medium medium = {.phase = PHASE_ISOTROPIC,
                           .absorption = {0.1f, 0.2f, 0.3f},
                           .scattering = {0.8f, 0.4f, 0.2f},
                           .emission = {1, 2, 3},
                           .extinction = 0.75,
                           .ndensities = 1,
                           .densities = densities,
                           .most = {0.25f, 0.5f, 1}};
    MediumSet set = {.count = 0};
    MediumSums sums;
    medium_set_add(&set, &medium);
    medium_set_complete(&set);
    assert_true(set.varies && set.scatters && set.emits);
    assert_float_equal(set.majorant, 0.45, 1e-6);
    for (int k = 0; k < 3; k++) {
        static const float most[] = {0, 0.9f, 0.225f}; /* none, enough, half */
        medium_at(&set, vec3(0.1, 0.2, 0.3), most[k], &sums);
        assert_sums(&sums, k == 2 ? 0.5 : 1);
    }
}

/* Where nothing says between which values a density lies, it is between 0 and 1. */
static void test_bounds(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "media{scattering{1,1} density{wrinkles}}"
                             "media{scattering{1,1} density{wrinkles color_map{[0 rgb <.5,1,2>][1 rgb <3,.25,1>]}}}"
                             "media{scattering{1,1} density{granite density_map{[0 rgb .5][1 rgb 3]}}} sphere{9,1}");
    static const Rgb wanted[] = {{1, 1, 1}, {3, 1, 2}, {3, 3, 3}};
    int k = 3;
    for (const Medium *m = scene->media; m; m = m->next) { /* the last comes first */
        const Rgb most = density_bound(m->densities[0]), want = wanted[--k];
        assert_true(most.r == want.r && most.g == want.g && most.b == want.b);
    }
    assert_int_equal(k, 0);
    scene_close(&scene);
}

/* Of POV-Ray 3.7: a ball of 2 units of `scattering{TYPE, <.02,.1,.01>}` before black, a light at 60 degrees from the
 * direction of view: what it shows is here, per colour of the light. */
static void test_povray(void **state)
{
    static const struct {
        const char *scattering;
        double seen[3];
    } cases[] = {{"1, <.02,.1,.01>", {0.0385, 0.1663, 0.0196}},
                 {"2, <.02,.1,.01>", {0.0423, 0.1823, 0.0215}},
                 {"3, <.02,.1,.01>", {0.0192, 0.0828, 0.0098}},
                 {"4, <.02,.1,.01>", {0.0385, 0.1661, 0.0196}},
                 {"5, <.02,.1,.01> eccentricity .4", {0.0489, 0.2108, 0.0249}},
                 {"1, <.02,.1,.01> extinction 0", {0.04, 0.2, 0.02}},
                 {"1, <.02,.1,.01> extinction 3", {0.0358, 0.1152, 0.0189}}};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[512];
        RenderParams params = RENDER_PARAMS_INIT;
        RenderStats stats = {0};
        RetexError err = {0};
        RetexSet *set = NULL;
        snprintf(text, sizeof text,
                 V37 "camera{location 0 look_at z angle .1} light_source{<86.6025,0,60> rgb 1}"
                     "sphere{10*z,1 pigment{rgbt 1} hollow interior{media{scattering{%s}}}}",
                 cases[k].scattering);
        Scene *scene = parse(text);
        params.width = params.height = 1, params.spp = 512, params.max_depth = 2, params.nthreads = 1;
        params.plain = 1;
        test_must(render_scene(&set, scene, &params, &stats, &err), &err);
        for (int c = 0; c < 3; c++)
            assert_float_equal(set->parts[0].image.pixels[c] / cases[k].seen[c], 1, 0.012);
        retex_set_close(&set);
        scene_close(&scene);
    }
}

/* What is read: densities multiply, constant ones go into coefficients, and transforms reach them. */
static void test_language(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "#declare D = density{rgb .5} #declare M = media{absorption .2 density{D}}"
                             "media{M density{rgb <.5,1,1>} intervals 3 samples 4, 5 method 3}"
                             "sphere{0,1 hollow pigment{rgbt 1} interior{media{emission 1 density{spherical"
                             "  color_map{[0 rgb 0][1 rgb <1,2,3>]} translate x}} media{M}} scale 2}");
    const Medium *air = scene->media;
    assert_true(scene->has_media && air && !air->next);
    assert_near(air->absorption.r, 0.05f);
    assert_near(air->absorption.g, 0.1f);
    assert_int_equal(air->ndensities, 0);
    MediumSet inside = {.count = 0};
    medium_set_add(&inside, only(scene)->interior->media);
    medium_set_complete(&inside);
    assert_int_equal(inside.count, 2);
    assert_true(inside.varies && inside.emits && !inside.scatters);
    assert_float_equal(inside.majorant, 0.1, 1e-6);
    assert_float_equal(inside.sums.emission[2], 3, 1e-6);
    MediumSums here;
    medium_at(&inside, vec3(2.5, 0, 0), 0, &here); /* a quarter from the density's middle to its edge */
    assert_float_equal(here.emission[1], 2 * 0.75, 1e-5);
    assert_float_equal(here.extinction[1], 0.1, 1e-6);
    medium_at(&inside, vec3(2, 0, 0), 0.05f, &here); /* scaled down */
    assert_float_equal(here.extinction[1], 0.05, 1e-6);
    assert_float_equal(here.emission[1], 1, 1e-5);
    scene_close(&scene);
    expect_error(V37 "media{scattering{6, 1}}", "type 6");
    expect_error(V37 "fog{fog_type 3}", "fog_type 3");
}

/* Densities of one medium multiply at each point. */
static void test_two_densities(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "sphere{0,1 hollow pigment{rgbt 1} interior{media{absorption <2,1,.5> emission 4"
                             "  density{gradient x color_map{[0 rgb 0][1 rgb <1,.5,2>]}}"
                             "  density{gradient y color_map{[0 rgb .2][1 rgb 1]}}"
                             "  density{gradient z color_map{[0 rgb 1][1 rgb <0,1,.5>]}}}}}");
    MediumSet inside = {.count = 0};
    MediumSums here;
    medium_set_add(&inside, only(scene)->interior->media);
    medium_set_complete(&inside);
    assert_true(inside.varies);
    for (int k = 0; k < 27; k++) {
        const double x = 0.1 + 0.3 * (k % 3), y = 0.15 + 0.3 * (k / 3 % 3), z = 0.05 + 0.4 * (k / 9);
        const double absorption[3] = {2, 1, 0.5}, first[3] = {1, 0.5, 2}, third[3] = {0, 1, 0.5};
        medium_at(&inside, vec3(x, y, z), 0, &here);
        for (int c = 0; c < 3; c++) {
            const double density = x * first[c] * (0.2 + 0.8 * y) * (1 - z + z * third[c]);
            assert_float_equal(here.extinction[c], absorption[c] * density, 1e-6);
            assert_float_equal(here.emission[c], 4 * density, 1e-6);
            assert_true(here.extinction[c] <= inside.majorant);
        }
    }
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_normalised), cmocka_unit_test(test_sampled),
        cmocka_unit_test(test_light_sources),
        cmocka_unit_test(test_coefficients),
        cmocka_unit_test(test_bounds),       cmocka_unit_test(test_povray),
        cmocka_unit_test(test_language),   cmocka_unit_test(test_two_densities),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
