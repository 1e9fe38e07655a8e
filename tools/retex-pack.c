/* retex-pack: compress a set to a pack, or decompress a pack. See retex-pack(1). */
#include <stdio.h>
#include <string.h>

#include <retex/host/set_build.h>
#include <retex/output_file.h>
#include <retex/pack.h>
#include <retex/set_file.h>

#include "common/cli.h"
#include "common/set_kind.h"
#include "page/page.h"

typedef struct Job {
    RetexPackParams params;
    int quality, unpack, no_lamps; /* quality: 0: not given */
    int level, web_lamps;          /* 0: not given */
    uint64_t memory;               /* bytes */
    int threads;
    const char *input, *stats;
    Page page; /* no folder: none is asked for */
} Job;

static void take_codec(Cli *cli, const CliOption *option, void *member)
{
    (void)option;
    (void)member;
    if (strcmp(cli->value, "jpeg") != 0)
        cli_die(cli, "--codec: there is no codec '%s'; this version has: jpeg", cli->value);
}

/* Scales, divided by commas. */
static void take_smaller(Cli *cli, const CliOption *option, void *member)
{
    int *smaller = member, count = 0;
    for (const char *at = cli->value; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        const int scale = *at - '0';
        if (!memchr("23468", *at, 5) || (at[1] && at[1] != ',') || count == RETEX_WEB_SMALLER)
            cli_die(cli, "--%s: expected up to %d of 2, 3, 4, 6 and 8, divided by commas, not '%s'", option->name,
                    RETEX_WEB_SMALLER, cli->value);
        smaller[count++] = scale;
    }
}

static const CliOption options[] = {
    {"quality", 0, "1..100", "lowest quality of pictures made from the pack; default 90, with --web 60", 0,
     CLI_NUMBER(Job, quality, 1, 100)},
    {"lossless", 0, NULL, "keep every bit of every part", 0, CLI_INTO(Job, params.lossless)},
    {"codec", 0, "NAME", "codec for light and albedo: jpeg, the default", 0, CLI_CALL_OF_ALL(take_codec)},
    {"stats", 0, "FILE.json", "write sizes by use and the loss in pictures; - is standard output", 0,
     CLI_INTO(Job, stats)},
    {"memory", 0, "SIZE", "keep the set in memory if it takes at most SIZE; default 2048 MB", 0, CLI_INTO(Job, memory)},
    {"levels", 0, NULL, "keep smaller sets beside it, for small pictures", 0, CLI_INTO(Job, params.levels)},
    {"level", 0, "3..8", "with --unpack: write the set that is so many times smaller", 0,
     CLI_NUMBER(Job, level, 2, 8)},
    {"no-lamps", 0, NULL, "leave out the lamps, which then cannot be changed", 0, CLI_INTO(Job, no_lamps)},
    {"unpack", 0, NULL, "read a pack and write a set, SET.exr", 0, CLI_INTO(Job, unpack)},
    {"web", 0, "DIR", "write a folder with a page that shows the set in browsers", 0, CLI_INTO(Job, page.folder)},
    {"preset", 0, "FILE", "the look that the page begins with, as of retex-combine --save-preset", 0,
     CLI_INTO(Job, page.preset)},
    {"web-lamps", 0, "N", "lamps that visitors can change; default 4, the dimmest others join `rest`", 0,
     CLI_NUMBER(Job, web_lamps, 1, RETEX_PARAMETERS_MAX)},
    {"web-smaller", 0, "N,...", "rooms beside it, 2, 3, 4, 6 or 8 times smaller, for small screens", 0,
     CLI_CALL(Job, page.params.smaller, take_smaller)},
    {0},
};

static void parse(Cli *cli, Job *job)
{
    cli_parse(cli, job, CLI_ARGUMENTS(&job->input), "one input is enough");
    if (!job->input)
        cli_die(cli, "no %s given; try --help", job->unpack ? "pack" : "set");
    if (job->params.lossless && job->quality)
        cli_die(cli, "--quality and --lossless exclude each other");
    if (job->unpack && (job->params.lossless || job->quality))
        cli_die(cli, "--unpack takes neither --quality nor --lossless");
    if (job->unpack && job->no_lamps)
        cli_die(cli, "--no-lamps is of packing");
    if (job->unpack && job->params.levels)
        cli_die(cli, "--levels is of packing; --unpack takes --level");
    if (job->level && !job->unpack)
        cli_die(cli, "--level is of --unpack");
    if (job->level && strcmp(job->input, "-") == 0)
        cli_die(cli, "--level reads the pack twice: it must be a file");
    if (job->unpack && job->stats)
        cli_die(cli, "--stats is of packing");
    if (job->page.folder && (job->unpack || job->params.lossless || job->params.levels || job->stats || cli->output))
        cli_die(cli, "--web writes a folder: it takes neither -o, --unpack, --lossless, --levels nor --stats");
    if (job->web_lamps && (!job->page.folder || job->no_lamps))
        cli_die(cli, "--web-lamps is of --web, and of sets that keep their lamps");
    if (job->page.preset && !job->page.folder)
        cli_die(cli, "--preset is of --web");
    if (*job->page.params.smaller && !job->page.folder)
        cli_die(cli, "--web-smaller is of --web");
    if (job->quality)
        job->params.quality = job->page.params.quality = job->quality;
    if (job->web_lamps)
        job->page.params.lamps = job->web_lamps;
    job->threads = cli->threads;
    job->params.warn = cli_warn_text;
    job->params.warn_context = cli;
}

static void report(const Cli *cli, const char *set_path, double set_bytes, const char *pack_path, double pack_bytes)
{
    char ratio[64] = "";
    if (set_bytes > 0 && pack_bytes > 0)
        snprintf(ratio, sizeof ratio, " (ratio %.2f)", set_bytes / pack_bytes);
    if (set_bytes > 0)
        cli_info(cli, "set %s: %.0f bytes", set_path, set_bytes);
    if (pack_bytes > 0)
        cli_info(cli, "pack %s: %.0f bytes%s", pack_path, pack_bytes, ratio);
}

/* Compare pictures from the set, which is still open, with pictures from the written pack. */
static int write_stats(const Job *job, const RetexSet *set, const char *pack_path, double pack_bytes, RetexError *err)
{
    static const char *const names[RETEX_PACK_LOSSES] = {"original", "white", "waves", "squares"};
    RetexSet *pack = NULL;
    double psnr[RETEX_PACK_LOSSES];
    RetexPackPromise promise;
    uint64_t bytes[RETEX_PACK_USES];
    char text[2048], quality[16] = "null";
    int code = retex_set_open(pack_path, &pack, job->threads, err);
    if (!code)
        code = retex_pack_loss(psnr, RETEX_PACK_LOSSES, pack, set, job->threads, err);
    if (!code) {
        double rest = pack_bytes;
        retex_pack_bytes(bytes, RETEX_PACK_USES, pack, NULL);
        for (int i = 0; i < RETEX_PACK_USES; i++)
            rest -= (double)bytes[i];
        bytes[RETEX_PACK_OTHER] += (uint64_t)rest;
        if (!job->params.lossless)
            snprintf(quality, sizeof quality, "%d", job->params.quality);
        int n = snprintf(text, sizeof text,
                         "{\n  \"codec\": \"%s\",\n  \"quality\": %s,\n  \"set_bytes\": %.0f,\n"
                         "  \"pack_bytes\": %.0f,\n  \"bytes\": {",
                         job->params.lossless ? "lossless" : "jpeg", quality, cli_file_size(job->input), pack_bytes);
        for (int i = 0; i < RETEX_PACK_USES; i++)
            n += snprintf(text + n, sizeof text - (size_t)n, "%s\"%s\": %llu", i ? ", " : "", retex_pack_use_name(i),
                          (unsigned long long)bytes[i]);
        n += snprintf(text + n, sizeof text - (size_t)n, "},\n  \"psnr\": {");
        for (int i = 0; i < RETEX_PACK_LOSSES; i++)
            n += snprintf(text + n, sizeof text - (size_t)n, "%s\"%s\": %.2f", i ? ", " : "", names[i], psnr[i]);
        n += snprintf(text + n, sizeof text - (size_t)n, "}");
        if (!retex_pack_promise(&promise, pack, NULL))
            n += snprintf(text + n, sizeof text - (size_t)n, ",\n  \"promised\": %.2f,\n  \"measured\": %.2f",
                          promise.promised, promise.measured);
        n += snprintf(text + n, sizeof text - (size_t)n, "\n}\n");
        code = retex_file_write(job->stats, text, (size_t)n, err);
    }
    retex_set_close(&pack);
    return code;
}

/* --stats reads the pack again, so the output must be a file. */
static void check_stats(Cli *cli, const Job *job, const char *output)
{
    RetexError err = {0};
    if (!job->stats)
        return;
    if (strcmp(output, "-") == 0)
        cli_die(cli, "--stats reads the pack again: it must be a file, -o FILE.retex");
    if (strcmp(job->stats, "-") != 0 && retex_output_check(job->stats, &err))
        cli_die(cli, "--stats: %s", err.message);
}

/* Read the smaller set of a pack that --level asks for. */
static int read_level(Cli *cli, const Job *job, RetexSet **set, RetexError *err)
{
    RetexPackLevel level = {.size = sizeof level};
    int found = 0, code = retex_set_open(job->input, set, job->threads, err);
    for (int i = 0; !code && !found && retex_pack_level(&level, *set, i); i++)
        found = level.scale == job->level;
    retex_set_close(set);
    if (!code && !found)
        cli_die(cli, "--level: %s has no set that is %d times smaller", job->input, job->level);
    if (!code)
        code = retex_set_open_size(job->input, level.width, level.height, set, job->threads, err);
    return code ? code : retex_set_load(*set, job->threads, err);
}

/* Without its lamps a set is in memory. */
static int open_set(Cli *cli, const Job *job, RetexSet **set, RetexError *err)
{
    const int whole = job->unpack || job->params.lossless || job->no_lamps;
    int code = job->level ? read_level(cli, job, set, err)
               : whole    ? retex_set_read(job->input, set, cli->threads, err)
                          : cli_open_set(cli, set, job->input, job->memory, err);
    if (!code && job->no_lamps)
        code = retex_set_drop_lamps(*set, err);
    return code;
}

static int run_web(Cli *cli, const Job *job)
{
    RetexError err = {0};
    RetexSet *set = NULL;
    cli_input(cli, job->input, "a set, as from retex-render");
    cli_reads(cli, "the set", job->input);
    page_announce(cli, &job->page);
    int code = open_set(cli, job, &set, &err);
    if (!code) {
        cli_check_pixels(cli, set, job->input);
        code = page_write(cli, &job->page, job->input, set, &err);
    }
    retex_set_close(&set);
    if (code)
        cli_fail(cli, &err);
    return cli_close(cli, CLI_OK);
}

int main(int argc, char **argv)
{
    Cli cli = {
        .tool = "retex-pack",
        .options = options,
        .argc = argc,
        .argv = argv,
        .usage = "SET [--quality 1..100 | --lossless] -o FILE.retex\n"
                 "       retex-pack SET [--quality 1..100] [--preset FILE] [--web-lamps N]\n"
                 "                  [--web-smaller N,...] --web DIR\n"
                 "       retex-pack --unpack FILE.retex -o SET.exr",
        .about =
            "Compress a set to one small file, or decompress one. Light is stored as JPEG, footprints without visible "
            "loss."};
    Job job = {.params = RETEX_PACK_INIT, .memory = CLI_MEMORY_DEFAULT, .page = {.params = RETEX_WEB_INIT}};
    RetexError err = {0};
    RetexSet *set = NULL;
    size_t bytes = 0;

    parse(&cli, &job);
    if (job.page.folder)
        return run_web(&cli, &job);
    const char *output = cli_output(&cli);
    cli_input(&cli, job.input, job.unpack ? "a pack" : "a set, as from retex-render");
    if (set_kind_of_name(output) == (job.unpack ? &set_kind_pack : &set_kind_exr))
        cli_die(&cli,
                job.unpack ? "%s: --unpack writes an OpenEXR file, .exr"
                           : "%s: a pack is no OpenEXR file; its name ends in .retex",
                output);
    cli_reads(&cli, job.unpack ? "the pack" : "the set", job.input);
    cli_writes(&cli, "the output", output);
    cli_writes(&cli, "--stats", job.stats);
    check_stats(&cli, &job, output);
    if (retex_output_check(output, &err))
        cli_fail(&cli, &err);
    int code = open_set(&cli, &job, &set, &err);
    if (code)
        cli_fail(&cli, &err);
    cli_check_pixels(&cli, set, job.input);
    if (job.unpack) {
        code = set_kind_exr.write(set, output, cli.threads, &err);
    } else {
        code = retex_pack_write(set, output, &job.params, &bytes, cli.threads, &err);
        if (!code && job.stats)
            code = write_stats(&job, set, output, (double)bytes, &err);
    }
    retex_set_close(&set);
    if (code)
        cli_fail(&cli, &err);
    if (job.unpack)
        report(&cli, output, cli_file_size(output), job.input, cli_file_size(job.input));
    else
        report(&cli, job.input, cli_file_size(job.input), output, (double)bytes);
    return cli_close(&cli, CLI_OK);
}
