/* The quality bounds the loss of pictures made from a pack, with textures that the packer tried and, within a margin,
 * with others. */
#include "lib_footprints.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "pack/loss.h"

enum { WIDE = 72, HIGH = 66, PATTERNS = 3 };

static const double SLACK = 2; /* dB that textures which were not tried may lose more: retex-pack(1) */

static const int qualities[] = {30, 60, 90, 100};
enum { QUALITIES = sizeof qualities / sizeof *qualities };

/* ---- the formula ---- */

static void promises_rise_with_quality(void **state)
{
    static const double noises[] = {0, 1e-4, 1e-2};
    (void)state;
    for (int i = 0; i < 3; i++)
        for (int quality = 2; quality <= 100; quality++)
            assert_true(retex_pack_promised_psnr(quality, 32, noises[i]) >
                        retex_pack_promised_psnr(quality - 1, 32, noises[i]));
    for (int quality = 2; quality <= 100; quality++)
        assert_true(retex_pack_promised_psnr(quality, 1, 0) > retex_pack_promised_psnr(quality - 1, 1, 0));
    assert_float_equal(retex_pack_promised_psnr(50, 32, 0), 30, 1e-9);
    assert_float_equal(retex_pack_promised_psnr(50, 1024, 0), 30, 1e-9);
    assert_float_equal(retex_pack_promised_psnr(50, 16, 0), 30 - 10 * log10(2), 1e-9);
    assert_float_equal(retex_pack_promised_psnr(95, 16, 0), 42 - 5 * log10(2), 1e-9);
    assert_float_equal(retex_pack_promised_psnr(100, 1, 0), 50, 1e-9);
    assert_float_equal(retex_pack_promised_psnr(90, 32, 0), 34, 1e-9);
    assert_float_equal(retex_pack_promised_psnr(100, 32, 0.1), 50, 1e-9);
    assert_float_equal(retex_pack_promised_psnr(90, 32, 0.01), 30, 1e-9); /* a tenth of the noise */
}

/* ---- sets ---- */

/* Clusters, light that goes on, and footprints that are all over the texture, as no surface has them, of which
 * compacting keeps little: or, smooth, those of a wall. */
static RetexSet *make_set(int smooth)
{
    RetexSet *set = start_set(WIDE, HIGH, 1);
    uint32_t seed = 3;
    for (int k = 0; k < 6; k++)
        add_footprint(set, 0, k < 4 ? RETEX_FOOTPRINT_BROAD : RETEX_FOOTPRINT_INTERREFLECTION, 1 + k, "RGB");
    for (int k = 0; k < 4; k++)
        add_term(set, 1, k, 0);
    const int first = add_mixture(set, 0, 4, "R"), later = add_mixture(set, 4, 2, "R");
    add_term(set, 2, first, later);
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++) {
            for (int f = 0; f < set->nfootprints; f++) {
                const float u = smooth ? 0.8f * (float)x / WIDE : (float)test_random(&seed);
                const float v = smooth ? 0.8f * (float)y / HIGH : (float)test_random(&seed);
                put(set, f, x, y, u, v, 0.2f);
                put_spread(set, f, x, y, 0.01f, 0.01f, 0);
                put_rgb(set, set->footprints[f].albedo, x, y, 0.5f, 0.4f, 0.3f);
                *pixel(set, share_part(set, f), x, y) = smooth ? 0.25f : (float)(0.1 + test_random(&seed));
            }
            for (int t = 0; t < set->nterms; t++) {
                const float light = smooth ? 0.1f + 0.1f * (float)x / WIDE : (float)(0.3 * test_random(&seed));
                put_rgb(set, set->terms[t].radiance, x, y, light, light, light);
            }
        }
    set->spp = 32;
    return set;
}

/* ---- pictures with textures that packing does not try ---- */

static void paint(RetexImage *image, int pattern)
{
    uint32_t seed = 11;
    test_random_image(image, 32, 32, 3, seed, 0, 1);
    for (int i = 0; i < 32 * 32; i++)
        for (int c = 0; c < 3 && pattern; c++)
            image->pixels[3 * i + c] = pattern == 1 ? (c == 0 ? 0.9f : 0.05f) : (float)((i % 32 + i / 32) / 4 % 2);
}

static int take_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    RetexImage *image = context;
    (void)err;
    for (size_t i = 0; i < 3 * (size_t)(y1 - y0) * WIDE; i++)
        image->pixels[retex_image_index(image, 0, y0) + i] = rows[i];
    return 0;
}

static double untried(const RetexSet *pack, const RetexSet *set, int pattern)
{
    const RetexSet *sets[] = {pack, set};
    RetexImage texels = {0}, images[2] = {{0}};
    RetexTexture *textures[RETEX_MAX_TARGETS] = {NULL};
    RetexMetrics metrics;
    RetexError err = {0};
    paint(&texels, pattern);
    test_must(retex_texture_create(&textures[0], &texels, NULL, 0, &err), &err);
    for (int i = 0; i < 2; i++) {
        test_must(retex_image_alloc(&images[i], WIDE, HIGH, 3, &err), &err);
        test_must(retex_retexture(sets[i], textures, NULL, take_rows, &images[i], 1, &err), &err);
    }
    test_must(retex_metrics(&metrics, &images[0], &images[1], 1, &err), &err);
    retex_texture_close(&textures[0]);
    retex_image_free(&texels);
    for (int i = 0; i < 2; i++)
        retex_image_free(&images[i]);
    return metrics.psnr;
}

/* ---- packs ---- */

/* A pack of it, open; and how many bytes it has. */
static RetexSet *packed(const RetexSet *set, int quality, int nthreads, size_t *bytes)
{
    char path[] = "/tmp/test_promise_XXXXXX";
    RetexPackParams params = RETEX_PACK_INIT;
    RetexError err = {0};
    RetexSet *pack;
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    params.quality = quality;
    test_must(retex_pack_write(set, path, &params, bytes, nthreads, &err), &err);
    test_must(retex_set_open(path, &pack, 1, &err), &err);
    unlink(path);
    return pack;
}

static void promises_are_kept(void **state)
{
    (void)state;
    for (int smooth = 0; smooth < 2; smooth++) {
        RetexSet *set = make_set(smooth);
        for (int i = 0; i < QUALITIES; i++) {
            double psnr[RETEX_PACK_LOSSES];
            RetexPackPromise promise;
            RetexError err = {0};
            RetexSet *pack = packed(set, qualities[i], 2, NULL);
            assert_int_equal(retex_pack_promise(&promise, pack, NULL), RETEX_OK);
            assert_int_equal(promise.quality, qualities[i]);
            assert_float_equal(promise.promised, retex_pack_promised_psnr(qualities[i], 32, 0), 1e-9);
            assert_true(promise.measured >= promise.promised);
            test_must(retex_pack_loss(psnr, RETEX_PACK_LOSSES, pack, set, 1, &err), &err);
            assert_float_equal(fmin(fmin(psnr[0], psnr[1]), psnr[RETEX_PACK_LOSS_SQUARES]), promise.measured, 1e-9);
            for (int k = 0; k < PATTERNS; k++)
                assert_true(untried(pack, set, k) >= promise.promised - SLACK);
            retex_set_close(&pack);
        }
        retex_set_close(&set);
    }
}

static void count_warning(void *context, const char *text)
{
    (void)text;
    ++*(int *)context;
}

/* Why a set stays as it is, it is told once, however many attempts the promise takes: here several. */
static void attempts_warn_once(void **state)
{
    (void)state;
    char path[] = "/tmp/test_promise_XXXXXX";
    RetexPackParams params = RETEX_PACK_INIT;
    RetexError err = {0};
    RetexSet *set = make_set(1);
    int told = 0;
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    for (int k = 0; k < 4; k++) { /* more than a compact set has room for */
        test_add_lamp(set, (const char *const[]){"A", "B", "C", "D"}[k]);
        for (int c = 0; c < 3; c++)
            set->parameters[k].value[c] = 1;
    }
    params.quality = 100, params.warn = count_warning, params.warn_context = &told;
    test_must(retex_pack_write(set, path, &params, NULL, 1, &err), &err);
    unlink(path);
    assert_int_equal(told, 1);
    retex_set_close(&set);
}

/* Denoised light of tiles that differ, without any noise: pictures have so many dB against those of the set. */
static double psnr_of_tiles(int quality)
{
    RetexSet *set = make_set(1);
    double psnr[RETEX_PACK_LOSSES];
    RetexError err = {0};
    uint32_t seed = 5;
    set->denoised = 1;
    for (int t = 0; t < set->nterms; t++)
        for (int y = 0; y < HIGH; y += 11)
            for (int x = 0; x < WIDE; x += 9) {
                const float light = (float)(0.05 + 0.1 * test_random(&seed)), red = (float)test_random(&seed);
                for (int k = 0; k < 99; k++)
                    put_rgb(set, set->terms[t].radiance, x + k % 9, y + k / 9, light * red, light, light * (1 - red));
            }
    RetexSet *pack = packed(set, quality, 1, NULL);
    test_must(retex_pack_loss(psnr, RETEX_PACK_LOSSES, pack, set, 1, &err), &err);
    retex_set_close(&pack);
    retex_set_close(&set);
    return psnr[RETEX_PACK_LOSS_WHITE];
}

/* Each target has a part in the pictures: light that only one of two sets has on it is a loss in all of them, of so
 * many dB. */
static void all_targets_are_tried(void **state)
{
    (void)state;
    for (int t = 0; t < 2; t++) {
        RetexSet *sets[2];
        double psnr[RETEX_PACK_LOSSES];
        RetexError err = {0};
        for (int k = 0; k < 2; k++) {
            RetexSet *set = sets[k] = start_set(8, 8, 2);
            set->denoised = 1;
            for (int target = 0; target < 2; target++) {
                const int f = add_footprint(set, target, RETEX_FOOTPRINT_SHARP, 1, "RGB");
                const int light = add_term(set, 1, f, f);
                for (int i = 0; i < 64; i++) {
                    put(set, f, i % 8, i / 8, 0.5f, 0.5f, 1);
                    put_rgb(set, set->footprints[f].albedo, i % 8, i / 8, 0.25f, 0.25f, 0.25f);
                    put_rgb(set, light, i % 8, i / 8, k && target == t ? 0.5f : 0.25f, 0.25f, 0.25f);
                }
            }
        }
        test_must(retex_pack_loss(psnr, RETEX_PACK_LOSSES, sets[1], sets[0], 1, &err), &err);
        /* red: with white textures .5 and .75, with the originals .125 and .1875 */
        const double white = retex_srgb_encode(0.75) - retex_srgb_encode(0.5),
                     original = retex_srgb_encode(0.1875) - retex_srgb_encode(0.125);
        assert_float_equal(psnr[RETEX_PACK_LOSS_WHITE], -10 * log10(white * white / 3), 0.01);
        assert_float_equal(psnr[RETEX_PACK_LOSS_ORIGINAL], -10 * log10(original * original / 3), 0.01);
        retex_set_close(&sets[0]);
        retex_set_close(&sets[1]);
    }
}

/* The noise that a set says it has is that of its own picture: a target's counts by half. */
static void noise_counts_as_it_shows(void **state)
{
    static const char *const names[] = {"noise_indep", "noise_T0_sharp"};
    (void)state;
    for (int k = 0; k < 2; k++) {
        RetexSet *set = start_set(8, 8, 1);
        RetexPackReference reference;
        RetexError err = {0};
        int part;
        const int f = add_footprint(set, 0, RETEX_FOOTPRINT_SHARP, 1, "RGB"), light = add_term(set, 1, f, f);
        test_must(retex_set_add_part(set, names[k], "RGB", RETEX_HALF, 0, 0, &part, &err), &err);
        for (int i = 0; i < 64; i++) {
            put(set, f, i % 8, i / 8, 0.5f, 0.5f, 1);
            put_rgb(set, set->footprints[f].albedo, i % 8, i / 8, 0.5f, 0.5f, 0.5f);
            put_rgb(set, light, i % 8, i / 8, 0.5f, 0.5f, 0.5f);
            put_rgb(set, part, i % 8, i / 8, 0.125f, 0.125f, 0.125f);
        }
        test_must(retex_pack_reference_open(&reference, set, 1u << RETEX_PACK_LOSS_ORIGINAL, 1, &err), &err);
        const double off = retex_srgb_encode(0.25 + 0.125 / (k + 1)) - retex_srgb_encode(0.25);
        assert_true(fabs(reference.noise / (off * off) - 1) < 1e-3);
        retex_pack_reference_close(&reference);
        retex_set_close(&set);
    }
}

/* Its steps are finer than those of a JPEG's 255 levels, or of twice as many. */
static void clean_light_stays_clean(void **state)
{
    (void)state;
    assert_true(psnr_of_tiles(90) > 67);
    assert_true(psnr_of_tiles(100) > 69);
}

/* What 100 promises needs every bit of some sets; others are packed far smaller, and all the more at 30. */
static void bits_are_kept_where_nothing_else_does(void **state)
{
    size_t bytes[2][2];
    (void)state;
    for (int smooth = 0; smooth < 2; smooth++) {
        RetexSet *set = make_set(smooth);
        for (int i = 0; i < 2; i++) {
            RetexPackPromise promise;
            RetexSet *pack = packed(set, i ? 100 : 30, 1, &bytes[smooth][i]);
            assert_int_equal(retex_pack_promise(&promise, pack, NULL), RETEX_OK);
            assert_true(promise.measured < 60 || (smooth && i && promise.measured == 120));
            retex_set_close(&pack);
        }
        assert_true(bytes[smooth][0] < bytes[smooth][1]);
        retex_set_close(&set);
    }
}

/* Noise that a set tells of lets more of it go; what denoising has used up does not. */
static void noise_lowers_the_promise(void **state)
{
    double promised[3];
    (void)state;
    for (int i = 0; i < 3; i++) {
        RetexSet *set = make_set(1);
        RetexPackPromise promise;
        RetexError err = {0};
        int noise;
        if (i > 0)
            test_must(retex_set_add_part(set, "noise_indep", "RGB", RETEX_HALF, 0, 0, &noise, &err), &err);
        for (int k = 0; i > 0 && k < 3 * WIDE * HIGH; k++)
            set->parts[noise].image.pixels[k] = k / 3 % 2 ? 0.15f : -0.15f;
        set->denoised = i == 2;
        RetexSet *pack = packed(set, 90, 1, NULL);
        assert_int_equal(retex_pack_promise(&promise, pack, NULL), RETEX_OK);
        promised[i] = promise.promised;
        retex_set_close(&pack);
        retex_set_close(&set);
    }
    assert_float_equal(promised[0], 34, 1e-9);
    assert_true(promised[1] < 33);
    assert_float_equal(promised[2], 34, 1e-9);
}

static void others_promise_nothing(void **state)
{
    RetexSet *set = make_set(1);
    RetexPackPromise promise;
    (void)state;
    assert_int_equal(retex_pack_promise(&promise, set, NULL), RETEX_ENOTFOUND);
    retex_set_close(&set);
}

static void threads_do_not_matter(void **state)
{
    RetexSet *set = make_set(0);
    RetexPackPromise one, many;
    size_t bytes[2];
    (void)state;
    RetexSet *pack = packed(set, 100, 1, &bytes[0]), *other = packed(set, 100, 7, &bytes[1]);
    assert_true(!retex_pack_promise(&one, pack, NULL) && !retex_pack_promise(&many, other, NULL));
    assert_int_equal(bytes[0], bytes[1]);
    assert_true(one.measured == many.measured);
    retex_set_close(&pack);
    retex_set_close(&other);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(promises_rise_with_quality),
        cmocka_unit_test(promises_are_kept),
        cmocka_unit_test(attempts_warn_once),
        cmocka_unit_test(all_targets_are_tried),
        cmocka_unit_test(noise_counts_as_it_shows),
        cmocka_unit_test(clean_light_stays_clean),
        cmocka_unit_test(bits_are_kept_where_nothing_else_does),
        cmocka_unit_test(noise_lowers_the_promise),
        cmocka_unit_test(others_promise_nothing),
        cmocka_unit_test(threads_do_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
