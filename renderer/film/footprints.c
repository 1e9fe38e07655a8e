/* Light of one pixel: into clusters, and these into their images; see footprints.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <retex/uv_stats.h>
#include "film/footprint_images.h"

#define PENDING_MAX 64
#define PARTS_MAX 1490 /* of a set, with room for its beauty, originals, AOVs and what denoising needs */
/* What an unknown texture is taken for where its hit only weighs another's. */
#define UNKNOWN_ALBEDO 0.5f
#define LEAST_ALBEDO 1e-3f /* of other hits, where originals are averaged: a black one may be the one that is edited */
#define AGAIN_WEIGHT 1e-3f /* in a cluster's albedo, of light that goes on to targets */
#define SHARE_STEP (1.0 / 512)
#define LEAST_SHARE 1e-5f /* of further hits: a half holds it */
/* White paint. */
#define WHITE_ALBEDO 0.8f
/* Coefficients are rounded to this share of what the pixel would be were its targets white: steps no one sees, and
 * small coefficients of few bits, which compress. */
#define COEFFICIENT_STEP (1.0f / 8192)

typedef float Coefficients[PLAN_COEFFICIENTS_MAX][3];

/* Original albedo of a footprint, weighted by the light it multiplies. */
typedef struct AlbedoSums {
    float light[3], reflected[3];
} AlbedoSums;

typedef struct Cluster {
    UvStats uv;
    AlbedoSums albedo;
    double squares; /* of the paths' weights */
    float c[3];     /* light that meets the target here, and no other after it */
    float again;    /* luminance of that which does */
} Cluster;

/* One path's light by the hit that comes first. */
typedef struct Pending {
    int target, order; /* the how-manieth target hit of its path */
    int sharp;
    Vec2 position;
    double weight;
    AlbedoSums albedo;
    float again; /* as of clusters */
    Coefficients c;
} Pending;

/* Clusters of one kind, and the light of all of them that meets targets again: [0] stays empty. */
typedef struct Clusters {
    int count;
    Cluster of[FILM_CLUSTERS_MAX];
    Coefficients again;
} Clusters;

/* Further hits of a target. */
typedef struct Later {
    UvStats uv;     /* weight 0: none */
    double squares; /* of the weights of all connections */
    AlbedoSums albedo;
} Later;

/* The clusters of one pixel on one target. */
typedef struct TargetClusters {
    Clusters sharp, broad;
    Later later[LATER_COUNT];
} TargetClusters;

struct FootprintPixel {
    FootprintFilm *film;
    double free[3];
    TargetClusters *targets;
    Pending pending[PENDING_MAX];
    int npending;
    UvRange range; /* of the path in hand */
};

/* ---- life ---- */

static int alloc_footprint(const FilmParams *p, FootprintImages *f, RetexError *err)
{
    int code = retex_image_alloc(&f->uv, p->width, p->height, 3, err);
    if (!code)
        code = retex_image_alloc(&f->spread, p->width, p->height, 3, err);
    if (!code)
        code = retex_image_alloc(&f->albedo, p->width, p->height, 3, err);
    if (!code)
        code = retex_image_alloc(&f->light, p->width, p->height, 3, err);
    if (!code)
        code = retex_image_alloc(&f->share, p->width, p->height, 1, err);
    return code;
}

static void free_footprint(FootprintImages *f)
{
    retex_image_free(&f->uv);
    retex_image_free(&f->spread);
    retex_image_free(&f->albedo);
    retex_image_free(&f->light);
    retex_image_free(&f->share);
}

static int alloc_target(const FootprintFilm *film, TargetImages *target, RetexError *err)
{
    const FilmParams *p = &film->params;
    int code = RETEX_OK;
    for (int kind = 0; kind < 2; kind++) {
        for (int k = 0; k < most_of_kind(p, kind) && !code; k++)
            code = alloc_footprint(p, &target->kinds[kind].of[k], err);
        for (int i = 1; i < film->plan.count && !code; i++)
            code = retex_image_alloc(&target->kinds[kind].again[i], p->width, p->height, 3, err);
    }
    for (int k = 0; k < LATER_COUNT && film->plan.count > 1 && !code; k++)
        code = alloc_footprint(p, &target->later[k], err);
    return code;
}

static void free_target(TargetImages *target)
{
    for (int kind = 0; kind < 2; kind++) {
        for (int k = 0; k < FILM_CLUSTERS_MAX; k++)
            free_footprint(&target->kinds[kind].of[k]);
        for (int i = 0; i < PLAN_COEFFICIENTS_MAX; i++)
            retex_image_free(&target->kinds[kind].again[i]);
    }
    for (int k = 0; k < LATER_COUNT; k++)
        free_footprint(&target->later[k]);
}

int footprints_create(FootprintFilm **out, const Scene *scene, const FilmParams *params, RetexError *err)
{
    FootprintFilm *film = *out = calloc(1, sizeof *film);
    if (film)
        film->targets = calloc((size_t)scene->ntargets + 1, sizeof *film->targets);
    if (!film || !film->targets)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    film->scene = scene;
    film->params = *params;
    plan_make(&film->plan, scene->ntargets, params->orders, expansion_most_hits(scene->ntargets, 0));
    int parts = scene->ntargets * (5 * (params->sharp + params->broad) + 2 * film->plan.count + 4 * LATER_COUNT);
    if (parts > PARTS_MAX)
        return retex_fail(err, RETEX_ELIMIT, "the set may need %d parts, more than %d: take fewer targets or clusters",
                          parts, PARTS_MAX);
    int code = retex_image_alloc(&film->free, params->width, params->height, 3, err);
    for (int t = 0; t < scene->ntargets && !code; t++)
        code = alloc_target(film, &film->targets[t], err);
    return code;
}

void footprints_close(FootprintFilm **out)
{
    FootprintFilm *film = *out;
    if (!film)
        return;
    retex_image_free(&film->free);
    for (int t = 0; film->targets && t < film->scene->ntargets; t++)
        free_target(&film->targets[t]);
    free(film->targets);
    free(film);
    *out = NULL;
}

int footprints_pixel_create(FootprintPixel **out, FootprintFilm *film, RetexError *err)
{
    FootprintPixel *p = *out = calloc(1, sizeof *p);
    if (p) {
        p->film = film;
        p->targets = calloc((size_t)film->scene->ntargets + 1, sizeof *p->targets);
        uv_range_reset(&p->range);
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
static float white_luminance(HitMask hits, Rgb value)
{
    float luminance = rgb_luminance(value);
    for (int n = __builtin_popcountll(hits); n > 0; n--)
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
    return rgb(fmaxf(hit->albedo.r, LEAST_ALBEDO), fmaxf(hit->albedo.g, LEAST_ALBEDO),
               fmaxf(hit->albedo.b, LEAST_ALBEDO));
}

static void add_albedo(AlbedoSums *a, Rgb light, Rgb albedo)
{
    add_rgb(a->light, light);
    add_rgb(a->reflected, rgb_mul(light, albedo));
}

static void flush_pending(FootprintPixel *p);

/* The path's entry for a hit; a hit met again, as the path goes on from where it connected, is the same. */
static Pending *find_pending(FootprintPixel *p, const TargetHit *hit, int order)
{
    for (int k = p->npending - 1; k >= 0; k--) {
        Pending *q = &p->pending[k];
        if (q->order == order && q->target == hit->target && q->position.u == hit->uv.u && q->position.v == hit->uv.v)
            return q;
    }
    if (p->npending == PENDING_MAX)
        flush_pending(p);
    Pending *q = &p->pending[p->npending++];
    q->target = hit->target, q->order = order, q->sharp = hit->sharp, q->position = hit->uv;
    q->weight = q->again = 0;
    q->albedo = (AlbedoSums){0};
    memset(q->c, 0, sizeof q->c[0] * (size_t)p->film->plan.count);
    return q;
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
    for (int k = 0; k < LATER_COUNT; k++) {
        if (later[k].uv.weight == 0) {
            later[k] = *one;
            return;
        }
        if (uv_stats_variation_gain(&later[k].uv, &one->uv, periodic) <= 0) {
            merge_later(&later[k], one, periodic);
            return;
        }
    }
    double first = uv_stats_variation_gain(&later[0].uv, &one->uv, periodic),
           second = uv_stats_variation_gain(&later[1].uv, &one->uv, periodic),
           both = uv_stats_variation_gain(&later[0].uv, &later[1].uv, periodic);
    if (both < first && both < second) {
        merge_later(&later[0], &later[1], periodic);
        later[1] = *one;
    } else {
        merge_later(&later[second < first], one, periodic);
    }
}

static void add_later(FootprintPixel *p, const TargetHit *hit, double weight, Rgb light)
{
    Later one = {.uv = {weight, {hit->uv.u, hit->uv.v}, {0, 0, 0}}, .squares = weight * weight};
    if (!(weight > 0))
        return;
    add_albedo(&one.albedo, light, hit->albedo);
    pool_later(p->targets[hit->target].later, &one, p->film->params.periodic[hit->target]);
    uv_range_add(&p->range, hit->target, one.uv.mean);
}

/* The hits of a monomial beyond its first, as far as the plan keeps them. */
typedef struct Kept {
    const TargetHit *hits[RETEX_MAX_FACTORS];
    int count, coefficient, folded;
} Kept;

/* Which of the hits after the first; the albedo of the others goes into value. */
static void keep_hits(const Plan *plan, const Expansion *e, HitMask hits, int first, Rgb *value, Kept *kept)
{
    *kept = (Kept){.count = 0};
    for (int j = first + 1; j < e->nhits; j++) {
        const TargetHit *hit = &e->hits[j];
        if (!(hits & hit_bit(hit->target, hit->index)))
            continue;
        int next = plan->coefficients[kept->coefficient].next[hit->target];
        if (next >= 0) {
            kept->coefficient = next;
            kept->hits[kept->count++] = hit;
        } else {
            *value = rgb_mul(*value, hit->albedo);
            kept->folded = 1;
        }
    }
}

static void add_monomial(FootprintPixel *p, const Expansion *e, HitMask hits, Rgb value, LightSums *sums)
{
    Kept kept;
    int first = 0;
    while (!(hits & hit_bit(e->hits[first].target, e->hits[first].index)))
        first++;
    const TargetHit *hit = &e->hits[first];
    float white = white_luminance(hits, value);
    sums->total_white += white;
    keep_hits(&p->film->plan, e, hits, first, &value, &kept);
    if (kept.folded)
        sums->folded_white += white;
    if (rgb_is_black(value))
        return;
    double weight = rgb_luminance(value);
    Rgb light = value;
    for (int k = 0; k < kept.count; k++) {
        weight *= UNKNOWN_ALBEDO;
        light = rgb_mul(light, weighing_albedo(kept.hits[k]));
    }
    Pending *q = find_pending(p, hit, first);
    q->weight += weight;
    add_rgb(q->c[kept.coefficient], value);
    if (kept.coefficient)
        q->again += rgb_luminance(light);
    /* a cluster's own light is what its albedo is for; light that goes on to targets tells where there is no other */
    add_albedo(&q->albedo, kept.coefficient ? rgb_scale(light, AGAIN_WEIGHT) : light, hit->albedo);
    for (int k = 0; k < kept.count; k++) {
        Rgb others = rgb_mul(value, weighing_albedo(hit));
        for (int i = 0; i < kept.count; i++)
            if (i != k)
                others = rgb_mul(others, weighing_albedo(kept.hits[i]));
        add_later(p, kept.hits[k], weight, others);
    }
    if (kept.folded)
        sums->folded += rgb_luminance(rgb_mul(light, hit->albedo));
}

void footprints_connect(FootprintPixel *p, const Expansion *e, Rgb outside, LightSums *sums)
{
    for (int k = 0; k < e->nmonomials; k++) {
        HitMask hits = e->monomials[k].hits;
        Rgb value = rgb_mul(outside, e->monomials[k].coefficient);
        if (rgb_is_black(value))
            continue;
        if (hits) {
            add_monomial(p, e, hits, value, sums);
        } else {
            p->free[0] += value.r, p->free[1] += value.g, p->free[2] += value.b;
            sums->total_white += rgb_luminance(value);
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
    for (int c = 0; c < 3; c++)
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
        uv_range_add(&p->range, q->target, uv);
        for (int i = 1; i < p->film->plan.count; i++)
            for (int c = 0; c < 3; c++)
                own->again[i][c] += q->c[i][c];
        if (own->count < room && own->count + other->count < params->clusters)
            start_cluster(&own->of[own->count++], q, periodic);
        else
            squeeze(own, other, own->count == room, q, periodic);
    }
    p->npending = 0;
}

void footprints_path_end(FootprintPixel *p, UvRange *range)
{
    flush_pending(p);
    uv_range_merge(range, &p->range);
    uv_range_reset(&p->range);
}

static void signal_total(double total[3], const Clusters *clusters, const Plan *plan)
{
    total[0] = total[1] = total[2] = 0;
    for (int k = 0; k < clusters->count; k++)
        for (int c = 0; c < 3; c++)
            total[c] += clusters->of[k].c[c];
    for (int i = 1; i < plan->count; i++) {
        double weight = ldexp(1, -plan_hits(&plan->coefficients[i]));
        for (int c = 0; c < 3; c++)
            total[c] += weight * clusters->again[i][c];
    }
}

void footprints_totals(const FootprintPixel *p, SignalTotals *totals)
{
    memcpy(totals->of[0], p->free, sizeof p->free);
    for (int t = 0; t < p->film->scene->ntargets; t++) {
        signal_total(totals->of[1 + 2 * t], &p->targets[t].sharp, &p->film->plan);
        signal_total(totals->of[2 + 2 * t], &p->targets[t].broad, &p->film->plan);
    }
}

/* ---- the finished pixel ---- */

static float *pixel_of(RetexImage *image, int x, int y)
{
    return image->pixels + retex_image_index(image, x, y);
}

static void store_footprint(FootprintImages *to, const UvStats *uv, const AlbedoSums *albedo, float coverage, int x,
                            int y)
{
    float *mean = pixel_of(&to->uv, x, y), *spread = pixel_of(&to->spread, x, y), *a = pixel_of(&to->albedo, x, y);
    uv_stats_store(uv, mean, spread);
    mean[2] = coverage;
    float light = albedo->light[0] + albedo->light[1] + albedo->light[2];
    float reflected = albedo->reflected[0] + albedo->reflected[1] + albedo->reflected[2];
    for (int c = 0; c < 3; c++) /* a channel without light: grey of the others */
        a[c] = albedo->light[c] > 0 ? albedo->reflected[c] / albedo->light[c] : light > 0 ? reflected / light : 0;
}

static int compare_clusters(const void *a, const void *b)
{
    const Cluster *x = a, *y = b;
    double p = x->uv.mean[0] + x->uv.mean[1], q = y->uv.mean[0] + y->uv.mean[1];
    return p < q ? -1 : p > q;
}

static void add_white(double sum[3], const Clusters *clusters, int coefficients)
{
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < clusters->count; k++)
            sum[c] += clusters->of[k].c[c];
        for (int i = 1; i < coefficients; i++)
            sum[c] += clusters->again[i][c];
    }
}

/* The largest channel of the pixel as it would be with white textures, in the set's units. */
static float white_pixel(const FootprintPixel *p)
{
    double sum[3] = {p->free[0], p->free[1], p->free[2]};
    for (int t = 0; t < p->film->scene->ntargets; t++) {
        add_white(sum, &p->targets[t].sharp, p->film->plan.count);
        add_white(sum, &p->targets[t].broad, p->film->plan.count);
    }
    return (float)(fmax(sum[0], fmax(sum[1], sum[2])) / p->film->params.spp);
}

/* So many paths of equal weight would know as much (Kish 1965): few bright ones count for few. */
static double effective_samples(const Cluster *cluster)
{
    return cluster->uv.weight * cluster->uv.weight / cluster->squares;
}

static void store_light(RetexImage *image, const float sum[3], float scale, double step, int x, int y)
{
    if (sum[0] == 0 && sum[1] == 0 && sum[2] == 0)
        return; /* memory that is never touched is never taken */
    float *to = pixel_of(image, x, y);
    for (int c = 0; c < 3; c++)
        to[c] = (float)retex_round_to(sum[c] * scale, step);
}

static void store_share(RetexImage *image, float share, int x, int y)
{
    *pixel_of(image, x, y) = fmaxf((float)retex_round_to(share, SHARE_STEP), LEAST_SHARE);
}

/* Clusters into their images, in the order of their place on the texture, so that neighbours agree. */
static void store_clusters(FootprintPixel *p, KindImages *images, Clusters *clusters, double step, int x, int y)
{
    float scale = 1 / (float)p->film->params.spp;
    float again = 0;
    for (int k = 0; k < clusters->count; k++)
        again += clusters->of[k].again;
    qsort(clusters->of, (size_t)clusters->count, sizeof *clusters->of, compare_clusters);
    for (int k = 0; k < clusters->count; k++) {
        const Cluster *cluster = &clusters->of[k];
        float coverage = (float)effective_samples(cluster) * scale;
        store_footprint(&images->of[k], &cluster->uv, &cluster->albedo, coverage, x, y);
        store_light(&images->of[k].light, cluster->c, scale, step, x, y);
        if (again > 0)
            store_share(&images->of[k].share, cluster->again / again, x, y);
    }
    for (int i = 1; i < p->film->plan.count; i++)
        store_light(&images->again[i], clusters->again[i], scale, step, x, y);
    clusters->count = 0;
    memset(clusters->again, 0, sizeof clusters->again[0] * (size_t)p->film->plan.count);
}

static double light_sum(const AlbedoSums *albedo)
{
    return (double)albedo->light[0] + albedo->light[1] + albedo->light[2];
}

/* Further hits, with the share that each has in the light of all. */
static void store_later(FootprintPixel *p, int x, int y)
{
    int ntargets = p->film->scene->ntargets;
    double sum = 0;
    for (int t = 0; t < ntargets; t++)
        for (int k = 0; k < LATER_COUNT; k++)
            sum += light_sum(&p->targets[t].later[k].albedo);
    for (int t = 0; t < ntargets; t++)
        for (int k = 0; k < LATER_COUNT; k++) {
            Later *later = &p->targets[t].later[k];
            FootprintImages *images = &p->film->targets[t].later[k];
            if (!(later->uv.weight > 0))
                continue;
            double effective = later->uv.weight * later->uv.weight / later->squares / p->film->params.spp;
            store_footprint(images, &later->uv, &later->albedo, (float)fmin(effective, 1), x, y);
            store_share(&images->share, sum > 0 ? (float)(light_sum(&later->albedo) / sum) : 0, x, y);
            *later = (Later){.squares = 0};
        }
}

void footprints_pixel_end(FootprintPixel *p, int x, int y)
{
    FootprintFilm *film = p->film;
    double step = COEFFICIENT_STEP * white_pixel(p);
    float scale = 1 / (float)film->params.spp, *c0 = pixel_of(&film->free, x, y);
    for (int c = 0; c < 3; c++)
        c0[c] = (float)(p->free[c] * scale), p->free[c] = 0;
    for (int t = 0; t < film->scene->ntargets; t++) {
        store_clusters(p, &film->targets[t].kinds[0], &p->targets[t].sharp, step, x, y);
        store_clusters(p, &film->targets[t].kinds[1], &p->targets[t].broad, step, x, y);
    }
    store_later(p, x, y);
}
