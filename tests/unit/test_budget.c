/* Limits of memory and time, and the names of files that a process removes when it is ended. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lib_folder.h"
#include "lib_test.h"
#include <cmocka.h>

#include <retex/budget.h>
#include <retex/image.h>
#include <retex/output_file.h>

#include "accel/accel.h"
#include "base/machine.h"
#include "job/job.h"
#include "sdl/lang/parser.h"
#include "sdl/statements.h"
#include "io/pending_files.h"

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

static void test_memory(void **state)
{
    (void)state;
    RetexError err = {0};
    RetexBudget *budget = NULL;
    assert_int_equal(retex_budget_charge(NULL, UINT64_MAX, "nothing", &err), 0);
    retex_budget_release(NULL, 1);
    assert_int_equal(retex_budget_create(&budget, &err), 0);
    assert_true(retex_budget_left(budget) == UINT64_MAX);
    assert_int_equal(retex_budget_charge(budget, 100, "what is there already", &err), 0);
    retex_budget_set_memory(budget, 1000);
    assert_int_equal(retex_budget_left(budget), 900);
    assert_int_equal(retex_budget_charge(budget, 901, "the scene", &err), RETEX_ELIMIT);
    assert_non_null(strstr(err.message, "the scene"));
    assert_non_null(strstr(err.message, "--max-memory"));
    assert_int_equal(retex_budget_left(budget), 900);
    assert_int_equal(retex_budget_charge(budget, 900, "the scene", &err), 0);
    assert_int_equal(retex_budget_charge(budget, 1, "the scene", &err), RETEX_ELIMIT);
    retex_budget_release(budget, 400);
    assert_int_equal(retex_budget_left(budget), 400);
    retex_budget_set_memory(budget, 100); /* less than is used */
    assert_int_equal(retex_budget_left(budget), 0);
    assert_int_equal(retex_budget_charge(budget, UINT64_MAX, "the scene", &err), RETEX_ELIMIT);
    retex_budget_close(&budget);
}

static void test_sizes(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        uint64_t bytes; /* 0: is no size */
    } cases[] = {{"512M", 512ull << 20},
                 {"1G", 1ull << 30},
                 {"1.5g", 3ull << 29},
                 {"2048", 2ull << 30},
                 {"64k", 65536},
                 {"1T", 1ull << 40},
                 {"", 0},
                 {"G", 0},
                 {"-1", 0},
                 {"1GB", 0},
                 {"1 G", 0},
                 {"nan", 0},
                 {"1e30", 0},
                 {" 1", 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint64_t bytes = 0;
        assert_int_equal(retex_size_parse(cases[i].text, &bytes, NULL), cases[i].bytes ? RETEX_OK : RETEX_EPARSE);
        assert_true(bytes == cases[i].bytes);
    }
}

static void test_environment(void **state)
{
    (void)state;
    RetexLimits limits = RETEX_LIMITS_INIT;
    RetexError err = {0};
    setenv("RETEX_MAX_MEMORY", "3G", 1);
    setenv("RETEX_MAX_TIME", "2.5", 1);
    setenv("RETEX_MAX_PIXELS", "1000", 1);
    setenv("RETEX_MAX_STEPS", "", 1);
    assert_int_equal(retex_limits_environment(&limits, &err), 0);
    assert_true(limits.memory == 3ull << 30 && limits.seconds == 2.5 && limits.pixels == 1000);
    assert_int_equal(limits.steps, 200000000);
    setenv("RETEX_MAX_STEPS", "many", 1);
    assert_int_equal(retex_limits_environment(&limits, &err), RETEX_EPARSE);
    assert_string_equal(err.message, "RETEX_MAX_STEPS: expected a whole number from 1, not 'many'");
    unsetenv("RETEX_MAX_MEMORY");
    unsetenv("RETEX_MAX_TIME");
    unsetenv("RETEX_MAX_PIXELS");
    unsetenv("RETEX_MAX_STEPS");
}

/* Safe access has its own limits; what is set by name stays, also where it is the default of other access. */
static void test_safe(void **state)
{
    (void)state;
    static const char *const names[] = {"max-memory", "max-time", "max-pixels", "max-steps"};
    static const char *const values[] = {"3G", "1000", "268435456", "200000000"};
    const uint64_t machine = retex_machine_memory() / 4 * 3, memory = machine < 2ull << 30 ? machine : 2ull << 30;
    RetexError err = {0};
    for (int given = 0; given < 16; given++) {
        RetexLimits limits = RETEX_LIMITS_INIT;
        for (int k = 0; k < 4; k++)
            if (given >> k & 1)
                assert_int_equal(retex_limits_set(&limits, names[k], values[k], &err), 0);
        retex_limits_safe(&limits);
        assert_true(limits.memory == (given & 1 ? 3ull << 30 : memory));
        assert_true(limits.seconds == (given & 2 ? 1000 : 60));
        assert_int_equal(limits.pixels, given & 4 ? 268435456 : 7680 * 4320);
        assert_int_equal(limits.steps, 200000000);
    }
    RetexLimits limits = RETEX_LIMITS_INIT;
    assert_int_equal(retex_limits_set(&limits, "max-time", "soon", &err), RETEX_EPARSE);
    assert_string_equal(err.message, "max-time: expected a number of seconds, not 'soon'");
    assert_int_equal(retex_limits_set(&limits, "max-speed", "1", &err), RETEX_ENOTFOUND);
    setenv("RETEX_MAX_PIXELS", "1000", 1);
    assert_int_equal(retex_limits_environment(&limits, &err), 0);
    unsetenv("RETEX_MAX_PIXELS");
    retex_limits_safe(&limits);
    assert_true(limits.memory == memory && limits.seconds == 60 && limits.pixels == 1000);
    /* of a program that was built before there was a note of what is given */
    RetexLimits old = RETEX_LIMITS_INIT;
    old.size = offsetof(RetexLimits, given), old.given = 0x5a5a;
    assert_int_equal(retex_limits_set(&old, "max-pixels", "7", &err), 0);
    assert_true(old.pixels == 7 && old.given == 0x5a5a);
}

/* A tree of control groups as the kernel shows it: folders with a file each. */
static void put_limit(const char *folder, const char *file, const char *text)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, file);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

static void make_folder(const char *path)
{
    assert_int_equal(mkdir(path, 0777), 0);
}

static void test_control_groups(void **state)
{
    (void)state;
    const char *root = test_in_folder("cgroup");
    char folder[400];
    make_folder(root);
    snprintf(folder, sizeof folder, "%s/a", root);
    make_folder(folder);
    put_limit(folder, "memory.max", "4000\n");
    snprintf(folder, sizeof folder, "%s/a/b", root);
    make_folder(folder);
    put_limit(folder, "memory.max", "max\n");
    snprintf(folder, sizeof folder, "%s/memory", root);
    make_folder(folder);
    put_limit(folder, "memory.limit_in_bytes", "9223372036854771712\n");
    snprintf(folder, sizeof folder, "%s/memory/c", root);
    make_folder(folder);
    put_limit(folder, "memory.limit_in_bytes", "3000\n");
    assert_int_equal(retex_machine_cgroup_memory("0::/a/b\n", root), 4000);
    assert_int_equal(retex_machine_cgroup_memory("0::/a", root), 4000);
    assert_true(retex_machine_cgroup_memory("0::/\n", root) == UINT64_MAX);
    assert_true(retex_machine_cgroup_memory("0::/../../other\n", root) == UINT64_MAX);
    assert_int_equal(retex_machine_cgroup_memory("12:cpu:/a\n5:memory:/c\n0::/\n", root), 3000);
    assert_true(retex_machine_cgroup_memory("", root) == UINT64_MAX);
    assert_true(retex_machine_cgroup_memory("nonsense\n::\n", root) == UINT64_MAX);
    assert_true(retex_machine_memory() > 1 << 20);
    static const char *const made[] = {"a/b/memory.max",
                                       "a/b",
                                       "a/memory.max",
                                       "a",
                                       "memory/c/memory.limit_in_bytes",
                                       "memory/c",
                                       "memory/memory.limit_in_bytes",
                                       "memory",
                                       ""};
    for (size_t i = 0; i < sizeof made / sizeof *made; i++) {
        snprintf(folder, sizeof folder, "%s/%s", root, made[i]);
        assert_int_equal(remove(folder), 0);
    }
}

/* Everything that a scene takes is charged while it is there, Embree's part too, and given back. */
static void test_scene_is_charged(void **state)
{
    (void)state;
    const char *path = test_in_folder("many.pov");
    FILE *file = fopen(path, "w");
    fputs("#for(I,1,3000) sphere{<mod(I,50),div(I,50),0>,.4} box{I*x, I*x+y} #end", file);
    fclose(file);
    RetexError err = {0};
    RetexBudget *budget = NULL;
    SdlOptions options = SDL_OPTIONS_INIT;
    Scene *scene = NULL;
    Accel *accel = NULL;
    assert_int_equal(retex_budget_create(&budget, &err), 0);
    options.budget = budget;
    retex_budget_set_memory(budget, 1 << 20);
    assert_int_equal(sdl_read(&scene, path, &options, &scene_builder, &err), RETEX_ELIMIT);
    assert_non_null(strstr(err.message, "--max-memory"));
    assert_int_equal(retex_budget_left(budget), 1 << 20);
    retex_budget_set_memory(budget, 1 << 28);
    test_must(sdl_read(&scene, path, &options, &scene_builder, &err), &err);
    const uint64_t after_scene = retex_budget_left(budget);
    assert_true(after_scene < 1 << 28);
    test_must(accel_create_within(&accel, scene, 2, budget, &err), &err);
    const uint64_t geometry = after_scene - retex_budget_left(budget);
    assert_true(geometry > 1 << 20);
    accel_close(&accel);
    assert_int_equal(retex_budget_left(budget), after_scene);
    for (int part = 1; part < 8; part++) { /* wherever on the way it is too much */
        retex_budget_set_memory(budget, (1 << 28) - after_scene + geometry * (uint64_t)part / 9);
        const uint64_t left = retex_budget_left(budget);
        assert_int_equal(accel_create_within(&accel, scene, 2, budget, &err), RETEX_ELIMIT);
        assert_non_null(strstr(err.message, "--max-memory"));
        assert_null(accel);
        assert_int_equal(retex_budget_left(budget), left);
    }
    retex_budget_set_memory(budget, 0);
    retex_budget_stop(budget);
    assert_int_equal(accel_create_within(&accel, scene, 2, budget, &err), RETEX_ESTOPPED);
    scene_close(&scene);
    retex_budget_set_memory(budget, 1 << 28);
    assert_int_equal(retex_budget_left(budget), 1 << 28);
    retex_budget_close(&budget);
}

/* What is too large to be rendered is refused beforehand: by the limit, or where there is none by the machine. */
static void test_size_is_checked(void **state)
{
    (void)state;
    RetexError err = {0};
    RetexBudget *budget = NULL;
    Scene scene = {.width = 2000, .height = 1000};
    RenderParams params = RENDER_PARAMS_INIT;
    params.plain = 1;
    test_must(job_check_size(&scene, &params, &err), &err);
    assert_int_equal(retex_budget_create(&budget, &err), 0);
    params.budget = budget;
    test_must(job_check_size(&scene, &params, &err), &err);
    retex_budget_set_memory(budget, 1 << 20);
    assert_int_equal(job_check_size(&scene, &params, &err), RETEX_ELIMIT);
    assert_non_null(strstr(err.message, "--max-memory"));
    retex_budget_set_memory(budget, 0);
    retex_budget_set_pixels(budget, 1999999);
    assert_int_equal(job_check_size(&scene, &params, &err), RETEX_ELIMIT);
    assert_non_null(strstr(err.message, "--max-pixels"));
    retex_budget_set_pixels(budget, 0);
    params.width = params.height = 50000000;
    assert_int_equal(job_check_size(&scene, &params, &err), RETEX_ENOMEM);
    assert_null(strstr(err.message, "--max-memory"));
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
        RetexPendingFile files[3];
        const char *names[] = {"first", "finished", "last"};
        retex_pending_files_lock();
        for (int i = 0; i < 3; i++) {
            touch(names[i]);
            retex_pending_files_add(&files[i], names[i]);
        }
        retex_pending_files_drop(&files[1]);
        retex_pending_files_drop(&files[1]);
        retex_pending_files_unlock();
        retex_pending_files_remove();
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
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_environment),
        cmocka_unit_test(test_safe),
        cmocka_unit_test(test_control_groups),
        cmocka_unit_test(test_scene_is_charged),
        cmocka_unit_test(test_size_is_checked),
        cmocka_unit_test(test_unfinished_files_go),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
