/* Damage that only a checksum detects: every reader of a set, samples or a stream refuses it, whether it reads
 * everything or row by row. */
#include "lib_damage.h"
#include "lib_folder.h"
#include "set/manifest.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static int begin(void **state)
{
    const int code = test_make_folder(state);
    if (!code)
        damage_begin(test_folder);
    return code;
}

static int end(void **state)
{
    damage_end();
    return test_remove_folder(state);
}

static void store(const char *path, const unsigned char *data, size_t bytes)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, bytes, file), bytes);
    assert_int_equal(fclose(file), 0);
}

/* Streams have not what denoising needs. */
static int can_go(DamageFile kind, DamageRoad road)
{
    return kind != FILE_STREAM || (road != ROAD_DENOISE && road != ROAD_STRIPS && road != ROAD_PACK);
}

/* Flip bits here and there in what holds the samples, which is the second half of a file at least, and go a road: it is
 * refused, and the message names a part, or what comes of it is the same to the bit. How many were refused of FLIPS. */
enum { FLIPS = 16 };
static int flip_samples(const char *path, DamageRoad road, uint32_t seed)
{
    uint32_t good = 0, sum = 0;
    RetexError err = {0};
    size_t bytes;
    int refused = 0;
    unsigned char *data = test_read_file(path, &bytes);
    test_must(damage_go(road, path, &good, &err), &err);
    for (int i = 0; i < FLIPS; i++) {
        const size_t at = bytes / 2 + (size_t)(test_random(&seed) * (double)(bytes / 2));
        data[at] ^= (unsigned char)(1 << i % 8);
        store(path, data, bytes);
        data[at] ^= (unsigned char)(1 << i % 8);
        const int code = damage_go(road, path, &sum, &err);
        if (code)
            assert_true(code == RETEX_EFORMAT && strstr(err.message, "part"));
        else if (sum != good)
            fail_msg("road %s: byte %zu, bit %d", damage_road_names[road], at, i % 8);
        refused += code != 0;
    }
    store(path, data, bytes);
    free(data);
    assert_int_equal(test_files_left(), 2); /* the set and the texture */
    return refused;
}

/* Of the two layouts, and of files without checksums of bands, where each part is compared as a whole. */
static void flip_everywhere(DamageFile kind)
{
    static const char *const layouts[] = {"footprints", "paper"};
    for (int k = 0; k < 4; k++) {
        RetexSet *set = damage_set(layouts[k % 2], 3);
        damage_write(set, kind, test_own_file);
        if (k >= 2)
            damage_drop_bands_of_file(test_own_file);
        for (DamageRoad road = 0; road < ROADS; road++) {
            if (!can_go(kind, road))
                continue;
            const int refused = flip_samples(test_own_file, road, 7 + (uint32_t)road);
            /* who reads all of the file sees all there is, but for bits that deflate does not use */
            if (kind != FILE_SET &&
                (road == ROAD_READ || road == ROAD_WRITE || road == ROAD_PACK || road == ROAD_DENOISE))
                assert_int_equal(refused, FLIPS);
            assert_true(refused > 0);
        }
        retex_set_close(&set);
    }
}

static void test_compressed_sets(void **state)
{
    (void)state;
    flip_everywhere(FILE_SET);
}

static void test_sets_as_they_are(void **state)
{
    (void)state;
    flip_everywhere(FILE_PLAIN);
}

static void test_streams(void **state)
{
    (void)state;
    flip_everywhere(FILE_STREAM);
}

/* With several threads, who find out together whether a part without sums of bands is whole; also where it is not. */
static void test_threads(void **state)
{
    (void)state;
    RetexImage pictures[2] = {{0}, {0}};
    RetexSet *set = damage_set("footprints", 3);
    RetexError err = {0};
    size_t bytes;
    damage_write(set, FILE_PLAIN, test_own_file);
    damage_drop_bands_of_file(test_own_file);
    unsigned char *data = test_read_file(test_own_file, &bytes);
    retex_set_close(&set);
    for (int damaged = 0; damaged < 2; damaged++)
        for (int k = 0; k < 2; k++) {
            const int nthreads = 1 + 3 * k;
            test_must(retex_set_open(test_own_file, &set, nthreads, &err), &err);
            const int code = retex_combine(&pictures[k], set, NULL, NULL, nthreads, &err);
            retex_set_close(&set);
            assert_int_equal(code, damaged ? RETEX_EFORMAT : RETEX_OK);
            if (k == 1)
                memset(data + bytes / 3, 7, bytes / 3);
            store(test_own_file, data, bytes);
        }
    assert_memory_equal(pictures[0].pixels, pictures[1].pixels,
                        sizeof(float) * retex_image_index(&pictures[0], 0, pictures[0].height));
    for (int k = 0; k < 2; k++)
        retex_image_free(&pictures[k]);
    free(data);
}

/* CRC-32 bit by bit, from its polynomial (ISO 3309). */
static uint32_t plain_crc32(const char *text)
{
    uint32_t crc = 0xffffffff;

    for (; *text; text++) {
        crc ^= (unsigned char)*text;
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return ~crc;
}

/* The manifest's sum is of all its text with 0s in the place of the digits. */
static void test_sum_of_the_manifest(void **state)
{
    (void)state;
    char json[] = "{\"retex\":1,\"crc32\":\"00000000\",\"kind\":\"set\",\"width\":48}", digits[9];

    assert_int_equal(plain_crc32("123456789"), 0xcbf43926);
    snprintf(digits, sizeof digits, "%08x", (unsigned)plain_crc32(json));
    retex_manifest_seal(json);
    assert_memory_equal(strstr(json, "crc32") + 8, digits, 8);
    assert_int_equal(retex_manifest_sum(json), RETEX_MANIFEST_RIGHT);
    json[sizeof json - 2] = ' ';
    assert_int_equal(retex_manifest_sum(json), RETEX_MANIFEST_WRONG);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_compressed_sets),
        cmocka_unit_test(test_sets_as_they_are),
        cmocka_unit_test(test_streams),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_sum_of_the_manifest),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
