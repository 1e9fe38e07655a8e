/* retex-denoise: remove the noise from a set's coefficients, once. See retex-denoise(1). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/clock.h>
#include <retex/denoise.h>
#include <retex/denoise_picture.h>
#include <retex/output_file.h>
#include <retex/set_file.h>

#include "common/cli.h"
#include "common/picture_kind.h"
#include "common/set_kind.h"

/* Strips take as long as the whole set in memory, and a third of the memory at 1920 x 1080. */
#define MEMORY_DEFAULT ((uint64_t)512 << 20)

typedef struct Request {
    const char *input;
    RetexDenoiseParams params;
    uint64_t memory;
    int no_footprints;
    const char **layers;               /* of a picture */
    const char *first_of_pictures;     /* the first option that is for pictures only, or NULL */
    RetexDenoisePictureParams picture; /* of what is no set; stands last: see is_of_pictures */
} Request;

static void take_denoiser(Cli *cli, const CliOption *option, void *to)
{
    if (strcmp(cli->value, "nlm") != 0 && strcmp(cli->value, "oidn") != 0 && strcmp(cli->value, "both") != 0)
        cli_die(cli, "--%s: expected nlm, oidn or both, not '%s'", option->name, cli->value);
    *(const char **)to = cli->value;
}

static void take_quality(Cli *cli, const CliOption *option, void *to)
{
    if (strcmp(cli->value, "preview") != 0 && strcmp(cli->value, "final") != 0)
        cli_die(cli, "--%s: expected preview or final, not '%s'", option->name, cli->value);
    *(const char **)to = cli->value;
}

static void take_layer(Cli *cli, const CliOption *option, void *to)
{
    (void)option;
    Request *r = to;
    r->layers[r->picture.nlayers++] = cli->value;
}

static const CliOption options[] = {
    {"strength", 0, "F", "difference of similar pixels, in standard deviations of their noise, 0.1 to 10; default 1", 0,
     CLI_NUMBER(Request, params.strength, 0.1, 10)},
    {"radius", 0, "N", "radius of the window of similar pixels, 1 to 10 pixels; default 5", 0,
     CLI_NUMBER(Request, params.radius, 1, 10)},
    {"memory", 0, "SIZE", "keep the set in memory if it takes at most SIZE; default 512 MB", 0,
     CLI_INTO(Request, memory)},
    {"denoiser", 0, "nlm|oidn|both",
     "filter of the light: retex's own, which is the default, Open Image Denoise 2, or the mean of both", 0,
     CLI_CALL(Request, params.denoiser, take_denoiser)},
    {"quality", 0, "preview|final", "preview: less time, for interactive use; default final", 0,
     CLI_CALL(Request, params.quality, take_quality)},
    {"no-footprints", 0, NULL, "leave footprints unchanged", 0, CLI_INTO(Request, no_footprints)},
    {"full-precision", 0, NULL, "keep all bits of the set's numbers, in a larger file", 0,
     CLI_INTO(Request, params.full_precision)},
    {"layer", 0, "NAME", "of a picture that is no set: denoise this layer; may be repeated; default: the picture", 0,
     CLI_CALL_OF_ALL(take_layer)},
    {"other-half", 0, "FILE", "a second render of that picture, with as many other samples", 0,
     CLI_INTO(Request, picture.other_half)},
    {"variance", 0, "NAME", "layer with the variance of each pixel's mean", 0, CLI_INTO(Request, picture.variance)},
    {"normal", 0, "NAME", "layer of normals; default: the one of a well known name, as for the three below", 0,
     CLI_INTO(Request, picture.normal)},
    {"albedo", 0, "NAME", "layer of colours of surfaces", 0, CLI_INTO(Request, picture.albedo)},
    {"position", 0, "NAME", "layer of positions", 0, CLI_INTO(Request, picture.position)},
    {"depth", 0, "NAME", "layer of depths, if there are no positions", 0, CLI_INTO(Request, picture.depth)},
    {0},
};

static int is_of_pictures(const CliOption *option)
{
    return option->into.take == take_layer || option->into.at >= offsetof(Request, picture);
}

static void parse(Cli *cli, Request *r)
{
    for (const CliOption *option; (option = cli_next(cli));) {
        if (option == &cli_positional) {
            if (r->input)
                cli_surplus(cli, "one set is enough");
            r->input = cli->value;
            continue;
        }
        cli_take(cli, option, r);
        if (is_of_pictures(option) && !r->first_of_pictures)
            r->first_of_pictures = option->name;
    }
    if (!r->input)
        cli_die(cli, "no set given; - is standard input");
    r->params.footprints = !r->no_footprints;
}

/* The output is a set, or an EXR picture. Refuse names of other formats. */
static void check_ending(const Cli *cli, const char *output, const char *picture)
{
    const PictureKind *kind = picture_kind_of_name(output);
    const int is_other = kind && strcmp(kind->ending, "exr") != 0;
    if (is_other && !picture)
        cli_die(cli, "%s: a set is an OpenEXR file, .exr, or a pack, .retex; pictures are made by retex-combine",
                output);
    if (is_other || (picture && set_kind_of_name(output) == &set_kind_pack))
        cli_die(cli, "%s: a denoised picture is an OpenEXR file, .exr, as %s is", output, picture);
}

static void progress(void *context, double done)
{
    cli_progress(context, "denoise", done);
}

/* A picture of any renderer: the output is the same file with other pixels. */
static int denoise_picture(Cli *cli, Request *r, const char *output)
{
    RetexDenoisePictureParams *p = &r->picture;
    const char *input = r->input, *of_sets = r->no_footprints            ? "no-footprints"
                                             : r->params.full_precision ? "full-precision"
                                                                        : NULL;
    RetexError err = {0};
    if (of_sets)
        cli_die(cli, "--%s: %s is a picture, not a set", of_sets, input);
    check_ending(cli, output, input);
    if (p->other_half) {
        cli_input(cli, p->other_half, "the other half");
        cli_reads(cli, "--other-half", p->other_half);
    }
    p->layers = r->layers;
    p->access = &cli->access;
    p->note = cli_note;
    p->note_context = cli;
    const double began = retex_clock_seconds();
    if (retex_denoise_picture(input, output, p, &r->params, cli->threads, &err))
        cli_fail(cli, &err);
    cli_info(cli, "%s: %.2f s", strcmp(output, "-") == 0 ? "standard output" : output, retex_clock_seconds() - began);
    return cli_close(cli, CLI_OK);
}

static int write_set(const Cli *cli, RetexSet *set, const char *output, RetexError *err)
{
    const SetKind *kind = set_kind_of_name(output);
    return (kind ? kind : &set_kind_exr)->write(set, output, cli->threads, err);
}

int main(int argc, char **argv)
{
    Cli cli = {.tool = "retex-denoise",
               .usage = "SET [--strength F] [--radius N] [--other-half FILE] -o SET",
               .about = "Remove the noise from a set once, and so from all its retextures.",
               .options = options,
               .argc = argc,
               .argv = argv,
               .next = 1};
    RetexSet *set = NULL;
    RetexError err = {0};
    Request request = {.params = RETEX_DENOISE_INIT, .memory = MEMORY_DEFAULT, .picture = RETEX_DENOISE_PICTURE_INIT};
    RetexDenoiseParams *params = &request.params;

    if (!(request.layers = calloc((size_t)argc, sizeof *request.layers)))
        cli_die(&cli, "no memory for the arguments");
    parse(&cli, &request);
    const char *input = request.input, *output = cli_output(&cli);
    const int piped = strcmp(input, "-") == 0;
    cli_input(&cli, input, "a set, as from retex-render");
    cli_reads(&cli, "the set", input);
    cli_writes(&cli, "the output", output);
    params->progress = progress;
    params->progress_context = &cli;
    params->near = output;
    params->budget = cli.budget;
    if (piped ? request.first_of_pictures != NULL : retex_is_picture(input, &cli.access)) {
        const int status = denoise_picture(&cli, &request, output);
        free(request.layers);
        return status;
    }
    if (request.first_of_pictures)
        cli_die(&cli, "--%s is for pictures: %s is a set, or no OpenEXR file", request.first_of_pictures, input);
    free(request.layers);
    check_ending(&cli, output, NULL);
    if (retex_output_check(output, &err))
        cli_fail(&cli, &err);
    const double began = retex_clock_seconds();
    if (cli_open_set(&cli, &set, input, request.memory, &err))
        cli_fail(&cli, &err);
    const double read = retex_clock_seconds();
    if (retex_denoise(set, params, NULL, cli.threads, &err))
        cli_fail(&cli, &err);
    const double denoised = retex_clock_seconds();
    if (write_set(&cli, set, output, &err))
        cli_fail(&cli, &err);
    const double written = retex_clock_seconds();

    const RetexSetInfo info = retex_set_info(set);
    cli_info(&cli, "%s: %d x %d, %.2f s", strcmp(output, "-") == 0 ? "standard output" : output, info.width,
             info.height, written - began);
    cli_detail(&cli, "read %.2f s, denoised %.2f s, written %.2f s", read - began, denoised - read, written - denoised);
    retex_set_close(&set);
    return cli_close(&cli, CLI_OK);
}
