/* The constant of each pixel that a control variate needs. See control_constants.h. */
#include <stdlib.h>
#include <string.h>
#include <retex/combine.h>
#include <retex/host/set_build.h>
#include <retex/host/texture_lookup.h>
#include <retex/parallel.h>
#include "camera/camera.h"
#include "render/control_constants.h"

enum { GRID = 3, MEANS = 32 }; /* per side: rays of a pixel, and texels of a target's mean */
#define FOLDED_MAX 1e-3        /* limit of the light with fixed original textures, which recombination cannot change */

int control_constants_fit(const Scene *scene, const RetexSet *set)
{
    const RetexSetInfo info = retex_set_info(set);
    if (!info.nterms || info.strict_paper || info.folded > FOLDED_MAX || info.ntargets != scene->ntargets)
        return 0;
    for (int t = 0; t < scene->ntargets; t++) {
        int found = retex_set_find_target(set, scene->targets[t].name);
        if (found < 0 || strcmp(retex_set_target(set, found)->idents, scene->targets[t].idents))
            return 0;
    }
    return 1;
}

typedef struct ColorJob {
    const FirstHitWindow *window;
    RetexImage *colors;
    Rgb means[RETEX_MAX_TARGETS];
} ColorJob;

static void color_row(void *context, int y, int thread)
{
    const ColorJob *job = context;
    const FirstHitWindow *w = job->window;
    (void)thread;
    for (int x = 0; x < w->w; x++) {
        Rgb sums[RETEX_MAX_TARGETS] = {{0, 0, 0}};
        int counts[RETEX_MAX_TARGETS] = {0};
        for (int k = 0; k < GRID * GRID; k++) {
            double dx = (k % GRID + 0.5) / GRID, dy = (k / GRID + 0.5) / GRID;
            const float lens[2] = {(float)((k * 7 % (GRID * GRID) + 0.5) / (GRID * GRID)), /* a lattice of its own */
                                   (float)((k * 3 % (GRID * GRID) + 0.5) / (GRID * GRID))};
            Ray ray = camera_ray(&w->scene->camera, w->width, w->height, w->x0 + x + dx, w->y0 + y + dy, lens);
            Hit hit;
            Shading s;
            if (!accel_intersect(w->accel, &ray, RAY_CAMERA, &hit))
                continue;
            shading_at(&s, w->scene, w->variants, 1, &ray, &hit);
            int t = s.surface.target;
            if (t >= 0)
                sums[t] = rgb_add(sums[t], shading_albedo(&s, 0)), counts[t]++;
        }
        for (int t = 0; t < w->scene->ntargets; t++) {
            Rgb color = counts[t] ? rgb_scale(sums[t], 1 / (float)counts[t]) : job->means[t];
            float *p = job->colors[t].pixels + retex_image_index(&job->colors[t], x, y);
            p[0] = color.r, p[1] = color.g, p[2] = color.b;
        }
    }
}

/* Mean colour of a whole target: of the original, or of the new texture over the range of UV that was seen. */
static Rgb target_mean(const RetexTarget *target, const RetexTexture *texture)
{
    const float *original = target->mean_albedo;
    Rgb mean = rgb(original[0], original[1], original[2]), sum = rgb_grey(0);
    for (int k = 0; k < MEANS * MEANS && texture; k++) {
        double u = (k % MEANS + 0.5) / MEANS, v = (k / MEANS + 0.5) / MEANS;
        float rgba[4];
        retex_texture_point(texture, target->uv_min[0] + u * (target->uv_max[0] - target->uv_min[0]),
                            target->uv_min[1] + v * (target->uv_max[1] - target->uv_min[1]), rgba);
        sum = rgb_add(sum, rgb_lerp(mean, rgb(rgba[0], rgba[1], rgba[2]), rgba[3]));
    }
    return texture ? rgb_scale(sum, 1.0f / (MEANS * MEANS)) : mean;
}

int control_constants(RetexImage *colors, const FirstHitWindow *window, const RetexSet *set, RetexError *err)
{
    const Scene *scene = window->scene;
    ColorJob job = {.window = window, .colors = colors};
    int code = RETEX_OK;
    for (int t = 0; t < scene->ntargets && !code; t++) {
        const RetexTarget *target = retex_set_target(set, retex_set_find_target(set, scene->targets[t].name));
        job.means[t] = target_mean(target, window->variants[0].textures[t]);
        code = retex_image_alloc(&colors[t], window->w, window->h, 3, err);
    }
    if (!code)
        retex_parallel(window->nthreads, window->h, color_row, &job);
    return code;
}

int control_constants_combine(RetexImage *dst, RetexSet *set, const Scene *scene, const RetexImage *colors,
                              int nthreads, RetexError *err)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    for (int t = 0; t < scene->ntargets; t++) {
        specs[t] = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
        memcpy(specs[t].target, scene->targets[t].name, sizeof specs[t].target);
        specs[t].constant = 1;
    }
    int code = retex_sample(set, specs, scene->ntargets, nthreads, err);
    const RetexFootprint *footprint;
    for (int k = 0; !code && (footprint = retex_set_footprint(set, k)); k++)
        for (int t = 0; t < scene->ntargets; t++)
            if (!strcmp(retex_set_target(set, footprint->target)->name, scene->targets[t].name))
                memcpy(retex_set_mutable_image(set, footprint->sampled - 1)->pixels, colors[t].pixels,
                       (size_t)colors[t].width * (size_t)colors[t].height * 3 * sizeof(float));
    if (!code)
        code = retex_combine(dst, set, NULL, NULL, nthreads, err);
    retex_set_lift(set, -1);
    return code;
}
