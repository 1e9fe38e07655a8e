/* Images with other textures: several from the same paths (--variants), and one with a set as control variate
 * (--control). */
#include <string.h>
#include <retex/clock.h>
#include "film/limits.h"
#include "render/control_constants.h"
#include "render/internal.h"
#include "render/render.h"

static long limit_picture(RetexImage *picture)
{
    return film_limit_numbers(picture->pixels, 3 * (size_t)picture->width * (size_t)picture->height, 0);
}

int render_variants(RetexImage *pictures, const Scene *scene, const RenderParams *params, RenderStats *stats,
                    RetexError *err)
{
    RenderStats ignored;
    if (!stats)
        stats = &ignored;
    *stats = (RenderStats){0};
    double started = retex_clock_seconds();
    RenderParams plain = *params;
    Render r;
    plain.plain = 1, plain.denoise_data = 0;
    render_drop_files(&plain);
    int code = render_open(&r, scene, &plain, err);
    if (!code && r.params.nvariants < 1)
        code = retex_fail(err, RETEX_EINVAL, "no variants to render");
    r.context.nvariants = r.params.nvariants;
    if (!code)
        code = render_open_guide(&r, err);
    if (!code)
        code = render_open_film(&r, 1, 0, err);
    if (!code)
        code = render_paths(&r, stats, started, err);
    for (int v = 0; v < r.params.nvariants && !code; v++) {
        pictures[v] = *control_film_picture(r.control, v);
        stats->limited += limit_picture(&pictures[v]);
        *control_film_picture(r.control, v) = (RetexImage){0};
    }
    render_close(&r);
    return code;
}

/* Fails if the set does not belong to the same image. */
static int check_control(const Render *r, const RetexSet *set, RetexError *err)
{
    const RetexSetInfo info = retex_set_info(set);
    const char *slash = strrchr(r->scene->path, '/'), *scene = slash ? slash + 1 : r->scene->path;
    if (info.width != r->w || info.height != r->h)
        return retex_fail(err, RETEX_EINVAL, "the set is %dx%d, this picture %dx%d", info.width, info.height, r->w,
                          r->h);
    if (strncmp(info.scene, scene, RETEX_SCENE_MAX - 1))
        return retex_fail(err, RETEX_EINVAL, "the set is of %s, this is %s", info.scene, scene);
    if (strcmp(info.filter, r->params.gaussian ? "gaussian" : "box"))
        return retex_fail(err, RETEX_EINVAL, "the set has the pixel filter %s, this picture another", info.filter);
    if (info.max_depth != r->params.max_depth)
        return retex_fail(err, RETEX_EINVAL, "the set has paths of up to %d segments, this picture of up to %d",
                          info.max_depth, r->params.max_depth);
    for (int t = 0; info.ntargets && t < r->scene->ntargets; t++)
        if (retex_set_find_target(set, r->scene->targets[t].name) < 0)
            return retex_fail(err, RETEX_EINVAL, "the set has no target `%s`", r->scene->targets[t].name);
    if (info.seed == r->params.seed)
        return retex_fail(err, RETEX_EINVAL, "the set has the same seed, %u: the new samples must have other noise",
                          (unsigned)info.seed);
    return RETEX_OK;
}

/* The constants by pixel, and the set recombined with them. */
static int find_constants(Render *r, RetexSet *set, RetexImage *constants, RetexImage *combined, RetexError *err)
{
    FirstHitWindow window = render_window(r);
    int code = control_constants(constants, &window, set, err);
    if (!code)
        code = control_constants_combine(combined, set, r->scene, constants, r->params.nthreads, err);
    r->constants = constants;
    return code;
}

static int trace_control(Render *r, RetexImage *picture, const RetexSet *set, const RetexImage *combined,
                         ControlMode mode, double *distance, RenderStats *stats, double started, RetexError *err)
{
    r->context.halves = mode == CONTROL_HALVES ? 2 : 1;
    int code = render_open_film(r, 1, r->context.halves, err);
    if (code)
        return code;
    code = render_paths(r, stats, started, err);
    if (code)
        return code;
    ControlMoments *moments[2] = {control_film_moments(r->control, 0), control_film_moments(r->control, 1)};
    HalfSamples half = render_half_samples(r);
    if (distance)
        *distance = control_distance(moments, half.samples, r->context.halves, set);
    code = control_variate(picture, moments, half.samples, set, combined, mode, err);
    if (!code)
        stats->limited = limit_picture(picture);
    return code;
}

int render_control(RetexImage *picture, const Scene *scene, const RenderParams *params, RetexSet *set, ControlMode mode,
                   double *distance, RenderStats *stats, RetexError *err)
{
    RenderStats ignored;
    if (!stats)
        stats = &ignored;
    *stats = (RenderStats){0};
    double started = retex_clock_seconds();
    RenderParams plain = *params;
    RenderVariant variants[CONTROL_VARIANTS_MAX] = {{{NULL}, NULL}};
    RetexImage constants[RETEX_MAX_TARGETS] = {{0}}, combined = {0};
    Render r;
    if (params->nvariants > 0)
        variants[0] = params->variants[0];
    plain.plain = 1, plain.variants = variants, plain.nvariants = 2, plain.denoise_data = 0;
    render_drop_files(&plain);
    int code = render_open(&r, scene, &plain, err);
    if (!code)
        code = check_control(&r, set, err);
    int two = !code && mode == CONTROL_UNBIASED && control_constants_fit(scene, set);
    r.context.nvariants = 2 + two;
    if (!code)
        code = render_open_guide(&r, err);
    if (two && !code)
        code = find_constants(&r, set, constants, &combined, err);
    if (!code)
        code = trace_control(&r, picture, set, two ? &combined : NULL, mode, distance, stats, started, err);
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        retex_image_free(&constants[t]);
    retex_image_free(&combined);
    render_close(&r);
    return code;
}
