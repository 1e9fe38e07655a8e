/* Throughput, and the contributions of paths: what they add to the film, and to a control film beside it.
 *
 * `beta` is the whole throughput. With several variants of the textures each has a throughput of its own, for nothing
 * that is chosen along a path depends on a texture. In sets, hits keep the factors of targets: `beta_rest` is the
 * throughput without those factors, and the light of each contribution is added to the hit that it met last, counted
 * from the camera. A film takes paths one after the other, so the paths of a packet hand their contributions over when
 * they end. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "path/internal.h"

/* Contributions at a vertex: of an emitter that the path meets, and of direct light. */
#define VERTEX_LIGHTS_MAX 2 /* and light sources that throw caustics */

/* Memory for the most contributions that there may be, of which little is ever touched. */
int path_worker_open(PathWorker *w, RetexError *err)
{
    const PathContext *c = w->context;
    const int of_air = c->scene->fogs || c->scene->has_media ? 4 : 0; /* of each segment */
    size_t lights = (size_t)PATHS_MAX * (size_t)(c->max_depth + STRAIGHT_MAX + 1) *
                    (size_t)(VERTEX_LIGHTS_MAX + of_air + c->caustic_sources);
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

const Rgb *keep_albedos(const PathContext *c, Rgb *storage, const Shading *s)
{
    if (!s->replaced)
        return NULL;
    for (int v = 0; v < c->nvariants; v++)
        storage[v] = s->albedos[v];
    return storage;
}

/* ---- hits ---- */

/* Whether the target's texture changes this factor. */
static int is_textured(const Factor *f)
{
    return f->target >= 0 && !is_black4(f->d);
}

/* Whether a factor is a hit. A reflection is one even where the texture does not change it, so that what is seen
 * reflected in a polished floor stays apart from the floor's own texture. Light that only passes through a target
 * unchanged makes no hit. */
static int is_hit(const Factor *f)
{
    return f->target >= 0 && (f->reflects || !is_black4(f->d));
}

/* Set the factor of the last hit, d a + i. Where one of d and i is black, the other is multiplied into beta_rest and 1
 * stays in its place: so beta_rest is black wherever no texture can make the contribution other than black. */
static inline void set_last_factor(Path *path, Float4 d, Float4 i)
{
    path->last_d = d, path->last_i = i;
    if (is_black4(i)) {
        path->beta_rest *= d;
        path->last_d = splat(1);
    } else if (is_black4(d)) {
        path->beta_rest *= i;
        path->last_i = splat(1);
    }
}

/* Whether a hit keeps the factor apart: then it is counted. Else it is multiplied into beta_rest as a whole, with the
 * original albedo; *folded: with a texture that changes it. counts: of the path's hits and those added since. */
static inline int keep_as_hit(const PathContext *c, const Path *path, Float4 *beta_rest, HitCounts *counts, int *folded,
                              const Factor *f, Float4 whole)
{
    int added = counts->nhits - path->counts.nhits;
    if (is_hit(f) && path->hits.count + added < PATH_HITS_MAX &&
        hit_counts_allow(counts, f->target, c->orders, c->most_hits)) {
        hit_counts_add(counts, f->target, !is_black4(f->d) && !is_black4(f->i));
        return 1;
    }
    *beta_rest *= whole;
    *folded |= is_textured(f);
    return 0;
}

static inline PathHit *add_hit(PathWorker *w, Path *path, const Factor *f, PathHit *before, Float4 before_d,
                               Float4 before_i)
{
    const TargetHit at = {f->uv, rgb_of4(f->albedo), (unsigned char)f->target, (unsigned char)f->sharp, 0};
    return path_hits_add(&path->hits, &w->hits[w->nhits++], &at, before, before_d, before_i);
}

/* The hit of the current vertex: direct light and the continued path share it. */
static inline PathHit *find_current_hit(PathWorker *w, Path *path, const Factor *f)
{
    const PathHit *hit = path->current_hit;
    if (!hit || hit->at.target != f->target || hit->at.uv.u != f->uv.u || hit->at.uv.v != f->uv.v ||
        hit->at.sharp != f->sharp)
        path->current_hit = add_hit(w, path, f, path->last_hit, path->last_d, path->last_i);
    return path->current_hit;
}

/* Add light to the last of the path's hits and `count` further ones. folded: the contribution, where some factor of it
 * was folded, else NULL. */
static inline void add_to_hits(PathWorker *w, Path *path, const Factor *const *further, int count, Float4 light,
                               const Float4 *folded)
{
    PathHit *last = path->last_hit;
    Float4 d = path->last_d, i = path->last_i;
    for (int k = 0; k < count; k++) {
        last = k == 0 ? find_current_hit(w, path, further[0]) : add_hit(w, path, further[k], last, d, i);
        d = further[k]->d, i = further[k]->i;
    }
    if (last)
        path_hit_add_light(last, d, i, light);
    else
        path->hits.free += light, path->hits.free_connections++;
    if (folded)
        film_add_folded(w->pixel, rgb_of4(*folded), rgb_of4(last ? path_white(last, d * light, i * light) : light));
}

/* ---- variants ---- */

/* Multiply the throughputs of the variants after the first. */
static inline void multiply_others(const PathContext *c, Rgb *betas, const Factor *f)
{
    for (int v = 1; v < c->nvariants; v++)
        betas[v] = rgb_of4(colour4(betas[v]) * (f->d * (f->albedos ? colour4(f->albedos[v]) : f->albedo) + f->i));
}

/* One more contribution in the log for the control film, by variant: to be filled in. */
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

/* ---- a path from its start to its end ---- */

void path_start(PathWorker *w, Path *path, const Ray *ray, const Sampler *sampler)
{
    const PathContext *c = w->context;
    path->beta = path->beta_rest = colour4(rgb_grey(1));
    path->wavelength = -1, path->leaving = 0;
    path->beta_neutral = 1, path->pdf = 0, path->prev_context = (LightSampleContext){.position = ray->origin};
    path->segments = 1, path->straight = 0, path->sharp = path->delta = 1;
    path->media = c->camera, path->media_weight = splat(1), path->kind = RAY_CAMERA;
    path->specular = 0, path->lit_group = NULL;
    path->sample = sampler->sample;
    path->light[0] = path->light[1] = path->light[2] = 0;
    path->counts = HIT_COUNTS_INIT, path->folded = 0;
    path->hits = (PathHits){.last = NULL}, path->last_hit = path->current_hit = NULL;
    path->first_light = path->last_light = -1;
    for (int v = 1; v < c->nvariants; v++)
        path->betas[v] = rgb_grey(1);
}

int path_apply_factor(PathWorker *w, Path *path, const Shading *s, Float4 d, Float4 i, int reflects)
{
    const PathContext *c = w->context;
    Factor factor = shading_factor(s, d, i);
    factor.reflects = reflects, factor.sharp = path->sharp;
    const Float4 whole = factor_whole(&factor);
    path->beta *= whole;
    multiply_others(c, path->betas, &factor);
    if (c->split && keep_as_hit(c, path, &path->beta_rest, &path->counts, &path->folded, &factor, whole)) {
        path->last_hit = find_current_hit(w, path, &factor);
        set_last_factor(path, d, i);
    }
    path->current_hit = NULL;
    return path_is_alive(w, path);
}

static void print_light(const PathContext *c, Float4 light)
{
    fprintf(c->trace, "  light %.6g %.6g %.6g\n", light[0], light[1], light[2]);
}

/* Add a contribution to the picture, unless it is not finite. rest: the same without the factors that hits keep.
 * Returns 0 where hits need not know of it. */
static inline int add_to_beauty(PathWorker *w, Path *path, Float4 beauty, Float4 rest)
{
    if (!rgb_is_finite(rgb_of4(beauty + rest))) {
        film_drop(w->pixel);
        return 0;
    }
    for (int c = 0; c < 3; c++)
        path->light[c] += (double)beauty[c];
    return !is_black4(rest);
}

void path_add_unsplit_light(PathWorker *w, Path *path, const Rgb *lights)
{
    int split = w->context->split;
    const Float4 light = colour4(lights[0]), beauty = path->beta * light;
    const Float4 rest = split ? path->beta_rest * light : beauty;
    if (add_to_beauty(w, path, beauty, rest) && split)
        add_to_hits(w, path, NULL, 0, rest, path->folded ? &beauty : NULL);
    if (!w->control)
        return;
    Rgb *logged = add_to_log(w, path);
    logged[0] = rgb_of4(beauty);
    for (int v = 1; v < w->context->nvariants; v++)
        logged[v] = rgb_mul(path->betas[v], lights[v]);
}

/* As path_add_light, of plain pictures. Returns the contribution. */
static inline Float4 add_plain_light(PathWorker *w, Path *path, Float4 light, const Factor *factors, int nfactors)
{
    Float4 beauty = path->beta * light;
    for (int k = 0; k < nfactors; k++)
        beauty *= factor_whole(&factors[k]);
    if (w->context->trace)
        print_light(w->context, beauty);
    add_to_beauty(w, path, beauty, beauty);
    return beauty;
}

/* As path_add_light, of sets. */
static inline Float4 add_split_light(PathWorker *w, Path *path, Float4 light, const Factor *factors, int nfactors)
{
    const PathContext *c = w->context;
    const Factor *kept[1 + LIGHT_FACTORS_MAX + SHADOW_FACTORS_MAX];
    Float4 beauty = path->beta * light, rest = path->beta_rest * light;
    HitCounts counts = path->counts;
    int count = 0, folded = path->folded;
    for (int k = 0; k < nfactors; k++) {
        const Float4 whole = factor_whole(&factors[k]);
        beauty *= whole;
        if (keep_as_hit(c, path, &rest, &counts, &folded, &factors[k], whole))
            kept[count++] = &factors[k];
    }
    if (c->trace)
        print_light(c, beauty);
    if (add_to_beauty(w, path, beauty, rest))
        add_to_hits(w, path, kept, count, rest, folded ? &beauty : NULL);
    return beauty;
}

void path_add_light(PathWorker *w, Path *path, Rgb light, const Factor *factors, int nfactors)
{
    const Float4 beauty = w->context->split ? add_split_light(w, path, colour4(light), factors, nfactors)
                                            : add_plain_light(w, path, colour4(light), factors, nfactors);
    if (!w->control)
        return;
    Rgb *logged = add_to_log(w, path);
    logged[0] = rgb_of4(beauty);
    for (int v = 1; v < w->context->nvariants; v++)
        logged[v] = rgb_mul(path->betas[v], light);
    for (int k = 0; k < nfactors; k++)
        multiply_others(w->context, logged, &factors[k]);
}

void path_end(PathWorker *w, Path *path)
{
    film_add_light(w->pixel, path->light);
    film_path_end(w->pixel, &path->hits);
    if (w->control)
        hand_over_log(w, path);
}
