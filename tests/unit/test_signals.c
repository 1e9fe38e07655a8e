/* The signals of a set: their terms and weights, the messages for missing and wrong parts, and inconsistent sets. */
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "set/parts.h"
#include "set/signals.h"

/* One signal as it should be: its parts, and its terms with their weights, named by their radiance. */
typedef struct Expected {
    int target;
    RetexFootprintKind kind;
    const char *noise, *cover;
    int nmembers;
    struct {
        const char *radiance;
        float weight;
    } members[12];
} Expected;

static const char *part_name(const RetexSet *set, int part)
{
    return part < 0 ? NULL : set->parts[part].name;
}

static void expect_signals(const RetexSet *set, const Expected *expected, int count)
{
    RetexSignals signals;
    RetexError err = {0};
    test_must(retex_signals_open(&signals, set, &err), &err);
    assert_int_equal(signals.count, count);
    for (int k = 0; k < count; k++) {
        const RetexSignal *signal = &signals.of[k];
        assert_int_equal(signal->target, expected[k].target);
        assert_int_equal(signal->kind, expected[k].kind);
        assert_string_equal(part_name(set, signal->noise), expected[k].noise);
        assert_true((signal->cover < 0) == !expected[k].cover);
        if (expected[k].cover)
            assert_string_equal(part_name(set, signal->cover), expected[k].cover);
        assert_int_equal(signal->nmembers, expected[k].nmembers);
        for (int m = 0; m < signal->nmembers; m++) {
            const RetexSignalMember *member = &signal->members[m];
            assert_string_equal(part_name(set, member->part), expected[k].members[m].radiance);
            assert_true(member->weight == expected[k].members[m].weight);
            if (set->nterms)
                assert_int_equal(set->terms[member->term].radiance, member->part);
            else
                assert_int_equal(member->term, -1);
        }
    }
    retex_signals_close(&signals);
    assert_null(signals.of);
}

static void test_signals_of_paper(void **state)
{
    (void)state;
    static const Expected expected[] = {
        {.target = -1,
         .noise = "noise_indep",
         .nmembers = 7,
         .members = {{"full0", 1},
                     {"t0_indep1", 1},
                     {"t0_indep2", 1},
                     {"t0_indep3", 1},
                     {"t1_indep1", 1},
                     {"t1_indep2", 1},
                     {"t1_indep3", 1}}},
        {.target = 0,
         .noise = "noise_Floor_hit",
         .cover = "guide_cover_Floor",
         .nmembers = 5,
         .members = {{"t0_dep1", 1}, {"t0_dep2", 0.5f}, {"t0_dep3", 0.25f}, {"t0_cross2", 1}, {"t0_cross3", 0.5f}}},
        {.target = 1,
         .noise = "noise_Wall_hit",
         .cover = "guide_cover_Wall",
         .nmembers = 5,
         .members = {{"t1_dep1", 1}, {"t1_dep2", 0.5f}, {"t1_dep3", 0.25f}, {"t1_cross2", 1}, {"t1_cross3", 0.5f}}},
    };
    RetexSet *set = test_set(16, 12, 1);
    assert_false(retex_denoise_has_data(set));
    test_add_denoise_data(set);
    assert_true(retex_denoise_has_data(set));
    expect_signals(set, expected, 3);
    retex_set_close(&set);
}

/* A set of layout footprints as the renderer makes it: a sharp and a broad cluster of the target, two later footprints,
 * and terms that have mixtures behind their first factor. */
static RetexSet *footprints_set(void)
{
    RetexSet *set = test_set(16, 12, 1);
    RetexError err = {0};
    test_make_footprints(set);
    for (int i = 0; i < set->nfootprints; i++) {
        static const RetexFootprintKind kinds[] = {RETEX_FOOTPRINT_SHARP, RETEX_FOOTPRINT_BROAD,
                                                   RETEX_FOOTPRINT_INTERREFLECTION};
        set->footprints[i].kind = kinds[i % 3];
    }
    /* one more term, whose only hit is of a mixture: that counts as its first share's footprint, here 2 and 0 */
    int radiance;
    test_must(retex_set_add_part(set, "mixed", "RGB", RETEX_HALF, 0, 0, &radiance, &err), &err);
    test_renew_roles(set);
    const RetexTerm term = test_term(set, radiance, 2, (int[]){MIXTURE(1), MIXTURE(0)});
    test_must(retex_set_add_term(set, &term, NULL, &err), &err);
    return set;
}

static void test_signals_of_footprints(void **state)
{
    (void)state;
    /* lib_set.c: t0_dep1 got mixture 0 as a second factor, the last term mixtures up to twelve */
    static const Expected expected[] = {
        {.target = -1,
         .noise = "noise_indep",
         .nmembers = 7,
         .members = {{"full0", 1},
                     {"t0_indep1", 1},
                     {"t0_indep2", 1},
                     {"t0_indep3", 1},
                     {"t1_indep1", 1},
                     {"t1_indep2", 1},
                     {"t1_indep3", 1}}},
        {.target = 0,
         .kind = RETEX_FOOTPRINT_SHARP,
         .noise = "noise_Floor_sharp",
         .cover = "guide_cover_Floor",
         .nmembers = 4,
         .members = {{"t0_dep1", 0.5f}, {"t0_dep2", 0.375f}, {"t0_dep3", 0.25f}, {"mixed", 0.5f}}},
        {.target = 0,
         .kind = RETEX_FOOTPRINT_BROAD,
         .noise = "noise_Floor_broad",
         .cover = "guide_cover_Floor",
         .nmembers = 1,
         .members = {{"t0_cross2", 1}}},
        {.target = 0,
         .kind = RETEX_FOOTPRINT_INTERREFLECTION,
         .noise = "noise_Floor_interreflection",
         .cover = "guide_cover_Floor",
         .nmembers = 1,
         .members = {{"t0_cross3", 0.5f}}},
        {.target = 1,
         .kind = RETEX_FOOTPRINT_SHARP,
         .noise = "noise_Wall_sharp",
         .cover = "guide_cover_Wall",
         .nmembers = 3,
         .members = {{"t1_dep1", 1}, {"t1_dep2", 0.5f}, {"t1_dep3", 0.25f}}},
        {.target = 1,
         .kind = RETEX_FOOTPRINT_BROAD,
         .noise = "noise_Wall_broad",
         .cover = "guide_cover_Wall",
         .nmembers = 1,
         .members = {{"t1_cross2", 1}}},
        {.target = 1,
         .kind = RETEX_FOOTPRINT_INTERREFLECTION,
         .noise = "noise_Wall_interreflection",
         .cover = "guide_cover_Wall",
         .nmembers = 1,
         .members = {{"t1_cross3", 1.0f / 2048}}},
    };
    RetexSet *set = footprints_set();
    test_add_denoise_data(set);
    for (int t = 0; t < set->nterms; t++)
        if (strcmp(set->parts[set->terms[t].radiance].name, "t0_dep2") == 0)
            set->terms[t].noise_weight = 0.375f;
    expect_signals(set, expected, (int)(sizeof expected / sizeof *expected));
    retex_set_close(&set);
}

/* Terms that say what they weigh where noise is summed weigh as much where light is filtered, whatever their target. */
static void test_weights_of_terms(void **state)
{
    (void)state;
    RetexSet *set = footprints_set();
    RetexSignals signals;
    RetexError err = {0};
    int found = 0;
    for (int c = 0; c < 3; c++)
        set->targets[0].mean_albedo[c] = 0.9f, set->targets[1].mean_albedo[c] = 0.2f;
    for (int t = 0; t < set->nterms; t++)
        if (retex_term_hits(&set->terms[t]) > 1)
            set->terms[t].noise_weight = 0.75f;
    test_must(retex_signals_sort(&signals, set, &err), &err);
    for (int s = 0; s < signals.count; s++)
        for (int m = 0; m < signals.of[s].nmembers; m++) {
            const RetexSignalMember *member = &signals.of[s].members[m];
            assert_true(member->weight == (member->hits > 1 ? 0.75f : 1) && member->bright == member->weight);
            found += member->hits > 1;
        }
    assert_true(found >= 7);
    retex_signals_close(&signals);
    retex_set_close(&set);
}

static void test_terms_without_sense(void **state)
{
    (void)state;
    static const float weights[] = {-0.5f, 1e-9f, 1.5f, INFINITY, NAN};
    RetexSet *set = test_set(16, 12, 1);
    RetexError err = {0};
    for (size_t k = 0; k < sizeof weights / sizeof *weights; k++) {
        RetexTerm term = set->terms[0];
        term.noise_weight = weights[k];
        assert_int_equal(retex_set_add_term(set, &term, NULL, &err), RETEX_EINVAL);
        assert_non_null(strstr(err.message, "weight in noise"));
    }
    retex_set_close(&set);
}

static RetexSet *plain_set(void)
{
    RetexSet *set;
    RetexError err = {0};
    test_must(retex_set_create(&set, 9, 7, &err), &err);
    strcpy(set->layout, "plain");
    test_must(retex_set_add_part(set, "beauty", "RGB", RETEX_HALF, 0, 0, NULL, &err), &err);
    return set;
}

static void test_signal_of_plain(void **state)
{
    (void)state;
    static const Expected expected[] = {
        {.target = -1, .noise = "noise_beauty", .nmembers = 1, .members = {{"beauty", 1}}}};
    RetexSet *set = plain_set();
    assert_false(retex_denoise_has_data(set));
    test_add_denoise_data(set);
    expect_signals(set, expected, 1);
    retex_set_close(&set);
}

/* A part is not as it should be: the signals say so, if it is theirs, and so does denoising, which leaves the set. */
static void expect_refused(RetexSet *set, const char *name, int code)
{
    RetexSignals signals;
    RetexError err = {0};
    if (strncmp(name, "noise_", 6) == 0 || strncmp(name, "guide_cover_", 12) == 0) {
        assert_int_equal(retex_signals_open(&signals, set, &err), code);
        assert_non_null(strstr(err.message, name));
        assert_null(signals.of);
    }
    const int nparts = set->nparts;
    memset(&err, 0, sizeof err);
    assert_int_equal(retex_denoise(set, NULL, NULL, 1, &err), code);
    assert_non_null(strstr(err.message, name));
    assert_false(retex_denoise_has_data(set));
    assert_false(set->denoised);
    assert_int_equal(set->nparts, nparts);
}

/* Every part that denoising reads, made wrong and taken away in turn. */
static void test_missing_and_wrong_parts(void **state)
{
    (void)state;
    RetexSet *model = footprints_set();
    RetexError err = {0};
    const int first = model->nparts;
    test_add_denoise_data(model);
    for (int i = first; i < model->nparts; i++) {
        const char *name = model->parts[i].name;
        const int channels = model->parts[i].image.channels;
        RetexSet *set = footprints_set();
        test_add_denoise_data(set);
        assert_true(retex_denoise_has_data(set));
        for (int wrong = 0; wrong < 3; wrong++) {
            RetexImage *im = &set->parts[i].image;
            retex_image_free(im);
            test_must(retex_image_alloc(im, wrong == 0 ? 15 : 16, wrong == 1 ? 13 : 12,
                                        wrong == 2 ? 4 - channels : channels, &err),
                      &err);
            expect_refused(set, name, RETEX_EFORMAT);
        }
        retex_set_remove_part(set, i);
        expect_refused(set, name, RETEX_ENOTFOUND);
        retex_set_close(&set);
    }
    retex_set_close(&model);
}

/* More kinds of first factors than the renderer's: no more than there is room for. */
static void test_too_many_signals(void **state)
{
    (void)state;
    RetexSet *set = plain_set();
    RetexError err = {0};
    RetexSignals signals;
    set->ntargets = RETEX_MAX_TARGETS;
    for (int t = 0; t < RETEX_MAX_TARGETS; t++) {
        set->targets[t].original = -1;
        snprintf(set->targets[t].name, sizeof set->targets[t].name, "T%d", t);
        for (int kind = 0; kind < 4; kind++) {
            RetexFootprint footprint = {
                .target = t, .hit = 1 + kind, .kind = (RetexFootprintKind)kind, .uv = -1, .spread = -1, .albedo = -1};
            int index;
            test_must(retex_set_add_footprint(set, &footprint, &index, &err), &err);
            const RetexTerm term = test_term(set, 0, 1, &index);
            test_must(retex_set_add_term(set, &term, NULL, &err), &err);
        }
    }
    test_add_denoise_data(set);
    assert_int_equal(retex_signals_open(&signals, set, &err), RETEX_EFORMAT);
    assert_null(signals.of);
    retex_set_close(&set);
}

/* What is denoise data: by name, and used by nothing else. */
static void test_which_parts_are_dropped(void **state)
{
    (void)state;
    RetexSet *set = footprints_set();
    const int before = set->nparts;
    test_add_denoise_data(set);
    for (int i = 0; i < set->nparts; i++)
        assert_int_equal(retex_part_is_denoise_data(set, i), i >= before);
    strcpy(set->parts[set->terms[3].radiance].name, "noise_of-no-kind");
    assert_false(retex_part_is_denoise_data(set, set->terms[3].radiance));
    strcpy(set->parts[set->footprints[2].uv].name, "guide_to-the-galaxy");
    assert_false(retex_part_is_denoise_data(set, set->footprints[2].uv));
    strcpy(set->parts[set->mixtures[1].shares[2].weight].name, "guide_x");
    assert_false(retex_part_is_denoise_data(set, set->mixtures[1].shares[2].weight));
    strcpy(set->parts[set->targets[1].original].name, "noise_x");
    assert_false(retex_part_is_denoise_data(set, set->targets[1].original));
    strcpy(set->parts[0].name, "noise_beauty");
    assert_false(retex_part_is_denoise_data(set, 0));
    retex_set_close(&set);
}

static void denoise(RetexSet *set)
{
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    RetexError err = {0};
    params.radius = 2;
    test_must(retex_denoise(set, &params, NULL, 2, &err), &err);
    assert_true(set->denoised);
    assert_false(retex_denoise_has_data(set));
    for (int i = 0; i < set->nparts; i++)
        assert_false(retex_part_is_denoise_data(set, i));
    assert_int_equal(retex_denoise(set, &params, NULL, 2, &err), RETEX_ENOTFOUND);
}

static void spoil(RetexSet *set, float value, int step)
{
    for (int i = 0; i < set->nparts; i++) {
        RetexImage *im = &set->parts[i].image;
        for (int k = 0; retex_part_is_denoise_data(set, i) && k < im->width * im->height * im->channels; k += step)
            im->pixels[k] = value;
    }
}

/* Whatever stands in the data, light stays a number. */
static void test_noise_that_is_no_number(void **state)
{
    (void)state;
    static const float values[] = {NAN, INFINITY, -INFINITY, 3e38f, -3e38f, 1e-45f};
    for (int v = 0; v < 2 * (int)(sizeof values / sizeof *values); v++) {
        RetexSet *set = footprints_set();
        test_add_denoise_data(set);
        spoil(set, values[v / 2], v % 2 ? 1 : 7);
        denoise(set);
        for (int t = 0; t < set->nterms; t++)
            for (int k = 0; k < 16 * 12 * 3; k++)
                assert_true(isfinite(set->parts[set->terms[t].radiance].image.pixels[k]));
        retex_set_close(&set);
    }
}

/* Footprints without some of their parts, as in what retex-sample writes: nothing to smooth there. */
static void test_footprints_without_parts(void **state)
{
    (void)state;
    RetexSet *set = footprints_set();
    RetexError err = {0};
    test_add_denoise_data(set);
    set->footprints[1].uv = set->footprints[2].spread = set->footprints[4].albedo = -1;
    set->footprints[5].uv = set->footprints[5].spread = set->footprints[5].albedo = -1;
    const int code = retex_denoise(set, NULL, NULL, 1, &err);
    assert_int_equal(set->denoised, code == 0);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_signals_of_paper),        cmocka_unit_test(test_signals_of_footprints),
        cmocka_unit_test(test_weights_of_terms),        cmocka_unit_test(test_terms_without_sense),
        cmocka_unit_test(test_signal_of_plain),         cmocka_unit_test(test_missing_and_wrong_parts),
        cmocka_unit_test(test_too_many_signals),        cmocka_unit_test(test_which_parts_are_dropped),
        cmocka_unit_test(test_noise_that_is_no_number), cmocka_unit_test(test_footprints_without_parts),
    };
    return cmocka_run_group_tests_name("signals", tests, NULL, NULL);
}
