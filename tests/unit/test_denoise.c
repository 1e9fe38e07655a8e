/* Denoising of whole sets: what a call does and refuses, and that its result does not depend on how it is made. */
#include "lib_denoise.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const layouts[] = {"plain", "paper", "footprints"};

static RetexSet *noisy_set(const char *layout, int width, int height)
{
    RetexSet *set = denoise_set(layout, width, height);
    denoise_add_noise(set, 7);
    return set;
}

/* ---- repeatable ---- */

static void test_threads_and_vectors(void **state)
{
    (void)state;
    static const struct {
        const char *layout;
        int nthreads, scalar;
    } ways[] = {{"plain", 7, 1}, {"paper", 7, 1}, {"footprints", 2, 0}, {"footprints", 7, 0}, {"footprints", 1, 1}};
    RetexSet *first = NULL;
    for (int k = 0; k < 5; k++) {
        RetexDenoiseParams params = RETEX_DENOISE_INIT;
        params.scalar = ways[k].scalar;
        if (k < 3) {
            retex_set_close(&first);
            first = noisy_set(ways[k].layout, 150, 130);
            denoise_all(first, NULL, 1);
        }
        RetexSet *set = noisy_set(ways[k].layout, 150, 130);
        denoise_all(set, &params, ways[k].nthreads);
        denoise_expect_same(first, set);
        retex_set_close(&set);
    }
    retex_set_close(&first);
}

/* A budget that is stopped, or whose time is over, ends it, of sets in memory. */
static void test_budget_ends_it(void **state)
{
    (void)state;
    RetexError err = {0};
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    for (int late = 0; late < 2; late++) {
        RetexSet *set = noisy_set("footprints", 60, 40);
        RetexBudget *budget = NULL;
        assert_int_equal(retex_budget_create(&budget, &err), 0);
        params.budget = budget;
        if (late)
            retex_budget_set_seconds(budget, 1e-9);
        else
            retex_budget_stop(budget);
        assert_int_equal(retex_denoise(set, &params, NULL, 2, &err), late ? RETEX_ELIMIT : RETEX_ESTOPPED);
        retex_budget_close(&budget);
        retex_set_close(&set);
    }
}

/* What lies in the region was filtered, with what lies around it; around it nothing changed. */
static void test_region(void **state)
{
    (void)state;
    static const RetexRoi roi = {37, 21, 119, 100, 0, 3};
    for (int k = 0; k < 3; k++) {
        RetexSet *before = noisy_set(layouts[k], 150, 130), *set = noisy_set(layouts[k], 150, 130);
        RetexError err = {0};
        int changed = 0;
        test_must(retex_denoise(set, NULL, &roi, 2, &err), &err);
        retex_denoise_drop_data(before);
        assert_int_equal(before->nparts, set->nparts);
        for (int part = 0; part < set->nparts; part++) {
            const RetexImage *a = &before->parts[part].image, *b = &set->parts[part].image;
            for (int y = 0; y < set->height; y++)
                for (int x = 0; x < set->width; x++) {
                    const size_t i = retex_image_index(a, x, y);
                    const int inside = x >= roi.x0 && x < roi.x1 && y >= roi.y0 && y < roi.y1;
                    const int same = memcmp(a->pixels + i, b->pixels + i, sizeof(float) * (size_t)a->channels) == 0;
                    if (!inside && !same)
                        fail_msg("%s changed at %d,%d", set->parts[part].name, x, y);
                    changed += !same;
                }
        }
        assert_true(changed > 82 * 79 * 9 / 10);
        retex_set_close(&before);
        retex_set_close(&set);
    }
}

/* ---- what a set is afterwards ---- */

static void test_data_is_gone(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        RetexSet *set = noisy_set(layouts[k], 40, 30), *clean = denoise_set(layouts[k], 40, 30);
        RetexError err = {0};
        assert_true(retex_denoise_has_data(set));
        assert_int_equal(set->denoised, 0);
        denoise_all(set, NULL, 1);
        assert_false(retex_denoise_has_data(set));
        assert_int_equal(set->denoised, 1);
        assert_string_equal(set->parts[0].name, "beauty");
        for (int part = 0; part < set->nparts; part++)
            assert_true(strncmp(set->parts[part].name, "noise_", 6) && strncmp(set->parts[part].name, "guide_", 6));
        assert_int_equal(set->nterms, clean->nterms);
        assert_int_equal(set->nfootprints, clean->nfootprints);
        for (int t = 0; t < set->nterms; t++)
            assert_string_equal(set->parts[set->terms[t].radiance].name, clean->parts[clean->terms[t].radiance].name);
        assert_int_equal(retex_denoise(set, NULL, NULL, 1, &err), RETEX_ENOTFOUND); /* twice */
        retex_set_close(&set);
        retex_set_close(&clean);
    }
}

static void test_beauty_is_the_recombination(void **state)
{
    (void)state;
    for (int k = 1; k < 3; k++) {
        RetexSet *set = noisy_set(layouts[k], 70, 60);
        RetexImage picture = {0};
        RetexError err = {0};
        denoise_all(set, NULL, 2);
        test_must(retex_combine(&picture, set, NULL, NULL, 1, &err), &err);
        assert_memory_equal(picture.pixels, set->parts[0].image.pixels, sizeof(float) * 3 * 70 * 60);
        retex_image_free(&picture);
        retex_set_close(&set);
    }
}

static void record(void *context, double done)
{
    double *last = context;
    assert_true(done >= *last && done <= 1);
    *last = done;
}

static void test_progress(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("plain", 20, 150);
    double last = 0;
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    params.progress = record, params.progress_context = &last;
    denoise_all(set, &params, 2);
    assert_true(last == 1);
    retex_set_close(&set);
}

/* ---- refused ---- */

static void expect_refused(RetexSet *set, const RetexDenoiseParams *params, int code, const char *word)
{
    RetexSet *before = noisy_set("footprints", 20, 15);
    RetexError err = {0};
    assert_int_equal(retex_denoise(set, params, NULL, 1, &err), code);
    assert_int_equal(err.code, code);
    if (!strstr(err.message, word))
        fail_msg("'%s' is not in '%s'", word, err.message);
    assert_int_equal(retex_denoise(set, params, NULL, 1, NULL), code);
    assert_int_equal(set->denoised, 0);
    for (int t = 0; t < set->nterms; t++)
        assert_memory_equal(set->parts[set->terms[t].radiance].image.pixels,
                            before->parts[before->terms[t].radiance].image.pixels, sizeof(float) * 3 * 20 * 15);
    retex_set_close(&before);
}

static void test_parameters(void **state)
{
    (void)state;
    static const float strengths[] = {0, 0.09f, 10.01f, -1, NAN, INFINITY};
    static const int radii[] = {0, -1, 11, 1000};
    RetexSet *set = noisy_set("footprints", 20, 15);
    for (int k = 0; k < 6; k++) {
        RetexDenoiseParams params = RETEX_DENOISE_INIT;
        params.strength = strengths[k];
        expect_refused(set, &params, RETEX_EINVAL, "strength");
    }
    for (int k = 0; k < 4; k++) {
        RetexDenoiseParams params = RETEX_DENOISE_INIT;
        params.radius = radii[k];
        expect_refused(set, &params, RETEX_EINVAL, "radius");
    }
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    params.quality = "draft";
    expect_refused(set, &params, RETEX_EINVAL, "quality of denoising must be preview or final, not 'draft'");
    for (set->spp = 0; set->spp < 2; set->spp++)
        expect_refused(set, NULL, RETEX_EINVAL, "two samples");
    retex_set_close(&set);
}

/* What a preview is made with; a radius of 1 stays. */
static void test_quality(void **state)
{
    (void)state;
    for (int radius = 1; radius <= 10; radius += 4) {
        RetexSet *preview = noisy_set("footprints", 40, 30), *plain = noisy_set("footprints", 40, 30);
        RetexDenoiseParams params = {sizeof params, 2, radius, 1, .quality = "preview"},
                           same = {sizeof same, 2, radius < 2 ? radius : 2, 0, .full_precision = 1, .quality = "final"};
        denoise_all(preview, &params, 2);
        denoise_all(plain, &same, 1);
        denoise_expect_same(preview, plain);
        retex_set_close(&preview);
        retex_set_close(&plain);
    }
}

/* An older caller's params are shorter: what they lack is as by default. */
static void test_shorter_params(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("footprints", 20, 15), *other = noisy_set("footprints", 20, 15);
    RetexDenoiseParams params = {.size = offsetof(RetexDenoiseParams, radius), .strength = 1, .radius = 77};
    denoise_all(set, &params, 1);
    denoise_all(other, NULL, 1);
    denoise_expect_same(set, other);
    retex_set_close(&set);
    retex_set_close(&other);
}

static void test_missing_parts(void **state)
{
    (void)state;
    static const char *const names[] = {"guide_normal",        "guide_position",    "guide_specular",
                                        "guide_seen_normal",   "guide_seen_albedo", "guide_seen_position",
                                        "guide_seen_material", "guide_cover_T0",    "noise_indep",
                                        "noise_T0_sharp",      "noise_T0_broad"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        RetexSet *set = noisy_set("footprints", 20, 15);
        RetexError err = {0};
        const int part = retex_set_find_part(set, names[k]);
        assert_true(part > 0);
        if (k % 2) {
            retex_set_remove_part(set, part);
            expect_refused(set, NULL, RETEX_ENOTFOUND, names[k]);
        } else { /* of another size */
            retex_image_free(&set->parts[part].image);
            test_must(retex_image_alloc(&set->parts[part].image, 20, 14, k == 2 ? 1 : 3, &err), &err);
            expect_refused(set, NULL, RETEX_EFORMAT, names[k]);
        }
        assert_false(retex_denoise_has_data(set));
        retex_set_close(&set);
    }
}

/* ---- few paths ---- */

/* A pixel without light on a cluster has no footprint of it either. */
static void clear_cluster(RetexSet *set, const RetexSignalMember *member, int i)
{
    const int footprint = member->cluster;
    if (footprint >= 0)
        memset(set->parts[set->footprints[footprint].uv].image.pixels + (size_t)3 * (size_t)i, 0, 3 * sizeof(float));
}

/* Leave light at one pixel of so many, and none at others; bare: also no footprints of clusters at others. */
static void thin_out(RetexSet *set, int one_of, uint32_t seed, int bare)
{
    RetexSignals signals = denoise_signals(set);
    for (int s = 0; s < signals.count; s++)
        for (int i = 0; i < set->width * set->height; i++) {
            const int kept = (int)(test_random(&seed) * one_of) == 0;
            for (int k = -1; k < signals.of[s].nmembers && !kept; k++) {
                const int part = k < 0 ? signals.of[s].noise : signals.of[s].members[k].part;
                memset(set->parts[part].image.pixels + (size_t)3 * (size_t)i, 0, 3 * sizeof(float));
                if (bare && k >= 0)
                    clear_cluster(set, &signals.of[s].members[k], i);
            }
        }
    retex_signals_close(&signals);
}

static void expect_kept(const char *layout, int one_of, int bare, const RetexDenoiseParams *params)
{
    RetexSet *before = noisy_set(layout, 150, 130), *set = noisy_set(layout, 150, 130);
    thin_out(before, one_of, 3, bare);
    thin_out(set, one_of, 3, bare);
    RetexSignals signals = denoise_signals(before);
    denoise_all(set, params, 2);
    denoise_expect_finite(set);
    for (int s = 0; s < signals.count; s++)
        for (int c = 0; c < 3; c++) {
            const double a = denoise_mean(before, &signals.of[s], c), b = denoise_mean(set, &signals.of[s], c);
            if (!(fabs(a - b) < 2e-3 * a))
                fail_msg("%s, one of %d, bare %d: signal %d had %g, has %g", layout, one_of, bare, s, a, b);
        }
    retex_signals_close(&signals);
    retex_set_close(&before);
    retex_set_close(&set);
}

/* Light is not lost where the weights that members' proportions are made with meet none, and other candidates do, nor
 * where the pixels whose footprints are pooled, a grid of the window, have none. */
static void test_rare_light_is_kept(void **state)
{
    (void)state;
    RetexDenoiseParams wide = RETEX_DENOISE_INIT, still = RETEX_DENOISE_INIT;
    wide.radius = 10;
    still.footprints = 0;
    for (int one_of = 30; one_of <= 300; one_of *= 10)
        for (int k = 1; k < 3; k++)
            expect_kept(layouts[k], one_of, 0, NULL);
    for (int one_of = 5; one_of <= 500; one_of *= 10) {
        expect_kept("footprints", one_of, 1, NULL);
        expect_kept("footprints", one_of, 1, &wide);
        expect_kept("footprints", one_of, 1, &still);
    }
}

/* Scale light, and its noise, pixel by pixel: by e^(-0.9 span) to e^(0.1 span). */
static void scale_light(RetexSet *set, double span, uint32_t seed)
{
    const size_t pixels = (size_t)set->width * (size_t)set->height;
    float *scales = malloc(pixels * sizeof *scales);
    assert_non_null(scales);
    for (size_t i = 0; i < pixels; i++)
        scales[i] = (float)exp((test_random(&seed) - 0.9) * span);
    for (int part = 0; part < set->nparts; part++)
        for (size_t i = 0; i < 3 * pixels; i++)
            if (strncmp(set->parts[part].name, "term", 4) == 0 || strncmp(set->parts[part].name, "noise_", 6) == 0)
                set->parts[part].image.pixels[i] *= scales[i / 3];
    free(scales);
}

/* Sums of light that is next to nothing lie near the least number there is, beside totals that do not. */
static void test_light_of_all_sizes(void **state)
{
    (void)state;
    for (int k = 1; k < 3; k++)
        for (uint32_t seed = 1; seed <= 8; seed++) {
            RetexSet *set = noisy_set(layouts[k], 80, 75);
            thin_out(set, 10, seed, 0);
            scale_light(set, 70, seed);
            denoise_all(set, NULL, 2);
            denoise_expect_finite(set);
            retex_set_close(&set);
        }
}

/* Scale one channel of all light and of its noise, in every third column by more. */
static void stain(RetexSet *set, int channel, float by)
{
    for (int part = 0; part < set->nparts; part++)
        for (int i = channel; i < 3 * set->width * set->height; i += 3)
            if (strncmp(set->parts[part].name, "term", 4) == 0 || strncmp(set->parts[part].name, "noise_", 6) == 0)
                set->parts[part].image.pixels[i] *= i / 3 % set->width % 3 ? by : 3 * by;
}

/* Each channel of each signal has the mean that it had, whatever the others have. */
static void test_channels_are_on_their_own(void **state)
{
    (void)state;
    enum { WIDTH = 40, HEIGHT = 30 };
    for (int bright = 0; bright < 3; bright++) {
        RetexSet *before = noisy_set("footprints", WIDTH, HEIGHT), *set = noisy_set("footprints", WIDTH, HEIGHT);
        stain(before, bright, 20);
        stain(set, bright, 20);
        denoise_all(set, NULL, 2);
        RetexSignals signals = denoise_signals(before);
        for (int s = 0; s < signals.count; s++)
            for (int c = 0; c < 3; c++) {
                const double a = denoise_mean(before, &signals.of[s], c), b = denoise_mean(set, &signals.of[s], c);
                if (fabs(a - b) > 2e-3 * a)
                    fail_msg("channel %d of signal %d: mean %.6g instead of %.6g", c, s, b, a);
            }
        retex_signals_close(&signals);
        retex_set_close(&before);
        retex_set_close(&set);
    }
}

/* Gives directions and positions ripples, and takes other axes. */
static void ripple_guides(RetexSet *set, int turn)
{
    for (int k = 0; k < RETEX_FEATURE_COUNT; k++) {
        const RetexFeatureInfo *info = retex_feature_info(k);
        RetexImage *im = &set->parts[retex_set_find_part(set, info->name)].image;
        if (info->kind != RETEX_FEATURE_KIND_NORMAL && info->kind != RETEX_FEATURE_KIND_POSITION)
            continue;
        for (int i = 0; i < im->width * im->height; i++) {
            const float x = (float)(i % im->width), y = (float)(i / im->width), *old = im->pixels + 3 * i;
            const float rippled[] = {old[0], old[1] + 0.2f * sinf(0.5f * x), old[2] + 0.3f * sinf(0.4f * y + 0.2f * x)};
            for (int c = 0; c < 3; c++)
                im->pixels[3 * i + (c + turn) % 3] = rippled[c];
        }
    }
}

/* Denoises both, which are closed; the picture of the second is that of the first, its channels moved by `turn`. */
static void expect_alike(RetexSet *first, RetexSet *turned, int turn)
{
    denoise_all(first, &denoise_exactly, 2);
    denoise_all(turned, &denoise_exactly, 2);
    const int beauty = retex_set_find_part(first, "beauty"), pixels = first->width * first->height;
    const float *a = first->parts[beauty].image.pixels, *b = turned->parts[beauty].image.pixels;
    double most = 0, sum = 0;
    for (int i = 0; i < pixels; i++)
        for (int c = 0; c < 3; c++) {
            most = fmax(most, fabs((double)a[3 * i + c] - (double)b[3 * i + (c + turn) % 3]));
            sum += (double)a[3 * i + c];
        }
    const double mean = sum / (3.0 * pixels);
    if (!(most < 1e-3 * mean))
        fail_msg("%g of a mean of %g", most, mean);
    retex_set_close(&first);
    retex_set_close(&turned);
}

/* Which axis is the first is no matter: each counts. */
static void test_axes_are_alike(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        RetexSet *first = noisy_set(layouts[k], 90, 70), *turned = noisy_set(layouts[k], 90, 70);
        ripple_guides(first, 0);
        ripple_guides(turned, 1);
        expect_alike(first, turned, 0);
    }
}

/* Gives channels noise and colours of their own, and moves each by `turn`. */
static void turn_colors(RetexSet *set, int turn)
{
    static const char *const guides[] = {"normal", "position", "material", "uv", "spread"};
    for (int k = 0; k < set->nparts; k++) {
        RetexImage *im = &set->parts[k].image;
        int is_rgb = im->channels == 3;
        for (size_t g = 0; g < sizeof guides / sizeof *guides; g++)
            is_rgb = is_rgb && !strstr(set->parts[k].name, guides[g]);
        for (int i = 0; is_rgb && i < im->width * im->height; i++) {
            const float *old = im->pixels + 3 * i;
            const float own[] = {old[0], old[1] * (i % 5 ? 1 : 3), old[2] * (i % 7 ? 0.5f : 6)};
            for (int c = 0; c < 3; c++)
                im->pixels[3 * i + (c + turn) % 3] = own[c];
        }
    }
}

/* Which colour is the first is no matter. */
static void test_colors_are_alike(void **state)
{
    (void)state;
    RetexSet *first = noisy_set("plain", 90, 70), *turned = noisy_set("plain", 90, 70);
    turn_colors(first, 0);
    turn_colors(turned, 1);
    expect_alike(first, turned, 1);
}

/* ---- invalid sets ---- */

/* Values that are no numbers, one in seven of those in parts whose name begins so. */
static void spoil(RetexSet *set, const char *prefix)
{
    static const float none[] = {NAN, INFINITY, -INFINITY, 3e38f, -3e38f};
    for (int part = 0; part < set->nparts; part++) {
        RetexImage *im = &set->parts[part].image;
        for (int i = part % 7; i < im->width * im->height * im->channels; i += 7)
            if (strncmp(set->parts[part].name, prefix, strlen(prefix)) == 0)
                im->pixels[i] = none[i / 7 % 5];
    }
}

static void test_what_is_no_number(void **state)
{
    (void)state;
    static const char *const prefixes[] = {"term", "beauty", "noise_", "guide_", "uv", "spread", "albedo", "share"};
    for (int k = 0; k < 3; k++)
        for (int n = 0; n < 8; n++) {
            RetexSet *set = noisy_set(layouts[k], 50, 40);
            spoil(set, prefixes[n]);
            denoise_all(set, NULL, 1);
            for (int t = 0; t < set->nterms; t++) {
                const RetexImage *im = &set->parts[set->terms[t].radiance].image;
                for (int i = 0; i < 50 * 40 * 3; i++)
                    if (!isfinite(im->pixels[i]))
                        fail_msg("%s, %s: term %d has %g", layouts[k], prefixes[n], t, (double)im->pixels[i]);
            }
            if (n < 4)
                denoise_expect_finite(set);
            retex_set_close(&set);
        }
}

static void test_sizes(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {3, 200}, {64, 64}, {57, 1}, {56, 57}};
    for (int k = 0; k < 3; k++)
        for (int n = 0; n < 5; n++)
            for (int radius = 1; radius <= 10; radius += 9) {
                RetexSet *set = noisy_set(layouts[k], sizes[n][0], sizes[n][1]);
                RetexDenoiseParams params = RETEX_DENOISE_INIT;
                params.radius = radius;
                denoise_all(set, &params, 2);
                denoise_expect_finite(set);
                retex_set_close(&set);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads_and_vectors),
        cmocka_unit_test(test_budget_ends_it),
        cmocka_unit_test(test_region),
        cmocka_unit_test(test_data_is_gone),
        cmocka_unit_test(test_beauty_is_the_recombination),
        cmocka_unit_test(test_progress),
        cmocka_unit_test(test_parameters),
        cmocka_unit_test(test_quality),
        cmocka_unit_test(test_shorter_params),
        cmocka_unit_test(test_missing_parts),
        cmocka_unit_test(test_rare_light_is_kept),
        cmocka_unit_test(test_channels_are_on_their_own),
        cmocka_unit_test(test_light_of_all_sizes),
        cmocka_unit_test(test_axes_are_alike),
        cmocka_unit_test(test_colors_are_alike),
        cmocka_unit_test(test_what_is_no_number),
        cmocka_unit_test(test_sizes),
    };
    return cmocka_run_group_tests_name("denoise", tests, NULL, NULL);
}
