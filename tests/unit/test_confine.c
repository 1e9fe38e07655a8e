/* What a confined process can still do, and what not. Each test runs in a child, which ends with the number of the line
 * that did not hold. Skipped where the kernel has no such layer. */
#include "lib_folder.h"
#include "lib_test.h"
#include <cmocka.h>

#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <sys/xattr.h>
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
    const int folder = open(test_in_folder("folder"), O_PATH | O_DIRECTORY);
    HOLDS(folder >= 0);
    /* another folder of that name is not the one that is meant */
    HOLDS(rename(test_in_folder("folder"), test_in_folder("moved")) == 0);
    HOLDS(mkdir(test_in_folder("folder"), 0700) == 0);
    confine_to_folder(folder);
    if (layers & CONFINE_FILES)
        HOLDS(fails(open(inside, O_WRONLY | O_CREAT, 0600)));
    snprintf(inside, sizeof inside, "%s/moved/in", test_folder);
    FILE *file = fopen("/proc/self/statm", "r");
    HOLDS(file && fclose(file) == 0);
    file = fopen(inside, "w");
    HOLDS(file && fputs("x", file) >= 0 && fclose(file) == 0);
    HOLDS(rename(inside, test_in_folder("moved/other")) == 0);
    HOLDS(mkdir(inside, 0700) == 0);
    if (layers & CONFINE_FILES) {
        HOLDS(fails(open(test_in_folder("out"), O_WRONLY | O_CREAT, 0600)));
        HOLDS(fails(open(test_own_file, O_WRONLY)));
        HOLDS(fails(truncate(test_own_file, 0)));
        HOLDS(fails(unlink(test_own_file)));
        HOLDS(fails(mkdir(test_in_folder("more"), 0700)));
        HOLDS(rename(test_in_folder("moved/other"), test_in_folder("out")) != 0);
    }
    if (layers & CONFINE_CALLS) {
        /* which Landlock knows nothing of */
        HOLDS(fails(chmod(test_own_file, 0777)));
        HOLDS(fails(utimensat(AT_FDCWD, test_own_file, NULL, 0)));
        HOLDS(fails(chown(test_own_file, getuid(), getgid())));
        HOLDS(fails(setxattr(test_own_file, "user.x", "1", 1, 0)));
        const int line = has_no_rights();
        return line ? line : works_as_process();
    }
    return 0;
}

/* ---- all calls ---- */

/* Nothing that is asked is done: a filter of the test's own answers calls with this last argument by EXDEV, unless that
 * of confine.c, which is newer, forbids them. */
enum { ASKING = 0x52457465, CALLS = 1024, X32 = 0x40000000 };

/* The kernel's own probes come back by these, whatever filters say; elsewhere they end the process. */
enum { URETPROBE = 335, UPROBE = 336 };

static int answer_what_is_asked(void)
{
    struct sock_filter steps[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, args) + 5 * sizeof(uint64_t) +
                                               (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__ ? sizeof(uint32_t) : 0)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, ASKING, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EXDEV),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    };
    const struct sock_fprog program = {sizeof steps / sizeof *steps, steps};
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

static int is_allowed(long call, const long a[5])
{
    errno = 0;
    syscall(call, a[0], a[1], a[2], a[3], a[4], (long)ASKING);
    return errno == EXDEV;
}

#define ALL -1L
static const long nothing[5] = {0}, everything[5] = {ALL, ALL, ALL, ALL, ALL};

/* Whatever their arguments are: to compute, and to read what is open. */
static const int free_calls[] = {
    __NR_brk,
    __NR_clock_getres,
    __NR_clock_gettime,
    __NR_clock_nanosleep,
    __NR_close,
    __NR_dup,
    __NR_exit,
    __NR_exit_group,
    __NR_fstat,
    __NR_futex,
    __NR_getcpu,
    __NR_getpid,
    __NR_getrandom,
    __NR_getrusage,
    __NR_gettid,
    __NR_gettimeofday,
    __NR_lseek,
    __NR_madvise,
    __NR_membarrier,
    __NR_mremap,
    __NR_munmap,
    __NR_nanosleep,
    __NR_pread64,
    __NR_preadv,
    __NR_read,
    __NR_readv,
    __NR_restart_syscall,
    __NR_rseq,
    __NR_rt_sigaction,
    __NR_rt_sigprocmask,
    __NR_rt_sigreturn,
    __NR_sched_getaffinity,
    __NR_sched_yield,
    __NR_set_robust_list,
    __NR_sigaltstack,
    __NR_uname,
};

/* Of an import besides, whatever their arguments are. None of them changes a mode, an owner, a time or an attribute,
 * locks a file, or tells a terminal or another process anything. */
static const int free_calls_of_imports[] = {
    __NR_faccessat,    __NR_faccessat2, __NR_fadvise64,  __NR_fdatasync, __NR_fstatfs,  __NR_fsync,      __NR_ftruncate,
    __NR_getcwd,       __NR_getdents64, __NR_getegid,    __NR_geteuid,   __NR_getgid,   __NR_getuid,     __NR_linkat,
    __NR_memfd_create, __NR_mkdirat,    __NR_newfstatat, __NR_openat,    __NR_pwrite64, __NR_readlinkat, __NR_renameat,
    __NR_renameat2,    __NR_statfs,     __NR_statx,      __NR_sysinfo,   __NR_unlinkat, __NR_write,      __NR_writev,
#ifdef __NR_open
    __NR_access,       __NR_link,       __NR_lstat,      __NR_mkdir,     __NR_open,     __NR_readlink,   __NR_rename,
    __NR_rmdir,        __NR_stat,       __NR_unlink,
#endif
};

enum { THREAD = CLONE_THREAD | CLONE_VM | CLONE_SIGHAND, DECODER = 2, IMPORT = 4, BOTH = 6 };

/* Those that depend on their arguments, and for which of the two they are allowed. */
static const struct {
    int call, who;
    long arguments[5];
} judged[] = {
    {__NR_clone, BOTH, {THREAD}},
    {__NR_clone, 0, {SIGCHLD}},
    {__NR_clone, 0, {CLONE_VM | CLONE_VFORK | SIGCHLD}},
    {__NR_fcntl, BOTH, {3, F_GETFL}},
    {__NR_fcntl, BOTH, {3, F_DUPFD_CLOEXEC, 3}},
    {__NR_fcntl, 0, {3, F_SETFL, O_ASYNC}},
    {__NR_fcntl, 0, {3, F_SETOWN, 1}},
    {__NR_fcntl, 0, {3, F_SETSIG, SIGKILL}},
    {__NR_fcntl, 0, {3, F_SETLK}},
    {__NR_fcntl, 0, {3, F_SETLEASE}},
    {__NR_mmap, BOTH, {0, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1}},
    {__NR_mmap, 0, {0, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1}},
    {__NR_mmap, 0, {0, 4096, PROT_READ | PROT_WRITE | PROT_EXEC, MAP_PRIVATE, 3}},
    {__NR_mmap, IMPORT, {0, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE, 3}},
    {__NR_mprotect, BOTH, {0, 4096, PROT_READ | PROT_WRITE}},
    {__NR_mprotect, 0, {0, 4096, PROT_READ | PROT_EXEC}},
    {__NR_newfstatat, BOTH, {3, 0, 0, AT_EMPTY_PATH}},
    {__NR_newfstatat, IMPORT, {AT_FDCWD, 0, 0, 0}},
    {__NR_prlimit64, BOTH, {0, RLIMIT_STACK, 0}},
    {__NR_prlimit64, 0, {0, RLIMIT_STACK, 0x7000}},
    {__NR_prlimit64, 0, {0, RLIMIT_STACK, 0x700000000}}, /* the low half is 0 */
    {__NR_prlimit64, 0, {1, RLIMIT_STACK, 0}},
    {__NR_write, BOTH, {STDOUT_FILENO}},
    {__NR_write, IMPORT, {STDERR_FILENO}},
};

static unsigned char *asked; /* by call, shared with the child: whether it is allowed */
enum { JUDGED = sizeof judged / sizeof *judged };

static int ask(int (*confine)(void))
{
    HOLDS(answer_what_is_asked() && is_allowed(__NR_kill, nothing));
    confine();
    for (int i = 0; i < CALLS; i++) {
        if (i == URETPROBE || i == UPROBE)
            continue;
        asked[i] = (unsigned char)(is_allowed(i, nothing) + 2 * is_allowed(i, everything));
        HOLDS(!is_allowed(X32 + i, nothing) && !is_allowed(X32 + i, everything));
    }
    for (int i = 0; i < JUDGED; i++)
        asked[CALLS + i] = (unsigned char)is_allowed(judged[i].call, judged[i].arguments);
    syscall(__NR_getpid, 0L, 0L, 0L, 0L, 0L, 0L); /* no register keeps the mark for calls that follow */
    return 0;
}

static int ask_decoder(void)
{
    return ask(confine_to_open_files);
}

static int confine_to_none(void)
{
    return confine_to_folder(-1);
}

static int ask_import(void)
{
    return ask(confine_to_none);
}

static void expect_calls(int who, const int *calls, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (asked[calls[i]] != 3)
            fail_msg("%s may not make the call %d", who == IMPORT ? "an import" : "a decoder", calls[i]);
        asked[calls[i]] = 0;
    }
}

static void check_calls(int who)
{
    const size_t size = CALLS + JUDGED;
    layers = run(try_layers);
    if (!(layers & CONFINE_CALLS))
        skip();
    asked = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_ptr_not_equal(asked, MAP_FAILED);
    assert_int_equal(run(who == IMPORT ? ask_import : ask_decoder), 0);
    for (int i = 0; i < JUDGED; i++) {
        if (asked[CALLS + i] != ((judged[i].who & who) != 0))
            fail_msg("line %d of the table, call %d: %d", i, judged[i].call, asked[CALLS + i]);
    }
    expect_calls(who, free_calls, sizeof free_calls / sizeof *free_calls);
    if (who == IMPORT)
        expect_calls(who, free_calls_of_imports, sizeof free_calls_of_imports / sizeof *free_calls_of_imports);
    for (int i = 0; i < JUDGED; i++)
        asked[judged[i].call] = 0;
    for (int i = 0; i < CALLS; i++)
        if (asked[i])
            fail_msg("%s may make the call %d, which no list has", who == IMPORT ? "an import" : "a decoder", i);
    munmap(asked, size);
}

static void test_calls_of_decoders(void **state)
{
    (void)state;
    check_calls(DECODER);
}

static void test_calls_of_imports(void **state)
{
    (void)state;
    check_calls(IMPORT);
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
    rmdir(test_in_folder("moved/in"));
    unlink(test_in_folder("moved/other"));
    rmdir(test_in_folder("moved"));
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
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_of_open_files),     cmocka_unit_test(test_of_output),
        cmocka_unit_test(test_of_one_folder),     cmocka_unit_test(test_of_limits),
        cmocka_unit_test(test_calls_of_decoders), cmocka_unit_test(test_calls_of_imports)};
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
