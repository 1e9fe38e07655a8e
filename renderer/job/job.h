/* A render as a whole, from a scene's file and its options on: what retex-render and the plugin for OpenImageIO do
 * alike. Nothing here prints or exits. */
#ifndef RENDERER_JOB_JOB_H
#define RENDERER_JOB_JOB_H

#include "render/render.h"
#include "sdl/sdl.h"

/* Set what an option of retex-render says: spp, noise, size, seed, max-depth, crop, filter, layout, clusters, orders,
 * aov (which adds up), and plain, strict-paper, caustics-guide, ambient, strict, whose value is NULL or "1" for yes and
 * "0" for no. RETEX_ENOTFOUND where there is no option of that name; messages begin with the name. */
int job_set_option(RenderParams *render, SdlOptions *sdl, const char *name, const char *value, RetexError *err);

/* count whole numbers of 0 to 2^24 with a separator between them and nothing behind them; 0 where the text is not. */
int job_numbers(const char *text, char separator, int count, int *numbers);

/* NAME=VALUE of SdlOptions: what begins like a number must be one, for `A=1/3` would be a string that nobody meant; the
 * built-ins are numbers. */
int job_check_declare(const char *declare, RetexError *err);

/* Read a scene and find its targets, each as after -t. A scene with nothing in it is refused. */
int job_open_scene(Scene **scene, const char *path, const SdlOptions *sdl, const char *const *targets, int ntargets,
                   RetexError *err);

/* 1: no surface belongs to target t. Each goes to the first target that names it, so one that is left without any is a
 * mistake. */
int job_target_is_empty(const Scene *scene, int t);

/* A warning, through the message of sdl, where nothing in the scene gives light. */
void job_warn_dark(const Scene *scene, const SdlOptions *sdl);

/* RETEX_ENOMEM where the images of a render take more memory than its budget has left, or than the machine has;
 * RETEX_ELIMIT where it has more pixels than the budget allows. */
int job_check_size(const Scene *scene, const RenderParams *render, RetexError *err);

#endif
