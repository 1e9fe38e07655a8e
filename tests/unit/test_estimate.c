/* The expected error of retexturing: its formula on one pixel, and the variance of textures within footprints. */
#include "lib_error.h"
#include "lib_test.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "retexture/estimate_row.h"

static char path[64];

static int make_path(void **state)
{
    (void)state;
    strcpy(path, "/tmp/retex-estimate-XXXXXX.exr");
    const int descriptor = mkstemps(path, 4);
    return descriptor < 0 ? -1 : close(descriptor);
}

static int remove_path(void **state)
{
    (void)state;
    return unlink(path);
}

/* ---- textures ---- */

/* Store four by four texels, a quarter of them mean + 3 contrast, the others mean - contrast, and name them. */
static RetexTextureSpec store_texture(const char *target, float mean, float contrast, float alpha)
{
    RetexImage im = {0};
    RetexError err = {0};
    test_must(retex_image_alloc(&im, 4, 4, 4, &err), &err);
    for (int i = 0; i < 16; i++)
        for (int c = 0; c < 4; c++)
            im.pixels[4 * i + c] = c == 3 ? alpha : mean + (i % 2 && i / 4 % 2 ? 3 : -1) * contrast;
    test_must(retex_image_write(&im, path, NULL, 1, &err), &err);
    retex_image_free(&im);
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    snprintf(spec.target, sizeof spec.target, "%s", target);
    snprintf(spec.image, sizeof spec.image, "%s", path);
    return spec;
}

static RetexTextureSpec constant_spec(const char *target, float r, float g, float b)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    snprintf(spec.target, sizeof spec.target, "%s", target);
    spec.constant = 1;
    spec.color[0] = r, spec.color[1] = g, spec.color[2] = b;
    return spec;
}

/* ---- a set of one pixel ---- */

#define NONE INT_MIN

static int add_part(RetexSet *set, const char *name, const char *letters, float a, float b, float c)
{
    RetexError err = {0};
    int part;
    test_must(retex_set_add_part(set, name, letters, RETEX_FLOAT, 0, 0, &part, &err), &err);
    float *pixel = set->parts[part].image.pixels;
    pixel[0] = a, pixel[1] = b, pixel[2] = c;
    return part;
}

static int add_footprint(RetexSet *set, RetexFootprintKind kind, float coverage, float sd)
{
    char name[64];
    RetexError err = {0};
    RetexFootprint footprint = {.target = 0, .hit = set->nfootprints + 1, .kind = kind};
    snprintf(name, sizeof name, "uv%d", set->nfootprints);
    footprint.uv = add_part(set, name, "RGA", 0.3f, 0.6f, coverage);
    snprintf(name, sizeof name, "spread%d", set->nfootprints);
    footprint.spread = add_part(set, name, "RGB", sd, sd, 0);
    snprintf(name, sizeof name, "albedo%d", set->nfootprints);
    footprint.albedo = add_part(set, name, "RGB", 0.5f, 0.5f, 0.5f);
    int index;
    test_must(retex_set_add_footprint(set, &footprint, &index, &err), &err);
    return index;
}

/* radiance times A_a B_b^powers, of footprints or mixtures; a = NONE: times nothing. */
static void add_term(RetexSet *set, float radiance, int a, int b, int powers)
{
    char name[64];
    RetexError err = {0};
    int numbers[RETEX_MAX_HITS], count = 0;
    snprintf(name, sizeof name, "term%d", set->nterms);
    if (a != NONE)
        numbers[count++] = a;
    for (int k = 0; k < powers; k++)
        numbers[count++] = b;
    const RetexTerm term = test_term(set, add_part(set, name, "RGB", radiance, 2 * radiance, 0), count, numbers);
    test_must(retex_set_add_term(set, &term, NULL, &err), &err);
}

static RetexSet *small_set(int spp)
{
    RetexSet *set = NULL;
    RetexError err = {0};
    test_must(retex_set_create(&set, 1, 1, &err), &err);
    strcpy(set->layout, "footprints");
    strcpy(set->filter, "box");
    set->spp = spp;
    set->ntargets = 1;
    strcpy(set->targets[0].name, "Floor");
    set->targets[0].original = -1;
    add_part(set, "beauty", "RGB", 1, 1, 1);
    return set;
}

/* Lays a texture on the set that shows these numbers, one a footprint. */
static void lay_values(RetexSet *set, const float *values)
{
    RetexTextureSpec spec = constant_spec("Floor", 0, 0, 0);
    RetexError err = {0};
    test_must(retex_sample(set, &spec, 1, 1, &err), &err);
    for (int i = 0; i < set->nfootprints; i++)
        for (int c = 0; c < 3; c++)
            test_laid(set, i)->pixels[c] = values[i];
}

static void estimate(float rgb[3], RetexSet *set, const float *values, const float *variances)
{
    float (*scatter)[3] = calloc((size_t)set->nfootprints, sizeof *scatter);
    assert_true(scatter);
    const float **rows = calloc((size_t)set->nfootprints, sizeof *rows);
    assert_true(rows);
    RetexEdited edited;
    RetexDerivatives derivatives;
    RetexViewReader reader;
    RetexError err = {0};
    for (int i = 0; i < set->nfootprints; i++)
        rows[i] = scatter[i], scatter[i][0] = scatter[i][1] = scatter[i][2] = variances[i];
    lay_values(set, values);
    test_must(retex_edited_open(&edited, set, NULL, NULL, EDITED_TERMS, 1, &err), &err);
    test_must(retex_derivatives_open(&derivatives, &edited, &err), &err);
    test_must(retex_view_reader_open(&reader, &edited.view, &err), &err);
    float *scratch = malloc(sizeof *scratch * retex_estimate_scratch(&derivatives));
    assert_true(scratch);
    test_must(retex_estimate_row(&derivatives, &reader, 0, rows, rows, scratch, rgb, &err), &err);
    retex_view_reader_close(&reader);
    retex_derivatives_close(&derivatives);
    retex_edited_close(&edited);
    free(scratch);
    free(rows);
    free(scatter);
}

/* How much light and texture are taken to agree, by kind: what is left of a footprint that endless paths met. */
static double agreement(RetexFootprintKind kind)
{
    static const float one = 1;
    RetexSet *set = small_set(1 << 30);
    float rgb[3];
    add_term(set, 1, add_footprint(set, kind, 1, 0), 0, 0);
    estimate(rgb, set, &one, &one);
    retex_set_close(&set);
    return (double)rgb[0];
}

/* The chance of a footprint seen sharply is 0.3 of what independent samples would leave. */
static void the_formula_holds_on_a_pixel(void **state)
{
    (void)state;
    static const float a[2] = {0.4f, 0.2f}, var[2] = {0.04f, 0.01f};
    RetexSet *set = small_set(16);
    int sharp = add_footprint(set, RETEX_FOOTPRINT_SHARP, 0.5f, 0),
        later = add_footprint(set, RETEX_FOOTPRINT_INTERREFLECTION, 0.25f, 0);
    add_term(set, 0.5f, NONE, 0, 0);
    add_term(set, 2, sharp, 0, 0);
    add_term(set, 3, sharp, later, 1);
    add_term(set, 5, sharp, later, 2);
    set->folded = 0.1;
    double value = 0.5 + 2 * 0.4 + 3 * 0.4 * 0.2 + 5 * 0.4 * 0.2 * 0.2;
    double by_sharp = 2 + 3 * 0.2 + 5 * 0.2 * 0.2, by_later = 3 * 0.4 + 2 * 5 * 0.4 * 0.2;
    double k0 = agreement(RETEX_FOOTPRINT_SHARP), k1 = agreement(RETEX_FOOTPRINT_INTERREFLECTION);
    double want = sqrt(by_sharp * by_sharp * 0.04 * (k0 * k0 + 0.3 / 8) +
                       by_later * by_later * 0.01 * (k1 * k1 + 1.0 / 4) + 0.1 * value * 0.1 * value);
    float rgb[3];
    estimate(rgb, set, a, var);
    assert_float_equal(rgb[0], want, 1e-5 * want);
    assert_float_equal(rgb[1], 2 * want, 2e-5 * want); /* twice the light */
    assert_float_equal(rgb[2], 0, 0);
    retex_set_close(&set);
}

/* A tenth of what further hits change is in doubt, and nothing of the light that is folded besides. */
static void further_hits_are_in_doubt(void **state)
{
    (void)state;
    static const float a[2] = {0.4f, 0.2f}, var[2] = {0, 0};
    RetexSet *set = small_set(16);
    const int sharp = add_footprint(set, RETEX_FOOTPRINT_SHARP, 0.5f, 0),
              later = add_footprint(set, RETEX_FOOTPRINT_INTERREFLECTION, 0.25f, 0);
    RetexTerm *term;
    add_term(set, 2, sharp, 0, 0);
    add_term(set, 5, sharp, later, 2);
    term = &set->terms[set->nterms - 1];
    term->factors[term->nfactors] = term->factors[term->nfactors - 1];
    term->factors[term->nfactors++].quantity = RETEX_QUANTITY_FURTHER;
    set->folded = 0.1, set->further_hits = 2;
    for (int c = 0; c < 3; c++)
        set->further_ratio[c] = 0.5f;
    const double albedo = (double)set->parts[set->footprints[later].albedo].image.pixels[0];
    const double q = 0.5, now = 1 + q * 0.2 + q * 0.2 * q * 0.2, then = 1 + q * albedo + q * albedo * q * albedo;
    const double want = 0.1 * fabs(5 * 0.4 * 0.2 * 0.2 * (now / then - 1));
    float rgb[3];
    estimate(rgb, set, a, var);
    assert_true(want > 0);
    assert_float_equal(rgb[0], want, 1e-4 * want);
    retex_set_close(&set);
}

static void agreements_are_shares(void **state)
{
    (void)state;
    static const RetexFootprintKind kinds[] = {RETEX_FOOTPRINT_HIT, RETEX_FOOTPRINT_SHARP, RETEX_FOOTPRINT_BROAD,
                                               RETEX_FOOTPRINT_INTERREFLECTION};
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++)
        assert_true(agreement(kinds[k]) > 0 && agreement(kinds[k]) < 1);
}

/* Fewer than one path meets nothing: a footprint of next to no coverage does not make the error endless. */
static void one_path_is_the_least(void **state)
{
    (void)state;
    static const float one = 1;
    float rgb[2][3];
    for (int i = 0; i < 2; i++) {
        RetexSet *set = small_set(1);
        add_term(set, 1, add_footprint(set, RETEX_FOOTPRINT_SHARP, i ? 1 : 1e-30f, 0), 0, 0);
        estimate(rgb[i], set, &one, &one);
        retex_set_close(&set);
    }
    assert_memory_equal(rgb[0], rgb[1], sizeof rgb[0]);
}

/* ---- mixtures ---- */

static struct RetexShare share(RetexSet *set, int footprint, const char *letters, float r, float g, float b)
{
    char name[64];
    RetexError err = {0};
    struct RetexShare share = {.footprint = footprint};
    snprintf(name, sizeof name, "share%d", set->nparts);
    test_must(retex_set_add_part(set, name, letters, RETEX_FLOAT, 0, 0, &share.weight, &err), &err);
    float *pixel = set->parts[share.weight].image.pixels;
    pixel[0] = r;
    if (letters[1])
        pixel[1] = g, pixel[2] = b;
    return share;
}

static int add_mixture(RetexSet *set, struct RetexShare first, struct RetexShare second)
{
    RetexError err = {0};
    RetexMixture mixture = {.nshares = 2, .shares = {first, second}};
    int index;
    test_must(retex_set_add_mixture(set, &mixture, &index, &err), &err);
    return MIXTURE(index);
}

/* What scatters with a mixture are its footprints, by their shares, on top of what each does by itself. */
static void a_mixture_scatters_with_its_footprints(void **state)
{
    (void)state;
    static const float a[3] = {0.4f, 0.2f, 0.8f}, var[3] = {0.04f, 0.01f, 0.09f};
    RetexSet *set = small_set(16);
    int sharp = add_footprint(set, RETEX_FOOTPRINT_SHARP, 0.5f, 0);
    int later[2];
    for (int k = 0; k < 2; k++)
        later[k] = add_footprint(set, RETEX_FOOTPRINT_INTERREFLECTION, 0.25f, 0);
    /* m = 1/4 later1 + 3/4 later2; n = 1/2 sharp + 1/2 later2 in red, all later2 in green */
    int m = add_mixture(set, share(set, later[0], "R", 0.5f, 0, 0), share(set, later[1], "R", 1.5f, 0, 0));
    int n = add_mixture(set, share(set, sharp, "RGB", 2, 0, 1), share(set, later[1], "RGB", 2, 3, 1));
    add_term(set, 2, sharp, 0, 0);
    add_term(set, 3, sharp, m, 2);
    add_term(set, 5, n, m, 1);
    const double mean = 0.25 * 0.2 + 0.75 * 0.8, of[3] = {0.04, 0.01, 0.09};
    double squares[3], sums[2] = {0, 0};
    for (int f = 0; f < 3; f++) {
        double k = agreement(f ? RETEX_FOOTPRINT_INTERREFLECTION : RETEX_FOOTPRINT_SHARP),
               chance = f ? 1.0 / 4 : 0.3 / 8;
        squares[f] = of[f] * (k * k + chance);
    }
    for (int green = 0; green < 2; green++) {
        double by_n = 5 * mean, other = green ? 0.8 : 0.5 * 0.4 + 0.5 * 0.8, by_m = 2 * 3 * 0.4 * mean + 5 * other;
        double by[3] = {2 + 3 * mean * mean + (green ? 0 : 0.5) * by_n, 0.25 * by_m,
                        0.75 * by_m + (green ? 1 : 0.5) * by_n};
        for (int f = 0; f < 3; f++)
            sums[green] += by[f] * by[f] * squares[f];
    }
    float rgb[3];
    estimate(rgb, set, a, var);
    assert_float_equal(rgb[0], sqrt(sums[0]), 1e-5 * sqrt(sums[0]));
    assert_float_equal(rgb[1], 2 * sqrt(sums[1]), 2e-5 * sqrt(sums[1]));
    assert_float_equal(rgb[2], 0, 0);
    retex_set_close(&set);
}

static void a_mixture_of_nothing_scatters_nothing(void **state)
{
    (void)state;
    static const float a[2] = {0.4f, 0.2f}, var[2] = {0.04f, 0.01f};
    RetexSet *set = small_set(16);
    int one = add_footprint(set, RETEX_FOOTPRINT_INTERREFLECTION, 0.5f, 0),
        two = add_footprint(set, RETEX_FOOTPRINT_INTERREFLECTION, 1, 0);
    add_term(set, 3, add_mixture(set, share(set, one, "R", 0, 0, 0), share(set, two, "RGB", 0, 0, 0)), 0, 0);
    float rgb[3];
    estimate(rgb, set, a, var);
    for (int c = 0; c < 3; c++)
        assert_true(rgb[c] == 0);
    retex_set_close(&set);
}

/* ---- textures within footprints ---- */

static void a_wide_footprint_sees_all_of_a_texture(void **state)
{
    (void)state;
    static const RetexFootprintKind kinds[] = {RETEX_FOOTPRINT_SHARP, RETEX_FOOTPRINT_BROAD, RETEX_FOOTPRINT_HIT};
    for (size_t k = 0; k < 3; k++) {
        RetexSet *set = small_set(16);
        RetexError err = {0};
        int wide = add_footprint(set, kinds[k], 1, 6), none = add_footprint(set, kinds[k], 0, 6);
        RetexTextureSpec spec = store_texture("Floor", 0.375f, 0.125f, 1); /* 0.75 over a quarter, else 0.25 */
        test_must(retex_sample(set, &spec, 1, 2, &err), &err);
        for (int c = 0; c < 3; c++)
            assert_float_equal(test_laid(set, wide)->pixels[c], 0.375f, 0.01f);
        test_lay_variances(set, &spec, 1);
        for (int c = 0; c < 3; c++) {
            assert_float_equal(test_laid(set, wide)->pixels[c], 0.25f * 0.75f * 0.5f * 0.5f, 0.002f);
            assert_float_equal(test_laid(set, none)->pixels[c], 0, 0);
        }
        /* through a texture half clear half as much is seen of how it scatters */
        spec = store_texture("Floor", 0.375f, 0.125f, 0.5f);
        test_lay_variances(set, &spec, 1);
        for (int c = 0; c < 3; c++)
            assert_float_equal(test_laid(set, wide)->pixels[c], 0.25f * 0.75f * 0.5f * 0.5f / 4, 0.001f);
        retex_set_close(&set);
    }
}

static void what_is_even_does_not_scatter(void **state)
{
    (void)state;
    RetexSet *set = test_set(40, 20, 3);
    for (int image = 0; image < 2; image++) {
        RetexTextureSpec specs[2] = {constant_spec("Floor", 0.3f, 0.6f, 4), constant_spec("Wall", 0, 0, 0)};
        if (image)
            specs[0] = store_texture("Floor", 0.3f, 0, 1);
        test_lay_variances(set, specs, 1 + image);
        for (int i = 0; i < set->nfootprints; i++)
            for (size_t n = 0; test_laid(set, i) && n < 40 * 20 * 3; n++)
                assert_true(test_laid(set, i)->pixels[n] >= 0 && test_laid(set, i)->pixels[n] < 1e-6f);
    }
    retex_set_close(&set);
}

/* ---- pictures ---- */

static void constants_have_only_what_was_folded(void **state)
{
    (void)state;
    RetexSet *set = test_set(40, 30, 2);
    test_make_footprints(set);
    RetexTextureSpec specs[2] = {constant_spec("Floor", 0.3f, 0.6f, 0), constant_spec("Wall", 0.9f, 0.9f, 0.5f)};
    for (int folded = 0; folded < 2; folded++) {
        set->folded = 0.25 * folded;
        RetexImage error = test_error(set, specs, 2, 2), picture = {0};
        test_combine(&picture, set, specs, 2, NULL);
        for (size_t i = 0; i < 40 * 30 * 3; i++) /* how colours of one value scatter is off by a float's rounding */
            assert_float_equal(error.pixels[i], set->folded * (double)picture.pixels[i],
                               1e-3f * picture.pixels[i] + 1e-9f);
        retex_image_free(&picture);
        retex_image_free(&error);
    }
    retex_set_close(&set);
}

static void contrast_makes_errors(void **state)
{
    (void)state;
    RetexSet *set = test_set(40, 30, 2);
    double sums[3];
    for (int k = 0; k < 3; k++) {
        RetexTextureSpec spec = store_texture("Floor", 0.5f, ldexpf(1, k - 6), 1);
        RetexImage error = test_error(set, &spec, 1, 2);
        sums[k] = 0;
        for (size_t i = 0; i < 40 * 30 * 3; i++) {
            assert_true(isfinite(error.pixels[i]) && error.pixels[i] >= 0);
            sums[k] += (double)error.pixels[i];
        }
        retex_image_free(&error);
    }
    assert_true(sums[0] > 0);
    for (int k = 1; k < 3; k++) /* twice the contrast, twice the error; later hits see each other's colour, too */
        assert_true(fabs(sums[k] / sums[k - 1] - 2) < 0.01);
    retex_set_close(&set);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    RetexSet *set = test_set(150, 90, 4);
    test_make_footprints(set);
    RetexTextureSpec specs[2] = {store_texture("Wall", 0.4f, 0.1f, 1), constant_spec("Floor", 0.2f, 0.7f, 0)};
    RetexImage one = test_error(set, specs, 2, 1);
    for (int threads = 2; threads <= 7; threads += 5) {
        RetexImage again = test_error(set, specs, 2, threads);
        assert_memory_equal(one.pixels, again.pixels, 150 * 90 * 3 * sizeof(float));
        retex_image_free(&again);
    }
    retex_image_free(&one);
    retex_set_close(&set);
}

/* A set in its file, and samples in theirs, have the error that they have in memory. Textures go before samples of the
 * same target. */
static void files_change_nothing(void **state)
{
    (void)state;
    RetexSet *set = test_set(70, 90, 4), *open, *read, *samples;
    RetexError err = {0};
    char set_path[80], samples_path[80];
    snprintf(set_path, sizeof set_path, "%s.set.exr", path);
    snprintf(samples_path, sizeof samples_path, "%s.samples.exr", path);
    test_make_footprints(set);
    assert_true(set->nmixtures > 0);
    RetexTextureSpec wall = store_texture("Wall", 0.4f, 0.1f, 0.5f);
    RetexTextureSpec specs[2] = {constant_spec("Floor", 0.2f, 0.7f, 0), wall};
    test_must(retex_set_write(set, set_path, NULL, 0, &err), &err);
    test_must(retex_sample(set, specs, 2, 2, &err), &err);
    test_must(retex_set_write_samples(set, samples_path, NULL, 0, &err), &err);
    test_must(retex_set_read(set_path, &read, 1, &err), &err);
    test_must(retex_sample(read, specs, 2, 2, &err), &err);
    test_must(retex_set_open(set_path, &open, 1, &err), &err);
    test_must(retex_set_open_any(samples_path, &samples, 1, &err), &err);
    test_must(retex_set_lay(open, samples, &err), &err);
    RetexImage one = test_error(read, &wall, 1, 1), other = test_error(open, &wall, 1, 2);
    assert_memory_equal(one.pixels, other.pixels, 70 * 90 * 3 * sizeof(float));
    retex_image_free(&other);
    retex_set_lift(read, -1);
    other = test_error(read, specs, 2, 1);
    for (size_t i = 0; i < 70 * 90 * 3; i++) /* a constant's own error is rounding */
        assert_float_equal(one.pixels[i], other.pixels[i], 1e-3f * one.pixels[i] + 1e-9f);
    retex_image_free(&one);
    retex_image_free(&other);
    retex_set_close(&samples);
    retex_set_close(&set);
    retex_set_close(&read);
    retex_set_close(&open);
    unlink(set_path);
    unlink(samples_path);
}

static int refuse_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    (void)context, (void)y0, (void)y1, (void)rows;
    return retex_fail(err, RETEX_EIO, "no more rows");
}

static void mistakes_are_told(void **state)
{
    (void)state;
    RetexSet *set = test_set(20, 10, 4);
    RetexTextureSpec spec = constant_spec("Floor", 0.2f, 0.7f, 0);
    RetexTexture *textures[RETEX_MAX_TARGETS];
    RetexError err = {0};
    RetexCombineParams params = RETEX_COMBINE_INIT;
    test_must(retex_textures_load(textures, set, &spec, 1, 1, &err), &err);
    assert_int_equal(retex_estimate_error(set, textures, NULL, refuse_rows, NULL, 1, &err), RETEX_EIO);
    assert_string_equal(err.message, "no more rows");
    params.cross = 1;
    assert_int_equal(retex_estimate_error(set, textures, &params, refuse_rows, NULL, 1, &err), RETEX_EINVAL);
    retex_textures_close(textures);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_formula_holds_on_a_pixel),
        cmocka_unit_test(a_mixture_scatters_with_its_footprints),
        cmocka_unit_test(a_mixture_of_nothing_scatters_nothing),
        cmocka_unit_test(agreements_are_shares),
        cmocka_unit_test(further_hits_are_in_doubt),
        cmocka_unit_test(further_hits_are_in_doubt),
        cmocka_unit_test(one_path_is_the_least),
        cmocka_unit_test(a_wide_footprint_sees_all_of_a_texture),
        cmocka_unit_test(what_is_even_does_not_scatter),
        cmocka_unit_test(constants_have_only_what_was_folded),
        cmocka_unit_test(contrast_makes_errors),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(files_change_nothing),
        cmocka_unit_test(mistakes_are_told),
    };
    return cmocka_run_group_tests(tests, make_path, remove_path);
}
