/* Vertices on targets with several finishes: the mean of each finish's weights, over directions of the mixture, is what
 * its own BSDF alone gives, by sampling and by integration; deltas of several finishes share their directions; the
 * choice among lobes keeps deltas first, as the guide to caustics needs. And numbers of combinations. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib_bsdf.h"
#include "path/internal.h"
#include "path/sampler.h"
#include "shade/material.h"

#define RETEX(...)                                                                                                     \
    {                                                                                                                  \
        .diffuse = 0.6, .brilliance = 1, .retex = {.present = 1, .ior = 1.5, .specular_tint = 1, __VA_ARGS__ }         \
    }

static Pigment white = {.kind = PIGMENT_COLOR, .color = {1, 1, 1, 0, 0}};
static const Finish finishes[] = {
    {.diffuse = 0.8, .brilliance = 1, .lambert = 1},
    RETEX(.roughness = 0.5),
    RETEX(.roughness = 0.1),
    RETEX(.roughness = 0),
    RETEX(.roughness = 0.3, .metallic = 1),
    RETEX(.roughness = 0.5, .clearcoat = 1),
    {.diffuse = 0.5, .brilliance = 2, .specular = 0.4, .roughness = 0.02, .reflection_falloff = 1},
    {.diffuse = 0.4,
     .brilliance = 1,
     .roughness = 0.05,
     .reflection_min = {0.1f, 0.2f, 0.3f},
     .reflection_max = {0.6f, 0.6f, 0.6f},
     .reflection_falloff = 2},
};
enum { FINISHES = sizeof finishes / sizeof *finishes, SAMPLES = 1 << 15 };

static void make(Bsdf *b, int finish, double theta)
{
    const Texture texture = {.pigment = &white, .finish = &finishes[finish]};
    const Primitive primitive = {.shape.ops = &shape_plane, .texture = &texture};
    const Surface surface = {
        .primitive = &primitive, .texture = &texture, .geometric_normal = {0, 0, 1}, .shading_normal = {0, 0, 1}};
    bsdf_setup(b, &surface, vec3(sin(theta), 0, cos(theta)), 0, 0, 1);
}

/* A vertex with these finishes, each once. */
static void begin(Vertex *v, const int *chosen, int count, double theta)
{
    memset(v, 0, sizeof *v);
    v->finishes.count = count;
    v->finishes.shown = count - 1;
    for (int k = 0; k < count; k++)
        make(&v->finishes.of[k], chosen[k], theta);
    v->s.bsdf = v->finishes.of[count - 1];
}

static double sum_of(Split s)
{
    return (double)(rgb_luminance(s.d) + 2 * rgb_luminance(s.i));
}

static double own_mean(const Bsdf *b)
{
    double sum = 0;
    for (int k = 0; k < SAMPLES; k++) {
        BsdfSample s;
        if (test_bsdf_sample(b, 7, k, &s))
            sum += sum_of(s.weight);
    }
    return sum / SAMPLES;
}

static float number(int k, int dimension)
{
    float u, v;
    const Sampler sampler = {11, (uint32_t)k};
    sampler_pair(&sampler, (unsigned)dimension, &u, &v);
    return u;
}

static void check_means(const int *chosen, int count, double theta)
{
    Vertex v;
    Split weights[FINISHES_MAX];
    double sums[FINISHES_MAX] = {0};
    begin(&v, chosen, count, theta);
    for (int k = 0; k < SAMPLES; k++) {
        BsdfSample s;
        if (!finishes_sample(&v, number(k, 0), number(k, 1), number(k, 2), &s, weights))
            continue;
        for (int i = 0; i < count; i++)
            sums[i] += sum_of(weights[i]);
        if (sum_of(s.weight) != sum_of(weights[v.finishes.shown]))
            fail_msg("the sample's weight is not that of the finish shown");
    }
    for (int i = 0; i < count; i++) {
        const double mean = sums[i] / SAMPLES, own = own_mean(&v.finishes.of[i]);
        if (fabs(mean - own) > 0.02 * own + 0.002)
            fail_msg("finish %d among %d, seen at %g: %g, alone %g", chosen[i], count, theta, mean, own);
    }
}

static void each_finish_is_unbiased(void **state)
{
    (void)state;
    for (int a = 0; a < FINISHES; a++)
        for (int b = 0; b < FINISHES; b++)
            check_means((const int[]){a, b}, 2, 0.2 + 0.1 * (a + b) / 2);
    check_means((const int[]){0, 3, 7, 5}, 4, 0.7);
    check_means((const int[]){1, 2, 4}, 3, 1.2);
}

static void densities_are_those_of_the_mixture(void **state)
{
    (void)state;
    const int chosen[] = {0, 2, 4, 6};
    enum { N = 300 };
    Vertex v;
    Split values[FINISHES_MAX], weights[FINISHES_MAX];
    double integral = 0;
    int found = 0;
    begin(&v, chosen, 4, 0.6);
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            const double cosine = (i + 0.5) / N, phi = 2 * PI * (j + 0.5) / N, sine = sqrt(1 - cosine * cosine);
            float pdf;
            finishes_eval(&v, vec3(sine * cos(phi), sine * sin(phi), cosine), BSDF_ANY_LIGHT, values, &pdf);
            integral += (double)pdf * 2 * PI / N / N;
        }
    for (int k = 0; k < SAMPLES; k++) {
        BsdfSample s;
        float pdf;
        if (!finishes_sample(&v, number(k, 0), number(k, 1), number(k, 2), &s, weights))
            continue;
        const Split shown = finishes_eval(&v, s.wi, BSDF_ANY_LIGHT, values, &pdf);
        found++;
        if (fabsf(pdf - s.pdf) > 1e-5f * pdf)
            fail_msg("density %g, evaluated %g", (double)s.pdf, (double)pdf);
        if (fabs(sum_of(shown) / (double)pdf - sum_of(s.weight)) > 1e-4 * sum_of(s.weight))
            fail_msg("weight %g, value over density %g", sum_of(s.weight), sum_of(shown) / (double)pdf);
    }
    if (fabs(integral - (double)found / SAMPLES) > 0.01)
        fail_msg("the density integrates to %g; %g of the samples scatter", integral, (double)found / SAMPLES);
}

/* A mirror beside a matt finish has half of the samples, and its weight is so much higher; two mirrors share them. */
static void deltas_share_directions(void **state)
{
    (void)state;
    Vertex v;
    Split weights[FINISHES_MAX];
    BsdfSample s;
    begin(&v, (const int[]){0, 3}, 2, 0.5);
    const Bsdf *mirror = &v.finishes.of[1];
    assert_true(finishes_sample(&v, 0.01f, 0.5f, 0.5f, &s, weights));
    assert_true(s.pdf == 0 && sum_of(weights[0]) == 0);
    assert_true(fabs(sum_of(weights[1]) - 2 * sum_of(mirror->mirror) / (double)mirror->p_mirror) < 1e-5);
    begin(&v, (const int[]){3, 7}, 2, 0.5);
    assert_true(finishes_sample(&v, 0.01f, 0.5f, 0.5f, &s, weights));
    for (int k = 0; k < 2; k++) {
        const Bsdf *b = &v.finishes.of[k];
        const double p = (double)(v.finishes.of[0].p_mirror + v.finishes.of[1].p_mirror) / 2;
        assert_true(fabs(sum_of(weights[k]) - sum_of(b->mirror) / p) < 1e-5);
    }
}

static void deltas_come_first(void **state)
{
    (void)state;
    Vertex v;
    Split weights[FINISHES_MAX];
    begin(&v, (const int[]){0, 3, 5, 7}, 4, 0.9);
    const float wide = finishes_wide_probability(&v);
    for (int k = 0; k < 1000; k++) {
        BsdfSample s;
        const float u = ((float)k + 0.5f) / 1000;
        if (fabsf(u - (1 - wide)) > 1e-4f && finishes_sample(&v, u, 0.3f, 0.7f, &s, weights))
            assert_int_equal(s.pdf == 0, u < 1 - wide);
    }
}

/* ---- combinations ---- */

static Scene *begin_scene(int ntargets, int nlamps)
{
    Scene *scene = calloc(1, sizeof *scene);
    assert_non_null(scene);
    scene->ntargets = ntargets, scene->nlamps = nlamps;
    for (int t = 0; t < ntargets; t++)
        snprintf(scene->targets[t].name, sizeof scene->targets[t].name, "T%d", t);
    for (int l = 0; l < nlamps; l++)
        scene->lamps[l] = (Lamp){.value = rgb(1, 2, 3), .kept = rgb(1, 2, 3), .name = {(char)('A' + l)}};
    return scene;
}

static void combinations_are_numbered(void **state)
{
    (void)state;
    const char *const specs[] = {"T0=matt,satin,metal", "t2=Polished,original"}, *const shown[] = {"T0=satin",
                                                                                                   "T2=original"};
    RetexError err;
    Scene *scene = begin_scene(3, 2);
    assert_int_equal(scene_resolve_finishes(scene, specs, 2, shown, 2, &err), 0);
    assert_int_equal(scene->ncombinations, 6);
    assert_int_equal(scene->nkept, 14);
    assert_string_equal(scene->targets[2].finishes[0].name, "polished");
    for (int c = 0; c < 6; c++) {
        assert_int_equal(scene->finish_of[c][0], c % 3);
        assert_int_equal(scene->finish_of[c][1], 0);
        assert_int_equal(scene->finish_of[c][2], c / 3);
    }
    assert_int_equal(scene->shown, 1 + 3);
    for (int k = 0; k < scene->nkept; k++) {
        const KeptLight *kept = &scene->kept[k];
        const RetexParameter p = kept_parameter(scene, k);
        assert_int_equal(k, scene_kept(scene, kept->lamp, kept->combination));
        assert_string_equal(p.lamp, scene->lamps[kept->lamp].name);
        const float by = kept->combination < 0 ? 1 : 1.0f / 6,
                    is_shown = kept->combination < 0 || kept->combination == 4;
        for (int c = 0; c < 3; c++) {
            assert_true(fabsf(p.kept[c] - by * (float)(c + 1)) < 1e-6f);
            assert_true(p.value[c] == is_shown * (float)(c + 1));
        }
        for (int t = 0; t < 3; t++)
            assert_int_equal(p.finishes[t],
                             kept->combination < 0 || t == 1 ? 0 : 1 + scene->finish_of[kept->combination][t]);
    }
    free(scene);
}

static void limits_hold(void **state)
{
    (void)state;
    static const struct {
        int lamps, works;
        const char *specs[3];
    } cases[] = {
        {0, 1, {"T0=matt,satin,metal,polished", "T1=matt,satin"}},
        {0, 0, {"T0=matt,satin,metal,polished", "T1=matt,satin,metal"}},
        {9, 1, {"T0=matt,satin"}},
        {10, 0, {"T0=matt,satin"}},
        {3, 1, {"T0=matt,satin,metal,polished", "T1=matt,satin"}},
        {4, 0, {"T0=matt,satin,metal,polished", "T1=matt,satin"}},
        {17, 1, {"T0=matt"}},
        {0, 0, {"T0=matt", "T0=satin"}},
        {0, 0, {"T0="}},
        {0, 0, {"T0=matt,"}},
        {0, 0, {"=matt"}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Scene *scene = begin_scene(2, cases[k].lamps);
        const int nspecs = cases[k].specs[1] ? 2 : 1;
        RetexError err = {0};
        const int code = scene_resolve_finishes(scene, cases[k].specs, nspecs, NULL, 0, &err);
        if ((code == 0) != cases[k].works || scene->nkept > KEPT_MAX)
            fail_msg("case %zu: %d, %d kept: %s", k, code, scene->nkept, err.message);
        free(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_finish_is_unbiased),   cmocka_unit_test(densities_are_those_of_the_mixture),
        cmocka_unit_test(deltas_share_directions),   cmocka_unit_test(deltas_come_first),
        cmocka_unit_test(combinations_are_numbered), cmocka_unit_test(limits_hold),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("finishes", tests, NULL, NULL);
}
