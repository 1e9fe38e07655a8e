/* Packs: round trips that are bit-exact or close. */
#include "lib_pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "pack/open.h"
#include "pack/strips.h"
#include "pack/plan.h"

static void test_lossless_keeps_every_bit(void **state)
{
    (void)state;
    size_t bytes, again_bytes;
    RetexPackParams params = lossless();
    RetexSet *set = test_set(37, 29, 3);
    set->parts[3].image.pixels[4] = -0.0f; /* zeros with a sign, subnormals and infinite depth survive too */
    set->parts[4].image.pixels[5] = 5.9604645e-8f;
    int depth = retex_set_find_part(set, "depth");
    set->parts[depth].image.pixels[1] = 1e-42f;
    set->parts[depth].image.pixels[2] = INFINITY;
    unsigned char *data = pack(set, &params, &bytes, 0);
    RetexSet *back = unpack(data, bytes);
    assert_int_equal(back->nparts, set->nparts);
    for (int i = 0; i < set->nparts; i++) {
        const RetexImage *im = &set->parts[i].image;
        assert_string_equal(back->parts[i].name, set->parts[i].name);
        assert_int_equal(back->parts[i].type, set->parts[i].type);
        assert_memory_equal(back->parts[i].image.pixels, im->pixels,
                            (size_t)im->width * (size_t)im->height * (size_t)im->channels * sizeof(float));
    }
    assert_int_equal(back->nterms, set->nterms);
    assert_memory_equal(back->footprints, set->footprints, (size_t)set->nfootprints * sizeof *set->footprints);
    unsigned char *again = pack(back, &params, &again_bytes, 0); /* and the same bytes come out again */
    assert_int_equal(again_bytes, bytes);
    assert_memory_equal(again, data, bytes);
    free(again);
    free(data);
    retex_set_close(&back);
    retex_set_close(&set);
}

/* Parts of few different values have a palette of them, which is smaller; others, and small ones, have not; either way
 * every bit is kept, of zeros with a sign and of infinities too. */
static void test_few_values_have_a_palette(void **state)
{
    (void)state;
    enum { FEW = 106, PIXELS = 97 * 70 }; /* 64 pixels for each */
    RetexPackParams params = lossless();
    RetexSet *set = test_set(97, 70, 4);
    const int parts[2] = {retex_set_find_part(set, "depth"), set->footprints[0].albedo};
    assert_int_equal(set->parts[parts[0]].type, RETEX_FLOAT);
    set->parts[parts[1]].type = RETEX_HALF;
    size_t bytes[2];
    for (int few = 0; few < 2; few++) {
        uint32_t seed = 5;
        for (int i = 0; i < 2; i++) {
            const RetexImage *im = &set->parts[parts[i]].image;
            for (int k = 0; k < PIXELS * im->channels; k++) {
                const int value = (int)(test_random(&seed) * FEW);
                im->pixels[k] = value == 0 ? -0.0f : value == 1 && i == 0 ? INFINITY : (float)value / 128;
            }
            im->pixels[0] = few ? 0.25f : 0.875f; /* one of the others, or one more */
        }
        RetexPackPart *plan = calloc((size_t)set->nparts, sizeof *plan);
        test_must(retex_pack_plan(plan, set, NULL, 2, NULL), NULL);
        for (int i = 0; i < 2; i++)
            assert_int_equal(plan[parts[i]].maps[0].kind, few ? RETEX_PACK_MAP_PALETTE : RETEX_PACK_MAP_BITS);
        assert_int_equal(plan[parts[1]].maps[1].kind, RETEX_PACK_MAP_PALETTE);
        free(plan);
        unsigned char *data = pack(set, &params, &bytes[few], 0);
        RetexSet *back = unpack(data, bytes[few]);
        for (int i = 0; i < set->nparts; i++) {
            const RetexImage *im = &set->parts[i].image;
            assert_memory_equal(back->parts[i].image.pixels, im->pixels,
                                (size_t)im->width * (size_t)im->height * (size_t)im->channels * sizeof(float));
        }
        free(data);
        retex_set_close(&back);
    }
    print_message("with palettes: %d bytes instead of %d\n", (int)bytes[1], (int)bytes[0]);
    assert_true(bytes[1] + 500 < bytes[0]);
    retex_set_close(&set);
}

static void test_default_is_close_and_smaller(void **state)
{
    (void)state;
    size_t bytes, lossless_bytes;
    RetexPackParams params = lossless();
    RetexSet *set = test_set(200, 150, 4);
    free(pack(set, &params, &lossless_bytes, 0));
    unsigned char *data = pack(set, NULL, &bytes, 0);
    RetexSet *back = unpack(data, bytes);
    assert_true(bytes * 2 < lossless_bytes);
    for (int i = 0; i < set->nterms; i++) {
        const RetexPart *before = &set->parts[set->terms[i].radiance], *after = &back->parts[back->terms[i].radiance];
        double sum[2][3] = {{0}};
        for (size_t j = 0; j < 200 * 150 * 3; j++) {
            assert_true(before->image.pixels[j] != 0 || after->image.pixels[j] == 0); /* black stays black */
            sum[0][j % 3] += (double)before->image.pixels[j];
            sum[1][j % 3] += (double)after->image.pixels[j];
        }
        for (int c = 0; c < 3; c++) /* and the mean the mean, nearly */
            assert_true(fabs(sum[1][c] - sum[0][c]) / (200 * 150) < 1e-4 + 2e-3 * sum[0][c] / (200 * 150));
        RetexMetrics m;
        RetexError err = {0};
        test_must(retex_metrics(&m, &after->image, &before->image, 0, &err), &err);
        assert_true(m.psnr > 40);
    }
    for (int i = 0; i < set->nfootprints; i++) {
        const RetexFootprint *f = &set->footprints[i];
        const RetexImage *uv = &set->parts[f->uv].image, *spread = &set->parts[f->spread].image;
        for (size_t j = 0; j < 200 * 150; j++) {
            const float *before = uv->pixels + 3 * j, *after = back->parts[f->uv].image.pixels + 3 * j;
            for (size_t c = 0; c < 2 && before[2] > 0; c++)
                assert_true(fabs((double)before[c] - (double)after[c]) <=
                            fmax((double)spread->pixels[2 * j + c] / 7.5, 1.0 / 524288));
            assert_true((before[2] > 0) == (after[2] > 0));
            assert_true(fabs((double)before[2] - (double)after[2]) <= 0.2 * (double)before[2]);
        }
        assert_true(part_difference(&set->parts[f->spread], &back->parts[f->spread], 1e-9) < 0.05);
        assert_true(part_difference(&set->parts[f->albedo], &back->parts[f->albedo], 1) < 0.025);
    }
    int depth = retex_set_find_part(set, "depth");
    assert_true(part_difference(&set->parts[depth], &back->parts[depth], 1) == 0);
    free(data);
    retex_set_close(&back);
    retex_set_close(&set);
}

/* Where a footprint covers nothing, all that tells of it is 0, its correlation too, whose code 0 is none. */
static void test_nothing_is_zero(void **state)
{
    (void)state;
    size_t bytes;
    RetexSet *set = test_set(75, 70, 3);
    test_make_footprints(set);
    unsigned char *data = pack(set, NULL, &bytes, 0);
    RetexSet *back = unpack(data, bytes);
    size_t uncovered = 0, correlated = 0;
    for (int i = 0; i < back->nfootprints; i++) {
        const RetexFootprint *f = &back->footprints[i];
        const RetexImage *uv = &back->parts[f->uv].image, *spread = &back->parts[f->spread].image;
        const size_t channels = (size_t)spread->channels;
        for (size_t j = 0; j < 75 * 70; j++) {
            const float *to = spread->pixels + channels * j;
            const int covered = uv->pixels[3 * j + 2] > 0;
            uncovered += !covered && channels == 3;
            correlated += covered && channels == 3 && to[2] != 0;
            for (size_t c = 0; c < channels; c++)
                assert_true(covered || to[c] == 0);
            for (size_t c = 0; c < 2; c++)
                assert_true(covered || uv->pixels[3 * j + c] == 0);
        }
    }
    assert_true(uncovered > 0 && correlated > 0);
    free(data);
    retex_set_close(&back);
    retex_set_close(&set);
}

/* What only denoising reads is packed without loss only; the caller's set keeps it; what has such a name but is used is
 * always packed. */
static void test_denoise_data_is_dropped(void **state)
{
    (void)state;
    for (int keep_bits = 0; keep_bits < 2; keep_bits++) {
        size_t bytes, data_bytes;
        RetexPackParams params = RETEX_PACK_INIT;
        params.lossless = keep_bits;
        RetexSet *set = test_set(37, 29, 3);
        test_make_footprints(set);
        set->denoised = 1; /* or the noise would be made use of */
        strcpy(set->parts[set->terms[2].radiance].name, "guide_light");
        const int nparts = set->nparts;
        unsigned char *without = pack(set, &params, &bytes, 0);
        test_add_denoise_data(set);
        const int all = set->nparts;
        unsigned char *with = pack(set, &params, &data_bytes, 0);
        assert_int_equal(set->nparts, all);
        assert_true(retex_denoise_has_data(set));
        RetexSet *back = unpack(with, data_bytes);
        if (keep_bits) {
            assert_int_equal(back->nparts, all);
        } else {
            assert_int_equal(bytes, data_bytes);
            assert_memory_equal(with, without, bytes);
            assert_int_equal(back->nparts, nparts);
        }
        assert_int_equal(retex_denoise_has_data(back), keep_bits);
        assert_string_equal(back->parts[back->terms[2].radiance].name, "guide_light");
        free(with);
        free(without);
        retex_set_close(&set);
        retex_set_close(&back);
    }
}

static void test_quality_trades_size(void **state)
{
    (void)state;
    RetexSet *set = test_set(64, 48, 4);
    size_t before = 0;
    for (int quality = 20; quality <= 100; quality += 40) {
        RetexPackParams params = RETEX_PACK_INIT;
        size_t bytes;
        params.quality = quality;
        free(pack(set, &params, &bytes, 0));
        assert_true(bytes > before);
        before = bytes;
    }
    RetexPackParams params = RETEX_PACK_INIT;
    RetexError err = {0};
    params.quality = 101;
    assert_int_equal(retex_pack_write(set, "/tmp/never", &params, NULL, 0, &err), RETEX_EINVAL);
    retex_set_close(&set);
}

static RetexPackPart *plan_of(const RetexSet *set)
{
    const RetexPackQuantizer quantizer = retex_pack_quantizer(56);
    RetexPackPart *packed = calloc((size_t)set->nparts, sizeof *packed);
    RetexError err = {0};
    test_must(retex_pack_plan(packed, set, &quantizer, 1, &err), &err);
    return packed;
}

static void test_radiance_that_does_not_suit_jpeg_keeps_its_bits(void **state)
{
    (void)state;
    const float odd[3] = {-1, INFINITY, NAN};
    for (int i = 0; i < 3; i++) {
        RetexSet *set = test_set(32, 24, 5);
        const int part = set->terms[1].radiance;
        RetexPackPart *before = plan_of(set);
        assert_int_equal(before[part].codec, RETEX_PACK_JPEG);
        set->parts[part].image.pixels[7] = odd[i];
        RetexPackPart *after = plan_of(set);
        assert_int_equal(after[part].codec, RETEX_PACK_PLANES);
        assert_int_equal(after[part].maps[1].kind, RETEX_PACK_MAP_BITS);
        free(before);
        free(after);
        retex_set_close(&set);
    }
}

/* Light with so much noise, that goes on once: how many levels a step of its gain is, in those of the light. */
static double gain_step_with(double noise, int denoised)
{
    RetexSet *set = test_set(32, 24, 5);
    RetexTerm *term = &set->terms[1];
    RetexError err = {0};
    uint32_t seed = 3;
    int number;
    set->denoised = denoised;
    test_must(retex_set_add_part(set, "gain", "RGB", RETEX_FLOAT, 0, 0, &number, &err), &err);
    test_must(retex_term_add_factor(term, retex_factor(RETEX_FACTOR_IMAGE, number), &err), &err);
    RetexImage *light = &set->parts[term->radiance].image, *gain = &set->parts[number].image;
    for (int i = 0; i < 32 * 24 * 3; i++) {
        light->pixels[i] = (float)(0.5 + noise * (test_random(&seed) - 0.5));
        gain->pixels[i] = 0.5f;
    }
    RetexPackPart *packed = plan_of(set);
    const RetexPackPart *of_light = &packed[term->radiance], *of_gain = &packed[number];
    const double ratio = of_gain->jpeg_step / of_gain->curve.levels * of_light->curve.levels / of_light->jpeg_step;
    free(packed);
    retex_set_close(&set);
    return ratio;
}

static void test_gains_are_finer_where_there_is_little_noise(void **state)
{
    (void)state;
    assert_true(gain_step_with(0.016, 0) < 1.7);
    assert_true(gain_step_with(0.256, 0) > 2.4);
    assert_true(gain_step_with(0.016, 1) > 2.4); /* fine noise is the least of what denoising leaves */
    assert_true(gain_step_with(0, 1) < 1.7);
}

static void test_black_parts_cost_nothing(void **state)
{
    (void)state;
    RetexSet *set = test_set(32, 24, 5);
    const int part = set->terms[1].radiance;
    memset(set->parts[part].image.pixels, 0, 32 * 24 * 3 * sizeof(float));
    RetexPackPart *packed = plan_of(set);
    assert_int_equal(packed[part].codec, RETEX_PACK_ZERO);
    free(packed);
    retex_set_close(&set);
}

/* A row is NULL where there is nothing; returns whether it is. */
static int expect_row(RetexPackScratch *scratch, int part, int y, const RetexImage *whole)
{
    const size_t row = (size_t)whole->width * (size_t)whole->channels;
    const float *one, *expected = whole->pixels + row * (size_t)y;
    size_t zeros = 0;
    RetexError err = {0};
    RetexRowSpan span;
    test_must(retex_pack_row(scratch, part, y, &one, &span, &err), &err);
    while (zeros < row && expected[zeros] == 0 && !signbit(expected[zeros]))
        zeros++;
    assert_int_equal(one == NULL, zeros == row);
    if (one)
        assert_memory_equal(one, expected, row * sizeof *one);
    for (int x = 0; one && x < whole->width; x++)
        for (int c = 0; c < whole->channels && (x < span.begin || x >= span.end); c++)
            assert_true(expected[x * whole->channels + c] == 0);
    return !one;
}

/* Rows read one by one, in any order, also of parts and strips, are those of the whole; so are those of an open
 * file. */
static void test_rows_are_those_of_the_whole(void **state)
{
    (void)state;
    size_t bytes;
    RetexSet *set = test_set(60, 150, 9), *open = NULL;
    int black = 0;
    for (int i = 0; i < set->nparts; i++) { /* a strip and some rows more */
        RetexImage *im = &set->parts[i].image;
        const size_t rows = im->height == 150 ? 70 : 0;
        memset(im->pixels, 0, rows * (size_t)im->width * (size_t)im->channels * sizeof *im->pixels);
    }
    for (int i = 0; i < set->nfootprints; i++) { /* strips that differ in coverage and in spread */
        const RetexImage *uv = &set->parts[set->footprints[i].uv].image;
        const RetexImage *spread = &set->parts[set->footprints[i].spread].image;
        for (int k = 0; k < uv->width * uv->height; k++) {
            const float scale = 1.0f / (float)(1 + k / uv->width / 8);
            uv->pixels[3 * k + 2] *= scale;
            for (int c = 0; c < 2; c++)
                spread->pixels[spread->channels * k + c] *= scale;
        }
    }
    unsigned char *data = pack(set, NULL, &bytes, 0);
    RetexSet *whole = unpack(data, bytes);
    RetexError err = {0};
    RetexInput *input = NULL;
    RetexPackScratch *scratch = NULL;
    test_must(retex_input_borrow(&input, data, bytes, "memory", &err), &err);
    test_must(retex_pack_open(&open, &input, &err), &err);
    test_must(retex_pack_scratch_create(&scratch, retex_pack_of(open), &err), &err);
    const int spans[][2] = {{64, 128}, {0, 64}, {63, 65}, {10, 11}, {128, 150}, {0, 150}};
    for (int i = 0; i < open->nparts; i++) {
        const RetexImage *im = &whole->parts[i].image;
        assert_null(open->parts[i].image.pixels);
        assert_int_equal(open->parts[i].image.height, im->height);
        for (size_t k = 0; k < sizeof spans / sizeof *spans; k++)
            for (int y = spans[k][0]; y < spans[k][1] && y < im->height; y++)
                black += expect_row(scratch, i, y, im);
        const float *none;
        RetexRowSpan span;
        assert_int_equal(retex_pack_row(scratch, i, im->height, &none, &span, &err), RETEX_EINVAL);
        assert_int_equal(retex_pack_row(scratch, i, -1, &none, &span, &err), RETEX_EINVAL);
    }
    assert_true(black >= 64);
    uint32_t seed = 3;
    for (int k = 0; k < 3000; k++) {
        const int i = (int)(test_random(&seed) * open->nparts);
        const RetexImage *im = &whole->parts[i].image;
        expect_row(scratch, i, (int)(test_random(&seed) * im->height), im);
    }
    retex_pack_scratch_close(&scratch);
    test_must(retex_set_load(open, 3, &err), &err);
    assert_null(open->parts[0].source);
    for (int i = 0; i < open->nparts; i++)
        assert_true(part_difference(&open->parts[i], &whole->parts[i], 1) == 0);
    retex_set_close(&open);
    retex_set_close(&whole);
    retex_set_close(&set);
    free(data);
}

static void test_threads_do_not_change_bytes(void **state)
{
    (void)state;
    RetexSet *set = test_set(64, 48, 6);
    size_t bytes[3];
    unsigned char *data[3];
    const int threads[3] = {1, 2, 7};
    for (int i = 0; i < 3; i++) {
        RetexPackParams params = RETEX_PACK_INIT;
        data[i] = pack(set, &params, &bytes[i], threads[i]);
        assert_int_equal(bytes[i], bytes[0]);
        assert_memory_equal(data[i], data[0], bytes[0]);
    }
    for (int i = 0; i < 3; i++)
        free(data[i]);
    retex_set_close(&set);
}

/* --- what JPEG costs --- */

static void test_recombination_from_a_pack_is_close(void **state)
{
    (void)state;
    size_t bytes;
    RetexError err = {0};
    RetexSet *set = test_set(200, 150, 8);
    unsigned char *data = pack(set, NULL, &bytes, 0);
    RetexSet *back = unpack(data, bytes);
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexImage pictures[2] = {{0}};
    test_must(test_texture_spec(&spec, "scale=3", "Floor=rgb(0.8,0.4,0.1)", &err), &err);
    RetexSet *sets[2] = {set, back};
    for (int i = 0; i < 2; i++) {
        test_must(retex_sample(sets[i], &spec, 1, 0, &err), &err);
        test_must(retex_combine(&pictures[i], sets[i], NULL, NULL, 0, &err), &err);
    }
    RetexMetrics m;
    test_must(retex_metrics(&m, &pictures[1], &pictures[0], 0, &err), &err);
    print_message("recombination from a pack: %.1f dB\n", m.psnr);
    assert_true(m.psnr > 42);
    for (int i = 0; i < 2; i++)
        retex_image_free(&pictures[i]);
    free(data);
    retex_set_close(&back);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lossless_keeps_every_bit),
        cmocka_unit_test(test_few_values_have_a_palette),
        cmocka_unit_test(test_default_is_close_and_smaller),
        cmocka_unit_test(test_nothing_is_zero),
        cmocka_unit_test(test_denoise_data_is_dropped),
        cmocka_unit_test(test_quality_trades_size),
        cmocka_unit_test(test_radiance_that_does_not_suit_jpeg_keeps_its_bits),
        cmocka_unit_test(test_gains_are_finer_where_there_is_little_noise),
        cmocka_unit_test(test_black_parts_cost_nothing),
        cmocka_unit_test(test_rows_are_those_of_the_whole),
        cmocka_unit_test(test_threads_do_not_change_bytes),
        cmocka_unit_test(test_recombination_from_a_pack_is_close),
    };
    return cmocka_run_group_tests_name("pack", tests, NULL, NULL);
}
