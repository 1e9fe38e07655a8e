/* A lamp's colour as a parameter of a set, from the set in memory to everything that reads one: recombination against
 * the formula term by term, files, packs, denoising; and what cannot hold one says so. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <retex/retex.h>

#include "lib_compact.h"
#include "lib_folder.h"
#include "lib_test.h"
#include "set/signals.h"

static const float GREEN[3] = {0.25f, 3, 0}, DARK[3] = {0, 0, 0}, RENDERED[3] = {1, 0.5f, 2};

/* ---- the formula ---- */

static double factor_value(const RetexSet *set, RetexFactor factor, const float *lamp, size_t i)
{
    if (factor.kind == RETEX_FACTOR_PARAMETER)
        return (double)lamp[i % 3];
    if (factor.kind == RETEX_FACTOR_FOOTPRINT)
        return (double)set->parts[set->footprints[factor.index].albedo].image.pixels[i];
    const RetexMixture *m = &set->mixtures[factor.index];
    double sum = 0, weights = 0;
    for (int k = 0; k < m->nshares; k++) {
        const RetexImage *weight = &set->parts[m->shares[k].weight].image;
        const double w = (double)weight->pixels[weight->channels == 3 ? i : i / 3];
        sum += w * factor_value(set, retex_factor(RETEX_FACTOR_FOOTPRINT, m->shares[k].footprint), lamp, i);
        weights += w;
    }
    return weights > 0 ? sum / weights : 0;
}

static double picture_value(const RetexSet *set, const float *lamp, size_t i)
{
    double sum = 0;
    for (int t = 0; t < set->nterms; t++) {
        double product = (double)set->parts[set->terms[t].radiance].image.pixels[i];
        for (int k = 0; k < set->terms[t].nfactors; k++)
            product *= factor_value(set, set->terms[t].factors[k], lamp, i);
        sum += retex_term_is_light(&set->terms[t]) ? product : 0;
    }
    return sum;
}

/* lamp: NULL = as rendered. */
static RetexImage combined(const RetexSet *set, const float *lamp)
{
    RetexCombineParams params = RETEX_COMBINE_INIT;
    RetexImage made = {0};
    RetexError err = {0};
    params.parameters = lamp;
    test_must(retex_combine(&made, set, &params, NULL, 2, &err), &err);
    return made;
}

/* source: of the terms; set: what is combined. */
static void expect_formula(const RetexSet *set, const RetexSet *source, const float *lamp, const float *given,
                           double tolerance)
{
    RetexImage made = combined(set, given);
    for (size_t i = 0; i < 3 * (size_t)set->width * (size_t)set->height; i++) {
        const double want = picture_value(source, lamp, i);
        if (fabs((double)made.pixels[i] - want) > tolerance * fabs(want) + 1e-7)
            fail_msg("value %zu is %g, not %g", i, (double)made.pixels[i], want);
    }
    retex_image_free(&made);
}

static RetexSet *lamp_set(int footprints)
{
    RetexSet *set = test_set(37, 21, 3);
    if (footprints)
        test_make_footprints(set);
    test_add_lamp(set, "Lamp");
    return set;
}

static void light_is_multiplied_by_it(void **state)
{
    (void)state;
    for (int footprints = 0; footprints < 2; footprints++) {
        RetexSet *set = lamp_set(footprints);
        expect_formula(set, set, RENDERED, NULL, 1e-5);
        expect_formula(set, set, RENDERED, RENDERED, 1e-5);
        expect_formula(set, set, GREEN, GREEN, 1e-5);
        expect_formula(set, set, DARK, DARK, 1e-5);
        retex_set_close(&set);
    }
}

/* Terms that differ in nothing but their lamp become one product: the picture is that of the formula all the same, with
 * reduced images as factors too. */
static void light_of_several_lamps_is_added_first(void **state)
{
    (void)state;
    RetexSet *set = test_set(37, 21, 3);
    RetexError err = {0};
    float values[9];
    for (int n = 0; n < 3; n++) {
        RetexParameter lamp = {.kind = RETEX_PARAMETER_COLOR, .target = -1};
        char name[32];
        int part, number;
        snprintf(lamp.name, sizeof lamp.name, "lamp %d", n);
        for (int c = 0; c < 3; c++)
            lamp.value[c] = 1, values[3 * n + c] = (float)(n + c);
        test_must(retex_set_add_parameter(set, &lamp, &number, &err), &err);
        snprintf(name, sizeof name, "light%d", n);
        test_must(retex_set_add_part(set, name, "RGB", RETEX_HALF, 0, 0, &part, &err), &err);
        RetexImage *im = &set->parts[part].image;
        for (size_t i = 0; i < retex_image_index(im, 0, im->height); i++)
            im->pixels[i] = (float)(i % 7) * 0.125f + (float)n;
        RetexTerm term = test_term(set, part, 1, (int[]){1});
        term.factors[term.nfactors++] = retex_factor(RETEX_FACTOR_PARAMETER, number);
        test_must(retex_set_add_term(set, &term, NULL, &err), &err);
    }
    RetexImage with = combined(set, values);
    set->nterms -= 3;
    RetexImage without = combined(set, NULL);
    for (size_t i = 0; i < 3 * 37 * 21; i++) {
        double sum = 0;
        for (int n = 0; n < 3; n++)
            sum += (double)(n + (int)(i % 3)) * (double)set->parts[set->nparts - 3 + n].image.pixels[i];
        const double albedo = (double)set->parts[set->footprints[1].albedo].image.pixels[i];
        assert_float_equal(with.pixels[i], (double)without.pixels[i] + sum * albedo, 1e-5 * (1 + sum));
    }
    retex_image_free(&with);
    retex_image_free(&without);
    retex_set_close(&set);
}

/* The picture as rendered stands for the sum only while the lamp is as it was. */
static void the_picture_is_of_the_lamp_as_rendered(void **state)
{
    (void)state;
    RetexSet *set = lamp_set(0);
    RetexError err = {0};
    const RetexTerm whole = {.role = RETEX_ROLE_PICTURE, .target = -1};
    test_must(retex_set_add_term(set, &whole, NULL, &err), &err);
    const size_t bytes = sizeof(float) * 3 * 37 * 21;
    RetexImage same = combined(set, NULL), again = combined(set, RENDERED);
    assert_memory_equal(same.pixels, set->parts[0].image.pixels, bytes);
    assert_memory_equal(again.pixels, set->parts[0].image.pixels, bytes);
    expect_formula(set, set, GREEN, GREEN, 1e-5);
    retex_image_free(&same);
    retex_image_free(&again);
    retex_set_close(&set);
}

static void what_is_no_value_is_refused(void **state)
{
    (void)state;
    RetexSet *set = lamp_set(0);
    const float wrong[][3] = {{1, -1, 1}, {1, 1, NAN}, {INFINITY, 1, 1}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        RetexCombineParams params = RETEX_COMBINE_INIT;
        RetexImage made = {0};
        RetexError err = {0};
        params.parameters = wrong[k];
        assert_int_equal(retex_combine(&made, set, &params, NULL, 1, &err), RETEX_EINVAL);
        assert_non_null(strstr(err.message, "Lamp"));
        retex_image_free(&made);
    }
    retex_set_close(&set);
}

/* ---- files ---- */

static void files_and_packs_keep_it(void **state)
{
    (void)state;
    RetexSet *set = lamp_set(1), *back;
    RetexError err = {0};
    for (int lossy = 0; lossy < 3; lossy++) {
        const char *path = test_in_folder(lossy ? "lamp.retex" : "lamp.exr");
        RetexPackParams params = RETEX_PACK_INIT;
        params.lossless = lossy == 1;
        test_must(lossy ? retex_pack_write(set, path, &params, NULL, 2, &err)
                        : retex_set_write(set, path, NULL, 2, &err),
                  &err);
        test_must(retex_set_read(path, &back, 2, &err), &err);
        assert_int_equal(back->nparameters, 1);
        assert_string_equal(back->parameters[0].name, "Lamp");
        assert_int_equal(back->parameters[0].kind, RETEX_PARAMETER_COLOR);
        assert_memory_equal(back->parameters[0].value, RENDERED, sizeof RENDERED);
        assert_int_equal(retex_set_find_parameter(back, "Lamp"), 0);
        assert_int_equal(retex_set_find_parameter(back, "lamp"), -1);
        if (lossy < 2)
            expect_formula(back, set, GREEN, GREEN, 1e-5);
        else
            expect_formula(back, back, GREEN, GREEN, 1e-5);
        retex_set_close(&back);
    }
    retex_set_close(&set);
}

static void keep_text(void *context, const char *text)
{
    strncat(context, text, 255 - strlen(context));
}

/* A set that would be made compact stays as it is, and whoever makes it is told why, once. */
static void what_is_not_made_compact_is_said(void **state)
{
    (void)state;
    RetexSet *set = whole_set(1, 2), *compact;
    RetexError err = {0};
    RetexCompactParams params = RETEX_COMPACT_INIT;
    RetexPackParams packing = RETEX_PACK_INIT;
    RetexWebParams web = RETEX_WEB_INIT;
    char told[256] = "";
    const char *many = "the set cannot be made compact and takes more room: its terms have too many parameters";
    params.warn = packing.warn = keep_text;
    params.warn_context = packing.warn_context = told;
    test_must(retex_set_compact(&compact, set, &params, 1, &err), &err);
    assert_string_equal(told, "");
    assert_true(compact->nparts < set->nparts);
    retex_set_close(&compact);
    for (int k = 0; k < 4; k++) /* of a term */
        test_add_lamp(set, (const char *const[]){"A", "B", "C", "D"}[k]);
    test_must(retex_set_compact(&compact, set, &params, 1, &err), &err);
    assert_string_equal(told, many);
    assert_int_equal(compact->nterms, set->nterms);
    expect_formula(compact, set, RENDERED, NULL, 1e-5);
    retex_set_close(&compact);
    told[0] = 0;
    test_must(retex_pack_write(set, test_in_folder("told.retex"), &packing, NULL, 1, &err), &err);
    assert_string_equal(told, many);
    assert_int_equal(retex_web_write(set, test_in_folder(""), &web, NULL, 1, &err), RETEX_EUNSUPPORTED);
    retex_set_close(&set);
}

/* ---- denoising ---- */

/* In the light that denoising looks at, a lamp counts as it was rendered. */
static void signals_have_the_lamp_as_rendered(void **state)
{
    (void)state;
    RetexSet *set = lamp_set(0);
    RetexSignals signals;
    RetexError err = {0};
    int seen = 0;
    test_must(retex_signals_sort(&signals, set, &err), &err);
    for (int k = 0; k < signals.count; k++)
        for (int m = 0; m < signals.of[k].nmembers; m++) {
            const RetexTerm *term = &set->terms[signals.of[k].members[m].term];
            double weight = pow(0.5, fmax(retex_term_hits(term) - 1, 0));
            const RetexFactor last = term->factors[term->nfactors ? term->nfactors - 1 : 0];
            if (term->nfactors && last.kind == RETEX_FACTOR_PARAMETER)
                weight *= 0.2126 + 0.7152 * 0.5 + 0.0722 * 2, seen++; /* Rec. 709 */
            assert_float_equal(signals.of[k].members[m].weight, weight, 1e-4);
        }
    assert_int_equal(seen, set->nterms / 2);
    retex_signals_close(&signals);
    retex_set_close(&set);
}

static void denoised_sets_keep_it(void **state)
{
    (void)state;
    RetexSet *set = lamp_set(1);
    RetexError err = {0};
    test_add_denoise_data(set);
    test_must(retex_denoise(set, NULL, NULL, 2, &err), &err);
    assert_int_equal(set->nparameters, 1);
    expect_formula(set, set, GREEN, GREEN, 1e-4);
    RetexImage made = combined(set, NULL);
    for (size_t i = 0; i < 3 * 37 * 21; i++) /* part 0 is their sum, as halves */
        assert_float_equal(made.pixels[i], set->parts[0].image.pixels[i], 1e-3 * (double)made.pixels[i] + 1e-6);
    retex_image_free(&made);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_is_multiplied_by_it),
        cmocka_unit_test(light_of_several_lamps_is_added_first),
        cmocka_unit_test(the_picture_is_of_the_lamp_as_rendered),
        cmocka_unit_test(what_is_no_value_is_refused),
        cmocka_unit_test(files_and_packs_keep_it),
        cmocka_unit_test(what_is_not_made_compact_is_said),
        cmocka_unit_test(signals_have_the_lamp_as_rendered),
        cmocka_unit_test(denoised_sets_keep_it),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
