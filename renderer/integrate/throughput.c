/* What paths bring to the film.
 *
 * A plain picture needs the throughput only. Sets and several variants need more of it: `beta` is the whole by variant
 * of the textures, for no choice along a path looks at a texture; `outside`, for sets, leaves out the target hits that
 * `expansion` holds as factors. Light that arrives goes to the film both ways. The film wants one path after the
 * other, and all this is large: so paths that are traced side by side write down what happens, and it is done when
 * they end. */
#include <stdlib.h>
#include <string.h>
#include "integrate/path_parts.h"

typedef enum PathEventKind { EVENT_SCALE, EVENT_SCATTER, EVENT_CONNECT } PathEventKind;

struct PathEvent {
    PathEventKind kind;
    int nfactors;    /* of a connection: so many events follow, for their factors alone */
    Rgb by;          /* scale or light */
    PathEvent *next; /* of the same path */
    Factor factor;
};

/* Scaled twice, an emitter met, a light picked with all that is on the way to it, a bounce. */
#define VERTEX_EVENTS_MAX (2 + 2 + 3 + SHADOW_FACTORS_MAX + 1)

/* Is there only one path at a time, so that nothing has to wait? */
static int is_alone(const PathContext *c)
{
    return !c->split || c->trace;
}

int path_worker_open(PathWorker *w, RetexError *err)
{
    const PathContext *c = w->context;
    if (is_alone(c))
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

/* ---- one path ---- */

/* Does the target's texture matter to this factor? */
static int is_textured(const PathContext *c, const Factor *f)
{
    return c->split && f->target >= 0 && !rgb_is_black(f->split.d);
}

/* A reflection counts as a hit of its target even where the texture does not matter, so that what is seen in a polished
 * floor stays apart from what is seen on it. What merely passes a target does not count. */
static int is_hit(const PathContext *c, const Factor *f)
{
    return c->split && f->target >= 0 && (f->reflects || !rgb_is_black(f->split.d));
}

/* Multiply by a factor: as a target hit while there is an order left, else as it is. */
static void apply_factor(const PathContext *c, Rgb *beta, Rgb *outside, Expansion *e, int *folded, const Factor *f)
{
    Rgb whole = split_apply(f->split, f->albedo);
    beta[0] = rgb_mul(beta[0], whole);
    for (int v = 1; v < c->nvariants; v++)
        beta[v] = rgb_mul(beta[v], f->albedos ? split_apply(f->split, f->albedos[v]) : whole);
    if (is_hit(c, f) && expansion_has_room(e, f->target, c->orders, c->most_hits)) {
        expansion_push(e, f->target, f->split, f->uv, f->albedo, f->sharp);
        return;
    }
    *outside = rgb_mul(*outside, whole);
    if (is_textured(c, f))
        *folded = 1;
}

/* Nothing is left of it in any variant. */
static int is_spent(const PathContext *c, const Rgb *beta)
{
    for (int v = 0; v < c->nvariants; v++)
        if (!rgb_is_black(beta[v]))
            return 0;
    return 1;
}

static void start_whole(PathWorker *w)
{
    Throughput *t = &w->whole;
    for (int v = 0; v < w->context->nvariants; v++)
        t->beta[v] = rgb_grey(1);
    t->outside = rgb_grey(1);
    t->folded = 0;
    expansion_reset(&t->expansion);
}

static void scale_whole(PathWorker *w, Rgb by)
{
    Throughput *t = &w->whole;
    for (int v = 0; v < w->context->nvariants; v++)
        t->beta[v] = rgb_mul(t->beta[v], by);
    t->outside = rgb_mul(t->outside, by);
}

static void scatter_whole(PathWorker *w, const Factor *factor)
{
    Throughput *t = &w->whole;
    apply_factor(w->context, t->beta, &t->outside, &t->expansion, &t->folded, factor);
}

static void connect_whole(PathWorker *w, Rgb light, const Factor *factors, int nfactors)
{
    const PathContext *c = w->context;
    const Throughput *t = &w->whole;
    Rgb beta[VARIANTS_MAX], outside = rgb_mul(t->outside, light);
    for (int v = 0; v < c->nvariants; v++)
        beta[v] = rgb_mul(t->beta[v], light);
    const Expansion *e = &t->expansion;
    int folded = t->folded;
    for (int k = 0; k < nfactors; k++) {
        if (e != &w->scratch && is_hit(c, &factors[k])) {
            expansion_copy(&w->scratch, e);
            e = &w->scratch;
        }
        apply_factor(c, beta, &outside, &w->scratch, &folded, &factors[k]);
    }
    if (is_spent(c, beta) && rgb_is_black(outside))
        return;
    if (c->trace)
        fprintf(c->trace, "  light %.6g %.6g %.6g over %d target hits\n", beta[0].r, beta[0].g, beta[0].b, e->nhits);
    film_connect(w->pixel, beta[0], outside, e, folded);
    if (w->control)
        control_connect(w->control, beta);
}

/* ---- several at a time ---- */

static PathEvent *add_event(PathWorker *w, Path *path, PathEventKind kind, Rgb by)
{
    PathEvent *e = &w->events[w->nevents++];
    e->kind = kind, e->by = by, e->nfactors = 0, e->next = NULL;
    *path->next_event = e;
    path->next_event = &e->next;
    return e;
}

/* Do what was written down. */
static void run_events(PathWorker *w, const Path *path)
{
    Factor factors[SHADOW_FACTORS_MAX + 2];
    start_whole(w);
    for (const PathEvent *e = path->events; e; e = e->next) {
        if (e->kind == EVENT_SCALE) {
            scale_whole(w, e->by);
        } else if (e->kind == EVENT_SCATTER) {
            scatter_whole(w, &e->factor);
        } else {
            Rgb light = e->by;
            int n = e->nfactors;
            for (int k = 0; k < n; k++)
                e = e->next, factors[k] = e->factor;
            connect_whole(w, light, factors, n);
        }
    }
}

void path_start(PathWorker *w, Path *path, const Ray *ray, const Sampler *sampler)
{
    path->beta = path->outside = rgb_grey(1);
    path->neutral = 1, path->pdf = 0, path->from = (LitPoint){ray->origin, {0, 0, 0}};
    path->segments = 1, path->passed = 0, path->sharp = 1;
    path->media.count = 0, path->kind = RAY_CAMERA;
    path->sample = sampler->sample;
    path->light[0] = path->light[1] = path->light[2] = 0;
    path->events = NULL, path->next_event = &path->events;
    if (is_alone(w->context) && !w->context->simple)
        start_whole(w);
}

void path_scale(PathWorker *w, Path *path, Rgb by)
{
    path->beta = rgb_mul(path->beta, by);
    path->outside = rgb_mul(path->outside, by);
    if (!is_alone(w->context))
        add_event(w, path, EVENT_SCALE, by);
    else if (!w->context->simple)
        scale_whole(w, by);
}

int path_scatter(PathWorker *w, Path *path, const Factor *factor)
{
    const PathContext *c = w->context;
    Rgb whole = split_apply(factor->split, factor->albedo);
    if (c->simple) {
        path->beta = rgb_mul(path->beta, whole);
        return !rgb_is_black(path->beta);
    }
    if (is_alone(c))
        scatter_whole(w, factor);
    else
        add_event(w, path, EVENT_SCATTER, whole)->factor = *factor;
    if (!c->split)
        return !is_spent(c, w->whole.beta);
    if (!is_hit(c, factor))
        path->outside = rgb_mul(path->outside, whole);
    return !rgb_is_black(path->outside);
}

void path_bring(PathWorker *w, Path *path, Rgb light)
{
    if (film_accepts(w->pixel, light, light))
        path->light[0] += light.r, path->light[1] += light.g, path->light[2] += light.b;
}

void path_connect(PathWorker *w, Path *path, Rgb light, const Factor *factors, int nfactors)
{
    const PathContext *c = w->context;
    if (c->simple) {
        Rgb sum = rgb_mul(path->beta, light);
        for (int k = 0; k < nfactors; k++)
            sum = rgb_mul(sum, split_apply(factors[k].split, factors[k].albedo));
        path_bring(w, path, sum);
    } else if (is_alone(c)) {
        connect_whole(w, light, factors, nfactors);
    } else {
        add_event(w, path, EVENT_CONNECT, light)->nfactors = nfactors;
        for (int k = 0; k < nfactors; k++)
            add_event(w, path, EVENT_CONNECT, light)->factor = factors[k];
    }
}

void path_end(PathWorker *w, Path *path)
{
    if (!is_alone(w->context))
        run_events(w, path);
    if (w->context->simple)
        film_add_light(w->pixel, path->light);
    film_path_end(w->pixel);
}
