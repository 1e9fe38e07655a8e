/* Lights of whole scenes: the density of sampling an emitter is that of hitting it, picks are as often as told. */
#include "lib_random_light.h"
#include "lib_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "path/sampler.h"
#include "light/environment.h"
#include "light/lights.h"
#include "light/source.h"
#include "shade/split.h"

#define HEAD                                                                                                           \
    "#version 3.7; global_settings { assumed_gamma 1 } camera { location -5*z look_at 0 }"                             \
    "#declare Shine = texture { pigment { rgb 1 } finish { ambient 0 diffuse 0 emission 2 } }"                         \
    "#declare Blue = texture { pigment { checker rgb 1 rgb .5 } finish { ambient 0 diffuse 0 emission <0, 0, 3> } }"   \
    "#declare Dark = texture { pigment { rgb 1 } finish { ambient 0 diffuse 1 } }"
/* N x N cells of two faces at height 3 */
#define SHEET(N)                                                                                                       \
    "mesh { #for (I, 0, " #N " - 1) #for (J, 0, " #N " - 1)"                                                           \
    "#local A = <2*I/" #N " - 1, 3, 2*J/" #N " - 1>; #local D = 2*x/" #N "; #local E = 2*z/" #N ";"                    \
    "triangle { A, A + D, A + D + E } triangle { A, A + D + E, A + E } #end #end texture { Shine } }"

static const char *const SCENES[] = {
    HEAD "sphere { 2*y, .5 texture { Shine } }",
    HEAD SHEET(1),
    HEAD SHEET(5),
    HEAD SHEET(5) "sphere { 2*y, .5 scale <1, 2, 1> texture { Shine } } box { <1, 0, 1>, 2 texture { Shine } }"
                  "disc { -2*y, y, 1 texture { Blue } } torus { 1, .2 texture { Shine } } light_source { 4*x, rgb 1 }",
    HEAD "mesh { #for (I, 0, 19) triangle { <I, 0, 2>, <I + 1, 0, 2>, <I, 1, 3>"
         "#if (mod(I, 3)) texture { Shine } #else #if (mod(I, 2)) texture { Blue } #else texture { Dark } #end #end }"
         "#end scale <.2, 1, 1> rotate 20*x } light_source { 3, rgb 2 parallel point_at 0 }"
         "sky_sphere { pigment { gradient y } }",
};

/* What is sampled has the density that hitting it is given. */
static void expect_densities(double lamp_share)
{
    for (size_t i = 0; i < sizeof SCENES / sizeof *SCENES; i++) {
        Scene *scene = test_scene(SCENES[i]);
        Lights *lights;
        int found = 0;
        const char *specs[] = {"Shine", "sky"};
        if (lamp_share > 0 && scene_resolve_lamps(scene, specs, 2, NULL)) /* some scenes have one lamp only */
            assert_int_equal(scene_resolve_lamps(scene, specs + (i + 1 == sizeof SCENES / sizeof *SCENES), 1, NULL), 0);
        assert_int_equal(lights_create(&lights, scene, lamp_share, NULL), 0);
        for (int k = 0; k < 4000; k++) {
            LightSampleContext p = random_lit(k);
            LightSample s;
            float u[4], pdf;
            for (int j = 0; j < 4; j++)
                u[j] = (float)random_between(0, 1);
            LightPick pick = lights_pick(lights, &p, u[0], u[1]);
            if (!lights_sample(lights, &p, &pick, u[2], u[3], &s) || s.source)
                continue;
            found++;
            assert_int_equal(s.lamp, light_sample_is_shape(&s) ? s.surface.primitive->lamp : scene->sky_lamp);
            if (!light_sample_is_shape(&s))
                pdf = lights_sky_pdf(lights, &p, s.direction);
            else
                pdf = lights_emitter_pdf(lights, &p, (int)(s.surface.primitive - scene->primitives), &s.surface);
            if (fabsf(pdf - s.pdf * s.pick_probability) > 1e-3f * pdf)
                fail_msg("scene %d: sampled with density %g, hit with %g", (int)i, s.pdf * s.pick_probability, pdf);
        }
        if (found < 500)
            fail_msg("scene %d: %d samples", (int)i, found);
        lights_close(&lights);
        scene_close(&scene);
    }
}

static void densities_agree(void **state)
{
    (void)state;
    expect_densities(0);
    expect_densities(0.3);
}

/* Each light, near or infinitely far, is chosen as often as its probability tells. */
static void picks_are_as_often_as_told(void **state)
{
    (void)state;
    enum { N = 20000, LIGHTS = 64 };
    int most = 0;
    Scene *scene = test_scene(HEAD SHEET(
        3) "sphere { 2*y, .5 texture { Shine } } light_source { 3, rgb 1 }"
           "light_source { <1, 5, 0>, rgb .2 parallel point_at 0 } light_source { y, .5 parallel point_at x }"
           "light_source { <0, 9, 1>, rgb <0, 2, 1> parallel point_at 0 } sky_sphere { pigment { gradient y } }");
    const char *specs[] = {"Shine", "sky"};
    assert_int_equal(scene_resolve_lamps(scene, specs, 2, NULL), 0);
    for (int k = 0; k < 40; k++) {
        const LightSampleContext p = random_lit(k);
        double told[LIGHTS] = {0}, often[LIGHTS] = {0}, all = 0;
        int places[LIGHTS], count = 0;
        Lights *lights;
        assert_int_equal(lights_create(&lights, scene, k % 2 ? 0.3 : 0, NULL), 0);
        for (int i = 0; i < N; i++) {
            const LightPick pick = lights_pick(lights, &p, (float)((i + 0.5) / N), 0.5f);
            const int place = 32 * pick.entry + pick.face + 1;
            int of = 0;
            assert_true(pick.entry >= 0 && pick.probability > 0);
            while (of < count && places[of] != place)
                of++;
            assert_true(of < LIGHTS);
            count += of == count;
            places[of] = place, told[of] = pick.probability, often[of] += 1.0 / N;
        }
        for (int of = 0; of < count; of++) {
            all += told[of];
            if (fabs(told[of] - often[of]) > 5.0 / N)
                fail_msg("light %d: told %.5f, chosen %.5f", places[of], told[of], often[of]);
        }
        if (fabs(all - 1) > 1e-3)
            fail_msg("%d lights with %.5f", count, all);
        most = count > most ? count : most;
        lights_close(&lights);
    }
    assert_true(most >= 8);
    scene_close(&scene);
}

/* Lamps share a part of the samples alike; the rest goes by what lights give. */
static void each_lamp_has_a_share(void **state)
{
    (void)state;
    enum { SAMPLES = 20000 };
    Scene *scene = test_scene(HEAD "#declare Dim = light_source { <0, 3, 0> .001 } light_source { Dim }"
                                   "light_source { <0, 3, 0> 1 } light_source { <0, 2, 0> 0 }");
    const char *specs[] = {"Dim", "off=light_source#3"};
    LightSampleContext p = {{0, 0, 0}, {0, 1, 0}, NULL};
    int counts[3] = {0};
    Lights *lights;
    assert_int_equal(scene_resolve_lamps(scene, specs, 2, NULL), 0);
    assert_int_equal(lights_create(&lights, scene, 0.6, NULL), 0);
    for (int k = 0; k < SAMPLES; k++) {
        LightPick pick = lights_pick(lights, &p, ((float)k + 0.5f) / SAMPLES, 0.5f);
        LightSample s;
        assert_true(lights_sample(lights, &p, &pick, 0.5f, 0.5f, &s));
        counts[s.lamp]++;
        if (s.lamp == 0)
            assert_true(fabsf(pick.probability - 0.2f) < 0.02f);
    }
    assert_true(counts[0] > 0.2 * SAMPLES && counts[0] < 0.21 * SAMPLES);
    assert_true(counts[1] > 0.2 * SAMPLES && counts[2] > 0.2 * SAMPLES); /* what is off would shine as the bright one */
    lights_close(&lights);
    scene_close(&scene);
}

/* A sphere is sampled by the cone in which it is seen: evenly where a path meets its front, never behind. */
static void spheres_are_sampled_where_they_are_seen(void **state)
{
    (void)state;
    Scene *scene = test_scene(HEAD "sphere { 0, 1 texture { Shine } }");
    Lights *lights;
    LightSampleContext from = {{0, 0, -4}, {0, 0, 0}, NULL};
    Surface s = {.primitive = &scene->primitives[0]};
    const double whole = 2 * PI * (1 - sqrt(1 - 1.0 / 16)); /* the cone's solid angle */
    assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
    for (int k = 0; k < 10; k++) {
        double angle = 0.13 * k; /* seen up to acos(1/4) = 1.318 */
        s.position = vec3(sin(angle), 0, -cos(angle)), s.geometric_normal = s.position;
        assert_true(fabs(lights_emitter_pdf(lights, &from, 0, &s) * whole - 1) < 1e-4);
        s.position.z = cos(angle), s.geometric_normal = s.position;
        assert_true(lights_emitter_pdf(lights, &from, 0, &s) == 0);
    }
    lights_close(&lights);
    scene_close(&scene);
}

/* Two faces that make a parallelogram are sampled as it: cells of numbers are cells of it. */
static void even_numbers_are_even_points(void **state)
{
    (void)state;
    enum { N = 32 };
    Scene *scene = test_scene(HEAD SHEET(1));
    Lights *lights;
    LightSampleContext from = {{0, 0, 0}, {0, 1, 0}, NULL};
    int cells[N][N] = {{0}};
    assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
    for (int k = 0; k < N * N; k++) {
        const LightPick pick = lights_pick(lights, &from, 0.5f, 0.5f);
        LightSample s;
        const float u = ((float)(k % N) + 0.4f) / N, v = ((float)(k / N) + 0.6f) / N;
        assert_true(lights_sample(lights, &from, &pick, u, v, &s));
        cells[(int)((s.surface.position.x + 1) / 2 * N)][(int)((s.surface.position.z + 1) / 2 * N)]++;
    }
    for (int k = 0; k < N * N; k++)
        assert_int_equal(cells[k / N][k % N], 1);
    lights_close(&lights);
    scene_close(&scene);
}

/* Points are uniform in area: so many lie in each face, and in each quarter of it, at its corners and between. */
static void faces_are_sampled_uniformly(void **state)
{
    (void)state;
    enum { N = 512 };
    Scene *scene = test_scene(HEAD "mesh { triangle { 0, 4*x, y } triangle { 0, y, -x } triangle { 2*z, 3*z, 2*z + x }"
                                   "texture { Shine } }");
    MeshLight *light;
    const double areas[] = {2, .5, .5};
    double counts[3][4] = {{0}};
    assert_int_equal(mesh_light_create(&light, &scene->primitives[0], NULL), 0);
    for (int k = 0; k < N * N; k++) {
        const MeshLightPoint p = mesh_light_point(light, -1, ((float)(k % N) + 0.5f) / N, ((float)(k / N) + 0.5f) / N);
        Surface s;
        mesh_light_surface(&p, &scene->primitives[0], &s);
        assert_true(fabs(p.density - 1 / 3.0) < 1e-6 && s.b1 >= 0 && s.b2 >= 0 && s.b1 + s.b2 <= 1);
        counts[s.face][s.b1 + s.b2 < .5 ? 0 : s.b1 > .5 ? 1 : s.b2 > .5 ? 2 : 3]++;
    }
    for (int k = 0; k < 12; k++) {
        const double wanted = areas[k / 4] / 3 * N * N / 4, got = counts[k / 4][k % 4];
        if (fabs(got - wanted) > 0.02 * wanted)
            fail_msg("face %d, quarter %d: %g points, should be %g", k / 4, k % 4, got, wanted);
    }
    mesh_light_close(&light);
    scene_close(&scene);
}

/* Photons carry the light of all emitters together, each its share: radiance times area. */
static void photons_carry_all_light(void **state)
{
    (void)state;
    enum { SAMPLES = 1 << 14 };
    Scene *scene = test_scene(HEAD SHEET(3) "sphere { -5*y, .5 texture { Blue } }"
                                            "disc { 5*x, x, 1 texture { Shine } } sphere { 9, 2 texture { Dark } }");
    Lights *lights;
    double sum = 0, of_sphere = 0;
    Sampler sampler = sampler_start(1, 0, 0, 0);
    assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
    for (uint32_t k = 0; k < SAMPLES; k++) {
        EmissionPoint p;
        float u[4];
        sampler.sample = k;
        sampler_pair(&sampler, 0, &u[0], &u[1]);
        sampler_pair(&sampler, 1, &u[2], &u[3]);
        assert_int_equal(lights_emission(lights, u[0], u[2], u[3], &p), 1);
        sum += (double)p.power / SAMPLES;
        of_sphere += p.position.y < -4 ? (double)p.power / SAMPLES : 0;
    }
    const double blue = 3 * 0.0722 * PI * NEUTRAL_ALBEDO, shine = 2 * (4 + PI) * NEUTRAL_ALBEDO;
    if (fabs(sum - blue - shine) > 0.01 * (blue + shine) || fabs(of_sphere - blue) > 0.02 * blue)
        fail_msg("%g and %g of the sphere, should be %g and %g", sum, of_sphere, blue + shine, blue);
    lights_close(&lights);
    scene_close(&scene);
}

/* Irradiance that all samples together find at a point. */
static double mean_irradiance(const char *text, LightSampleContext p)
{
    Scene *scene = test_scene(text);
    Lights *lights;
    double sum = 0;
    enum { SAMPLES = 1 << 18 };
    assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
    Sampler sampler = sampler_start(1, 0, 0, 0);
    for (uint32_t k = 0; k < SAMPLES; k++) {
        LightSample s;
        float u[4];
        sampler.sample = k;
        sampler_pair(&sampler, 0, &u[0], &u[1]);
        sampler_pair(&sampler, 1, &u[2], &u[3]);
        LightPick pick = lights_pick(lights, &p, u[0], u[1]);
        if (lights_sample(lights, &p, &pick, u[2], u[3], &s))
            sum += 2 * fmax(0, vec_dot(s.direction, p.normal)) / (s.pdf * s.pick_probability) / SAMPLES;
    }
    lights_close(&lights);
    scene_close(&scene);
    return sum;
}

/* Light does not depend on how a sheet is cut into faces, nor on what the faces are chosen by. */
static void faces_give_what_their_sheet_gives(void **state)
{
    (void)state;
    LightSampleContext points[] = {
        {{0, 0, 0}, {0, 1, 0}, NULL}, {{2, 2.5, 0.3}, {-0.6, 0.8, 0}, NULL}, {{0.3, 5, 0}, {0, -0.8, 0.6}, NULL}};
    for (int k = 0; k < 3; k++) {
        double whole = mean_irradiance(HEAD SHEET(1), points[k]), cut = mean_irradiance(HEAD SHEET(12), points[k]);
        if (fabs(whole - cut) > 0.004 * whole)
            fail_msg("point %d: a sheet gives %.5f, its faces %.5f", k, whole, cut);
    }
}

/* Direct light is not sampled from weak ambient, nor from a dome around the camera. */
static void domes_are_left_to_paths(void **state)
{
    (void)state;
    static const struct {
        const char *shape;
        int lights;
    } cases[] = {{"sphere { 0, 1 finish { ambient 1 diffuse 0 } }", 1},
                 {"sphere { 0, 1 finish { ambient .9 diffuse 0 } }", 0},
                 {"sphere { 0, 100 finish { ambient 1 diffuse 0 } }", 0},
                 {"sphere { 0, 100 finish { ambient 0 emission 1 diffuse 0 } }", 1},
                 {"box { -1, 1 scale 20 finish { ambient 3 diffuse .5 } }", 0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[1000];
        snprintf(text, sizeof text, "%s%s", HEAD, cases[k].shape);
        Scene *scene = test_scene(text);
        Lights *lights;
        assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
        assert_int_equal(lights_count(lights), cases[k].lights);
        lights_close(&lights);
        scene_close(&scene);
    }
}

/* Of light sources only those are chosen that shine on the surface's light group, whatever their number. */
static void only_lights_of_the_group_are_chosen(void **state)
{
    (void)state;
    static const char *const light_groups[] = {
        "light_group { light_source { <5,9,5>, 1 } light_source { <1,2,-3>, 1 parallel } sphere { 0, 1 } }",
        "light_group { light_source { <5,9,5>, 1 } sphere { 0, 1 } global_lights on }",
        "light_group { sphere { 0, 1 } }"};
    const int chosen[3][2] = {{2, 9}, {10, 9}, {0, 9}}; /* on the sphere, and on what is in no light group */
    char text[1000];
    for (int k = 0; k < 3; k++) {
        snprintf(text, sizeof text, "%s#for(I,1,9) light_source { <I,7,-3>, 1 } #end %s sphere { 5, 1 }", HEAD,
                 light_groups[k]);
        Scene *scene = test_scene(text);
        Lights *lights;
        assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
        for (int outside = 0; outside < 2; outside++) {
            const LightSampleContext p = {.position = vec3(outside, 1, 0),
                                          .light_group = scene->primitives[outside].light_group};
            double inverses = 0;
            enum { N = 4000 };
            for (int i = 0; i < N; i++) {
                LightSample s;
                const LightPick pick = lights_pick(lights, &p, (float)(i + 0.5) / N, 0.5f);
                if (!lights_sample(lights, &p, &pick, 0.5f, 0.5f, &s))
                    continue;
                assert_true(light_reaches(s.source, p.light_group));
                inverses += 1 / (double)s.pick_probability / N;
            }
            if (fabs(inverses - chosen[k][outside]) > 0.05) /* each of them once */
                fail_msg("light group %d, outside %d: %.3f lights, not %d", k, outside, inverses, chosen[k][outside]);
        }
        lights_close(&lights);
        scene_close(&scene);
    }
}

/* Of many lights far away each is chosen by the irradiance that it gives: a sphere that of its disc, a flat shape and
 * the faces of a mesh that of their area. */
static void far_lights_are_chosen_by_irradiance(void **state)
{
    (void)state;
    Scene *scene = test_scene(HEAD "#for(I,0,4) sphere { <I*40 - 80, 900, 0>, 1 + I/2 texture { Shine } }"
                                   "disc { <I*40 - 80, 1000, 200>, y, 1.5 + I/2 texture { Shine } } #end "
                                   "mesh { #for(I,0,19) triangle { <9*I, 800, 99>, <9*I + 4, 800, 99>, <9*I, 801, 96> }"
                                   "#end texture { Shine } }");
    const LightSampleContext p = {.position = vec3(0, 0, 0)};
    Lights *lights;
    double wanted[30], found[30], sum = 0;
    const double face = 0.5 * 4 * sqrt(10);
    int count = 0;
    assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
    for (int k = 0; k < 30; k++) {
        const double x = k < 10 ? k / 2 * 40 - 80 : 9 * (k - 10) + 4 / 3.0,
                     r = k % 2 ? 1.5 + k / 2 / 2.0 : 1 + k / 2 / 2.0;
        const Vec3 at = k >= 10 ? vec3(x, 800 + 1 / 3.0, 98) : k % 2 ? vec3(x, 1000, 200) : vec3(x, 900, 0);
        const Vec3 normal = k < 10 ? vec3(0, 1, 0) : vec_normalize(vec3(0, 3, 1));
        const double d = vec_length(at), cosine = k < 10 && k % 2 == 0 ? 1 : fabs(vec_dot(normal, at)) / d;
        wanted[k] = (k < 10 ? PI * r * r : face) * cosine / (d * d), sum += wanted[k], found[k] = 0;
    }
    for (int i = 0; i < 20000; i++) {
        const LightPick pick = lights_pick(lights, &p, (float)(i + 0.5) / 20000, 0.5f);
        found[pick.entry < 10 ? pick.entry : 10 + pick.face] = (double)pick.probability;
    }
    for (int k = 0; k < 30; k++) {
        count += found[k] > 0;
        if (fabs(found[k] - wanted[k] / sum) > 0.03 * wanted[k] / sum)
            fail_msg("light %d is chosen by %.5f, should be by %.5f", k, found[k], wanted[k] / sum);
    }
    assert_int_equal(count, 30);
    lights_close(&lights);
    scene_close(&scene);
}

/* Shares of few lights may add up to less than the largest random number: then the last one that shines is chosen. Also
 * where lamps have shares: there numbers just below the first half's parts are the largest of each lamp. */
static void largest_number_chooses_a_light(void **state)
{
    (void)state;
    const float numbers[] = {1 - 0x1p-24f, nextafterf(0.25f, 0), nextafterf(0.5f, 0)};
    Scene *scene =
        test_scene(HEAD "#declare Lamp = light_source { <1,2,7>, 1 fade_distance 1 fade_power 2 } light_source { Lamp }"
                        "#for(I,2,20) light_source { <I,2,mod(7*I,20)>, I fade_distance 1 fade_power 2 } #end "
                        "light_group { light_source { 9, 1 } light_source { 8, 1 } sphere { 1, .1 } }");
    const char *specs[] = {"Lamp"};
    for (int lamps = 0; lamps < 2; lamps++) {
        Lights *lights;
        if (lamps)
            assert_int_equal(scene_resolve_lamps(scene, specs, 1, NULL), 0);
        assert_int_equal(lights_create(&lights, scene, lamps ? 0.5 : 0, NULL), 0);
        for (int k = 0; k < 6000; k++) {
            const LightSampleContext p = random_lit(k);
            const LightPick pick = lights_pick(lights, &p, numbers[lamps ? k % 3 : 0], 0.5f);
            assert_true(pick.entry >= 0 && pick.entry < 20 && pick.probability < 1);
        }
        lights_close(&lights);
    }
    scene_close(&scene);
}

/* Faces of a mesh that do not shine are never sampled: hitting them has no density. */
static void dark_faces_have_no_density(void **state)
{
    (void)state;
    Scene *scene = test_scene(HEAD "mesh { #for(I,0,19) triangle { <I,0,0>, <I+1,0,0>, <I,0,1>"
                                   "#if (mod(I, 3)) texture { Shine } #else texture { Dark } #end } #end }");
    const LightSampleContext from = {.position = vec3(9, 5, 0)};
    Lights *lights;
    assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
    for (int k = 0; k < 20; k++) {
        const Surface s = {.primitive = &scene->primitives[0],
                           .face = k,
                           .position = vec3(k + 0.3, 0, 0.3),
                           .geometric_normal = vec3(0, 1, 0)};
        const float pdf = lights_emitter_pdf(lights, &from, 0, &s);
        assert_true(k % 3 ? pdf > 0 : pdf == 0);
    }
    lights_close(&lights);
    scene_close(&scene);
}

/* Directions of the sky are sampled by its luminance; whatever is looked at less closely, the densities add up to 1. */
static void skies_are_sampled_by_luminance(void **state)
{
    (void)state;
    enum { N = 500 };
    static const struct {
        const char *pigments;
        double within; /* of the luminance over its mean, in the mean of all directions; edges of a sun are far off */
    } skies[] = {
        {"pigment { gradient y color_map { [0 rgb .2] [1 rgb 1] } }", 0.002},
        {"pigment { gradient y color_map { [0 rgb .2] [1 rgb 1] } scale 2 translate -y }", 0.002},
        {"pigment { gradient x color_map { [0 rgb .2] [1 rgb 1] } }", 0.01},
        {"pigment { gradient y color_map { [0 rgb .2] [1 rgb 1] } rotate 90 * x }", 0.01},
        {"pigment { planar color_map { [0 rgb .2] [1 rgb 1] } scale .7 }", 0.015},
        {"pigment { bozo color_map { [0 rgb .2] [1 rgb 1] } scale .2 }", 0.02},
        {"pigment { rgb .1 } pigment { gradient y color_map { [.999 rgbt 1] [.999 rgb 500] } rotate 60 * x }", 0.85}};
    for (size_t k = 0; k < sizeof skies / sizeof *skies; k++) {
        char text[1000];
        snprintf(text, sizeof text, "%s sky_sphere { %s }", HEAD, skies[k].pigments);
        Scene *scene = test_scene(text);
        SkyTable *sky;
        double whole = 0, off = 0;
        assert_int_equal(sky_table_of(&sky, scene, 0, NULL), 0);
        for (int i = 0; i < N * N; i++) {
            const double z = 1 - 2 * (i / N + 0.5) / N, phi = 2 * PI * (i % N + 0.5) / N, r = sqrt(1 - z * z);
            const Vec3 d = vec3(r * cos(phi), z, r * sin(phi));
            const double pdf = (double)sky_table_pdf(sky, d) * 4 * PI;
            whole += pdf;
            off += fabs(pdf - (double)(rgb_luminance(sky_radiance(scene, d, 0)) / sky_table_mean(sky)));
        }
        if (!(fabs(whole / N / N - 1) < 0.05 && off / N / N < skies[k].within))
            fail_msg("sky %zu: densities add up to %.4f, and are %.4f off", k, whole / N / N, off / N / N);
        sky_table_close(&sky);
        scene_close(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(domes_are_left_to_paths),
        cmocka_unit_test(only_lights_of_the_group_are_chosen),
        cmocka_unit_test(far_lights_are_chosen_by_irradiance),
        cmocka_unit_test(largest_number_chooses_a_light),
        cmocka_unit_test(dark_faces_have_no_density),
        cmocka_unit_test(skies_are_sampled_by_luminance),
        cmocka_unit_test(densities_agree),
        cmocka_unit_test(picks_are_as_often_as_told),
        cmocka_unit_test(each_lamp_has_a_share),
        cmocka_unit_test(spheres_are_sampled_where_they_are_seen),
        cmocka_unit_test(even_numbers_are_even_points),
        cmocka_unit_test(faces_are_sampled_uniformly),
        cmocka_unit_test(photons_carry_all_light),
        cmocka_unit_test(faces_give_what_their_sheet_gives),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
