/* See confine.h. */
#include "common/confine.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

/* Numbers of calls are those of one machine; a program can make calls by those of another. Sanitizers make calls of
 * their own, which are not listed below. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#elif defined(__aarch64__)
#define MACHINE AUDIT_ARCH_AARCH64
#elif defined(__NR_arch_prctl) && __SIZEOF_POINTER__ == 8
#define MACHINE AUDIT_ARCH_X86_64
#endif

/* ---- limits ---- */

void confine_limit(int what, uint64_t most)
{
    struct rlimit limit;
    if (getrlimit(what, &limit) != 0)
        return;
    if (limit.rlim_max == RLIM_INFINITY || most < limit.rlim_max)
        limit.rlim_max = what == RLIMIT_CPU ? most + 1 : most; /* at the lower one SIGXCPU tells what it was */
    limit.rlim_cur = most < limit.rlim_max ? most : limit.rlim_max;
    setrlimit(what, &limit);
}

void confine_memory(uint64_t bytes)
{
    unsigned long pages = 0;
    FILE *in = fopen("/proc/self/statm", "r");
    if (in) {
        if (fscanf(in, "%lu", &pages) != 1)
            pages = 0;
        fclose(in);
    }
    confine_limit(RLIMIT_AS, (uint64_t)pages * (uint64_t)sysconf(_SC_PAGESIZE) + bytes);
}

/* ---- system calls ---- */

#ifdef MACHINE

enum { MOST_STEPS = 320 };

typedef struct Filter {
    struct sock_filter steps[MOST_STEPS];
    int count;
} Filter;

/* Calls that only change the process itself, or read what is open. */
static const int computing[] = {
    __NR_read,
    __NR_pread64,
    __NR_readv,
    __NR_preadv,
    __NR_lseek,
    __NR_fstat,
    __NR_close,
    __NR_dup,
    __NR_munmap,
    __NR_mremap,
    __NR_brk,
    __NR_madvise,
    __NR_futex,
    __NR_sched_yield,
    __NR_sched_getaffinity,
    __NR_clock_gettime,
    __NR_clock_getres,
    __NR_clock_nanosleep,
    __NR_nanosleep,
    __NR_gettimeofday,
    __NR_getpid,
    __NR_gettid,
    __NR_getrandom,
    __NR_rt_sigaction,
    __NR_rt_sigprocmask,
    __NR_rt_sigreturn,
    __NR_sigaltstack,
    __NR_set_robust_list,
    __NR_rseq,
    __NR_membarrier,
    __NR_getcpu,
    __NR_exit,
    __NR_exit_group,
    __NR_restart_syscall,
    __NR_getrusage,
    __NR_uname,
};

/* Calls for files by name. What of them changes files is restricted to a folder by Landlock. What it knows nothing of
 * is left out: modes, owners, times and attributes, locks, and ioctl(2), which types into the user's terminal.
 * Files in memory are for OpenImageIO, which writes pictures to files alone: see MemoryFile in bridge/write.cpp. */
static const int using_files[] = {
    __NR_openat,     __NR_newfstatat, __NR_statx,     __NR_readlinkat, __NR_faccessat,    __NR_faccessat2,
    __NR_getdents64, __NR_getcwd,     __NR_statfs,    __NR_fstatfs,    __NR_fadvise64,    __NR_write,
    __NR_writev,     __NR_pwrite64,   __NR_ftruncate, __NR_fsync,      __NR_fdatasync,    __NR_unlinkat,
    __NR_renameat,   __NR_renameat2,  __NR_mkdirat,   __NR_linkat,     __NR_memfd_create, __NR_getuid,
    __NR_geteuid,    __NR_getgid,     __NR_getegid,   __NR_sysinfo,
#ifdef __NR_open /* those of old */
    __NR_open,       __NR_stat,       __NR_lstat,     __NR_readlink,   __NR_access,       __NR_unlink,
    __NR_rename,     __NR_mkdir,      __NR_rmdir,     __NR_link,
#endif
};

static void add(Filter *filter, struct sock_filter step)
{
    if (filter->count < MOST_STEPS)
        filter->steps[filter->count++] = step;
}

static void load(Filter *filter, size_t at)
{
    add(filter, (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, (uint32_t)at));
}

static void answer(Filter *filter, uint32_t what)
{
    add(filter, (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, what));
}

static void allow(Filter *filter, int call)
{
    add(filter, (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)call, 0, 1));
    answer(filter, SECCOMP_RET_ALLOW);
}

/* The halves of an argument of a call. Of flags and descriptors the kernel looks at the low one alone. */
static size_t low_half(int number)
{
    return offsetof(struct seccomp_data, args) + (size_t)number * sizeof(uint64_t) +
           (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__ ? sizeof(uint32_t) : 0);
}

static size_t high_half(int number)
{
    return low_half(number) ^ sizeof(uint32_t);
}

static void load_number(Filter *filter)
{
    load(filter, offsetof(struct seccomp_data, nr));
}

/* These bits of what lies there have that value. */
typedef struct Condition {
    size_t at;
    uint32_t mask, value;
} Condition;

enum { MOST_CONDITIONS = 3 };

/* Allow a call if all conditions hold, up to the first whose mask is 0. */
static void allow_where(Filter *filter, int call, const Condition conditions[MOST_CONDITIONS])
{
    int count = 0;
    while (count < MOST_CONDITIONS && conditions[count].mask)
        count++;
    add(filter,
        (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)call, 0, (unsigned char)(3 * count + 2)));
    for (int i = 0; i < count; i++) {
        const unsigned char rest = (unsigned char)(3 * (count - i - 1) + 1);
        load(filter, conditions[i].at);
        add(filter, (struct sock_filter)BPF_STMT(BPF_ALU | BPF_AND | BPF_K, conditions[i].mask));
        add(filter, (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, conditions[i].value, 0, rest));
    }
    answer(filter, SECCOMP_RET_ALLOW);
    load_number(filter);
}

#define WHERE(...) ((const Condition[MOST_CONDITIONS]){__VA_ARGS__})
#define WHOLE 0xffffffff

static void begin(Filter *filter)
{
    filter->count = 0;
    load(filter, offsetof(struct seccomp_data, arch));
    add(filter, (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, MACHINE, 1, 0));
    answer(filter, SECCOMP_RET_KILL_PROCESS);
    load_number(filter);
    for (size_t i = 0; i < sizeof computing / sizeof *computing; i++)
        allow(filter, computing[i]);
    /* threads, but no processes; glibc uses clone where clone3, whose arguments a filter cannot see, is unknown */
    enum { THREAD = CLONE_THREAD | CLONE_VM | CLONE_SIGHAND };
    allow_where(filter, __NR_clone, WHERE({low_half(0), THREAD, THREAD}));
    add(filter, (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, __NR_clone3, 0, 1));
    answer(filter, SECCOMP_RET_ERRNO | ENOSYS);
    /* to ask for a limit of its own */
    allow_where(filter, __NR_prlimit64,
                WHERE({low_half(0), WHOLE, 0}, {low_half(2), WHOLE, 0}, {high_half(2), WHOLE, 0}));
    /* memory that is no program */
    allow_where(filter, __NR_mmap, WHERE({low_half(2), PROT_EXEC, 0}));
    allow_where(filter, __NR_mprotect, WHERE({low_half(2), PROT_EXEC, 0}));
    /* F_SETOWN and F_SETSIG would send signals, others lock files of the user */
    allow_where(filter, __NR_fcntl, WHERE({low_half(1), WHOLE, F_DUPFD_CLOEXEC}));
    allow_where(filter, __NR_fcntl, WHERE({low_half(1), WHOLE, F_GETFL}));
}

static int set_filter(Filter *filter)
{
    answer(filter, SECCOMP_RET_ERRNO | EPERM);
    const struct sock_fprog program = {(unsigned short)filter->count, filter->steps};
    if (filter->count == MOST_STEPS || prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
        return 0;
    return syscall(__NR_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &program) == 0;
}

static int allow_open_files(void)
{
    Filter filter;
    begin(&filter);
    allow_where(&filter, __NR_write, WHERE({low_half(0), WHOLE, STDOUT_FILENO}));
    allow_where(&filter, __NR_newfstatat, WHERE({low_half(3), AT_EMPTY_PATH, AT_EMPTY_PATH})); /* is fstat */
    return set_filter(&filter);
}

static int allow_files(void)
{
    Filter filter;
    begin(&filter);
    for (size_t i = 0; i < sizeof using_files / sizeof *using_files; i++)
        allow(&filter, using_files[i]);
    /* Programs out of files alone, not to be written to: TBB loads its allocator when Embree starts, and the bridge
     * loads OpenImageIO and what it stands on for the first picture that needs it. */
    allow_where(&filter, __NR_mmap,
                WHERE({low_half(2), PROT_EXEC | PROT_WRITE, PROT_EXEC}, {low_half(3), MAP_ANONYMOUS, 0}));
    return set_filter(&filter);
}

#else

static int allow_open_files(void)
{
    return 0;
}

static int allow_files(void)
{
    return 0;
}

#endif

/* ---- Landlock ---- */

/* As in the system's header, which may know less than the kernel that runs. */
enum {
    MAY_EXECUTE = 1 << 0,
    MAY_WRITE_FILE = 1 << 1,
    MAY_READ = 3 << 2,           /* files, folders */
    MAY_CHANGE_NAMES = 511 << 4, /* remove and make files of all kinds */
    MAY_REFER = 1 << 13,         /* from version 2 on */
    MAY_TRUNCATE = 1 << 14,      /* 3 */
    MAY_IOCTL = 1 << 15,         /* 5 */
    NET_VERSION = 4,
    SCOPE_VERSION = 6,
    RULE_BENEATH = 1
};

struct ruleset {
    uint64_t files, net, scoped;
};

struct beneath {
    uint64_t allowed;
    int32_t folder;
} __attribute__((packed));

static uint64_t write_rights(int version)
{
    return MAY_WRITE_FILE | MAY_CHANGE_NAMES | (version >= 2 ? MAY_REFER : 0) | (version >= 3 ? MAY_TRUNCATE : 0);
}

/* Allow what is handled below an open folder; of a file, what goes for files. */
static int allow_below(int set, int folder, uint64_t rights)
{
    const struct beneath rule = {rights, folder};
    return syscall(__NR_landlock_add_rule, set, RULE_BENEATH, &rule, 0) == 0;
}

static int allow_device(int set, const char *path, uint64_t rights)
{
    const int device = open(path, O_PATH | O_CLOEXEC);
    const int is_done = device >= 0 && allow_below(set, device, rights);
    if (device >= 0)
        close(device);
    return is_done;
}

/* Forbid what is handled but below an open folder, or, where that is -1, everywhere. */
static int restrict_files(int may_read, int folder, const char *device)
{
    const int version = (int)syscall(__NR_landlock_create_ruleset, NULL, 0, 1);
    if (version < 1)
        return 0;
    struct ruleset rules = {write_rights(version), version >= NET_VERSION ? 3 : 0, version >= SCOPE_VERSION ? 3 : 0};
    if (!may_read)
        rules.files |= MAY_EXECUTE | MAY_READ | (version >= 5 ? MAY_IOCTL : 0);
    const size_t size = version >= SCOPE_VERSION ? sizeof rules : version >= NET_VERSION ? 16 : 8;
    const int set = (int)syscall(__NR_landlock_create_ruleset, &rules, size, 0);
    if (set < 0)
        return 0;
    const int is_done =
        (folder < 0 || allow_below(set, folder, write_rights(version))) &&
        (!device || allow_device(set, device, write_rights(version) & (MAY_WRITE_FILE | MAY_TRUNCATE))) &&
        prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && syscall(__NR_landlock_restrict_self, set, 0) == 0;
    close(set);
    return is_done;
}

int confine_to_open_files(void)
{
    const int files = restrict_files(0, -1, NULL); /* first: the filter forbids it */
    return (files ? CONFINE_FILES : 0) | (allow_open_files() ? CONFINE_CALLS : 0);
}

int confine_to_folder(int folder)
{
    const int files = restrict_files(1, folder, NULL);
    return (files ? CONFINE_FILES : 0) | (allow_files() ? CONFINE_CALLS : 0);
}

int confine_writes_to(int folder)
{
    return restrict_files(1, folder, "/dev/null") ? CONFINE_FILES : 0; /* decoders get it as standard error */
}
