/* Clusters of one pixel, and the images they end in; see footprints.h. */
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "film/cluster.h"
#include "film/footprints.h"
#include "film/plan.h"

#define PENDING_MAX 64
#define PARTS_MAX 1500 /* of a set, with room for its beauty, originals and AOVs */
/* What an unknown texture is taken for where its hit only weighs another's. */
#define UNKNOWN_ALBEDO 0.5f
#define LEAST_ALBEDO 1e-3f
/* White paint. */
#define WHITE_ALBEDO 0.8f
/* Coefficients are rounded to this share of what the pixel would be were its targets white: steps no one sees, and
 * small coefficients of few bits, which compress. */
#define COEFFICIENT_STEP (1.0f / 8192)
/* Mean UVs are rounded to this share of their standard deviation. */
#define UV_STEP (1.0 / 32)

typedef float Coefficients[PLAN_COEFFICIENTS_MAX][3];

/* Original albedo of a footprint, weighted by the light it multiplies. */
typedef struct AlbedoSums {
    float light[3], reflected[3];
} AlbedoSums;

typedef struct Cluster {
    UvStats uv;
    AlbedoSums albedo;
    double squares; /* of the paths' weights */
    Coefficients c;
} Cluster;

/* One path's light by the hit that comes first. */
typedef struct Pending {
    int target, order; /* the how-manieth target hit of its path */
    int sharp;
    Vec2 position;
    double weight;
    AlbedoSums albedo;
    Coefficients c;
} Pending;

/* Clusters of one kind. */
typedef struct Clusters {
    int count;
    Cluster of[FILM_CLUSTERS_MAX];
} Clusters;

/* The clusters of one pixel on one target. */
typedef struct TargetClusters {
    Clusters sharp, broad;
    UvStats later[2]; /* two clusters of all further hits; weight 0: none */
    AlbedoSums later_albedo;
    int later_samples, later_seen; /* seen: by the path in hand */
    double mixed;                  /* weight of its hits in mixtures */
} TargetClusters;

/* Images of one footprint. */
typedef struct FootprintImages {
    RetexImage uv, spread, albedo;
    RetexImage coefficients[PLAN_COEFFICIENTS_MAX]; /* of clusters */
} FootprintImages;

struct FootprintFilm {
    const Scene *scene;
    FilmParams params;
    Plan plan;
    RetexImage free;                           /* C0 */
    FootprintImages *slots[RETEX_MAX_TARGETS]; /* sharp, broad */
    FootprintImages later[RETEX_MAX_TARGETS];
    RetexImage shares[RETEX_MAX_TARGETS]; /* of mixtures; with several targets */
};

struct FootprintPixel {
    FootprintFilm *film;
    double free[3];
    TargetClusters *targets;
    Pending pending[PENDING_MAX];
    int npending;
    UvRange range; /* of the path in hand */
};

/* ---- life ---- */

static int slots_count(const FilmParams *p)
{
    return p->sharp + p->broad;
}

static int alloc_footprint(const FilmParams *p, FootprintImages *f, int coefficients, RetexError *err)
{
    int code = retex_image_alloc(&f->uv, p->width, p->height, 3, err);
    if (!code)
        code = retex_image_alloc(&f->spread, p->width, p->height, 3, err);
    if (!code)
        code = retex_image_alloc(&f->albedo, p->width, p->height, 3, err);
    for (int i = 0; i < coefficients && !code; i++)
        code = retex_image_alloc(&f->coefficients[i], p->width, p->height, 3, err);
    return code;
}

static void free_footprint(FootprintImages *f)
{
    retex_image_free(&f->uv);
    retex_image_free(&f->spread);
    retex_image_free(&f->albedo);
    for (int i = 0; i < PLAN_COEFFICIENTS_MAX; i++)
        retex_image_free(&f->coefficients[i]);
}

static int has_mixtures(const Plan *plan)
{
    return plan->coefficients[plan->count - 1].mixed > 0;
}

static int alloc_images(FootprintFilm *film, RetexError *err)
{
    const FilmParams *p = &film->params;
    int code = retex_image_alloc(&film->free, p->width, p->height, 3, err);
    for (int t = 0; t < film->scene->ntargets && !code; t++) {
        film->slots[t] = calloc((size_t)slots_count(p), sizeof *film->slots[t]);
        if (!film->slots[t])
            return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
        for (int k = 0; k < slots_count(p) && !code; k++)
            code = alloc_footprint(p, &film->slots[t][k], film->plan.count, err);
        if (!code && film->plan.count > 1)
            code = alloc_footprint(p, &film->later[t], 0, err);
        if (!code && has_mixtures(&film->plan))
            code = retex_image_alloc(&film->shares[t], p->width, p->height, 1, err);
    }
    return code;
}

int footprints_create(FootprintFilm **out, const Scene *scene, const FilmParams *params, RetexError *err)
{
    FootprintFilm *film = *out = calloc(1, sizeof *film);
    if (!film)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    film->scene = scene;
    film->params = *params;
    plan_make(&film->plan, scene->ntargets, params->orders, expansion_most_hits(scene->ntargets, 0));
    int parts = scene->ntargets * (slots_count(params) * (film->plan.count + 3) + 4);
    if (parts > PARTS_MAX)
        return retex_fail(err, RETEX_ELIMIT, "the set may need %d parts, more than %d: take fewer targets or clusters",
                          parts, PARTS_MAX);
    return alloc_images(film, err);
}

void footprints_close(FootprintFilm **out)
{
    FootprintFilm *film = *out;
    if (!film)
        return;
    retex_image_free(&film->free);
    for (int t = 0; t < RETEX_MAX_TARGETS; t++) {
        for (int k = 0; film->slots[t] && k < slots_count(&film->params); k++)
            free_footprint(&film->slots[t][k]);
        free(film->slots[t]);
        free_footprint(&film->later[t]);
        retex_image_free(&film->shares[t]);
    }
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
    q->weight = 0;
    q->albedo = (AlbedoSums){0};
    memset(q->c, 0, sizeof q->c[0] * (size_t)p->film->plan.count);
    return q;
}

/* One more among two: it, or the pair it meets, goes together where that loses least. */
static void pool_later(UvStats later[2], const UvStats *one, const int periodic[2])
{
    for (int k = 0; k < 2; k++)
        if (later[k].weight == 0) {
            later[k] = *one;
            return;
        }
    double first = uv_stats_variation_gain(&later[0], one, periodic),
           second = uv_stats_variation_gain(&later[1], one, periodic),
           both = uv_stats_variation_gain(&later[0], &later[1], periodic);
    if (both < first && both < second) {
        uv_stats_merge(&later[0], &later[1], periodic);
        later[1] = *one;
    } else {
        uv_stats_merge(&later[second < first], one, periodic);
    }
}

/* The footprint that stands for all further hits: both clusters, or, where these lie so far apart that together they
 * would see the texture's mean, the one that has most of the light. */
static UvStats whole_later(const UvStats later[2], const int periodic[2])
{
    const double wide = UV_FEATURE * UV_FEATURE;
    const UvStats *heavy = &later[later[1].weight > later[0].weight], *light = &later[heavy == &later[0]];
    UvStats both = *heavy;
    if (light->weight > 0)
        uv_stats_merge(&both, light, periodic);
    return both.m2[0] + both.m2[2] > wide * both.weight && heavy->m2[0] + heavy->m2[2] < wide * heavy->weight ? *heavy
                                                                                                              : both;
}

static void add_later(FootprintPixel *p, const TargetHit *hit, double weight, double mixed, Rgb light)
{
    TargetClusters *t = &p->targets[hit->target];
    const double uv[2] = {hit->uv.u, hit->uv.v};
    if (weight > 0)
        pool_later(t->later, &(UvStats){weight, {uv[0], uv[1]}, {0, 0, 0}}, p->film->params.periodic[hit->target]);
    add_albedo(&t->later_albedo, light, hit->albedo);
    t->later_seen = 1;
    t->mixed += mixed;
    uv_range_add(&p->range, hit->target, uv);
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
    add_albedo(&q->albedo, light, hit->albedo);
    int mixed = p->film->plan.coefficients[kept.coefficient].mixed;
    for (int k = 0; k < kept.count; k++) {
        Rgb others = rgb_mul(value, weighing_albedo(hit));
        for (int i = 0; i < kept.count; i++)
            if (i != k)
                others = rgb_mul(others, weighing_albedo(kept.hits[i]));
        add_later(p, kept.hits[k], weight, mixed ? weight / mixed : 0, others);
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

static void merge_albedo(AlbedoSums *into, const AlbedoSums *from)
{
    for (int c = 0; c < 3; c++)
        into->light[c] += from->light[c], into->reflected[c] += from->reflected[c];
}

static void merge_cluster(Cluster *into, const Cluster *from, int coefficients, const int periodic[2])
{
    uv_stats_merge(&into->uv, &from->uv, periodic);
    merge_albedo(&into->albedo, &from->albedo);
    into->squares += from->squares;
    for (int i = 0; i < coefficients; i++)
        for (int c = 0; c < 3; c++)
            into->c[i][c] += from->c[i][c];
}

static void add_pending(Cluster *into, const Pending *q, int coefficients, const int periodic[2])
{
    const double uv[2] = {q->position.u, q->position.v};
    uv_stats_add(&into->uv, q->weight, uv, periodic);
    merge_albedo(&into->albedo, &q->albedo);
    into->squares += q->weight * q->weight;
    for (int i = 0; i < coefficients; i++)
        for (int c = 0; c < 3; c++)
            into->c[i][c] += q->c[i][c];
}

static void start_cluster(Cluster *cluster, const Pending *q, int coefficients, const int periodic[2])
{
    cluster->uv = (UvStats){0};
    cluster->albedo = (AlbedoSums){0};
    cluster->squares = 0;
    memset(cluster->c, 0, sizeof cluster->c[0] * (size_t)coefficients);
    add_pending(cluster, q, coefficients, periodic);
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
static void squeeze(Clusters *own, Clusters *other, int own_is_full, const Pending *q, int coefficients,
                    const int periodic[2])
{
    const UvStats one = {q->weight, {q->position.u, q->position.v}, {0, 0, 0}};
    Pair best = {.cost = INFINITY};
    find_cheapest(&best, own, q->sharp, &one, periodic);
    if (!own_is_full)
        find_cheapest(&best, other, !q->sharp, NULL, periodic);
    if (best.b < 0) {
        add_pending(&own->of[best.a], q, coefficients, periodic);
        return;
    }
    Clusters *merged = best.clusters;
    merge_cluster(&merged->of[best.a], &merged->of[best.b], coefficients, periodic);
    if (merged == own) {
        start_cluster(&own->of[best.b], q, coefficients, periodic);
        return;
    }
    if (best.b != --merged->count)
        merged->of[best.b] = merged->of[merged->count];
    start_cluster(&own->of[own->count++], q, coefficients, periodic);
}

static void flush_pending(FootprintPixel *p)
{
    const FilmParams *params = &p->film->params;
    for (int k = 0; k < p->npending; k++) {
        Pending *q = &p->pending[k];
        TargetClusters *t = &p->targets[q->target];
        Clusters *own = q->sharp ? &t->sharp : &t->broad, *other = q->sharp ? &t->broad : &t->sharp;
        int room = q->sharp ? params->sharp : params->broad, coefficients = p->film->plan.count;
        const int *periodic = params->periodic[q->target];
        const double uv[2] = {q->position.u, q->position.v};
        if (!(q->weight > 0))
            continue;
        uv_range_add(&p->range, q->target, uv);
        if (own->count < room && own->count + other->count < params->clusters)
            start_cluster(&own->of[own->count++], q, coefficients, periodic);
        else
            squeeze(own, other, own->count == room, q, coefficients, periodic);
    }
    p->npending = 0;
}

void footprints_path_end(FootprintPixel *p, UvRange *range)
{
    flush_pending(p);
    for (int t = 0; t < p->film->scene->ntargets; t++) {
        p->targets[t].later_samples += p->targets[t].later_seen;
        p->targets[t].later_seen = 0;
    }
    uv_range_merge(range, &p->range);
    uv_range_reset(&p->range);
}

/* ---- the finished pixel ---- */

static float *pixel_of(RetexImage *image, int x, int y)
{
    return image->pixels + retex_image_index(image, x, y);
}

/* To a power of two times step, or as it is where there is none. */
static double round_to(double value, double step)
{
    if (!(step > 0))
        return value;
    int exponent;
    frexp(step, &exponent);
    return ldexp(rint(ldexp(value, 1 - exponent)), exponent - 1);
}

static void store_footprint(FootprintImages *to, const UvStats *uv, const AlbedoSums *albedo, float coverage, int x,
                            int y)
{
    float *mean = pixel_of(&to->uv, x, y), *spread = pixel_of(&to->spread, x, y), *a = pixel_of(&to->albedo, x, y);
    double su = sqrt(uv->m2[0] / uv->weight), sv = sqrt(uv->m2[2] / uv->weight);
    mean[0] = (float)round_to(uv->mean[0], UV_STEP * su);
    mean[1] = (float)round_to(uv->mean[1], UV_STEP * sv);
    mean[2] = coverage;
    spread[0] = (float)su, spread[1] = (float)sv;
    spread[2] = su > 0 && sv > 0 ? (float)(uv->m2[1] / (uv->weight * su * sv)) : 0;
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
    for (int k = 0; k < clusters->count; k++)
        for (int i = 0; i < coefficients; i++)
            for (int c = 0; c < 3; c++)
                sum[c] += clusters->of[k].c[i][c];
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

/* Clusters into their images, in the order of their place on the texture, so that neighbours agree. */
static void store_clusters(FootprintPixel *p, FootprintImages *slots, Clusters *clusters, double step, int x, int y)
{
    float scale = 1 / (float)p->film->params.spp;
    int coefficients = p->film->plan.count;
    qsort(clusters->of, (size_t)clusters->count, sizeof *clusters->of, compare_clusters);
    for (int k = 0; k < clusters->count; k++) {
        const Cluster *cluster = &clusters->of[k];
        store_footprint(&slots[k], &cluster->uv, &cluster->albedo, (float)effective_samples(cluster) * scale, x, y);
        for (int i = 0; i < coefficients; i++) {
            const float *sum = cluster->c[i];
            if (sum[0] == 0 && sum[1] == 0 && sum[2] == 0)
                continue; /* memory that is never touched is never taken */
            float *to = pixel_of(&slots[k].coefficients[i], x, y);
            for (int c = 0; c < 3; c++)
                to[c] = (float)round_to(sum[c] * scale, step);
        }
    }
    clusters->count = 0;
}

/* How often each target was met in mixtures; they add up to 1, or are all 0. */
static void store_shares(FootprintPixel *p, int x, int y)
{
    double sum = 0;
    for (int t = 0; t < p->film->scene->ntargets; t++)
        sum += p->targets[t].mixed;
    for (int t = 0; t < p->film->scene->ntargets && sum > 0; t++)
        *pixel_of(&p->film->shares[t], x, y) = (float)(p->targets[t].mixed / sum);
}

void footprints_pixel_end(FootprintPixel *p, int x, int y)
{
    FootprintFilm *film = p->film;
    double step = COEFFICIENT_STEP * white_pixel(p);
    float scale = 1 / (float)film->params.spp, *c0 = pixel_of(&film->free, x, y);
    for (int c = 0; c < 3; c++)
        c0[c] = (float)(p->free[c] * scale), p->free[c] = 0;
    store_shares(p, x, y);
    for (int t = 0; t < film->scene->ntargets; t++) {
        TargetClusters *of = &p->targets[t];
        store_clusters(p, film->slots[t], &of->sharp, step, x, y);
        store_clusters(p, film->slots[t] + film->params.sharp, &of->broad, step, x, y);
        UvStats later = whole_later(of->later, film->params.periodic[t]);
        if (later.weight > 0)
            store_footprint(&film->later[t], &later, &of->later_albedo, (float)of->later_samples * scale, x, y);
        of->later_samples = 0;
        of->later[0] = of->later[1] = (UvStats){0};
        of->mixed = 0;
        of->later_albedo = (AlbedoSums){0};
    }
}

/* ---- into the set ---- */

static int is_empty(const RetexImage *image)
{
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < count; i++)
        if (image->pixels[i] != 0)
            return 0;
    return 1;
}

static int finish_footprint(RetexSet *set, FootprintImages *images, RetexFootprint *f, const char *suffix,
                            RetexError *err)
{
    char name[RETEX_NAME_MAX];
    const char *target = set->targets[f->target].name;
    snprintf(name, sizeof name, "uv_%.90s_%s", target, suffix);
    int code = film_move_part(set, name, "RGA", RETEX_FLOAT, &images->uv, &f->uv, err);
    snprintf(name, sizeof name, "spread_%.90s_%s", target, suffix);
    if (!code)
        code = film_move_part(set, name, "RGB", RETEX_HALF, &images->spread, &f->spread, err);
    snprintf(name, sizeof name, "albedo_%.90s_%s", target, suffix);
    if (!code)
        code = film_move_part(set, name, "RGB", RETEX_HALF, &images->albedo, &f->albedo, err);
    return code ? code : retex_set_add_footprint(set, f, NULL, err);
}

static void slot_name(const FootprintFilm *film, int slot, char name[16])
{
    if (slot < film->params.sharp)
        snprintf(name, 16, "sharp%d", slot + 1);
    else
        snprintf(name, 16, "broad%d", slot - film->params.sharp + 1);
}

/* Where the footprints of the film are in the set. */
typedef struct Places {
    int clusters[2 * FILM_CLUSTERS_MAX]; /* -1: no pixel has so many, and the set leaves it out */
    int later;
} Places;

static int finish_footprints(FootprintFilm *film, RetexSet *set, Places *places, RetexError *err)
{
    int slots = slots_count(&film->params), code = RETEX_OK;
    for (int t = 0; t < set->ntargets && !code; t++) {
        for (int k = 0; k < slots && !code; k++) {
            char name[16];
            RetexFootprint f = {.target = t, .hit = k + 1};
            f.kind = k < film->params.sharp ? RETEX_FOOTPRINT_SHARP : RETEX_FOOTPRINT_BROAD;
            places[t].clusters[k] = -1;
            if (is_empty(&film->slots[t][k].uv))
                continue;
            places[t].clusters[k] = set->nfootprints;
            slot_name(film, k, name);
            code = finish_footprint(set, &film->slots[t][k], &f, name, err);
        }
        places[t].later = set->nfootprints;
        RetexFootprint f = {.target = t, .hit = slots + 1, .kind = RETEX_FOOTPRINT_LATER};
        if (!code && film->plan.count > 1)
            code = finish_footprint(set, &film->later[t], &f, "later", err);
    }
    return code;
}

static int finish_shares(FootprintFilm *film, RetexSet *set, const Places *places, RetexError *err)
{
    int code = RETEX_OK;
    for (int t = 0; t < set->ntargets && has_mixtures(&film->plan) && !code; t++) {
        char name[RETEX_NAME_MAX];
        RetexShare *share = &set->mixture[set->nmixture];
        snprintf(name, sizeof name, "share_%.90s", set->targets[t].name);
        share->footprint = places[t].later;
        code = film_move_part(set, name, "R", RETEX_HALF, &film->shares[t], &share->weight, err);
        set->nmixture += !code;
    }
    return code;
}

/* dep_Floor_sharp1, and with further hits dep_Floor_sharp1_a2b1: two of the first target, one of the second; or
 * dep_Floor_sharp1_m5: five of any. */
static void coefficient_name(const FootprintFilm *film, const RetexSet *set, int t, int slot, int i,
                             char name[RETEX_NAME_MAX])
{
    char cluster[16];
    slot_name(film, slot, cluster);
    int used = snprintf(name, RETEX_NAME_MAX, "dep_%.80s_%s", set->targets[t].name, cluster);
    const PlanCoefficient *c = &film->plan.coefficients[i];
    if (c->mixed)
        snprintf(name + used, (size_t)(RETEX_NAME_MAX - used), "_m%d", c->mixed);
    for (int later = 0, any = 0; later < set->ntargets; later++)
        if (c->powers[later])
            used += snprintf(name + used, (size_t)(RETEX_NAME_MAX - used), "%s%c%d", any++ ? "" : "_", 'a' + later,
                             c->powers[later]);
}

/* One cluster's coefficients, but for those that no pixel has. */
static int finish_coefficients(FootprintFilm *film, RetexSet *set, int t, int slot, const Places *places,
                               RetexError *err)
{
    int code = RETEX_OK;
    for (int i = 0; i < film->plan.count && !code; i++) {
        RetexImage *image = &film->slots[t][slot].coefficients[i];
        const PlanCoefficient *c = &film->plan.coefficients[i];
        RetexTerm term = {.kind = RETEX_TERM_DEP, .nfactors = 1, .factors = {places[t].clusters[slot]}};
        char name[RETEX_NAME_MAX];
        if (is_empty(image))
            continue;
        term.nmixed = c->mixed;
        for (int b = 0; b < set->ntargets; b++)
            for (int n = 0; n < c->powers[b]; n++)
                term.factors[term.nfactors++] = places[b].later;
        coefficient_name(film, set, t, slot, i, name);
        code = film_move_part(set, name, "RGB", RETEX_HALF, image, &term.radiance, err);
        if (!code)
            code = retex_set_add_term(set, &term, NULL, err);
    }
    return code;
}

int footprints_finish(FootprintFilm *film, RetexSet *set, RetexError *err)
{
    Places places[RETEX_MAX_TARGETS];
    RetexTerm free_term = {.kind = RETEX_TERM_INDEP};
    int code = finish_footprints(film, set, places, err);
    if (!code)
        code = finish_shares(film, set, places, err);
    if (!code)
        code = film_move_part(set, "indep", "RGB", RETEX_HALF, &film->free, &free_term.radiance, err);
    if (!code)
        code = retex_set_add_term(set, &free_term, NULL, err);
    for (int t = 0; t < set->ntargets; t++)
        for (int k = 0; k < slots_count(&film->params) && !code; k++)
            if (places[t].clusters[k] >= 0)
                code = finish_coefficients(film, set, t, k, places, err);
    return code;
}
