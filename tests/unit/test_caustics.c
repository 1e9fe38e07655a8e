/* The guide to caustics: its density integrates to one over the sphere and is that of its directions, the guide is the
 * same for any number of threads, and the mean of a picture does not depend on it. */
#include "lib_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "path/caustics.h"
#include "path/photons.h"
#include "render/render.h"
#include "path/sampler.h"

#define GROUND                                                                                                         \
    "#version 3.7; global_settings { assumed_gamma 1 } camera { location <0, 3, -4> look_at 0 angle 40 }"              \
    "#default { finish { ambient 0 diffuse 1 } } plane { y, 0 texture { pigment { rgb .5 } } }"
#define DISC "disc { <0, 5, 0>, y, .6 texture { pigment { rgb 1 } finish { diffuse 0 emission 20 } } }"
static const char LENS[] = GROUND
    "sphere { 0, .5 texture { pigment { rgbt 1 } finish { diffuse 0 reflection { 0, 1 fresnel on } conserve_energy } }"
    " interior { ior 1.5 } translate <0, .9, 0> }" DISC;
static const char NO_GLASS[] = "#version 3.7; camera { location -4*z look_at 0 } sphere { 0, 1 pigment { rgb 1 } }"
                               "disc { 5*y, y, .3 texture { pigment { rgb 1 } finish { diffuse 0 emission 9 } } }";

static Caustics *make_guide(const Scene *scene, int nthreads)
{
    Caustics *caustics;
    Accel *accel;
    Lights *lights;
    assert_int_equal(accel_create(&accel, scene, nthreads, NULL), 0);
    assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
    const PhotonSources sources = {.scene = scene, .accel = accel, .lights = lights, .paths = 1 << 20};
    assert_int_equal(caustics_create(&caustics, &sources, CAUSTICS_OF_EMITTERS, nthreads, NULL), 0);
    lights_close(&lights);
    accel_close(&accel);
    return caustics;
}

/* A budget that is stopped ends the tracing of photons. */
static void budget_ends_it(void **state)
{
    (void)state;
    Scene *scene = test_scene(LENS);
    Caustics *caustics;
    Accel *accel;
    Lights *lights;
    RetexBudget *budget;
    assert_int_equal(retex_budget_create(&budget, NULL), 0);
    retex_budget_stop(budget);
    assert_int_equal(accel_create(&accel, scene, 1, NULL), 0);
    assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
    const PhotonSources sources = {scene, accel, lights, 1L << 40, budget, 0};
    assert_int_equal(caustics_create(&caustics, &sources, CAUSTICS_OF_EMITTERS, 2, NULL), RETEX_ESTOPPED);
    assert_null(caustics);
    lights_close(&lights);
    accel_close(&accel);
    scene_close(&scene);
    retex_budget_close(&budget);
}

/* Points on the floor below the ball that have a cell; returns how many. */
static int guided_points(const Caustics *caustics, Vec3 *points, int most)
{
    int n = 0;
    for (int k = 0; k < 400 && n < most; k++) {
        Vec3 p = vec3(-1 + 0.1 * (k % 20), 0, -1 + 0.1 * (double)(k / 20));
        if (caustics_find(caustics, p))
            points[n++] = p;
    }
    return n;
}

/* A direction of a grid of equal solid angles. */
static Vec3 grid_direction(int i, int j, int n)
{
    double z = 1 - 2 * (i + 0.5) / n, turn = 2 * PI * (j + 0.5) / n, r = sqrt(1 - z * z);
    return vec3(r * cos(turn), z, r * sin(turn));
}

/* In quarters of the sphere; lobes are made broad enough for a grid. */
static void density_is_that_of_samples(void **state)
{
    (void)state;
    enum { N = 600, SAMPLES = 20000, PARTS = 4 };
    Scene *scene = test_scene(LENS);
    Caustics *caustics = make_guide(scene, 2);
    Vec3 points[400];
    int n, seen = 0;
    assert_non_null(caustics);
    n = guided_points(caustics, points, 400);
    assert_true(n > 20);
    for (int k = 0; k < n; k += n / 6) {
        CausticsCell cell = *caustics_find(caustics, points[k]);
        double sum[PARTS] = {0}, total = 0;
        int found[PARTS] = {0};
        Sampler sampler = sampler_start(3, (uint32_t)k, 0, 0);
        for (int l = 0; l < cell.nlobes; l++)
            cell.concentration[l] = fminf(cell.concentration[l], 300);
        for (int i = 0; i < N; i++)
            for (int j = 0; j < N; j++) {
                Vec3 d = grid_direction(i, j, N);
                double density = caustics_density(&cell, points[k], d) * 4 * PI / (N * N);
                sum[(d.x > 0) + 2 * (d.z > 0)] += density, total += density;
            }
        for (uint32_t s = 0; s < SAMPLES; s++) {
            float u[4];
            sampler.sample = s;
            sampler_pair(&sampler, 0, &u[0], &u[1]);
            sampler_pair(&sampler, 1, &u[2], &u[3]);
            Vec3 d = caustics_sample(&cell, points[k], u[0], u[2], u[3]);
            assert_true(fabs(vec_dot(d, d) - 1) < 1e-9);
            found[(d.x > 0) + 2 * (d.z > 0)]++;
        }
        if (fabs(total - 1) > 0.01)
            fail_msg("point %d: the density adds up to %.5f", k, total);
        for (int p = 0; p < PARTS; p++)
            if (fabs(sum[p] - (double)found[p] / SAMPLES) > 0.02)
                fail_msg("point %d: %.4f of the density, %.4f of the samples", k, sum[p], (double)found[p] / SAMPLES);
        seen++;
    }
    assert_true(seen >= 6);
    caustics_close(&caustics);
    scene_close(&scene);
}

static void same_for_any_threads(void **state)
{
    (void)state;
    Scene *scene = test_scene(LENS);
    Caustics *one = make_guide(scene, 1), *seven = make_guide(scene, 7);
    Vec3 points[400];
    int n = guided_points(one, points, 400);
    for (int k = 0; k < n; k++) {
        const CausticsCell *a = caustics_find(one, points[k]), *b = caustics_find(seven, points[k]);
        assert_non_null(b);
        assert_memory_equal(a, b, sizeof *a);
        assert_true(a->share > 0 && a->share <= 0.5f);
    }
    caustics_close(&one);
    caustics_close(&seven);
    scene_close(&scene);
}

/* The ball is in an instance of a compound of many parts, with a texture of its own or of the instance. */
static void instances_are_casters(void **state)
{
    (void)state;
    for (int inherits = 0; inherits < 2; inherits++) {
        char text[2048];
        snprintf(text, sizeof text,
                 GROUND "#declare Clear = texture { pigment { rgbt 1 } finish { diffuse 0 } }"
                        "#declare Many = union { sphere { 0, .5 %s interior { ior 1.5 } translate <0, .9, 0> }"
                        "#for (I, 1, 8192) sphere { <I, -50, 0>, .1 pigment { rgb 1 } } #end }"
                        "object { Many translate -500*y } object { Many rotate 30*y %s }" DISC,
                 inherits ? "" : "texture { Clear }", inherits ? "texture { Clear }" : "");
        Scene *scene = test_scene(text);
        Vec3 points[400];
        assert_int_equal(scene->ninstances, 1);
        Caustics *caustics = make_guide(scene, 1);
        assert_non_null(caustics);
        assert_true(guided_points(caustics, points, 400) > 100);
        caustics_close(&caustics);
        scene_close(&scene);
    }
}

/* A mesh casts by textures of its faces too. */
static void faces_are_casters(void **state)
{
    (void)state;
    for (int clear = 0; clear < 2; clear++) {
        char text[2048];
        snprintf(text, sizeof text,
                 GROUND "#declare Wall = texture { pigment { rgb 1 } }"
                        "#declare Face = texture { pigment { %s } finish { diffuse 0 } }"
                        "mesh2 { vertex_vectors { 4, <-.5, .5, -.5>, <.5, .5, -.5>, <0, .5, .6>, <0, 1.5, 0> }"
                        "texture_list { 2, texture { Wall } texture { Face } }"
                        "face_indices { 4, <0, 2, 1>, 1, <0, 1, 3>, 1, <1, 2, 3>, 1, <2, 0, 3>, 1 }"
                        "texture { Wall } interior { ior 1.5 } }" DISC,
                 clear ? "rgbt 1" : "rgb 1");
        Scene *scene = test_scene(text);
        Caustics *caustics = make_guide(scene, 1);
        assert_int_equal(caustics != NULL, clear);
        caustics_close(&caustics);
        scene_close(&scene);
    }
}

static void nothing_without_glass(void **state)
{
    (void)state;
    Scene *scene = test_scene(NO_GLASS);
    assert_null(make_guide(scene, 1));
    scene_close(&scene);
}

static RetexSet *render(const Scene *scene, int spp, int guide, int nthreads)
{
    RenderParams p = RENDER_PARAMS_INIT;
    RetexSet *set = NULL;
    RetexError err = {0};
    p.width = 32, p.height = 24, p.spp = spp, p.plain = 1, p.nthreads = nthreads, p.caustics_guide = guide;
    if (render_scene(&set, scene, &p, NULL, &err))
        fail_msg("%s", err.message);
    return set;
}

static double mean_of(const RetexSet *set)
{
    const RetexImage *image = &set->parts[0].image;
    double sum = 0;
    for (size_t i = 0; i < (size_t)32 * 24 * 3; i++)
        sum += image->pixels[i] / (32.0 * 24 * 3);
    return sum;
}

/* Also below a sky, of which directions are drawn with a density that the guide shares. */
static void mean_stays(void **state)
{
    (void)state;
    for (int sky = 0; sky < 2; sky++) {
        char text[2048];
        snprintf(text, sizeof text, "%s%s", LENS, sky ? "sky_sphere { pigment { rgb 1 } }" : "");
        Scene *scene = test_scene(text);
        const int spp = sky ? 512 : 2048;
        RetexSet *guided = render(scene, spp, 1, 0), *chance = render(scene, spp, -1, 0);
        double a = mean_of(guided), b = mean_of(chance);
        if (fabs(a - b) > 0.004 * b)
            fail_msg("mean %.5f with the guide, %.5f without", a, b);
        retex_set_close(&guided);
        retex_set_close(&chance);
        guided = render(scene, 16, 1, 1), chance = render(scene, 16, 1, 7);
        assert_memory_equal(guided->parts[0].image.pixels, chance->parts[0].image.pixels, 32 * 24 * 3 * sizeof(float));
        retex_set_close(&guided);
        retex_set_close(&chance);
        scene_close(&scene);
    }
}

/* Without being asked the guide is there for a small lamp over glass, and not for a large one. */
static void switches_itself_on(void **state)
{
    (void)state;
    for (int small = 0; small < 2; small++) {
        char text[2048];
        snprintf(text, sizeof text, "%s", LENS);
        char *radius = strstr(text, ", .6 ");
        assert_non_null(radius);
        memcpy(radius, small ? ", .1 " : ", 2. ", 5);
        Scene *scene = test_scene(text);
        RetexSet *sets[3];
        for (int guide = -1; guide < 2; guide++)
            sets[guide + 1] = render(scene, 16, guide, 1);
        const size_t bytes = 32 * 24 * 3 * sizeof(float);
        const float *asked = sets[1]->parts[0].image.pixels;
        assert_int_equal(memcmp(asked, sets[0]->parts[0].image.pixels, bytes) == 0, !small);
        assert_int_equal(memcmp(asked, sets[2]->parts[0].image.pixels, bytes) == 0, small);
        for (int k = 0; k < 3; k++)
            retex_set_close(&sets[k]);
        scene_close(&scene);
    }
}

/* ---- light sources ---- */

#define SOURCE_SCENE                                                                                                   \
    "#version 3.7; global_settings { assumed_gamma 1 photons { count 1000 } }"                                         \
    "camera { location <0, 3, -4> look_at <0, .2, 0> angle 40 } #default { finish { ambient 0 diffuse 1 } }"           \
    "plane { y, 0 texture { pigment { rgb .5 } } }"                                                                    \
    "sphere { 0, .5 texture { pigment { rgbf <1, .8, .6, 1> } finish { diffuse 0 } } interior { ior 1.5 }"             \
    " photons { target refraction on reflection on } translate <0, .9, 0> }"
/* Irradiance 2 pi / d^2, of a light of radius .15. */
static const char SOURCE[] =
    SOURCE_SCENE "light_source { <.5, 4, 0>, 1e6 fade_distance 1e-3 fade_power 2 retex { radius .15 } }";
static const char LAMP[] = SOURCE_SCENE
    "sphere { <.5, 4, 0>, .15 texture { pigment { rgb 1 } finish { diffuse 0 emission 2 / .0225 } } no_image }";

/* A light source with caustics shines as the small sphere does that it is said to be: on the whole, and in blocks of
 * 4 x 4 pixels. Straight through the glass it does not shine. */
static void source_is_a_small_lamp(void **state)
{
    (void)state;
    Scene *scenes[] = {test_scene(SOURCE), test_scene(LAMP)};
    RetexSet *sets[2];
    double worst = 0;
    for (int k = 0; k < 2; k++)
        sets[k] = render(scenes[k], 4096, 1, 0);
    const double a = mean_of(sets[0]), b = mean_of(sets[1]);
    if (fabs(a - b) > 0.006 * b)
        fail_msg("mean %.5f by a light source, %.5f by a lamp", a, b);
    for (int block = 0; block < 48; block++) {
        double sums[2] = {0, 0};
        for (int i = 0; i < 48; i++) {
            const int x = block % 8 * 4 + i / 3 % 4, y = block / 8 * 4 + i / 12;
            for (int k = 0; k < 2; k++)
                sums[k] += (double)sets[k]->parts[0].image.pixels[(y * 32 + x) * 3 + i % 3];
        }
        worst = fmax(worst, fabs(sums[0] - sums[1]) / fmax(sums[1], 0.02 * 48 * b));
    }
    if (worst > 0.1)
        fail_msg("a block differs by %.3f", worst);
    for (int k = 0; k < 2; k++) {
        retex_set_close(&sets[k]);
        scene_close(&scenes[k]);
    }
}

/* The mean is the same without the guide, where paths meet the light by chance. */
static void source_needs_no_guide(void **state)
{
    (void)state;
    Scene *scene = test_scene(SOURCE_SCENE "light_source { <0, 4, 0>, .6 retex { radius .8 } }");
    RetexSet *guided = render(scene, 1024, 0, 0), *chance = render(scene, 4096, -1, 0);
    const double a = mean_of(guided), b = mean_of(chance);
    if (fabs(a - b) > 0.004 * b)
        fail_msg("mean %.5f with the guide, %.5f without", a, b);
    retex_set_close(&guided);
    retex_set_close(&chance);
    scene_close(&scene);
}

/* Beams keep their light too: a sheet of glass as wide as the picture takes none of it away. */
static void sheet_keeps_the_light(void **state)
{
    (void)state;
    static const char SHEET[] =
        "#version 3.7; global_settings { photons { count 1 } } camera { location <0, 1, -3> look_at <0, 0, 1> angle 40 "
        "}"
        "#default { finish { ambient 0 diffuse 1 } } plane { y, 0 pigment { rgb .5 } }"
        "light_source { <3, 6, 0>, 1 parallel point_at 0 }"
        "box { <-30, 3, -30>, <30, 3.2, 30> pigment { rgbt 1 } finish { diffuse 0 } interior { ior 1.4 } no_image %s }";
    double means[2];
    for (int k = 0; k < 2; k++) {
        char text[1024];
        snprintf(text, sizeof text, SHEET, k ? "photons { target refraction on }" : "");
        Scene *scene = test_scene(text);
        assert_int_equal(scene->lights[0].caustics != 0, k);
        RetexSet *set = render(scene, 256, 0, 0);
        means[k] = mean_of(set);
        retex_set_close(&set);
        scene_close(&scene);
    }
    if (fabs(means[0] - means[1]) > 0.02 * means[0])
        fail_msg("mean %.5f straight through, %.5f refracted", means[0], means[1]);
}

/* What is on the way dims caustics by Beer's law, and the photons that guide to them too. */
static void media_dim_caustics(void **state)
{
    (void)state;
    static const char SHEET[] =
        "#version 3.7; global_settings { assumed_gamma 1 photons { count 1 } }"
        "camera { location <0, .9, -3> look_at <0, 0, .5> angle 20 }"
        "#default { finish { ambient 0 diffuse 1 } } plane { y, 0 pigment { rgb .5 } hollow }"
        "#declare Smoke = media { absorption .4 } #declare Clear = box { <-30, 0, -30>, <30, 1, 30> pigment { rgbt 1 }"
        " finish { diffuse 0 } hollow }"
        "light_source { <0, 9, 0>, 1 parallel point_at 0 }"
        "box { <-30, 3, -30>, <30, 4, 30> pigment { rgbt 1 } finish { diffuse 0 } hollow no_image"
        " photons { target refraction on } interior { ior 1.4 %s } } %s";
    static const struct {
        const char *within, *beside;
        double depth;
    } cases[] = {{"", "", 0},
                 {"", "object { Clear interior { media { Smoke } } translate 1.5*y }", 0.4},
                 {"", "object { Clear interior { media { Smoke } } translate 5*y }", 0.4},
                 {"media { Smoke }", "", 0.4},
                 {"media { Smoke density { gradient y translate 3*y } }", "", 0.2},
                 {"media { Smoke }", "object { Clear interior { media { Smoke } } translate 5*y }", 0.8}};
    double mean = 0, power = 0;
    for (int k = 0; k < 6; k++) {
        char text[1024];
        Accel *accel;
        Lights *lights;
        Photons photons;
        double landed = 0;
        snprintf(text, sizeof text, SHEET, cases[k].within, cases[k].beside);
        Scene *scene = test_scene(text);
        RetexSet *set = render(scene, 64, 0, 0);
        assert_int_equal(accel_create(&accel, scene, 1, NULL), 0);
        assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
        const PhotonSources sources = {.scene = scene, .accel = accel, .lights = lights, .paths = 1};
        assert_int_equal(photons_trace(&photons, &sources, 1, NULL), 0);
        for (int i = 0; i < photons.count; i++)
            landed += (double)photons.landings[i].power;
        if (k == 0)
            mean = mean_of(set), power = landed;
        const double passing = exp(-cases[k].depth);
        if (fabs(mean_of(set) / mean - passing) > 0.02 * passing)
            fail_msg("case %d: mean %.5f of %.5f, should be %.5f", k, mean_of(set) / mean, mean, passing);
        if (fabs(landed / power - passing) > 0.02 * passing)
            fail_msg("case %d: photons have %.5f of %.5f, should be %.5f", k, landed / power, power, passing);
        free(photons.landings);
        lights_close(&lights);
        accel_close(&accel);
        retex_set_close(&set);
        scene_close(&scene);
    }
}

/* Round the image of a lamp in a flat mirror, which moves over the mirror as the point moves, lobes are narrow. */
static void lobes_follow_a_mirror(void **state)
{
    (void)state;
    Scene *scene =
        test_scene("#version 3.7; global_settings { photons { count 1 } } camera { location <0, 5, -4> look_at 0 }"
                   "plane { y, 0 pigment { rgb .5 } finish { diffuse 1 } }"
                   "box { <-1, .2, 2>, <1, 2, 2.1> pigment { rgb 0 } finish { diffuse 0 reflection .9 }"
                   " photons { target reflection on } } light_source { <0, 3, -1>, 1 }");
    Caustics *caustics = make_guide(scene, 0);
    int points = 0, narrow = 0;
    assert_non_null(caustics);
    for (int k = 0; k < 400; k++) {
        const Vec3 p = vec3(-0.9 + 0.09 * (k % 20), 0, 0.1 + 0.08 * (double)(k / 20));
        const double along = (2 - p.z) / (5 - p.z), height = 3 * along, x = p.x * (1 - along);
        const CausticsCell *cell = caustics_find(caustics, p);
        if (height < 0.3 || height > 1.9 || fabs(x) > 0.9 || !cell)
            continue;
        points++;
        narrow += caustics_density(cell, p, vec_normalize(vec_sub(vec3(0, 3, 5), p))) > 1000;
    }
    if (points < 100 || narrow < points * 8 / 10)
        fail_msg("of %d points %d have narrow lobes", points, narrow);
    caustics_close(&caustics);
    scene_close(&scene);
}

/* Light sources are invisible in mirrors and through glass. */
static void source_stays_invisible(void **state)
{
    (void)state;
    Scene *scene =
        test_scene("#version 3.7; global_settings { photons { count 1 } } camera { location -3*z look_at 0 angle 40 }"
                   "box { <-2, -2, 0>, <2, 2, 1> pigment { rgb 0 } finish { ambient 0 diffuse 0 reflection 1 }"
                   " photons { target reflection on } } light_source { <0, 0, -3>, 1 retex { radius 1 } }");
    RetexSet *set = render(scene, 16, 0, 1);
    assert_true(scene->lights[0].caustics != 0);
    assert_true(mean_of(set) == 0);
    retex_set_close(&set);
    scene_close(&scene);
}

/* A mirror that throws no caustics ends them, also for one behind it that does: the light of a periscope. */
static void caustics_end_at_other_mirrors(void **state)
{
    static const char PERISCOPE[] =
        "#version 3.7; global_settings { photons { count 1 } } camera { location <0, 1, -1> look_at 0 angle 20 }"
        "#default { finish { ambient 0 diffuse 1 } } disc { 0, y, .4 pigment { rgb 1 } }"
        "#macro Mirror() box { <-1, -.02, -.6>, <1, .02, .6> rotate 45*z pigment { rgb 0 }"
        " finish { diffuse 0 reflection 1 } #end "
        "Mirror() translate <0, 3, 0> %s } Mirror() translate <3, 3, 0> photons { target reflection on } }"
        "box { <-9, 5, -9>, <2.25, 5.1, 9> pigment { rgb 0 } } light_source { <3, 9, 0>, 1 retex { radius .6 } }";
    (void)state;
    for (int k = 0; k < 2; k++) {
        char text[1024];
        snprintf(text, sizeof text, PERISCOPE, k ? "photons { target reflection on }" : "");
        Scene *scene = test_scene(text);
        RetexSet *set = render(scene, 64, -1, 1);
        assert_true(scene->lights[0].caustics != 0);
        assert_int_equal(mean_of(set) > 0, k);
        retex_set_close(&set);
        scene_close(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(density_is_that_of_samples),
        cmocka_unit_test(same_for_any_threads),
        cmocka_unit_test(instances_are_casters),
        cmocka_unit_test(faces_are_casters),
        cmocka_unit_test(nothing_without_glass),
        cmocka_unit_test(budget_ends_it),
        cmocka_unit_test(mean_stays),
        cmocka_unit_test(switches_itself_on),
        cmocka_unit_test(source_is_a_small_lamp),
        cmocka_unit_test(media_dim_caustics),
        cmocka_unit_test(lobes_follow_a_mirror),
        cmocka_unit_test(source_stays_invisible),
        cmocka_unit_test(caustics_end_at_other_mirrors),
        cmocka_unit_test(source_needs_no_guide),
        cmocka_unit_test(sheet_keeps_the_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
