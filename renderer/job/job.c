/* See job.h. */
#include "job/job.h"
#include "sdl/lang/parser.h"
#include "sdl/statements.h"

int job_target_is_empty(const Scene *scene, int t)
{
    for (int k = 0; k < scene->nprimitives; k++)
        if (primitive_target_texture(&scene->primitives[k], t))
            return 0;
    for (int k = 0; k < scene->ninstances; k++)
        if (instance_target_texture(scene, &scene->instances[k], t, NULL))
            return 0;
    return 1;
}

int job_open_scene(Scene **scene, const char *path, const SdlOptions *sdl, const RenderParams *render,
                   const JobNames *names, RetexError *err)
{
    int code = sdl_read(scene, path, sdl, &scene_builder, err);
    if (!code)
        code = job_resolve_targets(*scene, render, names->targets, names->ntargets, err);
    if (!code)
        code = job_resolve_lamps(*scene, render, names, err);
    if (!code)
        code = job_resolve_finishes(*scene, names, err);
    if (code)
        scene_close(scene);
    return code;
}

int job_check_size(const Scene *scene, const RenderParams *r, RetexError *err)
{
    double width = r->crop[2] ? r->crop[2] : r->width ? r->width : scene->width;
    double height = r->crop[3] ? r->crop[3] : r->height ? r->height : scene->height;
    const uint64_t left = retex_budget_left(r->budget);
    const int is_limited = left != UINT64_MAX;
    double memory = (double)(is_limited ? left : retex_machine_memory());
    const long pixels = retex_budget_pixels(r->budget);
    if (pixels > 0 && width * height > (double)pixels)
        return retex_fail(err, RETEX_ELIMIT, "%.0fx%.0f pixels are more than the %ld of --max-pixels", width, height,
                          pixels);
    double bytes = render_bytes(scene, r, (int)width, (int)height);
    if (memory > 0 && bytes > memory)
        return retex_fail(err, is_limited ? RETEX_ELIMIT : RETEX_ENOMEM,
                          "%.0fx%.0f pixels need %.1f GB of memory, there are %.1f: render parts with --crop%s", width,
                          height, bytes / 1e9, memory / 1e9, is_limited ? ", or raise --max-memory" : "");
    return RETEX_OK;
}
