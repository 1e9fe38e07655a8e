/* The files of retex-render: the command line and its actions. Functions without a RetexError print one line about an
 * error and exit with CLI_FAIL. */
#ifndef RENDERER_RETEX_RENDER_H
#define RENDERER_RETEX_RENDER_H

#include <retex/retex.h>
#include "batch/batch.h"
#include "common/cli.h"
#include "common/texture_args.h"
#include "common/frames.h"
#include "job/ini.h"
#include "job/job.h"

#define LIST_MAX 64

typedef struct Arguments {
    Cli *cli;
    RenderParams render;
    SdlOptions sdl;
    const char *output; /* NULL = none, or the table's */
    const char *scene, *stats, *variants, *control, *aov_dir, *sheet, *mattes;
    int matte_ranks;
    ControlMode control_mode;
    int seeded;
    Batch batch; /* the table of --variants */
    const char *targets[LIST_MAX], *includes[LIST_MAX], *declares[LIST_MAX];
    const char *lamps[LIST_MAX];
    int nlamps, each_lamp, list_lamps;
    const char *finishes[LIST_MAX], *shown[LIST_MAX];
    int nfinishes, nshown, list_finishes, list_cameras, live;
    const char *lights[LIST_MAX], *solo; /* values of lamps, as arguments of --light */
    const char *preset;
    int nlights, lamps_by_light; /* 1: they name the lamps, too */
    int ntargets, nincludes, ndeclares, nreplacements, list, trace[3], tracing;
    RetexTextureSpec replacements[RETEX_MAX_TARGETS];
    RenderVariant replaced;
    double uv_scales[RETEX_MAX_TARGETS][2]; /* set when measured */
    int measured;
    RetexSet *control_set;
    char set_targets[RETEX_MAX_TARGETS][RETEX_NAME_MAX + 512]; /* the set's targets, as arguments of -t */
    int named;                                                 /* -t was given */
    int keep_going;                                            /* of frames */
    const char *denoise_quality; /* NULL: final */
    int denoise, no_denoise_data, full_precision;
    const char *ini_words[LIST_MAX]; /* .ini files and switches of POV-Ray, in their order */
    int nini_words;
    IniOptions ini; /* what they say */
    char clock[48]; /* a declaration */
    Animation animation;
    FrameRange frames;     /* the frames of it that are rendered; step 0: one picture without a number */
    char checkpoint[4096]; /* OUTPUT.partial, or "" if the output is not a file */
} Arguments;

/* Whether it prints an answer, and makes no picture. */
static inline int answers(const Arguments *a)
{
    return a->list || a->list_lamps || a->list_finishes || a->list_cameras || a->tracing || a->live;
}

/* ---- arguments.c ---- */

void parse_arguments(Arguments *arguments);

/* ---- ini_arguments.c ---- */

/* Keep a word of the command line if it is an .ini file or a switch of POV-Ray, such as `+KFF12`. Return 0 if not. */
int take_ini_word(Arguments *arguments, const char *word);
/* Read those words, after all options of the command line. */
void take_ini_options(Arguments *arguments);

/* ---- frames.c ---- */

/* After parse_arguments: find the frames, and check that each has files of its own. */
void plan_frames(Arguments *arguments);
/* Call action for each frame, with names and numbers of that frame, or once if there are no frames. Returns the first
 * status that is not CLI_OK; ends there, unless --keep-going. */
int for_each_frame(Arguments *arguments, int (*action)(Arguments *frame));
/* Whether --resume finds this frame finished: its file is there, and no finished rows beside it. */
int frame_is_there(const Arguments *frame);

/* ---- replaced.c: --replace, --variants and --control ---- */

/* Check the table of --variants, before the scene is read. Its mistakes are printed with those of its columns. */
void check_table(Arguments *arguments);
/* If the scene cannot be opened because columns of the table are no targets: print all of them and end. */
void refuse_columns(Arguments *arguments);
/* Make its pictures, or with --dry-run list them. Return the exit status. */
int make_variants(Arguments *arguments, const Scene *scene);
/* Open the set of --control. Without -t, its targets become those of the render, which reduces noise the most. */
int read_control(Arguments *arguments, RetexError *err);
/* Render a picture with that set as control variate. */
int render_controlled(Arguments *arguments, const Scene *scene, const char *output, RetexError *err);
/* Load replacement textures onto their targets. */
int replace_textures(Arguments *arguments, const Scene *scene, RetexTexture **loaded, RetexError *err);

/* ---- list_targets.c ---- */

/* Before the scene is read: check that the picture can be written. */
void check_sheet(const Arguments *arguments);
/* Whether it takes memory for each pixel. */
static inline int lists_pixels(const Arguments *a) { return a->sheet || a->cli->verbose; }
void list_targets(Arguments *arguments, Scene *scene);

/* ---- live.c ---- */

/* Answer requests until there are no more. */
int live(Arguments *arguments, Scene *scene, RetexError *err);

/* ---- lamp_values.c ---- */

/* Without -l, what --light and --solo name are the lamps; before the scene is read. */
void name_lamps(Arguments *arguments);
/* Give the scene's lamps the values of --light and --solo. */
int light_lamps(const Arguments *arguments, Scene *scene, RetexError *err);

/* ---- list_lamps.c ---- */

/* The scene's lamps are others after it. */
void list_lamps(Arguments *arguments, Scene *scene);

/* ---- fingerprint.c ---- */

/* A digest of everything that the rendered rows depend on. */
uint64_t render_fingerprint(const Arguments *arguments, const Scene *scene);

/* ---- aov_files.c: beauty and AOVs as separate files, as programs that edit or denoise pictures take them ---- */

/* Make the folder, if there is none, and see whether it takes files. */
int aov_files_check(const char *folder, RetexError *err);
/* The k-th file that aov_files_write may write; 0 behind the last one. */
int aov_files_path(char *path, size_t size, const char *folder, int k);
/* Write the beauty and each AOV of the set as NAME.exr, with its values as halves, and as NAME.png, to look at: the
 * beauty through the display transform, AOVs as their RetexAovShown says, colours sRGB-encoded. */
int aov_files_write(const RetexSet *set, const char *folder, int nthreads, RetexError *err);

/* ---- stats.c ---- */

/* Before the render: check that the statistics can be written. */
void check_stats(const Arguments *arguments);
/* Warn of numbers that were left out or limited. */
void warn_numbers(const Cli *cli, const RenderStats *stats);

int write_stats(Arguments *arguments, const RenderStats *stats, const RetexSet *set, double parse_seconds,
                RetexError *err);

#endif
