/* Numbers that are not valid colours: no set, stream or pack that holds one is accepted by any reader, and the message
 * names the part and the place. */
#include "lib_folder.h"
#include "lib_pack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/half.h"
#include "base/value_check.h"
#include "pack/open.h"
#include "pack/strips.h"
#include "set/rows.h"

/* ---- the kernels ---- */

static int is_odd(const unsigned char *stored, RetexPixelType type)
{
    float value;
    if (type == RETEX_FLOAT)
        memcpy(&value, stored, 4);
    else
        retex_half_to_float_scalar(&value, (const uint16_t *)(const void *)stored, 1);
    return !isfinite(value);
}

/* Any bits, at any length and alignment: the first bad one is found, and none where there is none. */
static void test_kernels(void **state)
{
    (void)state;
    enum { MOST = 200 };
    static _Alignas(16) unsigned char memory[4 * MOST + 8], copy[4];
    uint32_t seed = 5;
    int found_some = 0;
    for (int round = 0; round < 20000; round++) {
        const RetexPixelType type = round % 2 ? RETEX_FLOAT : RETEX_HALF;
        const size_t bytes = type == RETEX_FLOAT ? 4 : 2, count = (size_t)(test_random(&seed) * MOST);
        unsigned char *at = memory + (size_t)(test_random(&seed) * 8);
        for (size_t i = 0; i < count * bytes; i++)
            at[i] = (unsigned char)(test_random(&seed) * 256);
        for (size_t i = 0; i < count && round % 3; i++) /* most rounds: finite but for one */
            at[(i + 1) * bytes - 1] &= 0x3f;
        if (count && round % 3 == 1)
            memset(at + (size_t)(test_random(&seed) * (double)count) * bytes, 0x7f, bytes);
        size_t first = 0;
        while (first < count && !is_odd(memcpy(copy, at + first * bytes, bytes), type))
            first++;
        assert_int_equal(retex_find_disallowed(at, type, count, RETEX_ALLOW_FINITE), first);
        assert_int_equal(retex_find_disallowed(at, type, count, RETEX_ALLOW_ANY), count);
        found_some += first < count;
    }
    assert_true(found_some > 5000);
    static const float depths[4] = {1, INFINITY, -INFINITY, NAN};
    assert_int_equal(retex_find_disallowed(depths, RETEX_FLOAT, 4, RETEX_ALLOW_FINITE), 1);
    assert_int_equal(retex_find_disallowed(depths, RETEX_FLOAT, 4, RETEX_ALLOW_INFINITE), 3);
    assert_int_equal(retex_find_disallowed(depths, RETEX_FLOAT, 3, RETEX_ALLOW_INFINITE), 3);
}

/* ---- readers ---- */

/* Each returns what opening and reading all of a file say. */
typedef int Reader(const char *path, RetexError *err);

static int read_whole(const char *path, RetexError *err)
{
    RetexSet *set = NULL;
    int code = retex_set_open_any(path, &set, 2, err);
    const int is_samples = set && retex_set_info(set).is_samples;
    retex_set_close(&set);
    if (is_samples)
        return RETEX_OK; /* which only retex_set_open_any takes */
    code = retex_set_read(path, &set, 2, err);
    assert_true(!code || !set);
    retex_set_close(&set);
    return code;
}

static int open_and_load(const char *path, RetexError *err)
{
    RetexSet *set = NULL;
    int code = retex_set_open_any(path, &set, 2, err);
    if (!code)
        code = retex_set_load(set, 2, err);
    retex_set_close(&set);
    return code;
}

static int read_rows(const char *path, RetexError *err)
{
    RetexSet *set = NULL;
    RetexRowReader *reader = NULL;
    int code = retex_set_open_any(path, &set, 2, err);
    if (!code)
        code = retex_row_reader_open(&reader, set, err);
    for (int i = 0; set && i < set->nparts; i++)
        for (int y = set->parts[i].image.height; y-- > 0 && !code;) {
            const float *row;
            code = retex_row_reader_get(reader, i, y, &row, err);
        }
    retex_row_reader_close(&reader);
    retex_set_close(&set);
    return code;
}

static int check_sums(const char *path, RetexError *err)
{
    return retex_set_check(path, 2, err);
}

static Reader *const readers[] = {read_whole, open_and_load, read_rows, check_sums};
enum { READERS = sizeof readers / sizeof *readers };

/* Fails where the reader takes it, or does not say where it is. */
static void must_refuse(const char *path, const char *part, const char *place)
{
    char names[RETEX_NAME_MAX + 16];
    snprintf(names, sizeof names, "part %s holds", part);
    for (int k = 0; k < READERS; k++) {
        RetexError err = {0};
        const int code = readers[k](path, &err);
        if (code != RETEX_EFORMAT || !strstr(err.message, names) || !strstr(err.message, place))
            fail_msg("reader %d of %s: %d \"%s\"", k, part, code, err.message);
    }
}

static const float bad[3] = {NAN, INFINITY, -INFINITY};

static void test_sets(void **state)
{
    (void)state;
    const char *path = test_in_folder("s.exr");
    for (int footprints = 0; footprints < 2; footprints++) {
        RetexSet *set = test_set(37, 41, 2);
        if (footprints)
            test_make_footprints(set);
        test_add_denoise_data(set);
        for (int i = 0; i < set->nparts; i++) {
            RetexPart *part = &set->parts[i];
            RetexStoreParams params = RETEX_STORE_INIT;
            RetexError err = {0};
            char place[64];
            params.compress = i % 2;
            const int x = part->image.width / 2, y = part->image.height - 1;
            float *value = part->image.pixels + retex_image_index(&part->image, x + 1, y) - 1, kept = *value;
            snprintf(place, sizeof place, "at %d,%d in channel %c", x, y, part->letters[strlen(part->letters) - 1]);
            *value = strcmp(part->name, "depth") == 0 ? NAN : bad[i % 3];
            test_must(retex_set_write(set, path, &params, 0, &err), &err);
            must_refuse(path, part->name, place);
            *value = strcmp(part->name, "depth") == 0 ? INFINITY : -65504;
            test_must(retex_set_write(set, path, &params, 0, &err), &err);
            for (int k = 0; k < READERS; k++)
                test_must(readers[k](path, &err), &err);
            *value = kept;
        }
        retex_set_close(&set);
    }
}

static void test_streams(void **state)
{
    (void)state;
    const char *path = test_in_folder("t.exr");
    RetexSet *set = test_set(24, 20, 3);
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexError err = {0};
    test_must(test_texture_spec(&spec, NULL, "Floor=rgb(.1,.2,.3)", &err), &err);
    test_must(retex_sample(set, &spec, 1, 1, &err), &err);
    int i = 0;
    while (!test_laid(set, i))
        i++;
    test_laid(set, i)->pixels[retex_image_index(test_laid(set, i), 3, 7)] = NAN;
    test_must(retex_set_write(set, path, NULL, 0, &err), &err);
    must_refuse(path, "sample_Floor_1", "at 3,7 in channel R");
    retex_set_close(&set);
}

static void test_packs(void **state)
{
    (void)state;
    const char *path = test_in_folder("p.retex");
    RetexSet *set = test_set(37, 70, 2);
    for (int i = 0; i < set->nparts; i++) {
        RetexPart *part = &set->parts[i];
        RetexPackParams params = lossless();
        RetexError err = {0};
        char place[64];
        const int x = part->image.width / 2, y = part->image.height - 1;
        float *value = part->image.pixels + retex_image_index(&part->image, x, y), kept = *value;
        snprintf(place, sizeof place, "at %d,%d in channel %c", x, y, part->letters[0]);
        *value = strcmp(part->name, "depth") == 0 ? NAN : bad[i % 3];
        test_must(retex_pack_write(set, path, &params, NULL, 0, &err), &err);
        must_refuse(path, part->name, place);
        *value = kept;
    }
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kernels),
        cmocka_unit_test(test_sets),
        cmocka_unit_test(test_streams),
        cmocka_unit_test(test_packs),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
