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

static void add_rgb(float sum[3], Rgb c)
{
    sum[0] += c.r, sum[1] += c.g, sum[2] += c.b;
}

/* Another hit's albedo, as it weighs a hit's own: a black one must not make the hit's own unknown, for it may be the
 * black one that is edited. */
static Rgb weighing_albedo(const TargetHit *hit)
{
    Rgb a = hit->albedo;
    return rgb(a.r > LEAST_ALBEDO ? a.r : LEAST_ALBEDO, a.g > LEAST_ALBEDO ? a.g : LEAST_ALBEDO,
               a.b > LEAST_ALBEDO ? a.b : LEAST_ALBEDO);
}

static void flush_pending(FootprintPixel *p);
static void flush_later(FootprintPixel *p);

/* The path's entry for a hit, the order-th of the path; a hit met again, as the path goes on from where it connected,
 * is the same. */
static Pending *find_pending(FootprintPixel *p, const TargetHit *hit, int order)
{
    int last = p->pending_of[order];
    if (last) {
        Pending *q = &p->pending[last - 1];
        if (q->target == hit->target && q->position.u == hit->uv.u && q->position.v == hit->uv.v)
            return q;
    }
    if (p->npending == PENDING_MAX)
        flush_pending(p);
    Pending *q = &p->pending[p->npending++];
    p->pending_of[order] = (unsigned char)p->npending;
    q->target = hit->target, q->sharp = hit->sharp, q->position = hit->uv;
    q->albedo = hit->albedo, q->again = rgb_grey(0);
    q->used = 0;
    return q;
}

/* Likewise for a further hit. */
static PendingLater *find_later(FootprintPixel *p, const TargetHit *hit, int order)
{
    int last = p->later_of[order];
    if (last) {
        PendingLater *l = &p->later[last - 1];
        if (l->target == hit->target && l->uv[0] == hit->uv.u && l->uv[1] == hit->uv.v)
            return l;
    }
    if (p->nlater == PENDING_MAX)
        flush_later(p);
    PendingLater *l = &p->later[p->nlater++];
    p->later_of[order] = (unsigned char)p->nlater;
    *l = (PendingLater){hit->target, {hit->uv.u, hit->uv.v}, 0, rgb_grey(0), hit->albedo};
    return l;
}

static void flush_later(FootprintPixel *p)
{
    for (int k = 0; k < p->nlater; k++) {
        const PendingLater *l = &p->later[k];
        clusters_add_later(&p->targets[l->target], l, p->film->params.periodic[l->target]);
        uv_range_add(p->range, l->target, l->uv);
    }
    memset(p->later_of, 0, sizeof p->later_of);
    p->nlater = 0;
}

static void add_later(FootprintPixel *p, const TargetHit *hit, int order, double weight, Rgb light)
{
    if (!(weight > 0))
        return;
    PendingLater *l = find_later(p, hit, order);
    l->weight += weight;
    l->light = rgb_add(l->light, light);
}

/* The hits of a monomial beyond its first, as far as the plan keeps them: their numbers in the expansion, and with what
 * albedo they weigh other hits. */
typedef struct Kept {
    int count, coefficient, folded, met; /* met: all of them */
    int hits[RETEX_MAX_FACTORS];
    Rgb albedos[RETEX_MAX_FACTORS];
} Kept;

/* Which of the hits after the first, given as bits; the albedo of the others goes into value. */
static void keep_hits(const Plan *plan, const Expansion *e, unsigned further, Rgb *value, Kept *kept)
{
    kept->count = kept->coefficient = kept->folded = kept->met = 0;
    for (; further; further &= further - 1) {
        int j = __builtin_ctz(further);
        int next = plan->coefficients[kept->coefficient].next[e->hits[j].target];
        kept->met++;
        if (next >= 0) {
            kept->coefficient = next;
            kept->albedos[kept->count] = weighing_albedo(&e->hits[j]);
            kept->hits[kept->count++] = j;
        } else {
            *value = rgb_mul(*value, e->hits[j].albedo);
            kept->folded = 1;
        }
    }
}

static void add_white_light(LightSums *sums, float white, int folded)
{
    sums->total_white += white;
    if (folded)
        sums->folded_white += white;
}

static void add_coefficient(Pending *q, int coefficient, Rgb value)
{
    float *c = q->c[coefficient];
    if (q->used >> coefficient & 1)
        add_rgb(c, value);
    else
        c[0] = value.r, c[1] = value.g, c[2] = value.b;
    q->used |= 1u << coefficient;
}

/* The further hits that are kept, each with the light that the others leave it: all_met is what all hits leave. */
static void add_further(FootprintPixel *p, const Expansion *e, const Kept *kept, double weight, Rgb all_met)
{
    for (int k = 0; k < kept->count; k++) {
        Rgb own = kept->albedos[k];
        add_later(p, &e->hits[kept->hits[k]], kept->hits[k], weight,
                  rgb(all_met.r / own.r, all_met.g / own.g, all_met.b / own.b));
    }
}

/* Light that met more hits than the first, given as bits. */
static void add_with_further(FootprintPixel *p, const Expansion *e, int first, unsigned further, Rgb value, int folded)
{
    Kept kept;
    const TargetHit *hit = &e->hits[first];
    float luminance = rgb_luminance(value);
    keep_hits(&p->film->plan, e, further, &value, &kept);
    add_white_light(p->light, white_left[kept.met + 1] * luminance, folded || kept.folded);
    if (rgb_is_black(value))
        return;
    Rgb light = value;
    for (int k = 0; k < kept.count; k++)
        light = rgb_mul(light, kept.albedos[k]);
    Pending *q = find_pending(p, hit, first);
    add_coefficient(q, kept.coefficient, value);
    if (kept.count) {
        double weight = p->film->plan.coefficients[kept.coefficient].weight * rgb_luminance(value);
        q->again = rgb_add(q->again, light);
        add_further(p, e, &kept, weight, rgb_mul(light, weighing_albedo(hit)));
    }
    if (kept.folded && !folded) /* else all of it counts as folded already */
        p->light->folded += rgb_luminance(rgb_mul(light, hit->albedo));
}

void footprints_connect(FootprintPixel *p, const Expansion *e, Rgb outside, int folded)
{
    for (int k = 0; k < e->size.nmonomials; k++) {
        unsigned hits = e->monomials[k].hits;
        Rgb value = rgb_mul(outside, e->monomials[k].coefficient);
        if (rgb_is_black(value))
            continue;
        if (hits) {
            int first = __builtin_ctz(hits);
            unsigned further = hits & (hits - 1);
            if (further) {
                add_with_further(p, e, first, further, value, folded);
                continue;
            }
            add_coefficient(find_pending(p, &e->hits[first], first), 0, value);
            add_white_light(p->light, white_left[1] * rgb_luminance(value), folded);
        } else {
            p->free[0] += value.r, p->free[1] += value.g, p->free[2] += value.b;
            add_white_light(p->light, rgb_luminance(value), folded);
        }
    }
}

/* ---- a path ends ---- */

/* Luminance of all light by a hit, each further one as an albedo of 1/2. */
static double pending_weight(const Pending *q, const Plan *plan)
{
    double weight = 0;
    for (unsigned left = q->used; left; left &= left - 1) {
        int i = __builtin_ctz(left);
        weight += plan->coefficients[i].weight * rgb_luminance(rgb(q->c[i][0], q->c[i][1], q->c[i][2]));
    }
    return weight;
}

static void flush_pending(FootprintPixel *p)
{
    for (int k = 0; k < p->npending; k++) {
        Pending *q = &p->pending[k];
        const double uv[2] = {q->position.u, q->position.v};
        q->weight = pending_weight(q, &p->film->plan);
        if (!(q->weight > 0))
            continue;
        uv_range_add(p->range, q->target, uv);
        clusters_add(&p->targets[q->target], q, &p->film->params);
    }
    memset(p->pending_of, 0, sizeof p->pending_of);
    p->npending = 0;
}

void footprints_path_end(FootprintPixel *p)
{
    if (p->npending)
        flush_pending(p);
    if (p->nlater)
        flush_later(p);
}

static void signal_total(double total[3], const Clusters *clusters, const Plan *plan)
{
    total[0] = total[1] = total[2] = 0;
    for (int k = 0; k < clusters->count; k++)
        for (int c = 0; c < 3; c++)
            total[c] += clusters->of[k].c[c];
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
