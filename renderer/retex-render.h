/* What the parts of retex-render share: what was said on the command line, and what is done for it. Every mistake
 * prints one line and exits with CLI_FAIL. */
#ifndef RENDERER_RETEX_RENDER_H
#define RENDERER_RETEX_RENDER_H

#include <retex/retex.h>
#include "cli.h"
#include "texture_args.h"
#include "batch.h"
#include "job/job.h"

#define LIST_MAX 64

typedef struct Arguments {
    Cli *cli;
    RenderParams render;
    SdlOptions sdl;
    const char *scene, *stats, *variants, *control, *aov_dir;
    ControlMode control_mode;
    int seeded;
    Batch batch; /* of --variants */
    const char *targets[LIST_MAX], *includes[LIST_MAX], *declares[LIST_MAX];
    int ntargets, nincludes, ndeclares, nreplacements, list, trace[3], tracing;
    RetexTextureSpec replacements[RETEX_MAX_TARGETS];
    RenderVariant replaced;
    double uv_scales[RETEX_MAX_TARGETS][2]; /* once measured */
    int measured;
    RetexSet *control_set;
    char set_targets[RETEX_MAX_TARGETS][RETEX_NAME_MAX + 512]; /* its targets, as of -t */
    int named;                                                 /* -t was given */
    int denoise, no_denoise_data;
    const char *merged[LIST_MAX];
    int nmerged;
    char checkpoint[4096]; /* OUTPUT.partial, or "" where the output is no file */
} Arguments;

/* ---- arguments.c ---- */

void parse_arguments(Arguments *arguments);

/* ---- replaced.c: --replace, --variants and --control ---- */

/* Check the table of --variants, before the scene is read. */
void check_table(Arguments *arguments);
/* Make its pictures, or with --dry-run say what they would be; returns the exit status. */
int make_variants(Arguments *arguments, const Scene *scene);
/* The set of --control. Its targets are those of the render, unless some are named: then it tells the most. */
void read_control(Arguments *arguments);
/* A picture from new samples and that set. */
void render_controlled(Arguments *arguments, const Scene *scene, const char *output);
/* Load replacement textures onto their targets. */
void replace_textures(Arguments *arguments, const Scene *scene, RetexTexture **loaded);

/* ---- fingerprint.c ---- */

/* Of everything that the rendered rows depend on. */
uint64_t render_fingerprint(const Arguments *arguments, const Scene *scene);

/* ---- stats.c ---- */

/* Before the work: whether the statistics can be written. */
void check_stats(const Arguments *arguments);
void write_stats(Arguments *arguments, const RenderStats *stats, const RetexSet *set, double parse_seconds);

#endif
