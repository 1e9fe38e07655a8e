/* Incomplete and inconsistent packs are refused. */
#include "lib_folder.h"
#include "lib_pack.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zip.h>

#include <cmocka.h>

#include "set/manifest.h"

/* Reading gives an error with a message and no set. */
static void assert_refused(const void *data, size_t bytes)
{
    RetexSet *set = NULL;
    RetexError err = {0};
    int code = pack_read(data, bytes, &set, 1, &err);
    assert_true(code < 0 && err.code == code && err.message[0]);
    assert_null(set);
    assert_true(pack_check(data, bytes, 0, NULL) < 0);
}

static int sets_equal(const RetexSet *a, const RetexSet *b)
{
    int equal = a->nparts == b->nparts && a->nterms == b->nterms && a->nfootprints == b->nfootprints &&
                a->ntargets == b->ntargets && strcmp(a->scene, b->scene) == 0;
    for (int i = 0; equal && i < a->nparts; i++) {
        const RetexImage *x = &a->parts[i].image, *y = &b->parts[i].image;
        equal = x->width == y->width && x->height == y->height && x->channels == y->channels &&
                memcmp(x->pixels, y->pixels, (size_t)x->width * (size_t)x->height * (size_t)x->channels * 4) == 0;
    }
    return equal;
}

/* Of a pack: all bytes up to a place, then one of step. */
static void flip_bytes(unsigned char *data, size_t bytes, size_t all, size_t step)
{
    size_t unseen = 0;
    RetexSet *whole = unpack(data, bytes);
    for (size_t i = 0; i < bytes; i += i < all ? 1 : step) {
        RetexSet *back = NULL;
        unsigned char kept = data[i];
        data[i] ^= (unsigned char)(1 + i % 255);
        RetexError err = {0};
        int code = pack_read(data, bytes, &back, 1, &err);
        if (code == 0) { /* a date or an attribute of the zip: then the set is the same to the bit */
            assert_true(sets_equal(whole, back));
            unseen++;
        } else {
            assert_true(code < 0 && err.message[0]);
            assert_null(back);
        }
        retex_set_close(&back);
        data[i] = kept;
    }
    assert_true(unseen < bytes / 70);
    retex_set_close(&whole);
}

static void test_every_flipped_byte_is_seen(void **state)
{
    (void)state;
    for (int exact = 0; exact < 2; exact++) {
        const RetexPackParams params = lossless();
        size_t bytes;
        RetexSet *set = test_set(16, 8, 7);
        unsigned char *data = pack(set, exact ? &params : NULL, &bytes, 0);
        flip_bytes(data, bytes, exact ? 64 : 2048, exact ? 31 : 7);
        free(data);
        retex_set_close(&set);
    }
}

static void test_truncated_packs_are_refused(void **state)
{
    (void)state;
    size_t bytes;
    RetexSet *set = test_set(16, 8, 7);
    unsigned char *data = pack(set, NULL, &bytes, 0);
    for (size_t cut = 0; cut < bytes; cut += cut < 64 || cut + 64 > bytes ? 1 : 97)
        assert_refused(data, cut);
    free(data);
    retex_set_close(&set);
}

/* A pack with one change: an entry added, or the manifest edited by replacing `find` by `put`. */
static unsigned char *changed_pack(const unsigned char *data, size_t bytes, const char *add, const char *find,
                                   const char *put, size_t *out_bytes)
{
    char path[] = "/tmp/test_pack_XXXXXX";
    int fd = mkstemp(path);
    assert_true(fd >= 0 && write(fd, data, bytes) == (ssize_t)bytes);
    close(fd);
    zip_t *zip = zip_open(path, 0, NULL);
    assert_non_null(zip);
    char *edited = NULL;
    if (add)
        assert_true(zip_file_add(zip, add, zip_source_buffer(zip, "abc", 3, 0), 0) >= 0);
    if (find) {
        zip_stat_t stat;
        assert_int_equal(zip_stat(zip, "manifest.json", 0, &stat), 0);
        char *text = calloc(stat.size + 1, 1);
        zip_file_t *file = zip_fopen(zip, "manifest.json", 0);
        assert_int_equal(zip_fread(file, text, stat.size), stat.size);
        zip_fclose(file);
        char *at = strstr(text, find);
        assert_non_null(at);
        edited = malloc(stat.size + strlen(put) + 1);
        sprintf(edited, "%.*s%s%s", (int)(at - text), text, put, at + strlen(find));
        retex_manifest_seal(edited);
        zip_int64_t index = zip_name_locate(zip, "manifest.json", 0);
        assert_int_equal(
            zip_file_replace(zip, (zip_uint64_t)index, zip_source_buffer(zip, edited, strlen(edited), 0), 0), 0);
        zip_set_file_compression(zip, (zip_uint64_t)index, ZIP_CM_STORE, 0);
        free(text);
    }
    assert_int_equal(zip_close(zip), 0);
    free(edited);
    unsigned char *out = test_read_file(path, out_bytes);
    unlink(path);
    return out;
}

/* Refuse the pack of a set, which is closed, once it is changed. */
static void refuse_change_of(RetexSet *set, const char *add, const char *find, const char *put, const char *message)
{
    size_t bytes, changed_bytes;
    RetexSet *back = NULL;
    RetexError err = {0};
    unsigned char *data = pack(set, NULL, &bytes, 0);
    unsigned char *changed = changed_pack(data, bytes, add, find, put, &changed_bytes);
    assert_refused(changed, changed_bytes);
    pack_read(changed, changed_bytes, &back, 1, &err);
    assert_non_null(strstr(err.message, message));
    free(changed);
    free(data);
    retex_set_close(&set);
}

static void refuse_change(const char *add, const char *find, const char *put, const char *message)
{
    refuse_change_of(test_set(16, 8, 7), add, find, put, message);
}

static void test_foreign_entries_are_refused(void **state)
{
    (void)state;
    refuse_change("../evil", NULL, NULL, "does not know");
    refuse_change("/etc/passwd", NULL, NULL, "does not know");
    refuse_change("parts/../../x.data", NULL, NULL, "does not know");
    refuse_change("radiance/unknown.jpg", NULL, NULL, "does not know");
}

static void test_manifests_that_lie_are_refused(void **state)
{
    (void)state;
    refuse_change(NULL, "\"codec\":\"jpeg\"", "\"codec\":\"webp\"", "this version knows");
    refuse_change(NULL, "\"codec\":\"planes\"", "\"codec\":\"zero\"", "");
    refuse_change(NULL, "{\"retex\":1", "{\"retex\":9", "version 9; this program reads version 1: render again");
    refuse_change(NULL, "\"pack\":{", "\"pakk\":{", "list of parts");
    refuse_change(NULL, "\"white\":", "\"white\":-", "not sound");
    refuse_change(NULL, "\"per_octave\":8", "\"per_octave\":0", "not sound");
    refuse_change(NULL, "\"map\":\"lattice\"", "\"map\":\"trellis\"", "not sound");
    refuse_change(NULL, "\"present\":\"t0_uv1\"", "\"present\":\"depth\"", "not sound");
    refuse_change(NULL, "\"sigma\":\"t0_spread1\"", "\"sigma\":\"t0_uv1\"", "not sound");
    refuse_change(NULL, "\"sigma\":\"t0_spread1\",", "", "not sound");
    refuse_change(NULL, "\"width\":16,\"height\":8,\"crc", "\"width\":60000,\"height\":60000,\"crc", "");
    refuse_change(NULL, "\"masked\":true", "\"masked\":false", "");
}

static void test_steps_that_lie_are_refused(void **state)
{
    static const char *const changes[][2] = {{"\"map\":\"step\"", "\"map\":\"log\""},
                                             {"\"map\":\"lattice\"", "\"map\":\"step\",\"first\":1,\"per_octave\":8"},
                                             {"\"sigma\":\"axes_T0_whole\"", "\"sigma\":\"uv_T0_whole\""},
                                             {"\"map\":\"step\",\"first\":", "\"map\":\"step\",\"first\":-"}};
    (void)state;
    for (size_t k = 0; k < sizeof changes / sizeof *changes; k++)
        refuse_change_of(set_of_axes(20, 70), NULL, changes[k][0], changes[k][1], "not sound");
}

/* Palettes have numbers of the part's type, which ascend. */
static void test_palettes_that_lie_are_refused(void **state)
{
    static const char *const numbers[] = {"[1073741824,1065353216]",
                                          "[1065353216,1065353216]",
                                          "[1065353216,2147483648]",
                                          "[-2147483649,1065353216]",
                                          "[1065353216,1073741824.5]",
                                          "[]",
                                          "1065353216",
                                          "{\"0\":1065353216}"};
    (void)state;
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        char changed[64];
        RetexSet *set = test_set(16, 8, 7);
        const RetexImage *depth = &set->parts[retex_set_find_part(set, "depth")].image;
        for (int i = 0; i < 16 * 8; i++)
            depth->pixels[i] = (float)(1 + i % 2);
        snprintf(changed, sizeof changed, "\"numbers\":%s", numbers[k]);
        refuse_change_of(set, NULL, "\"numbers\":[1065353216,1073741824]", changed, "not sound");
    }
}

static void test_other_zips_are_refused(void **state)
{
    (void)state;
    assert_refused("PK\5\6\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 22); /* an empty zip */
    assert_refused("", 0);
    assert_true(retex_pack_probe("PK\3\4", 4));
    assert_false(retex_pack_probe("PK\3", 3));
    assert_false(retex_pack_probe("\x76\x2f\x31\x01", 4));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_flipped_byte_is_seen),    cmocka_unit_test(test_truncated_packs_are_refused),
        cmocka_unit_test(test_foreign_entries_are_refused),   cmocka_unit_test(test_manifests_that_lie_are_refused),
        cmocka_unit_test(test_other_zips_are_refused),        cmocka_unit_test(test_steps_that_lie_are_refused),
        cmocka_unit_test(test_palettes_that_lie_are_refused),
    };
    return cmocka_run_group_tests_name("pack damage", tests, NULL, NULL);
}
