/* What a confined process can still do, and what not. Each test runs in a child, which ends with the number of the line
 * that did not hold. Skipped where the kernel has no such layer. */
#include "lib_folder.h"
#include "lib_test.h"
#include <cmocka.h>

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/confine.h"

#define HOLDS(what)                                                                                                    \
    do {                                                                                                               \
        if (!(what))                                                                                                   \
            return __LINE__;                                                                                           \
    } while (0)

/* The layers that are there, by trying. */
static int layers;

static int try_layers(void)
{
    return confine_to_open_files();
}

static int run(int (*body)(void))
{
    int status = 0;
    fflush(NULL);
    const pid_t pid = fork();
    if (pid == 0)
        _exit(body() % 251); /* lines of this file, and 0 */
    assert_int_equal(waitpid(pid, &status, 0), pid);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static int fails(long result)
{
    return result == -1 && (errno == EPERM || errno == EACCES);
}

static void *add_one(void *number)
{
    ++*(int *)number;
    return NULL;
}

static int works_as_process(void)
{
    pthread_t thread;
    int number = 0;
    char *memory = malloc(1 << 26);
    HOLDS(memory);
    memset(memory, 1, 1 << 26);
    free(memory);
    HOLDS(pthread_create(&thread, NULL, add_one, &number) == 0);
    HOLDS(pthread_join(thread, NULL) == 0 && number == 1);
    return 0;
}

static int has_no_rights(void)
{
    char *arguments[] = {(char *)"true", NULL};
    HOLDS(fails(socket(AF_INET, SOCK_STREAM, 0)));
    HOLDS(fails(socket(AF_UNIX, SOCK_STREAM, 0)));
    HOLDS(fails(fork()));
    HOLDS(fails(execv("/bin/true", arguments)));
    HOLDS(fails(kill(getppid(), 0)));
    return 0;
}

static int test_open_files(void)
{
    char text[16];
    int ends[2];
    const int before = open("/proc/self/exe", O_RDONLY);
    HOLDS(before >= 0 && pipe(ends) == 0);
    confine_to_open_files();
    HOLDS(read(before, text, 4) == 4 && memcmp(text, "\177ELF", 4) == 0);
    HOLDS(lseek(before, 0, SEEK_SET) == 0);
    HOLDS(fails(open("/dev/null", O_RDONLY)));
    HOLDS(fails(open(test_own_file, O_WRONLY | O_CREAT, 0600)));
    HOLDS(fails(unlink("/proc/self/exe")));
    if (layers & CONFINE_CALLS) {
        HOLDS(fails(write(ends[1], "x", 1)));
        HOLDS(mmap(NULL, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) == MAP_FAILED);
        HOLDS(fails(mprotect((void *)((uintptr_t)text & ~4095ul), 4096, PROT_READ | PROT_WRITE | PROT_EXEC)));
        const int line = has_no_rights();
        HOLDS(fcntl(before, F_SETOWN, getpid()) != 0);
        return line ? line : works_as_process();
    }
    return works_as_process();
}

static int test_output(void)
{
    int ends[2];
    char text[2];
    HOLDS(pipe(ends) == 0 && dup2(ends[1], STDOUT_FILENO) == STDOUT_FILENO);
    confine_to_open_files();
    HOLDS(write(STDOUT_FILENO, "ok", 2) == 2);
    HOLDS(read(ends[0], text, 2) == 2 && memcmp(text, "ok", 2) == 0);
    return 0;
}

static int test_one_folder(void)
{
    char inside[128];
    snprintf(inside, sizeof inside, "%s/folder/in", test_folder);
    confine_to_folder(test_in_folder("folder"));
    FILE *file = fopen("/proc/self/statm", "r");
    HOLDS(file && fclose(file) == 0);
    file = fopen(inside, "w");
    HOLDS(file && fputs("x", file) >= 0 && fclose(file) == 0);
    HOLDS(rename(inside, test_in_folder("folder/other")) == 0);
    HOLDS(mkdir(inside, 0700) == 0);
    if (layers & CONFINE_FILES) {
        HOLDS(fails(open(test_in_folder("out"), O_WRONLY | O_CREAT, 0600)));
        HOLDS(fails(open(test_own_file, O_WRONLY)));
        HOLDS(fails(truncate(test_own_file, 0)));
        HOLDS(fails(unlink(test_own_file)));
        HOLDS(fails(mkdir(test_in_folder("more"), 0700)));
        HOLDS(rename(test_in_folder("folder/other"), test_in_folder("out")) != 0);
    }
    if (layers & CONFINE_CALLS) {
        const int line = has_no_rights();
        return line ? line : works_as_process();
    }
    return 0;
}

static int test_limits(void)
{
    struct rlimit limit;
    confine_limit(RLIMIT_NOFILE, 20);
    HOLDS(getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur == 20 && limit.rlim_max == 20);
    confine_limit(RLIMIT_NOFILE, 30); /* stays lower */
    HOLDS(getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur == 20 && limit.rlim_max == 20);
    confine_limit(RLIMIT_CPU, 7);
    HOLDS(getrlimit(RLIMIT_CPU, &limit) == 0 && limit.rlim_cur == 7 && limit.rlim_max == 8);
    confine_memory(64 << 20);
    HOLDS(mmap(NULL, 32 << 20, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED);
    HOLDS(mmap(NULL, 64 << 20, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) == MAP_FAILED);
    return 0;
}

static void check(int (*body)(void))
{
    layers = run(try_layers);
    if (!layers)
        skip();
    const int line = run(body);
    if (line)
        fail_msg("line %d", line);
}

static void test_of_open_files(void **state)
{
    (void)state;
    check(test_open_files);
}

static void test_of_output(void **state)
{
    (void)state;
    check(test_output);
}

static void test_of_one_folder(void **state)
{
    (void)state;
    FILE *file = fopen(test_own_file, "w");
    assert_true(file && fclose(file) == 0);
    assert_int_equal(mkdir(test_in_folder("folder"), 0700), 0);
    check(test_one_folder);
    rmdir(test_in_folder("folder/in"));
    unlink(test_in_folder("folder/other"));
    rmdir(test_in_folder("folder"));
}

static void test_of_limits(void **state)
{
    (void)state;
    const int line = run(test_limits);
    if (line)
        fail_msg("line %d", line);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_of_open_files), cmocka_unit_test(test_of_output),
                                       cmocka_unit_test(test_of_one_folder), cmocka_unit_test(test_of_limits)};
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
