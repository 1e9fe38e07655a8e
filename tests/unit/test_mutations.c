/* Files that are damaged in all ways, read in all ways. A damaged file must be refused, or give the same result to the
 * bit as the undamaged one. It must never give another picture, a crash or an endless loop.
 *
 * test_mutations [COUNT [SEED [FOLDER]]]: so many inputs of each file; those that fail are kept in FOLDER. Input number
 * i of a seed is the same in every run. */
#include "lib_damage.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lib_folder.h"

#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
enum { LIMIT_MEMORY = 0 }; /* they take any amount of addresses */
#else
enum { LIMIT_MEMORY = 1 };
#endif
enum { CPU_SECONDS = 20, WALL_SECONDS = 120 };

/* Of an input: the worst of its roads; an exit status. */
typedef enum Outcome { REFUSED = 10, SAME, WITHOUT_A_WORD, OTHER, ENDED_BADLY, OUTCOMES } Outcome;
static const char *const outcome_names[] = {"refused", "the same", "refused without a word", "another picture",
                                            "crash or no end"};

/* A whole file, and what comes of it. */
typedef struct Whole {
    char name[40];
    unsigned char *bytes;
    size_t size;
    uint32_t sums[ROADS];
    char goes[ROADS]; /* there is a road for it */
    int descriptor;   /* of a file in memory, for the damaged one, as is */
    char path[64];
} Whole;

static int tests, failures, count = 24;
static uint32_t first_seed = 1;
static const char *kept_in;

static void report(int ok, const char *name)
{
    tests++;
    failures += !ok;
    printf("%sok %d - %s\n", ok ? "" : "not ", tests, name);
}

static void store(const Whole *whole, const unsigned char *bytes, size_t size)
{
    if (ftruncate(whole->descriptor, 0) || pwrite(whole->descriptor, bytes, size, 0) != (ssize_t)size)
        abort();
}

static void open_whole(Whole *whole, const char *layout, DamageFile kind)
{
    RetexError err = {0};
    RetexSet *set = damage_set(layout, 3);
    snprintf(whole->name, sizeof whole->name, "%s, %s", damage_file_names[kind], layout);
    damage_write(set, kind, test_own_file);
    retex_set_close(&set);
    whole->bytes = test_read_file(test_own_file, &whole->size);
    whole->descriptor = memfd_create("damaged", 0);
    snprintf(whole->path, sizeof whole->path, "/proc/self/fd/%d", whole->descriptor);
    store(whole, whole->bytes, whole->size);
    for (DamageRoad road = 0; road < ROADS; road++)
        whole->goes[road] = damage_go(road, whole->path, &whole->sums[road], &err) == 0;
    if (!whole->goes[ROAD_ROWS] || !whole->goes[ROAD_READ] || !whole->goes[ROAD_WRITE])
        abort();
}

static void close_whole(Whole *whole)
{
    close(whole->descriptor);
    free(whole->bytes);
}

static Outcome go(const Whole *whole, DamageRoad road)
{
    RetexError err = {0};
    uint32_t sum = 0;
    if (damage_go(road, whole->path, &sum, &err))
        return err.message[0] ? REFUSED : WITHOUT_A_WORD;
    return sum == whole->sums[road] ? SAME : OTHER;
}

static void limit_oneself(void)
{
    const struct rlimit cpu = {CPU_SECONDS, CPU_SECONDS}, memory = {(rlim_t)4 << 30, (rlim_t)4 << 30}, none = {0, 0};
    setrlimit(RLIMIT_CPU, &cpu);
    setrlimit(RLIMIT_CORE, &none);
    if (LIMIT_MEMORY)
        setrlimit(RLIMIT_AS, &memory);
    alarm(WALL_SECONDS);
}

/* Every kind of damage meets every road. */
static DamageRoad second_road(int number)
{
    return (DamageRoad)(1 + (number + number / DAMAGE_KINDS) % (ROADS - 1));
}

/* In a process of its own: row by row, and another road. */
static Outcome try_file(const Whole *whole, int number)
{
    int status;
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        const DamageRoad road = second_road(number);
        limit_oneself();
        Outcome outcome = go(whole, ROAD_ROWS), second = whole->goes[road] ? go(whole, road) : outcome;
        _exit(outcome == SAME && second == REFUSED ? REFUSED : second > outcome ? second : outcome);
    }
    if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) < REFUSED)
        return ENDED_BADLY;
    return (Outcome)WEXITSTATUS(status);
}

static void keep(const Whole *whole, int number, const unsigned char *bytes, size_t size)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%.8s-%u-%d", kept_in, whole->name, (unsigned)first_seed, number);
    FILE *file = fopen(path, "wb");
    if (file && fwrite(bytes, 1, size, file) == size)
        printf("# kept as %s\n", path);
    if (file)
        fclose(file);
}

static void damage_in_all_ways(const Whole *whole)
{
    unsigned char *bytes = malloc(whole->size + DAMAGE_ROOM);
    int found[OUTCOMES - REFUSED] = {0}, inputs = 0;
    for (int i = 0; i < count; i++) {
        uint32_t seed = first_seed * 1000003u + (uint32_t)i * 7919u;
        const DamageKind kind = (DamageKind)(i % DAMAGE_KINDS);
        for (int k = 0; k < 8; k++) /* seeds beside each other begin alike */
            test_random(&seed);
        memcpy(bytes, whole->bytes, whole->size);
        const size_t size = damage_change(bytes, whole->size, kind, &seed);
        if (size == whole->size && memcmp(bytes, whole->bytes, size) == 0)
            continue;
        store(whole, bytes, size);
        const Outcome outcome = try_file(whole, i);
        found[outcome - REFUSED]++;
        inputs++;
        if (outcome > SAME)
            printf("# %s: input %d of seed %u, %s, on the road of rows or %s: %s\n", whole->name, i,
                   (unsigned)first_seed, damage_kind_names[kind], damage_road_names[second_road(i)],
                   outcome_names[outcome - REFUSED]);
        if (outcome > SAME && kept_in)
            keep(whole, i, bytes, size);
    }
    printf("# %s: %d inputs: ", whole->name, inputs);
    for (int k = 0; k < OUTCOMES - REFUSED; k++)
        printf("%s %d%s", outcome_names[k], found[k], k + 1 < OUTCOMES - REFUSED ? ", " : "\n");
    report(found[REFUSED - REFUSED] > 0 && found[REFUSED - REFUSED] + found[SAME - REFUSED] == inputs, whole->name);
    free(bytes);
}

/* Every digit of the manifest is another one. */
static void change_digits(const Whole *whole)
{
    char name[80];
    RetexSet *set;
    RetexError err;
    int accepted = 0, digits = 0;
    unsigned char *bytes = malloc(whole->size + 1);
    memcpy(bytes, whole->bytes, whole->size);
    unsigned char *at = memmem(bytes, whole->size, "{\"retex\"", 8);
    if (!at)
        abort();
    for (; *at >= ' '; at++) {
        const unsigned char kept = *at;
        if (kept < '0' || kept > '9')
            continue;
        *at = (unsigned char)('0' + (kept - '0' + 1 + digits % 9) % 10);
        if (pwrite(whole->descriptor, at, 1, at - bytes) != 1)
            abort();
        const int code = retex_set_open(whole->path, &set, 1, &err);
        accepted += code != RETEX_EFORMAT && code != RETEX_EUNSUPPORTED;
        retex_set_close(&set);
        *at = kept;
        if (pwrite(whole->descriptor, at, 1, at - bytes) != 1)
            abort();
        digits++;
    }
    snprintf(name, sizeof name, "%s: digits of the manifest", whole->name);
    printf("# %s: %d, accepted %d\n", name, digits, accepted);
    report(digits > 100 && !accepted, name);
    free(bytes);
}

int main(int argc, char **argv)
{
    static const char *const layouts[] = {"footprints", "paper"};
    if (argc > 1)
        count = atoi(argv[1]);
    if (argc > 2)
        first_seed = (uint32_t)strtoul(argv[2], NULL, 10);
    if (argc > 3)
        kept_in = argv[3];
    if (test_make_folder(NULL))
        return 2;
    damage_begin(test_folder);
    for (int layout = 0; layout < 2; layout++)
        for (DamageFile kind = 0; kind < DAMAGE_FILES; kind++) {
            Whole whole = {.size = 0};
            open_whole(&whole, layouts[layout], kind);
            store(&whole, whole.bytes, whole.size);
            change_digits(&whole);
            damage_in_all_ways(&whole);
            close_whole(&whole);
        }
    damage_end();
    test_remove_folder(NULL);
    printf("1..%d\n", tests);
    return failures > 0;
}
