/* retex-pack: compress a set to a pack, or decompress a pack. See retex-pack(1). */
#include <stdio.h>
#include <string.h>

#include <retex/host/set_build.h>
#include <retex/output_file.h>
#include <retex/pack.h>
#include <retex/set_file.h>

#include "common/cli.h"
#include "page/page.h"

static const CliOption options[] = {
    {"quality", 0, "1..100", "lowest quality of pictures made from the pack; default 90, with --web 60", 0},
    {"lossless", 0, NULL, "keep every bit of every part", 0},
    {"codec", 0, "NAME", "codec for light and albedo: jpeg, the default", 0},
    {"stats", 0, "FILE.json", "write sizes by use and the loss in pictures; - is standard output", 0},
    {"memory", 0, "SIZE", "keep the set in memory if it takes at most SIZE; default 2048 MB", 0},
    {"levels", 0, NULL, "keep smaller sets beside it, for small pictures", 0},
    {"level", 0, "3..8", "with --unpack: write the set that is so many times smaller", 0},
    {"no-lamps", 0, NULL, "leave out the lamps, which then cannot be changed", 0},
    {"unpack", 0, NULL, "read a pack and write a set, SET.exr", 0},
    {"web", 0, "DIR", "write a folder with a page that shows the set in browsers", 0},
    {"preset", 0, "FILE", "the look that the page begins with, as of retex-combine --save-preset", 0},
    {"web-lamps", 0, "N", "lamps that visitors can change; default 4, the dimmest others join `rest`", 0},
    {"web-smaller", 0, "N,...", "rooms beside it, 2, 3, 4, 6 or 8 times smaller, for small screens", 0},
    {0},
};

typedef struct Job {
    RetexPackParams params;
    int unpack, quality_given, no_lamps;
    int level;       /* 0: not given */
    int web_lamps;   /* 0: not given */
    int web_smaller[RETEX_WEB_SMALLER];
    uint64_t memory; /* bytes */
    int threads;
    const char *input, *stats, *web, *preset;
} Job;

/* Scales, divided by commas. */
static void parse_smaller(Cli *cli, Job *job)
{
    int count = 0;
    for (const char *at = cli->value; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        const int scale = *at - '0';
        if (!memchr("23468", *at, 5) || (at[1] && at[1] != ',') || count == RETEX_WEB_SMALLER)
            cli_die(cli, "--web-smaller: expected up to %d of 2, 3, 4, 6 and 8, divided by commas, not '%s'",
                    RETEX_WEB_SMALLER, cli->value);
        job->web_smaller[count++] = scale;
    }
}

static void parse(Cli *cli, Job *job)
{
    const CliOption *option;
    while ((option = cli_next(cli))) {
        if (option == &cli_positional) {
            if (job->input)
                cli_surplus(cli, "one input is enough");
            job->input = cli->value;
        } else if (strcmp(option->name, "quality") == 0) {
            job->params.quality = (int)cli_integer(cli, option, 1, 100);
            job->quality_given = 1;
        } else if (strcmp(option->name, "lossless") == 0) {
            job->params.lossless = 1;
        } else if (strcmp(option->name, "codec") == 0) {
            if (strcmp(cli->value, "jpeg") != 0)
                cli_die(cli, "--codec: there is no codec '%s'; this version has: jpeg", cli->value);
        } else if (strcmp(option->name, "stats") == 0) {
            job->stats = cli->value;
        } else if (strcmp(option->name, "levels") == 0) {
            job->params.levels = 1;
        } else if (strcmp(option->name, "level") == 0) {
            job->level = (int)cli_integer(cli, option, 2, 8);
        } else if (strcmp(option->name, "no-lamps") == 0) {
            job->no_lamps = 1;
        } else if (strcmp(option->name, "web") == 0) {
            job->web = cli->value;
        } else if (strcmp(option->name, "preset") == 0) {
            job->preset = cli->value;
        } else if (strcmp(option->name, "web-lamps") == 0) {
            job->web_lamps = (int)cli_integer(cli, option, 1, RETEX_PARAMETERS_MAX);
        } else if (strcmp(option->name, "web-smaller") == 0) {
            parse_smaller(cli, job);
        } else if (strcmp(option->name, "memory") == 0) {
            job->memory = cli_size(cli, option);
        } else {
            job->unpack = 1;
        }
    }
    if (!job->input)
        cli_die(cli, "no %s given; try --help", job->unpack ? "pack" : "set");
    if (job->params.lossless && job->quality_given)
        cli_die(cli, "--quality and --lossless exclude each other");
    if (job->unpack && (job->params.lossless || job->quality_given))
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
    if (job->web && (job->unpack || job->params.lossless || job->params.levels || job->stats || cli->output))
        cli_die(cli, "--web writes a folder: it takes neither -o, --unpack, --lossless, --levels nor --stats");
    if (job->web_lamps && (!job->web || job->no_lamps))
        cli_die(cli, "--web-lamps is of --web, and of sets that keep their lamps");
    if (job->preset && !job->web)
        cli_die(cli, "--preset is of --web");
    if (*job->web_smaller && !job->web)
        cli_die(cli, "--web-smaller is of --web");
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
    int code = retex_set_open(pack_path, &pack, NULL, job->threads, err);
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
    if (strcmp(job->stats, "-") != 0 && retex_set_write_check(job->stats, &err))
        cli_die(cli, "--stats: %s", err.message);
}

/* Read the smaller set of a pack that --level asks for. */
static int read_level(Cli *cli, const Job *job, RetexSet **set, RetexError *err)
{
    RetexPackLevel level = {.size = sizeof level};
    int found = 0, code = retex_set_open(job->input, set, NULL, job->threads, err);
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
               : whole    ? retex_set_read(job->input, set, NULL, cli->threads, err)
                          : cli_open_set(cli, set, job->input, job->memory, err);
    if (!code && job->no_lamps)
        code = retex_set_drop_lamps(*set, err);
    return code;
}

static int run_web(Cli *cli, const Job *job)
{
    Page page = {job->web, job->preset, RETEX_WEB_INIT};
    RetexError err = {0};
    RetexSet *set = NULL;
    page.params.quality = job->quality_given ? job->params.quality : page.params.quality;
    page.params.lamps = job->web_lamps ? job->web_lamps : page.params.lamps;
    memcpy(page.params.smaller, job->web_smaller, sizeof page.params.smaller);
    cli_input(cli, job->input, "a set, as from retex-render");
    cli_reads(cli, "the set", job->input);
    page_announce(cli, &page);
    int code = open_set(cli, job, &set, &err);
    if (!code) {
        cli_check_pixels(cli, set, job->input);
        code = page_write(cli, &page, job->input, set, &err);
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
    Job job = {.params = RETEX_PACK_INIT, .memory = CLI_MEMORY_DEFAULT};
    RetexError err = {0};
    RetexSet *set = NULL;
    size_t bytes = 0;

    parse(&cli, &job);
    if (job.web)
        return run_web(&cli, &job);
    const char *output = cli_output(&cli);
    cli_input(&cli, job.input, job.unpack ? "a pack" : "a set, as from retex-render");
    if (cli_ends_with(output, job.unpack ? ".retex" : ".exr"))
        cli_die(&cli,
                job.unpack ? "%s: --unpack writes an OpenEXR file, .exr"
                           : "%s: a pack is no OpenEXR file; its name ends in .retex",
                output);
    cli_reads(&cli, job.unpack ? "the pack" : "the set", job.input);
    cli_writes(&cli, "the output", output);
    cli_writes(&cli, "--stats", job.stats);
    check_stats(&cli, &job, output);
    if (retex_set_write_check(output, &err))
        cli_fail(&cli, &err);
    int code = open_set(&cli, &job, &set, &err);
    if (code)
        cli_fail(&cli, &err);
    cli_check_pixels(&cli, set, job.input);
    if (job.unpack) {
        RetexStoreParams store = RETEX_STORE_INIT;
        code = retex_set_write(set, NULL, output, &store, cli.threads, &err);
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
