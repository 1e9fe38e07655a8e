/* Denoising a set that stays in its file: the result is the same as in memory, and no temporary file remains. */
#include "lib_denoise.h"
#include "lib_folder.h"
#include "set/source.h"
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One pixel of 200 has up to a hundred times its light, all in the first half of the samples. */
static void add_fireflies(RetexSet *set)
{
    uint32_t seed = 8;
    RetexSignals signals = denoise_signals(set);
    for (int s = 0; s < signals.count; s++)
        for (size_t i = 0; i < (size_t)set->width * (size_t)set->height; i++) {
            const float times = test_random(&seed) < 0.005 ? (float)(100 * test_random(&seed)) : 0;
            for (int m = 0; m < signals.of[s].nmembers; m++)
                for (size_t c = 3 * i; c < 3 * i + 3; c++) {
                    const RetexSignalMember *member = &signals.of[s].members[m];
                    float *to = &set->parts[member->part].image.pixels[c];
                    set->parts[signals.of[s].noise].image.pixels[c] += member->weight * *to * times;
                    *to *= 1 + times;
                }
        }
    retex_signals_close(&signals);
}

static void write_noisy(const char *path, const char *layout, int width, int height)
{
    RetexSet *set = denoise_set(layout, width, height);
    RetexError err = {0};
    denoise_add_noise(set, 7);
    add_fireflies(set);
    if (set->ntargets) /* a part of another size */
        denoise_add_original(set, (const double[2]){0, 0}, (const double[2]){1, 1});
    if (strstr(path, ".retex")) {
        RetexPackParams params = RETEX_PACK_INIT;
        params.lossless = 1;
        test_must(retex_pack_write(set, path, &params, NULL, 0, &err), &err);
    } else {
        test_must(retex_set_write(set, path, NULL, 0, &err), &err);
    }
    retex_set_close(&set);
}

/* Denoised from `from` to `to`, whole in memory or not. */
static void denoise_file(const char *from, const char *to, int in_memory, int nthreads)
{
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    RetexError err = {0};
    RetexSet *set = NULL;
    params.near = to;
    test_must(in_memory ? retex_set_read(from, &set, nthreads, &err) : retex_set_open(from, &set, nthreads, &err),
              &err);
    test_must(retex_denoise(set, &params, NULL, nthreads, &err), &err);
    assert_int_equal(!in_memory, retex_part_store(&set->parts[0]) != NULL);
    assert_int_equal(set->denoised, 1);
    test_must(retex_set_write(set, to, NULL, 0, &err), &err);
    retex_set_close(&set);
}

static void assert_same_file(const char *a, const char *b)
{
    char command[512];
    snprintf(command, sizeof command, "cmp '%s' '%s'", a, b);
    assert_int_equal(system(command), 0);
}

/* Strips of 112 rows: three and one that is not full, one and a row, one, and fewer rows than decide on a pixel. */
static void test_same_as_in_memory(void **state)
{
    (void)state;
    static const int sizes[][2] = {{70, 400}, {33, 113}, {150, 112}, {20, 17}, {1, 1}};
    static const char *const layouts[] = {"plain", "paper", "footprints"};
    for (int k = 0; k < 3; k++)
        for (int n = 0; n < 5; n++) {
            write_noisy(test_in_folder("noisy.exr"), layouts[k], sizes[n][0], sizes[n][1]);
            denoise_file(test_in_folder("noisy.exr"), test_in_folder("memory.exr"), 1, 1);
            denoise_file(test_in_folder("noisy.exr"), test_in_folder("strips.exr"), 0, 1 + n);
            assert_same_file(test_in_folder("memory.exr"), test_in_folder("strips.exr"));
        }
    assert_int_equal(test_files_left(), 3);
}

static void test_from_a_pack(void **state)
{
    (void)state;
    write_noisy(test_in_folder("noisy.retex"), "footprints", 50, 150);
    denoise_file(test_in_folder("noisy.retex"), test_in_folder("memory.exr"), 1, 2);
    denoise_file(test_in_folder("noisy.retex"), test_in_folder("strips.exr"), 0, 2);
    assert_same_file(test_in_folder("memory.exr"), test_in_folder("strips.exr"));
}

/* A set that was denoised in strips is combined and packed, without being written before, as one that was denoised in
 * memory. */
static void test_what_comes_out_is_a_set(void **state)
{
    (void)state;
    RetexPackParams params = RETEX_PACK_INIT;
    RetexSet *sets[2] = {NULL, NULL};
    RetexImage pictures[2] = {{0}, {0}};
    RetexError err = {0};
    write_noisy(test_in_folder("noisy.exr"), "footprints", 50, 150);
    test_must(retex_set_read(test_in_folder("noisy.exr"), &sets[0], 2, &err), &err);
    test_must(retex_set_open(test_in_folder("noisy.exr"), &sets[1], 2, &err), &err);
    for (int k = 0; k < 2; k++) {
        char name[32];
        snprintf(name, sizeof name, "%d.retex", k);
        test_must(retex_denoise(sets[k], NULL, NULL, 2, &err), &err);
        assert_int_equal(retex_part_store(&sets[k]->parts[0]) != NULL,
                         k == 1); /* what was denoised in strips is in a band store */
        test_must(retex_combine(&pictures[k], sets[k], NULL, NULL, 2, &err), &err);
        test_must(retex_pack_write(sets[k], test_in_folder(name), &params, NULL, 0, &err), &err);
    }
    assert_memory_equal(pictures[0].pixels, pictures[1].pixels, sizeof(float) * 3 * 50 * 150);
    assert_same_file(test_in_folder("0.retex"), test_in_folder("1.retex"));
    for (int k = 0; k < 2; k++) {
        retex_image_free(&pictures[k]);
        retex_set_close(&sets[k]);
    }
}

/* Of a region only: the set is brought into memory, for pixels around it stay what they are. */
static void test_a_region_of_an_open_set(void **state)
{
    (void)state;
    static const RetexRoi roi = {10, 20, 40, 130, 0, 3};
    RetexSet *sets[2] = {NULL, NULL};
    RetexError err = {0};
    write_noisy(test_in_folder("noisy.exr"), "paper", 50, 150);
    test_must(retex_set_read(test_in_folder("noisy.exr"), &sets[0], 2, &err), &err);
    test_must(retex_set_open(test_in_folder("noisy.exr"), &sets[1], 2, &err), &err);
    for (int k = 0; k < 2; k++)
        test_must(retex_denoise(sets[k], NULL, &roi, 2, &err), &err);
    denoise_expect_same(sets[0], sets[1]);
    for (int k = 0; k < 2; k++)
        retex_set_close(&sets[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_same_as_in_memory, test_make_folder, test_remove_folder),
        cmocka_unit_test_setup_teardown(test_from_a_pack, test_make_folder, test_remove_folder),
        cmocka_unit_test_setup_teardown(test_what_comes_out_is_a_set, test_make_folder, test_remove_folder),
        cmocka_unit_test_setup_teardown(test_a_region_of_an_open_set, test_make_folder, test_remove_folder),
    };
    return cmocka_run_group_tests_name("denoise strips", tests, NULL, NULL);
}
