/* retex-diff: compare two pictures, and check the difference against limits. See retex-diff(1). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <retex/diff.h>

#include "common/cli.h"
#include "common/json.h"

typedef struct Request {
    RetexDiffParams params;
    const char *names[2]; /* of the files */
    int json;
} Request;

static const CliOption options[] = {
    {"json", 0, NULL, "print the figures as JSON", 0, CLI_INTO(Request, json)},
    {"part", 0, "NAME", "compare the parts called NAME, not the first part of each file", 0,
     CLI_INTO(Request, params.part)},
    {"all-parts", 0, NULL, "compare all parts, by name", 0, CLI_INTO(Request, params.all_parts)},
    {"allow-inf", 0, NULL, "treat infinities of the same sign as equal", 0, CLI_INTO(Request, params.allow_inf)},
    {"fail-psnr", 0, "DB", "fail if the PSNR is below DB", 0, CLI_NUMBER(Request, params.fail_psnr, 0, 120)},
    {"fail-relmse", 0, "X", "fail if relMSE is above X", 0, CLI_NUMBER(Request, params.fail_relmse, 0, 1e30)},
    {"fail-flip", 0, "X", "fail if the mean of FLIP is above X", 0, CLI_NUMBER(Request, params.fail_flip, 0, 1)},
    {"fail-abs", 0, "X", "fail if any value differs by more than X", 0, CLI_NUMBER(Request, params.fail_abs, 0, 1e30)},
    {"fail-rel", 0, "X", "fail if any value differs by more than X times that of B", 0,
     CLI_NUMBER(Request, params.fail_rel, 0, 1e30)},
    {0},
};

static void parse(Cli *cli, Request *request)
{
    cli_parse(cli, request, CLI_ARGUMENTS(&request->names[0], &request->names[1]), "two files are enough");
    if (!request->names[1])
        cli_die(cli, "two files are needed; try --help");
    if (request->params.part && request->params.all_parts)
        cli_die(cli, "--part and --all-parts exclude each other");
}

/* A figure, or null if it is not defined: the part has no colours. */
static json_t *figure(double value, int defined)
{
    return defined ? json_of_number(value) : json_null();
}

static json_t *describe_part(const RetexDiffPart *part)
{
    const RetexMetrics *m = &part->metrics;
    const int color = part->compared && part->has_color;
    json_t *worst = part->compared ? json_pack("{s:i, s:i, s:o}", "x", m->worst.x, "y", m->worst.y, "channel",
                                               json_of_text(part->worst_channel))
                                   : json_null();
    return json_pack("{s:o, s:i, s:i, s:i, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:I, s:o, s:o}", "part",
                     json_of_text(part->name), "width", part->width, "height", part->height, "channels",
                     part->channels, "psnr", figure(m->psnr, color), "relmse", figure(m->relmse, color), "mae",
                     figure(m->mae, part->compared), "flip_mean", figure(m->flip_mean, color), "flip_p99",
                     figure(m->flip_p99, color), "max_abs", figure(m->max_abs, part->compared), "max_rel",
                     figure(m->max_rel, part->compared), "nonfinite", (json_int_t)m->nonfinite, "worst", worst,
                     "reason", json_of_text(part->reason));
}

/* The first part's figures; with --all-parts also a list of all parts. */
static json_t *describe(const RetexDiff *diff, int all_parts)
{
    json_t *whole = json_pack("{s:b}", "differs", diff->differs), *parts = all_parts ? json_array() : NULL;
    json_object_update_new(whole, describe_part(diff->nparts ? &diff->parts[0] : &(RetexDiffPart){0}));
    for (int i = 0; parts && i < diff->nparts; i++)
        json_add(&parts, describe_part(&diff->parts[i]));
    if (parts)
        json_object_set_new(whole, "parts", parts);
    json_object_set_new(whole, "why", json_of_text(diff->reason));
    return whole;
}

/* Print one line per part: its figures, and why it differs. */
static void print_line(FILE *out, RetexDiffPart *part, int name)
{
    const RetexMetrics *m = &part->metrics;
    cli_plain(part->name), cli_plain(part->worst_channel), cli_plain(part->reason);
    if (name)
        fprintf(out, "%s: ", part->name);
    if (part->compared && part->has_color)
        fprintf(out, "psnr %.2f relmse %.4g mae %.4g flip %.4g (p99 %.4g) ", m->psnr, m->relmse, m->mae, m->flip_mean,
                m->flip_p99);
    if (part->compared)
        fprintf(out, "max %.4g rel %.4g at %d,%d %s%s", m->max_abs, m->max_rel, m->worst.x, m->worst.y,
                part->worst_channel, part->reason[0] ? ": " : "");
    fprintf(out, "%s\n", part->reason);
}

int main(int argc, char **argv)
{
    Cli cli = {
        .tool = "retex-diff",
        .usage = "[options] A B [-o FILE]",
        .options = options,
        .argc = argc,
        .argv = argv,
        .about =
            "Compare picture A with the reference B. The exit status is 0 if they are the same or within the limits "
            "given, 1 if they differ."};
    Request request = {.params = RETEX_DIFF_INIT};
    RetexDiffParams *params = &request.params;
    RetexDiff *diff = NULL;
    RetexError err = {0};

    parse(&cli, &request);
    for (int i = 0; i < 2; i++) {
        cli_input(&cli, request.names[i], "an OpenEXR file");
        cli_reads(&cli, i ? "B" : "A", request.names[i]);
    }
    cli_answer(&cli);
    params->access = &cli.access;
    params->budget = cli.budget;
    params->warn = cli_warn_text;
    params->warn_context = &cli;
    if (retex_diff(&diff, request.names[0], request.names[1], params, cli.threads, &err))
        cli_fail(&cli, &err);
    int differs = diff->differs;
    if (request.json && json_print_line(cli.answer, describe(diff, params->all_parts), 9))
        cli_die(&cli, "not enough memory");
    for (int i = 0; !request.json && !cli.quiet && i < diff->nparts; i++)
        print_line(cli.answer, &diff->parts[i], params->all_parts);
    if (!request.json && !cli.quiet && differs && (!diff->nparts || params->all_parts))
        fprintf(cli.answer, "%s\n", cli_plain(diff->reason));
    retex_diff_close(&diff);
    return cli_close(&cli, differs ? CLI_NO : CLI_OK);
}
