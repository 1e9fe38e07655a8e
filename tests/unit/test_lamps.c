/* Terms of role LAMP: which of them are evaluated, against the formula term by term; their signals; their rounding. */
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/denoise_data.h>
#include <retex/retex.h>

#include "lib_folder.h"
#include "precision/precision.h"
#include "set/parts.h"
#include "set/signals.h"

enum { WIDTH = 37, HEIGHT = 21, VALUES = 3 * WIDTH * HEIGHT, LAMPS = 3 };

static RetexSet *lamp_set(int footprints, int off)
{
    RetexSet *set = test_set(WIDTH, HEIGHT, 3);
    if (footprints)
        test_make_footprints(set);
    test_add_lamp_terms(set, off, 0);
    return set;
}

/* ---- the formula ---- */

static double factor_value(const RetexSet *set, RetexFactor factor, const float *values, size_t i)
{
    if (factor.kind == RETEX_FACTOR_PARAMETER)
        return (double)values[3 * factor.index + (int)(i % 3)];
    if (factor.kind == RETEX_FACTOR_FOOTPRINT)
        return (double)set->parts[set->footprints[factor.index].albedo].image.pixels[i];
    const RetexMixture *m = &set->mixtures[factor.index];
    double sum = 0, weights = 0;
    for (int k = 0; k < m->nshares; k++) {
        const RetexImage *weight = &set->parts[m->shares[k].weight].image;
        const double w = (double)weight->pixels[weight->channels == 3 ? i : i / 3];
        sum += w * factor_value(set, retex_factor(RETEX_FACTOR_FOOTPRINT, m->shares[k].footprint), values, i);
        weights += w;
    }
    return weights > 0 ? sum / weights : 0;
}

/* The sum of the terms of lamps, or of all others, by terms apart. */
static double formula(const RetexSet *set, int lamps, const float *values, size_t i)
{
    double sum = 0;
    for (int t = 0; t < set->nterms; t++) {
        double product = (double)set->parts[set->terms[t].radiance].image.pixels[i];
        for (int k = 0; k < set->terms[t].nfactors; k++)
            product *= factor_value(set, set->terms[t].factors[k], values, i);
        sum += (set->terms[t].role == RETEX_ROLE_LAMP) == lamps ? product : 0;
    }
    return sum;
}

static void expect_formula(const RetexSet *set, int lamps, const float *values, const float *given)
{
    RetexCombineParams params = RETEX_COMBINE_INIT;
    RetexImage made = {0};
    RetexError err = {0};
    params.parameters = given;
    test_must(retex_combine(&made, set, &params, NULL, 2, &err), &err);
    for (size_t i = 0; i < VALUES; i++) {
        const double want = formula(set, lamps, values, i);
        if (fabs((double)made.pixels[i] - want) > 1e-5 * fabs(want) + 1e-7)
            fail_msg("value %zu is %g, not %g", i, (double)made.pixels[i], want);
    }
    retex_image_free(&made);
}

static void lamps_stand_for_all_light_where_one_is_changed(void **state)
{
    static const float kept[] = {1, 0.5f, 2, 1, 1, 1, 1, 1, 1}, dark[9] = {0}, warm[] = {3, 1, 0, 1, 1, 1, 1, 1, 1},
                       two[] = {0, 0, 0, 0, 2, 5, 1, 0.5f, 0};
    (void)state;
    for (int footprints = 0; footprints < 2; footprints++) {
        RetexSet *set = lamp_set(footprints, 0);
        expect_formula(set, 0, kept, NULL);
        expect_formula(set, 0, kept, kept);
        expect_formula(set, 1, warm, warm);
        expect_formula(set, 1, two, two);
        expect_formula(set, 1, dark, dark);
        retex_set_close(&set);
    }
}

/* As much of all light as the lamps have in common, by channel, and of each what it has beyond: where light of lamps
 * does not add up to all light, as in a pack, or all light has corrections. Kept values are 1 0.5 2, and else 1. */
static void light_that_lamps_have_in_common_is_that_of_all(void **state)
{
    static const float given[][9] = {{0.9f, 0.45f, 1.8f, 1, 1, 1, 1, 1, 1},
                                     {0.5f, 0.25f, 1, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f},
                                     {2, 0.5f, 2, 1, 1, 3, 1, 1, 1},
                                     {2, 0.1f, 3, 0.7f, 0.3f, 2, 4, 0.2f, 0}};
    static const float kept[] = {1, 0.5f, 2, 1, 1, 1, 1, 1, 1};
    (void)state;
    for (int footprints = 0; footprints < 2; footprints++)
        for (int k = 0; k < 4; k++) {
            RetexSet *set = lamp_set(footprints, 0);
            RetexCombineParams params = RETEX_COMBINE_INIT;
            RetexImage made = {0};
            RetexError err = {0};
            float beyond[9];
            double common[3];
            for (int t = 0; t < set->nterms; t++) /* the light of the second lamp has been lost in part */
                for (size_t i = 0; i < VALUES && retex_set_term_lamp(set, &set->terms[t]) == 1; i++)
                    set->parts[set->terms[t].radiance].image.pixels[i] *= 0.8f;
            for (int c = 0; c < 3; c++) {
                common[c] = 1e9;
                for (int l = 0; l < LAMPS; l++)
                    common[c] = fmin(common[c], (double)given[k][3 * l + c] / (double)kept[3 * l + c]);
                for (int l = 0; l < LAMPS; l++)
                    beyond[3 * l + c] = (float)((double)given[k][3 * l + c] - common[c] * (double)kept[3 * l + c]);
            }
            params.parameters = given[k];
            test_must(retex_combine(&made, set, &params, NULL, 2, &err), &err);
            for (size_t i = 0; i < VALUES; i++) {
                const double want = common[i % 3] * formula(set, 0, kept, i) + formula(set, 1, beyond, i);
                if (fabs((double)made.pixels[i] - want) > 1e-5 * fabs(want) + 1e-6)
                    fail_msg("case %d: value %zu is %g, not %g", k, i, (double)made.pixels[i], want);
            }
            retex_image_free(&made);
            retex_set_close(&set);
        }
}

/* A lamp that is off is not so in the other terms. */
static void a_lamp_that_is_off_is_changed_as_rendered(void **state)
{
    static const float rendered[] = {1, 0.5f, 2, 0, 0, 0, 1, 1, 1}, kept[] = {1, 0.5f, 2, 1, 1, 1, 1, 1, 1};
    (void)state;
    RetexSet *set = lamp_set(1, 1);
    expect_formula(set, 1, rendered, NULL);
    expect_formula(set, 0, kept, kept);
    retex_set_close(&set);
}

static void files_keep_what_lamps_are(void **state)
{
    (void)state;
    RetexSet *set = test_set(WIDTH, HEIGHT, 3), *back;
    RetexError err = {0};
    test_add_lamp_terms(set, 1, 1);
    test_must(retex_set_write(set, test_in_folder("lamps.exr"), NULL, 2, &err), &err);
    test_must(retex_set_read(test_in_folder("lamps.exr"), &back, 2, &err), &err);
    assert_int_equal(back->nparameters, LAMPS);
    for (int k = 0; k < LAMPS; k++) {
        assert_memory_equal(back->parameters[k].value, set->parameters[k].value, sizeof set->parameters[k].value);
        assert_memory_equal(back->parameters[k].kept, set->parameters[k].kept, sizeof set->parameters[k].kept);
        assert_int_equal(back->parameters[k].several, k == 0);
    }
    for (int t = 0; t < set->nterms; t++)
        assert_int_equal(back->terms[t].role, set->terms[t].role);
    retex_set_close(&set);
    retex_set_close(&back);
}

/* ---- signals ---- */

static void each_lamp_has_signals_of_its_own(void **state)
{
    (void)state;
    for (int footprints = 0; footprints < 2; footprints++) {
        RetexSet *set = lamp_set(footprints, 0);
        RetexSignals signals;
        RetexError err = {0};
        int members[1 + LAMPS] = {0};
        test_add_denoise_data(set);
        test_must(retex_signals_open(&signals, set, &err), &err);
        assert_int_equal(signals.count % (1 + LAMPS), 0);
        for (int k = 0; k < signals.count; k++) {
            const RetexSignal *signal = &signals.of[k];
            members[1 + signal->lamp] += signal->nmembers;
            for (int m = 0; m < signal->nmembers; m++) {
                const RetexTerm *term = &set->terms[signal->members[m].term];
                assert_int_equal(term->target, signal->target);
                assert_true(term->role == RETEX_ROLE_LAMP ? term->factors[term->nfactors - 1].index == signal->lamp
                                                          : signal->lamp < 0);
                assert_false(signal->members[m].corrects);
                assert_float_equal(signal->members[m].weight, pow(0.5, fmax(retex_term_hits(term) - 1, 0)), 1e-6);
            }
        }
        for (int k = 0; k <= LAMPS; k++)
            assert_int_equal(members[k] * (1 + LAMPS), set->nterms);
        retex_signals_close(&signals);
        retex_set_close(&set);
    }
}

static void expect_name(const char *lamp, const char *target, const char *signal, const char *want)
{
    char name[RETEX_NAME_MAX];
    retex_lamp_noise_part_name(name, lamp, target, signal);
    assert_string_equal(name, want);
}

static void noise_of_lamps_has_names(void **state)
{
    char one[RETEX_NAME_MAX], other[RETEX_NAME_MAX], longest[RETEX_NAME_MAX];
    (void)state;
    expect_name("Lamp", NULL, RETEX_SIGNAL_INDEP, "noise_lamp_Lamp_indep");
    expect_name("table_lamp", NULL, RETEX_SIGNAL_INDEP, "noise_lamp_table_lamp_indep");
    expect_name("Lamp", "Floor", "sharp", "noise_lamp_Lamp_Floor_sharp");
    retex_lamp_word(one, "a_b", "c");
    retex_lamp_word(other, "a", "b_c");
    assert_string_not_equal(one, other);
    memset(longest, 'x', sizeof longest - 1);
    longest[sizeof longest - 1] = 0;
    retex_lamp_word(one, longest, longest);
    longest[100] = 'y';
    retex_lamp_word(other, longest, longest);
    assert_string_not_equal(one, other);
    assert_true(strlen(one) <= 90);
}

/* ---- rounding ---- */

/* A dim lamp is rounded by its own light and noise, and the others as if there were no lamps. */
static void lamps_are_rounded_by_their_own_noise(void **state)
{
    (void)state;
    RetexSet *plain = test_set(WIDTH, HEIGHT, 3), *set = test_set(WIDTH, HEIGHT, 3);
    RetexError err = {0};
    RetexPrecision *precision;
    test_make_footprints(plain);
    test_make_footprints(set);
    test_add_lamp_terms(set, 0, 0);
    for (int t = 0; t < set->nterms; t++) /* the first lamp is dim but in the first pixel, with little noise */
        for (int i = 0; i < VALUES && set->terms[t].role == RETEX_ROLE_LAMP; i++)
            if (set->terms[t].factors[set->terms[t].nfactors - 1].index == 0)
                set->parts[set->terms[t].radiance].image.pixels[i] *= i < 3 ? 1e3f : 1e-3f;
    test_add_denoise_data(plain);
    test_add_denoise_data(set);
    for (int i = 0; i < set->nparts; i++)
        for (int k = 0; k < VALUES && strncmp(set->parts[i].name, "noise_", 6) == 0; k++) {
            const int own = strncmp(set->parts[i].name, "noise_lamp_Lamp_", 16) == 0;
            const int part = own ? -1 : retex_set_find_part(plain, set->parts[i].name);
            set->parts[i].image.pixels[k] = own ? 1e-6f : part < 0 ? 0.01f : plain->parts[part].image.pixels[k];
        }
    RetexSet *sets[] = {plain, set};
    float *before = malloc(sizeof *before * VALUES * (size_t)set->nterms);
    for (int t = 0; t < set->nterms; t++)
        memcpy(before + (size_t)t * VALUES, set->parts[set->terms[t].radiance].image.pixels, sizeof *before * VALUES);
    for (int k = 0; k < 2; k++) {
        test_must(retex_precision_open(&precision, sets[k], 1, &err), &err);
        test_must(retex_precision_round(precision, sets[k], NULL, 2, &err), &err);
        retex_precision_close(&precision);
    }
    for (int i = 0; i < plain->nparts; i++) { /* all but lamps: as without */
        const int part = retex_set_find_part(set, plain->parts[i].name);
        const RetexImage *im = &plain->parts[i].image;
        assert_true(part >= 0);
        if (strncmp(plain->parts[i].name, "guide_", 6) == 0) /* random */
            continue;
        assert_memory_equal(im->pixels, set->parts[part].image.pixels,
                            sizeof *im->pixels * retex_image_index(im, 0, im->height));
    }
    for (int i = 0; i < VALUES; i++) {
        double white[3] = {0, 0, 0};
        for (int t = 0; t < set->nterms; t++)
            for (int c = 0; c < 3; c++)
                if (set->terms[t].role == RETEX_ROLE_LAMP &&
                    set->terms[t].factors[set->terms[t].nfactors - 1].index == 0)
                    white[c] += (double)before[(size_t)t * VALUES + (size_t)(i - i % 3 + c)];
        const double most = fmax(white[0], fmax(white[1], white[2]));
        const double step = fmax(most / 8192, 0.1 * sqrt(1e-6 * most * sqrt(0.5 / set->spp))) * 1.001;
        for (int t = 0; t < set->nterms; t++)
            if (set->terms[t].role == RETEX_ROLE_LAMP && set->terms[t].factors[set->terms[t].nfactors - 1].index == 0) {
                const double a = (double)before[(size_t)t * VALUES + (size_t)i];
                const double b = (double)set->parts[set->terms[t].radiance].image.pixels[i];
                if (fabs(a - b) > 2 * step)
                    fail_msg("%g became %g, steps of %g", a, b, step);
            }
    }
    free(before);
    retex_set_close(&plain);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lamps_stand_for_all_light_where_one_is_changed),
        cmocka_unit_test(light_that_lamps_have_in_common_is_that_of_all),
        cmocka_unit_test(a_lamp_that_is_off_is_changed_as_rendered),
        cmocka_unit_test(files_keep_what_lamps_are),
        cmocka_unit_test(each_lamp_has_signals_of_its_own),
        cmocka_unit_test(noise_of_lamps_has_names),
        cmocka_unit_test(lamps_are_rounded_by_their_own_noise),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
