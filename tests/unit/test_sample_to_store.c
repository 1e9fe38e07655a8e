/* Textures laid on sets that stay in their files: little is kept in memory, and files are the same as from memory. */
#include "lib_folder.h"
#include "lib_test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define WIDTH 37
#define HEIGHT 141 /* jobs of 64 rows, bands of 16, and some left over */

/* One footprint, the last, is half as large as the picture. */
static RetexSet *make_set(void)
{
    static const char *const names[] = {"small_uv", "small_spread", "small_albedo"};
    static const char *const letters[] = {"RGA", "RG", "RGB"};
    RetexSet *set = test_set(WIDTH, HEIGHT, 3);
    RetexFootprint f = set->footprints[set->nfootprints - 1];
    RetexError err = {0};
    int *const parts[] = {&f.uv, &f.spread, &f.albedo};
    uint32_t seed = 7;
    for (int k = 0; k < 3; k++) {
        test_must(retex_set_add_part(set, names[k], letters[k], RETEX_FLOAT, (WIDTH + 1) / 2, (HEIGHT + 1) / 2,
                                     parts[k], &err),
                  &err);
        RetexImage *im = &set->parts[*parts[k]].image;
        for (size_t i = 0; i < retex_image_index(im, 0, im->height); i++)
            im->pixels[i] = (float)test_random(&seed);
    }
    f.hit++;
    test_must(retex_set_add_footprint(set, &f, NULL, &err), &err);
    const RetexTerm term = test_term(set, set->terms[0].radiance, 1, (int[]){set->nfootprints - 1});
    test_must(retex_set_add_term(set, &term, NULL, &err), &err);
    return set;
}

static RetexTextureSpec make_spec(const char *target)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexImage im = {0};
    RetexError err = {0};
    strcpy(spec.target, target);
    snprintf(spec.image, sizeof spec.image, "%s", test_in_folder("glass.exr"));
    test_random_image(&im, 16, 16, 4, 9, 0, 1); /* transparent: original albedo is wanted */
    test_must(retex_image_write(&im, spec.image, NULL, 1, &err), &err);
    retex_image_free(&im);
    return spec;
}

static void expect_same_file(const char *a, const char *b)
{
    FILE *files[2] = {fopen(a, "rb"), fopen(b, "rb")};
    int c;
    assert_true(files[0] && files[1]);
    do {
        c = getc(files[0]);
        assert_int_equal(c, getc(files[1]));
    } while (c != EOF);
    fclose(files[0]);
    fclose(files[1]);
}

static int is_large(const RetexImage *image)
{
    return image->width == WIDTH;
}

/* Whether no image of the picture's size is there. */
static int is_out_of_memory(const RetexSet *set)
{
    int count = 0;
    for (int i = 0; i < set->nparts; i++)
        count += is_large(&set->parts[i].image) && set->parts[i].image.pixels;
    return !count;
}

static void write_to(RetexSet *set, const char *path, int compress)
{
    RetexStoreParams store = RETEX_STORE_INIT;
    RetexError err = {0};
    store.compress = compress;
    test_must(retex_set_write(set, path, &store, 0, &err), &err);
}

static void write_samples_to(const RetexSet *set, const char *path, int compress)
{
    RetexStoreParams store = RETEX_STORE_INIT;
    RetexError err = {0};
    store.compress = compress;
    test_must(retex_set_write_samples(set, path, &store, 0, &err), &err);
}

/* Files of samples and of streams, whichever way the band store keeps its bands. */
static void files_are_those_from_memory(void **state)
{
    (void)state;
    RetexSet *set = make_set(), *open;
    RetexTextureSpec spec = make_spec("Floor");
    RetexError err = {0};
    write_to(set, test_in_folder("set.exr"), 1);
    retex_set_close(&set);
    test_must(retex_set_read(test_in_folder("set.exr"), &set, 2, &err), &err);
    test_must(retex_sample(set, &spec, 1, 2, &err), &err);
    for (int round = 0; round < 4; round++) {
        const int compress = round & 1, plain = round >> 1;
        test_must(retex_set_open(test_in_folder("set.exr"), &open, 2, &err), &err);
        test_must(test_sample_to_store(open, &spec, 1, plain ? "-" : test_own_file, 1 + plain, &err), &err);
        assert_true(is_out_of_memory(open));
        write_samples_to(set, test_in_folder("a.exr"), compress);
        write_samples_to(open, test_in_folder("b.exr"), compress);
        if (!plain || !compress) /* a band store that is not compressed is not for a file that is */
            expect_same_file(test_in_folder("a.exr"), test_in_folder("b.exr"));
        write_to(set, test_in_folder("a.exr"), compress);
        write_to(open, test_in_folder("b.exr"), compress);
        if (!plain || !compress)
            expect_same_file(test_in_folder("a.exr"), test_in_folder("b.exr"));
        assert_true(is_out_of_memory(open));
        test_must(retex_set_load(open, 2, &err), &err);
        for (int f = 0; f < set->nfootprints; f++) {
            const RetexImage *a = test_laid(set, f), *b = test_laid(open, f);
            assert_int_equal(a != NULL, b != NULL);
            if (a)
                assert_memory_equal(a->pixels, b->pixels, sizeof(float) * retex_image_index(a, 0, a->height));
        }
        retex_set_close(&open);
    }
    retex_set_close(&set);
}

/* A stream stays in its file: pictures, and streams with one more target, are those of one in memory. */
static void streams_stay_in_their_files(void **state)
{
    (void)state;
    RetexSet *set = make_set(), *open;
    RetexTextureSpec floor = make_spec("Floor"), wall = make_spec("Wall");
    RetexImage picture = {0}, other = {0};
    RetexError err = {0};
    test_must(retex_sample(set, &floor, 1, 2, &err), &err);
    write_to(set, test_in_folder("stream.exr"), 0);
    retex_set_close(&set);

    test_must(retex_set_read(test_in_folder("stream.exr"), &set, 2, &err), &err);
    test_must(retex_set_open(test_in_folder("stream.exr"), &open, 2, &err), &err);
    assert_true(retex_set_has_laid(open) && is_out_of_memory(open));
    test_must(retex_combine(&picture, set, NULL, NULL, 2, &err), &err);
    test_must(retex_combine(&other, open, NULL, NULL, 2, &err), &err);
    assert_memory_equal(picture.pixels, other.pixels, sizeof(float) * 3 * WIDTH * HEIGHT);

    test_must(retex_sample(set, &wall, 1, 2, &err), &err);
    write_to(set, test_in_folder("a.exr"), 0);
    for (int again = 0; again < 2; again++) { /* a second texture takes the place of the first, and its band store */
        test_must(test_sample_to_store(open, &wall, 1, "-", 2, &err), &err);
        assert_true(is_out_of_memory(open));
        write_to(open, test_in_folder("b.exr"), 0);
        expect_same_file(test_in_folder("a.exr"), test_in_folder("b.exr"));
    }
    test_must(retex_set_load(open, 2, &err), &err);
    for (int i = 0; i < open->nparts; i++)
        assert_null(open->parts[i].source);
    retex_image_free(&picture);
    retex_image_free(&other);
    retex_set_close(&open);
    retex_set_close(&set);
}

/* Samples without the set. */
static void samples_alone_stay_in_their_file(void **state)
{
    (void)state;
    RetexSet *set = make_set(), *stored;
    RetexTextureSpec spec = make_spec("Floor");
    RetexImage picture = {0}, other = {0};
    RetexError err = {0};
    test_must(retex_sample(set, &spec, 1, 2, &err), &err);
    write_samples_to(set, test_in_folder("a.exr"), 1);
    test_must(retex_combine(&picture, set, NULL, NULL, 2, &err), &err);
    retex_set_lift(set, -1);
    test_must(retex_set_open_any(test_in_folder("a.exr"), &stored, 2, &err), &err);
    assert_true(is_out_of_memory(stored));
    assert_int_equal(retex_combine(&other, stored, NULL, NULL, 2, &err), RETEX_EINVAL); /* they are no set */
    test_must(retex_set_lay(set, stored, &err), &err);
    retex_set_close(&stored); /* the file is held by the set too */
    test_must(retex_combine(&other, set, NULL, NULL, 2, &err), &err);
    assert_memory_equal(picture.pixels, other.pixels, sizeof(float) * 3 * WIDTH * HEIGHT);
    write_samples_to(set, test_in_folder("b.exr"), 1);
    expect_same_file(test_in_folder("a.exr"), test_in_folder("b.exr"));
    retex_image_free(&picture);
    retex_image_free(&other);
    retex_set_close(&set);
}

/* Of two textures for one target the one that came later counts, and samples of other targets stay. */
static void later_textures_win(void **state)
{
    (void)state;
    RetexSet *set = make_set(), *both = make_set();
    RetexTextureSpec specs[3] = {make_spec("Floor"), make_spec("Wall"), make_spec("Wall")};
    RetexImage merged = {0}, direct = {0};
    RetexError err = {0};
    specs[2].constant = 1, specs[2].color[1] = 0.75f;
    test_must(retex_sample(set, specs, 2, 2, &err), &err);
    test_must(retex_sample(set, &specs[2], 1, 2, &err), &err);
    specs[1] = specs[2];
    for (int again = 0; again < 2; again++) /* all at once, where each has one already */
        test_must(retex_sample(both, specs, 2, 2, &err), &err);
    assert_int_equal(set->nparts, both->nparts);
    test_must(retex_combine(&merged, set, NULL, NULL, 2, &err), &err);
    test_must(retex_combine(&direct, both, NULL, NULL, 2, &err), &err);
    assert_memory_equal(merged.pixels, direct.pixels, sizeof(float) * 3 * WIDTH * HEIGHT);
    for (int t = 0; t < set->ntargets; t++)
        assert_string_equal(set->targets[t].texture, both->targets[t].texture);
    retex_image_free(&merged);
    retex_image_free(&direct);
    retex_set_close(&both);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_those_from_memory),
        cmocka_unit_test(later_textures_win),
        cmocka_unit_test(streams_stay_in_their_files),
        cmocka_unit_test(samples_alone_stay_in_their_file),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
