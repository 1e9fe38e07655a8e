/* What retex-sample and retex-combine share: --texture on the command line, reading the set, and the closing line. */
#ifndef RETEX_TEXTURE_ARGS_H
#define RETEX_TEXTURE_ARGS_H

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include <retex/retex.h>

#include "cli.h"

typedef struct TextureArgs {
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    int count;
} TextureArgs;

static inline double texture_args_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The option --texture just seen. */
static inline void texture_args_add(const Cli *cli, TextureArgs *args)
{
    RetexError err = {0};
    if (args->count == RETEX_MAX_TARGETS)
        cli_die(cli, "more than %d textures", RETEX_MAX_TARGETS);
    if (retex_texture_spec_parse(&args->specs[args->count], cli->modifiers, cli->value, &err))
        cli_fail(cli, &err);
    args->count++;
}

/* Writing over the set would leave nothing to retexture; over a texture, neither. */
static inline void texture_args_check_output(const Cli *cli, const char *input, const char *output)
{
    struct stat in, out;
    if (strcmp(input, "-") != 0 && strcmp(output, "-") != 0 && stat(input, &in) == 0 && stat(output, &out) == 0 &&
        S_ISREG(in.st_mode) && in.st_dev == out.st_dev && in.st_ino == out.st_ino)
        cli_die(cli, "the output %s would replace the input", output);
}

static inline void texture_args_check_outputs(const Cli *cli, const TextureArgs *args, const char *output)
{
    for (int i = 0; i < args->count; i++)
        if (!args->specs[i].constant)
            texture_args_check_output(cli, args->specs[i].image, output);
}

/* "Floor <- oak.png, Wall <- rgb(1,1,1)", or "original textures". */
static inline const char *texture_args_describe(const RetexSamples *samples, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (int t = 0; samples && t < samples->ntargets && used < size; t++)
        if (samples->textures[t][0])
            used += (size_t)snprintf(text + used, size - used, "%s%s <- %s", used ? ", " : "", samples->target_names[t],
                                     samples->textures[t]);
    return used ? text : "original textures";
}

#endif
