/* retex-denoise: remove the noise from a set's coefficients, once. See retex-denoise(1). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/clock.h>
#include <retex/denoise.h>
#include <retex/denoise_picture.h>
#include <retex/pack.h>
#include <retex/set_file.h>

#include "common/cli.h"

/* Strips take as long as the whole set in memory, and a third of the memory at 1920 x 1080. */
#define MEMORY_DEFAULT ((uint64_t)512 << 20)

static const CliOption options[] = {
    {"strength", 0, "F", "difference of similar pixels, in standard deviations of their noise, 0.1 to 10; default 1",
     0},
    {"radius", 0, "N", "radius of the window of similar pixels, 1 to 10 pixels; default 5", 0},
    {"memory", 0, "SIZE", "keep the set in memory if it takes at most SIZE; default 512 MB", 0},
    {"denoiser", 0, "nlm|oidn|both",
     "filter of the light: retex's own, which is the default, Open Image Denoise 2, or the mean of both", 0},
    {"quality", 0, "preview|final", "preview: less time, for interactive use; default final", 0},
    {"no-footprints", 0, NULL, "leave footprints unchanged", 0},
    {"full-precision", 0, NULL, "keep all bits of the set's numbers, in a larger file", 0},
    {"layer", 0, "NAME", "of a picture that is no set: denoise this layer; may be repeated; default: the picture", 0},
    {"other-half", 0, "FILE", "a second render of that picture, with as many other samples", 0},
    {"variance", 0, "NAME", "layer with the variance of each pixel's mean", 0},
    {"normal", 0, "NAME", "layer of normals; default: the one of a well known name, as for the three below", 0},
    {"albedo", 0, "NAME", "layer of colours of surfaces", 0},
    {"position", 0, "NAME", "layer of positions", 0},
    {"depth", 0, "NAME", "layer of depths, if there are no positions", 0},
    {0},
};

static void check_denoiser(const Cli *cli, const CliOption *option)
{
    if (strcmp(cli->value, "nlm") != 0 && strcmp(cli->value, "oidn") != 0 && strcmp(cli->value, "both") != 0)
        cli_die(cli, "--%s: expected nlm, oidn or both, not '%s'", option->name, cli->value);
}

static void check_quality(const Cli *cli, const CliOption *option)
{
    if (strcmp(cli->value, "preview") != 0 && strcmp(cli->value, "final") != 0)
        cli_die(cli, "--%s: expected preview or final, not '%s'", option->name, cli->value);
}

/* What the options say of a picture that is no set. */
typedef struct Picture {
    RetexDenoisePictureParams params;
    const char **layers;
    const char *first;         /* the first option that is for pictures, or NULL */
    const char *first_of_sets; /* the same of options for sets */
} Picture;

/* Takes an option that is for pictures only; 0: it is another one. */
static int take_picture_option(const Cli *cli, const CliOption *option, Picture *picture)
{
    RetexDenoisePictureParams *p = &picture->params;
    const struct {
        const char *name, **value;
    } names[] = {{"other-half", &p->other_half}, {"variance", &p->variance}, {"normal", &p->normal},
                 {"albedo", &p->albedo},         {"position", &p->position}, {"depth", &p->depth}};
    if (strcmp(option->name, "layer") == 0) {
        picture->layers[p->nlayers++] = cli->value;
        picture->first = picture->first ? picture->first : option->name;
        return 1;
    }
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (strcmp(option->name, names[k].name) == 0) {
            *names[k].value = cli->value;
            picture->first = picture->first ? picture->first : option->name;
            return 1;
        }
    return 0;
}

static const char *parse(Cli *cli, RetexDenoiseParams *params, uint64_t *memory, Picture *picture)
{
    const char *input = NULL;
    for (const CliOption *option; (option = cli_next(cli));) {
        if (option == &cli_positional) {
            if (input)
                cli_surplus(cli, "one set is enough");
            input = cli->value;
        } else if (take_picture_option(cli, option, picture)) {
            continue;
        } else if (strcmp(option->name, "strength") == 0) {
            params->strength = (float)cli_number(cli, option, 0.1, 10);
        } else if (strcmp(option->name, "radius") == 0) {
            params->radius = (int)cli_integer(cli, option, 1, 10);
        } else if (strcmp(option->name, "memory") == 0) {
            *memory = cli_size(cli, option);
        } else if (strcmp(option->name, "denoiser") == 0) {
            params->denoiser = cli->value;
            check_denoiser(cli, option);
        } else if (strcmp(option->name, "quality") == 0) {
            params->quality = cli->value;
            check_quality(cli, option);
        } else if (strcmp(option->name, "full-precision") == 0) {
            params->full_precision = 1;
            picture->first_of_sets = option->name;
        } else {
            params->footprints = 0;
            picture->first_of_sets = option->name;
        }
    }
    if (!input)
        cli_die(cli, "no set given; - is standard input");
    return input;
}

/* The output is a set, or an EXR picture. Refuse names of other formats. */
static void check_ending(const Cli *cli, const char *output, const char *picture)
{
    static const char *const others[] = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".hdr", ".pfm", ".webp"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (cli_ends_with(output, others[i]) && !picture)
            cli_die(cli, "%s: a set is an OpenEXR file, .exr, or a pack, .retex; pictures are made by retex-combine",
                    output);
        else if (cli_ends_with(output, others[i]) || (picture && cli_ends_with(output, ".retex")))
            cli_die(cli, "%s: a denoised picture is an OpenEXR file, .exr, as %s is", output, picture);
}

static void progress(void *context, double done)
{
    cli_progress(context, "denoise", done);
}

static void print_note(void *cli, int important, const char *text)
{
    if (important)
        cli_info(cli, "%s", text);
    else
        cli_detail(cli, "%s", text);
}

/* A picture of any renderer: the output is the same file with other pixels. */
static int denoise_picture(Cli *cli, Picture *picture, const RetexDenoiseParams *params, const char *input,
                           const char *output)
{
    RetexDenoisePictureParams *p = &picture->params;
    RetexError err = {0};
    if (picture->first_of_sets)
        cli_die(cli, "--%s: %s is a picture, not a set", picture->first_of_sets, input);
    check_ending(cli, output, input);
    if (p->other_half) {
        cli_input(cli, p->other_half, "the other half");
        cli_reads(cli, "--other-half", p->other_half);
    }
    p->layers = picture->layers;
    p->access = &cli->access;
    p->note = print_note;
    p->note_context = cli;
    const double began = retex_clock_seconds();
    if (retex_denoise_picture(input, output, p, params, cli->threads, &err))
        cli_fail(cli, &err);
    cli_info(cli, "%s: %.2f s", strcmp(output, "-") == 0 ? "standard output" : output, retex_clock_seconds() - began);
    return cli_close(cli, CLI_OK);
}

static int write_set(const Cli *cli, RetexSet *set, const char *output, RetexError *err)
{
    RetexStoreParams store = RETEX_STORE_INIT;
    RetexPackParams pack = RETEX_PACK_INIT;
    return cli_ends_with(output, ".retex") ? retex_pack_write(set, output, &pack, NULL, cli->threads, err)
                                           : retex_set_write(set, NULL, output, &store, cli->threads, err);
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
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    RetexSet *set = NULL;
    RetexError err = {0};
    uint64_t memory = MEMORY_DEFAULT;
    Picture picture = {.params = RETEX_DENOISE_PICTURE_INIT, .layers = calloc((size_t)argc, sizeof *picture.layers)};

    if (!picture.layers)
        cli_die(&cli, "no memory for the arguments");
    const char *input = parse(&cli, &params, &memory, &picture), *output = cli_output(&cli);
    const int piped = strcmp(input, "-") == 0;
    cli_input(&cli, input, "a set, as from retex-render");
    cli_reads(&cli, "the set", input);
    cli_writes(&cli, "the output", output);
    params.progress = progress;
    params.progress_context = &cli;
    params.near = output;
    params.budget = cli.budget;
    if (piped ? picture.first != NULL : retex_is_picture(input, &cli.access))
        return denoise_picture(&cli, &picture, &params, input, output);
    if (picture.first)
        cli_die(&cli, "--%s is for pictures: %s is a set, or no OpenEXR file", picture.first, input);
    free(picture.layers);
    check_ending(&cli, output, NULL);
    if (retex_set_write_check(output, &err))
        cli_fail(&cli, &err);
    const double began = retex_clock_seconds();
    if (cli_open_set(&cli, &set, input, memory, &err))
        cli_fail(&cli, &err);
    const double read = retex_clock_seconds();
    if (retex_denoise(set, &params, NULL, cli.threads, &err))
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
