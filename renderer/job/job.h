/* A whole render, from a scene's file and options, for retex-render and the plugin of OpenImageIO. No function prints
 * or exits. */
#ifndef RENDERER_JOB_JOB_H
#define RENDERER_JOB_JOB_H

#include "render/render.h"
#include "sdl/lang/options.h"

/* Set an option of retex-render by name: spp, noise, size, unit, seed, max-depth, crop, filter, layout, clusters,
 * orders, aov (repeated calls add AOVs); and plain, strict-paper, caustics-guide, ambient, no-ambient, strict, with the
 * value NULL or "1" for yes and "0" for no. RETEX_ENOTFOUND if no option has that name. Messages begin with the
 * name. */
int job_set_option(RenderParams *render, SdlOptions *sdl, const char *name, const char *value, RetexError *err);

/* Parse `count` whole numbers, 0 to 2^24, between separators. Return 0 if the text is anything else. */
int job_numbers(const char *text, char separator, int count, int *numbers);

/* Check a NAME=VALUE of SdlOptions. A value that begins like a number must be a number: `A=1/3` would become a string,
 * which nobody means. Values of built-in names must be numbers. */
int job_check_declare(const char *declare, RetexError *err);

/* What of a scene is to be changed later: targets, each in the form of -t, lamps, each in the form of -l, and finishes,
 * each in the form of --finish; shown: of --show. each_lamp: 1: all that have a name, instead, and light sources
 * without one, and the sky. */
typedef struct JobNames {
    const char *const *targets, *const *lamps, *const *finishes, *const *shown;
    int ntargets, nlamps, each_lamp, nfinishes, nshown;
} JobNames;

/* Read a scene and find its targets, lamps and finishes. render: the size of the picture whose pixels they may name. */
int job_open_scene(Scene **scene, const char *path, const SdlOptions *sdl, const RenderParams *render,
                   const JobNames *names, RetexError *err);

/* The second half of it: targets by pixels, and then the others. */
int job_resolve_targets(Scene *scene, const RenderParams *render, const char *const *targets, int ntargets,
                        RetexError *err);

/* The same of lamps. */
int job_resolve_lamps(Scene *scene, const RenderParams *render, const JobNames *names, RetexError *err);

/* The same of finishes, after both. RETEX_EUNSUPPORTED for targets that let light through. */
int job_resolve_finishes(Scene *scene, const JobNames *names, RetexError *err);

/* Whether no surface belongs to target t. A surface belongs to the first target that names it, so a target without
 * surfaces is a mistake. */
int job_target_is_empty(const Scene *scene, int t);

/* Warn, through the message callback of sdl, if the scene has no emitter or no object. */
void job_warn_dark(const Scene *scene, const SdlOptions *sdl);

/* RETEX_ELIMIT if a render has more pixels than its budget allows, or its images take more memory than that has left;
 * RETEX_ENOMEM if no limit is set, and they take more than the machine has. */
int job_check_size(const Scene *scene, const RenderParams *render, RetexError *err);

#endif
