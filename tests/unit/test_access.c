/* Which files may be read: folders, links, `..`, and names whose meaning changes meanwhile. */
#include "lib_folder.h"
#include "lib_test.h"
#include <cmocka.h>

#include <fcntl.h>
#include <ftw.h>
#include <limits.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/access.h>

#include "picture/image_format.h"

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* top/base with a file and a folder in it; beside it a folder whose name begins alike; and links of all kinds. */
static char top[PATH_MAX], root[PATH_MAX + 8];

static int make_tree(void **state)
{
    if (test_make_folder(state) || !realpath(test_folder, top) || chdir(top))
        return -1;
    snprintf(root, sizeof root, "%s/base", top);
    mkdir("base", 0777), mkdir("base/sub", 0777), mkdir("baseless", 0777), mkdir("baseless/sub", 0777);
    write_text("base/file", "I"), write_text("base/sub/file", "I"), write_text("baseless/file", "O");
    write_text("above", "O"), write_text("baseless/sub/file", "O");
    return symlink("sub/file", "base/within") || symlink("../above", "base/away") || symlink(top, "base/up") ||
           symlink("../baseless/none", "base/dangling") || symlink("none", "base/nowhere") ||
           symlink("base", "to-base") || mkfifo("base/pipe", 0666);
}

static int remove_entry(const char *path, const struct stat *info, int type, struct FTW *where)
{
    (void)info, (void)type, (void)where;
    return remove(path);
}

static int remove_tree(void **state)
{
    (void)state;
    return chdir("/") || nftw(test_folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

static void test_answers(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        RetexAccessResult plain, safe;
    } cases[] = {
        {"file", RETEX_ACCESS_ALLOWED, RETEX_ACCESS_ALLOWED},
        {"sub/file", RETEX_ACCESS_ALLOWED, RETEX_ACCESS_ALLOWED},
        {"sub/../file", RETEX_ACCESS_ALLOWED, RETEX_ACCESS_ALLOWED},
        {"./sub//./file", RETEX_ACCESS_ALLOWED, RETEX_ACCESS_ALLOWED},
        {"within", RETEX_ACCESS_ALLOWED, RETEX_ACCESS_ALLOWED},
        {"none", RETEX_ACCESS_ABSENT, RETEX_ACCESS_ABSENT},
        {"sub/none", RETEX_ACCESS_ABSENT, RETEX_ACCESS_ABSENT},
        {"file/file", RETEX_ACCESS_ABSENT, RETEX_ACCESS_ABSENT},
        {".", RETEX_ACCESS_IRREGULAR, RETEX_ACCESS_IRREGULAR},
        {"sub", RETEX_ACCESS_IRREGULAR, RETEX_ACCESS_IRREGULAR},
        {"pipe", RETEX_ACCESS_IRREGULAR, RETEX_ACCESS_IRREGULAR},
        {"../above", RETEX_ACCESS_OUTSIDE, RETEX_ACCESS_OUTSIDE},
        {"../baseless/file", RETEX_ACCESS_OUTSIDE, RETEX_ACCESS_OUTSIDE},
        {"away", RETEX_ACCESS_OUTSIDE, RETEX_ACCESS_OUTSIDE},
        {"up/above", RETEX_ACCESS_OUTSIDE, RETEX_ACCESS_OUTSIDE},
        /* of what is outside, safe access does not tell whether it is there */
        {"../none", RETEX_ACCESS_ABSENT, RETEX_ACCESS_OUTSIDE},
        {"up/none", RETEX_ACCESS_ABSENT, RETEX_ACCESS_OUTSIDE},
        {"dangling", RETEX_ACCESS_ABSENT, RETEX_ACCESS_OUTSIDE},
        {"nowhere", RETEX_ACCESS_ABSENT, RETEX_ACCESS_OUTSIDE},
        {"../base/file", RETEX_ACCESS_ALLOWED, RETEX_ACCESS_OUTSIDE},
        {"../baseless/../base/file", RETEX_ACCESS_ALLOWED, RETEX_ACCESS_OUTSIDE},
        {"up/base/file", RETEX_ACCESS_ALLOWED, RETEX_ACCESS_OUTSIDE},
    };
    static const char *const spellings[] = {"base", "base/", "./base/", "to-base", ""};
    const char *roots[] = {root};
    RetexAccess access = RETEX_ACCESS_INIT;
    access.roots = roots, access.nroots = 1;
    for (size_t s = 0; s < sizeof spellings / sizeof *spellings; s++) {
        assert_int_equal(chdir(*spellings[s] ? top : root), 0);
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
            for (access.safe = 0; access.safe < 2; access.safe++) {
                RetexAccessResult answer = retex_access_check(&access, spellings[s], cases[i].name);
                if (answer != (access.safe ? cases[i].safe : cases[i].plain))
                    fail_msg("`%s` of `%s`, safe %d: %d", cases[i].name, spellings[s], access.safe, (int)answer);
            }
    }
    assert_int_equal(chdir(top), 0);
}

static void test_absolute_names(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        RetexAccessResult safe;
    } cases[] = {
        {"/base/file", RETEX_ACCESS_ALLOWED},
        {"/to-base/file", RETEX_ACCESS_ALLOWED},
        {"/base/none", RETEX_ACCESS_ABSENT},
        {"/base", RETEX_ACCESS_IRREGULAR},
        {"/baseless/file", RETEX_ACCESS_OUTSIDE},
        {"/baseless", RETEX_ACCESS_OUTSIDE},
        {"/above", RETEX_ACCESS_OUTSIDE},
        {"/none", RETEX_ACCESS_OUTSIDE},
        {"/baseless/../base/file", RETEX_ACCESS_OUTSIDE},
        {"/none/../base/file", RETEX_ACCESS_OUTSIDE},
        {"/base/../above", RETEX_ACCESS_OUTSIDE},
        {"/base/up/base/file", RETEX_ACCESS_OUTSIDE},
    };
    const char *roots[] = {root}, *all[] = {"/"};
    RetexAccess access = {sizeof access, 1, roots, 1, 0};
    char name[PATH_MAX + 64];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        snprintf(name, sizeof name, "%s%s", top, cases[i].name);
        RetexAccessResult answer = retex_access_check(&access, "base", name);
        if (answer != cases[i].safe)
            fail_msg("`%s`: %d", cases[i].name, (int)answer);
    }
    assert_int_equal(retex_access_check(&access, "base", "/"), RETEX_ACCESS_OUTSIDE);
    assert_int_equal(retex_access_check(&access, "base", "/etc/passwd"), RETEX_ACCESS_OUTSIDE);
    access.roots = all;
    assert_int_equal(retex_access_check(&access, "/", "etc/passwd"), RETEX_ACCESS_ALLOWED);
    assert_int_equal(retex_access_check(&access, "base", "../above"), RETEX_ACCESS_ALLOWED);
    access.nroots = 0; /* a folder that is not there is no leave to read everything */
    assert_int_equal(retex_access_check(&access, "/", "etc/passwd"), RETEX_ACCESS_OUTSIDE);
    access.roots = NULL;
    assert_int_equal(retex_access_check(&access, "", "above"), RETEX_ACCESS_ALLOWED);
    assert_int_equal(retex_access_check(NULL, "", "base/pipe"), RETEX_ACCESS_IRREGULAR);
}

/* The file's letter, or the negative code. */
static int opened(const RetexAccess *access, const char *path)
{
    char letter = 0;
    int file = -1, code = retex_access_open(access, path, &file, NULL);
    if (code)
        return code;
    assert_int_equal(read(file, &letter, 1), 1);
    close(file);
    return letter;
}

static void test_open(void **state)
{
    (void)state;
    const char *roots[] = {root};
    RetexAccess access = {sizeof access, 1, roots, 1, 0};
    assert_int_equal(opened(&access, "base/file"), 'I');
    assert_int_equal(opened(&access, "base/within"), 'I');
    assert_int_equal(opened(&access, "to-base/sub/../file"), 'I');
    assert_int_equal(opened(&access, "base/none"), RETEX_EIO);
    assert_int_equal(opened(&access, "base/away"), RETEX_EACCESS);
    assert_int_equal(opened(&access, "baseless/file"), RETEX_EACCESS);
    assert_int_equal(opened(&access, "base/pipe"), RETEX_EACCESS);
    assert_int_equal(opened(&access, "base"), RETEX_EACCESS);
    access.roots = NULL;
    assert_int_equal(opened(&access, "baseless/file"), 'O');
    assert_int_equal(opened(&access, "/dev/zero"), RETEX_EACCESS);
    assert_int_equal(opened(NULL, "above"), 'O');
}

/* A folder becomes a link that leads out, and a folder again, all the time. */
static atomic_int ended;

static void *exchange(void *unused)
{
    while (!atomic_load(&ended))
        if (renameat2(AT_FDCWD, "base/sub", AT_FDCWD, "base/out", RENAME_EXCHANGE))
            break;
    return unused;
}

static void test_what_is_read_was_checked(void **state)
{
    (void)state;
    const char *roots[] = {root};
    RetexAccess access = {sizeof access, 1, roots, 1, 0};
    pthread_t thread;
    int read_inside = 0;
    assert_int_equal(symlink("../baseless/sub", "base/out"), 0);
    atomic_store(&ended, 0);
    assert_int_equal(pthread_create(&thread, NULL, exchange, NULL), 0);
    for (int i = 0; i < 20000; i++) {
        int letter = opened(&access, "base/sub/file");
        read_inside += letter == 'I';
        if (letter == 'O')
            fail_msg("turn %d: a file from outside", i);
    }
    atomic_store(&ended, 1);
    pthread_join(thread, NULL);
    assert_true(read_inside > 0);
    unlink("base/out"), unlink("base/sub"); /* one of them is the link */
}

/* The first bytes of a file, and OpenImageIO's name of the format. */
static void test_formats(void **state)
{
    (void)state;
    static const struct {
        const char *name, *format;
        unsigned char bytes[64];
        size_t size;
    } cases[] = {
        {"a", "png", "\x89PNG\r\n\x1a\n", 8},
        {"a", NULL, "\x89PNG\n\n\x1a\n", 8},
        {"a.png", NULL, "plain text", 10},
        {"a", "jpeg", "\xff\xd8\xff\xe0", 4},
        {"a", NULL, "\xff\xd8", 2},
        {"a", "openexr", "\x76\x2f\x31\x01\x02", 8},
        {"a", "gif", "GIF89a", 6},
        {"a", NULL, "GIF88a", 6},
        {"a", "hdr", "#?RADIANCE\n", 11},
        {"a", "hdr", "#?RGBE\n", 7},
        {"a", NULL, "#!/bin/sh", 9},
        {"a", "tiff", "II*\0\x08\0\0\0", 8},
        {"a", "tiff", "MM\0*\0\0\0\x08", 8},
        {"a", "tiff", "MM\0+\0\x08\0\0", 8},
        {"a", NULL, "MM*\0", 8},
        {"a", "bmp", "BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0", 54},
        {"a", NULL, "BMW, not a picture at all", 25},
        {"a.ppm", NULL, "P6\n1 1\n255\nabc", 14},
        {"a.dpx", NULL, "SDPX", 32},
        {"a", NULL, "", 0},
        /* 4 x 2 pixels of 24 bits: 18 + 24 bytes */
        {"a.tga", "targa", "\0\0\2\0\0\0\0\0\0\0\0\0\4\0\2\0\x18", 42},
        {"a.TGA", "targa", "\0\0\2\0\0\0\0\0\0\0\0\0\4\0\2\0\x18", 43},
        {"a.tga", NULL, "\0\0\2\0\0\0\0\0\0\0\0\0\4\0\2\0\x18", 41},
        {"a.tgb", NULL, "\0\0\2\0\0\0\0\0\0\0\0\0\4\0\2\0\x18", 42},
        {"a", "targa", "\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x18\0abc\0\0\0\0\0\0\0\0TRUEVISION-XFILE.", 47},
        {"a.tga", NULL, "\0\0\4\0\0\0\0\0\0\0\0\0\4\0\2\0\x18", 42},      /* no such type */
        {"a.tga", NULL, "\0\0\2\0\0\0\0\0\0\0\0\0\0\0\2\0\x18", 42},      /* no width */
        {"a.tga", NULL, "\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x17", 42},      /* 23 bits */
        {"a.tga", NULL, "\0\0\1\0\0\0\0\0\0\0\0\0\4\0\2\0\x08", 42},      /* a palette's picture without a palette */
        {"a.tga", "targa", "\0\1\1\0\0\2\0\x18\0\0\0\0\4\0\2\0\x08", 32}, /* with one of two colours */
        {"a.tga", NULL, "\0\1\1\0\0\2\0\x18\0\0\0\0\4\0\2\0\x08", 31},
        {"a.tga", "targa", "\0\0\x0a\0\0\0\0\0\0\0\0\0\4\0\2\0\x20", 24}, /* packed: as little as may be */
        {"a.tga", "targa", "\0\0\3\0\0\0\0\0\0\0\0\0\4\0\2\0\x08", 26},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        RetexInput *input = NULL;
        assert_int_equal(retex_input_borrow(&input, cases[i].bytes, cases[i].size, cases[i].name, NULL), 0);
        const char *format = retex_image_format(input);
        if (strcmp(format ? format : "none", cases[i].format ? cases[i].format : "none") != 0)
            fail_msg("case %zu, %s: %s", i, cases[i].name, format ? format : "none");
        retex_input_close(&input);
    }
}

static void test_header_pixels(void **state)
{
    (void)state;
    static const struct {
        const char *format;
        unsigned char bytes[32];
        uint64_t pixels;
    } cases[] = {
        {"gif", "GIF89a\x10\x27\x20\x4e", 10000 * 20000},
        {"bmp", "BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x03\0\0\0\x05\0\0\0", 15},
        {"bmp", "BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x03\0\0\0\xfb\xff\xff\xff", 15},
        {"bmp", "BM\0\0\0\0\0\0\0\0\x1a\0\0\0\x0c\0\0\0\x03\0\x05", 15},
        {"png", "\x89PNG\r\n\x1a\n", 0},
        {NULL, "GIF89a\x10\x27\x20\x4e", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        RetexInput *input = NULL;
        assert_int_equal(retex_input_borrow(&input, cases[i].bytes, sizeof cases[i].bytes, "a", NULL), 0);
        assert_int_equal(retex_image_header_pixels(input, cases[i].format), cases[i].pixels);
        retex_input_close(&input);
    }
}

static void test_environment(void **state)
{
    (void)state;
    static const char *const on[] = {"1", "yes", "2", "false"};
    unsetenv("RETEX_SAFE");
    assert_int_equal(retex_access_safe_requested(), 0);
    setenv("RETEX_SAFE", "", 1);
    assert_int_equal(retex_access_safe_requested(), 0);
    setenv("RETEX_SAFE", "0", 1);
    assert_int_equal(retex_access_safe_requested(), 0);
    for (size_t i = 0; i < sizeof on / sizeof *on; i++) {
        setenv("RETEX_SAFE", on[i], 1);
        assert_int_equal(retex_access_safe_requested(), 1);
    }
    unsetenv("RETEX_SAFE");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_answers),     cmocka_unit_test(test_absolute_names),
        cmocka_unit_test(test_open),        cmocka_unit_test(test_what_is_read_was_checked),
        cmocka_unit_test(test_formats),     cmocka_unit_test(test_header_pixels),
        cmocka_unit_test(test_environment),
    };
    return cmocka_run_group_tests(tests, make_tree, remove_tree);
}
