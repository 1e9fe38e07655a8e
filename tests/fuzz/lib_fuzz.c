/* The parent that watches and keeps, and the child that runs: see lib_fuzz.h. */
#include "lib_fuzz.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
size_t __sanitizer_get_current_allocated_bytes(void); /* gcc has no header of it */
const char *__asan_default_options(void);
const char *__ubsan_default_options(void);

/* What cannot be had is NULL, as on a machine with less memory. */
const char *__asan_default_options(void)
{
    return "allocator_may_return_null=1:max_allocation_size_mb=1024:quarantine_size_mb=16:malloc_context_size=12";
}

const char *__ubsan_default_options(void)
{
    return "print_stacktrace=1";
}

static size_t memory_in_use(void)
{
    return __sanitizer_get_current_allocated_bytes();
}
#else
static size_t memory_in_use(void)
{
    return 0;
}

static int __lsan_do_recoverable_leak_check(void)
{
    return 0;
}
#endif

enum { PLACES_MAX = 32, EXIT_LEAK = 23 };

/* What parent and child both see. */
typedef struct Shared {
    volatile long iteration; /* the input being made or run */
    volatile long accepted;  /* inputs that the code under test took */
    volatile int stop;
    volatile size_t size;
    unsigned char bytes[FUZZ_LARGEST + 1];
} Shared;

typedef struct Fuzz {
    const FuzzDriver *driver;
    uint64_t seed;
    double seconds;
    const char *folder;
    Shared *shared;
    char log[512]; /* what the child writes */
    int nplaces;
    char places[PLACES_MAX][512]; /* of findings so far */
} Fuzz;

void fuzz_must(int holds, const char *what)
{
    if (holds)
        return;
    fprintf(stderr, "SUMMARY: does not hold: %s\n", what);
    abort();
}

static _Noreturn void die(const char *what, const char *name)
{
    fprintf(stderr, "fuzz: %s %s: %s\n", what, name, strerror(errno));
    exit(2);
}

static unsigned char *read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    unsigned char *bytes = malloc(FUZZ_LARGEST + 1);
    if (!file || !bytes)
        die("cannot read", path);
    *size = fread(bytes, 1, FUZZ_LARGEST, file);
    bytes[*size] = 0;
    fclose(file);
    return bytes;
}

static void write_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file))
        die("cannot write", path);
}

/* ---- the child ---- */

/* Run a copy of the input of exactly its size, so that reading past its end is seen. */
static int run_input(const FuzzDriver *driver, const unsigned char *bytes, size_t size)
{
    unsigned char *copy = malloc(size + 1);
    if (!copy)
        die("no memory for", "an input");
    memcpy(copy, bytes, size);
    copy[size] = 0;
    int accepted = driver->run(copy, size);
    free(copy);
    return accepted;
}

/* Whether the input takes more memory once more: not something kept for the next time, then, but perhaps a leak. */
static int grows_again(const Fuzz *fuzz)
{
    size_t before = memory_in_use();
    run_input(fuzz->driver, fuzz->shared->bytes, fuzz->shared->size);
    return memory_in_use() > before;
}

static _Noreturn void child(Fuzz *fuzz)
{
    Shared *shared = fuzz->shared;
    int log = open(fuzz->log, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (log < 0)
        _exit(2);
    dup2(log, 1);
    dup2(log, 2);
    for (; !shared->stop; shared->iteration++) {
        uint64_t random = fuzz->seed * 0xd1342543de82ef95u + (uint64_t)shared->iteration;
        shared->size = fuzz_mutate(shared->bytes, FUZZ_LARGEST, fuzz->driver->text, &random);
        size_t before = memory_in_use();
        shared->accepted += run_input(fuzz->driver, shared->bytes, shared->size);
        if (memory_in_use() > before && grows_again(fuzz) && __lsan_do_recoverable_leak_check())
            _exit(EXIT_LEAK);
    }
    _exit(0);
}

/* ---- the parent ---- */

static double now(clockid_t clock)
{
    struct timespec t = {0, 0};
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static size_t resident(pid_t pid)
{
    char path[64];
    long pages = 0;
    snprintf(path, sizeof path, "/proc/%d/statm", (int)pid);
    FILE *file = fopen(path, "r");
    if (file && fscanf(file, "%*d %ld", &pages) != 1)
        pages = 0;
    if (file)
        fclose(file);
    return (size_t)pages * (size_t)sysconf(_SC_PAGESIZE);
}

/* Watch until the child ends; NULL when it ended as told, else what is wrong with the input it was at. */
static const char *watch(Fuzz *fuzz, pid_t pid, double until)
{
    clockid_t clock;
    long seen = -1;
    double cpu = 0, wall = 0;
    int status = 0;
    const char *wrong = NULL;
    if (clock_getcpuclockid(pid, &clock))
        clock = CLOCK_MONOTONIC;
    while (waitpid(pid, &status, WNOHANG) == 0) {
        double time = now(CLOCK_MONOTONIC);
        fuzz->shared->stop |= time > until;
        if (fuzz->shared->iteration != seen) {
            seen = fuzz->shared->iteration;
            cpu = now(clock);
            wall = time;
        }
        if (now(clock) - cpu > FUZZ_CPU_SECONDS || time - wall > FUZZ_WALL_SECONDS)
            wrong = "takes too long";
        else if (resident(pid) > FUZZ_MEMORY)
            wrong = "takes too much memory";
        if (wrong) {
            kill(pid, SIGKILL);
            waitpid(pid, &status, 0);
            return wrong;
        }
        nanosleep(&(struct timespec){0, 10000000}, NULL);
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return NULL;
    return WIFEXITED(status) && WEXITSTATUS(status) == EXIT_LEAK ? "leaks" : "crashes";
}

/* Where in the code, as the sanitizer says: its summary, and the first of our own lines in its trace. Returns 0 where
 * the sanitizer only failed itself, over threads that another library was starting. */
static int find_place(const Fuzz *fuzz, const char *wrong, char *place, size_t room)
{
    char line[1024], summary[200] = "", frame[200] = "";
    FILE *file = fopen(fuzz->log, "r");
    int real = 1;
    while (file && fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = 0;
        real &= !strstr(line, "LeakSanitizer has encountered a fatal error");
        if (!summary[0] && strncmp(line, "SUMMARY: ", 9) == 0)
            snprintf(summary, sizeof summary, "%.190s", line + 9);
        else if (!summary[0] && strstr(line, "runtime error: ")) /* the undefined behaviour sanitizer's */
            snprintf(summary, sizeof summary, "%.190s", line);
        else if (!frame[0] && strstr(line, " in ") && (strstr(line, "renderer/") || strstr(line, "tools/")))
            snprintf(frame, sizeof frame, "%.190s", strstr(line, " in ") + 4);
    }
    if (file)
        fclose(file);
    snprintf(place, room, "%s%s%s%s%s", wrong, summary[0] ? ": " : "", summary, frame[0] ? ", " : "", frame);
    return real;
}

static void keep_finding(Fuzz *fuzz, const char *wrong)
{
    char place[512], path[700];
    if (!find_place(fuzz, wrong, place, sizeof place))
        return;
    for (int i = 0; i < fuzz->nplaces; i++)
        if (strcmp(fuzz->places[i], place) == 0)
            return;
    snprintf(fuzz->places[fuzz->nplaces++], sizeof *fuzz->places, "%s", place);
    snprintf(path, sizeof path, "%s/%s-%llu-%ld", fuzz->folder, fuzz->driver->name, (unsigned long long)fuzz->seed,
             fuzz->shared->iteration);
    write_file(path, fuzz->shared->bytes, fuzz->shared->size);
    printf("%s %s\n", path, place);
    fflush(stdout);
    size_t size;
    unsigned char *log = read_file(fuzz->log, &size);
    strncat(path, ".report", sizeof path - strlen(path) - 1);
    write_file(path, log, size);
    free(log);
}

static int run_all(Fuzz *fuzz)
{
    double began = now(CLOCK_MONOTONIC), until = began + fuzz->seconds;
    snprintf(fuzz->log, sizeof fuzz->log, "%s/%s.log", fuzz->folder, fuzz->driver->name);
    while (!fuzz->shared->stop && fuzz->nplaces < PLACES_MAX) {
        fflush(stdout);
        pid_t pid = fork();
        if (pid < 0)
            die("cannot start", "a process");
        if (pid == 0)
            child(fuzz);
        const char *wrong = watch(fuzz, pid, until);
        if (wrong) {
            keep_finding(fuzz, wrong);
            fuzz->shared->iteration++;
        }
        fuzz->shared->stop |= now(CLOCK_MONOTONIC) > until;
    }
    unlink(fuzz->log);
    printf("fuzz_%s: seed %llu, %ld inputs in %.0f s, %ld accepted, %d findings\n", fuzz->driver->name,
           (unsigned long long)fuzz->seed, fuzz->shared->iteration, now(CLOCK_MONOTONIC) - began,
           fuzz->shared->accepted, fuzz->nplaces);
    return fuzz->nplaces > 0;
}

static int run_blind(const FuzzDriver *driver, int argc, char **argv)
{
    Fuzz *fuzz = calloc(1, sizeof *fuzz);
    size_t size;
    int only = 0;
    const char *seeds = NULL;
    if (!fuzz)
        die("no memory", "");
    *fuzz = (Fuzz){.driver = driver, .seed = 1, .seconds = 10, .folder = "."};
    if (driver->begin)
        driver->begin();
    for (int i = 1; i < argc; i++) {
        const char *value = i + 1 < argc ? argv[i + 1] : "";
        if (strcmp(argv[i], "--run") == 0) {
            only = 1;
            continue;
        }
        if (strcmp(argv[i], "--seeds") == 0) {
            seeds = value, i++;
            continue;
        }
        if (strcmp(argv[i], "--seconds") == 0)
            i++, fuzz->seconds = atof(value);
        else if (strcmp(argv[i], "--seed") == 0)
            i++, fuzz->seed = strtoull(value, NULL, 10);
        else if (strcmp(argv[i], "--keep") == 0)
            i++, fuzz->folder = value;
        else {
            int is_words = strcmp(argv[i], "--words") == 0;
            i += is_words;
            unsigned char *bytes = read_file(is_words ? value : argv[i], &size);
            if (only)
                printf("%s %s\n", argv[i], run_input(driver, bytes, size) ? "accepted" : "refused");
            else if (is_words)
                fuzz_words((char *)bytes, size);
            else
                fuzz_seed(bytes, size);
            free(bytes);
        }
    }
    if (seeds)
        fuzz_write_seeds(seeds);
    if (only || seeds) {
        free(fuzz);
        return 0;
    }
    fuzz->shared = mmap(NULL, sizeof *fuzz->shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (fuzz->shared == MAP_FAILED)
        die("no memory", "");
    int found = run_all(fuzz);
    munmap(fuzz->shared, sizeof *fuzz->shared);
    free(fuzz);
    return found;
}

/* ---- guided by coverage ---- */

/* Of libFuzzer, where the program is linked with it. */
__attribute__((weak)) int LLVMFuzzerRunDriver(int *argc, char ***argv, int (*run)(const unsigned char *, size_t));

static const FuzzDriver *guided;

static int run_guided(const unsigned char *bytes, size_t size)
{
    if (size <= FUZZ_LARGEST)
        run_input(guided, bytes, size);
    return 0;
}

/* Options of libFuzzer begin with one dash: they and folders are its alone. */
static int is_guided(int argc, char **argv)
{
    return LLVMFuzzerRunDriver && argc > 1 && argv[1][0] == '-' && argv[1][1] != '-';
}

int fuzz_main(const FuzzDriver *driver, int argc, char **argv)
{
    if (is_guided(argc, argv)) {
        guided = driver;
        if (driver->begin)
            driver->begin();
        return LLVMFuzzerRunDriver(&argc, &argv, run_guided);
    }
    return run_blind(driver, argc, argv);
}
