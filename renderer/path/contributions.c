/* Throughput, and the contributions of paths, which go to the film (film/contribution.h says how).
 *
 * `beta` is the throughput with all factors, in the first variant of the textures: the picture's. The other sinks keep
 * theirs, so each factor is told to all of them. */
#include "path/internal.h"
#include <retex/host/assert.h>
#include "path/path.h"

int path_worker_open(PathWorker *w, RetexError *err)
{
    return w->context->split ? split_open(&w->split, w->pixel, PATHS_MAX, w->context->scene, err) : RETEX_OK;
}

void path_worker_close(PathWorker *w)
{
    split_close(&w->split);
}

Factor shading_factor(const Shading *s, Float4 d, Float4 i)
{
    return (Factor){.target = s->surface.target,
                    .d = d,
                    .i = i,
                    .albedo = color4(shading_albedo(s, 0)),
                    .albedos = s->replaced ? s->albedos : NULL,
                    .uv = s->uv};
}

const Rgb *keep_albedos(const PathContext *c, Rgb *storage, const Shading *s)
{
    if (!s->replaced)
        return NULL;
    for (int v = 0; v < c->nvariants; v++)
        storage[v] = s->albedos[v];
    return storage;
}

/* ---- a path from its start to its end ---- */

void path_start(PathWorker *w, Path *path, const Ray *ray, const Sampler *sampler)
{
    const PathContext *c = w->context;
    path->beta = color4(rgb_grey(1));
    path->wavelength = -1, path->leaving = 0;
    path->beta_neutral = 1, path->pdf = 0, path->prev_context = (LightSampleContext){.position = ray->origin};
    path->segments = 1, path->straight = 0, path->sharp = path->delta = 1;
    path->media = c->camera, path->media_weight = splat(1), path->kind = RAY_CAMERA;
    path->specular = 0, path->light_group = NULL;
    path->key = sampler->key, path->sample = sampler->sample;
    path->light[0] = path->light[1] = path->light[2] = path->cut = 0;
    split_start(&w->split, &path->split, (int)(path->control - w->controls));
    if (w->control)
        control_start(path->control, c->nvariants);
}

int path_apply_factor(PathWorker *w, Path *path, const Shading *s, Split weight, const FinishFactor *finishes,
                      const float (*weights)[FINISHES_MAX], const FinishFactor *variants, int reflects)
{
    const PathContext *c = w->context;
    Rgb *betas = path->control->betas;
    Factor factor = shading_factor(s, color4(weight.d), color4(weight.i));
    factor.finishes = finishes, factor.weights = weights;
    factor.variants = variants, factor.reflects = reflects;
    set_seen(&factor, path);
    RETEX_ASSERT(!c->split || c->nvariants == 1); /* sets are rendered with the textures that they are to replace */
    path->beta *= factor_whole(&factor);
    for (int v = 1; v < c->nvariants; v++)
        betas[v] = rgb_of4(color4(betas[v]) * factor_of_variant(&factor, v));
    if (c->split)
        split_multiply(&w->split, &path->split, &factor);
    return path_is_alive(w, path);
}

/* The control film has the picture, in which lamps are as shown. */
static void add_to_control(PathWorker *w, Path *path, const Contribution *c, Float4 shown)
{
    const Scene *scene = w->context->scene;
    Rgb variants[VARIANTS_MAX];
    Contribution own = *c;
    if (scene->nlamps) {
        own.light = rgb_mul(c->light, scene->lamps[c->lamp].shown);
        for (int v = 0; c->variants && v < w->context->nvariants; v++)
            variants[v] = rgb_mul(c->variants[v], scene->lamps[c->lamp].shown);
        own.variants = c->variants ? variants : NULL;
    }
    control_add(w->control, path->control, &own, shown);
}

/* Light becomes values of the picture. storage: of its variants. */
static Contribution expose(const PathContext *context, const Contribution *c, Rgb storage[VARIANTS_MAX])
{
    Contribution exposed = *c;
    exposed.light = rgb_scale(c->light, context->exposure);
    for (int v = 0; c->variants && v < context->nvariants; v++)
        storage[v] = rgb_scale(c->variants[v], context->exposure);
    exposed.variants = c->variants ? storage : NULL;
    return exposed;
}

void path_contribute(PathWorker *w, Path *path, const Contribution *unexposed)
{
    const PathContext *context = w->context;
    Rgb variants[VARIANTS_MAX];
    const Contribution exposed = expose(context, unexposed, variants), *c = &exposed;
    Float4 light = path->beta * color4(c->light);
    for (int k = 0; k < c->nfactors; k++)
        light *= factor_whole(&c->factors[k]);
    const Scene *scene = context->scene;
    RETEX_ASSERT(c->lamp >= 0 && (!scene->nlamps || c->lamp < scene->nlamps));
    const Float4 shown = scene->nlamps ? light * color4(scene->lamps[c->lamp].shown) : light;
    if (context->trace)
        fprintf(context->trace, "  light %.6g %.6g %.6g%s%s\n", shown[0], shown[1], shown[2],
                scene->nlamps ? " of lamp " : "", scene->nlamps ? scene->lamps[c->lamp].name : "");
    if (w->control)
        add_to_control(w, path, c, shown);
    if (context->split ? split_add(&w->split, &path->split, c) : rgb_is_finite(rgb_of4(light)))
        for (int k = 0; k < 3; k++)
            path->light[k] += (double)shown[k];
    else if (!context->is_beyond)
        film_drop(w->pixel);
}

void path_end(PathWorker *w, const PathResult *result)
{
    film_add_light(w->pixel, result->light);
    film_add_cut(w->pixel, result->cut);
    film_path_end(w->pixel, &result->hits);
}
