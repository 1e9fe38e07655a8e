/* retex-diff: compare two pictures, and check the difference against limits. See retex-diff(1). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <retex/diff.h>

#include "common/cli.h"
#include "common/json_text.h"

typedef struct Request {
    RetexDiffParams params;
    const char *names[2]; /* of the files */
    int files, json;
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

static void take_file(Cli *cli, void *to)
{
    Request *request = to;
    if (request->files == 2)
        cli_die(cli, "more than two files: '%s'", cli->value);
    request->names[request->files++] = cli->value;
}

static void parse(Cli *cli, Request *request)
{
    cli_parse(cli, request, take_file);
    if (request->files < 2)
        cli_die(cli, "two files are needed; try --help");
    if (request->params.part && request->params.all_parts)
        cli_die(cli, "--part and --all-parts exclude each other");
}

/* Print a figure, or null if it is not defined: the part has no colours. */
static void print_json_figure(FILE *out, const char *name, double value, int defined)
{
    if (defined)
        fprintf(out, "\"%s\": %.9g, ", name, value);
    else
        fprintf(out, "\"%s\": null, ", name);
}

/* Print the keys of one part, without braces. */
static void print_json_part(FILE *out, const RetexDiffPart *part)
{
    const RetexMetrics *m = &part->metrics;
    int color = part->compared && part->has_color;
    fprintf(out, "\"part\": ");
    json_text(out, part->name);
    fprintf(out, ", \"width\": %d, \"height\": %d, \"channels\": %d, ", part->width, part->height, part->channels);
    print_json_figure(out, "psnr", m->psnr, color);
    print_json_figure(out, "relmse", m->relmse, color);
    print_json_figure(out, "mae", m->mae, part->compared);
    print_json_figure(out, "flip_mean", m->flip_mean, color);
    print_json_figure(out, "flip_p99", m->flip_p99, color);
    print_json_figure(out, "max_abs", m->max_abs, part->compared);
    print_json_figure(out, "max_rel", m->max_rel, part->compared);
    fprintf(out, "\"nonfinite\": %ld, ", m->nonfinite);
    if (part->compared) {
        fprintf(out, "\"worst\": {\"x\": %d, \"y\": %d, \"channel\": ", m->worst.x, m->worst.y);
        json_text(out, part->worst_channel);
        fprintf(out, "}, ");
    } else {
        fprintf(out, "\"worst\": null, ");
    }
    fprintf(out, "\"reason\": ");
    json_text(out, part->reason);
}

/* Print the first part's figures; with --all-parts also a list of all parts. */
static void print_json(FILE *out, const RetexDiff *diff, int all_parts)
{
    fprintf(out, "{\"differs\": %s, ", diff->differs ? "true" : "false");
    if (diff->nparts)
        print_json_part(out, &diff->parts[0]);
    else
        print_json_part(out, &(RetexDiffPart){0});
    if (all_parts) {
        fprintf(out, ", \"parts\": [");
        for (int i = 0; i < diff->nparts; i++) {
            fprintf(out, "%s{", i ? ", " : "");
            print_json_part(out, &diff->parts[i]);
            fprintf(out, "}");
        }
        fprintf(out, "]");
    }
    fprintf(out, ", \"why\": ");
    json_text(out, diff->reason);
    fprintf(out, "}\n");
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
    if (request.json)
        print_json(cli.answer, diff, params->all_parts);
    for (int i = 0; !request.json && !cli.quiet && i < diff->nparts; i++)
        print_line(cli.answer, &diff->parts[i], params->all_parts);
    if (!request.json && !cli.quiet && differs && (!diff->nparts || params->all_parts))
        fprintf(cli.answer, "%s\n", cli_plain(diff->reason));
    retex_diff_close(&diff);
    return cli_close(&cli, differs ? CLI_NO : CLI_OK);
}
