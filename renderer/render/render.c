/* A whole render: all parts of the scene's light are rendered into a set. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <retex/clock.h>
#include <retex/host/set_build.h>
#include <retex/version.h>
#include "film/limits.h"
#include "render/checkpoints.h"
#include "render/internal.h"
#include "render/mean_aovs.h"
#include "render/originals.h"
#include "render/render.h"
#include "render/uv_scale.h"

int render_start_set(RetexSet **set, const Render *r, RetexError *err)
{
    int code = retex_set_create(set, r->w, r->h, err);
    if (code)
        return code;
    code = retex_set_add_part(*set, "beauty", "RGB", RETEX_FLOAT, 0, 0, NULL, err);
    if (code)
        return code;
    const char *name = strrchr(r->scene->path, '/');
    RetexSetInfo info = retex_set_info(*set);
    info.layout = r->context.split ? render_layout(&r->params)->name : "plain";
    info.filter = r->params.gaussian ? "gaussian" : "box";
    info.scene = name ? name + 1 : r->scene->path;
    info.generator = "retex-render " RETEX_VERSION;
    info.orders = r->params.orders, info.spp = r->params.spp;
    info.max_depth = r->params.max_depth, info.seed = r->params.seed;
    info.unit = r->params.unit;
    info.exposure = r->scene->exposure;
    return retex_set_describe(*set, &info, err);
}

/* The part `irradiance`: a separate pass with its own samples, at the first hits of the pixel centres. */
static int add_irradiance(RetexSet *set, const Render *r, RetexError *err)
{
    Render pass = render_pass(r);
    RetexSet *found = NULL;
    RenderStats ignored = {0};
    int part;
    pass.context.white = 1, pass.context.split = 0, pass.context.halves = 1;
    pass.params.seed = hash_pair(r->params.seed, 2), pass.params.denoise_data = 0;
    int code = render_start_set(&found, &pass, err);
    if (!code)
        code = render_open_film(&pass, 0, 0, err);
    if (!code)
        code = render_paths(&pass, &ignored, 0, err);
    if (!code)
        code = film_finish(pass.film, found, err);
    if (!code)
        code = first_hit_add_aov(set, RETEX_AOV_IRRADIANCE, &part, err);
    if (!code) {
        float *irradiance = retex_set_mutable_image(set, part)->pixels;
        const float *radiance = retex_set_part(found, 0)->image.pixels;
        for (size_t i = 0; i < (size_t)r->w * (size_t)r->h * 3; i++)
            irradiance[i] = (float)PI * radiance[i];
    }
    render_close_films(&pass);
    retex_set_close(&found);
    return code;
}

/* Of the parts in memory; those in the band store were limited when their bands were finished. */
static long limit_numbers(RetexSet *set)
{
    long replaced = 0;
    const RetexPart *part;
    for (int k = 0; (part = retex_set_part(set, k)); k++) {
        const RetexImage *im = retex_set_mutable_image(set, k);
        const int aov = retex_aov_find(part->name);
        if (im->pixels)
            replaced += film_limit_numbers(im->pixels, (size_t)im->width * (size_t)im->height * (size_t)im->channels,
                                           aov >= 0 && isinf(retex_aov_info(aov)->nothing));
    }
    return replaced;
}

/* Render, then add the images that the film does not have. */
static int render_into(RetexSet *set, Render *r, RenderStats *stats, double started, RetexError *err)
{
    int data = r->params.control_data;
    r->context.halves = data == 2 ? 2 : 1;
    int code = render_open_film(r, data > 0, r->context.halves, err);
    if (code)
        return code;
    if (render_paths(r, stats, started, err))
        return checkpoint_save(r->film, &r->params, err);
    code = film_finish(r->film, set, err);
    FirstHitWindow window = render_window(r);
    if (!code && r->context.split)
        code = first_hit_targets(set, &window, err);
    double scales[RETEX_MAX_TARGETS][2];
    if (!code && r->context.split)
        code = uv_scale_measure(r->scene, r->accel, scales, err);
    RetexTarget *target;
    for (int t = 0; !code && (target = retex_set_mutable_target(set, t)); t++)
        memcpy(target->uv_scale, scales[t], sizeof scales[t]);
    if (!code && r->context.split)
        code = originals_add(set, r->scene, r->params.nthreads, err);
    if (!code)
        code = first_hit_aovs(set, &window, r->params.aovs, err);
    if (!code)
        code = mean_aovs_add(set, r, r->params.aovs, err);
    if (!code && r->pixel_guides)
        code = denoise_guides_finish(&r->guides, r->film, set, err);
    if (!code && r->params.aovs & RETEX_AOV_BIT(IRRADIANCE))
        code = add_irradiance(set, r, err);
    if (!code && data) {
        ControlMoments *moments[2] = {control_film_moments(r->control, 0), control_film_moments(r->control, 1)};
        code = control_data_add(set, moments, render_half_samples(r).samples, r->context.halves, err);
    }
    stats->limited = film_limited(r->film) + limit_numbers(set);
    const int moved = film_move_store(r->film, set, code ? NULL : err);
    code = code ? code : moved;
    if (!code)
        code = retex_set_find_further(set, err);
    stats->render_seconds = retex_clock_seconds() - started - stats->build_seconds;
    return code;
}

int render_scene(RetexSet **set, const Scene *scene, const RenderParams *params, RenderStats *stats, RetexError *err)
{
    const RenderParams defaults = RENDER_PARAMS_INIT;
    RenderStats ignored;
    if (!stats)
        stats = &ignored;
    *stats = (RenderStats){0};
    *set = NULL;
    double started = retex_clock_seconds();
    Render r;
    int code = render_open(&r, scene, params ? params : &defaults, err);
    if (!code)
        code = render_open_guide(&r, err);
    if (!code)
        code = render_start_set(set, &r, err);
    if (!code)
        code = render_into(*set, &r, stats, started, err);
    render_close(&r);
    if (code)
        retex_set_close(set);
    return code;
}

int render_ident_shares(const Scene *scene, const RenderParams *params, double *shares, RetexError *err)
{
    Render r;
    int code = render_open(&r, scene, params, err);
    FirstHitWindow window = render_window(&r);
    if (!code)
        code = first_hit_idents(&window, shares, err);
    render_close(&r);
    return code;
}

int render_target_shares(const Scene *scene, const RenderParams *params, double shares[RETEX_MAX_TARGETS],
                         RetexError *err)
{
    Render r;
    int code = render_open(&r, scene, params, err);
    FirstHitWindow window = render_window(&r);
    if (!code)
        code = first_hit_target_shares(&window, shares, err);
    render_close(&r);
    return code;
}

/* The pixel nearest to one that shows nothing; 0 where none shows anything. */
static int nearest_object(const FirstHitWindow *w, const int from[2], int nearest[2])
{
    double best = INFINITY;
    ShownSurface shown;
    for (int y = 0; y < w->h; y++)
        for (int x = 0; x < w->w; x++) {
            const double distance = hypot(x - from[0], y - from[1]);
            if (distance >= best || !first_hit_shown(w, x, y, &shown))
                continue;
            best = distance;
            nearest[0] = x, nearest[1] = y;
        }
    return best < INFINITY;
}

static int pick(const FirstHitWindow *w, const int pixel[2], ShownSurface *shown, RetexError *err)
{
    int nearest[2];
    if (pixel[0] >= w->w || pixel[1] >= w->h)
        return retex_fail(err, RETEX_EINVAL, "pixel @%d:%d does not lie inside the picture of %dx%d", pixel[0],
                          pixel[1], w->w, w->h);
    if (first_hit_shown(w, pixel[0], pixel[1], shown))
        return RETEX_OK;
    if (!nearest_object(w, pixel, nearest))
        return retex_fail(err, RETEX_ENOTFOUND, "pixel @%d:%d shows no object, nor does any other", pixel[0], pixel[1]);
    return retex_fail(err, RETEX_ENOTFOUND, "pixel @%d:%d shows no object; the nearest that does is @%d:%d", pixel[0],
                      pixel[1], nearest[0], nearest[1]);
}

int render_pick(const Scene *scene, const RenderParams *params, int count, const int (*pixels)[2], ShownSurface *shown,
                RetexError *err)
{
    RenderParams whole = *params;
    Render r;
    memset(whole.crop, 0, sizeof whole.crop);
    render_drop_files(&whole);
    int code = render_open(&r, scene, &whole, err);
    const FirstHitWindow window = render_window(&r);
    for (int k = 0; k < count && !code; k++)
        code = pick(&window, pixels[k], &shown[k], err);
    render_close(&r);
    return code;
}

int render_uv_scales(const Scene *scene, int nthreads, double scales[][2], RetexError *err)
{
    Accel *accel = NULL;
    int code = accel_create(&accel, scene, nthreads, err);
    if (!code)
        code = uv_scale_measure(scene, accel, scales, err);
    accel_close(&accel);
    return code;
}

int render_trace(const Scene *scene, const RenderParams *params, int x, int y, int sample, FILE *out, RetexError *err)
{
    Render r;
    int code = render_open(&r, scene, params, err);
    if (!code && (x < 0 || y < 0 || x >= r.width || y >= r.height))
        code = retex_fail(err, RETEX_EINVAL, "pixel %d,%d does not lie inside the picture of %dx%d", x, y, r.width,
                          r.height);
    if (!code)
        code = render_open_guide(&r, err);
    if (!code)
        code = render_open_film(&r, 0, 0, err);
    if (!code) {
        r.context.trace = out, r.context.matte = 0;
        fprintf(out, "pixel %d,%d sample %d of %dx%d\n", x, y, sample, r.width, r.height);
        render_sample(&r, x, y, sample);
    }
    render_close(&r);
    return code;
}
