/* What paths bring to the film.
 *
 * `beta` is the whole throughput; of several variants of the textures the worker has it by variant, for no choice along
 * a path looks at a texture. Sets keep target hits apart: `outside` is the throughput without them, and the hits are
 * written down with the light that arrives behind them. The film wants one path after the other, and polynomials are
 * large: so paths that are traced side by side hand all that over when they end. */
#include <math.h>
#include <stdlib.h>
#include "integrate/path_parts.h"

/* A hit of a target, or light that arrives behind those before it, and behind some that only this light met. */
struct PathEvent {
    PathEvent *next; /* of the same path */
    int is_light;
    int own_hits; /* of light: so many events follow, for these */
    FilmLight light;
    Factor hit;
};

/* At a vertex: an emitter met, a light picked with all that is on the way to it, a bounce. */
#define VERTEX_EVENTS_MAX (2 + 1 + 2 + SHADOW_FACTORS_MAX + 1)

int path_worker_open(PathWorker *w, RetexError *err)
{
    const PathContext *c = w->context;
    if (!c->split)
        return RETEX_OK;
    size_t most = (size_t)PATHS_MAX * VERTEX_EVENTS_MAX * (size_t)(c->max_depth + STRAIGHT_MAX + 1);
    w->events = malloc(most * sizeof *w->events); /* of which little is ever touched */
    return w->events ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "out of memory for paths");
}

void path_worker_close(PathWorker *w)
{
    free(w->events);
    w->events = NULL;
}

Factor shading_factor(const Shading *s, Split split)
{
    return (Factor){s->surface.target, split, shading_albedo(s, 0), s->replaced ? s->albedos : NULL, s->uv, 0, 0};
}

/* ---- target hits ---- */

/* Does the target's texture matter to this factor? */
static int is_textured(const Factor *f)
{
    return f->target >= 0 && !rgb_is_black(f->split.d);
}

/* A reflection counts as a hit of its target even where the texture does not matter, so that what is seen in a polished
 * floor stays apart from what is seen on it. What merely passes a target does not count. */
static int is_hit(const Factor *f)
{
    return f->target >= 0 && (f->reflects || !rgb_is_black(f->split.d));
}

/* Multiply by a factor: as a target hit while there is an order left, else as it is. Returns 1 for a hit. */
static int take_factor(const PathContext *c, Rgb *outside, ExpansionSize *size, int *folded, const Factor *f)
{
    if (is_hit(f) && expansion_has_room(size, f->target, c->orders, c->most_hits)) {
        expansion_grow(size, f->target, f->split);
        return 1;
    }
    *outside = rgb_mul(*outside, split_apply(f->split, f->albedo));
    *folded |= is_textured(f);
    return 0;
}

static PathEvent *add_event(PathWorker *w, Path *path)
{
    PathEvent *e = &w->events[w->nevents++];
    e->next = NULL;
    *path->next_event = e;
    path->next_event = &e->next;
    return e;
}

static void add_hit(PathWorker *w, Path *path, const Factor *factor)
{
    PathEvent *e = add_event(w, path);
    e->is_light = 0, e->hit = *factor;
}

static PathEvent *add_light(PathWorker *w, Path *path, const FilmLight *light, int own_hits)
{
    PathEvent *e = add_event(w, path);
    e->is_light = 1, e->own_hits = own_hits, e->light = *light;
    return e;
}

static int is_finite(Rgb c)
{
    return isfinite(c.r + c.g + c.b);
}

/* Light behind the path's hits so far, and no others. */
static void arrive(PathWorker *w, Path *path, const FilmLight *light)
{
    FilmLight *sum = path->arrived ? &path->arrived->light : NULL;
    if (!sum || sum->folded != light->folded || !is_finite(rgb_add(light->beauty, light->outside))) {
        path->arrived = add_light(w, path, light, 0);
        return;
    }
    sum->beauty = rgb_add(sum->beauty, light->beauty);
    sum->outside = rgb_add(sum->outside, light->outside);
    sum->connections++;
}

static void push_hit(Expansion *e, const Factor *hit)
{
    expansion_push(e, hit->target, hit->split, hit->uv, hit->albedo, hit->sharp);
}

/* All that a path brought goes to the film. */
static void hand_over(PathWorker *w, const Path *path)
{
    Expansion *e = &w->expansion;
    expansion_reset(e);
    for (const PathEvent *event = path->events; event; event = event->next) {
        if (!event->is_light) {
            push_hit(e, &event->hit);
        } else if (event->own_hits == 0) {
            film_connect(w->pixel, &event->light, e);
        } else {
            const FilmLight *light = &event->light;
            expansion_copy(&w->scratch, e);
            for (int k = event->own_hits; k > 0; k--) {
                event = event->next;
                push_hit(&w->scratch, &event->hit);
            }
            film_connect(w->pixel, light, &w->scratch);
        }
    }
}

/* ---- variants ---- */

static void scale_variants(PathWorker *w, Rgb by)
{
    for (int v = 0; v < w->context->nvariants; v++)
        w->betas[v] = rgb_mul(w->betas[v], by);
}

static void multiply(const PathContext *c, Rgb *betas, const Factor *f)
{
    for (int v = 0; v < c->nvariants; v++)
        betas[v] = rgb_mul(betas[v], split_apply(f->split, f->albedos ? f->albedos[v] : f->albedo));
}

/* Nothing is left of it in any variant. */
static int is_spent(const PathContext *c, const Rgb *betas)
{
    for (int v = 0; v < c->nvariants; v++)
        if (!rgb_is_black(betas[v]))
            return 0;
    return 1;
}

static void connect_variants(PathWorker *w, Rgb light, const Factor *factors, int nfactors)
{
    const PathContext *c = w->context;
    Rgb betas[VARIANTS_MAX];
    for (int v = 0; v < c->nvariants; v++)
        betas[v] = rgb_mul(w->betas[v], light);
    for (int k = 0; k < nfactors; k++)
        multiply(c, betas, &factors[k]);
    if (w->control)
        control_connect(w->control, betas);
}

/* ---- a path's life ---- */

void path_start(PathWorker *w, Path *path, const Ray *ray, const Sampler *sampler)
{
    const PathContext *c = w->context;
    path->beta = path->outside = rgb_grey(1);
    path->neutral = 1, path->pdf = 0, path->from = (LitPoint){ray->origin, {0, 0, 0}};
    path->segments = 1, path->passed = 0, path->sharp = 1;
    path->media.count = 0, path->kind = RAY_CAMERA;
    path->sample = sampler->sample;
    path->light[0] = path->light[1] = path->light[2] = 0;
    path->hits = (ExpansionSize){.nmonomials = 1}, path->folded = 0;
    path->arrived = NULL, path->events = NULL, path->next_event = &path->events;
    for (int v = 0; v < c->nvariants && c->compare; v++)
        w->betas[v] = rgb_grey(1);
}

/* Can any light come by it? */
static int is_alive(const PathWorker *w, const Path *path)
{
    const PathContext *c = w->context;
    if (c->split)
        return !rgb_is_black(path->outside);
    return c->compare ? !is_spent(c, w->betas) : !rgb_is_black(path->beta);
}

int path_scale(PathWorker *w, Path *path, Rgb by)
{
    path->beta = rgb_mul(path->beta, by);
    path->outside = rgb_mul(path->outside, by);
    if (w->context->compare)
        scale_variants(w, by);
    return is_alive(w, path);
}

int path_scatter(PathWorker *w, Path *path, const Factor *factor)
{
    const PathContext *c = w->context;
    path->beta = rgb_mul(path->beta, split_apply(factor->split, factor->albedo));
    if (c->compare)
        multiply(c, w->betas, factor);
    if (c->split && take_factor(c, &path->outside, &path->hits, &path->folded, factor)) {
        add_hit(w, path, factor);
        path->arrived = NULL;
    }
    return is_alive(w, path);
}

/* As path_connect, of plain pictures. */
static void connect_plain(PathWorker *w, Path *path, Rgb beauty)
{
    if (film_accepts(w->pixel, beauty))
        path->light[0] += beauty.r, path->light[1] += beauty.g, path->light[2] += beauty.b;
}

void path_bring(PathWorker *w, Path *path, Rgb light)
{
    Rgb beauty = rgb_mul(path->beta, light);
    if (w->context->split)
        arrive(w, path, &(FilmLight){beauty, rgb_mul(path->outside, light), path->folded, 1});
    else
        connect_plain(w, path, beauty);
    if (w->context->compare)
        connect_variants(w, light, NULL, 0);
}

/* As path_connect, of sets. */
static void connect_split(PathWorker *w, Path *path, Rgb beauty, Rgb light, const Factor *factors, int nfactors)
{
    const PathContext *c = w->context;
    const Factor *own[SHADOW_FACTORS_MAX + 2];
    FilmLight sum = {beauty, rgb_mul(path->outside, light), path->folded, 1};
    ExpansionSize size = path->hits;
    int count = 0;
    for (int k = 0; k < nfactors; k++)
        if (take_factor(c, &sum.outside, &size, &sum.folded, &factors[k]))
            own[count++] = &factors[k];
    if (rgb_is_black(beauty) && rgb_is_black(sum.outside))
        return;
    if (count == 0) {
        arrive(w, path, &sum);
        return;
    }
    add_light(w, path, &sum, count);
    for (int k = 0; k < count; k++)
        add_hit(w, path, own[k]);
}

void path_connect(PathWorker *w, Path *path, Rgb light, const Factor *factors, int nfactors)
{
    const PathContext *c = w->context;
    Rgb beauty = rgb_mul(path->beta, light);
    for (int k = 0; k < nfactors; k++)
        beauty = rgb_mul(beauty, split_apply(factors[k].split, factors[k].albedo));
    if (c->trace)
        fprintf(c->trace, "  light %.6g %.6g %.6g\n", beauty.r, beauty.g, beauty.b);
    if (c->split)
        connect_split(w, path, beauty, light, factors, nfactors);
    else
        connect_plain(w, path, beauty);
    if (c->compare)
        connect_variants(w, light, factors, nfactors);
}

void path_end(PathWorker *w, Path *path)
{
    if (w->context->split)
        hand_over(w, path);
    else
        film_add_light(w->pixel, path->light);
    film_path_end(w->pixel);
}
