/* Folders that strangers have filled: links at every place of a path are met, and nothing outside is opened or made. */
#include "lib_test.h"
#include "lib_folder.h"
#include <cmocka.h>

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/beneath.h"

static char folder[PATH_MAX]; /* the current one */

static int enter_folder(void **state)
{
    return test_make_folder(state) || !realpath(test_folder, folder) || chdir(folder);
}

static int leave_folder(void **state)
{
    return chdir("/") || test_remove_folder(state);
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

/* top/a/b/file, and mine/b/file outside */
static void make_tree(void)
{
    const char *const folders[] = {"top", "top/a", "top/a/b", "mine", "mine/b"};
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
        assert_int_equal(mkdir(folders[i], 0777), 0);
    write_text("top/a/b/file", "theirs");
    write_text("mine/b/file", "mine");
}

static void expect_text(int file, const char *text)
{
    char got[16] = "";
    assert_true(file >= 0);
    assert_true(read(file, got, sizeof got - 1) >= 0);
    close(file);
    assert_string_equal(got, text);
}

static void expect_refused(int file, int why)
{
    const int got = errno;
    assert_int_equal(file, -1);
    assert_int_equal(got, why);
}

static void test_top(void **state)
{
    (void)state;
    make_tree();
    assert_int_equal(symlink("mine", "link"), 0);
    assert_int_equal(symlink("nowhere", "dangling"), 0);
    assert_int_equal(symlink(".", "here"), 0);
    const char *const refused[] = {"link", "link/", "link//", "dangling", "here/link"};
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
        for (int may_make = 0; may_make < 2; may_make++)
            expect_refused(beneath_open_top(refused[i], may_make), ELOOP);
    assert_int_equal(access("nowhere", F_OK), -1);
    expect_refused(beneath_open_top("mine/b/file", 1), ENOTDIR);
    expect_refused(beneath_open_top("new", 0), ENOENT);
    expect_refused(beneath_open_top("", 1), ENOENT);
    const char *const taken[] = {"top", "top/", "here/top", "new"}; /* links above are the user's */
    for (size_t i = 0; i < sizeof taken / sizeof *taken; i++) {
        const int top = beneath_open_top(taken[i], 1);
        assert_true(top >= 0);
        close(top);
    }
}

/* Each part of the path in turn becomes a link to what is outside. */
static void test_links(void **state)
{
    const char *const parts[] = {"top/a", "top/a/b", "top/a/b/file"}, *const leads[] = {"../mine", "../../mine/b",
                                                                                        "../../../mine/b/file"};
    const char *last;
    (void)state;
    make_tree();
    const int top = beneath_open_top("top", 0);
    expect_text(beneath_open(top, "a/b/file", O_RDONLY, 0), "theirs");
    expect_text(beneath_open(top, "./a//b/./file", O_RDONLY, 0), "theirs");
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(rename(parts[i], "kept"), 0);
        assert_int_equal(symlink(leads[i], parts[i]), 0);
        expect_text(open("top/a/b/file", O_RDONLY | O_CLOEXEC), "mine");
        expect_refused(beneath_open(top, "a/b/file", O_RDONLY, 0), ELOOP);
        expect_refused(beneath_open(top, "a/b/file", O_WRONLY | O_CREAT | O_TRUNC, 0666), ELOOP);
        expect_refused(beneath_open(top, "a/b/file/", O_RDONLY, 0), ELOOP);
        if (i < 2)
            expect_refused(beneath_open_parent(top, "a/b/c/file", 1, &last), ELOOP);
        assert_int_equal(unlink(parts[i]), 0);
        assert_int_equal(rename("kept", parts[i]), 0);
    }
    expect_text(open("mine/b/file", O_RDONLY | O_CLOEXEC), "mine");
    assert_int_equal(access("mine/b/c", F_OK), -1);
    close(top);
}

static void test_names(void **state)
{
    char long_name[NAME_MAX + 8];
    const char *last;
    (void)state;
    make_tree();
    memset(long_name, 'x', sizeof long_name - 1);
    long_name[sizeof long_name - 1] = 0;
    const int top = beneath_open_top("top", 0);
    const char *const out[] = {"..", "../mine/b/file", "a/../../mine/b/file", "a/..", "/", "/etc/passwd"};
    for (size_t i = 0; i < sizeof out / sizeof *out; i++) {
        expect_refused(beneath_open(top, out[i], O_RDONLY, 0), EXDEV);
        expect_refused(beneath_open_parent(top, out[i], 1, &last), EXDEV);
    }
    expect_refused(beneath_open(top, long_name, O_RDONLY, 0), ENAMETOOLONG);
    expect_refused(beneath_open(top, "a/b/file/x", O_RDONLY, 0), ENOTDIR);
    expect_refused(beneath_open_parent(top, "c/file", 0, &last), ENOENT);
    const int made = beneath_open_parent(top, "c/d/..x", 1, &last);
    assert_true(made >= 0);
    assert_string_equal(last, "..x");
    close(openat(made, last, O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
    close(made);
    assert_int_equal(access("top/c/d/..x", F_OK), 0);
    const int self = beneath_open(top, "", O_RDONLY | O_DIRECTORY, 0);
    struct stat a, b;
    assert_int_equal(fstat(self, &a) | fstat(top, &b), 0);
    assert_true(a.st_ino == b.st_ino);
    close(self);
    close(top);
}

static void test_find_link(void **state)
{
    char found[PATH_MAX];
    const char *const places[] = {"top/l", "top/a/l", "top/a/b/l"};
    (void)state;
    make_tree();
    const int top = beneath_open_top("top", 0);
    assert_int_equal(beneath_find_link(top, found), 0);
    for (size_t i = 0; i < sizeof places / sizeof *places; i++)
        for (int k = 0; k < 2; k++) {
            assert_int_equal(symlink(k ? "/" : "nowhere", places[i]), 0);
            assert_int_equal(beneath_find_link(top, found), 1);
            assert_string_equal(found, places[i] + 4);
            assert_int_equal(unlink(places[i]), 0);
        }
    assert_int_equal(beneath_find_link(top, found), 0);
    assert_int_equal(beneath_find_link(-1, found), -1);
    close(top);
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, enter_folder, leave_folder)
    const struct CMUnitTest tests[] = {
        IN_FOLDER(test_top),
        IN_FOLDER(test_links),
        IN_FOLDER(test_names),
        IN_FOLDER(test_find_link),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
