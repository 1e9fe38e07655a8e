/* See split.h. */
#include <stdlib.h>
#include <string.h>
#include <retex/host/assert.h>
#include "film/split.h"

int split_open(SplitSink *s, const FilmPixel *pixel, size_t paths, const Scene *scene, RetexError *err)
{
    const size_t nodes = paths * TARGET_NODES_MAX, lights = paths * (TARGET_NODES_MAX + 1) * (size_t)scene->nkept;
    const int has_finishes = scene->ncombinations > 0;
    s->scene = scene, s->count = s->nlamp_light = 0;
    s->ncombinations = has_finishes ? scene->ncombinations : 1;
    film_hit_limits(pixel, &s->orders, &s->most_hits);
    s->nodes = aligned_alloc(sizeof *s->nodes, nodes * sizeof *s->nodes);
    s->throughput = aligned_alloc(sizeof(Float4), paths * (size_t)s->ncombinations * sizeof *s->throughput);
    s->lamp_light = lights ? aligned_alloc(sizeof(Float4), lights * sizeof *s->lamp_light) : NULL;
    s->finishes = has_finishes ? aligned_alloc(sizeof(Float4), nodes * sizeof *s->finishes) : NULL;
    s->last_finishes = has_finishes ? aligned_alloc(sizeof(Float4), paths * sizeof *s->last_finishes) : NULL;
    return s->nodes && s->throughput && (s->lamp_light || !lights) &&
                   ((s->finishes && s->last_finishes) || !has_finishes)
               ? RETEX_OK
               : retex_fail(err, RETEX_ENOMEM, "out of memory for paths");
}

void split_close(SplitSink *s)
{
    free(s->nodes);
    free(s->throughput);
    free(s->lamp_light);
    free(s->finishes);
    free(s->last_finishes);
    s->nodes = NULL, s->throughput = NULL, s->lamp_light = NULL, s->finishes = s->last_finishes = NULL;
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

/* The factor by finish, or NULL: it is the same in all combinations. */
static inline const FinishFactor *by_finish(int ncombinations, const Factor *f)
{
    return ncombinations > 1 ? f->finishes : NULL;
}

/* Whether a hit keeps the factor apart: then it is counted. Else it is to be multiplied in as a whole, with the
 * original albedo; *folded: with a texture that changes it. counts: of the path's hits and those added since.
 *
 * A reflection is a hit even where the texture does not change it, so that what is seen reflected in a polished floor
 * stays apart from the floor's own texture. Light that only passes through a target unchanged makes no hit. */
static inline int keep_as_hit(const SplitSink *s, const SplitPath *p, TargetCounts *counts, int *folded,
                              const Factor *f, FactorParts parts)
{
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
        memcpy(s->finishes[s->count], finishes, sizeof *s->finishes);
        hit->before_finishes = s->finishes[s->count];
    }
    s->count++;
    RETEX_ASSERT(p->tree.count <= TARGET_NODES_MAX);       /* as much memory as there is for a path */
    RETEX_ASSERT(!hit->before_finishes || s->scene->ncombinations > 1);
    return hit;
}

/* The hit of the current vertex: direct light and the continued path share it. */
static inline TargetNode *find_current_hit(SplitSink *s, SplitPath *p, const Factor *f)
{
    const TargetNode *hit = p->current_hit;
    if (!hit || hit->at.target != f->target || hit->at.uv.u != f->uv.u || hit->at.uv.v != f->uv.v ||
        hit->at.sharp != f->sharp)
        p->current_hit = add_hit(s, p, f, p->last, p->last_d, p->last_i, p->last_finishes);
    return p->current_hit;
}

/* Where one of d and i is black in all finishes, the other is multiplied into `rest` and 1 stays in its place: so
 * `rest` is black wherever no texture can make the contribution other than black. */
static inline __attribute__((always_inline)) void multiply(SplitSink *s, SplitPath *p, int ncombinations,
                                                           const Factor *f)
{
    const FactorParts parts = factor_parts(s, f);
    const int is_hit = keep_as_hit(s, p, &p->counts, &p->folded, f, parts);
    p->met |= by_finish(ncombinations, f) != NULL;
    for (int c = 0; c < ncombinations; c++) {
        const FinishFactor by = factor_of_combination(f, s->scene, c);
        const Float4 whole = by.d * f->albedo + by.i;
        p->throughput[c].all *= whole;
        if (!is_hit || !parts.d || !parts.i)
            p->throughput[c].rest *= !is_hit ? whole : !parts.i ? by.d : by.i;
    }
    if (is_hit) {
        const int differs = by_finish(ncombinations, f) && parts.d && parts.i;
        p->last = find_current_hit(s, p, f);
        p->last_finishes = differs ? p->own_finishes : NULL;
        if (differs)
            memcpy(p->own_finishes, f->finishes, (size_t)s->scene->targets[f->target].nfinishes * sizeof *f->finishes);
        p->last_d = !parts.i ? splat(1) : f->d;
        p->last_i = !parts.d ? splat(1) : f->i;
    }
    p->current_hit = NULL;
}

/* Most scenes have no finishes to choose from: code of their own has no loops over combinations. */
void split_multiply(SplitSink *s, SplitPath *p, const Factor *f)
{
    if (s->ncombinations == 1)
        multiply(s, p, 1, f);
    else
        multiply(s, p, s->ncombinations, f);
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
    RETEX_ASSERT(kept >= 0 && kept < s->scene->nkept); /* of kept light, not of lamps */
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

/* Factors of a contribution that are hits. */
typedef struct ContributionHits {
    const Factor *of[TARGET_NODES_MAX];
    int count, folded, met;
    TargetNode *last;
    FinishFactor by;                     /* the factor of the last hit; where there is none, light is independent */
    const FinishFactor *by_finish; /* or NULL: the same in all */
} ContributionHits;

/* Sort a contribution's factors; light: its throughput, to which they are added. */
static inline void find_hits(const SplitSink *s, const SplitPath *p, int ncombinations, const Contribution *c,
                             ContributionHits *hits, SplitThroughput *light)
{
    TargetCounts counts = p->counts;
    hits->count = 0, hits->folded = p->folded, hits->met = p->met;
    for (int k = 0; k < ncombinations; k++)
        light[k] = (SplitThroughput){p->throughput[k].rest * color4(c->light), p->throughput[k].all * color4(c->light)};
    for (int n = 0; n < c->nfactors; n++) {
        const Factor *f = &c->factors[n];
        const int is_hit = keep_as_hit(s, p, &counts, &hits->folded, f, factor_parts(s, f));
        hits->met |= by_finish(ncombinations, f) != NULL;
        for (int k = 0; k < ncombinations; k++) {
            const FinishFactor by = factor_of_combination(f, s->scene, k);
            const Float4 whole = by.d * f->albedo + by.i;
            light[k].all *= whole;
            if (!is_hit)
                light[k].rest *= whole;
        }
        if (is_hit)
            hits->of[hits->count++] = f;
    }
}

static inline void add_hits(SplitSink *s, SplitPath *p, int ncombinations, ContributionHits *hits)
{
    RETEX_ASSERT(p->last || !p->last_finishes); /* factors by finish are of that hit */
    hits->last = p->last, hits->by_finish = p->last_finishes;
    hits->by = p->last ? (FinishFactor){p->last_d, p->last_i} : (FinishFactor){splat(0), splat(1)};
    for (int k = 0; k < hits->count; k++) {
        const Factor *f = hits->of[k];
        hits->last = k == 0 ? find_current_hit(s, p, f)
                            : add_hit(s, p, f, hits->last, hits->by.d, hits->by.i, hits->by_finish);
        hits->by = (FinishFactor){f->d, f->i}, hits->by_finish = by_finish(ncombinations, f);
    }
}

static void add_folded(TargetTree *tree, const TargetNode *last, Float4 light, Float4 d, Float4 i)
{
    tree->folded += luminance4(light);
    tree->folded_white += luminance4(last ? with_white_targets(last, d, i) : i);
}

static inline __attribute__((always_inline)) int add(SplitSink *s, SplitPath *p, int ncombinations,
                                                     const Contribution *c)
{
    const Scene *scene = s->scene;
    const Float4 share = splat(1 / (float)ncombinations);
    SplitThroughput light[COMBINATIONS_MAX];
    ContributionHits hits;
    Float4 d = splat(0), i = splat(0), all = splat(0);
    int is_black = 1;
    find_hits(s, p, ncombinations, c, &hits, light);
    for (int k = 0; k < ncombinations; k++) {
        if (!rgb_is_finite(rgb_of4(light[k].all + light[k].rest)))
            return 0;
        is_black &= is_black4(light[k].rest);
    }
    if (is_black)
        return 1;
    add_hits(s, p, ncombinations, &hits);
    RETEX_ASSERT(hits.last || !hits.by_finish);
    RETEX_ASSERT(!hits.met || ncombinations > 1); /* which goes to kept light by combination */
    for (int k = 0; k < ncombinations; k++) {
        const FinishFactor by = hits.by_finish ? hits.by_finish[scene->finish_of[k][hits.last->at.target]] : hits.by;
        const Float4 scaled = light[k].rest * share, own_d = by.d * scaled, own_i = by.i * scaled;
        d += own_d, i += own_i, all += light[k].all * share;
        if (hits.met)
            add_lamp_light(s, p, scene_kept(scene, c->lamp, k), hits.last, own_d, own_i, light[k].all * share);
    }
    if (!hits.met && s->lamp_light)
        add_lamp_light(s, p, scene_kept(scene, c->lamp, -1), hits.last, d, i, all);
    p->tree.met |= hits.met;
    if (hits.last)
        target_node_add_light(hits.last, d, i);
    else
        p->tree.without_hit += i, p->tree.nwithout_hit++;
    if (hits.folded)
        add_folded(&p->tree, hits.last, all, d, i);
    return 1;
}

int split_add(SplitSink *s, SplitPath *p, const Contribution *c)
{
    return s->ncombinations == 1 ? add(s, p, 1, c) : add(s, p, s->ncombinations, c);
}
