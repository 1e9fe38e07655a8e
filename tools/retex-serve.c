/* retex-serve: pictures of rooms by URL. See retex-serve(1). */
#include <errno.h>
#include <limits.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <retex/retex.h>

#include "common/beneath.h"
#include "common/cli.h"
#include "serve/http/http.h"
#include "serve/request/parse.h"
#include "common/watchdog.h"

typedef struct Job {
    const char *folder, *textures, *presets;
    uint64_t memory, texture_memory, picture_memory; /* bytes */
    const char *uploads;
    uint64_t upload_size, upload_total; /* bytes */
    long upload_pixels;
    int upload_count;
    double upload_age, upload_time;
    int queue, quality;
    const char *sign; /* a URL to be signed; NULL: serve */
    HttpParams http;
} Job;

static void take_base(Cli *cli, const CliOption *option, void *to)
{
    (void)option;
    const size_t length = strlen(cli->value);
    if (length >= 256 || (strncmp(cli->value, "http://", 7) != 0 && strncmp(cli->value, "https://", 8) != 0) ||
        cli->value[length - 1] == '/' || strpbrk(cli->value, " \"<>\\\n"))
        cli_die(cli, "--base-url: expected a URL such as https://example.org, without a slash at its end, not '%s'",
                cli->value);
    *(const char **)to = cli->value;
}

static void read_keys(Cli *cli, const CliOption *option, void *keys)
{
    (void)option;
    RetexError err = {0};
    if (keys_read(keys, cli->value, &err))
        cli_fail(cli, &err);
}

static void add_proxy(Cli *cli, const CliOption *option, void *to)
{
    (void)option;
    Trusted *proxies = to;
    if (proxies->count == TRUSTED_MAX)
        cli_die(cli, "--trusted-proxy: at most %d are taken", TRUSTED_MAX);
    if (trusted_add(proxies, cli->value))
        cli_die(cli,
                "--trusted-proxy: expected an address such as 127.0.0.1, or a network such as 10.0.0.0/8, not '%s'",
                cli->value);
}

static const CliOption options[] = {
    {"port", 0, "N", "listen on this port; 0: a free one, which is printed; default 8080", 0,
     CLI_NUMBER(Job, http.port, 0, 65535)},
    {"listen", 0, "ADDRESS", "listen on this address; default 127.0.0.1", 0, CLI_INTO(Job, http.address)},
    {"textures", 0, "FOLDER", "images that a URL may name; without it there are only colours", 0,
     CLI_INTO(Job, textures)},
    {"presets", 0, "FOLDER", "presets that a URL may name, files NAME.json as retex-combine writes them", 0,
     CLI_INTO(Job, presets)},
    {"quality", 0, "N", "quality of JPEG, WebP, AVIF and JPEG XL if the URL has none, 1 to 100; default 95", 0,
     CLI_NUMBER(Job, quality, 1, 100)},
    {"memory", 0, "SIZE", "keep decoded rooms of at most SIZE in memory; default 2048 MB", 0, CLI_INTO(Job, memory)},
    {"texture-memory", 0, "SIZE", "keep images of textures of at most SIZE in memory; default 512 MB", 0,
     CLI_INTO(Job, texture_memory)},
    {"picture-memory", 0, "SIZE", "keep finished pictures of at most SIZE in memory; default 128 MB", 0,
     CLI_INTO(Job, picture_memory)},
    {"queue", 0, "N", "let at most N pictures wait; what is beyond is answered by 503; default 512", 0,
     CLI_NUMBER(Job, queue, 0, 100000)},
    {"deadline", 0, "SECONDS", "give up a picture that takes longer, waiting included; default 300", 0,
     CLI_NUMBER(Job, http.deadline, 0.001, 3600)},
    {"connections", 0, "N", "accept at most N connections; default 1000", 0,
     CLI_NUMBER(Job, http.connections, 1, 100000)},
    {"per-client", 0, "N", "accept at most N connections of one client, N/8 images; 0: any number; default 64", 0,
     CLI_NUMBER(Job, http.per_client, 0, 100000)},
    {"trusted-proxy", 0, "ADDRESS", "clients of this proxy, or of a network a.b.c.d/BITS, are those it tells", 0,
     CLI_CALL(Job, http.proxies, add_proxy)},
    {"key-file", 0, "FILE", "answer only URLs that are signed by one of the keys in FILE", 0,
     CLI_CALL(Job, http.keys, read_keys)},
    {"sign", 0, "URL", "print URL signed by the first key of --key-file, and end", 0, CLI_INTO(Job, sign)},
    {"min-rate", 0, "N", "close a connection that sends fewer than N bytes of an image a second; default 1000", 0,
     CLI_NUMBER(Job, http.min_rate, 0, 1e9)},
    {"timeout", 0, "SECONDS", "close a connection that is silent, or sends a request for longer; default 30", 0,
     CLI_NUMBER(Job, http.timeout, 0.1, 3600)},
    {"max-age", 0, "SECONDS", "let others keep an answer so long without asking again; default 60", 0,
     CLI_NUMBER(Job, http.max_age, 0, 31536000)},
    {"uploads", 0, "FOLDER", "accept images by POST and keep them in FOLDER; by default none are accepted", 0,
     CLI_INTO(Job, uploads)},
    {"upload-size", 0, "SIZE", "accept an image of at most SIZE; default 16 MB", 0, CLI_INTO(Job, upload_size)},
    {"upload-pixels", 0, "N", "accept an image of at most N pixels; default 25000000", 0,
     CLI_NUMBER(Job, upload_pixels, 1, 1 << 28)},
    {"upload-count", 0, "N", "keep at most N images; default 1000", 0, CLI_NUMBER(Job, upload_count, 1, 1000000)},
    {"upload-total", 0, "SIZE", "keep images of at most SIZE in all; default 1024 MB", 0, CLI_INTO(Job, upload_total)},
    {"upload-age", 0, "SECONDS", "delete an image after this time; 0: never; default 86400, a day", 0,
     CLI_NUMBER(Job, upload_age, 0, 1e9)},
    {"upload-time", 0, "SECONDS", "give up an image that takes longer to decode; default 10", 0,
     CLI_NUMBER(Job, upload_time, 0.01, 60)},
    {"base-url", 0, "URL", "the server's URL as clients know it; default that of this machine", 0,
     CLI_CALL(Job, http.base, take_base)},
    {0},
};

static void parse(Cli *cli, Job *job)
{
    cli_parse(cli, job, CLI_ARGUMENTS(&job->folder), "one folder of rooms is enough");
    if (job->sign && !job->http.keys.count)
        cli_die(cli, "--sign needs a key: add --key-file FILE");
    if (!job->folder && !job->sign)
        cli_die(cli, "no folder of rooms given");
}

/* ---- signatures ---- */

/* Where the path of a URL begins, which may be all there is of it. */
static const char *find_path(const Cli *cli, const char *url)
{
    const char *host = strncmp(url, "https://", 8) == 0 ? url + 8 : strncmp(url, "http://", 7) == 0 ? url + 7 : NULL;
    const char *path = host ? strchr(host, '/') : url;
    if (!path || *path != '/' || path == host)
        cli_die(cli, "--sign: expected a URL such as https://example.org/v1/room/full.jpg, or its path, not '%s'", url);
    return path;
}

/* Print what clients are to ask for. A URL that would be refused is not signed, nor one that browsers would change: its
 * signature would not be that of what they send. */
static void print_signed(const Cli *cli, const char *url, const Keys *keys)
{
    const char *path = find_path(cli, url), *odd = path;
    char signature[SIGNATURE_LENGTH + 1], *text = NULL;
    ServeRequest request;
    RetexError err = {0};
    while (*odd > ' ' && *odd < 0x7f && !strchr("\"#'<>[\\]^`{|}", *odd))
        odd++;
    if (*odd)
        cli_die(cli, "--sign: in '%s' there are characters to be percent-encoded, the first one behind '%.*s'", url,
                (int)(odd - url), url);
    if (strcmp(path, "/v1/uploads") != 0 && serve_request_parse(&request, path, NULL, (1u << SERVE_FORMATS) - 1))
        cli_die(cli, "--sign: %s", request.reason);
    if (asprintf(&text, "%.*s/%s%s\n", (int)(path - url), url, keys_sign(keys, path, signature), path) < 0)
        cli_die(cli, "not enough memory");
    if (retex_file_write(cli->output ? cli->output : "-", text, strlen(text), &err))
        cli_fail(cli, &err);
    free(text);
}

/* ---- start ---- */

/* The folders of images and presets. */
typedef struct Folders {
    RetexAccess access; /* to those of images alone, wherever links lead, and in the formats of safe access */
    const char *roots[2], *preset_roots[1];
    RetexAccess access_to_presets; /* to that folder alone */
    char *textures, *uploads, *presets; /* or NULL */
} Folders;

static char *find_folder(const Cli *cli, RetexAccess *access, const char **roots, const char *option, const char *name)
{
    char *path = name ? realpath(name, NULL) : NULL;
    if (name && !path)
        cli_die(cli, "%s: there is no folder %s", option, name);
    if (path)
        roots[access->nroots++] = path;
    return path;
}

/* Of a folder that is written to, and that may have come with the rooms, from a stranger. */
static void refuse_link(const Cli *cli, const char *option, const char *name)
{
    const int top = name ? beneath_open_top(name, 0) : -1;
    if (name && top < 0 && errno == ELOOP)
        cli_die(cli, "%s: %s is a link; give the folder that it leads to", option, name);
    if (top >= 0)
        close(top);
}

static void allow_folders(const Cli *cli, const Job *job, Folders *folders)
{
    *folders = (Folders){.access = RETEX_ACCESS_INIT};
    folders->access.safe = 1;
    folders->access.accept_damaged = cli->access.accept_damaged;
    folders->access.roots = folders->roots;
    folders->textures = find_folder(cli, &folders->access, folders->roots, "--textures", job->textures);
    refuse_link(cli, "--uploads", job->uploads);
    folders->uploads = find_folder(cli, &folders->access, folders->roots, "--uploads", job->uploads);
    folders->access_to_presets = (RetexAccess)RETEX_ACCESS_INIT;
    folders->access_to_presets.safe = 1;
    folders->access_to_presets.roots = folders->preset_roots;
    folders->presets =
        find_folder(cli, &folders->access_to_presets, folders->preset_roots, "--presets", job->presets);
}

/* A budget of what is read; that of cli is stopped while requests are still being answered. */
static RetexBudget *new_budget(const Cli *cli, long pixels)
{
    RetexBudget *budget = NULL;
    RetexError err = {0};
    if (retex_budget_create(&budget, &err))
        cli_fail(cli, &err);
    retex_budget_set_memory(budget, retex_budget_memory(cli->budget));
    retex_budget_set_pixels(budget, !cli->limits.pixels || pixels < cli->limits.pixels ? pixels : cli->limits.pixels);
    return budget;
}

/* So many bytes, but at most a share of --max-memory, so that what is kept leaves enough for the work. */
static uint64_t share_of(const Cli *cli, uint64_t bytes, unsigned share)
{
    const uint64_t most = retex_budget_memory(cli->budget) / share;
    return most && most < bytes ? most : bytes;
}

static void open_uploads(const Cli *cli, const Job *job, Site *site, const Folders *folders, RetexBudget *budget)
{
    const UploadsParams params = {.folder = folders->uploads,
                                  .most_bytes = (size_t)job->upload_size,
                                  .total_bytes = job->upload_total,
                                  .most = job->upload_count,
                                  .seconds = job->upload_age,
                                  .budget = budget,
                                  .decoding = job->upload_time};
    RetexError err = {0};
    if (folders->uploads && uploads_open(&site->uploads, &params, &err))
        cli_fail(cli, &err);
}

static void open_site(const Cli *cli, const Job *job, Site *site, const Folders *folders, RetexBudget *budget)
{
    RetexError err = {0};
    const RoomsParams rooms = {job->folder, share_of(cli, job->memory, 2), cli->limits.pixels, cli->threads};
    const ImagesParams images = {folders->textures, folders->uploads, share_of(cli, job->texture_memory, 8),
                                 &folders->access,  budget,           cli->threads,
                                 job->upload_time};
    if (rooms_open(&site->rooms, &rooms, &err) || images_open(&site->images, &images, &err))
        cli_fail(cli, &err);
    if (!(site->pictures = cache_open((size_t)share_of(cli, job->picture_memory, 16))))
        cli_die(cli, "not enough memory");
    site->quality = job->quality;
    site->presets = (Presets){folders->presets, &folders->access_to_presets};
}

/* Print the address, or write it to the file of -o, when the server can be reached. */
static void tell_address(const Cli *cli, const Http *http, const char *address)
{
    RetexError err = {0};
    char text[512];
    snprintf(text, sizeof text, strchr(address, ':') ? "http://[%s]:%d\n" : "http://%s:%d\n", address, http_port(http));
    if (retex_file_write(cli->output ? cli->output : "-", text, strlen(text), &err))
        cli_fail(cli, &err);
}

/* ---- until the end ---- */

static void sleep_milliseconds(long milliseconds)
{
    const struct timespec time = {milliseconds / 1000, milliseconds % 1000 * 1000000};
    nanosleep(&time, NULL);
}

static void serve(const Cli *cli, Http *http, Work *works[], int count)
{
    enum { LOOK_MILLISECONDS = 50, LAST_SECONDS = 5 };
    while (!retex_budget_is_stopped(cli->budget)) {
        sleep_milliseconds(LOOK_MILLISECONDS);
        http_sweep(http);
    }
    http_refuse(http);
    for (int i = 0; i < count; i++)
        work_refuse(works[i]);
    /* what was accepted is finished; then clients have some time to take it */
    for (double until = 0; http_pending(http) && (!until || retex_clock_seconds() < until);) {
        int is_busy = 0;
        for (int i = 0; i < count; i++) {
            const WorkCount work = work_count(works[i]);
            is_busy |= work.waiting || work.running;
        }
        if (!until && !is_busy)
            until = retex_clock_seconds() + LAST_SECONDS;
        sleep_milliseconds(LOOK_MILLISECONDS);
        http_sweep(http);
    }
}

/* Keep freed memory in the process, as retex-combine does, but in few places. */
static void keep_memory(int threads)
{
#ifdef __GLIBC__
    mallopt(M_TRIM_THRESHOLD, INT_MAX);
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_ARENA_MAX, threads + 1);
#else
    (void)threads;
#endif
}

int main(int argc, char **argv)
{
    static Job job = {
        .memory = CLI_MEMORY_DEFAULT,
        .texture_memory = 512 << 20,
        .picture_memory = 128 << 20,
        .queue = 512,
        .quality = 95,
        .upload_size = 16 << 20,
        .upload_total = 1024 << 20,
        .upload_pixels = 25000000,
        .upload_count = 1000,
        .upload_age = 86400,
        .upload_time = 10,
        .http = {.address = "127.0.0.1",
                 .port = 8080,
                 .connections = 1000,
                 .per_client = 64,
                 .min_rate = 1000,
                 .timeout = 30,
                 .deadline = 300,
                 .max_age = 60}};
    Cli cli = {.tool = "retex-serve",
               .usage = "FOLDER [--port N] [--textures FOLDER]",
               .about = "Serve pictures of sets and packs, with the textures that URLs name.",
               .options = options,
               .argc = argc,
               .argv = argv,
               .next = 1,
               .is_server = 1};
    RetexError err = {0};
    Folders folders;
    Site site = {0};
    Http *http = NULL;
    parse(&cli, &job);
    if (job.sign) {
        print_signed(&cli, job.sign, &job.http.keys);
        return 0;
    }
    watchdog_let_keep(1);
    keep_memory(retex_threads(cli.threads));
    allow_folders(&cli, &job, &folders);
    RetexBudget *budget = new_budget(&cli, LONG_MAX), *upload_budget = new_budget(&cli, job.upload_pixels);
    open_site(&cli, &job, &site, &folders, budget);
    open_uploads(&cli, &job, &site, &folders, upload_budget);
    /* images of strangers never take the last place */
    const int threads = retex_threads(cli.threads), decoders = threads > 1 ? threads - 1 : 1;
    const WorkParams pictures = {site_make, &site, threads, job.queue}, texts = {site_make, &site, 1, job.queue},
                     uploads = {site_make, &site, decoders, job.queue};
    if (work_open(&job.http.pictures, &pictures, &err) || work_open(&job.http.texts, &texts, &err) ||
        (site.uploads && work_open(&job.http.uploads, &uploads, &err)))
        cli_fail(&cli, &err);
    job.http.site = &site;
    job.http.is_quiet = cli.quiet;
    if (http_open(&http, &job.http, &err))
        cli_fail(&cli, &err);
    watchdog_end_is_right(1);
    retex_budget_hold(cli.budget);
    tell_address(&cli, http, job.http.address);
    Work *works[] = {job.http.pictures, job.http.texts, job.http.uploads};
    const int count = site.uploads ? 3 : 2;
    serve(&cli, http, works, count);
    for (int i = 0; i < count; i++)
        work_close(works[i]);
    http_close(http);
    cache_close(site.pictures);
    images_close(site.images);
    rooms_close(site.rooms);
    uploads_close(site.uploads);
    retex_budget_close(&budget);
    retex_budget_close(&upload_budget);
    free(folders.textures);
    free(folders.presets);
    free(folders.uploads);
    return cli_close(&cli, CLI_OK);
}
