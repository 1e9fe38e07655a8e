/* --texture of retex-sample and retex-combine: parsing, the files that it reads, and its description in messages. */
#ifndef RETEX_TEXTURE_ARGS_H
#define RETEX_TEXTURE_ARGS_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <retex/retex.h>

#include "common/cli.h"
#include "common/frames.h"

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

/* Parse --texture or --replace, the option that cli_next returned. A layer joins the texture that its target is given
 * before, or the other way round; else it is added to the `count` ones. */
static inline int texture_args_parse(const Cli *cli, RetexTextureSpec *specs, int *count, RetexError *err)
{
    RetexEdit *edit = NULL;
    int code = retex_edit_create(&edit, err);
    if (!code)
        code = retex_edit_option(edit, cli->modifiers, cli->value, err);
    if (!code) {
        const RetexTextureSpec *spec = retex_edit_texture(edit, 0);
        int at = *count;
        for (int k = 0; k < *count; k++)
            if (strcmp(specs[k].target, spec->target) == 0 && (specs[k].nlayers || spec->nlayers))
                at = k;
        if (at < *count)
            code = retex_texture_spec_join(&specs[at], spec, err);
        else
            specs[(*count)++] = *spec;
        texture_args_read_by(cli, &specs[at]);
    }
    retex_edit_close(&edit);
    return code;
}

/* Of an option's row: CLI_CALL(type, member, texture_args_add), for TextureArgs. */
static inline void texture_args_add(Cli *cli, const CliOption *option, void *to)
{
    (void)option;
    TextureArgs *args = to;
    RetexError err = {0};
    if (args->count == RETEX_MAX_TARGETS)
        cli_die(cli, "more than %d textures", RETEX_MAX_TARGETS);
    if (texture_args_parse(cli, args->specs, &args->count, &err))
        cli_fail(cli, &err);
}

/* Add the textures of a preset for targets that have none, and what else it says to `edit`, if that does not. */
static inline void texture_args_add_preset(const Cli *cli, RetexTextureSpec *specs, int *count, RetexEdit *edit,
                                           const char *path)
{
    RetexEdit *preset = NULL;
    RetexError err = {0};
    cli_input(cli, path, "a preset, as of retex-combine --save-preset");
    cli_reads(cli, "the preset", path);
    int code = retex_edit_create(&preset, &err);
    if (!code)
        code = retex_preset_read(preset, path, &err);
    if (!code)
        code = retex_edit_complete_lights(edit, preset, &err);
    for (int i = 0; !code && i < retex_edit_count(preset); i++) {
        const RetexTextureSpec *spec = retex_edit_texture(preset, i);
        int at = 0;
        while (at < *count && strcasecmp(specs[at].target, spec->target) != 0)
            at++;
        if (at < *count)
            continue;
        if (*count == RETEX_MAX_TARGETS)
            cli_die(cli, "more than %d textures", RETEX_MAX_TARGETS);
        specs[(*count)++] = *spec;
        texture_args_read_by(cli, &specs[at]);
    }
    retex_edit_close(&preset);
    if (code)
        cli_fail(cli, &err);
}

/* The textures alone; 1: it says more. */
static inline int texture_args_add_preset_textures(const Cli *cli, RetexTextureSpec *specs, int *count,
                                                   const char *path)
{
    RetexEdit *others = NULL;
    RetexError err = {0};
    char *more = NULL;
    if (retex_edit_create(&others, &err))
        cli_fail(cli, &err);
    texture_args_add_preset(cli, specs, count, others, path);
    if (retex_edit_text(others, ';', &more, &err))
        cli_fail(cli, &err);
    const int says_more = more[0] != '\0';
    free(more);
    retex_edit_close(&others);
    return says_more;
}

/* Write textures, and what `lights` has, as a preset. */
static inline int texture_args_save_preset(const TextureArgs *args, const RetexEdit *lights, const char *path,
                                           RetexError *err)
{
    RetexEdit *edit = NULL;
    int code = retex_edit_create(&edit, err);
    for (int i = 0; i < args->count && !code; i++)
        code = retex_edit_add(edit, &args->specs[i], err);
    if (!code)
        code = retex_edit_complete_lights(edit, lights, err);
    if (!code)
        code = retex_preset_write(edit, path, err);
    retex_edit_close(&edit);
    return code;
}

/* Announce the files of a texture: of a folder, those that are used. For a name with options,
 * `room.retex?Floor=oak.jpg`, also announce the file before the `?`. */
static inline int texture_args_add_input(const RetexTextureSpec *spec, RetexError *err)
{
    char before[sizeof spec->image], *file;
    const char *query = spec->constant ? NULL : strchr(spec->image, '?');
    int code = RETEX_OK;
    for (int k = 0; k < RETEX_TEXTURE_FILES && !code; k++) {
        code = retex_texture_file(&file, spec, k, err);
        if (!code && file)
            code = cli_add_input("the texture", file, err);
        free(file);
    }
    if (!code && query) {
        snprintf(before, sizeof before, "%.*s", (int)(query - spec->image), spec->image);
        code = cli_add_input("the texture", before, err);
    }
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
    for (int i = 0; i < count; i++) {
        if (!specs[i].constant && specs[i].image[0])
            frames_check_name(cli, range, what, specs[i].image, 0);
        for (int k = 0; k < specs[i].nlayers; k++)
            frames_check_name(cli, range, what, specs[i].layers[k].image, 0);
        if (specs[i].finish[0])
            frames_check_name(cli, range, what, specs[i].finish, 0);
    }
}

/* The name of a file at one frame. */
static inline void texture_args_frame_name(const Cli *cli, int frame, char *name, size_t size)
{
    char *made = frames_name(cli, name, frame);
    if (strlen(made) >= size)
        cli_die(cli, "the name of the image is too long: %s", made);
    memset(name, 0, size); /* specs are compared byte by byte */
    strcpy(name, made);
    free(made);
}

/* Give the images their names at one frame. */
static inline void texture_args_set_frame(const Cli *cli, int frame, RetexTextureSpec *specs, int count)
{
    for (int i = 0; i < count; i++) {
        RetexTextureSpec *spec = &specs[i];
        if (!spec->constant && spec->image[0])
            texture_args_frame_name(cli, frame, spec->image, sizeof spec->image);
        for (int k = 0; k < spec->nlayers; k++)
            texture_args_frame_name(cli, frame, spec->layers[k].image, sizeof spec->layers[k].image);
        if (spec->finish[0])
            texture_args_frame_name(cli, frame, spec->finish, sizeof spec->finish);
    }
}

/* "Floor <- oak.png, Wall <- rgb(1,1,1)", or "original textures". */
static inline const char *texture_args_describe(const RetexSet *set, char *text, size_t size)
{
    const RetexTarget *target;
    size_t used = 0;
    text[0] = '\0';
    for (int t = 0; (target = retex_set_target(set, t)) && used < size; t++)
        if (target->texture[0])
            used += (size_t)snprintf(text + used, size - used, "%s%s <- %s", used ? ", " : "", target->name,
                                     target->texture);
    return used ? text : "original textures";
}

/* Warn of lamps that become so much brighter than they were rendered that it is rather a slip: values are those of
 * retex_edit_parameters. */
static inline void lamp_args_warn(const Cli *cli, const RetexSet *set, const float *values)
{
    static const double BRIGHT = 1e6; /* --solve finds no brighter ones */
    const int count = retex_set_info(set).nparameters;
    for (int i = 0; i < count; i++) {
        const RetexParameter *p = retex_set_parameter(set, i);
        char name[RETEX_NAME_MAX] = "";
        const int is_off = p->value[0] == 0 && p->value[1] == 0 && p->value[2] == 0;
        const float *was = is_off ? p->kept : p->value, *is = values + 3 * i;
        const double times = retex_luminance((double)is[0], (double)is[1], (double)is[2]) /
                             retex_luminance((double)was[0], (double)was[1], (double)was[2]);
        if (!retex_parameter_lamp(set, i) || !(times > BRIGHT))
            continue;
        snprintf(name, sizeof name, "%s", retex_parameter_lamp(set, i));
        cli_warn(cli, "lamp %s becomes %.3g times as bright as it was rendered, and so does its noise",
                 cli_plain(name), times);
    }
}

#endif
