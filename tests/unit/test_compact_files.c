/* Compact sets are the same for any number of threads and wherever the set is stored, when written and read. */
#include "lib_compact.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "set/parts.h"

static void expect_equal(const RetexSet *one, const RetexSet *other)
{
    assert_int_equal(one->nparts, other->nparts);
    for (int i = 0; i < one->nparts; i++) {
        const RetexImage *a = &one->parts[i].image, *b = &other->parts[i].image;
        assert_string_equal(one->parts[i].name, other->parts[i].name);
        assert_int_equal(a->width, b->width);
        assert_int_equal(a->height, b->height);
        assert_memory_equal(a->pixels, b->pixels,
                            sizeof(float) * (size_t)a->width * (size_t)a->height * (size_t)a->channels);
    }
}

static void threads_do_not_matter(void **state)
{
    RetexSet *set = whole_set(2, 3), *one, *many;
    RetexError err = {0};
    (void)state;
    test_must(retex_set_compact(&one, set, NULL, 1, &err), &err);
    test_must(retex_set_compact(&many, set, NULL, 7, &err), &err);
    expect_equal(one, many);
    retex_set_close(&set);
    retex_set_close(&one);
    retex_set_close(&many);
}

/* So many of it, one below the other, with more light in each. */
static void stack(RetexSet *set, int copies)
{
    for (int i = 0; i < set->nparts; i++) {
        RetexImage *image = &set->parts[i].image, tall = {0};
        const size_t count = retex_image_index(image, 0, image->height);
        RetexError err = {0};
        int radiance = 0;
        if (image->width != WIDE || image->height != HIGH)
            continue;
        for (int k = 0; k < set->nterms; k++)
            radiance |= set->terms[k].radiance == i;
        test_must(retex_image_alloc(&tall, WIDE, copies * HIGH, image->channels, &err), &err);
        for (size_t k = 0; k < (size_t)copies * count; k++)
            tall.pixels[k] = image->pixels[k % count] * (radiance ? 1 + 0.01f * (float)(k / count) : 1);
        retex_image_free(image);
        *image = tall;
    }
    set->height = copies * HIGH;
}

/* In bands of rows, and trials on tiles, for it is large. */
static void file_and_memory_are_the_same(void **state)
{
    RetexSet *set = whole_set(1, 2), *memory, *file, *one, *other;
    RetexError err = {0};
    char path[] = "/tmp/test_compact_XXXXXX";
    (void)state;
    const int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    close(descriptor);
    stack(set, 86);
    test_must(retex_set_write(set, path, NULL, 0, &err), &err);
    test_must(retex_set_read(path, &memory, 2, &err), &err);
    test_must(retex_set_open(path, &file, 2, &err), &err);
    remove(path);
    assert_null(file->parts[1].image.pixels);
    test_must(retex_set_compact(&one, memory, NULL, 2, &err), &err);
    test_must(retex_set_compact(&other, file, NULL, 2, &err), &err);
    expect_equal(one, other);
    assert_null(file->parts[1].image.pixels);
    retex_set_close(&set);
    retex_set_close(&memory);
    retex_set_close(&file);
    retex_set_close(&one);
    retex_set_close(&other);
}

static void expect_copy(const RetexSet *set, const RetexSet *copy)
{
    int parts = 0;
    for (int i = 0; i < set->nparts; i++) {
        if (retex_part_is_denoise_data(set, i))
            continue;
        const RetexImage *a = &set->parts[i].image, *b = &copy->parts[parts].image;
        assert_string_equal(set->parts[i].name, copy->parts[parts++].name);
        assert_memory_equal(a->pixels, b->pixels,
                            sizeof(float) * (size_t)a->width * (size_t)a->height * (size_t)a->channels);
    }
    assert_int_equal(copy->nparts, parts);
    assert_int_equal(copy->nterms, set->nterms);
    assert_int_equal(copy->nfootprints, set->nfootprints);
    assert_int_equal(copy->nmixtures, set->nmixtures);
}

static void others_come_out_as_they_are(void **state)
{
    RetexSet *paper = test_set(24, 16, 3), *set = whole_set(1, 2), *compact = compacted(set, 4, 8, 2), *again, *copy;
    RetexError err = {0};
    (void)state;
    test_add_denoise_data(paper);
    test_must(retex_set_compact(&copy, paper, NULL, 1, &err), &err);
    assert_true(copy->nparts < paper->nparts);
    expect_copy(paper, copy);
    test_must(retex_set_compact(&again, compact, NULL, 1, &err), &err);
    expect_copy(compact, again);
    retex_set_close(&paper);
    retex_set_close(&copy);
    retex_set_close(&set);
    retex_set_close(&compact);
    retex_set_close(&again);
}

static void survives_writing(void **state)
{
    RetexSet *set = whole_set(2, 3), *compact = compacted(set, 4, 8, 2), *read = NULL;
    RetexError err = {0};
    char path[] = "/tmp/test_compact_XXXXXX";
    (void)state;
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    test_must(retex_set_write(compact, path, NULL, 0, &err), &err);
    test_must(retex_set_read(path, &read, 1, &err), &err);
    expect_same_picture(compact, read, bright);
    remove(path);
    retex_set_close(&set);
    retex_set_close(&compact);
    retex_set_close(&read);
}

static void wrong_params_are_refused(void **state)
{
    static const RetexCompactParams wrong[] = {{.psnr = 55, .broad = 3, .noise = 1},
                                               {.psnr = 55, .interreflection = 16, .noise = 1},
                                               {.psnr = 55, .gain = -1, .noise = 1},
                                               {.psnr = 10, .noise = 1},
                                               {.psnr = NAN, .noise = 1},
                                               {.psnr = 55, .noise = 1.5}};
    RetexSet *set = whole_set(1, 1), *compact;
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        RetexError err = {0};
        assert_int_equal(retex_set_compact(&compact, set, &wrong[i], 1, &err), RETEX_EINVAL);
        assert_null(compact);
    }
    retex_set_close(&set);
}

/* Two clusters have one albedo: that one of them is empty does not take it from the other. */
static void pruning_keeps_what_is_shared(void **state)
{
    RetexSet *set = whole_set(1, 2), *compact = compacted(set, 4, 8, 2);
    char empty[256] = {0};
    (void)state;
    const int count = compact->nfootprints, parts = compact->nparts;
    empty[compact->footprints[1].uv] = 1;
    retex_set_prune(compact, empty);
    assert_int_equal(compact->nfootprints, count - 1);
    assert_true(compact->nparts < parts);
    const int albedo = compact->footprints[0].albedo;
    assert_string_equal(compact->parts[albedo].name, "albedo_T0_sharp");
    assert_true(retex_set_find_part(compact, "dep_T0_sharp") > 0);
    RetexImage shown = picture(compact, bright);
    retex_image_free(&shown);

    /* A gain that is empty takes its term away, but not the radiance of the others. */
    memset(empty, 0, sizeof empty);
    const int terms = compact->nterms, gain = retex_term_image(&compact->terms[compact->nterms - 1]);
    const int radiance = compact->terms[compact->nterms - 1].radiance;
    char name[RETEX_NAME_MAX], kept[RETEX_NAME_MAX];
    strcpy(name, compact->parts[gain].name);
    strcpy(kept, compact->parts[radiance].name);
    empty[gain] = 1;
    retex_set_prune(compact, empty);
    assert_int_equal(compact->nterms, terms - 1);
    assert_int_equal(retex_set_find_part(compact, name), -1);
    assert_true(retex_set_find_part(compact, kept) > 0);
    retex_set_close(&set);
    retex_set_close(&compact);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_do_not_matter),       cmocka_unit_test(file_and_memory_are_the_same),
        cmocka_unit_test(others_come_out_as_they_are), cmocka_unit_test(survives_writing),
        cmocka_unit_test(wrong_params_are_refused),    cmocka_unit_test(pruning_keeps_what_is_shared),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
