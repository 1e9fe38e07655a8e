/* Denoising sets with lamps: all light as without them; each lamp; that they add up; strips and threads. */
#include "lib_denoise.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/set_build.h>
#include <retex/retex.h>

#include "denoise/filter.h"
#include "denoise/residual.h"
#include "lib_folder.h"
#include "set/parts.h"

enum { LAMPS = 3 };
static const char *const layouts[] = {"paper", "footprints"};

static void add_lamps(RetexSet *set)
{
    RetexError err = {0};
    test_add_lamp_terms(set, 0, 0);
    for (int t = 0; t < set->nterms; t++) {
        char name[RETEX_NAME_MAX];
        retex_signal_noise_name(set, &set->terms[t], name);
        if (retex_set_find_part(set, name) < 0)
            test_must(retex_set_add_part(set, name, "RGB", RETEX_HALF, 0, 0, NULL, &err), &err);
    }
}

static void add_lamp_pictures(RetexSet *set)
{
    RetexError err = {0};
    for (int i = 0; i < set->nparameters; i++) {
        RetexTerm term = {.role = RETEX_ROLE_LAMP_PICTURE, .target = -1};
        char name[32];
        snprintf(name, sizeof name, "picture%d", i);
        test_must(retex_set_add_part(set, name, "RGB", RETEX_HALF, 0, 0, &term.radiance, &err), &err);
        test_must(retex_term_add_factor(&term, retex_factor(RETEX_FACTOR_PARAMETER, i), &err), &err);
        test_must(retex_set_add_term(set, &term, NULL, &err), &err);
    }
}

static RetexSet *noisy_set(const char *layout, int width, int height, int lamps, int noisy)
{
    RetexSet *set = denoise_set(layout, width, height);
    set->spp = 16;
    if (lamps) {
        add_lamps(set);
        add_lamp_pictures(set);
    }
    if (noisy)
        denoise_add_noise(set, 7);
    return set;
}

static void all_light_is_as_without_lamps(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        RetexSet *with = noisy_set(layouts[k], 70, 52, 1, 1), *without = noisy_set(layouts[k], 70, 52, 0, 1);
        denoise_all(with, NULL, 2);
        denoise_all(without, NULL, 2);
        for (int i = 0; i < without->nparts; i++) {
            const int part = retex_set_find_part(with, without->parts[i].name);
            const RetexImage *im = &without->parts[i].image;
            assert_true(part >= 0);
            if (memcmp(im->pixels, with->parts[part].image.pixels,
                       sizeof *im->pixels * retex_image_index(im, 0, im->height)) != 0)
                fail_msg("%s: another %s", layouts[k], without->parts[i].name);
        }
        retex_set_close(&with);
        retex_set_close(&without);
    }
}

/* The signals of a denoised set, which has no noise any more. */
static RetexSignals signals_of(const RetexSet *set)
{
    RetexSignals signals;
    RetexError err = {0};
    test_must(retex_signals_sort(&signals, set, &err), &err);
    return signals;
}

static double sum_of_lamps(const RetexSet *set, const RetexSignals *signals, const RetexSignal *whole, int x, int y,
                           int c)
{
    double sum = 0;
    for (int s = 0; s < signals->count; s++) {
        const RetexSignal *own = &signals->of[s];
        if (own->lamp >= 0 && own->target == whole->target && own->kind == whole->kind)
            sum += (double)set->parameters[own->lamp].kept[c] * denoise_total(set, own, x, y, c);
    }
    return sum;
}

static void expect_sums(const RetexSet *set, const RetexSignals *signals, double tolerance)
{
    for (int s = 0; s < signals->count; s++)
        for (int i = 0; i < set->width * set->height && signals->of[s].lamp < 0; i++)
            for (int c = 0; c < 3; c++) {
                const int x = i % set->width, y = i / set->width;
                const double whole = denoise_total(set, &signals->of[s], x, y, c);
                const double sum = sum_of_lamps(set, signals, &signals->of[s], x, y, c);
                if (fabs(whole - sum) > tolerance * whole + 1e-7)
                    fail_msg("signal %d at %d, %d: %g, lamps %g", s, x, y, whole, sum);
            }
}

/* All light is filtered first, then each lamp, in whatever order terms come. */
static void lamps_are_filtered_one_by_one(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("footprints", 70, 52, 1, 0);
    for (int t = 0; t < set->nterms / 2; t++) {
        const RetexTerm term = set->terms[t];
        set->terms[t] = set->terms[set->nterms - 1 - t], set->terms[set->nterms - 1 - t] = term;
    }
    const RetexDenoiser all = {.set = set, .signals = denoise_signals(set)};
    RetexDenoiser bundle;
    int lamp = -1, next = 0;
    for (int count; (count = retex_denoise_bundle(&bundle, &all, next)) > 0; next += count, lamp++) {
        assert_int_equal(bundle.first_signal, next);
        assert_int_equal(bundle.signals.count, count);
        for (int s = 0; s < count; s++)
            assert_int_equal(bundle.signals.of[s].lamp, lamp);
    }
    assert_int_equal(lamp, LAMPS);
    assert_int_equal(next, all.signals.count);
    RetexSignals signals = all.signals;
    retex_signals_close(&signals);
    retex_set_close(&set);
}

static void lamps_add_up_to_all_light(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        RetexSet *set = noisy_set(layouts[k], 70, 52, 1, 1);
        denoise_all(set, &denoise_exactly, 2);
        RetexSignals signals = signals_of(set);
        expect_sums(set, &signals, 0x1p-10); /* of halves */
        retex_signals_close(&signals);
        retex_set_close(&set);
    }
}

/* Before halves are stored the sum is exact to floats; what is negative or multiplied by 0 stays out of it. */
static void the_residual_is_shared(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        RetexSet *set = noisy_set(layouts[k], 70, 52, 1, 1), *was;
        set->parameters[1].kept[2] = 0;
        RetexDenoiser d = {.set = set, .roi = {0, 0, 70, 52, 0, 3}, .signals = denoise_signals(set)};
        RetexSignals before;
        was = noisy_set(layouts[k], 70, 52, 1, 1);
        before = denoise_signals(was);
        for (int y = 0; y < 52; y++)
            retex_denoise_share_residual(&d, y);
        expect_sums(set, &d.signals, 1e-6);
        for (int s = 0; s < d.signals.count; s++)
            for (int i = 0; i < 70 * 52; i++)
                for (int c = 0; c < 3; c++) {
                    const double is = denoise_total(set, &d.signals.of[s], i % 70, i / 70, c);
                    assert_true(is >= 0);
                    if (d.signals.of[s].lamp < 0 || (d.signals.of[s].lamp == 1 && c == 2))
                        assert_true(is == denoise_total(was, &before.of[s], i % 70, i / 70, c));
                }
        retex_signals_close(&before);
        retex_signals_close(&d.signals);
        retex_set_close(&set);
        retex_set_close(&was);
    }
}

/* The lamp without noise keeps its light: others take the residual. */
static void the_noisiest_lamp_takes_most(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("footprints", 70, 52, 1, 0);
    RetexSignals signals = denoise_signals(set);
    double moved[LAMPS] = {0};
    for (int s = 0; s < signals.count; s++)
        for (int i = 0; i < 3 * 70 * 52; i++)
            if (signals.of[s].lamp >= 0)
                set->parts[signals.of[s].noise].image.pixels[i] = signals.of[s].lamp == 1 ? 0.02f : 0.002f;
    for (int s = 0; s < signals.count; s++)
        for (int m = 0; m < signals.of[s].nmembers && signals.of[s].lamp < 0; m++)
            for (int i = 0; i < 3 * 70 * 52; i++)
                set->parts[signals.of[s].members[m].part].image.pixels[i] *= 1.01f;
    RetexSet *was = noisy_set("footprints", 70, 52, 1, 0);
    RetexDenoiser d = {.set = set, .roi = {0, 0, 70, 52, 0, 3}, .signals = signals};
    for (int y = 0; y < 52; y++)
        retex_denoise_share_residual(&d, y);
    for (int s = 0; s < signals.count; s++)
        for (int i = 0; i < 70 * 52 && signals.of[s].lamp >= 0; i++)
            moved[signals.of[s].lamp] += denoise_total(set, &signals.of[s], i % 70, i / 70, 0) -
                                         denoise_total(was, &signals.of[s], i % 70, i / 70, 0);
    /* by variance, a hundredth each: values are 1 in red */
    assert_true(moved[1] > 0);
    assert_float_equal(moved[0] / moved[1], 0.01, 0.002);
    assert_float_equal(moved[2] / moved[1], 0.01, 0.002);
    retex_signals_close(&signals);
    retex_set_close(&was);
    retex_set_close(&set);
}

static void find_errors(double errors[LAMPS], const RetexSet *set, const RetexSet *truth)
{
    RetexSignals signals = signals_of(set), exact = signals_of(truth);
    memset(errors, 0, LAMPS * sizeof *errors);
    for (int s = 0; s < signals.count; s++)
        for (int i = 0; i < 3 * 70 * 52 && signals.of[s].lamp >= 0; i++)
            errors[signals.of[s].lamp] += pow(denoise_total(set, &signals.of[s], i / 3 % 70, i / 210, i % 3) -
                                                  denoise_total(truth, &exact.of[s], i / 3 % 70, i / 210, i % 3),
                                              2);
    retex_signals_close(&signals);
    retex_signals_close(&exact);
}

static void each_lamp_becomes_cleaner(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        RetexSet *set = noisy_set(layouts[k], 70, 52, 1, 1), *truth = noisy_set(layouts[k], 70, 52, 1, 0);
        double before[LAMPS], after[LAMPS];
        find_errors(before, set, truth);
        denoise_all(set, NULL, 2);
        find_errors(after, set, truth);
        for (int n = 0; n < LAMPS; n++)
            if (!(after[n] < before[n] / 4))
                fail_msg("%s, lamp %d: %g became %g", layouts[k], n, before[n], after[n]);
        retex_set_close(&set);
        retex_set_close(&truth);
    }
}

static double sum_of_part(const RetexSet *set, const char *name)
{
    const RetexImage *im = &set->parts[retex_set_find_part(set, name)].image;
    double sum = 0;
    for (size_t i = 0; i < retex_image_index(im, 0, im->height); i++)
        sum += fabs((double)im->pixels[i]);
    return sum;
}

/* A term without light gets none, and the others keep theirs. */
static void terms_without_light_stay_so(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("footprints", 70, 52, 1, 0);
    RetexSignals signals = denoise_signals(set);
    char dark[RETEX_NAME_MAX] = "", lit[RETEX_NAME_MAX] = "";
    for (int s = 0; s < signals.count; s++)
        if (signals.of[s].lamp >= 0 && signals.of[s].nmembers >= 3) { /* where all are 0 the first takes all */
            snprintf(dark, sizeof dark, "%s", set->parts[signals.of[s].members[1].part].name);
            snprintf(lit, sizeof lit, "%s", set->parts[signals.of[s].members[2].part].name);
        }
    const double light = sum_of_part(set, lit);
    memset(set->parts[retex_set_find_part(set, dark)].image.pixels, 0, sizeof(float) * 3 * 70 * 52);
    assert_true(light > 0);
    denoise_all(set, &denoise_exactly, 2);
    assert_true(sum_of_part(set, dark) == 0);
    assert_true(sum_of_part(set, lit) > light / 2);
    retex_signals_close(&signals);
    retex_set_close(&set);
}

/* The picture of a lamp with all originals is that of its filtered terms. */
static void pictures_of_lamps_are_renewed(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("footprints", 70, 52, 1, 1);
    RetexError err = {0};
    denoise_all(set, NULL, 2);
    for (int i = 0; i < LAMPS; i++) {
        char name[32];
        float values[3 * LAMPS] = {0};
        RetexCombineParams params = RETEX_COMBINE_INIT;
        RetexImage made = {0};
        snprintf(name, sizeof name, "picture%d", i);
        values[3 * i] = values[3 * i + 1] = values[3 * i + 2] = 1;
        params.parameters = values, params.terms_only = 1;
        test_must(retex_combine(&made, set, &params, NULL, 2, &err), &err);
        const float *picture = set->parts[retex_set_find_part(set, name)].image.pixels;
        for (int k = 0; k < 3 * 70 * 52; k++)
            assert_float_equal(picture[k], made.pixels[k], 1e-3 * (double)made.pixels[k] + 1e-6);
        retex_image_free(&made);
    }
    retex_set_close(&set);
}

static void strips_and_threads_change_nothing(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        RetexSet *sets[3] = {noisy_set(layouts[k], 50, 150, 1, 1), NULL, NULL};
        RetexError err = {0};
        test_must(retex_set_write(sets[0], test_in_folder("noisy.exr"), NULL, 2, &err), &err);
        retex_set_close(&sets[0]);
        for (int n = 0; n < 3; n++) {
            char name[32];
            snprintf(name, sizeof name, "%d.exr", n);
            test_must(n < 2 ? retex_set_read(test_in_folder("noisy.exr"), &sets[n], 2, &err)
                            : retex_set_open(test_in_folder("noisy.exr"), &sets[n], 2, &err),
                      &err);
            test_must(retex_denoise(sets[n], NULL, NULL, 1 + n, &err), &err);
            test_must(retex_set_load(sets[n], 2, &err), &err);
            if (n)
                denoise_expect_same(sets[0], sets[n]);
        }
        for (int n = 0; n < 3; n++)
            retex_set_close(&sets[n]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_light_is_as_without_lamps),
        cmocka_unit_test(lamps_are_filtered_one_by_one),
        cmocka_unit_test(lamps_add_up_to_all_light),
        cmocka_unit_test(the_residual_is_shared),
        cmocka_unit_test(the_noisiest_lamp_takes_most),
        cmocka_unit_test(each_lamp_becomes_cleaner),
        cmocka_unit_test(terms_without_light_stay_so),
        cmocka_unit_test(pictures_of_lamps_are_renewed),
        cmocka_unit_test(strips_and_threads_change_nothing),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
