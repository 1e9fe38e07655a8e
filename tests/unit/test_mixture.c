/* Terms with mixtures whose values are known by hand: with new textures on either target, on both and on none, through
 * files, streams and packs; and incomplete mixtures. */
#include "lib_error.h"
#include "lib_folder.h"
#include "lib_test.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

enum { PIXELS = 3, FLOOR_FIRST = 0, FLOOR_LATER, WALL_FIRST, WALL_LATER };
enum { LATER = MIXTURE(0), FIRST = MIXTURE(1) };

static const char *const path = test_own_file;

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

/* Of one floor and one wall; weights of one number a pixel ("R"), or of three. */
static void add_mixture(RetexSet *set, const char *letters, int floor, const float *floor_weights, int wall,
                        const float *wall_weights)
{
    const float *weights[2] = {floor_weights, wall_weights};
    RetexMixture mixture = {.nshares = 2, .shares = {{.footprint = floor}, {.footprint = wall}}};
    RetexError err = {0};
    for (int k = 0; k < 2; k++) {
        char name[32];
        snprintf(name, sizeof name, "share_%d_%d", set->nmixtures, k);
        int part = mixture.shares[k].weight = add_part(set, name, letters, RETEX_HALF);
        memcpy(set->parts[part].image.pixels, weights[k], PIXELS * strlen(letters) * sizeof *weights[k]);
    }
    int index;
    test_must(retex_set_add_mixture(set, &mixture, &index, &err), &err);
    assert_int_equal(index, set->nmixtures - 1);
}

/* Of every pixel's light green has twice what red has, blue nothing. The last factor may occur several times. */
static void add_term(RetexSet *set, float light, int nfactors, int first, int second, int others)
{
    int numbers[RETEX_MAX_HITS] = {first, second};
    RetexError err = {0};
    char name[32];
    for (int k = 2; k < nfactors; k++)
        numbers[k] = others;
    snprintf(name, sizeof name, "term_%d", set->nterms);
    const RetexTerm term = test_term(set, add_part(set, name, "RGB", RETEX_HALF), nfactors, numbers);
    for (size_t i = 0; i < PIXELS; i++) {
        set->parts[term.radiance].image.pixels[3 * i] = light;
        set->parts[term.radiance].image.pixels[3 * i + 1] = 2 * light;
    }
    test_must(retex_set_add_term(set, &term, NULL, &err), &err);
}

/* The floor is 0.5, the wall 0.25. Of the mixture of later ones the left pixel's is a quarter floor, three quarters
 * wall; the next has none; the right one's is all floor. Of first ones the left pixel's is floor in red, wall in green;
 * the next is three quarters floor in red, all wall in blue, and for green, which has no weight, what it is on the
 * whole: three eighths floor; the right one has none. */
static RetexSet *make_set(void)
{
    static const float floor_later[PIXELS] = {1, 0, 2}, wall_later[PIXELS] = {3, 0, 0};
    static const float floor_first[3 * PIXELS] = {0.5f, 0, 0, 3, 0, 0}, wall_first[3 * PIXELS] = {0, 7, 0, 1, 0, 4};
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
    add_footprint(set, 0, 2, RETEX_FOOTPRINT_INTERREFLECTION, 0.5f);
    add_footprint(set, 1, 1, RETEX_FOOTPRINT_SHARP, 0.25f);
    add_footprint(set, 1, 2, RETEX_FOOTPRINT_INTERREFLECTION, 0.25f);
    add_mixture(set, "R", FLOOR_LATER, floor_later, WALL_LATER, wall_later);
    add_mixture(set, "RGB", FLOOR_FIRST, floor_first, WALL_FIRST, wall_first);
    add_term(set, 1, 0, 0, 0, 0);
    add_term(set, 2, 1, FLOOR_FIRST, 0, 0);
    add_term(set, 16, 3, FLOOR_FIRST, LATER, LATER);
    add_term(set, 64, 5, WALL_FIRST, FLOOR_LATER, LATER);
    add_term(set, 8, 2, FIRST, FLOOR_LATER, 0);
    return set;
}

/* ---- its pictures ---- */

/* Red of each pixel and half its green, with m the mixture of later ones and n that of first ones:
 * 1 + 2 f + 16 f m^2 + 64 w f m^3 + 8 n f. */
typedef struct Retexture {
    int white_floor, white_wall;
    float red[PIXELS], half_green[PIXELS];
} Retexture;

static const Retexture retextures[] = {
    /* m = 5/16, 0, 1/2: 1 + 1 + 25/32 + 125/512; 1 + 1; 1 + 1 + 2 + 1;
     * n = 1/2, 7/16, 0 and 1/4, 11/32, 0: 2; 7/4; 0 and 1; 11/8; 0 */
    {0, 0, {5.025390625f, 3.75f, 5}, {4.025390625f, 3.375f, 5}},
    /* m = 7/16, 0, 1: 1 + 2 + 49/16 + 343/256; 1 + 2; 1 + 2 + 16 + 16;
     * n = 1, 13/16, 0 and 1/4, 17/32, 0: 8; 13/2; 0 and 2; 17/4; 0 */
    {1, 0, {15.40234375f, 9.5f, 35}, {9.40234375f, 7.25f, 35}},
    /* m = 7/8, 0, 1/2: 1 + 1 + 49/8 + 343/16; 1 + 1; 1 + 1 + 2 + 4;
     * n = 1/2, 5/8, 0 and 1, 13/16, 0: 2; 5/2; 0 and 4; 13/4; 0 */
    {0, 1, {31.5625f, 4.5f, 8}, {33.5625f, 5.25f, 8}},
    /* m = 1, 0, 1; n = 1, 1, 0 */
    {1, 1, {91, 11, 83}, {91, 11, 83}},
};
enum { RETEXTURES = sizeof retextures / sizeof retextures[0] };

static int make_specs(RetexTextureSpec specs[2], const Retexture *r)
{
    RetexError err = {0};
    int count = 0;
    specs[0] = specs[1] = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
    if (r->white_floor)
        test_must(test_texture_spec(&specs[count++], "", "Floor=rgb(1,1,1)", &err), &err);
    if (r->white_wall)
        test_must(test_texture_spec(&specs[count++], "", "Wall=rgb(1,1,1)", &err), &err);
    return count;
}

/* Lays the textures of a retexture on the set, and no others. */
static void lay(RetexSet *set, const Retexture *r)
{
    RetexTextureSpec specs[2] = {RETEX_TEXTURE_SPEC_INIT, RETEX_TEXTURE_SPEC_INIT};
    RetexError err = {0};
    const int count = make_specs(specs, r);
    retex_set_lift(set, -1);
    test_must(retex_sample(set, specs, count, 1, &err), &err);
}

static void expect_picture(const RetexSet *set, const Retexture *r)
{
    RetexImage picture = {0};
    RetexError err = {0};
    test_must(retex_combine(&picture, set, NULL, NULL, 1, &err), &err);
    for (size_t i = 0; i < PIXELS; i++) {
        const float *got = picture.pixels + 3 * i;
        if (got[0] != r->red[i] || got[1] != 2 * r->half_green[i] || got[2] != 0)
            fail_msg("floor %d, wall %d, pixel %zu: %.9g %.9g %.9g, not %.9g %.9g 0", r->white_floor, r->white_wall, i,
                     (double)got[0], (double)got[1], (double)got[2], (double)r->red[i], (double)(2 * r->half_green[i]));
    }
    retex_image_free(&picture);
}

static void test_by_hand(void **state)
{
    (void)state;
    RetexSet *set = make_set();
    for (int k = 0; k < RETEXTURES; k++) {
        lay(set, &retextures[k]);
        expect_picture(set, &retextures[k]);
    }
    retex_set_close(&set);
}

/* A term may have as many factors as there can be, mixtures among them. */
static void test_most_factors(void **state)
{
    (void)state;
    RetexSet *set = make_set();
    RetexImage picture = {0};
    RetexError err = {0};
    add_term(set, 4096, RETEX_MAX_HITS, FLOOR_FIRST, FLOOR_LATER, LATER);
    test_must(retex_combine(&picture, set, NULL, NULL, 1, &err), &err);
    assert_true(picture.pixels[3] == 3.75f);
    assert_true(picture.pixels[6] == 6); /* 5 + 4096 / 2^12 */
    retex_image_free(&picture);
    retex_set_close(&set);
}

/* And a mixture as many shares, a set as many mixtures. */
static void test_most_shares(void **state)
{
    (void)state;
    RetexSet *set = make_set();
    RetexMixture mixture = {.nshares = RETEX_SHARES_MAX};
    RetexImage picture = {0};
    RetexError err = {0};
    int weight = add_part(set, "eighth", "R", RETEX_HALF), index = 1;
    for (size_t i = 0; i < PIXELS; i++)
        set->parts[weight].image.pixels[i] = 0.125f;
    for (int k = 0; k < RETEX_SHARES_MAX; k++) /* a quarter of them wall: 7/16 */
        mixture.shares[k] = (struct RetexShare){k % 4 ? FLOOR_LATER : WALL_FIRST, weight};
    while (set->nmixtures < RETEX_MIXTURES_MAX)
        test_must(retex_set_add_mixture(set, &mixture, &index, &err), &err);
    assert_int_equal(index, RETEX_MIXTURES_MAX - 1);
    assert_int_equal(retex_set_add_mixture(set, &mixture, NULL, &err), RETEX_ELIMIT);
    assert_int_equal(set->nmixtures, RETEX_MIXTURES_MAX);
    add_term(set, 16, 1, MIXTURE(index), 0, 0);
    test_must(retex_set_write(set, path, NULL, 0, &err), &err);
    retex_set_close(&set);
    test_must(retex_set_read(path, &set, 1, &err), &err);
    assert_int_equal(set->nmixtures, RETEX_MIXTURES_MAX);
    assert_int_equal(set->mixtures[index].nshares, RETEX_SHARES_MAX);
    test_must(retex_combine(&picture, set, NULL, NULL, 1, &err), &err);
    for (size_t i = 0; i < PIXELS; i++)
        assert_true(picture.pixels[3 * i] == retextures[0].red[i] + 7);
    retex_image_free(&picture);
    retex_set_close(&set);
}

/* Constant colours have no error, whatever is mixed. */
static void test_no_error(void **state)
{
    (void)state;
    RetexSet *set = make_set();
    for (int k = 1; k < RETEXTURES; k++) {
        RetexTextureSpec specs[2] = {RETEX_TEXTURE_SPEC_INIT, RETEX_TEXTURE_SPEC_INIT};
        RetexImage error = test_error(set, specs, make_specs(specs, &retextures[k]), 1);
        for (size_t i = 0; i < 3 * PIXELS; i++)
            assert_true(error.pixels[i] == 0);
        retex_image_free(&error);
    }
    retex_set_close(&set);
}

/* ---- there and back ---- */

static void test_file(void **state)
{
    (void)state;
    RetexSet *set = make_set(), *back;
    RetexError err = {0};
    test_must(retex_set_write(set, path, NULL, 0, &err), &err);
    test_must(retex_set_check(path, 1, &err), &err);
    test_must(retex_set_read(path, &back, 1, &err), &err);
    for (int k = 0; k < RETEXTURES; k++) {
        lay(back, &retextures[k]);
        expect_picture(back, &retextures[k]);
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
        RetexSet *back;
        RetexError err = {0};
        lay(set, &retextures[k]);
        test_must(retex_set_write(set, path, NULL, 0, &err), &err);
        test_must(retex_set_read(path, &back, 1, &err), &err);
        assert_true(back->nparts < set->nparts);
        assert_int_equal(back->footprints[FLOOR_LATER].albedo < 0, retextures[k].white_floor);
        assert_int_equal(back->footprints[WALL_LATER].albedo < 0, retextures[k].white_wall);
        expect_picture(back, &retextures[k]);
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
        test_must(retex_pack_write(set, path, &params, NULL, 0, &err), &err);
        test_must(retex_set_read(path, &back, 1, &err), &err);
        assert_int_equal(back->nmixtures, 2);
        for (int m = 0; m < 2; m++) /* shares keep every bit, or stay within half a 64th of the largest */
            for (int i = 0; i < 2; i++) {
                const struct RetexShare *share = &set->mixtures[m].shares[i], *same = &back->mixtures[m].shares[i];
                const RetexPart *before = &set->parts[share->weight], *after = &back->parts[same->weight];
                assert_int_equal(same->footprint, share->footprint);
                assert_int_equal(after->image.channels, before->image.channels);
                float most = 0;
                for (size_t k = 0; k < PIXELS * (size_t)before->image.channels; k++)
                    most = fmaxf(most, before->image.pixels[k]);
                for (size_t k = 0; k < PIXELS * (size_t)before->image.channels; k++)
                    assert_true(fabsf(before->image.pixels[k] - after->image.pixels[k]) <=
                                (params.lossless ? 0 : most / 127));
            }
        for (int i = 0; i < set->nterms; i++) {
            assert_int_equal(back->terms[i].nfactors, set->terms[i].nfactors);
            assert_memory_equal(back->terms[i].factors, set->terms[i].factors, sizeof set->terms[i].factors);
        }
        for (int k = 0; k < RETEXTURES && params.lossless; k++) {
            lay(back, &retextures[k]);
            expect_picture(back, &retextures[k]);
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
    assert_int_equal(retex_combine(&picture, set, NULL, NULL, 1, &err), RETEX_EFORMAT);
    if (!strstr(err.message, says))
        fail_msg("\"%s\"", err.message);
    assert_null(picture.pixels);
}

static void test_not_whole(void **state)
{
    (void)state;
    static const char whole[] = "mixture of the set lacks a footprint or its weight";
    RetexSet *set = make_set();
    RetexError err = {0};
    int small;
    test_must(retex_set_add_part(set, "small", "R", RETEX_HALF, 2, 1, &small, &err), &err);
    const int places[] = {-1, small, add_part(set, "two", "RG", RETEX_HALF), set->nparts};
    struct RetexShare *share = &set->mixtures[1].shares[1];
    const struct RetexShare kept = *share;
    for (size_t k = 0; k < sizeof places / sizeof places[0]; k++) {
        share->weight = places[k];
        expect_failure(set, whole);
    }
    *share = kept;
    share->footprint = set->nfootprints;
    expect_failure(set, whole);
    *share = kept;
    set->footprints[WALL_LATER].albedo = -1; /* as in a stream whose samples are not at hand */
    expect_failure(set, whole);
    set->nmixtures = 0;
    expect_failure(set, "term 2 of the set lacks");
    for (int t = 2; t < set->nterms; t++)
        set->terms[t].nfactors = 0;
    RetexImage picture = {0};
    test_must(retex_combine(&picture, set, NULL, NULL, 1, &err), &err); /* needs no mixture */
    retex_image_free(&picture);
    const int factors[] = {MIXTURE(0), -INT_MAX, set->nfootprints, INT_MAX};
    for (size_t k = 0; k < sizeof factors / sizeof factors[0]; k++) {
        set->terms[1].factors[0] = test_factor(factors[k]);
        expect_failure(set, "term 1 of the set lacks");
    }
    set->terms[1].nfactors = -1;
    expect_failure(set, "term 1 of the set lacks");
    retex_set_close(&set);
}

/* What is wrong is not added. */
static void test_additions(void **state)
{
    (void)state;
    RetexSet *set = make_set();
    RetexError err = {0};
    int two = add_part(set, "two", "RG", RETEX_HALF), one = set->mixtures[0].shares[0].weight;
    const RetexMixture wrong[] = {
        {.nshares = 0},
        {.nshares = -1},
        {.nshares = RETEX_SHARES_MAX + 1},
        {.nshares = 1, .shares = {{-1, one}}},
        {.nshares = 1, .shares = {{set->nfootprints, one}}},
        {.nshares = 2, .shares = {{0, one}, {1, two}}},
        {.nshares = 2, .shares = {{0, one}, {1, set->nparts}}},
        {.nshares = 1, .shares = {{0, -1}}},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++)
        assert_int_equal(retex_set_add_mixture(set, &wrong[k], NULL, &err), RETEX_EINVAL);
    assert_int_equal(set->nmixtures, 2);
    RetexTerm term = set->terms[1];
    const int factors[] = {MIXTURE(2), -INT_MAX, set->nfootprints};
    for (size_t k = 0; k < sizeof factors / sizeof factors[0]; k++) {
        term.factors[0] = test_factor(factors[k]);
        assert_int_equal(retex_set_add_term(set, &term, NULL, &err), RETEX_EINVAL);
    }
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_by_hand),  cmocka_unit_test(test_most_factors), cmocka_unit_test(test_most_shares),
        cmocka_unit_test(test_no_error), cmocka_unit_test(test_file),         cmocka_unit_test(test_stream),
        cmocka_unit_test(test_pack),     cmocka_unit_test(test_not_whole),    cmocka_unit_test(test_additions),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
