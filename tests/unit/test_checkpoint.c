/* Checkpoints: committed bands are there when a band store is opened again, however its file ends or is damaged. */
#include "lib_damage.h"
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <retex/host/band_stats.h>

#include "exr/band_store_file.h"

#define WIDTH 5
#define HEIGHT 40
#define BANDS 3
#define KEY 0x1234567890u

static char path[64], copy[80];

static int make_path(void **state)
{
    (void)state;
    strcpy(path, "/tmp/retex-checkpoint-XXXXXX");
    const int descriptor = mkstemp(path);
    snprintf(copy, sizeof copy, "%s.copy", path);
    return descriptor < 0 ? -1 : close(descriptor) || unlink(path);
}

static int remove_path(void **state)
{
    (void)state;
    unlink(path);
    unlink(copy);
    return 0;
}

/* A pixel of a band: image 1 is black in the first. */
static float value_of(int image, int band, int i)
{
    return image == 1 && band == 0 ? 0 : (float)(1 + image + 2 * band) + (float)(i % 7) / 8;
}

static void put_band(RetexBandStore *store, int band, int commit)
{
    RetexError err;
    RetexBandStats stats;
    float pixels[16 * WIDTH * 3];
    for (int image = 0; image < 2; image++) {
        for (int i = 0; i < 16 * WIDTH * 3; i++)
            pixels[i] = value_of(image, band, i);
        test_must(retex_band_store_put(store, image, band, pixels, &err), &err);
    }
    retex_band_stats_reset(&stats);
    stats.total = band + 0.5;
    if (commit)
        test_must(retex_band_store_commit(store, band, &stats, &err), &err);
}

static void add_images(RetexBandStore *store)
{
    RetexError err;
    int number;
    test_must(retex_band_store_add(store, "first", "RGB", RETEX_HALF, &number, &err), &err);
    assert_int_equal(number, 0);
    test_must(retex_band_store_add(store, "second", "RGB", RETEX_FLOAT, &number, &err), &err);
    assert_int_equal(number, 1);
}

/* Two of three bands are committed, a third is there in part. */
static void make_checkpoint(void)
{
    RetexError err;
    RetexBandStore *store = NULL;
    test_must(retex_band_store_open(&store, WIDTH, HEIGHT, KEY, path, &err), &err);
    add_images(store);
    put_band(store, 1, 1);
    put_band(store, 0, 1);
    put_band(store, 2, 0);
    retex_band_store_close(&store);
}

/* How many bands are committed; they must be as they were. */
static int check_bands(const RetexBandStore *store)
{
    RetexError err;
    float pixels[16 * WIDTH * 3];
    int count = 0;
    for (int band = 0; band < BANDS; band++) {
        const RetexBandStats *stats = retex_band_store_committed(store, band);
        if (!stats)
            continue;
        assert_true(stats->total == band + 0.5);
        count++;
        for (int image = 0; image < 2; image++) {
            test_must(retex_band_store_load_band(store, image, band, pixels, &err), &err);
            for (int i = 0; i < (band < 2 ? 16 : 8) * WIDTH * 3; i++)
                assert_true(pixels[i] == value_of(image, band, i));
        }
    }
    return count;
}

static void what_was_committed_is_there(void **state)
{
    (void)state;
    RetexError err;
    RetexBandStore *store = NULL;
    int number;
    make_checkpoint();
    test_must(retex_band_store_open(&store, WIDTH, HEIGHT, KEY, path, &err), &err);
    assert_string_equal(retex_band_store_image_name(store, 1), "second");
    assert_null(retex_band_store_image_name(store, 2));
    add_images(store); /* they are there */
    assert_int_equal(check_bands(store), 2);
    assert_null(retex_band_store_committed(store, 2));
    test_must(retex_band_store_add(store, "third", "R", RETEX_HALF, &number, &err), &err);
    assert_true(retex_band_store_is_empty(store, number) && !retex_band_store_is_empty(store, 1));
    put_band(store, 2, 1);
    assert_int_equal(check_bands(store), 3);
    retex_band_store_close(&store);
    test_must(retex_band_store_open(&store, WIDTH, HEIGHT, KEY, path, &err), &err);
    assert_int_equal(check_bands(store), 3);
    retex_band_store_close(&store);
}

static void another_render_is_refused(void **state)
{
    (void)state;
    RetexError err;
    RetexBandStore *store = NULL, *second = NULL;
    int number;
    make_checkpoint();
    assert_int_equal(retex_band_store_open(&store, WIDTH, HEIGHT, KEY + 1, path, &err), RETEX_EINVAL);
    assert_int_equal(retex_band_store_open(&store, WIDTH, HEIGHT + 1, KEY, path, &err), RETEX_EINVAL);
    assert_null(store);
    test_must(retex_band_store_open(&store, WIDTH, HEIGHT, KEY, path, &err), &err);
    assert_int_equal(retex_band_store_open(&second, WIDTH, HEIGHT, KEY, path, &err), RETEX_EIO); /* in use */
    assert_int_equal(retex_band_store_add(store, "first", "RGB", RETEX_FLOAT, &number, &err), RETEX_EFORMAT);
    retex_band_store_close(&store);
}

static unsigned char *read_checkpoint(size_t *size)
{
    FILE *file = fopen(path, "rb");
    unsigned char *bytes = malloc(1 << 16);
    assert_true(file && bytes);
    *size = fread(bytes, 1, 1 << 16, file);
    fclose(file);
    return bytes;
}

static void write_copy(const unsigned char *bytes, size_t size)
{
    FILE *file = fopen(copy, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

static void one_of_an_older_version_is_refused(void **state)
{
    (void)state;
    RetexError err;
    RetexBandStore *store = NULL;
    size_t size;
    make_checkpoint();
    unsigned char *bytes = read_checkpoint(&size);
    bytes[7]--;
    write_copy(bytes, size);
    assert_int_equal(retex_band_store_open(&store, WIDTH, HEIGHT, KEY, copy, &err), RETEX_EFORMAT);
    assert_non_null(strstr(err.message, "another kind of machine or version"));
    free(bytes);
}

static void a_checkpoint_may_end_anywhere(void **state)
{
    (void)state;
    RetexError err;
    size_t size;
    int before = 0;
    make_checkpoint();
    unsigned char *bytes = read_checkpoint(&size);
    for (size_t cut = 0; cut <= size; cut++) {
        RetexBandStore *store = NULL;
        write_copy(bytes, cut);
        test_must(retex_band_store_open(&store, WIDTH, HEIGHT, KEY, copy, &err), &err);
        const int count = check_bands(store);
        assert_in_range(count, before, 2);
        before = count;
        add_images(store);
        put_band(store, 2, 1);
        assert_int_equal(check_bands(store), count + 1);
        retex_band_store_close(&store);
    }
    assert_int_equal(before, 2);
    free(bytes);
}

static void damage_costs_bands_at_most(void **state)
{
    (void)state;
    RetexError err;
    size_t size;
    make_checkpoint();
    unsigned char *bytes = read_checkpoint(&size);
    for (size_t at = 0; at < size; at++) {
        RetexBandStore *store = NULL;
        bytes[at] ^= 0x41;
        write_copy(bytes, size);
        bytes[at] ^= 0x41;
        if (retex_band_store_open(&store, WIDTH, HEIGHT, KEY, copy, &err) == 0)
            check_bands(store);
        else
            assert_true(at < 64); /* the header */
        retex_band_store_close(&store);
    }
    free(bytes);
}

/* Where the records of a checkpoint begin, and at last where it ends. */
static int find_records(const unsigned char *bytes, size_t size, size_t *begins)
{
    size_t at = 32; /* the header */
    int count = 0;
    while (at + sizeof(RetexBandStoreRecord) <= size) {
        RetexBandStoreRecord record;
        memcpy(&record, bytes + at, sizeof record);
        begins[count++] = at;
        at += sizeof record + record.bytes;
    }
    assert_int_equal(at, size);
    begins[count] = at;
    return count;
}

static void check_copy(void)
{
    RetexError err;
    RetexBandStore *store = NULL;
    test_must(retex_band_store_open(&store, WIDTH, HEIGHT, KEY, copy, &err), &err);
    check_bands(store);
    retex_band_store_close(&store);
}

/* Whole records, each with its right checksum: without one of them a band would be black where it was not. */
static void no_record_is_missing_or_comes_twice(void **state)
{
    (void)state;
    size_t size, begins[32];
    make_checkpoint();
    unsigned char *bytes = read_checkpoint(&size), *other = malloc(2 * size);
    const int count = find_records(bytes, size, begins);
    assert_in_range(count, 8, 30);
    for (int i = 0; i < count; i++) {
        const size_t begin = begins[i], end = begins[i + 1];
        memcpy(other, bytes, begin);
        memcpy(other + begin, bytes + end, size - end);
        write_copy(other, size - (end - begin));
        check_copy();
        memcpy(other, bytes, end);
        memcpy(other + end, bytes + begin, size - begin);
        write_copy(other, size + end - begin);
        check_copy();
        for (int k = i + 1; k < count; k++) { /* and the one of another place */
            memcpy(other, bytes, begin);
            memcpy(other + begin, bytes + begins[k], size - begins[k]);
            write_copy(other, begin + size - begins[k]);
            check_copy();
        }
    }
    free(bytes);
    free(other);
}

/* The file changes after its checksums were compared: what is read back is compared again. */
static void damage_after_opening_is_seen(void **state)
{
    (void)state;
    RetexError err;
    RetexBandStore *store = NULL;
    float pixels[16 * WIDTH * 3];
    size_t size;
    int refused = 0;
    make_checkpoint();
    unsigned char *bytes = read_checkpoint(&size);
    write_copy(bytes, size);
    test_must(retex_band_store_open(&store, WIDTH, HEIGHT, KEY, copy, &err), &err);
    FILE *file = fopen(copy, "r+b");
    assert_non_null(file);
    setbuf(file, NULL);
    for (size_t at = 0; at < size; at++) {
        assert_true(fseek(file, (long)at, SEEK_SET) == 0 && fputc(bytes[at] ^ 1 << at % 8, file) != EOF);
        for (int band = 0; band < 2; band++)
            for (int image = 0; image < 2; image++) {
                const int code = retex_band_store_load_band(store, image, band, pixels, &err);
                refused += code != 0;
                assert_true(code == 0 || (code == RETEX_EFORMAT && strstr(err.message, "a checksum is wrong")));
                for (int i = 0; i < 16 * WIDTH * 3 && !code; i++)
                    assert_true(pixels[i] == value_of(image, band, i));
            }
        assert_true(fseek(file, (long)at, SEEK_SET) == 0 && fputc(bytes[at], file) != EOF);
    }
    assert_true(refused > 0);
    fclose(file);
    retex_band_store_close(&store);
    free(bytes);
}

/* Whatever happens to a checkpoint, the render that goes on from it ends as one that was not disturbed. */
static void renders_go_on_from_what_is_whole(void **state)
{
    (void)state;
    RetexError err;
    size_t size;
    int refused = 0, lost = 0;
    make_checkpoint();
    unsigned char *bytes = read_checkpoint(&size), *other = malloc(size + DAMAGE_ROOM);
    for (int i = 0; i < 100 * DAMAGE_KINDS; i++) {
        uint32_t seed = 77u + (uint32_t)i * 7919u;
        RetexBandStore *store = NULL;
        memcpy(other, bytes, size);
        write_copy(other, damage_change(other, size, (DamageKind)(i % DAMAGE_KINDS), &seed));
        const int code = retex_band_store_open(&store, WIDTH, HEIGHT, KEY, copy, &err);
        refused += code != 0;
        if (code)
            continue;
        add_images(store);
        lost += check_bands(store) < 2;
        for (int band = 0; band < BANDS; band++)
            if (!retex_band_store_committed(store, band))
                put_band(store, band, 1);
        assert_int_equal(check_bands(store), BANDS);
        retex_band_store_close(&store);
    }
    assert_true(refused > 0 && lost > 0);
    free(bytes);
    free(other);
}

static void a_nameless_band_store_gets_a_name(void **state)
{
    (void)state;
    RetexError err;
    RetexBandStore *store = NULL, *read = NULL;
    for (int elsewhere = 0; elsewhere < 2; elsewhere++) {
        const char *const folder = getenv("TMPDIR");
        if (elsewhere) /* on another file system, where there is one: it is copied there, not linked */
            setenv("TMPDIR", "/dev/shm", 1);
        test_must(retex_band_store_create(&store, WIDTH, HEIGHT, KEY, elsewhere ? "/dev/null" : path, &err), &err);
        if (elsewhere && folder)
            setenv("TMPDIR", folder, 1);
        else if (elsewhere)
            unsetenv("TMPDIR");
        add_images(store);
        put_band(store, 1, 1);
        unlink(path);
        test_must(retex_band_store_keep(store, path, &err), &err);
        assert_int_equal(retex_band_store_keep(store, path, &err), RETEX_EIO); /* is there */
        assert_int_equal(retex_band_store_keep(store, "/no/such/folder/x", &err), RETEX_EIO);
        test_must(retex_band_store_open(&read, WIDTH, HEIGHT, KEY, path, &err), &err);
        assert_int_equal(check_bands(read), 1);
        retex_band_store_close(&read);
        retex_band_store_close(&store);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(what_was_committed_is_there, make_path, remove_path),
        cmocka_unit_test_setup_teardown(another_render_is_refused, make_path, remove_path),
        cmocka_unit_test_setup_teardown(one_of_an_older_version_is_refused, make_path, remove_path),
        cmocka_unit_test_setup_teardown(a_checkpoint_may_end_anywhere, make_path, remove_path),
        cmocka_unit_test_setup_teardown(damage_costs_bands_at_most, make_path, remove_path),
        cmocka_unit_test_setup_teardown(no_record_is_missing_or_comes_twice, make_path, remove_path),
        cmocka_unit_test_setup_teardown(damage_after_opening_is_seen, make_path, remove_path),
        cmocka_unit_test_setup_teardown(renders_go_on_from_what_is_whole, make_path, remove_path),
        cmocka_unit_test_setup_teardown(a_nameless_band_store_gets_a_name, make_path, remove_path),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
