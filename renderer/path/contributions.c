/* What paths bring to the film, and to a control film beside it.
 *
 * `beta` is the whole throughput; of several variants of the textures each has its own, for no choice along a path
 * looks at a texture. Sets keep target hits apart: `outside` is the throughput without them, and the hits are written
 * down with the light that came by them. Films want one path after the other: so paths that are traced side by side
 * hand all that over when they end. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "path/internal.h"

/* Lights at a vertex: an emitter met, a light picked. */
#define VERTEX_LIGHTS_MAX 2

/* Room for the most that may be, of which little is ever touched. */
int path_worker_open(PathWorker *w, RetexError *err)
{
    const PathContext *c = w->context;
    size_t lights = (size_t)PATHS_MAX * (size_t)(c->max_depth + STRAIGHT_MAX + 1) * VERTEX_LIGHTS_MAX;
    if (c->split)
        w->hits = aligned_alloc(sizeof *w->hits, (size_t)PATHS_MAX * PATH_HITS_MAX * sizeof *w->hits);
    if (w->control) {
        w->log.lights = malloc(lights * (size_t)c->nvariants * sizeof *w->log.lights);
        w->log.next = malloc(lights * sizeof *w->log.next);
    }
    if ((c->split && !w->hits) || (w->control && (!w->log.lights || !w->log.next)))
        return retex_fail(err, RETEX_ENOMEM, "out of memory for paths");
    return RETEX_OK;
}

void path_worker_close(PathWorker *w)
{
    free(w->hits);
    free(w->log.lights);
    free(w->log.next);
    w->hits = NULL;
    w->log = (ControlLog){NULL, NULL, 0};
}

Factor shading_factor(const Shading *s, Float4 d, Float4 i)
{
    return (Factor){
        s->surface.target, d, i, colour4(shading_albedo(s, 0)), s->replaced ? s->albedos : NULL, s->uv, 0, 0};
}

/* ---- target hits ---- */

/* Does the target's texture matter to this factor? */
static int is_textured(const Factor *f)
{
    return f->target >= 0 && !is_black4(f->d);
}

/* A reflection counts as a hit of its target even where the texture does not matter, so that what is seen in a polished
 * floor stays apart from what is seen on it. What merely passes a target does not count. */
static int is_hit(const Factor *f)
{
    return f->target >= 0 && (f->reflects || !is_black4(f->d));
}

/* Of a hit that the path goes on from and that has a single part, the part goes outside, and 1 of it is left: where
 * outside is black, no texture brings light back. */
static inline void take_part(Path *path, Float4 d, Float4 i)
{
    path->from_d = d, path->from_i = i;
    if (is_black4(i)) {
        path->outside *= d;
        path->from_d = splat(1);
    } else if (is_black4(d)) {
        path->outside *= i;
        path->from_i = splat(1);
    }
}

/* Multiply by a factor: as a target hit while there is an order left, which goes into size, else by what it is as a
 * whole. Returns 1 for a hit. */
static inline int take_factor(const PathContext *c, const Path *path, Float4 *outside, HitCounts *size, int *folded,
                              const Factor *f, Float4 whole)
{
    int more = size->nhits - path->size.nhits;
    if (is_hit(f) && path->hits.count + more < PATH_HITS_MAX &&
        hit_counts_allow(size, f->target, c->orders, c->most_hits)) {
        hit_counts_add(size, f->target, !is_black4(f->d) && !is_black4(f->i));
        return 1;
    }
    *outside *= whole;
    *folded |= is_textured(f);
    return 0;
}

static inline PathHit *add_hit(PathWorker *w, Path *path, const Factor *f, PathHit *before, Float4 before_d,
                               Float4 before_i)
{
    const TargetHit at = {f->uv, rgb_of4(f->albedo), (unsigned char)f->target, (unsigned char)f->sharp, 0};
    return path_hits_add(&path->hits, &w->hits[w->nhits++], &at, before, before_d, before_i);
}

/* The hit of a factor right behind those that the path came by: light that was picked at a surface, and the path that
 * goes on from there, share one. */
static inline PathHit *next_hit(PathWorker *w, Path *path, const Factor *f)
{
    const PathHit *here = path->here;
    if (!here || here->at.target != f->target || here->at.uv.u != f->uv.u || here->at.uv.v != f->uv.v ||
        here->at.sharp != f->sharp)
        path->here = add_hit(w, path, f, path->from_hit, path->from_d, path->from_i);
    return path->here;
}

/* Light behind the path's hits so far, and some more; folded: what it is, where it met hits that are, or NULL. */
static inline void arrive(PathWorker *w, Path *path, const Factor *const *more, int count, Float4 light,
                          const Float4 *folded)
{
    PathHit *last = path->from_hit;
    Float4 d = path->from_d, i = path->from_i;
    for (int k = 0; k < count; k++) {
        last = k == 0 ? next_hit(w, path, more[0]) : add_hit(w, path, more[k], last, d, i);
        d = more[k]->d, i = more[k]->i;
    }
    if (last)
        path_hit_add_light(last, d, i, light);
    else
        path->hits.free += light, path->hits.free_connections++;
    if (folded)
        film_add_folded(w->pixel, rgb_of4(*folded), rgb_of4(last ? path_white(last, d * light, i * light) : light));
}

/* ---- variants ---- */

/* Those after the first. */
static inline void multiply_others(const PathContext *c, Rgb *betas, const Factor *f)
{
    for (int v = 1; v < c->nvariants; v++)
        betas[v] = rgb_of4(colour4(betas[v]) * (f->d * (f->albedos ? colour4(f->albedos[v]) : f->albedo) + f->i));
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
    path->beta = path->outside = colour4(rgb_grey(1));
    path->neutral = 1, path->pdf = 0, path->from = (LitPoint){ray->origin, {0, 0, 0}};
    path->segments = 1, path->passed = 0, path->sharp = 1;
    path->media.count = 0, path->kind = RAY_CAMERA;
    path->sample = sampler->sample;
    path->light[0] = path->light[1] = path->light[2] = 0;
    path->size = (HitCounts){.nmonomials = 1}, path->folded = 0;
    path->hits = (PathHits){.last = NULL}, path->from_hit = path->here = NULL;
    path->first_light = path->last_light = -1;
    for (int v = 1; v < c->nvariants; v++)
        path->betas[v] = rgb_grey(1);
}

int path_scatter(PathWorker *w, Path *path, const Shading *s, Float4 d, Float4 i, int reflects)
{
    const PathContext *c = w->context;
    Factor factor = shading_factor(s, d, i);
    factor.reflects = reflects, factor.sharp = path->sharp;
    const Float4 whole = factor_whole(&factor);
    path->beta *= whole;
    multiply_others(c, path->betas, &factor);
    if (c->split && take_factor(c, path, &path->outside, &path->size, &path->folded, &factor, whole)) {
        path->from_hit = next_hit(w, path, &factor);
        take_part(path, d, i);
    }
    path->here = NULL;
    return path_is_alive(w, path);
}

static void trace_light(const PathContext *c, Float4 light)
{
    fprintf(c->trace, "  light %.6g %.6g %.6g\n", light[0], light[1], light[2]);
}

/* Light reaches the picture, unless it is not finite. Returns 0 where it has no use for sets either. */
static inline int add_beauty(PathWorker *w, Path *path, Float4 beauty, Float4 outside)
{
    if (!rgb_is_finite(rgb_of4(beauty + outside))) {
        film_drop(w->pixel);
        return 0;
    }
    for (int c = 0; c < 3; c++)
        path->light[c] += (double)beauty[c];
    return !is_black4(outside);
}

void path_bring(PathWorker *w, Path *path, const Rgb *lights)
{
    int split = w->context->split;
    const Float4 light = colour4(lights[0]), beauty = path->beta * light;
    const Float4 outside = split ? path->outside * light : beauty;
    if (add_beauty(w, path, beauty, outside) && split)
        arrive(w, path, NULL, 0, outside, path->folded ? &beauty : NULL);
    if (!w->control)
        return;
    Rgb *arrived = add_to_log(w, path);
    arrived[0] = rgb_of4(beauty);
    for (int v = 1; v < w->context->nvariants; v++)
        arrived[v] = rgb_mul(path->betas[v], lights[v]);
}

/* As path_connect, of plain pictures. Returns what arrives. */
static inline Float4 connect_plain(PathWorker *w, Path *path, Float4 light, const Factor *factors, int nfactors)
{
    Float4 beauty = path->beta * light;
    for (int k = 0; k < nfactors; k++)
        beauty *= factor_whole(&factors[k]);
    if (w->context->trace)
        trace_light(w->context, beauty);
    add_beauty(w, path, beauty, beauty);
    return beauty;
}

/* As path_connect, of sets. */
static inline Float4 connect_split(PathWorker *w, Path *path, Float4 light, const Factor *factors, int nfactors)
{
    const PathContext *c = w->context;
    const Factor *own[SHADOW_FACTORS_MAX + 2];
    Float4 beauty = path->beta * light, outside = path->outside * light;
    HitCounts size = path->size;
    int count = 0, folded = path->folded;
    for (int k = 0; k < nfactors; k++) {
        const Float4 whole = factor_whole(&factors[k]);
        beauty *= whole;
        if (take_factor(c, path, &outside, &size, &folded, &factors[k], whole))
            own[count++] = &factors[k];
    }
    if (c->trace)
        trace_light(c, beauty);
    if (add_beauty(w, path, beauty, outside))
        arrive(w, path, own, count, outside, folded ? &beauty : NULL);
    return beauty;
}

void path_connect(PathWorker *w, Path *path, Rgb light, const Factor *factors, int nfactors)
{
    const Float4 beauty = w->context->split ? connect_split(w, path, colour4(light), factors, nfactors)
                                            : connect_plain(w, path, colour4(light), factors, nfactors);
    if (!w->control)
        return;
    Rgb *arrived = add_to_log(w, path);
    arrived[0] = rgb_of4(beauty);
    for (int v = 1; v < w->context->nvariants; v++)
        arrived[v] = rgb_mul(path->betas[v], light);
    for (int k = 0; k < nfactors; k++)
        multiply_others(w->context, arrived, &factors[k]);
}

void path_end(PathWorker *w, Path *path)
{
    film_add_light(w->pixel, path->light);
    film_path_end(w->pixel, &path->hits);
    if (w->control)
        hand_over_log(w, path);
}
