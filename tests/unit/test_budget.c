/* What work may take, and the names of files that a process leaves when it is ended. */
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lib_test.h"
#include <cmocka.h>

#include <retex/budget.h>
#include <retex/image.h>

#include "unfinished.h"

static void test_stop(void **state)
{
    (void)state;
    RetexError err = {0};
    RetexBudget *budget = NULL;
    assert_int_equal(retex_budget_check(NULL, &err), 0);
    assert_int_equal(retex_budget_create(&budget, &err), 0);
    assert_int_equal(retex_budget_check(budget, &err), 0);
    retex_budget_stop(budget);
    assert_int_equal(retex_budget_is_stopped(budget), 1);
    assert_int_equal(retex_budget_check(budget, &err), RETEX_ESTOPPED);
    retex_budget_close(&budget);
    assert_null(budget);
}

static void test_seconds(void **state)
{
    (void)state;
    RetexError err = {0};
    RetexBudget *budget = NULL;
    assert_int_equal(retex_budget_create(&budget, &err), 0);
    retex_budget_set_seconds(budget, 1000);
    assert_int_equal(retex_budget_check(budget, &err), 0);
    retex_budget_set_seconds(budget, 0.01);
    usleep(20000);
    assert_int_equal(retex_budget_check(budget, &err), RETEX_ELIMIT);
    assert_non_null(strstr(err.message, "max-time"));
    retex_budget_set_seconds(budget, 0);
    assert_int_equal(retex_budget_check(budget, &err), 0);
    retex_budget_close(&budget);
}

static void touch(const char *path)
{
    close(open(path, O_WRONLY | O_CREAT, 0666));
}

/* In another process, for the names' lock is never given back. */
static void test_unfinished_files_go(void **state)
{
    (void)state;
    char folder[] = "/tmp/test_budget-XXXXXX";
    assert_non_null(mkdtemp(folder));
    assert_int_equal(chdir(folder), 0);
    const pid_t child = fork();
    if (!child) {
        Unfinished files[3];
        const char *names[] = {"first", "finished", "last"};
        unfinished_lock();
        for (int i = 0; i < 3; i++) {
            touch(names[i]);
            unfinished_add(&files[i], names[i]);
        }
        unfinished_drop(&files[1]);
        unfinished_drop(&files[1]);
        unfinished_unlock();
        retex_unfinished_remove();
        _exit(0);
    }
    int status = -1;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    assert_int_equal(access("first", F_OK), -1);
    assert_int_equal(access("last", F_OK), -1);
    assert_int_equal(access("finished", F_OK), 0);
    unlink("finished");
    assert_int_equal(chdir("/"), 0);
    rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stop),
        cmocka_unit_test(test_seconds),
        cmocka_unit_test(test_unfinished_files_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
