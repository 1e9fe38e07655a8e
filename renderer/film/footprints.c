/* Light of one pixel, into clusters; see footprints.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "film/footprint_pixel.h"

/* What an unknown texture is taken for where its hit only weighs another's. */
#define UNKNOWN_ALBEDO 0.5f
#define LEAST_ALBEDO 1e-3f /* of other hits, where originals are averaged: a black one may be the one that is edited */
#define AGAIN_WEIGHT 1e-3f /* in a cluster's albedo, of light that goes on to targets */
/* White paint. */
#define WHITE_ALBEDO 0.8f

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

/* Luminance of a monomial were all its targets white paint. */
static float white_luminance(unsigned hits, Rgb value)
{
    float luminance = rgb_luminance(value);
    for (; hits; hits &= hits - 1)
        luminance *= WHITE_ALBEDO;
    return luminance;
}

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

static void add_albedo(AlbedoSums *a, Rgb light, Rgb albedo)
{
    add_rgb(a->light, light);
    add_rgb(a->reflected, rgb_mul(light, albedo));
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
    q->weight = q->again = 0;
    q->used = 0;
    q->albedo = (AlbedoSums){0};
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
    *l = (PendingLater){hit->target, {hit->uv.u, hit->uv.v}, 0, {{0}, {0}}};
    return l;
}

static void merge_albedo(AlbedoSums *into, const AlbedoSums *from)
{
    for (int c = 0; c < 3; c++)
        into->light[c] += from->light[c], into->reflected[c] += from->reflected[c];
}

static void merge_later(Later *into, const Later *from, const int periodic[2])
{
    uv_stats_merge(&into->uv, &from->uv, periodic);
    into->squares += from->squares;
    merge_albedo(&into->albedo, &from->albedo);
}

/* One more among two: it, or the pair it meets, goes together where that loses least. */
static void pool_later(Later later[LATER_COUNT], const Later *one, const int periodic[2])
{
    double gain[LATER_COUNT];
    for (int k = 0; k < LATER_COUNT; k++) {
        if (later[k].uv.weight == 0) {
            later[k] = *one;
            return;
        }
        gain[k] = uv_stats_variation_gain(&later[k].uv, &one->uv, periodic);
        if (gain[k] <= 0) {
            merge_later(&later[k], one, periodic);
            return;
        }
    }
    double both = uv_stats_variation_gain(&later[0].uv, &later[1].uv, periodic);
    if (both < gain[0] && both < gain[1]) {
        merge_later(&later[0], &later[1], periodic);
        later[1] = *one;
    } else {
        merge_later(&later[gain[1] < gain[0]], one, periodic);
    }
}

static void flush_later(FootprintPixel *p)
{
    for (int k = 0; k < p->nlater; k++) {
        const PendingLater *l = &p->later[k];
        Later one = {.uv = {l->weight, {l->uv[0], l->uv[1]}, {0, 0, 0}}, .squares = l->weight * l->weight};
        one.albedo = l->albedo;
        pool_later(p->targets[l->target].later, &one, p->film->params.periodic[l->target]);
        uv_range_add(p->range, l->target, l->uv);
    }
    if (p->nlater)
        memset(p->later_of, 0, sizeof p->later_of);
    p->nlater = 0;
}

static void add_later(FootprintPixel *p, const TargetHit *hit, int order, double weight, Rgb light)
{
    if (!(weight > 0))
        return;
    PendingLater *l = find_later(p, hit, order);
    l->weight += weight;
    add_albedo(&l->albedo, light, hit->albedo);
}

/* The hits of a monomial beyond its first, as far as the plan keeps them: their numbers in the expansion. */
typedef struct Kept {
    int count, coefficient, folded;
    int hits[RETEX_MAX_FACTORS];
} Kept;

/* Which of the hits after the first, given as bits; the albedo of the others goes into value. */
static void keep_hits(const Plan *plan, const Expansion *e, unsigned further, Rgb *value, Kept *kept)
{
    kept->count = kept->coefficient = kept->folded = 0;
    for (; further; further &= further - 1) {
        int j = __builtin_ctz(further);
        int next = plan->coefficients[kept->coefficient].next[e->hits[j].target];
        if (next >= 0) {
            kept->coefficient = next;
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

/* The further hits that are kept, each with the light that the others leave it. */
static void add_further(FootprintPixel *p, const Expansion *e, const TargetHit *first, const Kept *kept, double weight,
                        Rgb value)
{
    for (int k = 0; k < kept->count; k++) {
        Rgb others = rgb_mul(value, weighing_albedo(first));
        for (int i = 0; i < kept->count; i++)
            if (i != k)
                others = rgb_mul(others, weighing_albedo(&e->hits[kept->hits[i]]));
        add_later(p, &e->hits[kept->hits[k]], kept->hits[k], weight, others);
    }
}

/* Light that met these hits, of which there is one at least. */
static void add_monomial(FootprintPixel *p, const Expansion *e, unsigned hits, Rgb value, int folded)
{
    Kept kept;
    int first = __builtin_ctz(hits);
    const TargetHit *hit = &e->hits[first];
    float white = white_luminance(hits, value);
    keep_hits(&p->film->plan, e, hits & (hits - 1), &value, &kept);
    add_white_light(p->light, white, folded || kept.folded);
    if (rgb_is_black(value))
        return;
    double weight = rgb_luminance(value);
    Rgb light = value;
    for (int k = 0; k < kept.count; k++) {
        weight *= UNKNOWN_ALBEDO;
        light = rgb_mul(light, weighing_albedo(&e->hits[kept.hits[k]]));
    }
    Pending *q = find_pending(p, hit, first);
    q->weight += weight;
    add_coefficient(q, kept.coefficient, value);
    if (kept.coefficient)
        q->again += rgb_luminance(light);
    /* a cluster's own light is what its albedo is for; light that goes on to targets tells where there is no other */
    add_albedo(&q->albedo, kept.coefficient ? rgb_scale(light, AGAIN_WEIGHT) : light, hit->albedo);
    if (kept.count)
        add_further(p, e, hit, &kept, weight, value);
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
            add_monomial(p, e, hits, value, folded);
        } else {
            p->free[0] += value.r, p->free[1] += value.g, p->free[2] += value.b;
            add_white_light(p->light, rgb_luminance(value), folded);
        }
    }
}

/* ---- clusters ---- */

static void merge_cluster(Cluster *into, const Cluster *from, const int periodic[2])
{
    uv_stats_merge(&into->uv, &from->uv, periodic);
    merge_albedo(&into->albedo, &from->albedo);
    into->squares += from->squares;
    for (int c = 0; c < 3; c++)
        into->c[c] += from->c[c];
    into->again += from->again;
}

static void add_pending(Cluster *into, const Pending *q, const int periodic[2])
{
    const double uv[2] = {q->position.u, q->position.v};
    uv_stats_add(&into->uv, q->weight, uv, periodic);
    merge_albedo(&into->albedo, &q->albedo);
    into->squares += q->weight * q->weight;
    for (int c = 0; c < 3 && q->used & 1; c++)
        into->c[c] += q->c[0][c];
    into->again += q->again;
}

static void start_cluster(Cluster *cluster, const Pending *q, const int periodic[2])
{
    *cluster = (Cluster){.squares = 0};
    add_pending(cluster, q, periodic);
}

/* Two clusters of one kind, or one and what is to be added (b = -1). */
typedef struct Pair {
    Clusters *clusters;
    int a, b;
    double cost;
} Pair;

static double merge_cost(const UvStats *a, const UvStats *b, int sharp, const int periodic[2])
{
    return sharp ? uv_stats_ward(a, b, periodic) / (UV_FEATURE * UV_FEATURE) : uv_stats_variation_gain(a, b, periodic);
}

/* Look for a cheaper pair than the best so far: among the clusters, and of each with the new one (NULL: without). */
static void find_cheapest(Pair *best, Clusters *clusters, int sharp, const UvStats *one, const int periodic[2])
{
    for (int i = 0; i < clusters->count; i++) {
        double cost = one ? merge_cost(&clusters->of[i].uv, one, sharp, periodic) : INFINITY;
        if (cost < best->cost)
            *best = (Pair){clusters, i, -1, cost};
        for (int k = i + 1; k < clusters->count; k++) {
            cost = merge_cost(&clusters->of[i].uv, &clusters->of[k].uv, sharp, periodic);
            if (cost < best->cost)
                *best = (Pair){clusters, i, k, cost};
        }
    }
}

/* One more, where there are as many clusters as there may be: merge the cheapest pair of either kind, or of its
 * own where that has all that it may have. */
static void squeeze(Clusters *own, Clusters *other, int own_is_full, const Pending *q, const int periodic[2])
{
    const UvStats one = {q->weight, {q->position.u, q->position.v}, {0, 0, 0}};
    Pair best = {.cost = INFINITY};
    find_cheapest(&best, own, q->sharp, &one, periodic);
    if (!own_is_full)
        find_cheapest(&best, other, !q->sharp, NULL, periodic);
    if (best.b < 0) {
        add_pending(&own->of[best.a], q, periodic);
        return;
    }
    Clusters *merged = best.clusters;
    merge_cluster(&merged->of[best.a], &merged->of[best.b], periodic);
    if (merged == own) {
        start_cluster(&own->of[best.b], q, periodic);
        return;
    }
    if (best.b != --merged->count)
        merged->of[best.b] = merged->of[merged->count];
    start_cluster(&own->of[own->count++], q, periodic);
}

static void flush_pending(FootprintPixel *p)
{
    const FilmParams *params = &p->film->params;
    for (int k = 0; k < p->npending; k++) {
        Pending *q = &p->pending[k];
        TargetClusters *t = &p->targets[q->target];
        Clusters *own = q->sharp ? &t->sharp : &t->broad, *other = q->sharp ? &t->broad : &t->sharp;
        int room = q->sharp ? params->sharp : params->broad;
        const int *periodic = params->periodic[q->target];
        const double uv[2] = {q->position.u, q->position.v};
        if (!(q->weight > 0))
            continue;
        uv_range_add(p->range, q->target, uv);
        own->used |= q->used & ~1u;
        for (int i = 1; q->used >> i; i++)
            for (int c = 0; c < 3 && q->used >> i & 1; c++)
                own->again[i][c] += q->c[i][c];
        if (own->count < room && own->count + other->count < params->clusters)
            start_cluster(&own->of[own->count++], q, periodic);
        else
            squeeze(own, other, own->count == room, q, periodic);
    }
    if (p->npending)
        memset(p->pending_of, 0, sizeof p->pending_of);
    p->npending = 0;
}

void footprints_path_end(FootprintPixel *p)
{
    flush_pending(p);
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
