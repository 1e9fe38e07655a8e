/* The frames of an animation: which are rendered, and the arguments of each. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "retex-render.h"

/* Check all names: several frames cannot share an output. */
static void check_names(const Arguments *a)
{
    const FrameRange *range = &a->frames;
    frames_check_name(a->cli, range, "the output", a->output, 1);
    frames_check_name(a->cli, range, "--stats", a->stats, 1);
    frames_check_name(a->cli, range, "--aov-dir", a->aov_dir, 1);
    frames_check_name(a->cli, range, "--mattes", a->mattes, 1);
    frames_check_name(a->cli, range, "--control", a->control, 0);
    texture_args_check_frames(a->cli, range, "--replace", a->replacements, a->nreplacements);
}

void plan_frames(Arguments *a)
{
    FrameRange *range = &a->frames;
    Animation *animation = &a->animation;
    if (animation->last_frame < 0 && range->step)
        animation->first_frame = range->first, animation->last_frame = range->last;
    if (animation->last_frame < 0)
        return;
    if (animation->last_frame < animation->first_frame)
        cli_die(a->cli, "the last frame, %d, is before the first, %d", animation->last_frame, animation->first_frame);
    if (!range->step)
        *range = (FrameRange){animation->first_frame, animation->last_frame, 1};
    if (range->last < range->first || range->first < animation->first_frame || range->last > animation->last_frame)
        cli_die(a->cli, "there are no frames %d to %d: the animation has frames %d to %d", range->first, range->last,
                animation->first_frame, animation->last_frame);
    frames_check_count(a->cli, range);
    for (int k = 0; k < a->ndeclares; k++)
        if (animation_is_declare(a->declares[k]))
            cli_die(a->cli, "-D %s: an animation sets this for each frame", a->declares[k]);
    if (a->ndeclares + ANIMATION_DECLARES > LIST_MAX)
        cli_die(a->cli, "more than %d of --declare with frames", LIST_MAX - ANIMATION_DECLARES);
    if (a->variants)
        cli_die(a->cli, "--variants makes one table of pictures: no frames");
    if (answers(a)) /* at the first frame */
        range->last = range->first;
    check_names(a);
}

/* What the frame's arguments own. */
typedef struct Frame {
    Arguments arguments;
    char declares[ANIMATION_DECLARES][ANIMATION_DECLARE_SIZE];
    char *names[5];
    int nnames;
} Frame;

static void name_file(Frame *f, const char **name, int frame)
{
    *name = f->names[f->nnames++] = frames_name(f->arguments.cli, *name, frame);
}

/* The arguments for one frame. */
static Frame *open_frame(const Arguments *all, int frame)
{
    Frame *f = calloc(1, sizeof *f);
    if (!f)
        cli_die(all->cli, "out of memory");
    Arguments *a = &f->arguments;
    *a = *all;
    name_file(f, &a->output, frame);
    name_file(f, &a->stats, frame);
    name_file(f, &a->aov_dir, frame);
    name_file(f, &a->mattes, frame);
    name_file(f, &a->control, frame);
    texture_args_set_frame(a->cli, frame, a->replacements, a->nreplacements);
    animation_declares(&a->animation, frame, f->declares);
    for (int k = 0; k < ANIMATION_DECLARES; k++)
        a->declares[a->ndeclares++] = f->declares[k];
    a->sdl.declares = a->declares, a->sdl.ndeclares = a->ndeclares;
    a->render.seed += (uint32_t)frame;
    return f;
}

static void close_frame(Frame *f)
{
    for (int k = 0; k < f->nnames; k++)
        free(f->names[k]);
    free(f);
}

int for_each_frame(Arguments *a, int (*action)(Arguments *frame))
{
    int status = CLI_OK, failed = 0;
    if (!a->frames.step)
        return action(a);
    FOR_FRAMES(number, a->frames)
    {
        Frame *f = open_frame(a, number);
        cli_set_frame(a->cli, number);
        const int answer = action(&f->arguments);
        close_frame(f);
        failed += answer != CLI_OK;
        status = status == CLI_OK ? answer : status;
        if (failed && !a->keep_going)
            break;
    }
    cli_set_frame(a->cli, -1);
    if (failed && a->keep_going)
        frames_tell_failed(a->cli, failed, frames_count(&a->frames));
    return status;
}

int frame_is_there(const Arguments *a)
{
    struct stat info;
    return a->frames.step && a->render.resume && a->output && !stat(a->output, &info) &&
           S_ISREG(info.st_mode) && stat(a->checkpoint, &info) != 0;
}
