/* Denoising with Open Image Denoise, for which a stand-in answers whose filter is the mean of 3x3 pixels: the images it
 * is given, what is made of its result, and every way in which it fails. */
#include "lib_denoise.h"
#include "lib_folder.h"
#include "lib_footprints.h"
#include <cmocka.h>

#include <dlfcn.h>
#include <libgen.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../oidn/stand_in.h"
#include "set/source.h"

enum { ACROSS = 90, DOWN = 130, PIXELS = ACROSS * DOWN };

static char folder[1024]; /* of the stand-ins */
static OidnStandIn *oidn;

static void choose_library(const char *name)
{
    char path[1200];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    setenv("RETEX_OIDN", path, 1);
}

static int find_stand_in(void **state)
{
    (void)state;
    char program[1000] = "";
    assert_true(readlink("/proc/self/exe", program, sizeof program - 1) > 0);
    snprintf(folder, sizeof folder, "%s/../oidn", dirname(program));
    choose_library("libOpenImageDenoise.so.2");
    oidn = dlsym(dlopen(getenv("RETEX_OIDN"), RTLD_NOW), "oidn_stand_in");
    assert_non_null(oidn);
    return 0;
}

static int begin(void **state)
{
    memset(oidn, 0, sizeof *oidn);
    unsetenv("OIDN_STAND_IN");
    choose_library("libOpenImageDenoise.so.2");
    return test_make_folder(state);
}

static RetexSet *noisy_set(const char *layout)
{
    RetexSet *set = denoise_set(layout, ACROSS, DOWN);
    denoise_add_noise(set, 7);
    return set;
}

static RetexDenoiseParams params_of(const char *denoiser)
{
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    params.denoiser = denoiser, params.full_precision = 1;
    return params;
}

static void denoise_by(RetexSet *set, const char *denoiser)
{
    const RetexDenoiseParams params = params_of(denoiser);
    denoise_all(set, &params, 2);
}

/* All that was made is released, and nothing was done that the library would refuse. */
static void expect_tidy(void)
{
    assert_int_equal(oidn->devices, 0);
    assert_int_equal(oidn->filters, 0);
    assert_int_equal(oidn->misused, 0);
    assert_int_equal(oidn->made_devices, 1);
}

/* ---- what it is given ---- */

static int is_black(const RetexSet *set, const RetexSignal *signal)
{
    return denoise_mean(set, signal, 0) == 0;
}

static void expect_color(const RetexSet *set, const RetexSignal *signal, const float *given)
{
    for (int i = 0; i < 3 * PIXELS; i++) {
        const double total = denoise_total(set, signal, i / 3 % ACROSS, i / 3 / ACROSS, i % 3);
        if (fabs(given[i] - total) > 1e-5 * total)
            fail_msg("light of %s at %d: %g, not %g", denoise_signal_name(set, signal), i, (double)given[i], total);
    }
}

/* Sharp light is multiplied by the target, light of any kind by everything, other light by what is seen, where targets
 * are white but count as darker. */
static double modulation(const RetexSet *set, const RetexSignal *signal, int x, int y, int c)
{
    char name[RETEX_NAME_MAX];
    if (signal->target >= 0 && signal->kind == RETEX_FOOTPRINT_HIT)
        return 1;
    if (signal->target >= 0 && signal->kind == RETEX_FOOTPRINT_SHARP)
        return pixel(set, signal->cover, x, y)[0];
    double seen = pixel(set, retex_set_find_part(set, "guide_seen_albedo"), x, y)[c];
    for (int t = 0; t < set->ntargets; t++) {
        retex_cover_part_name(name, set->targets[t].name);
        seen -= 0.7 * pixel(set, retex_set_find_part(set, name), x, y)[0];
    }
    return seen;
}

static void expect_guides(const RetexSet *set, const RetexSignal *signal, const float *albedo, const float *normal)
{
    const int normals = retex_set_find_part(set, "guide_seen_normal");
    for (int i = 0; i < 3 * PIXELS; i++) {
        const int x = i / 3 % ACROSS, y = i / 3 / ACROSS, c = i % 3;
        if (fabs(albedo[i] - modulation(set, signal, x, y, c)) > 1e-5)
            fail_msg("albedo for %s at %d,%d: %g, not %g", denoise_signal_name(set, signal), x, y, (double)albedo[i],
                     modulation(set, signal, x, y, c));
        assert_true(normal[i] == pixel(set, normals, x, y)[c]);
    }
}

static void test_images(void **state)
{
    (void)state;
    static const char *const layouts[] = {"plain", "paper", "footprints"};
    for (int k = 0; k < 3; k++) {
        RetexSet *set = noisy_set(layouts[k]), *before = noisy_set(layouts[k]);
        RetexSignals signals = denoise_signals(before);
        memset(oidn, 0, sizeof *oidn);
        denoise_by(set, "oidn");
        int n = 0;
        for (int s = 0; s < signals.count; s++) {
            if (is_black(before, &signals.of[s]))
                continue;
            expect_color(before, &signals.of[s], oidn->color[n]);
            expect_guides(before, &signals.of[s], oidn->albedo[n], oidn->normal[n]);
            n++;
        }
        assert_true(n > (k > 0));
        assert_int_equal(oidn->executed, n);
        assert_int_equal(oidn->width, ACROSS);
        assert_int_equal(oidn->height, DOWN);
        assert_int_equal(oidn->threads, 2);
        assert_int_equal(oidn->affinity, 0);
        assert_int_equal(oidn->made_filters, n);
        expect_tidy();
        retex_signals_close(&signals);
        retex_set_close(&before);
        retex_set_close(&set);
    }
}

/* Numbers that are no light, which a damaged set may hold, do not reach it. */
static void test_strange_numbers(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("plain");
    RetexSignals signals = denoise_signals(set);
    pixel(set, signals.of[0].members[0].part, 5, 7)[1] = NAN;
    pixel(set, signals.of[0].members[0].part, 6, 7)[1] = 3e38f;
    retex_signals_close(&signals);
    denoise_by(set, "oidn");
    assert_true(oidn->color[0][3 * (7 * ACROSS + 5) + 1] == 0 && oidn->color[0][3 * (7 * ACROSS + 6) + 1] == 0);
    denoise_expect_finite(set);
    retex_set_close(&set);
}

/* ---- what is made of it ---- */

/* The mean of the pixels around a pixel. */
static double box(const RetexSet *set, const RetexSignal *signal, int x, int y, int c)
{
    double sum = 0;
    int count = 0;
    for (int v = y - 1; v <= y + 1; v++)
        for (int u = x - 1; u <= x + 1; u++)
            if (u >= 0 && u < ACROSS && v >= 0 && v < DOWN)
                sum += denoise_total(set, signal, u, v, c), count++;
    return sum / count;
}

/* The totals after denoising are the wanted ones times one number, by which the mean is as before; where retex's own
 * filter finds no light, there is none. */
static void expect_totals(const RetexSet *got, const RetexSet *own, const RetexSet *before, const RetexSignal *signal)
{
    double wanted[2] = {0, 0};
    for (int i = 0; i < PIXELS; i++)
        if (denoise_total(own, signal, i % ACROSS, i / ACROSS, 0) > 0)
            wanted[0] += box(before, signal, i % ACROSS, i / ACROSS, 0);
    wanted[1] = denoise_mean(before, signal, 0) * PIXELS;
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % ACROSS, y = i / ACROSS;
        const double there = denoise_total(own, signal, x, y, 0) > 0 ? box(before, signal, x, y, 0) : 0,
                     total = denoise_total(got, signal, x, y, 0);
        if (fabs(total - there * wanted[1] / wanted[0]) > 2e-3 * there + 1e-6)
            fail_msg("%s at %d,%d: %g, not %g", denoise_signal_name(before, signal), x, y, total,
                     there * wanted[1] / wanted[0]);
    }
}

static void test_oidn_replaces_the_total(void **state)
{
    (void)state;
    static const char *const layouts[] = {"plain", "paper", "footprints"};
    for (int k = 0; k < 3; k++) {
        RetexSet *set = noisy_set(layouts[k]), *own = noisy_set(layouts[k]), *before = noisy_set(layouts[k]);
        RetexSignals signals = denoise_signals(before);
        denoise_by(set, "oidn");
        denoise_by(own, "nlm");
        for (int s = 0; s < signals.count; s++)
            if (!is_black(before, &signals.of[s]))
                expect_totals(set, own, before, &signals.of[s]);
        retex_signals_close(&signals);
        retex_set_close(&before);
        retex_set_close(&own);
        retex_set_close(&set);
    }
}

/* Solves both = a own + b box by least squares. */
static void fit(double factors[2], const RetexSet *both, const RetexSet *own, const RetexSet *before)
{
    RetexSignals signals = denoise_signals(before);
    double nn = 0, nb = 0, bb = 0, n = 0, b = 0;
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % ACROSS, y = i / ACROSS;
        const double u = denoise_total(own, &signals.of[0], x, y, 0), v = box(before, &signals.of[0], x, y, 0),
                     t = denoise_total(both, &signals.of[0], x, y, 0);
        nn += u * u, nb += u * v, bb += v * v, n += u * t, b += v * t;
    }
    factors[0] = (n * bb - b * nb) / (nn * bb - nb * nb), factors[1] = (b * nn - n * nb) / (nn * bb - nb * nb);
    retex_signals_close(&signals);
}

static void test_both_is_the_mean(void **state)
{
    (void)state;
    RetexSet *both = noisy_set("plain"), *own = noisy_set("plain"), *before = noisy_set("plain");
    RetexSignals signals = denoise_signals(before);
    double factors[2];
    denoise_by(both, "both");
    denoise_by(own, NULL);
    fit(factors, both, own, before);
    assert_true(fabs(factors[0] - 0.5) < 0.02 && fabs(factors[1] - 0.5) < 0.02);
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % ACROSS, y = i / ACROSS;
        const double mean = factors[0] * denoise_total(own, &signals.of[0], x, y, 0) +
                            factors[1] * box(before, &signals.of[0], x, y, 0);
        if (fabs(denoise_total(both, &signals.of[0], x, y, 0) - mean) > 2e-3 * mean)
            fail_msg("at %d,%d: %g, not %g", x, y, denoise_total(both, &signals.of[0], x, y, 0), mean);
    }
    assert_int_equal(oidn->executed, 1);
    retex_signals_close(&signals);
    retex_set_close(&both);
    retex_set_close(&own);
    retex_set_close(&before);
}

/* nlm is the default, and does not open the library. */
static void test_default(void **state)
{
    (void)state;
    RetexSet *sets[2] = {noisy_set("footprints"), noisy_set("footprints")};
    denoise_by(sets[0], NULL);
    denoise_by(sets[1], "nlm");
    denoise_expect_same(sets[0], sets[1]);
    assert_int_equal(oidn->made_devices, 0);
    for (int k = 0; k < 2; k++)
        retex_set_close(&sets[k]);
}

/* ---- sets in memory and in files, threads, regions ---- */

static void denoise_file(const char *from, const char *to, const char *denoiser, int in_memory, int nthreads)
{
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    RetexError err = {0};
    RetexSet *set = NULL;
    params.near = to, params.denoiser = denoiser;
    test_must(in_memory ? retex_set_read(from, &set, nthreads, &err) : retex_set_open(from, &set, nthreads, &err),
              &err);
    test_must(retex_denoise(set, &params, NULL, nthreads, &err), &err);
    assert_int_equal(!in_memory, retex_part_store(&set->parts[0]) != NULL);
    test_must(retex_set_write(set, to, NULL, 0, &err), &err);
    retex_set_close(&set);
}

static void test_strips(void **state)
{
    (void)state;
    static const char *const layouts[] = {"plain", "paper", "footprints"}, *const denoisers[] = {"oidn", "both"};
    char command[1024];
    for (int k = 0; k < 6; k++) {
        RetexError err = {0};
        RetexSet *set = denoise_set(layouts[k / 2], 40, 300);
        denoise_add_noise(set, 3);
        test_must(retex_set_write(set, test_in_folder("noisy.exr"), NULL, 0, &err), &err);
        retex_set_close(&set);
        denoise_file(test_in_folder("noisy.exr"), test_in_folder("memory.exr"), denoisers[k % 2], 1, 1);
        denoise_file(test_in_folder("noisy.exr"), test_in_folder("strips.exr"), denoisers[k % 2], 0, 3);
        assert_int_equal(oidn->threads, 3);
        snprintf(command, sizeof command, "cmp '%s' '%s'", test_in_folder("memory.exr"), test_in_folder("strips.exr"));
        assert_int_equal(system(command), 0);
    }
    assert_int_equal(test_files_left(), 3);
}

/* Of a region, the light is that of the whole picture, but for the scale that keeps the region's mean. */
static void test_region(void **state)
{
    (void)state;
    static const RetexRoi roi = {11, 20, 81, 100, 0, 3};
    RetexSet *whole = noisy_set("plain"), *part = noisy_set("plain"), *before = noisy_set("plain");
    const RetexDenoiseParams params = params_of("oidn");
    RetexError err = {0};
    double scale = 0;
    denoise_by(whole, "oidn");
    test_must(retex_denoise(part, &params, &roi, 2, &err), &err);
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % ACROSS, y = i / ACROSS, inside = x >= roi.x0 && x < roi.x1 && y >= roi.y0 && y < roi.y1;
        const double now = pixel(part, 0, x, y)[0], of_whole = pixel(whole, 0, x, y)[0];
        if (!inside)
            assert_true(now == (double)pixel(before, 0, x, y)[0]);
        else if (!(scale > 0))
            scale = now / of_whole;
        else
            assert_true(fabs(now / of_whole - scale) < 2e-3);
    }
    assert_int_equal(oidn->width, ACROSS);
    retex_set_close(&whole);
    retex_set_close(&part);
    retex_set_close(&before);
}

/* ---- what goes wrong ---- */

/* Fails with that code and text, makes nothing of the set, and releases everything. */
static void expect_failure(const RetexDenoiseParams *params, int code, const char *text)
{
    RetexSet *set = noisy_set("footprints"), *before = noisy_set("footprints");
    RetexError err = {0};
    const int got = retex_denoise(set, params, NULL, 2, &err);
    if (got != code || !strstr(err.message, text))
        fail_msg("%d, %s; not %d, %s", got, err.message, code, text);
    denoise_expect_same(set, before);
    assert_int_equal(set->denoised, 0);
    assert_int_equal(oidn->devices, 0);
    assert_int_equal(oidn->filters, 0);
    assert_int_equal(oidn->misused, 0);
    retex_set_close(&set);
    retex_set_close(&before);
}

static void test_failures(void **state)
{
    (void)state;
    static const struct {
        const char *what, *text;
        int code;
    } cases[] = {
        {"no-device", "unsupported hardware", RETEX_EUNSUPPORTED},
        {"nothing", "makes no device", RETEX_EUNSUPPORTED},
        {"version-1", "is of version 1: version 2 is needed", RETEX_EUNSUPPORTED},
        {"device", "failed: the device is broken", RETEX_EUNSUPPORTED},
        {"no-filter", "unknown filter type", RETEX_EUNSUPPORTED},
        {"commit", "failed: the filter is broken", RETEX_EUNSUPPORTED},
        {"filter", "failed: the network is broken", RETEX_EUNSUPPORTED},
        {"silent", "failed: it does not say why", RETEX_EUNSUPPORTED},
        {"memory", "failed: out of memory", RETEX_ENOMEM},
        {"nan", "the result of Open Image Denoise has a number that is not finite", RETEX_EUNSUPPORTED},
        {"infinite", "the result of Open Image Denoise has a number that is not finite", RETEX_EUNSUPPORTED},
    };
    const RetexDenoiseParams params = params_of("oidn");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        setenv("OIDN_STAND_IN", cases[k].what, 1);
        expect_failure(&params, cases[k].code, cases[k].text);
    }
}

static void test_no_library(void **state)
{
    (void)state;
    RetexDenoiseParams params = params_of("both");
    choose_library("absent.so");
    expect_failure(&params, RETEX_EUNSUPPORTED, "absent.so: cannot open shared object file");
    choose_library("older.so");
    expect_failure(&params, RETEX_EUNSUPPORTED, "older.so has no oidnSetFilterInt: Open Image Denoise 2 is needed");
    params.denoiser = "OIDN";
    expect_failure(&params, RETEX_EINVAL, "the denoiser must be nlm, oidn or both, not 'OIDN'");
    assert_int_equal(oidn->made_devices, 0);
}

/* Light below 0 is no light. */
static void test_negative_light(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("plain");
    setenv("OIDN_STAND_IN", "negative", 1);
    denoise_by(set, "oidn");
    assert_true(pixel(set, 0, 1, 0)[1] == 0 && pixel(set, 0, 2, 0)[1] > 0);
    retex_set_close(&set);
}

static void test_black_picture(void **state)
{
    (void)state;
    RetexSet *set = denoise_set("plain", ACROSS, DOWN);
    memset(set->parts[0].image.pixels, 0, 3 * PIXELS * sizeof(float));
    denoise_by(set, "oidn");
    for (int i = 0; i < 3 * PIXELS; i++)
        assert_true(set->parts[0].image.pixels[i] == 0);
    assert_int_equal(oidn->executed, 0);
    expect_tidy();
    retex_set_close(&set);
}

/* ---- limits ---- */

static RetexBudget *new_budget(void)
{
    RetexBudget *budget = NULL;
    RetexError err = {0};
    test_must(retex_budget_create(&budget, &err), &err);
    return budget;
}

/* The filter is told to stop while it runs. */
static void test_time(void **state)
{
    (void)state;
    RetexDenoiseParams params = params_of("oidn");
    RetexBudget *budget = new_budget();
    setenv("OIDN_STAND_IN", "slow", 1);
    params.budget = budget;
    retex_budget_set_seconds(budget, 2);
    expect_failure(&params, RETEX_ELIMIT, "longer than the 2 s of --max-time");
    assert_int_equal(oidn->executed, 1);
    assert_int_equal(oidn->cancelled, 1);
    retex_budget_close(&budget);
}

/* Half of what the limit leaves is the filter's; with less than whole pictures take it does not begin. */
static void test_memory(void **state)
{
    (void)state;
    static const struct {
        uint64_t limit;
        int megabytes;
    } cases[] = {{0, 3000}, {(uint64_t)1 << 40, 3000}, {(uint64_t)1000 << 20, 500}, {(uint64_t)2 << 20, 64}};
    RetexDenoiseParams params = params_of("oidn");
    for (int k = 0; k < 4; k++) {
        RetexBudget *budget = new_budget();
        RetexSet *set = noisy_set("plain");
        retex_budget_set_memory(budget, cases[k].limit);
        params.budget = budget;
        denoise_all(set, &params, 1);
        assert_int_equal(oidn->megabytes, cases[k].megabytes);
        retex_set_close(&set);
        retex_budget_close(&budget);
    }
    RetexBudget *budget = new_budget();
    params.budget = budget;
    memset(oidn, 0, sizeof *oidn);
    retex_budget_set_memory(budget, 6 * 12 * PIXELS - 1); /* three signals, and three images to filter with */
    expect_failure(&params, RETEX_ELIMIT, "filters whole pictures: that takes more than the 1 MB of --max-memory");
    assert_int_equal(oidn->made_devices, 0);
    retex_budget_set_memory(budget, 6 * 12 * PIXELS);
    RetexSet *set = noisy_set("footprints");
    denoise_all(set, &params, 1);
    retex_set_close(&set);
    retex_budget_close(&budget);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, test_remove_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_images),        TEST(test_strange_numbers),  TEST(test_oidn_replaces_the_total),
        TEST(test_default),       TEST(test_both_is_the_mean), TEST(test_strips),
        TEST(test_region),        TEST(test_failures),         TEST(test_no_library),
        TEST(test_time),          TEST(test_memory),           TEST(test_negative_light),
        TEST(test_black_picture),
    };
    return cmocka_run_group_tests_name("denoise oidn", tests, find_stand_in, NULL);
}
