/* Which paths lead to the same file, whether it exists or not, and which files one command may read and write. */
#include "lib_test.h"
#include "lib_folder.h"
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/cli.h"

typedef struct Path {
    const char *path;
    int place; /* paths with the same number lead to one file; 0: to none that could be overwritten */
} Path;

static const Path paths[] = {
    {"there", 1},
    {"./there", 1},
    {"sub/../there", 1},
    {"soft", 1},
    {"hard", 1},
    {"sub/up", 1},
    {"missing", 2},
    {"./missing", 2},
    {"sub/..//missing", 2},
    {"dangling", 2},
    {"chain", 2},
    {"sub/missing", 3},
    {"sub/./missing", 3},
    {"folder/missing", 3},
    {"sub/dangling", 2},
    {"new/missing", 4},
    {"./new//missing", 4},
    {"new/./missing", 4},
    {"new/other", 5},
    {"missing2", 6},
    {"loop", 7},
    {"/dev/null", 0},
    {"sub", 0},
    {"pipe", 0},
    {"", 0},
};
enum { PATHS = sizeof paths / sizeof *paths };

static int make_files(void **state)
{
    int failed = test_make_folder(state) || chdir(test_folder) || mkdir("sub", 0777) || mkfifo("pipe", 0666);
    FILE *file = fopen("there", "w");
    failed |= !file || fclose(file) || link("there", "hard") || symlink("there", "soft");
    failed |= symlink("../there", "sub/up") || symlink("missing", "dangling") || symlink("dangling", "chain");
    failed |= symlink("../missing", "sub/dangling") || symlink("sub", "folder") || symlink("loop", "loop");
    return failed;
}

/* What is known of files stays for the life of a process: each case has one of its own. */
static int refused(const char *a, int a_written, const char *b, int b_written)
{
    RetexError err = {0};
    int status = -1;
    pid_t child = fork();
    if (child == 0) {
        int code = a_written ? cli_add_output("A", a, &err) : cli_add_input("A", a, &err);
        if (code)
            _exit(2);
        code = b_written ? cli_add_output("B", b, &err) : cli_add_input("B", b, &err);
        _exit(code != 0);
    }
    assert_true(child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status));
    assert_in_range(WEXITSTATUS(status), 0, 1);
    return WEXITSTATUS(status);
}

static void test_pairs(void **state)
{
    (void)state;
    for (int i = 0; i < PATHS; i++)
        for (int k = 0; k < PATHS; k++) {
            int same = paths[i].place && paths[i].place == paths[k].place;
            if (refused(paths[i].path, 1, paths[k].path, 1) != same)
                fail_msg("'%s' and '%s'", paths[i].path, paths[k].path);
        }
    for (int k = 0; k < PATHS; k++) {
        assert_int_equal(refused("there", 0, paths[k].path, 1), paths[k].place == 1);
        assert_int_equal(refused(paths[k].path, 1, "missing", 0), paths[k].place == 2);
        assert_int_equal(refused("there", 0, paths[k].path, 0), 0);
    }
}

static void test_standard_streams(void **state)
{
    (void)state;
    assert_int_equal(refused("-", 0, "-", 0), 1);
    assert_int_equal(refused("-", 1, "-", 1), 1);
    assert_int_equal(refused("-", 0, "-", 1), 0);
    assert_int_equal(refused("/dev/stdin", 0, "-", 0), 1);
    assert_int_equal(refused("-", 1, "/dev/stdout", 1), 1);
    assert_int_equal(refused("/dev/stdin", 0, "/proc/self/fd/1", 1), 0);
    assert_int_equal(refused(NULL, 0, NULL, 1), 0);
}

/* Standard input may be a file that has a name. */
static void test_redirected_input(void **state)
{
    (void)state;
    int before = dup(STDIN_FILENO);
    assert_non_null(freopen("there", "r", stdin));
    assert_int_equal(refused("-", 0, "soft", 1), 1);
    assert_int_equal(refused("-", 0, "missing", 1), 0);
    assert_int_equal(dup2(before, STDIN_FILENO), STDIN_FILENO);
    close(before);
}

static void test_many(void **state)
{
    (void)state;
    enum { COUNT = 5000 };
    char path[64];
    RetexError err;
    for (int k = 0; k < COUNT; k++) {
        snprintf(path, sizeof path, "sub/many-%d.png", k);
        assert_int_equal(cli_add_output("A", path, &err), RETEX_OK);
        assert_int_equal(cli_add_input("B", "there", &err), RETEX_OK);
    }
    for (int k = 0; k < COUNT; k++) {
        snprintf(path, sizeof path, "folder/many-%d.png", k);
        assert_int_equal(cli_add_output("B", path, &err), RETEX_EINVAL);
        assert_int_equal(cli_add_input("B", path, &err), RETEX_EINVAL);
    }
}

static int remove_files(void **state)
{
    unlink("sub/up");
    unlink("sub/dangling");
    return rmdir("sub") || chdir("/") || test_remove_folder(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pairs),
        cmocka_unit_test(test_standard_streams),
        cmocka_unit_test(test_redirected_input),
        cmocka_unit_test(test_many),
    };
    return cmocka_run_group_tests_name("cli_files", tests, make_files, remove_files);
}
