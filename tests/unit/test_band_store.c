/* The band store: bands arrive in any order, and a set that is written from the store gives the same file as one from
 * memory. */
#include "lib_folder.h"
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <retex/parallel.h>

#include "exr/band_store_file.h"

#define WIDTH 37
#define HEIGHT 41 /* two bands and a half */
#define BANDS 3

static char folder[64], path[96], other[96];

static int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/retex-band-store-XXXXXX");
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
    RetexBandStore *store;
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
        test_must(retex_band_store_put(job->store, job->numbers[part], band,
                                       image->pixels + retex_image_index(image, 0, band * RETEX_BAND_ROWS), &err),
                  &err);
}

/* Move all parts of the set's size, but for the beauty, into a band store of the set. */
static RetexBandStore *store_parts(RetexSet *set)
{
    RetexError err;
    int *numbers = calloc((size_t)set->nparts, sizeof *numbers);
    PutJob job = {NULL, set, numbers};
    test_must(retex_band_store_create(&job.store, set->width, set->height, 0, path, &err), &err);
    for (int i = 0; i < set->nparts; i++) {
        const RetexPart *part = &set->parts[i];
        numbers[i] = -1;
        if (i > 0 && part->image.width == set->width && part->image.height == set->height)
            test_must(retex_band_store_add(job.store, part->name, part->letters, part->type, &numbers[i], &err), &err);
    }
    retex_parallel(4, set->nparts * BANDS, put_band, &job);
    for (int i = 0; i < set->nparts; i++) {
        if (numbers[i] < 0)
            continue;
        free(set->parts[i].image.pixels);
        set->parts[i].image.pixels = NULL;
        set->parts[i].source_part = numbers[i];
    }
    test_must(retex_set_take_store(set, job.store, &err), &err);
    free(numbers);
    return job.store;
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

static void a_set_in_a_band_store_is_written_as_one_in_memory(void **state)
{
    (void)state;
    RetexError err;
    for (int compress = 0; compress < 2; compress++) {
        RetexStoreParams store = RETEX_STORE_INIT;
        RetexSet *set = test_set(WIDTH, HEIGHT, 7);
        test_make_footprints(set);
        darken(set);
        store.compress = compress;
        test_must(retex_set_write(set, path, &store, 0, &err), &err);
        store_parts(set);
        test_must(retex_set_write(set, other, &store, 0, &err), &err);
        expect_same_file();
        retex_set_close(&set);
    }
}

static void a_loaded_set_is_what_a_file_gives(void **state)
{
    (void)state;
    RetexError err;
    RetexSet *set = test_set(WIDTH, HEIGHT, 8), *read = NULL;
    test_must(retex_set_write(set, path, NULL, 0, &err), &err);
    test_must(retex_set_read(path, &read, 2, &err), &err);
    store_parts(set);
    test_must(retex_set_load(set, 2, &err), &err);
    for (int i = 1; i < set->nparts; i++) {
        const RetexImage *a = &set->parts[i].image, *b = &read->parts[i].image;
        assert_null(set->parts[i].source);
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
    RetexBandStore *store = NULL;
    static const float values[] = {0, -0.0f, 1e-12f, 1, NAN};
    static const int empty[] = {1, 1, 0, 0, 0};
    test_must(retex_band_store_create(&store, WIDTH, HEIGHT, 0, NULL, &err), &err);
    for (int k = 0; k < 5; k++) {
        char name[] = "part0";
        float pixels[WIDTH * 9] = {0};
        int number;
        name[4] = (char)('0' + k);
        test_must(retex_band_store_add(store, name, "R", RETEX_HALF, &number, &err), &err);
        assert_true(retex_band_store_is_empty(store, number));
        pixels[17] = values[k];
        test_must(retex_band_store_put(store, number, BANDS - 1, pixels, &err), &err);
        assert_int_equal(retex_band_store_is_empty(store, number), empty[k]);
    }
    retex_band_store_close(&store);
}

static void a_band_store_needs_no_folder_of_the_output(void **state)
{
    (void)state;
    static const char *const near[] = {NULL, "-", "/dev/null", "/dev/full", "/no/such/folder/x.exr", "x.exr"};
    RetexError err;
    for (int k = 0; k < 6; k++) {
        RetexBandStore *store = NULL;
        test_must(retex_band_store_create(&store, 8, 8, 0, near[k], &err), &err);
        retex_band_store_close(&store);
    }
    RetexBandStore *store = NULL;
    int number;
    test_must(retex_band_store_create(&store, 8, 8, 0, NULL, &err), &err);
    assert_int_equal(retex_band_store_add(store, "a part", "R", RETEX_HALF, &number, &err), RETEX_EINVAL);
    assert_int_equal(retex_band_store_add(store, "part", "", RETEX_HALF, &number, &err), RETEX_EINVAL);
    retex_band_store_close(&store);
}

/* Bands of a store that compresses fast come back like others, all as ZIP. Its streams tell by their
 * headers (RFC 1950: the level) that it does. */
static void fast_bands_come_back(void **state)
{
    (void)state;
    static float pixels[WIDTH * RETEX_BAND_ROWS * 3], back[WIDTH * RETEX_BAND_ROWS * 3];
    RetexError err;
    for (int k = 0; k < WIDTH * RETEX_BAND_ROWS * 3; k++)
        pixels[k] = (float)(k / 3 % 64) / 64;
    for (int fast = 0; fast < 2; fast++) {
        RetexBandStore *store;
        unsigned char head[2];
        int number[2];
        test_must(retex_band_store_create(&store, WIDTH, HEIGHT, 0, NULL, &err), &err);
        if (fast)
            retex_band_store_set_fast(store);
        test_must(retex_band_store_add(store, "half", "RGB", RETEX_HALF, &number[0], &err), &err);
        test_must(retex_band_store_add(store, "float", "RGB", RETEX_FLOAT, &number[1], &err), &err);
        for (int k = 0; k < 2; k++) {
            test_must(retex_band_store_put(store, number[k], 1, pixels, &err), &err);
            test_must(retex_band_store_load_band(store, number[k], 1, back, &err), &err);
            assert_memory_equal(back, pixels, sizeof back);
            const RetexBandStoreChunk *chunk = retex_band_store_chunk(store, number[k], 1);
            assert_in_range(chunk->bytes, 10, 2000);
            assert_int_equal(chunk->pxr24, k && !fast);
            assert_int_equal(pread(store->descriptor, head, sizeof head, (off_t)chunk->offset), 2);
            assert_int_equal((head[0] << 8 | head[1]) % 31, 0);
            assert_int_equal(head[1] >> 6 == 0, fast);
        }
        retex_band_store_close(&store);
    }
}

static void flip(const RetexBandStore *store, uint64_t at)
{
    unsigned char byte;
    assert_int_equal(pread(store->descriptor, &byte, 1, (off_t)at), 1);
    byte ^= 1 << at % 8;
    assert_int_equal(pwrite(store->descriptor, &byte, 1, (off_t)at), 1);
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
        RetexBandStore *kept = store_parts(set);
        for (int image = 0; image < kept->nimages; image++) {
            const RetexBandStoreChunk *chunk = retex_band_store_chunk(kept, image, image % BANDS);
            const uint64_t at = chunk->offset + (uint64_t)(image * 37) % (chunk->bytes ? chunk->bytes : 1);
            if (!chunk->bytes)
                continue;
            flip(kept, at);
            assert_int_equal(retex_set_write(set, path, &store, 0, &err), RETEX_EFORMAT);
            assert_non_null(strstr(err.message, "is damaged: a checksum is wrong"));
            assert_int_equal(access(path, F_OK), -1);
            assert_int_equal(retex_set_load(set, 1, &err), RETEX_EFORMAT);
            flip(kept, at);
        }
        test_must(retex_set_write(set, path, &store, 0, &err), &err);
        unlink(path);
        retex_set_close(&set);
    }
}

/* A checkpoint of another size or key is refused, as one with its sides swapped. */
static void checkpoints_have_a_size_and_a_key(void **state)
{
    static const int sizes[4][2] = {{WIDTH, HEIGHT}, {HEIGHT, HEIGHT}, {WIDTH, WIDTH}, {HEIGHT, WIDTH}};
    RetexBandStore *store;
    RetexError err = {0};

    (void)state;
    test_must(retex_band_store_open(&store, WIDTH, HEIGHT, 5, path, &err), &err);
    retex_band_store_close(&store);
    for (int k = 0; k < 4; k++)
        for (int key = 5; key < 7; key++) {
            const int code = retex_band_store_open(&store, sizes[k][0], sizes[k][1], (uint64_t)key, path, &err);
            assert_int_equal(code == RETEX_OK, k == 0 && key == 5);
            retex_band_store_close(&store);
        }
}

/* What bands counted becomes what the set says: means by pixel, coverage and light, the union of ranges. */
static void statistics_of_bands_add_up(void **state)
{
    RetexSet *set = test_set(8, 10, 1);
    RetexBandStats bands[2];

    (void)state;
    for (int b = 0; b < 2; b++)
        retex_band_stats_reset(&bands[b]);
    bands[0].samples = 300, bands[1].samples = 241; /* of 80 pixels: 6.76 */
    bands[0].total = 3, bands[1].total = 5, bands[0].folded = 0.5, bands[1].folded = 1.5;
    bands[0].total_white = 12, bands[1].total_white = 4, bands[0].folded_white = 1, bands[1].folded_white = 3;
    bands[0].cut = 0.5, bands[1].cut = 1.5;
    bands[0].coverage[1] = 1, bands[1].coverage[1] = 3;
    bands[0].albedo[1][0] = 0.5, bands[1].albedo[1][0] = 0.5, bands[1].albedo[1][2] = 3;
    bands[0].uv_low[1][0] = -2, bands[0].uv_high[1][0] = 1, bands[1].uv_low[1][0] = -1, bands[1].uv_high[1][0] = 4;
    bands[1].uv_low[1][1] = 0.25, bands[1].uv_high[1][1] = 0.5;
    retex_band_stats_finish(set, bands, 2);
    assert_int_equal(set->spp, 7);
    assert_true(set->folded == 0.25 && set->folded_white == 0.25 && set->depth_cut == 0.2);
    const RetexTarget *t = &set->targets[1], *unseen = &set->targets[0];
    assert_true(t->mean_albedo[0] == 0.25f && t->mean_albedo[1] == 0 && t->mean_albedo[2] == 0.75f);
    assert_true(t->uv_min[0] == -2 && t->uv_max[0] == 4 && t->uv_min[1] == 0.25 && t->uv_max[1] == 0.5);
    assert_true(unseen->uv_min[0] == 0 && unseen->uv_max[1] == 1 && unseen->mean_albedo[0] == 0);
    bands[1].total_white = 8;
    retex_band_stats_finish(set, bands, 2);
    assert_true(set->folded == 0.25 && set->folded_white == 0.2);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_set_in_a_band_store_is_written_as_one_in_memory, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(a_loaded_set_is_what_a_file_gives, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(what_is_damaged_is_not_read_back, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(checkpoints_have_a_size_and_a_key, make_folder, remove_folder),
        cmocka_unit_test(what_is_empty_is_known),
        cmocka_unit_test(fast_bands_come_back),
        cmocka_unit_test(statistics_of_bands_add_up),
        cmocka_unit_test(a_band_store_needs_no_folder_of_the_output),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
