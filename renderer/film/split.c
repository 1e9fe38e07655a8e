/* See split.h. */
#include <stdlib.h>
#include <string.h>
#include "film/split.h"

/* What the hit before a node does, by finish. */
typedef struct NodeFinishes {
    FinishFactor of[FINISHES_MAX];
} NodeFinishes;

int split_open(SplitSink *s, FilmPixel *pixel, size_t paths, const Scene *scene, RetexError *err)
{
    const size_t nodes = paths * TARGET_NODES_MAX, lights = paths * (TARGET_NODES_MAX + 1) * (size_t)scene->nkept;
    const int combines = scene->ncombinations > 0;
    s->pixel = pixel, s->scene = scene, s->count = s->nlamp_light = 0;
    film_hit_limits(pixel, &s->orders, &s->most_hits);
    s->nodes = aligned_alloc(sizeof *s->nodes, nodes * sizeof *s->nodes);
    s->lamp_light = lights ? aligned_alloc(sizeof(Float4), lights * sizeof *s->lamp_light) : NULL;
    s->finishes = combines ? aligned_alloc(sizeof(Float4), nodes * sizeof *s->finishes) : NULL;
    s->combined = combines ? aligned_alloc(sizeof(Float4), paths * sizeof *s->combined) : NULL;
    return s->nodes && (s->lamp_light || !lights) && ((s->finishes && s->combined) || !combines)
               ? RETEX_OK
               : retex_fail(err, RETEX_ENOMEM, "out of memory for paths");
}

void split_close(SplitSink *s)
{
    free(s->nodes);
    free(s->lamp_light);
    free(s->finishes);
    free(s->combined);
    s->nodes = NULL, s->lamp_light = NULL, s->finishes = NULL, s->combined = NULL;
}

/* ---- hits ---- */

/* Which parts a factor has, in some finish. */
typedef struct FactorParts {
    int d, i;
} FactorParts;

static inline FactorParts factor_parts(const SplitSink *s, const Factor *f)
{
    FactorParts parts = {!is_black4(f->d), !is_black4(f->i)};
    for (int k = 0; f->finishes && k < s->scene->targets[f->target].nfinishes; k++)
        parts.d |= !is_black4(f->finishes[k].d), parts.i |= !is_black4(f->finishes[k].i);
    return parts;
}

/* Whether a hit keeps the factor apart: then it is counted. Else it is to be multiplied in as a whole, with the
 * original albedo; *folded: with a texture that changes it. counts: of the path's hits and those added since.
 *
 * A reflection is a hit even where the texture does not change it, so that what is seen reflected in a polished floor
 * stays apart from the floor's own texture. Light that only passes through a target unchanged makes no hit. */
static inline int keep_as_hit(const SplitSink *s, const SplitPath *p, TargetCounts *counts, int *folded,
                              const Factor *f)
{
    const FactorParts parts = factor_parts(s, f);
    const int added = counts->nhits - p->counts.nhits, is_textured = f->target >= 0 && parts.d;
    if ((is_textured || (f->target >= 0 && f->reflects)) && p->tree.count + added < TARGET_NODES_MAX &&
        target_counts_allow(counts, f->target, s->orders, s->most_hits)) {
        target_counts_add(counts, f->target, parts.d && parts.i);
        return 1;
    }
    *folded |= is_textured;
    return 0;
}

/* finishes: the factor of the hit before it by finish, or NULL. */
static inline TargetNode *add_hit(SplitSink *s, SplitPath *p, const Factor *f, TargetNode *before, Float4 before_d,
                                  Float4 before_i, const FinishFactor *finishes)
{
    const TargetVertex at = {.uv = f->uv,
                             .albedo = rgb_of4(f->albedo),
                             .target = (unsigned char)f->target,
                             .sharp = (unsigned char)f->sharp,
                             .direct = (unsigned char)f->direct};
    TargetNode *hit = target_tree_add(&p->tree, &s->nodes[s->count], &at, before, before_d, before_i);
    if (before && finishes) {
        memcpy(s->finishes[s->count].of, finishes, sizeof s->finishes->of);
        hit->before_finishes = s->finishes[s->count].of;
    }
    s->count++;
    return hit;
}

static inline const FinishFactor *last_finishes(const SplitPath *p)
{
    return p->combined && p->combined->last_differs ? p->combined->last : NULL;
}

/* The hit of the current vertex: direct light and the continued path share it. */
static inline TargetNode *find_current_hit(SplitSink *s, SplitPath *p, const Factor *f)
{
    const TargetNode *hit = p->current_hit;
    if (!hit || hit->at.target != f->target || hit->at.uv.u != f->uv.u || hit->at.uv.v != f->uv.v ||
        hit->at.sharp != f->sharp)
        p->current_hit = add_hit(s, p, f, p->last, p->last_d, p->last_i, last_finishes(p));
    return p->current_hit;
}

/* As split_multiply, in each combination. */
static __attribute__((noinline)) void multiply_combined(SplitSink *s, SplitPath *p, const Factor *f)
{
    SplitCombined *combined = p->combined;
    const FactorParts parts = factor_parts(s, f);
    const int is_hit = keep_as_hit(s, p, &p->counts, &p->folded, f);
    combined->met |= f->finishes != NULL;
    p->rest = splat(0);
    for (int c = 0; c < s->scene->ncombinations; c++) {
        const FinishFactor by = factor_of_combination(f, s->scene, c);
        const Float4 whole = by.d * f->albedo + by.i;
        combined->beta[c] *= whole;
        combined->rest[c] *= !is_hit ? whole : !parts.i ? by.d : !parts.d ? by.i : splat(1);
        p->rest += combined->rest[c] * splat(1 / (float)s->scene->ncombinations);
    }
    if (is_hit) {
        p->last = find_current_hit(s, p, f);
        combined->last_differs = f->finishes && parts.d && parts.i;
        if (combined->last_differs)
            memcpy(combined->last, f->finishes, (size_t)s->scene->targets[f->target].nfinishes * sizeof *f->finishes);
        p->last_d = !parts.i ? splat(1) : f->d;
        p->last_i = !parts.d ? splat(1) : f->i;
    }
    p->current_hit = NULL;
}

/* Where one of d and i is black, the other is multiplied into `rest` and 1 stays in its place: so `rest` is black
 * wherever no texture can make the contribution other than black. */
void split_multiply(SplitSink *s, SplitPath *p, const Factor *f)
{
    if (p->combined) {
        multiply_combined(s, p, f);
        return;
    }
    if (keep_as_hit(s, p, &p->counts, &p->folded, f)) {
        p->last = find_current_hit(s, p, f);
        p->last_d = f->d, p->last_i = f->i;
        if (is_black4(f->i)) {
            p->rest *= f->d;
            p->last_d = splat(1);
        } else if (is_black4(f->d)) {
            p->rest *= f->i;
            p->last_i = splat(1);
        }
    } else {
        p->rest *= factor_whole(f);
    }
    p->current_hit = NULL;
}

/* ---- light ---- */

/* Light that comes to a hit, D and I, or to the camera where hit is NULL: what it would be with white targets. */
static Float4 with_white_targets(const TargetNode *hit, Float4 dependent, Float4 independent)
{
    Float4 light = target_factor_white(dependent, independent);
    for (; hit && hit->before; hit = hit->before)
        light *= target_factor_white(hit->before_d, hit->before_i);
    return light;
}

/* Add kept light to that which there is at the same hit. */
static void add_lamp_light(SplitSink *s, SplitPath *p, int kept, const TargetNode *hit, Float4 d, Float4 i,
                           Float4 light)
{
    LampLight *same = p->tree.lamp_light;
    while (same && (same->kept != kept || same->hit != hit))
        same = (LampLight *)same->earlier;
    if (same) {
        same->dependent += d, same->independent += i, same->light += light;
        return;
    }
    LampLight *added = &s->lamp_light[s->nlamp_light++];
    *added = (LampLight){d, i, light, hit, p->tree.lamp_light, kept};
    p->tree.lamp_light = added;
}

/* Factors of a contribution that are hits, and what becomes of throughput by the others. */
typedef struct ContributionHits {
    const Factor *of[TARGET_NODES_MAX];
    int count, folded;
    TargetNode *last;
    Float4 d, i; /* the factor of the last hit */
} ContributionHits;

static void add_hits(SplitSink *s, SplitPath *p, ContributionHits *hits)
{
    const FinishFactor *finishes = last_finishes(p);
    hits->last = p->last, hits->d = p->last_d, hits->i = p->last_i;
    for (int k = 0; k < hits->count; k++) {
        const Factor *f = hits->of[k];
        hits->last = k == 0 ? find_current_hit(s, p, f) : add_hit(s, p, f, hits->last, hits->d, hits->i, finishes);
        hits->d = f->d, hits->i = f->i, finishes = f->finishes;
    }
}

static void add_folded(const SplitSink *s, const ContributionHits *hits, Float4 light, Float4 d, Float4 i)
{
    if (hits->folded)
        film_add_folded(s->pixel, rgb_of4(light), rgb_of4(hits->last ? with_white_targets(hits->last, d, i) : i));
}

/* As split_add, in each combination. */
static __attribute__((noinline)) int add_combined(SplitSink *s, SplitPath *p, const Contribution *c)
{
    const Scene *scene = s->scene;
    const SplitCombined *combined = p->combined;
    ContributionHits hits = {.count = 0, .folded = p->folded};
    Float4 rest[COMBINATIONS_MAX], light[COMBINATIONS_MAX], sum_d = splat(0), sum_i = splat(0), sum = splat(0);
    TargetCounts counts = p->counts;
    int met = combined->met, is_black = 1;
    for (int k = 0; k < scene->ncombinations; k++)
        rest[k] = combined->rest[k] * color4(c->light), light[k] = combined->beta[k] * color4(c->light);
    for (int f = 0; f < c->nfactors; f++) {
        const int is_hit = keep_as_hit(s, p, &counts, &hits.folded, &c->factors[f]);
        met |= c->factors[f].finishes != NULL;
        for (int k = 0; k < scene->ncombinations; k++) {
            const FinishFactor by = factor_of_combination(&c->factors[f], scene, k);
            const Float4 whole = by.d * c->factors[f].albedo + by.i;
            light[k] *= whole, rest[k] *= is_hit ? splat(1) : whole;
        }
        if (is_hit)
            hits.of[hits.count++] = &c->factors[f];
    }
    for (int k = 0; k < scene->ncombinations; k++) {
        if (!rgb_is_finite(rgb_of4(light[k] + rest[k])))
            return 0;
        is_black &= is_black4(rest[k]);
    }
    if (is_black)
        return 1;
    add_hits(s, p, &hits);
    const Factor *own = hits.count ? hits.of[hits.count - 1] : NULL;
    const FinishFactor *last = own ? own->finishes : last_finishes(p);
    for (int k = 0; k < scene->ncombinations; k++) {
        const Float4 share = splat(1 / (float)scene->ncombinations);
        const FinishFactor by =
            hits.last && last ? last[scene->finish_of[k][hits.last->at.target]] : (FinishFactor){hits.d, hits.i};
        const Float4 scaled = rest[k] * share, d = hits.last ? by.d * scaled : splat(0),
                     i = hits.last ? by.i * scaled : scaled;
        sum_d += d, sum_i += i, sum += light[k] * share;
        if (met)
            add_lamp_light(s, p, scene_kept(scene, c->lamp, k), hits.last, d, i, light[k] * share);
    }
    if (!met)
        add_lamp_light(s, p, scene_kept(scene, c->lamp, -1), hits.last, sum_d, sum_i, sum);
    p->tree.met |= met;
    if (hits.last)
        target_node_add_light(hits.last, splat(1), splat(0), sum_d), hits.last->independent += sum_i;
    else
        p->tree.without_hit += sum_i, p->tree.nwithout_hit++;
    add_folded(s, &hits, sum, sum_d, sum_i);
    return 1;
}

int split_add(SplitSink *s, SplitPath *p, const Contribution *c, Float4 light)
{
    ContributionHits hits = {.count = 0, .folded = p->folded};
    Float4 rest = p->rest * color4(c->light);
    TargetCounts counts = p->counts;
    if (p->combined)
        return add_combined(s, p, c);
    for (int k = 0; k < c->nfactors; k++)
        if (keep_as_hit(s, p, &counts, &hits.folded, &c->factors[k]))
            hits.of[hits.count++] = &c->factors[k];
        else
            rest *= factor_whole(&c->factors[k]);
    if (!rgb_is_finite(rgb_of4(light + rest)))
        return 0;
    if (is_black4(rest))
        return 1;
    add_hits(s, p, &hits);
    const Float4 d = hits.last ? hits.d * rest : splat(0), i = hits.last ? hits.i * rest : rest;
    if (s->lamp_light)
        add_lamp_light(s, p, c->lamp, hits.last, d, i, light);
    if (hits.last)
        target_node_add_light(hits.last, hits.d, hits.i, rest);
    else
        p->tree.without_hit += rest, p->tree.nwithout_hit++;
    add_folded(s, &hits, light, d, i);
    return 1;
}
