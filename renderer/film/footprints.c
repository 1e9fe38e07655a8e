/* Light of one pixel, into clusters; see footprints.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "film/footprint_pixel.h"

#define LEAST_ALBEDO 1e-3f /* of other hits, where originals are averaged: a black one may be the one that is edited */
/* What so many hits of white paint, of albedo 0.8, leave of light. */
static const float white_left[RETEX_MAX_FACTORS + 1] = {
    1,          0.8f,        0.64f,        0.512f,       0.4096f,       0.32768f,     0.262144f,
    0.2097152f, 0.16777216f, 0.134217728f, 0.107374182f, 0.0858993459f, 0.0687194767f};

/* ---- life ---- */

int footprints_pixel_create(FootprintPixel **out, FootprintFilm *film, LightSums *light, UvRange *range,
                            RetexError *err)
{
    FootprintPixel *p = *out = calloc(1, sizeof *p);
    if (p) {
        p->film = film;
        p->targets = calloc((size_t)film->scene->ntargets + 1, sizeof *p->targets);
        p->light = light, p->range = range;
    }
    if (p && p->targets)
        return RETEX_OK;
    footprints_pixel_close(out);
    return retex_fail(err, RETEX_ENOMEM, "out of memory for a thread's pixel");
}

void footprints_pixel_close(FootprintPixel **pixel)
{
    if (!*pixel)
        return;
    free((*pixel)->targets);
    free(*pixel);
    *pixel = NULL;
}

/* ---- light ---- */

/* Another hit's albedo, as it weighs a hit's own: a black one must not make the hit's own unknown, for it may be the
 * black one that is edited. */
static Float4 weighing_albedo(Rgb a)
{
    return (Float4){a.r > LEAST_ALBEDO ? a.r : LEAST_ALBEDO, a.g > LEAST_ALBEDO ? a.g : LEAST_ALBEDO,
                    a.b > LEAST_ALBEDO ? a.b : LEAST_ALBEDO, 1};
}

static void flush_hits(FootprintPixel *p);

static int is_at(const Pending *q, const TargetHit *hit)
{
    return q->target == hit->target && q->position.u == hit->uv.u && q->position.v == hit->uv.v;
}

static PathHit *start_hit(FootprintPixel *p, const TargetHit *hit)
{
    PathHit *h = &p->hits[p->nhits++];
    h->weighing = weighing_albedo(hit->albedo);
    h->weighted = h->later_weighted = h->met = splat(0);
    h->first.target = hit->target, h->first.sharp = hit->sharp, h->first.position = hit->uv;
    h->first.albedo = colour4(hit->albedo), h->first.again = splat(0);
    h->first.used = 0;
    return h;
}

/* The path's hits up to where light arrives; one that was met before, as the path goes on from where it connected, is
 * the same. */
static void find_hits(FootprintPixel *p, const Expansion *e)
{
    if (p->nhits + e->size.nhits > PATH_HITS_MAX)
        flush_hits(p);
    for (int j = 0; j < e->size.nhits; j++)
        if (!p->last[j] || !is_at(&p->last[j]->first, &e->hits[j]))
            p->last[j] = start_hit(p, &e->hits[j]);
}

/* The hits of a monomial beyond its first, as far as the plan keeps them. */
typedef struct Kept {
    unsigned hits; /* bits */
    int coefficient, folded;
    Float4 albedo; /* of all that are kept, as it weighs other hits */
} Kept;

/* Which of the hits after the first, given as bits; the albedo of the others goes into value. */
static inline void keep_hits(const FootprintPixel *p, const Expansion *e, unsigned further, Float4 *value, Kept *kept)
{
    const Plan *plan = &p->film->plan;
    *kept = (Kept){.albedo = splat(1)};
    for (; further; further &= further - 1) {
        int j = __builtin_ctz(further);
        int next = plan->coefficients[kept->coefficient].next[e->hits[j].target];
        if (next >= 0) {
            kept->coefficient = next;
            kept->albedo *= p->last[j]->weighing;
            kept->hits |= 1u << j;
        } else {
            *value *= p->last[j]->first.albedo;
            kept->folded = 1;
        }
    }
}

static inline void add_coefficient(Pending *q, int coefficient, Float4 value)
{
    q->c[coefficient] = q->used >> coefficient & 1 ? q->c[coefficient] + value : value;
    q->used |= 1u << coefficient;
}

/* Of the light that a connection brings. */
typedef struct Arrived {
    Float4 white, white_folded; /* as it would be with white targets; of it, what has folded hits */
    Float4 folded;              /* as it is, of that */
} Arrived;

/* Light that met more hits than the first, given as bits. */
static inline void add_with_further(FootprintPixel *p, const Expansion *e, PathHit *first, unsigned further,
                                    Float4 value, Arrived *sums)
{
    Kept kept;
    Float4 white = value * splat(white_left[1 + __builtin_popcount(further)]);
    keep_hits(p, e, further, &value, &kept);
    Float4 light = value * kept.albedo;
    Float4 weighted = value * splat((float)p->film->plan.coefficients[kept.coefficient].weight);
    add_coefficient(&first->first, kept.coefficient, value);
    first->weighted += weighted;
    if (kept.hits)
        first->first.again += light;
    for (unsigned left = kept.hits; left; left &= left - 1) {
        PathHit *later = p->last[__builtin_ctz(left)];
        later->later_weighted += weighted;
        later->met += light * first->weighing;
    }
    sums->white += white;
    if (kept.folded) {
        sums->white_folded += white;
        sums->folded += light * first->first.albedo;
    }
}

void footprints_connect(FootprintPixel *p, const Expansion *e, Rgb outside, int folded)
{
    Float4 light = colour4(outside);
    Arrived sums = {splat(0), splat(0), splat(0)};
    find_hits(p, e);
    for (int k = 0; k < e->size.nmonomials; k++) {
        unsigned hits = e->monomials[k].hits, further = hits & (hits - 1);
        Float4 value = light * e->monomials[k].coefficient;
        if (further) {
            add_with_further(p, e, p->last[__builtin_ctz(hits)], further, value, &sums);
        } else if (hits) {
            PathHit *first = p->last[__builtin_ctz(hits)];
            add_coefficient(&first->first, 0, value);
            first->weighted += value;
            sums.white += value * splat(white_left[1]);
        } else {
            p->free[0] += value[0], p->free[1] += value[1], p->free[2] += value[2];
            sums.white += value;
        }
    }
    p->light->total_white += luminance4(sums.white);
    p->light->folded_white += luminance4(folded ? sums.white : sums.white_folded);
    if (!folded) /* else all of it counts as folded already */
        p->light->folded += luminance4(sums.folded);
}

/* ---- a path ends ---- */

static void flush_later(FootprintPixel *p, const PathHit *hit, double weight)
{
    const Pending *q = &hit->first;
    const PendingLater later = {.target = q->target,
                                .uv = {q->position.u, q->position.v},
                                .weight = weight,
                                .light = hit->met / hit->weighing,
                                .albedo = q->albedo};
    clusters_add_later(&p->targets[q->target], &later, p->film->params.periodic[q->target]);
}

static void flush_hits(FootprintPixel *p)
{
    for (int k = 0; k < p->nhits; k++) {
        PathHit *hit = &p->hits[k];
        Pending *q = &hit->first;
        const double uv[2] = {q->position.u, q->position.v}, later = luminance4(hit->later_weighted);
        q->weight = luminance4(hit->weighted);
        if (q->weight > 0 || later > 0)
            uv_range_add(p->range, q->target, uv);
        if (q->weight > 0)
            clusters_add(&p->targets[q->target], q, &p->film->params);
        if (later > 0)
            flush_later(p, hit, later);
    }
    memset(p->last, 0, sizeof p->last);
    p->nhits = 0;
}

void footprints_path_end(FootprintPixel *p)
{
    if (p->nhits)
        flush_hits(p);
}

static void signal_total(double total[3], const Clusters *clusters, const Plan *plan)
{
    total[0] = total[1] = total[2] = 0;
    for (int k = 0; k < clusters->count; k++)
        for (int c = 0; c < 3; c++)
            total[c] += (double)clusters->of[k].c[c];
    for (int i = 1; clusters->used >> i; i++)
        for (int c = 0; c < 3 && clusters->used >> i & 1; c++)
            total[c] += plan->coefficients[i].weight * clusters->again[i][c];
}

void footprints_totals(const FootprintPixel *p, SignalTotals *totals)
{
    memcpy(totals->of[0], p->free, sizeof p->free);
    for (int t = 0; t < p->film->scene->ntargets; t++) {
        signal_total(totals->of[1 + 2 * t], &p->targets[t].sharp, &p->film->plan);
        signal_total(totals->of[2 + 2 * t], &p->targets[t].broad, &p->film->plan);
    }
}
