/* Part 0 of lossless packs, stored as its difference from the picture that the set's terms give: it is exact, small,
 * and never used where its conditions do not hold. */
#include "lib_test.h"
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "lib_folder.h"
#include "pack/open.h"
#include "pack/strips.h"
#include "pack/format.h"

static void write_lossless(const RetexSet *set, int nthreads, size_t *bytes)
{
    RetexPackParams params = RETEX_PACK_INIT;
    RetexError err = {0};
    params.lossless = 1;
    test_must(retex_pack_write(set, test_own_file, &params, bytes, nthreads, &err), &err);
}

static RetexSet *open_pack(void)
{
    RetexSet *set = NULL;
    RetexError err = {0};
    test_must(retex_set_open(test_own_file, &set, NULL, 2, &err), &err);
    return set;
}

static size_t part_size(const RetexPart *part)
{
    return sizeof(float) * (size_t)part->image.width * (size_t)part->image.height * (size_t)part->image.channels;
}

static void assert_same_pixels(const RetexSet *a, const RetexSet *b)
{
    assert_int_equal(a->nparts, b->nparts);
    for (int i = 0; i < a->nparts; i++)
        assert_memory_equal(a->parts[i].image.pixels, b->parts[i].image.pixels, part_size(&a->parts[i]));
}

static void round_picture(RetexSet *set)
{
    RetexPart *part = &set->parts[0];
    const size_t width = 3 * (size_t)part->image.width;
    uint16_t halves[3 * 64];
    for (int y = 0; y < part->image.height && part->type == RETEX_HALF; y++) {
        retex_image_stored_row(&part->image, part->type, y, halves);
        retex_half_to_float(part->image.pixels + width * (size_t)y, halves, width);
    }
}

/* A set whose picture is what its terms give, as denoising leaves it; scattered: with the noise that rendering leaves
 * between both. */
static RetexSet *make_set(int width, int height, int footprints, RetexPixelType type, double scattered)
{
    RetexSet *set = test_set(width, height, 11);
    RetexError err = {0};
    uint32_t seed = 4;
    if (footprints)
        test_make_footprints(set);
    set->parts[0].type = type;
    test_must(retex_combine(&set->parts[0].image, set, NULL, NULL, NULL, 1, &err), &err);
    for (size_t i = 0; i < part_size(&set->parts[0]) / sizeof(float); i++)
        set->parts[0].image.pixels[i] *= (float)(1 + scattered * (test_random(&seed) - 0.5));
    round_picture(set);
    return set;
}

/* Pack it, tell how part 0 is stored and in how many bytes, and see that all comes back. */
static uint64_t check_round_trip(const RetexSet *set, const char *codec)
{
    RetexError err = {0};
    write_lossless(set, 2, NULL);
    RetexSet *back = open_pack();
    const uint64_t bytes = retex_pack_part_bytes(retex_pack_of(back), 0);
    assert_string_equal(retex_pack_part_codec(retex_pack_of(back), 0), codec);
    test_must(retex_set_load(back, 2, &err), &err);
    assert_same_pixels(back, set);
    retex_set_close(&back);
    test_must(retex_set_check(test_own_file, 1, &err), &err);
    return bytes;
}

static void test_recombined_pictures_take_nothing(void **state)
{
    (void)state;
    for (int footprints = 0; footprints < 2; footprints++)
        for (int type = 0; type < 2; type++) {
            RetexSet *set = make_set(61, 131, footprints, type ? RETEX_FLOAT : RETEX_HALF, 0);
            assert_int_equal(check_round_trip(set, "combined"), 0);
            retex_set_close(&set);
        }
}

static void test_denoised_pictures_take_nothing(void **state)
{
    (void)state;
    RetexSet *set = make_set(64, 48, 1, RETEX_FLOAT, 0.3);
    RetexError err = {0};
    test_add_denoise_data(set);
    test_must(retex_denoise(set, NULL, NULL, 2, &err), &err);
    assert_int_equal(check_round_trip(set, "combined"), 0);
    retex_set_close(&set);
}

/* Also where it comes close only, and its zeros have signs. */
static void test_rendered_pictures_take_less(void **state)
{
    (void)state;
    for (int type = 0; type < 2; type++) {
        RetexSet *set = make_set(61, 131, 1, type ? RETEX_FLOAT : RETEX_HALF, 0.01);
        set->parts[0].image.pixels[7] = -0.0f;
        set->parts[0].image.pixels[8] = 65504;
        set->parts[0].image.pixels[9] = -65504;
        const uint64_t less = check_round_trip(set, "combined");
        strcpy(set->parts[set->terms[0].radiance].name, "other");
        set->nterms = 0, set->nmixtures = 0; /* nothing to compare it with */
        strcpy(set->layout, "plain");
        const uint64_t more = check_round_trip(set, "model");
        print_message("%s: %d bytes instead of %d\n", type ? "float" : "half", (int)less, (int)more);
        assert_true(less > 0 && 10 * less < 9 * more);
        retex_set_close(&set);
    }
}

/* A picture that has nothing to do with its terms, and halves that are not rounded yet, so that readers would sum up
 * others. */
static void test_other_pictures_stay_alone(void **state)
{
    (void)state;
    RetexSet *set = test_set(32, 70, 3);
    check_round_trip(set, "model");
    retex_set_close(&set);

    set = make_set(32, 70, 0, RETEX_FLOAT, 0);
    float *light = &set->parts[set->terms[0].radiance].image.pixels[30];
    *light = nextafterf(*light, 2);
    write_lossless(set, 1, NULL);
    RetexSet *back = open_pack();
    assert_string_equal(retex_pack_part_codec(retex_pack_of(back), 0), "model");
    retex_set_close(&back);
    retex_set_close(&set);
}

/* Rows of the picture alone, in any order, with parts in memory and without. */
static void test_rows_are_those_of_the_whole(void **state)
{
    (void)state;
    RetexSet *set = make_set(40, 150, 1, RETEX_FLOAT, 0.01);
    RetexError err = {0};
    RetexPackScratch *scratch = NULL;
    write_lossless(set, 1, NULL);
    RetexSet *back = open_pack();
    const int rows[] = {149, 3, 70, 71, 0, 128};
    for (int kept = 0; kept < 2; kept++) {
        test_must(retex_pack_scratch_create(&scratch, retex_pack_of(back), &err), &err);
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
            const float *row;
            RetexRowSpan span;
            test_must(retex_pack_row(scratch, 0, rows[i], &row, &span, &err), &err);
            assert_memory_equal(row, set->parts[0].image.pixels + 3 * 40 * rows[i], 3 * 40 * sizeof *row);
        }
        retex_pack_scratch_close(&scratch);
        test_must(retex_set_preload(back, NULL, NULL, UINT64_MAX, 2, &err), &err);
        assert_null(back->parts[0].image.pixels);
    }
    retex_set_close(&back);
    retex_set_close(&set);
}

static void test_threads_do_not_change_bytes(void **state)
{
    (void)state;
    RetexSet *set = make_set(40, 150, 1, RETEX_FLOAT, 0.01);
    const int threads[3] = {1, 2, 7};
    unsigned char *data[3];
    size_t bytes[3];
    for (int i = 0; i < 3; i++) {
        write_lossless(set, threads[i], &bytes[i]);
        FILE *file = fopen(test_own_file, "rb");
        data[i] = malloc(bytes[i]);
        assert_int_equal(fread(data[i], 1, bytes[i], file), bytes[i]);
        fclose(file);
        assert_int_equal(bytes[i], bytes[0]);
        assert_memory_equal(data[i], data[0], bytes[0]);
    }
    for (int i = 0; i < 3; i++)
        free(data[i]);
    retex_set_close(&set);
}

/* The picture's checksum is compared with what the terms give, whatever became of these. */
static void test_wrong_pictures_are_seen(void **state)
{
    (void)state;
    RetexSet *set = make_set(40, 70, 1, RETEX_FLOAT, 0);
    write_lossless(set, 1, NULL);
    for (int i = 0; i < 2; i++) {
        RetexError err = {0};
        RetexSet *back = open_pack();
        back->nterms -= i;
        assert_int_equal(retex_pack_verify(back, 1, &err), i ? RETEX_EFORMAT : RETEX_OK);
        assert_int_equal(strstr(err.message, "beauty") != NULL, i);
        retex_set_close(&back);
    }
    retex_set_close(&set);
}

/* Manifests by which no picture could be made, or without end. */
static void test_unsound_descriptions_are_refused(void **state)
{
    (void)state;
    const char *const wrongs[] = {"nothing", "another part", "itself", "no terms", "smaller"};
    for (size_t i = 0; i < sizeof wrongs / sizeof *wrongs; i++) {
        RetexSet *set = make_set(40, 70, 1, RETEX_FLOAT, 0);
        RetexPackPart *packed = calloc((size_t)set->nparts, sizeof *packed),
                      *read = calloc((size_t)set->nparts, sizeof *read);
        RetexError err = {0};
        char *manifest = NULL;
        packed[i == 1 ? set->terms[1].radiance : 0].codec = RETEX_PACK_COMBINED;
        if (i == 2)
            set->footprints[set->nfootprints - 1].albedo = 0;
        if (i == 3)
            set->nterms = 0;
        if (i == 4)
            set->parts[set->footprints[0].albedo].image.width = 20;
        test_must(retex_set_manifest(set, NULL, &manifest, &err), &err);
        char *text = retex_pack_describe(manifest, set, packed, NULL, NULL);
        assert_int_equal(retex_pack_parse(read, set, text, &err), i ? RETEX_EFORMAT : RETEX_OK);
        if (i)
            assert_non_null(strstr(err.message, "not sound"));
        for (int k = 0; k < set->nparts; k++)
            retex_pack_part_free(&read[k]);
        free(text);
        free(manifest);
        free(packed);
        free(read);
        retex_set_close(&set);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_recombined_pictures_take_nothing),
        cmocka_unit_test(test_denoised_pictures_take_nothing),
        cmocka_unit_test(test_rendered_pictures_take_less),
        cmocka_unit_test(test_other_pictures_stay_alone),
        cmocka_unit_test(test_rows_are_those_of_the_whole),
        cmocka_unit_test(test_threads_do_not_change_bytes),
        cmocka_unit_test(test_wrong_pictures_are_seen),
        cmocka_unit_test(test_unsound_descriptions_are_refused),
    };
    return cmocka_run_group_tests_name("pack_combine", tests, test_make_folder, test_remove_folder);
}
