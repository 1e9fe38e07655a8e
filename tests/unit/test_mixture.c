/* Terms with a mixture, whose values are known by hand: with new textures on either target, on both, on none; through
 * files, streams and packs; and mixtures that are not whole. */
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

enum { PIXELS = 3, FLOOR_FIRST = 0, FLOOR_LATER, WALL_FIRST, WALL_LATER };

static char path[64];

static int make_path(void **state)
{
    (void)state;
    strcpy(path, "/tmp/retex-mixture-XXXXXX");
    const int descriptor = mkstemp(path);
    return descriptor < 0 ? -1 : close(descriptor);
}

static int remove_path(void **state)
{
    (void)state;
    return unlink(path);
}

/* ---- the set: three pixels side by side ---- */

static int add_part(RetexSet *set, const char *name, const char *letters, RetexPixelType type)
{
    RetexError err = {0};
    int part;
    test_must(retex_set_add_part(set, name, letters, type, 0, 0, &part, &err), &err);
    return part;
}

static void add_footprint(RetexSet *set, int target, int hit, RetexFootprintKind kind, float albedo)
{
    RetexFootprint f = {.target = target, .hit = hit, .kind = kind};
    RetexError err = {0};
    char name[32];
    snprintf(name, sizeof name, "uv_%d_%d", target, hit);
    f.uv = add_part(set, name, "RGA", RETEX_FLOAT);
    snprintf(name, sizeof name, "spread_%d_%d", target, hit);
    f.spread = add_part(set, name, "RGB", RETEX_HALF);
    snprintf(name, sizeof name, "albedo_%d_%d", target, hit);
    f.albedo = add_part(set, name, "RGB", RETEX_HALF);
    for (size_t i = 0; i < PIXELS; i++) {
        set->parts[f.uv].image.pixels[3 * i + 2] = 1;
        for (size_t c = 0; c < 3; c++)
            set->parts[f.albedo].image.pixels[3 * i + c] = albedo;
    }
    test_must(retex_set_add_footprint(set, &f, NULL, &err), &err);
}

static void add_share(RetexSet *set, int footprint, const float *weights)
{
    RetexShare *share = &set->mixture[set->nmixture];
    share->footprint = footprint;
    share->weight = add_part(set, set->nmixture++ ? "share_1" : "share_0", "R", RETEX_HALF);
    memcpy(set->parts[share->weight].image.pixels, weights, PIXELS * sizeof *weights);
}

/* Of every pixel's light green has twice what red has, blue nothing. */
static void add_term(RetexSet *set, float light, int nfactors, int first, int second, int nmixed)
{
    RetexTerm term = {.nfactors = nfactors, .factors = {first, second}, .nmixed = nmixed};
    RetexError err = {0};
    char name[32];
    term.kind = nfactors ? RETEX_TERM_DEP : RETEX_TERM_INDEP;
    snprintf(name, sizeof name, "term_%d", set->nterms);
    term.radiance = add_part(set, name, "RGB", RETEX_HALF);
    for (size_t i = 0; i < PIXELS; i++) {
        set->parts[term.radiance].image.pixels[3 * i] = light;
        set->parts[term.radiance].image.pixels[3 * i + 1] = 2 * light;
    }
    test_must(retex_set_add_term(set, &term, NULL, &err), &err);
}

/* The floor is 0.5, the wall 0.25. Of the mixture the left pixel's is a quarter floor, three quarters wall; the next
 * has none; the right one's is all floor. */
static RetexSet *make_set(void)
{
    static const float floor_shares[PIXELS] = {0.25f, 0, 1}, wall_shares[PIXELS] = {0.75f, 0, 0};
    RetexSet *set;
    RetexError err = {0};
    test_must(retex_set_create(&set, PIXELS, 1, &err), &err);
    strcpy(set->layout, "footprints");
    set->spp = 1, set->orders = 6;
    set->ntargets = 2;
    strcpy(set->targets[0].name, "Floor");
    strcpy(set->targets[1].name, "Wall");
    set->targets[0].original = set->targets[1].original = -1;
    add_part(set, "beauty", "RGB", RETEX_HALF);
    add_footprint(set, 0, 1, RETEX_FOOTPRINT_SHARP, 0.5f);
    add_footprint(set, 0, 2, RETEX_FOOTPRINT_LATER, 0.5f);
    add_footprint(set, 1, 1, RETEX_FOOTPRINT_SHARP, 0.25f);
    add_footprint(set, 1, 2, RETEX_FOOTPRINT_LATER, 0.25f);
    add_share(set, FLOOR_LATER, floor_shares);
    add_share(set, WALL_LATER, wall_shares);
    add_term(set, 1, 0, 0, 0, 0);
    add_term(set, 2, 1, FLOOR_FIRST, 0, 0);
    add_term(set, 16, 1, FLOOR_FIRST, 0, 2);
    add_term(set, 64, 2, WALL_FIRST, FLOOR_LATER, 3);
    return set;
}

/* ---- its pictures ---- */

/* Red of each pixel, with m the mixture: 1 + 2 f + 16 f m^2 + 64 w f m^3. */
typedef struct Retexture {
    int white_floor, white_wall;
    float red[PIXELS];
} Retexture;

static const Retexture retextures[] = {
    /* m = 5/16, 0, 1/2: 1 + 1 + 25/32 + 125/512; 1 + 1; 1 + 1 + 2 + 1 */
    {0, 0, {3.025390625f, 2, 5}},
    /* m = 7/16, 0, 1: 1 + 2 + 49/16 + 343/256; 1 + 2; 1 + 2 + 16 + 16 */
    {1, 0, {7.40234375f, 3, 35}},
    /* m = 7/8, 0, 1/2: 1 + 1 + 49/8 + 343/16; 1 + 1; 1 + 1 + 2 + 4 */
    {0, 1, {29.5625f, 2, 8}},
    /* m = 1, 0, 1 */
    {1, 1, {83, 3, 83}},
};
enum { RETEXTURES = sizeof retextures / sizeof retextures[0] };

static RetexSamples *make_samples(const RetexSet *set, const Retexture *r, RetexSamples **variances)
{
    RetexTextureSpec specs[2] = {RETEX_TEXTURE_SPEC_INIT, RETEX_TEXTURE_SPEC_INIT};
    RetexSamples *samples = NULL;
    RetexError err = {0};
    int count = 0;
    if (r->white_floor)
        test_must(retex_texture_spec_parse(&specs[count++], "", "Floor=rgb(1,1,1)", &err), &err);
    if (r->white_wall)
        test_must(retex_texture_spec_parse(&specs[count++], "", "Wall=rgb(1,1,1)", &err), &err);
    if (count)
        test_must(retex_sample_with_variances(&samples, variances, set, specs, count, 1, &err), &err);
    return samples;
}

static void expect_picture(const RetexSet *set, const RetexSamples *samples, const Retexture *r)
{
    RetexImage picture = {0};
    RetexError err = {0};
    test_must(retex_combine(&picture, set, samples, NULL, NULL, 1, &err), &err);
    for (size_t i = 0; i < PIXELS; i++) {
        const float *got = picture.pixels + 3 * i;
        if (got[0] != r->red[i] || got[1] != 2 * r->red[i] || got[2] != 0)
            fail_msg("floor %d, wall %d, pixel %zu: %.9g %.9g %.9g, not %.9g", r->white_floor, r->white_wall, i,
                     (double)got[0], (double)got[1], (double)got[2], (double)r->red[i]);
    }
    retex_image_free(&picture);
}

static void test_by_hand(void **state)
{
    (void)state;
    RetexSet *set = make_set();
    for (int k = 0; k < RETEXTURES; k++) {
        RetexSamples *samples = make_samples(set, &retextures[k], NULL);
        expect_picture(set, samples, &retextures[k]);
        retex_samples_close(&samples);
    }
    retex_set_close(&set);
}

/* A term may have as many factors as there can be, mixed ones included. */
static void test_most_factors(void **state)
{
    (void)state;
    RetexSet *set = make_set();
    RetexImage picture = {0};
    RetexError err = {0};
    add_term(set, 4096, 2, FLOOR_FIRST, FLOOR_LATER, RETEX_MAX_FACTORS - 2);
    test_must(retex_combine(&picture, set, NULL, NULL, NULL, 1, &err), &err);
    assert_true(picture.pixels[3] == 2);
    assert_true(picture.pixels[6] == 6); /* 5 + 4096 / 2^12 */
    retex_image_free(&picture);
    retex_set_close(&set);
}

/* Constant colours have no error, whatever is mixed. */
static void test_error(void **state)
{
    (void)state;
    RetexSet *set = make_set();
    for (int k = 1; k < RETEXTURES; k++) {
        RetexImage error = {0};
        RetexError err = {0};
        RetexSamples *variances, *samples = make_samples(set, &retextures[k], &variances);
        test_must(retex_estimate_error(&error, set, samples, variances, NULL, NULL, 1, &err), &err);
        for (size_t i = 0; i < 3 * PIXELS; i++)
            assert_true(error.pixels[i] == 0);
        retex_image_free(&error);
        retex_samples_close(&samples);
        retex_samples_close(&variances);
    }
    retex_set_close(&set);
}

/* ---- there and back ---- */

static void test_file(void **state)
{
    (void)state;
    RetexSet *set = make_set(), *back;
    RetexError err = {0};
    test_must(retex_set_write(set, NULL, path, NULL, &err), &err);
    test_must(retex_set_check(path, 1, &err), &err);
    test_must(retex_set_read(path, &back, NULL, 1, &err), &err);
    for (int k = 0; k < RETEXTURES; k++) {
        RetexSamples *samples = make_samples(back, &retextures[k], NULL);
        expect_picture(back, samples, &retextures[k]);
        retex_samples_close(&samples);
    }
    retex_set_close(&set);
    retex_set_close(&back);
}

/* A stream keeps the shares, and of albedos only those that no sample replaces. */
static void test_stream(void **state)
{
    (void)state;
    RetexSet *set = make_set();
    for (int k = 1; k < RETEXTURES; k++) {
        RetexSamples *samples = make_samples(set, &retextures[k], NULL), *samples_back;
        RetexSet *back;
        RetexError err = {0};
        test_must(retex_set_write(set, samples, path, NULL, &err), &err);
        test_must(retex_set_read(path, &back, &samples_back, 1, &err), &err);
        assert_true(back->nparts < set->nparts);
        assert_int_equal(back->footprints[FLOOR_LATER].albedo < 0, retextures[k].white_floor);
        assert_int_equal(back->footprints[WALL_LATER].albedo < 0, retextures[k].white_wall);
        expect_picture(back, samples_back, &retextures[k]);
        retex_samples_close(&samples);
        retex_samples_close(&samples_back);
        retex_set_close(&back);
    }
    retex_set_close(&set);
}

static void test_pack(void **state)
{
    (void)state;
    RetexPackParams params = RETEX_PACK_INIT;
    RetexSet *set = make_set(), *back;
    RetexError err = {0};
    for (params.lossless = 0; params.lossless < 2; params.lossless++) {
        test_must(retex_pack_write(set, path, &params, NULL, &err), &err);
        test_must(retex_set_read(path, &back, NULL, 1, &err), &err);
        assert_int_equal(back->nmixture, 2);
        for (int i = 0; i < 2; i++) { /* shares keep every bit */
            const RetexPart *before = &set->parts[set->mixture[i].weight],
                            *after = &back->parts[back->mixture[i].weight];
            assert_int_equal(back->mixture[i].footprint, set->mixture[i].footprint);
            assert_memory_equal(before->image.pixels, after->image.pixels, PIXELS * sizeof(float));
        }
        for (int i = 0; i < set->nterms; i++)
            assert_int_equal(back->terms[i].nmixed, set->terms[i].nmixed);
        for (int k = 0; k < RETEXTURES && params.lossless; k++) {
            RetexSamples *samples = make_samples(back, &retextures[k], NULL);
            expect_picture(back, samples, &retextures[k]);
            retex_samples_close(&samples);
        }
        retex_set_close(&back);
    }
    retex_set_close(&set);
}

/* ---- what is not whole ---- */

static void expect_failure(const RetexSet *set, const char *says)
{
    RetexImage picture = {0};
    RetexError err = {0};
    assert_int_equal(retex_combine(&picture, set, NULL, NULL, NULL, 1, &err), RETEX_EFORMAT);
    if (!strstr(err.message, says))
        fail_msg("\"%s\"", err.message);
    assert_null(picture.pixels);
}

static void test_not_whole(void **state)
{
    (void)state;
    RetexSet *set = make_set();
    RetexError err = {0};
    int small;
    test_must(retex_set_add_part(set, "small", "R", RETEX_HALF, 2, 1, &small, &err), &err);
    const int places[] = {0, small, set->footprints[0].spread};
    const RetexShare share = set->mixture[1];
    for (size_t k = 0; k < sizeof places / sizeof places[0]; k++) {
        set->mixture[1].weight = places[k];
        expect_failure(set, "mixture lacks a footprint or its weight");
    }
    set->mixture[1] = share;
    set->mixture[1].footprint = set->nfootprints;
    expect_failure(set, "mixture lacks a footprint or its weight");
    set->mixture[1] = share;
    set->footprints[WALL_LATER].albedo = -1; /* as in a stream whose samples are not at hand */
    expect_failure(set, "mixture lacks a footprint or its weight");
    set->nmixture = 0;
    expect_failure(set, "term 2 of the set lacks");
    set->terms[2].nmixed = set->terms[3].nmixed = 0;
    RetexImage picture = {0};
    test_must(retex_combine(&picture, set, NULL, NULL, NULL, 1, &err), &err); /* needs no mixture */
    retex_image_free(&picture);
    set->terms[2].nmixed = -1;
    expect_failure(set, "term 2 of the set lacks");
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_by_hand),   cmocka_unit_test(test_most_factors), cmocka_unit_test(test_error),
        cmocka_unit_test(test_file),      cmocka_unit_test(test_stream),       cmocka_unit_test(test_pack),
        cmocka_unit_test(test_not_whole),
    };
    return cmocka_run_group_tests(tests, make_path, remove_path);
}
