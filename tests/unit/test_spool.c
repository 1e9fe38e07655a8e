/* The spool: bands in any order, and a set that is written from it is the same file as from memory. */
#include "lib_folder.h"
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <retex/parallel.h>

#include "exr/spool_file.h"

#define WIDTH 37
#define HEIGHT 41 /* two bands and a half */
#define BANDS 3

static char folder[64], path[96], other[96];

static int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/retex-spool-XXXXXX");
    if (!mkdtemp(folder))
        return -1;
    snprintf(path, sizeof path, "%s/a.exr", folder);
    snprintf(other, sizeof other, "%s/b.exr", folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    unlink(path);
    unlink(other);
    return rmdir(folder); /* nothing else is left in it */
}

typedef struct PutJob {
    RetexSpool *spool;
    const RetexSet *set;
    const int *numbers;
} PutJob;

static void put_band(void *context, int index, int thread)
{
    const PutJob *job = context;
    const int part = index / BANDS, band = BANDS - 1 - index % BANDS;
    const RetexImage *image = &job->set->parts[part].image;
    RetexError err;
    (void)thread;
    if (job->numbers[part] >= 0)
        test_must(retex_spool_put(job->spool, job->numbers[part], band,
                                  image->pixels + retex_image_index(image, 0, band * RETEX_SPOOL_LINES), &err),
                  &err);
}

/* Move all parts of the set's size, but for the beauty, into a spool of the set. */
static void spool_parts(RetexSet *set)
{
    RetexError err;
    int *numbers = calloc((size_t)set->nparts, sizeof *numbers);
    PutJob job = {NULL, set, numbers};
    test_must(retex_spool_create(&job.spool, set->width, set->height, 0, path, &err), &err);
    for (int i = 0; i < set->nparts; i++) {
        const RetexPart *part = &set->parts[i];
        numbers[i] = -1;
        if (i > 0 && part->image.width == set->width && part->image.height == set->height)
            test_must(retex_spool_add(job.spool, part->name, part->letters, part->type, &numbers[i], &err), &err);
    }
    retex_parallel(4, set->nparts * BANDS, put_band, &job);
    for (int i = 0; i < set->nparts; i++) {
        if (numbers[i] < 0)
            continue;
        free(set->parts[i].image.pixels);
        set->parts[i].image.pixels = NULL;
        set->parts[i].spooled = numbers[i] + 1;
    }
    set->spool = job.spool;
    free(numbers);
}

static void expect_same_file(void)
{
    size_t a, b;
    unsigned char *x = test_read_file(path, &a), *y = test_read_file(other, &b);
    assert_int_equal(a, b);
    assert_memory_equal(x, y, a);
    free(x);
    free(y);
}

/* One part black, one but for the last rows, one but for a sign. */
static void darken(RetexSet *set)
{
    int done = 0;
    for (int i = 1; done < 3; i++) {
        RetexImage *image = &set->parts[i].image;
        if (image->width != WIDTH || image->height != HEIGHT)
            continue;
        memset(image->pixels, 0, retex_image_index(image, 0, done == 1 ? 32 : HEIGHT) * sizeof(float));
        if (done == 2)
            image->pixels[5] = -0.0f;
        done++;
    }
}

static void a_spooled_set_is_written_as_one_in_memory(void **state)
{
    (void)state;
    RetexError err;
    for (int compress = 0; compress < 2; compress++) {
        RetexStoreParams store = RETEX_STORE_INIT;
        RetexSet *set = test_set(WIDTH, HEIGHT, 7);
        test_make_footprints(set);
        darken(set);
        store.compress = compress;
        test_must(retex_set_write(set, NULL, path, &store, &err), &err);
        spool_parts(set);
        test_must(retex_set_write(set, NULL, other, &store, &err), &err);
        expect_same_file();
        retex_set_close(&set);
    }
}

static void a_loaded_set_is_what_a_file_gives(void **state)
{
    (void)state;
    RetexError err;
    RetexSet *set = test_set(WIDTH, HEIGHT, 8), *read = NULL;
    test_must(retex_set_write(set, NULL, path, NULL, &err), &err);
    test_must(retex_set_read(path, &read, NULL, 2, &err), &err);
    spool_parts(set);
    test_must(retex_set_load(set, 2, &err), &err);
    assert_null(set->spool);
    for (int i = 1; i < set->nparts; i++) {
        const RetexImage *a = &set->parts[i].image, *b = &read->parts[i].image;
        assert_int_equal(set->parts[i].spooled, 0);
        assert_int_equal(retex_image_index(a, 0, a->height), retex_image_index(b, 0, b->height));
        if (a->width == WIDTH)
            assert_memory_equal(a->pixels, b->pixels, retex_image_index(a, 0, a->height) * sizeof(float));
    }
    retex_set_close(&set);
    retex_set_close(&read);
}

static void what_is_empty_is_known(void **state)
{
    (void)state;
    RetexError err;
    RetexSpool *spool = NULL;
    static const float values[] = {0, -0.0f, 1e-12f, 1, NAN};
    static const int empty[] = {1, 1, 0, 0, 0};
    test_must(retex_spool_create(&spool, WIDTH, HEIGHT, 0, NULL, &err), &err);
    for (int k = 0; k < 5; k++) {
        char name[] = "part0";
        float pixels[WIDTH * 9] = {0};
        int number;
        name[4] = (char)('0' + k);
        test_must(retex_spool_add(spool, name, "R", RETEX_HALF, &number, &err), &err);
        assert_true(retex_spool_is_empty(spool, number));
        pixels[17] = values[k];
        test_must(retex_spool_put(spool, number, BANDS - 1, pixels, &err), &err);
        assert_int_equal(retex_spool_is_empty(spool, number), empty[k]);
    }
    retex_spool_close(&spool);
}

static void a_spool_needs_no_folder_of_the_output(void **state)
{
    (void)state;
    static const char *const near[] = {NULL, "-", "/dev/null", "/dev/full", "/no/such/folder/x.exr", "x.exr"};
    RetexError err;
    for (int k = 0; k < 6; k++) {
        RetexSpool *spool = NULL;
        test_must(retex_spool_create(&spool, 8, 8, 0, near[k], &err), &err);
        retex_spool_close(&spool);
    }
    RetexSpool *spool = NULL;
    int number;
    test_must(retex_spool_create(&spool, 8, 8, 0, NULL, &err), &err);
    assert_int_equal(retex_spool_add(spool, "a part", "R", RETEX_HALF, &number, &err), RETEX_EINVAL);
    assert_int_equal(retex_spool_add(spool, "part", "", RETEX_HALF, &number, &err), RETEX_EINVAL);
    retex_spool_close(&spool);
}

static void flip(const RetexSpool *spool, uint64_t at)
{
    unsigned char byte;
    assert_int_equal(pread(spool->descriptor, &byte, 1, (off_t)at), 1);
    byte ^= 1 << at % 8;
    assert_int_equal(pwrite(spool->descriptor, &byte, 1, (off_t)at), 1);
}

/* A bit of what waits in the temporary file: no file is made of it, and no memory. */
static void what_is_damaged_is_not_read_back(void **state)
{
    (void)state;
    RetexError err = {0};
    for (int plain = 0; plain < 2; plain++) {
        RetexStoreParams store = RETEX_STORE_INIT;
        RetexSet *set = test_set(WIDTH, HEIGHT, 7);
        store.compress = !plain;
        spool_parts(set);
        for (int image = 0; image < set->spool->nimages; image++) {
            const RetexSpoolChunk *chunk = retex_spool_chunk(set->spool, image, image % BANDS);
            const uint64_t at = chunk->offset + (uint64_t)(image * 37) % (chunk->bytes ? chunk->bytes : 1);
            if (!chunk->bytes)
                continue;
            flip(set->spool, at);
            assert_int_equal(retex_set_write(set, NULL, path, &store, &err), RETEX_EFORMAT);
            assert_non_null(strstr(err.message, "is damaged: a checksum is wrong"));
            assert_int_equal(access(path, F_OK), -1);
            assert_int_equal(retex_set_load(set, 1, &err), RETEX_EFORMAT);
            flip(set->spool, at);
        }
        test_must(retex_set_write(set, NULL, path, &store, &err), &err);
        unlink(path);
        retex_set_close(&set);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_spooled_set_is_written_as_one_in_memory, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(a_loaded_set_is_what_a_file_gives, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(what_is_damaged_is_not_read_back, make_folder, remove_folder),
        cmocka_unit_test(what_is_empty_is_known),
        cmocka_unit_test(a_spool_needs_no_folder_of_the_output),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
