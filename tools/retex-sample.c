/* retex-sample: filter new textures at a set's footprints. See retex-sample(1). */
#include "texture_args.h"

static const CliOption options[] = {
    {"texture", 0, "NAME=IMAGE",
     "put IMAGE, a file or rgb(r,g,b), on target NAME; opts: scale=S[,T], rotate=DEGREES, offset=U,V, "
     "flip=u|v|uv, width=W[,H], wrap=repeat|mirror|clamp|black, repeat=straight|brick|half-drop|mirror, "
     "colorspace=NAME",
     1},
    {0},
};

static const char *parse(Cli *cli, TextureArgs *textures)
{
    const char *set = NULL;
    for (const CliOption *option; (option = cli_next(cli));) {
        if (option != &cli_positional)
            texture_args_add(cli, textures);
        else if (set)
            cli_surplus(cli, "one set is enough");
        else
            set = cli->value;
    }
    if (!set)
        cli_die(cli, "no set given; - is standard input");
    if (!textures->count)
        cli_die(cli, "no texture given; expected --texture NAME=IMAGE");
    return set;
}

/* Samples are always OpenEXR. Refuse names of other formats, which suggest that retex-combine is meant. */
static void check_ending(const Cli *cli, const char *output)
{
    static const char *const others[] = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".hdr", ".pfm", ".webp", ".retex"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (cli_ends_with(output, others[i]))
            cli_die(cli, "%s: samples are an OpenEXR file, .exr; pictures are made by retex-combine", output);
}

int main(int argc, char **argv)
{
    static TextureArgs textures;
    Cli cli = {.tool = "retex-sample",
               .usage = "SET --texture[:opts] NAME=IMAGE ... [-o SAMPLES]",
               .about = "Filter new textures at a set's footprints, for retex-combine.",
               .options = options,
               .argc = argc,
               .argv = argv,
               .next = 1};
    const char *input = parse(&cli, &textures), *output = cli_output(&cli);
    RetexSet *set = NULL;
    RetexSamples *samples = NULL, *earlier = NULL;
    RetexError err = {0};

    cli_input(&cli, input, "a set, as from retex-render");
    cli_reads(&cli, "the set", input);
    texture_args_reads(&cli, textures.specs, textures.count);
    cli_writes(&cli, "the output", output);
    check_ending(&cli, output);
    if (retex_set_write_check(output, &err))
        cli_fail(&cli, &err);
    double began = retex_clock_seconds();
    if (retex_set_open(input, &set, &earlier, cli.threads, &err))
        cli_fail(&cli, &err);
    if (!set)
        cli_die(&cli, "%s holds samples but no set", input);
    cli_check_pixels(&cli, set, input);
    double read = retex_clock_seconds();
    if (retex_sample_to_store(&samples, set, textures.specs, textures.count, output, cli.threads, &err))
        cli_fail(&cli, &err);
    if (earlier) { /* a stream from another retex-sample: keep the samples of its other targets */
        if (retex_samples_merge(earlier, samples, cli.threads, &err))
            cli_fail(&cli, &err);
        retex_samples_close(&samples);
        samples = earlier;
    }
    double sampled = retex_clock_seconds();
    RetexStoreParams store = RETEX_STORE_INIT;
    int to_pipe = strcmp(output, "-") == 0;
    if (retex_set_write(to_pipe ? set : NULL, samples, output, &store, cli.threads, &err))
        cli_fail(&cli, &err);
    double written = retex_clock_seconds();

    char text[2048];
    cli_info(&cli, "%s: %d x %d, %.2f s", texture_args_describe(samples, text, sizeof text), set->width, set->height,
             written - began);
    cli_detail(&cli, "read %.2f s, sampled %.2f s, written %.2f s", read - began, sampled - read, written - sampled);
    retex_samples_close(&samples);
    retex_set_close(&set);
    return cli_close(&cli, CLI_OK);
}
