/* What paths bring to the film, and to a control film beside it.
 *
 * `beta` is the whole throughput; of several variants of the textures each has its own, for no choice along a path
 * looks at a texture. Sets keep target hits apart: `outside` is the throughput without them, and the hits are written
 * down with the light that arrives behind them. Films want one path after the other, and polynomials are large: so
 * paths that are traced side by side hand all that over when they end. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "integrate/path_parts.h"

/* A hit of a target, or light that arrives behind those before it, and behind some that only this light met. There are
 * many, so that they should not drive the scene out of the caches: one takes a line of 64 bytes. */
struct PathEvent {
    int next; /* of the same path, among the worker's; -1: none */
    char is_light;
    char own_hits; /* of light: so many events follow, for these */
    union {
        FilmLight light;
        struct {
            TargetHit at; /* as of its Factor */
            Split split;
        } hit;
    };
};

/* At a vertex: an emitter met, a light picked with all that is on the way to it, a bounce. */
#define VERTEX_EVENTS_MAX (2 + 1 + 2 + SHADOW_FACTORS_MAX + 1)
#define VERTEX_LIGHTS_MAX 2

/* Room for the most that may be, of which little is ever touched. */
int path_worker_open(PathWorker *w, RetexError *err)
{
    const PathContext *c = w->context;
    size_t vertices = (size_t)PATHS_MAX * (size_t)(c->max_depth + STRAIGHT_MAX + 1);
    size_t lights = vertices * VERTEX_LIGHTS_MAX;
    if (c->split)
        w->events = aligned_alloc(sizeof *w->events, vertices * VERTEX_EVENTS_MAX * sizeof *w->events);
    if (w->control) {
        w->log.lights = malloc(lights * (size_t)c->nvariants * sizeof *w->log.lights);
        w->log.next = malloc(lights * sizeof *w->log.next);
    }
    if ((c->split && !w->events) || (w->control && (!w->log.lights || !w->log.next)))
        return retex_fail(err, RETEX_ENOMEM, "out of memory for paths");
    return RETEX_OK;
}

void path_worker_close(PathWorker *w)
{
    free(w->events);
    free(w->log.lights);
    free(w->log.next);
    w->events = NULL;
    w->log = (ControlLog){NULL, NULL, 0};
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

/* Of a hit that has a single part, the part goes outside, and the hit keeps 1 of it: so hits at the same place are the
 * same, whichever way light goes on from there. Returns 1 where it has both. */
static int take_part(Split *split, Rgb *outside)
{
    Rgb *part = rgb_is_black(split->i) ? &split->d : rgb_is_black(split->d) ? &split->i : NULL;
    if (!part)
        return 1;
    *outside = rgb_mul(*outside, *part);
    *part = rgb_grey(1);
    return 0;
}

/* Multiply by a factor: as a target hit while there is an order left, else by what it is as a whole. Returns 1 for a
 * hit. */
static inline int take_factor(const PathContext *c, Rgb *outside, ExpansionSize *size, int *folded, Factor *f,
                              Rgb whole)
{
    if (is_hit(f) && expansion_has_room(size, f->target, c->orders, c->most_hits)) {
        expansion_grow(size, f->target, take_part(&f->split, outside));
        return 1;
    }
    *outside = rgb_mul(*outside, whole);
    *folded |= is_textured(f);
    return 0;
}

static PathEvent *add_event(PathWorker *w, Path *path)
{
    int at = w->nevents++;
    PathEvent *e = &w->events[at];
    e->next = -1;
    if (path->last < 0)
        path->first = at;
    else
        w->events[path->last].next = at;
    path->last = at;
    path->beside = NULL;
    return e;
}

static void add_hit(PathWorker *w, Path *path, const Factor *f)
{
    PathEvent *e = add_event(w, path);
    e->is_light = 0;
    e->hit.at = (TargetHit){f->uv, f->albedo, (unsigned char)f->target, (unsigned char)f->sharp, 0};
    e->hit.split = f->split;
}

static PathEvent *add_light(PathWorker *w, Path *path, const FilmLight *light, int own_hits)
{
    PathEvent *e = add_event(w, path);
    e->is_light = 1, e->own_hits = (char)own_hits, e->light = *light;
    return e;
}

static int is_same_hit(const PathEvent *e, const Factor *f)
{
    const TargetHit *at = &e->hit.at;
    return at->target == f->target && at->uv.u == f->uv.u && at->uv.v == f->uv.v && at->sharp == f->sharp &&
           !memcmp(&e->hit.split, &f->split, sizeof f->split);
}

/* The path goes on from a hit. If light came just now by that hit alone, it stands behind the path's own. */
static void go_on_from(PathWorker *w, Path *path, const Factor *factor)
{
    PathEvent *light = path->beside, *hit = &w->events[path->last];
    if (light && is_same_hit(hit, factor)) {
        FilmLight sum = light->light;
        light->is_light = 0, light->hit = hit->hit;
        hit->is_light = 1, hit->own_hits = 0, hit->light = sum;
        path->arrived = hit, path->beside = NULL;
    } else {
        add_hit(w, path, factor);
        path->arrived = NULL;
    }
}

/* Two lights become one. */
static int join(FilmLight *sum, const FilmLight *light)
{
    if (sum->folded != light->folded)
        return 0;
    sum->outside = rgb_add(sum->outside, light->outside);
    sum->connections++;
    return 1;
}

/* Light behind the path's hits so far, and no others. */
static void arrive(PathWorker *w, Path *path, const FilmLight *light)
{
    if (!path->arrived || !join(&path->arrived->light, light))
        path->arrived = add_light(w, path, light, 0);
}

static void push_hit(Expansion *e, const PathEvent *hit)
{
    expansion_push(e, &hit->hit.at, &hit->hit.split);
}

/* All that a path brought goes to the film. */
static void hand_over(PathWorker *w, const Path *path)
{
    Expansion *e = &w->expansion;
    expansion_reset(e);
    for (int at = path->first; at >= 0; at = w->events[at].next) {
        const PathEvent *event = &w->events[at];
        if (!event->is_light) {
            push_hit(e, event);
        } else if (event->own_hits == 0) {
            film_connect(w->pixel, &event->light, e);
        } else {
            expansion_mark(&w->mark, e);
            for (int k = event->own_hits; k > 0; k--) {
                at = w->events[at].next;
                push_hit(e, &w->events[at]);
            }
            film_connect(w->pixel, &event->light, e);
            expansion_return(e, &w->mark);
        }
    }
}

/* ---- variants ---- */

/* Those after the first. */
static void multiply_others(const PathContext *c, Rgb *betas, const Factor *f)
{
    for (int v = 1; v < c->nvariants; v++)
        betas[v] = rgb_mul(betas[v], split_apply(f->split, f->albedos ? f->albedos[v] : f->albedo));
}

/* Room for the light that just arrived, by variant, for the control film. */
static Rgb *add_to_log(PathWorker *w, Path *path)
{
    ControlLog *log = &w->log;
    int at = log->count++;
    log->next[at] = -1;
    if (path->last_light < 0)
        path->first_light = at;
    else
        log->next[path->last_light] = at;
    path->last_light = at;
    return log->lights + (size_t)at * (size_t)w->context->nvariants;
}

static void hand_over_log(PathWorker *w, const Path *path)
{
    const ControlLog *log = &w->log;
    for (int at = path->first_light; at >= 0; at = log->next[at])
        control_connect(w->control, log->lights + (size_t)at * (size_t)w->context->nvariants);
    control_sample_end(w->control, path->half);
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
    path->arrived = path->beside = NULL, path->first = path->last = -1;
    path->first_light = path->last_light = -1;
    for (int v = 1; v < c->nvariants; v++)
        path->betas[v] = rgb_grey(1);
}

int path_scatter(PathWorker *w, Path *path, Factor *factor)
{
    const PathContext *c = w->context;
    Rgb whole = split_apply(factor->split, factor->albedo);
    path->beta = rgb_mul(path->beta, whole);
    multiply_others(c, path->betas, factor);
    if (c->split && take_factor(c, &path->outside, &path->hits, &path->folded, factor, whole))
        go_on_from(w, path, factor);
    return path_is_alive(w, path);
}

static void trace_light(const PathContext *c, Rgb light)
{
    fprintf(c->trace, "  light %.6g %.6g %.6g\n", light.r, light.g, light.b);
}

/* Light reaches the picture, unless it is not finite. Returns 0 where it has no use for sets either. */
static inline int add_beauty(PathWorker *w, Path *path, Rgb beauty, Rgb outside, int folded)
{
    if (!rgb_is_finite(rgb_add(beauty, outside))) {
        film_drop(w->pixel);
        return 0;
    }
    path->light[0] += beauty.r, path->light[1] += beauty.g, path->light[2] += beauty.b;
    if (folded)
        film_add_folded(w->pixel, beauty);
    return !rgb_is_black(outside);
}

void path_bring(PathWorker *w, Path *path, const Rgb *lights)
{
    int split = w->context->split;
    Rgb beauty = rgb_mul(path->beta, lights[0]), outside = split ? rgb_mul(path->outside, lights[0]) : beauty;
    if (add_beauty(w, path, beauty, outside, path->folded) && split)
        arrive(w, path, &(FilmLight){outside, path->folded, 1});
    if (!w->control)
        return;
    Rgb *arrived = add_to_log(w, path);
    arrived[0] = beauty;
    for (int v = 1; v < w->context->nvariants; v++)
        arrived[v] = rgb_mul(path->betas[v], lights[v]);
}

/* As path_connect, of plain pictures. Returns what arrives. */
static Rgb connect_plain(PathWorker *w, Path *path, Rgb light, const Factor *factors, int nfactors)
{
    Rgb beauty = rgb_mul(path->beta, light);
    for (int k = 0; k < nfactors; k++)
        beauty = rgb_mul(beauty, split_apply(factors[k].split, factors[k].albedo));
    if (w->context->trace)
        trace_light(w->context, beauty);
    add_beauty(w, path, beauty, beauty, 0);
    return beauty;
}

/* As path_connect, of sets. */
static Rgb connect_split(PathWorker *w, Path *path, Rgb light, Factor *factors, int nfactors)
{
    const PathContext *c = w->context;
    const Factor *own[SHADOW_FACTORS_MAX + 2];
    Rgb beauty = rgb_mul(path->beta, light);
    FilmLight sum = {rgb_mul(path->outside, light), path->folded, 1};
    ExpansionSize size = path->hits;
    int count = 0;
    for (int k = 0; k < nfactors; k++) {
        Rgb whole = split_apply(factors[k].split, factors[k].albedo);
        beauty = rgb_mul(beauty, whole);
        if (take_factor(c, &sum.outside, &size, &sum.folded, &factors[k], whole))
            own[count++] = &factors[k];
    }
    if (c->trace)
        trace_light(c, beauty);
    if (!add_beauty(w, path, beauty, sum.outside, sum.folded))
        return beauty;
    if (count == 0) {
        arrive(w, path, &sum);
        return beauty;
    }
    PathEvent *e = add_light(w, path, &sum, count);
    for (int k = 0; k < count; k++)
        add_hit(w, path, own[k]);
    if (count == 1)
        path->beside = e;
    return beauty;
}

void path_connect(PathWorker *w, Path *path, Rgb light, Factor *factors, int nfactors)
{
    Rgb beauty = w->context->split ? connect_split(w, path, light, factors, nfactors)
                                   : connect_plain(w, path, light, factors, nfactors);
    if (!w->control)
        return;
    Rgb *arrived = add_to_log(w, path);
    arrived[0] = beauty;
    for (int v = 1; v < w->context->nvariants; v++)
        arrived[v] = rgb_mul(path->betas[v], light);
    for (int k = 0; k < nfactors; k++)
        multiply_others(w->context, arrived, &factors[k]);
}

void path_end(PathWorker *w, Path *path)
{
    film_add_light(w->pixel, path->light);
    if (w->context->split)
        hand_over(w, path);
    film_path_end(w->pixel);
    if (w->control)
        hand_over_log(w, path);
}
