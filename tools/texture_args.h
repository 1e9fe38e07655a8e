/* --texture of retex-sample and retex-combine: parsing, the files that it reads, and its description in messages. */
#ifndef RETEX_TEXTURE_ARGS_H
#define RETEX_TEXTURE_ARGS_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/retex.h>

#include "cli.h"
#include "frames.h"

typedef struct TextureArgs {
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    int count;
} TextureArgs;

/* An image of a texture is read, and warned about, as the command line says. */
static inline void texture_args_read_by(const Cli *cli, RetexTextureSpec *spec)
{
    spec->access = &cli->access;
    spec->warn = cli_warn_text;
    spec->warn_context = (void *)cli;
    spec->budget = cli->budget;
}

/* Parse --texture or --replace, the option that cli_next returned. */
static inline int texture_args_parse(const Cli *cli, RetexTextureSpec *spec, RetexError *err)
{
    RetexEdit *edit = NULL;
    int code = retex_edit_create(&edit, err);
    if (!code)
        code = retex_edit_option(edit, cli->modifiers, cli->value, err);
    if (!code)
        *spec = *retex_edit_texture(edit, 0);
    retex_edit_close(&edit);
    texture_args_read_by(cli, spec);
    return code;
}

static inline void texture_args_add(const Cli *cli, TextureArgs *args)
{
    RetexError err = {0};
    if (args->count == RETEX_MAX_TARGETS)
        cli_die(cli, "more than %d textures", RETEX_MAX_TARGETS);
    if (texture_args_parse(cli, &args->specs[args->count++], &err))
        cli_fail(cli, &err);
}

/* Announce the file of a texture, if it has one: of a folder, that of its base colour. For a name with options,
 * `room.retex?Floor=oak.jpg`, also announce the file before the `?`. */
static inline int texture_args_add_input(const RetexTextureSpec *spec, RetexError *err)
{
    char before[sizeof spec->image], *file;
    const char *query = strchr(spec->image, '?');
    if (spec->constant)
        return RETEX_OK;
    int code = retex_texture_file(&file, spec, err);
    if (code)
        return code;
    code = cli_add_input("the texture", file, err);
    if (!code && query) {
        snprintf(before, sizeof before, "%.*s", (int)(query - spec->image), spec->image);
        code = cli_add_input("the texture", before, err);
    }
    free(file);
    return code;
}

static inline void texture_args_reads(const Cli *cli, const RetexTextureSpec *specs, int count)
{
    RetexError err = {0};
    for (int i = 0; i < count; i++)
        if (texture_args_add_input(&specs[i], &err))
            cli_fail(cli, &err);
}

/* frames_check_name for the images of --texture or --replace, which `what` says. */
static inline void texture_args_check_frames(const Cli *cli, const FrameRange *range, const char *what,
                                             const RetexTextureSpec *specs, int count)
{
    for (int i = 0; i < count; i++)
        if (!specs[i].constant)
            frames_check_name(cli, range, what, specs[i].image, 0);
}

/* Give the images their names at one frame. */
static inline void texture_args_set_frame(const Cli *cli, int frame, RetexTextureSpec *specs, int count)
{
    for (int i = 0; i < count; i++) {
        RetexTextureSpec *spec = &specs[i];
        char *image = spec->constant ? NULL : frames_name(cli, spec->image, frame);
        if (image && strlen(image) >= sizeof spec->image)
            cli_die(cli, "the name of the image is too long: %s", image);
        memset(spec->image, 0, sizeof spec->image); /* specs are compared byte by byte */
        strcpy(spec->image, image ? image : "");
        free(image);
    }
}

/* "Floor <- oak.png, Wall <- rgb(1,1,1)", or "original textures". */
static inline const char *texture_args_describe(const RetexSamples *samples, char *text, size_t size)
{
    const int ntargets = samples ? retex_samples_info(samples).ntargets : 0;
    size_t used = 0;
    text[0] = '\0';
    for (int t = 0; t < ntargets && used < size; t++)
        if (*retex_samples_texture(samples, t))
            used += (size_t)snprintf(text + used, size - used, "%s%s <- %s", used ? ", " : "",
                                     retex_samples_target(samples, t), retex_samples_texture(samples, t));
    return used ? text : "original textures";
}

#endif
