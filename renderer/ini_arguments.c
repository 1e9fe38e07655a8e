/* POV-Ray's .ini files and switches on the command line. What retex-render's own options say has precedence. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "retex-render.h"

int take_ini_word(Arguments *a, const char *word)
{
    if (a->cli->only_positional || !(ini_is_file(word) || word[0] == '+'))
        return 0;
    if (a->nini_words == LIST_MAX)
        cli_die(a->cli, "more than %d .ini files and switches", LIST_MAX);
    a->ini_words[a->nini_words++] = word;
    return 1;
}

static void ini_message(void *context, int level, const char *text)
{
    if (level > 0)
        cli_message(context, text);
    else
        cli_detail(context, "%s", text);
}

/* Declarations of -D come last, so that they win. */
static void add_declares(Arguments *a, const IniOptions *ini)
{
    const char *own[LIST_MAX];
    const int nown = a->ndeclares, has_clock = !isnan(ini->clock) && ini->animation.last_frame < 0;
    if (nown + ini->declares.count + has_clock > LIST_MAX)
        cli_die(a->cli, "more than %d of --declare and Declare", LIST_MAX);
    memcpy(own, a->declares, sizeof own);
    snprintf(a->clock, sizeof a->clock, "clock=%.17g", (double)(float)ini->clock);
    a->ndeclares = 0;
    if (has_clock)
        a->declares[a->ndeclares++] = a->clock;
    for (int k = 0; k < ini->declares.count; k++)
        a->declares[a->ndeclares++] = ini->declares.items[k];
    for (int k = 0; k < nown; k++)
        a->declares[a->ndeclares++] = own[k];
}

static void add_folders(Arguments *a, const IniOptions *ini)
{
    if (a->nincludes + ini->folders.count > LIST_MAX)
        cli_die(a->cli, "more than %d of --include and Library_Path", LIST_MAX);
    for (int k = 0; k < ini->folders.count; k++)
        a->includes[a->nincludes++] = ini->folders.items[k];
}

/* The first pixel of a part of the picture, from 0: value is a column or row from 1, or a share. */
static int first_pixel(double value, int size)
{
    return value < 1 ? (int)(value * size) : (int)value - 1;
}

/* The pixel after the last; value 0 is not given. */
static int end_pixel(double value, int size)
{
    const int end = value <= 0 ? size : value < 1 ? (int)ceil(value * size) : (int)value;
    return end > size ? size : end;
}

static void set_size(Arguments *a, const IniOptions *ini)
{
    RenderParams *r = &a->render;
    const double *w = ini->window;
    if (!r->width && (ini->width || ini->height)) {
        if (!ini->width || !ini->height)
            cli_die(a->cli, "POV-Ray's %s needs %s", ini->width ? "Width" : "Height", ini->width ? "Height" : "Width");
        r->width = a->sdl.width = ini->width;
        r->height = a->sdl.height = ini->height;
    }
    if (r->crop[2] || !(w[0] > 0 || w[1] > 0 || w[2] > 0 || w[3] > 0))
        return;
    if (!r->width)
        cli_die(a->cli, "POV-Ray's Start_Column, End_Column, Start_Row and End_Row need Width and Height");
    r->crop[0] = first_pixel(w[0], r->width), r->crop[1] = first_pixel(w[2], r->height);
    r->crop[2] = end_pixel(w[1], r->width) - r->crop[0], r->crop[3] = end_pixel(w[3], r->height) - r->crop[1];
    if (r->crop[2] < 1 || r->crop[3] < 1)
        cli_die(a->cli, "no pixel is between Start_Column and End_Column and between Start_Row and End_Row");
}

static void set_frames(Arguments *a, const IniOptions *ini)
{
    a->animation = ini->animation;
    if (ini->animation.last_frame < 0 || a->frames.step)
        return;
    ini_frames(ini, &a->frames.first, &a->frames.last);
    a->frames.step = ini->step;
}

void take_ini_options(Arguments *a)
{
    Cli *cli = a->cli;
    IniOptions *ini = &a->ini;
    RetexError err;
    *ini = (IniOptions)INI_OPTIONS_INIT;
    ini->safe = cli->access.safe;
    ini->message = ini_message, ini->message_context = cli;
    for (int k = 0; k < a->nini_words; k++)
        if (a->ini_words[k][0] == '+' ? ini_switch(ini, a->ini_words[k], &err) : ini_read(ini, a->ini_words[k], &err))
            cli_fail(cli, &err);
    if (!a->scene)
        a->scene = ini->scene;
    add_declares(a, ini);
    add_folders(a, ini);
    set_size(a, ini);
    set_frames(a, ini);
    if (!a->seeded && ini->seed >= 0)
        a->render.seed = (uint32_t)ini->seed, a->seeded = 1;
    if (!cli->threads)
        cli->threads = ini->threads;
    if (a->list || a->tracing || a->variants)
        return;
    a->render.resume |= ini->resume && !a->control && !a->render.control_data;
    if (cli->output || !ini->output)
        return;
    char *name = ini_output_name(ini);
    if (!name)
        cli_die(cli, "out of memory");
    free(ini->output);
    cli->output = ini->output = name;
}
