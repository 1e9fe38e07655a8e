/* retex-studio: a local web application around the tools. See retex-studio(1). */
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/retex.h>

#include "common/cli.h"
#include "studio/browser.h"
#include "studio/studio.h"
#include "common/watchdog.h"

typedef struct Options {
    const char *file, *textures[PLACES_TEXTURES];
    int port, no_browser, is_unsafe, ntextures;
} Options;

static void take_textures(Cli *cli, const CliOption *option, void *to)
{
    Options *given = to;
    if (given->ntextures == PLACES_TEXTURES)
        cli_die(cli, "--%s: at most %d folders are taken", option->name, PLACES_TEXTURES);
    given->textures[given->ntextures++] = cli->value;
}

static const CliOption options[] = {
    {"port", 0, "N", "listen on this port of 127.0.0.1; 0, the default: a free one", 0,
     CLI_NUMBER(Options, port, 0, 65535)},
    {"no-browser", 0, NULL, "print the address only, without opening it", 0, CLI_INTO(Options, no_browser)},
    {"textures", 0, "FOLDER", "show the images of this folder; may be given several times", 0,
     CLI_CALL_OF_ALL(take_textures)},
    {"unsafe", 0, NULL, "run the tools without --safe and its limits, for scenes of one's own", 0,
     CLI_INTO(Options, is_unsafe)},
    {0},
};

static void parse(Cli *cli, Options *given)
{
    cli_parse(cli, given, CLI_ARGUMENTS(&given->file), "one model is enough");
    if (given->is_unsafe && cli->access.safe)
        cli_die(cli, "--unsafe cannot be given with --safe or RETEX_SAFE");
}

static void open_studio(const Cli *cli, const Options *given, Studio *studio)
{
    RetexError err = {0};
    if (changes_open(&studio->changes, &err) || gate_open(&studio->gate, &err) ||
        places_open(&studio->places, &studio->changes, &err))
        cli_fail(cli, &err);
    for (int i = 0; i < given->ntextures; i++)
        if (places_add_textures(&studio->places, given->textures[i], &err))
            cli_fail(cli, &err);
    if (given->file && places_open_model(&studio->places, given->file, &err))
        cli_fail(cli, &err);
    studio->limits = (ProgramLimits){given->is_unsafe, retex_budget_memory(cli->budget)};
    watch_open(&studio->watch);
    project_open(&studio->project, &studio->changes);
    jobs_open(&studio->jobs, &studio->changes);
    preview_open(&studio->preview, &studio->changes);
    thumbs_open(&studio->thumbs, cli->budget);
}

static void close_studio(Studio *studio)
{
    jobs_close(&studio->jobs);
    preview_close(&studio->preview);
    project_close(&studio->project);
    thumbs_close(&studio->thumbs);
    watch_close(&studio->watch);
    places_close(&studio->places);
    changes_close(&studio->changes);
}

/* The address is the key to all that the user may do: a file that has it is for nobody else, whoever could read it
 * before. */
static void write_address(const Cli *cli, const char *address)
{
    RetexError err = {0};
    struct stat info;
    const char *output = cli->output ? cli->output : "-";
    const int is_file = strcmp(output, "-") != 0 && stat(output, &info) == 0 && S_ISREG(info.st_mode);
    if (is_file && chmod(output, 0600) != 0)
        cli_die(cli, "cannot keep %s from others: %s", output, strerror(errno));
    const mode_t before = umask(077);
    if (retex_file_write(output, address, strlen(address), &err))
        cli_fail(cli, &err);
    umask(before);
}

/* ---- the thread that runs programs ---- */

/* Wait until a program says something, a file changes or a window asks for something; then go on with all of it. */
static void go_on(Studio *studio, int milliseconds)
{
    struct pollfd files[JOBS_FILES + PREVIEW_FILES + 2];
    uint64_t woken;
    int count = jobs_poll(&studio->jobs, files);
    count += preview_poll(&studio->preview, files + count);
    files[count++] = (struct pollfd){studio->changes.wake, POLLIN, 0};
    files[count++] = (struct pollfd){studio->watch.file, POLLIN, 0};
    poll(files, (nfds_t)count, milliseconds);
    (void)!read(studio->changes.wake, &woken, sizeof woken);
    watch_go_on(&studio->watch, &studio->places, &studio->project);
    preview_go_on(&studio->preview);
    jobs_go_on(&studio->jobs);
}

static int is_quitting(Studio *studio)
{
    changes_lock(&studio->changes);
    const int quits = studio->is_quitting;
    changes_unlock(&studio->changes);
    return quits;
}

/* Until a signal, the end of --max-time or a window ends it. Programs are told as Ctrl-C tells them, so that a render
 * keeps its rows; those that have not ended after some time are ended. */
static void run(const Cli *cli, Studio *studio)
{
    enum { LOOK_MILLISECONDS = 250, ENDING_MILLISECONDS = 20, LAST_SECONDS = 60 };
    while (!retex_budget_is_stopped(cli->budget) && !is_quitting(studio))
        go_on(studio, LOOK_MILLISECONDS);
    changes_lock(&studio->changes);
    changes_end(&studio->changes);
    changes_unlock(&studio->changes);
    const double until = retex_clock_seconds() + LAST_SECONDS;
    int running = jobs_end(&studio->jobs, SIGINT) + preview_end(&studio->preview, 0);
    while (running && retex_clock_seconds() < until) {
        go_on(studio, ENDING_MILLISECONDS);
        running = jobs_end(&studio->jobs, 0) + preview_end(&studio->preview, 0);
    }
    if (jobs_end(&studio->jobs, SIGKILL) + preview_end(&studio->preview, SIGKILL))
        go_on(studio, ENDING_MILLISECONDS);
}

int main(int argc, char **argv)
{
    static Studio studio;
    Options given = {0};
    Cli cli = {.tool = "retex-studio",
               .usage = "[FILE] [--textures FOLDER]",
               .about = "Retexture a model in the browser: see it, choose surfaces, render, change textures.",
               .options = options,
               .argc = argc,
               .argv = argv,
               .next = 1,
               .is_server = 1};
    RetexError err = {0};
    Http *http = NULL;
    char address[128], *opened = NULL;
    parse(&cli, &given);
    watchdog_let_keep(1);
    open_studio(&cli, &given, &studio);
    if (http_open(&http, &studio, given.port, &err))
        cli_fail(&cli, &err);
    watchdog_end_is_right(1);
    retex_budget_hold(cli.budget); /* programs may take their time to keep what they have */
    snprintf(address, sizeof address, "http://127.0.0.1:%d/%s/\n", studio.gate.port, studio.gate.token);
    write_address(&cli, address);
    if (!given.no_browser)
        browser_open(address, &opened);
    run(&cli, &studio);
    http_close(&http);
    browser_close(&opened);
    close_studio(&studio);
    return cli_close(&cli, CLI_OK);
}
