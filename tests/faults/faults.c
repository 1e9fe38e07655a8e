/* Runs commands again and again, a call failing in each: faults ROADS SHIM KNOWN MOST LIBRARIES FOLDER
 *
 * ROADS is roads.txt; its commands run in FOLDER, which holds what they read, and in copies beside it. KNOWN is
 * known.txt. Of each road and kind of call at most MOST
 * of our own calls fail in turn, spread evenly over all; 0: every one. LIBRARIES is how many of the libraries' fail in
 * all roads together. JOBS of the environment run at a time. Prints TAP, a result for each road.
 *
 * A run with a fault must end in exit 2 with one line of error, the old files whole, nothing left over; or, where the
 * fault does no harm, as the run without a fault did, to the bit. Of a batch a file may be either. The manifest of a
 * catalogue must have the checksum of each picture that it has, and the same command without a fault must go on. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <zlib.h>

enum {
    ROADS = 40,
    WORDS = 40,
    FILES = 32,
    KINDS = 7,
    NAME = 64,
    PATH = 512,
    TEXT = 1 << 14,
    SECONDS = 120, /* a busy machine may need half a minute */
    JOBS_MOST = 16
};

static const char *const kinds[KINDS] = {"memory", "read", "write", "open", "rename", "thread", "map"};
static const char *const owners[2] = {"own", "library"};
static const char old_content[] = "what was there before\n";

typedef struct Bytes {
    char *data;
    size_t size;
} Bytes;

typedef struct Road {
    char name[NAME], line[PATH], *words[WORDS], *input;
    int nfiles, status;
    int makes_folder;        /* which must not be there before */
    int is_catalogue;        /* writes out/manifest */
    char files[FILES][NAME]; /* in out/, as the run without a fault leaves them */
    Bytes contents[FILES], output;
    long counts[KINDS][2];
} Road;

static Road roads[ROADS];
static int nroads;
static char shim[PATH];

static void die(const char *what, const char *name)
{
    fprintf(stderr, "faults: %s %s: %s\n", what, name, strerror(errno));
    exit(1);
}

static Bytes read_all(const char *path)
{
    Bytes b = {0};
    struct stat info;
    FILE *f = fopen(path, "rb");

    if (!f || fstat(fileno(f), &info))
        die("cannot read", path);
    b.data = malloc((size_t)info.st_size + 1);
    if (!b.data)
        die("no memory for", path);
    b.size = fread(b.data, 1, (size_t)info.st_size, f);
    b.data[b.size] = 0;
    fclose(f);
    return b;
}

static int same(Bytes a, const void *data, size_t size)
{
    return a.size == size && memcmp(a.data, data, size) == 0;
}

static void write_text(const char *path, const char *text)
{
    FILE *f = fopen(path, "wb");

    if (!f || fputs(text, f) == EOF || fclose(f))
        die("cannot write", path);
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *where)
{
    (void)info, (void)kind;
    return where->level > 0 && remove(path) != 0;
}

static void empty_folder(const char *path)
{
    nftw(path, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

/* The files below a folder, by their names in it. */
typedef struct Listing {
    char names[2 * FILES][NAME];
    int count;
} Listing;
static Listing listing; /* of the last list_folder */

static int list_entry(const char *path, const struct stat *info, int kind, struct FTW *where)
{
    (void)info;
    const char *name = strchr(path, '/'); /* the folder's own name has none */
    if (where->level > 0 && kind == FTW_F && listing.count < 2 * FILES)
        snprintf(listing.names[listing.count++], NAME, "%.60s", name + 1);
    return 0;
}

static void list_folder(const char *path)
{
    listing.count = 0;
    nftw(path, list_entry, 8, FTW_PHYS);
}

static void read_roads(const char *path)
{
    const char *only = getenv("FAULTS_ROADS");
    FILE *f = fopen(path, "r");

    if (!f)
        die("cannot read", path);
    while (nroads < ROADS && fgets(roads[nroads].line, PATH, f)) {
        Road *road = &roads[nroads];
        int count = 0;
        char *word = strtok(road->line, " \n"), *name = word;
        if (!word || *word == '#' || (only && !strstr(only, word)))
            continue;
        while ((word = strtok(NULL, " \n")) && count < WORDS - 1)
            road->words[count++] = word;
        if (count > 2 && strcmp(road->words[count - 2], "<") == 0) {
            road->input = road->words[count - 1];
            count -= 2;
        }
        road->words[count] = NULL;
        road->makes_folder = strcmp(name, "import") == 0;
        road->is_catalogue = strncmp(name, "catalogue", 9) == 0;
        snprintf(road->name, sizeof road->name, "%s", name);
        nroads++;
    }
    fclose(f);
}

/* ---- a run ---- */

static void become(const Road *road, const char *fault)
{
    const char *input = road->input ? road->input : "/dev/null";

    if (!freopen(input, "rb", stdin) || !freopen("log/output", "wb", stdout) || !freopen("log/errors", "wb", stderr))
        _exit(127);
    setenv("LD_PRELOAD", shim, 1);
    setenv("FAULT", fault, 1);
    setenv("FAULT_REPORT", "log/report", 1);
    setenv("TMPDIR", "tmp", 1);
    alarm(SECONDS); /* for who hangs */
    execvp(road->words[0], road->words);
    _exit(127);
}

/* Those that a file is in. */
static void make_folders(char *path)
{
    for (char *slash = strchr(path, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        mkdir(path, 0777);
        *slash = '/';
    }
}

/* Whether a file's name has the checksum of its content, as in folders for browsers: none with other content has been
 * there before. */
static int has_checksum(const char *name)
{
    const char *dash = strrchr(name, '-');
    return dash && strspn(dash + 1, "0123456789abcdef") == 8 && dash[9] == '.';
}

static int is_manifest(const Road *road, const char *name)
{
    return road->is_catalogue && strcmp(name, "manifest") == 0;
}

/* Returns what waitpid says. */
static int start(const Road *road, const char *fault)
{
    int status = -1;
    pid_t child;

    empty_folder("tmp");
    empty_folder("log");
    fflush(NULL);
    child = fork();
    if (child == 0)
        become(road, fault);
    if (child < 0 || waitpid(child, &status, 0) != child)
        die("cannot run", road->name);
    return status;
}

static int run(const Road *road, const char *fault)
{
    empty_folder("out");
    for (int k = 0; k < road->nfiles && !road->makes_folder; k++) {
        char path[PATH];
        snprintf(path, sizeof path, "out/%s", road->files[k]);
        if (has_checksum(road->files[k]) || is_manifest(road, road->files[k]))
            continue;
        make_folders(path);
        write_text(path, old_content);
    }
    return start(road, fault);
}

static void list_files(Road *road)
{
    list_folder("out");
    for (int i = 0; i < listing.count && i < FILES; i++) {
        char path[PATH];
        memcpy(road->files[i], listing.names[i], NAME);
        snprintf(path, sizeof path, "out/%s", road->files[i]);
        road->contents[i] = read_all(path);
        road->nfiles++;
    }
}

/* Without a fault: what it leaves, and how many calls there are. */
static void run_without(Road *road)
{
    char kind[NAME], owner[NAME], line[PATH];
    long count;
    int status = run(road, "none");
    FILE *f = fopen("log/report", "r");

    if (!WIFEXITED(status) || WEXITSTATUS(status) == 2 || !f) {
        fprintf(stderr, "faults: %s does not run\n%s", road->name, read_all("log/errors").data);
        exit(1);
    }
    while (fgets(line, sizeof line, f))
        if (sscanf(line, "count %63s %63s %ld", kind, owner, &count) == 3)
            for (int k = 0; k < KINDS; k++)
                if (strcmp(kind, kinds[k]) == 0)
                    road->counts[k][strcmp(owner, "own") != 0] = count;
    fclose(f);
    road->status = WEXITSTATUS(status);
    road->output = read_all("log/output");
    list_files(road);
}

/* ---- judging ---- */

/* One line of error, and nothing else but it. */
static const char *judge_message(void)
{
    Bytes errors = read_all("log/errors");
    const char *what = NULL, *at;

    at = strstr(errors.data, "error: ");
    if (errors.size == 0)
        what = "no message";
    else if (strncmp(errors.data, "retex-", 6) != 0 || !at || strlen(at) < 12)
        what = "not an error message";
    else if (strchr(errors.data, '\n') != errors.data + errors.size - 1)
        what = "more than one line";
    free(errors.data);
    return what;
}

/* The files in a folder: those of the road and no others. */
static const char *judge_folder(const Road *road, const char *folder, int failed)
{
    const char *what = NULL;

    list_folder(folder);
    for (int i = 0; i < listing.count; i++) {
        int known = 0;
        for (int k = 0; k < road->nfiles; k++)
            known |= strcmp(road->files[k], listing.names[i]) == 0 && strcmp(folder, "out") == 0 &&
                     !(failed && has_checksum(road->files[k]));
        /* --resume promises to keep that. */
        if (!known && !(strncmp(road->name, "render-resume", 13) == 0 && strstr(listing.names[i], ".partial")))
            what = "a file is left";
    }
    return what;
}

static const char *judge_files(const Road *road, int failed)
{
    /* files that are made one by one, or put in place so */
    int batch = strcmp(road->name, "batch") == 0 || road->is_catalogue || strcmp(road->name, "import-again") == 0;
    const int web = strcmp(road->name, "pack-web") == 0;

    for (int k = 0; k < road->nfiles; k++) {
        char path[PATH];
        snprintf(path, sizeof path, "out/%s", road->files[k]);
        if (failed && road->makes_folder) {
            if (!access(path, F_OK))
                return "a file is left";
            continue;
        }
        if ((failed && has_checksum(road->files[k])) || is_manifest(road, road->files[k]))
            continue; /* judge_folder finds it, if it is left; or judge_manifest looks at it */
        if (access(path, R_OK))
            return failed ? "the old file is gone" : "no output";
        Bytes now = read_all(path);
        int is_old = same(now, old_content, sizeof old_content - 1),
            is_new = same(now, road->contents[k].data, road->contents[k].size);
        free(now.data);
        int may_be_new = batch || (web && strcmp(road->files[k], "room.json") != 0); /* the player, of any version */
        if (failed && !is_old && !(may_be_new && is_new))
            return is_new ? "the output is there all the same" : "the old file is damaged";
        if (!failed && !is_new)
            return is_old ? "no output" : "another output";
    }
    return NULL;
}

/* Whether each picture that is in the manifest has the checksum there; all = 1: whether it has each picture. */
static const char *judge_manifest(int all, const Road *road)
{
    Bytes manifest = access("out/manifest", F_OK) ? (Bytes){calloc(1, 1), 0} : read_all("out/manifest");
    const char *what = NULL;
    int found = 0;

    for (char *line = manifest.data, *end; !what && (end = strchr(line, '\n')) != NULL; line = end + 1) {
        char path[NAME];
        unsigned long crc, bytes;
        *end = '\0';
        const char *made = strstr(line, ", \"bytes\": ");
        if (!made || sscanf(line, "{\"output\": \"%63[^\"]", path) != 1 ||
            sscanf(made, ", \"bytes\": %lu, \"crc32\": \"%lx\", \"seconds\": %*f}", &bytes, &crc) != 2)
            continue; /* cut off */
        Bytes picture = read_all(path);
        if (picture.size != bytes || crc32(0, (const Bytef *)picture.data, (uInt)picture.size) != crc)
            what = "the manifest lies";
        free(picture.data);
        found++;
    }
    free(manifest.data);
    return what || !all || found == road->nfiles - 1 ? what : "the manifest lacks a picture";
}

static long manifest_bytes(void)
{
    struct stat info;
    return stat("out/manifest", &info) ? 0 : (long)info.st_size;
}

/* Whether the same command, without a fault, makes what is missing after a failure, and nothing otherwise. */
static const char *judge_resumed(const Road *road, int failed)
{
    const long before = manifest_bytes();
    const int status = start(road, "none");
    const char *what;

    if (!WIFEXITED(status) || WEXITSTATUS(status) != road->status)
        return "does not go on";
    if (!failed && manifest_bytes() != before)
        return "makes a picture again";
    what = judge_files(road, 0);
    return what ? what : judge_manifest(1, road);
}

/* A picture or an image that cannot be read is not good, says --verify, and why. */
static int is_verdict(const Road *road, int status)
{
    if (strcmp(road->name, "verify") != 0 || WEXITSTATUS(status) != 1)
        return 0;
    Bytes now = read_all("log/output");
    int is_told = strstr(now.data, ": cannot ") != NULL;
    free(now.data);
    return is_told;
}

static const char *judge(const Road *road, int status)
{
    const char *what;

    if (WIFSIGNALED(status))
        return WTERMSIG(status) == SIGALRM ? "hangs" : "killed by a signal";
    int failed = WEXITSTATUS(status) == 2;
    if (is_verdict(road, status))
        return NULL;
    if (!failed && WEXITSTATUS(status) != road->status)
        return "another exit status";
    if (failed && (what = judge_message()) != NULL)
        return what;
    if ((what = judge_files(road, failed)) || (what = judge_folder(road, "out", failed)) ||
        (what = judge_folder(road, "tmp", failed)) ||
        (road->is_catalogue && (what = judge_manifest(!failed, road)) != NULL))
        return what;
    if (failed)
        return road->is_catalogue ? judge_resumed(road, 1) : NULL;
    Bytes now = read_all("log/output");
    int equal = strcmp(road->name, "plan") == 0 /* tells times */ || same(now, road->output.data, road->output.size);
    free(now.data);
    if (!equal)
        return "another standard output";
    return road->is_catalogue ? judge_resumed(road, 0) : NULL;
}

/* ---- all faults ---- */

/* What failed, from the shim's report; 0 where nothing did. */
static int what_fired(char *text)
{
    FILE *f = fopen("log/report", "r");
    int fired = 0;

    *text = 0;
    while (f && fgets(text, PATH, f) && !(fired = strncmp(text, "fired ", 6) == 0))
        continue;
    if (f)
        fclose(f);
    text[strcspn(text, "\n")] = 0;
    return fired;
}

/* tests/faults/known.txt: lines `KIND MODULE REASON`, of calls in libraries that cannot be helped. KIND verdict: only
 * that retex-info --check calls a file damaged. */
static int is_known(const char *kind, const char *fired, const Bytes *known)
{
    char line[PATH], of[NAME], module[NAME];

    for (const char *at = known->data; at < known->data + known->size; at += strcspn(at, "\n") + 1) {
        snprintf(line, sizeof line, "%.*s", (int)strcspn(at, "\n"), at);
        if (sscanf(line, "%63s %63s", of, module) == 2 && strcmp(of, kind) == 0 && strstr(fired, module))
            return 1;
    }
    return 0;
}

/* Returns 1 for a finding, and prints it into the pipe. */
static int try_fault(const Road *road, const char *fault, const char *kind, const Bytes *known, FILE *out)
{
    char fired[PATH];
    int status = run(road, fault);

    what_fired(fired); /* before judge_resumed writes another report */
    const char *what = judge(road, status);
    if (!what && getenv("FAULTS_TELL") && WEXITSTATUS(status) == 2)
        fprintf(out, "# told %s %s: %s", road->name, fired, read_all("log/errors").data);
    if (!what)
        return 0;
    if (is_known(kind, fired, known) ||
        (is_known("verdict", fired, known) && WIFEXITED(status) && WEXITSTATUS(status) == 1))
        return 0;
    Bytes errors = read_all("log/errors");
    fprintf(out, "# %s %s: %s (status %d) after %s: %.*s\n", road->name, fault, what,
            WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), *fired ? fired + 6 : "nothing",
            (int)strcspn(errors.data, "\n"), errors.data);
    fflush(out);
    free(errors.data);
    return 1;
}

typedef struct Tally {
    int tried[ROADS], found[ROADS];
} Tally;

/* A share of all faults, in a folder of its own. */
static void try_share(int job, int jobs, long most, long libraries, Bytes known, FILE *out, Tally *tally)
{
    long index = 0;
    unsigned seed = 1;

    for (int r = 0; r < nroads; r++) {
        const Road *road = &roads[r];
        for (int k = 0; k < KINDS; k++)
            for (int own = 1; own >= 0; own--) {
                long count = road->counts[k][!own];
                /* The libraries' share of each road and kind, at places by chance. */
                long tries = own ? (most && count > most ? most : count) : libraries / (nroads * 4) + 1;
                for (long i = 0; i < tries && count > 0 && (own || libraries > 0); i++) {
                    char fault[NAME];
                    seed = seed * 1664525u + 1013904223u;
                    long n = own ? 1 + i * count / tries : 1 + (long)((double)count * (seed >> 8) / 16777216.0);
                    if (index++ % jobs != job)
                        continue;
                    snprintf(fault, sizeof fault, "%s:%s:%ld", kinds[k], owners[!own], n);
                    tally->tried[r]++;
                    tally->found[r] += try_fault(road, fault, kinds[k], &known, out);
                }
            }
        if (index++ % jobs == job) {
            tally->tried[r]++;
            tally->found[r] += try_fault(road, "short", "short", &known, out);
        }
    }
}

int main(int argc, char **argv)
{
    int jobs = getenv("JOBS") ? atoi(getenv("JOBS")) : 2, failed = 0;
    Tally *tallies = mmap(NULL, JOBS_MOST * sizeof *tallies, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    Bytes known;

    if (argc != 7 || !realpath(argv[2], shim) || tallies == MAP_FAILED || chdir(argv[6]))
        die("usage: faults ROADS SHIM KNOWN MOST LIBRARIES FOLDER", "");
    jobs = jobs < 1 ? 1 : jobs > JOBS_MOST ? JOBS_MOST : jobs;
    read_roads(argv[1]);
    known = read_all(argv[3]);
    for (int r = 0; r < nroads; r++)
        run_without(&roads[r]);
    printf("1..%d\n", nroads);
    fflush(stdout);
    for (int job = 0; job < jobs; job++)
        if (fork() == 0) {
            char folder[NAME], command[PATH];
            snprintf(folder, sizeof folder, "../job%d", job);
            snprintf(command, sizeof command, "cp -r . %s", folder);
            if (system(command) || chdir(folder))
                die("cannot make", folder);
            try_share(job, jobs, atol(argv[4]), atol(argv[5]), known, stdout, &tallies[job]);
            _exit(0);
        }
    while (wait(NULL) > 0)
        continue;
    for (int r = 0; r < nroads; r++) {
        int tried = 0, found = 0;
        for (int job = 0; job < jobs; job++)
            tried += tallies[job].tried[r], found += tallies[job].found[r];
        printf("%s %d - %s: %d faults\n", found || !tried ? "not ok" : "ok", r + 1, roads[r].name, tried);
        failed |= found > 0;
    }
    return failed;
}
