/* For LD_PRELOAD: one call fails of those that a program makes to get memory, files or threads.
 *
 *   FAULT=KIND:WHOSE:N   the N-th call of that kind fails, KIND being memory, read, write, open, rename, thread or map,
 *                        WHOSE own or library: who calls. Own are the program and what of it is loaded later; the C
 *                        library's own calls of itself are nobody's.
 *   FAULT=short          no call fails, but reads and writes do half of what they are asked to.
 *   FAULT_REPORT=FILE    what failed, and at the end the number of calls: lines `fired FUNCTION MODULE+OFFSET [dlopen]`
 *                        and `count KIND WHOSE N`.
 *
 * Calls are counted from main on, those of child processes too. What fails leaves what the real call would leave:
 * errno, and files as they were; a file that is closed or flushed is so, but says that the disk is full. */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdio_ext.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { MEMORY, READ, WRITE, OPEN, RENAME, THREAD, MAP, KINDS };
enum { OWN, LIBRARY, OWNERS };
enum { RANGES = 16, EARLY = 1 << 16, FRAMES = 24 };

static const char *const kind_names[KINDS] = {"memory", "read", "write", "open", "rename", "thread", "map"};
static const int kind_errors[KINDS] = {ENOMEM, EIO, ENOSPC, EMFILE, EIO, EAGAIN, ENOMEM};
static const char *const owner_names[OWNERS] = {"own", "library"};

static struct Range {
    uintptr_t low, high;
} own_code[RANGES];
static atomic_int nown, started;
static atomic_long (*counts)[OWNERS]; /* by kind; shared with child processes */
static int chosen_kind = -1, chosen_owner, halves;
static long chosen;
static const char *report;
static _Thread_local int opening; /* a library */

/* The next definition of a function, which is the real one. */
#define REAL(name)                                                                                                     \
    static __typeof__(name) *real;                                                                                     \
    if (!real)                                                                                                         \
    real = (__typeof__(name) *)dlsym(RTLD_NEXT, #name)
#define CALLER ((uintptr_t)__builtin_return_address(0))

/* ---- who calls ---- */

static int note_own(struct dl_phdr_info *info, size_t size, void *first)
{
    int main_program = *(int *)first;

    (void)size;
    *(int *)first = 0;
    if (!main_program && !strstr(info->dlpi_name, "retex"))
        return 0;
    for (int k = 0; k < info->dlpi_phnum && nown < RANGES; k++) {
        const ElfW(Phdr) *p = &info->dlpi_phdr[k];
        uintptr_t low = info->dlpi_addr + p->p_vaddr;
        int known = 0;
        for (int i = 0; i < nown; i++)
            known |= own_code[i].low == low;
        if (p->p_type != PT_LOAD || !(p->p_flags & PF_X) || known)
            continue;
        own_code[nown] = (struct Range){low, low + p->p_memsz};
        nown++;
    }
    return 0;
}

static void find_own_code(void)
{
    int first = 1;

    dl_iterate_phdr(note_own, &first);
}

static int owner_of(uintptr_t caller)
{
    for (int i = 0; i < nown; i++)
        if (caller >= own_code[i].low && caller < own_code[i].high)
            return OWN;
    return LIBRARY;
}

/* ---- reports, by system calls, which nobody counts ---- */

static void tell(const char *format, ...)
{
    char line[512];
    va_list arguments;
    long file;

    if (!report || (file = syscall(SYS_openat, AT_FDCWD, report, O_WRONLY | O_CREAT | O_APPEND, 0600)) < 0)
        return;
    va_start(arguments, format);
    int length = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    syscall(SYS_write, file, line, length < (int)sizeof line ? length : (int)sizeof line - 1);
    syscall(SYS_close, file);
}

/* Whose call it is, but for the C and the C++ library, which pass on what others ask for. */
static void tell_fired(const char *function)
{
    void *frames[FRAMES];
    int count = backtrace(frames, FRAMES);

    for (int i = 1; i < count; i++) {
        Dl_info info = {0};
        if (!dladdr(frames[i], &info) || !info.dli_fname)
            continue;
        const char *slash = strrchr(info.dli_fname, '/'), *module = slash ? slash + 1 : info.dli_fname;
        if (strstr(module, "shim.so") || strstr(module, "libstdc++") || strncmp(module, "libc.so", 7) == 0)
            continue;
        tell("fired %s %s+0x%lx%s\n", function, module, (unsigned long)((char *)frames[i] - (char *)info.dli_fbase),
             opening ? " dlopen" : "");
        return;
    }
    tell("fired %s ?+0x0%s\n", function, opening ? " dlopen" : "");
}

/* Is this call to fail? Sets errno then. */
static int fails(int kind, const char *function, uintptr_t caller)
{
    static _Thread_local int telling; /* which takes memory, too */

    if (!started || telling)
        return 0;
    int owner = owner_of(caller);
    long number = atomic_fetch_add(&counts[kind][owner], 1) + 1;
    if (kind != chosen_kind || owner != chosen_owner || number != chosen)
        return 0;
    telling = 1;
    tell_fired(function);
    telling = 0;
    errno = kind_errors[kind];
    return 1;
}

/* ---- starting and ending ---- */

static void choose(const char *what)
{
    char kind[16], owner[16];

    halves = strcmp(what, "short") == 0;
    if (sscanf(what, "%15[a-z]:%15[a-z]:%ld", kind, owner, &chosen) != 3)
        return;
    for (int k = 0; k < KINDS; k++)
        if (strcmp(kind, kind_names[k]) == 0)
            chosen_kind = k;
    chosen_owner = strcmp(owner, "own") == 0 ? OWN : LIBRARY;
}

static int (*real_main)(int, char **, char **);

static int counted_main(int argc, char **argv, char **environment)
{
    report = getenv("FAULT_REPORT");
    if (getenv("FAULT"))
        choose(getenv("FAULT"));
    find_own_code();
    counts = mmap(NULL, KINDS * sizeof *counts, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (counts == MAP_FAILED)
        _exit(127);
    started = 1;
    return real_main(argc, argv, environment);
}

int __libc_start_main(int (*main)(int, char **, char **), int argc, char **argv, void (*init)(void), void (*fini)(void),
                      void (*rtld_fini)(void), void *stack_end)
{
    __typeof__(__libc_start_main) *real = (__typeof__(__libc_start_main) *)dlsym(RTLD_NEXT, "__libc_start_main");

    real_main = main;
    return real(counted_main, argc, argv, init, fini, rtld_fini, stack_end);
}

__attribute__((destructor)) static void tell_counts(void)
{
    started = 0;
    for (int k = 0; counts && k < KINDS; k++)
        for (int o = 0; o < OWNERS; o++)
            tell("count %s %s %ld\n", kind_names[k], owner_names[o], (long)counts[k][o]);
}

/* What a library does while it is opened is counted like all else, but told apart. */
void *dlopen(const char *path, int flags)
{
    REAL(dlopen);
    if (fails(OPEN, "dlopen", CALLER))
        return NULL;
    opening++;
    void *library = real(path, flags);
    opening--;
    find_own_code();
    return library;
}

/* ---- memory ---- */

/* dlsym itself may want memory before the real functions are known. */
static _Alignas(16) char early[EARLY];
static size_t early_used;

static void *early_memory(size_t size)
{
    void *at = early + early_used;

    early_used += (size + 15) / 16 * 16;
    return early_used <= EARLY ? at : NULL;
}

void *malloc(size_t size)
{
    REAL(malloc);
    return fails(MEMORY, "malloc", CALLER) ? NULL : real(size);
}

void *calloc(size_t count, size_t size)
{
    static int asking;
    static __typeof__(calloc) *real;

    if (!real && asking)
        return early_memory(count * size);
    asking = 1;
    if (!real)
        real = (__typeof__(calloc) *)dlsym(RTLD_NEXT, "calloc");
    return fails(MEMORY, "calloc", CALLER) ? NULL : real(count, size);
}

void *realloc(void *old, size_t size)
{
    REAL(realloc);
    return fails(MEMORY, "realloc", CALLER) ? NULL : real(old, size);
}

void free(void *memory)
{
    REAL(free);
    if ((char *)memory < early || (char *)memory >= early + EARLY)
        real(memory);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    REAL(aligned_alloc);
    return fails(MEMORY, "aligned_alloc", CALLER) ? NULL : real(alignment, size);
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
    REAL(posix_memalign);
    return fails(MEMORY, "posix_memalign", CALLER) ? ENOMEM : real(memory, alignment, size);
}

char *strdup(const char *text)
{
    REAL(strdup);
    return fails(MEMORY, "strdup", CALLER) ? NULL : real(text);
}

FILE *open_memstream(char **text, size_t *size)
{
    REAL(open_memstream);
    return fails(MEMORY, "open_memstream", CALLER) ? NULL : real(text, size);
}

void *mmap(void *at, size_t size, int protection, int flags, int file, off_t offset)
{
    REAL(mmap);
    return fails(MAP, "mmap", CALLER) ? MAP_FAILED : real(at, size, protection, flags, file, offset);
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument)
{
    REAL(pthread_create);
    return fails(THREAD, "pthread_create", CALLER) ? EAGAIN : real(thread, attributes, start, argument);
}

pid_t fork(void)
{
    REAL(fork);
    return fails(THREAD, "fork", CALLER) ? -1 : real();
}

int posix_spawn(pid_t *pid, const char *path, const posix_spawn_file_actions_t *files,
                const posix_spawnattr_t *attributes, char *const arguments[], char *const environment[])
{
    REAL(posix_spawn);
    return fails(THREAD, "posix_spawn", CALLER) ? EAGAIN : real(pid, path, files, attributes, arguments, environment);
}

/* ---- files ---- */

static size_t asked(size_t size)
{
    return halves && started && size > 1 ? size / 2 : size;
}

ssize_t read(int file, void *to, size_t size)
{
    REAL(read);
    return fails(READ, "read", CALLER) ? -1 : real(file, to, asked(size));
}

ssize_t pread(int file, void *to, size_t size, off_t offset)
{
    REAL(pread);
    return fails(READ, "pread", CALLER) ? -1 : real(file, to, asked(size), offset);
}

size_t fread(void *to, size_t size, size_t count, FILE *file)
{
    REAL(fread);
    if (!fails(READ, "fread", CALLER))
        return real(to, size, count, file);
    fcntl(fileno(file), F_GETFD);
    file->_flags |= 0x20; /* ferror() is to see it: glibc's _IO_ERR_SEEN */
    errno = EIO;
    return 0;
}

ssize_t write(int file, const void *from, size_t size)
{
    REAL(write);
    return file != STDERR_FILENO && fails(WRITE, "write", CALLER) ? -1 : real(file, from, asked(size));
}

ssize_t pwrite(int file, const void *from, size_t size, off_t offset)
{
    REAL(pwrite);
    return fails(WRITE, "pwrite", CALLER) ? -1 : real(file, from, asked(size), offset);
}

static int full(FILE *file)
{
    file->_flags |= 0x20;
    errno = ENOSPC;
    return EOF;
}

size_t fwrite(const void *from, size_t size, size_t count, FILE *file)
{
    REAL(fwrite);
    return file != stderr && fails(WRITE, "fwrite", CALLER) ? (size_t)(full(file), 0) : real(from, size, count, file);
}

int fputs(const char *text, FILE *file)
{
    REAL(fputs);
    return file != stderr && fails(WRITE, "fputs", CALLER) ? full(file) : real(text, file);
}

int fflush(FILE *file)
{
    REAL(fflush);
    const int pending = file && __fpending(file) > 0; /* without, nothing is written that could fail */
    int code = real(file);
    return pending && file != stderr && fails(WRITE, "fflush", CALLER) ? full(file) : code;
}

int fclose(FILE *file)
{
    REAL(fclose);
    int code = real(file);
    return fails(WRITE, "fclose", CALLER) ? EOF : code;
}

int ftruncate(int file, off_t size)
{
    REAL(ftruncate);
    return fails(WRITE, "ftruncate", CALLER) ? -1 : real(file, size);
}

int fchmod(int file, mode_t mode)
{
    REAL(fchmod);
    return fails(WRITE, "fchmod", CALLER) ? -1 : real(file, mode);
}

static mode_t mode_of(int flags, va_list arguments)
{
    return flags & (O_CREAT | __O_TMPFILE) ? va_arg(arguments, mode_t) : 0;
}

int open(const char *path, int flags, ...)
{
    REAL(open);
    va_list arguments;
    va_start(arguments, flags);
    mode_t mode = mode_of(flags, arguments);
    va_end(arguments);
    return fails(OPEN, "open", CALLER) ? -1 : real(path, flags, mode);
}

int openat(int folder, const char *path, int flags, ...)
{
    REAL(openat);
    va_list arguments;
    va_start(arguments, flags);
    mode_t mode = mode_of(flags, arguments);
    va_end(arguments);
    return fails(OPEN, "openat", CALLER) ? -1 : real(folder, path, flags, mode);
}

FILE *fopen(const char *path, const char *mode)
{
    REAL(fopen);
    return fails(OPEN, "fopen", CALLER) ? NULL : real(path, mode);
}

FILE *fdopen(int file, const char *mode)
{
    REAL(fdopen);
    return fails(OPEN, "fdopen", CALLER) ? NULL : real(file, mode);
}

int mkostemp(char *path, int flags)
{
    REAL(mkostemp);
    return fails(OPEN, "mkostemp", CALLER) ? -1 : real(path, flags);
}

int mkstemps(char *path, int suffix)
{
    REAL(mkstemps);
    return fails(OPEN, "mkstemps", CALLER) ? -1 : real(path, suffix);
}

char *mkdtemp(char *path)
{
    REAL(mkdtemp);
    return fails(OPEN, "mkdtemp", CALLER) ? NULL : real(path);
}

DIR *opendir(const char *path)
{
    REAL(opendir);
    return fails(OPEN, "opendir", CALLER) ? NULL : real(path);
}

int pipe2(int ends[2], int flags)
{
    REAL(pipe2);
    return fails(OPEN, "pipe2", CALLER) ? -1 : real(ends, flags);
}

int memfd_create(const char *name, unsigned flags)
{
    REAL(memfd_create);
    return fails(OPEN, "memfd_create", CALLER) ? -1 : real(name, flags);
}

int dup(int file)
{
    REAL(dup);
    return fails(OPEN, "dup", CALLER) ? -1 : real(file);
}

int dup2(int file, int as)
{
    REAL(dup2);
    return fails(OPEN, "dup2", CALLER) ? -1 : real(file, as);
}

int rename(const char *from, const char *to)
{
    REAL(rename);
    return fails(RENAME, "rename", CALLER) ? -1 : real(from, to);
}

int linkat(int from_folder, const char *from, int to_folder, const char *to, int flags)
{
    REAL(linkat);
    return fails(RENAME, "linkat", CALLER) ? -1 : real(from_folder, from, to_folder, to, flags);
}

int mkdir(const char *path, mode_t mode)
{
    REAL(mkdir);
    return fails(RENAME, "mkdir", CALLER) ? -1 : real(path, mode);
}

/* The same under the names that programs built for large files call. */
ssize_t pread64(int file, void *to, size_t size, off_t offset) __attribute__((alias("pread")));
ssize_t pwrite64(int file, const void *from, size_t size, off_t offset) __attribute__((alias("pwrite")));
int open64(const char *path, int flags, ...) __attribute__((alias("open")));
int openat64(int folder, const char *path, int flags, ...) __attribute__((alias("openat")));
FILE *fopen64(const char *path, const char *mode) __attribute__((alias("fopen")));
void *mmap64(void *at, size_t size, int protection, int flags, int file, off_t offset) __attribute__((alias("mmap")));
int ftruncate64(int file, off_t size) __attribute__((alias("ftruncate")));
