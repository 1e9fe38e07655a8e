/* See footprints.h. */
#include <limits.h>
#include <math.h>
#include <string.h>

#include <retex/host/rounding.h>
#include <retex/host/uv_stats.h>

#include "denoise/footprints.h"
#include "set/set.h"

#define NEGLIGIBLE 1e-2f   /* neighbours with less weight are left out */
#define LEAST_VARIANCE 0.5 /* of a sample in a cluster, relative to its light squared */
#define NOISE_REACH 2      /* pixels to each side whose noise tells how much there is */
#define CLUSTERS_LEAST 2   /* clusters of broad light that a pixel may always have */
#define CLUSTERS_MOST 3
#define NEAR 0.1 /* fraction of a cluster's width that another pixel's may be away */
#define FAR 0.05 /* share of its weight that merging may lose: with more a cluster stays apart, within capacity */

/* ---- one pixel ---- */

/* The pixel that is written, and its number in the set's images. */
typedef struct Pixel {
    const RetexDenoisedRows *out;
    size_t at, place; /* in the set, in the rows */
} Pixel;

static Pixel pixel_at(const RetexDenoiseFootprints *f, const RetexDenoisedRows *out, int x, int y)
{
    return (Pixel){out, (size_t)y * f->width + (size_t)x, (size_t)(y - out->first) * f->width + (size_t)x};
}

static float *written(const Pixel *p, const RetexFootprintImage *image)
{
    return p->out->parts[image->part] + p->place * image->channels;
}

static void copy_pixel(const Pixel *p, const RetexFootprintImage *image, size_t from)
{
    memcpy(written(p, image), image->pixels + from * image->channels, image->channels * sizeof(float));
}

static void clear_pixel(const Pixel *p, const RetexFootprintImage *image)
{
    memset(written(p, image), 0, image->channels * sizeof(float));
}

/* Moves UV that was copied from a pixel with axes to where the pixel itself is on the surface, if that goes on
 * evenly. */
static void move_along_axes(const RetexDenoiseFootprints *f, const RetexFootprintImages *place, const Pixel *p,
                            size_t from)
{
    const float *axes = place->spread.pixels + from * RETEX_AXES;
    const float right = (float)(p->at % f->width) - (float)(from % f->width),
                down = (float)(p->at / f->width) - (float)(from / f->width);
    float *uv = written(p, &place->uv);
    for (int i = 0; i < 2; i++)
        uv[i] += right * axes[i] + down * axes[2 + i];
}

/* Copies the footprints of another pixel, or of the pixel itself. */
static void copy_footprints(const RetexDenoiseFootprints *f, const RetexFootprintClass *g, const Pixel *p, size_t from)
{
    for (int k = 0; k < g->count; k++) {
        const RetexFootprintImages *place = &g->of[k];
        copy_pixel(p, &place->uv, from);
        if (place->spread.channels == RETEX_AXES && from != p->at)
            move_along_axes(f, place, p, from);
        copy_pixel(p, &place->spread, from);
        copy_pixel(p, &place->albedo, from);
        if (place->share.channels == 1)
            copy_pixel(p, &place->share, from);
    }
}

static void clear_footprint(const RetexFootprintImages *place, const Pixel *p)
{
    clear_pixel(p, &place->uv);
    clear_pixel(p, &place->spread);
    clear_pixel(p, &place->albedo);
    if (place->light.pixels)
        clear_pixel(p, &place->light);
    if (place->share.channels == 1)
        clear_pixel(p, &place->share);
}

static void store_share(const RetexFootprintImages *place, const Pixel *p, double share)
{
    if (place->share.channels == 1)
        *written(p, &place->share) = share > 0 ? retex_round_share(share) : 0;
}

static void store_light(const RetexFootprintImages *place, const Pixel *p, const float light[3], double share)
{
    float *to = written(p, &place->light);
    for (int c = 0; c < 3; c++)
        to[c] = (float)share * light[c];
}

/* ---- clusters that stay ---- */

static float cluster_light(const RetexFootprintImages *place, size_t i)
{
    float l = place->light.pixels ? footprint_luminance(place->light.pixels + 3 * i) : 0;
    return l > 0 && l < FOOTPRINT_VALUE_MAX ? l : 0;
}

static float cluster_cover(const RetexFootprintImages *place, size_t i)
{
    const float *uv = place->light.pixels && place->uv.pixels ? place->uv.pixels + 3 * i : NULL;
    return uv && uv[2] > 0 && fabsf(uv[0]) + fabsf(uv[1]) + uv[2] < FOOTPRINT_VALUE_MAX ? uv[2] : 0;
}

static double sum_over(const RetexFootprintClass *g, size_t i, float (*value)(const RetexFootprintImages *, size_t))
{
    double sum = 0;
    for (int k = 0; k < g->nlit; k++)
        sum += value(&g->of[k], i);
    return sum;
}

/* The nearest pixel of the window that has clusters; else the pixel itself. */
static size_t find_nearest_donor(const RetexDenoiseFootprints *f, const RetexFootprintClass *g, size_t self)
{
    const int width = (int)f->width, height = (int)(f->pixels / f->width);
    const int x = (int)(self % f->width), y = (int)(self / f->width), radius = f->radius;
    int least = INT_MAX;
    size_t donor = self;
    for (int dy = -radius; dy <= radius; dy++)
        for (int dx = -radius; dx <= radius; dx++) {
            const int squared = dx * dx + dy * dy;
            if (squared >= least || x + dx < 0 || x + dx >= width || y + dy < 0 || y + dy >= height)
                continue;
            const size_t i = (size_t)(y + dy) * f->width + (size_t)(x + dx);
            if (sum_over(g, i, cluster_cover) > 0)
                least = squared, donor = i;
        }
    return donor;
}

/* The neighbour with the largest weight that has clusters. Neighbours are but a grid of the window: where none has
 * clusters, the light came from pixels between them. */
static size_t find_donor(const RetexDenoiseFootprints *f, const RetexFootprintClass *g,
                         const RetexNeighbour *neighbours, int count, size_t self)
{
    float best = 0;
    size_t donor = self;
    for (int n = 0; n < count; n++) {
        size_t i = (size_t)neighbours[n].y * f->width + (size_t)neighbours[n].x;
        if (neighbours[n].weight > best && sum_over(g, i, cluster_cover) > 0)
            best = neighbours[n].weight, donor = i;
    }
    return best > 0 ? donor : find_nearest_donor(f, g, self);
}

/* Filtered interreflected light may come to a pixel that had none, so that no cluster has a share in it. Shares of 0
 * would lose that light. */
static void repair_shares(const RetexFootprintClass *g, const Pixel *p, size_t from,
                          float (*value)(const RetexFootprintImages *, size_t), double all)
{
    for (int k = 0; k < g->count; k++)
        if (g->of[k].share.channels != 1 || g->of[k].share.pixels[from] != 0)
            return;
    for (int k = 0; k < g->nlit; k++)
        if (cluster_cover(&g->of[k], from) > 0)
            store_share(&g->of[k], p, value(&g->of[k], from) / all);
}

/* The coverage of a cluster in the pixel, if the cluster has light. */
static float lit_coverage(const RetexFootprintImages *place, size_t i)
{
    return cluster_light(place, i) > 0 ? cluster_cover(place, i) : 0;
}

/* The variance of the pixel's light of the class, relative to its square, by the noise there and in the pixels at both
 * sides. */
static double relative_variance(const RetexFootprintClass *g, const RetexImage *noise, size_t at)
{
    const size_t width = (size_t)noise->width, x = at % width, row = at - x, reach = NOISE_REACH,
                 first = x > reach ? x - reach : 0, last = x + reach < width ? x + reach : width - 1;
    double variance = 0, squares = 0;
    for (size_t i = row + first; i <= row + last; i++) {
        const double light = sum_over(g, i, cluster_light), n = (double)footprint_luminance(noise->pixels + 3 * i);
        variance += n * n, squares += light * light;
    }
    return variance < squares ? variance / squares : 1;
}

/* How far the clusters' light is credible, 0..1, where its proportions differ from those of the coverage: in part the
 * brightness of a cluster is noise. The part of the squared difference beyond that is real (James and Stein 1961). The
 * relative variance of a sum of n effective samples is 1/n, or less: as that of all the light, of more samples. But
 * samples are spread evenly over pixels, not over clusters, so that these have more noise than the pixel tells. */
static double light_confidence(const RetexDenoiseFootprints *f, const RetexFootprintClass *g, const RetexImage *noise,
                               size_t from)
{
    double cover = sum_over(g, from, lit_coverage), light = sum_over(g, from, cluster_light), chance = 0, differs = 0;
    if (g->kind != RETEX_FOOTPRINT_SHARP || !(cover > 0))
        return 1;
    const double variance = /* of what covers a pixel */
        fmin(1, fmax(LEAST_VARIANCE, f->spp * cover * relative_variance(g, noise, from))) / f->spp;
    for (int k = 0; k < g->nlit; k++) {
        double of_light = cluster_light(&g->of[k], from) / light, of_cover = lit_coverage(&g->of[k], from);
        if (!(of_cover > 0))
            continue;
        chance += of_light * of_light * variance / of_cover;
        differs += (of_light - of_cover / cover) * (of_light - of_cover / cover);
    }
    return differs > chance ? 1 - chance / differs : 0;
}

/* The share of a cluster in the light: for each colour by the cluster's own light, as far as that is credible, else by
 * its coverage. */
static void share_cluster(const RetexFootprintClass *g, int k, const Pixel *p, size_t from, double belief,
                          const float light[3])
{
    double cover = sum_over(g, from, lit_coverage), by_cover = cover > 0 ? lit_coverage(&g->of[k], from) / cover : 0,
           by_light = cluster_light(&g->of[k], from) / sum_over(g, from, cluster_light);
    float *to = written(p, &g->of[k].light);
    for (int c = 0; c < 3; c++) {
        double sum = 0, own = 0;
        for (int j = 0; j < g->nlit; j++) {
            double l = cluster_light(&g->of[j], from) > 0 ? fmaxf(0, g->of[j].light.pixels[3 * from + (size_t)c]) : 0;
            sum += l, own += j == k ? l : 0;
        }
        double share = sum > 0 ? own / sum : by_light;
        to[c] = (float)(belief * share + (1 - belief) * by_cover) * light[c];
    }
}

static void keep_clusters(const RetexDenoiseFootprints *f, const RetexFootprintClass *g, const RetexImage *noise,
                          const Pixel *p, const RetexNeighbour *neighbours, int count, const float light[3])
{
    size_t from = p->at;
    double all = sum_over(g, from, cluster_light);
    if (!(all > 0) && g->movable && (light[0] > 0 || light[1] > 0 || light[2] > 0) &&
        !(sum_over(g, from, cluster_cover) > 0)) {
        from = find_donor(f, g, neighbours, count, from);
        all = sum_over(g, from, cluster_light);
    }
    float (*value)(const RetexFootprintImages *, size_t) = all > 0 ? cluster_light : cluster_cover;
    if (!(all > 0))
        all = sum_over(g, from, value);
    double belief = value == cluster_light ? light_confidence(f, g, noise, from) : 0;
    for (int k = 0; k < g->nlit; k++)
        if (g->of[k].light.pixels && value == cluster_light)
            share_cluster(g, k, p, from, belief, light);
        else if (g->of[k].light.pixels)
            store_light(&g->of[k], p, light, all > 0 ? value(&g->of[k], from) / all : 0);
    if (!g->movable)
        return;
    copy_footprints(f, g, p, from);
    if (all > 0)
        repair_shares(g, p, from, value, all);
}

/* ---- pooling ---- */

/* Clusters of several pixels as one. */
typedef struct Pool {
    RetexUvStats uv;
    double squares;                           /* sum of squared weights over coverage */
    double luminance, shared;                 /* luminance of the cluster's light, and of its share in interreflected
                                                 light */
    double light[3], reflected[3], albedo[3]; /* albedo is weighted by the statistics' weight */
} Pool;

typedef struct Pools {
    int count, capacity;
    int drops_far; /* 1: of neighbours only clusters near to those of the pixel itself */
    Pool of[CLUSTERS_MOST];
} Pools;

static float read_share(const RetexFootprintClass *g, const RetexFootprintImages *place, size_t i)
{
    const float *share = place->share.pixels + i * place->share.channels;
    if (!place->share.pixels) /* the footprint is in no mixture */
        return g->kind == RETEX_FOOTPRINT_INTERREFLECTION || g->count == 1;
    return place->share.channels == 1 ? share[0] : (share[0] + share[1] + share[2]) / 3;
}

/* Loads a footprint; 0 if it is not there or has no weight. */
static int load_pool(Pool *pool, const RetexFootprintClass *g, const RetexFootprintImages *place, size_t i,
                     float weight)
{
    static const float dark[3];
    const float *uv = place->uv.pixels + 3 * i, *spread = place->spread.pixels + i * place->spread.channels;
    const float *albedo = place->albedo.pixels + 3 * i,
                *light = place->light.pixels ? place->light.pixels + 3 * i : dark;
    const float spreads[3] = {spread[0], spread[1], place->spread.channels == 3 ? spread[2] : 0};
    if (!(uv[2] > 0))
        return 0;
    float own = footprint_luminance(light),
          shared = g->interreflected && g->interreflected[i] > 0 ? g->interreflected[i] * read_share(g, place, i) : 0;
    float all = g->kind == RETEX_FOOTPRINT_HIT ? uv[2] : own + shared;
    float size = fabsf(uv[0]) + fabsf(uv[1]) + uv[2] + fabsf(spreads[0]) + fabsf(spreads[1]) + fabsf(spreads[2]) +
                 fabsf(albedo[0]) + fabsf(albedo[1]) + fabsf(albedo[2]) + fabsf(light[0]) + fabsf(light[1]) +
                 fabsf(light[2]);
    if (!(size < FOOTPRINT_VALUE_MAX) || !(own >= 0) || !(shared >= 0) || !(all > 0) || !(all < FOOTPRINT_VALUE_MAX))
        return 0;
    const float w = weight * all;
    if (!(w > 0))
        return 0;
    retex_uv_stats_load(&pool->uv, w, uv, spreads);
    pool->squares = (double)w * w / uv[2];
    pool->luminance = weight * own, pool->shared = weight * shared;
    for (int c = 0; c < 3; c++) {
        pool->light[c] = light[c] > 0 ? weight * light[c] : 0;
        pool->reflected[c] = pool->light[c] * albedo[c];
        pool->albedo[c] = w * albedo[c];
    }
    return 1;
}

static void merge_pool(Pool *into, const Pool *from, const int periodic[2])
{
    retex_uv_stats_merge(&into->uv, &from->uv, periodic);
    into->squares += from->squares;
    into->luminance += from->luminance, into->shared += from->shared;
    for (int c = 0; c < 3; c++) {
        into->light[c] += from->light[c];
        into->reflected[c] += from->reflected[c];
        into->albedo[c] += from->albedo[c];
    }
}

/* 1 if the distance of the means is larger than the first cluster's width. */
static int is_far(const RetexUvStats *a, const RetexUvStats *b, const int periodic[2])
{
    double squared = retex_uv_stats_ward(a, b, periodic) * (a->weight + b->weight) / (a->weight * b->weight);
    return squared > NEAR * NEAR * (a->m2[0] + a->m2[2]) / a->weight;
}

/* Merges a cluster into the pool where that loses least; with `open`, or where the loss is large, into a new one if
 * there is capacity. */
static void add_pool(Pools *pools, const Pool *one, const int periodic[2], int open)
{
    int best = -1;
    double least = INFINITY;
    for (int k = 0; k < pools->count && (pools->capacity > 1 || best < 0); k++) {
        double gain = retex_uv_stats_variation_gain(&pools->of[k].uv, &one->uv, periodic);
        if (gain < least || best < 0)
            least = gain, best = k;
    }
    if (best >= 0 && !open && pools->drops_far && is_far(&pools->of[best].uv, &one->uv, periodic))
        return;
    if (best < 0 || (pools->count < pools->capacity && (open || least > FAR * one->uv.weight)))
        pools->of[pools->count++] = *one;
    else
        merge_pool(&pools->of[best], one, periodic);
}

/* The clusters of the pixel itself come first, the heaviest foremost. */
static void pool_own(Pools *pools, const RetexFootprintClass *g, int most, const RetexNeighbour *self, size_t i)
{
    Pool own[FOOTPRINT_CLASS_MAX];
    int order[FOOTPRINT_CLASS_MAX], count = 0;
    for (int k = 0; k < g->count; k++) {
        if (!load_pool(&own[count], g, &g->of[k], i, self->weight))
            continue;
        int at = count++;
        for (; at > 0 && own[order[at - 1]].uv.weight < own[count - 1].uv.weight; at--)
            order[at] = order[at - 1];
        order[at] = count - 1;
    }
    pools->capacity = count < CLUSTERS_LEAST ? CLUSTERS_LEAST : count < CLUSTERS_MOST ? count : CLUSTERS_MOST;
    pools->capacity = pools->capacity < most ? pools->capacity : most;
    for (int k = 0; k < count; k++)
        add_pool(pools, &own[order[k]], g->periodic, 1);
}

static int compare_pools(const Pool *a, const Pool *b)
{
    double p = a->uv.mean[0] + a->uv.mean[1], q = b->uv.mean[0] + b->uv.mean[1];
    return p < q ? -1 : p > q;
}

/* By place on the texture, so that pixels next to each other list theirs alike. */
static void sort_pools(Pools *pools)
{
    for (int k = 1; k < pools->count; k++)
        for (int i = k; i > 0 && compare_pools(&pools->of[i], &pools->of[i - 1]) < 0; i--) {
            Pool swap = pools->of[i];
            pools->of[i] = pools->of[i - 1], pools->of[i - 1] = swap;
        }
}

/* Pools the clusters of a pixel, which is the first of its neighbours, and of all others, into at most `most`. Its own
 * open the pools; others join that which loses least. Far ones join none but of broad clusters. */
static void pool_class(Pools *pools, const RetexDenoiseFootprints *f, const RetexFootprintClass *g, int most,
                       const RetexNeighbour *neighbours, int count)
{
    *pools = (Pools){.capacity = most, .drops_far = g->kind != RETEX_FOOTPRINT_BROAD};
    for (int n = 0; n < count; n++) {
        size_t i = (size_t)neighbours[n].y * f->width + (size_t)neighbours[n].x;
        if (!(neighbours[n].weight > NEGLIGIBLE && neighbours[n].weight < FOOTPRINT_VALUE_MAX))
            continue;
        if (n == 0) {
            pool_own(pools, g, most, &neighbours[0], i);
            continue;
        }
        for (int k = 0; k < g->count; k++) {
            Pool one;
            if (load_pool(&one, g, &g->of[k], i, neighbours[n].weight))
                add_pool(pools, &one, g->periodic, 0);
        }
    }
    sort_pools(pools);
}

static void store_pool(const RetexFootprintImages *place, const Pixel *p, const Pool *pool, double coverage)
{
    float *uv = written(p, &place->uv), *spread = written(p, &place->spread), *albedo = written(p, &place->albedo);
    float spreads[3];
    retex_uv_stats_store(&pool->uv, uv, spreads);
    uv[2] = retex_round_coverage(fmin(coverage, 1));
    memcpy(spread, spreads, place->spread.channels * sizeof *spread);
    for (int c = 0; c < 3; c++)
        albedo[c] =
            (float)(pool->light[c] > 0 ? pool->reflected[c] / pool->light[c] : pool->albedo[c] / pool->uv.weight);
}

/* The effective number of samples of equal weight (Kish 1965), as a share of all samples. */
static double effective_coverage(const Pool *pool)
{
    return pool->uv.weight * pool->uv.weight / pool->squares;
}

static int pool_clusters(const RetexDenoiseFootprints *f, const RetexFootprintClass *g, const Pixel *p,
                         const RetexNeighbour *neighbours, int count, const float light[3])
{
    Pools pools;
    double lit = 0, shared = 0, weight = 0;
    pool_class(&pools, f, g, g->nlit < CLUSTERS_MOST ? g->nlit : CLUSTERS_MOST, neighbours, count);
    for (int k = 0; k < pools.count; k++)
        lit += pools.of[k].luminance, shared += pools.of[k].shared, weight += pools.of[k].uv.weight;
    for (int k = 0; k < g->count && pools.count; k++) {
        const Pool *pool = &pools.of[k];
        if (k >= pools.count) {
            clear_footprint(&g->of[k], p);
            continue;
        }
        store_pool(&g->of[k], p, pool, effective_coverage(pool));
        store_light(&g->of[k], p, light, lit > 0 ? pool->luminance / lit : pool->uv.weight / weight);
        /* without shares, interreflected light from other pixels would be lost */
        store_share(&g->of[k], p, shared > 0 ? pool->shared / shared : pool->uv.weight / weight);
    }
    return pools.count;
}

void retex_denoise_share_light(const RetexDenoiseFootprints *f, const RetexDenoiser *d, const RetexSignal *signal,
                               int x, int y, const RetexNeighbour *neighbours, int count, const float light[3],
                               RetexDenoisedRows *out)
{
    const RetexFootprintClass *g = &f->signals[signal - d->signals.of];
    const Pixel p = pixel_at(f, out, x, y);
    int pooled = g->kind == RETEX_FOOTPRINT_BROAD && g->movable && d->params.footprints && g->nlit;
    if (!pooled || !pool_clusters(f, g, &p, neighbours, count, light))
        keep_clusters(f, g, &d->set->parts[signal->noise].image, &p, neighbours, count, light);
}

/* 1 if the pixel has clusters with shares in interreflected light. */
static int has_interreflections(const RetexDenoiseFootprints *f, size_t i)
{
    Pool pool;
    for (int t = 0; t < f->ninterreflections; t++)
        for (int k = 0; k < f->interreflections[t].count; k++)
            if (load_pool(&pool, &f->interreflections[t], &f->interreflections[t].of[k], i, 1))
                return 1;
    return 0;
}

/* What a pixel sees of interreflections, and the shares of it, stay its own: shares pooled over neighbours, which see
 * other parts of the texture, would favour wide clusters. A pixel that has none takes those of the neighbour with the
 * largest weight that has any; its own weight is the largest of all. */
static void keep_interreflections(const RetexDenoiseFootprints *f, const Pixel *p, const RetexNeighbour *neighbours,
                                  int count)
{
    size_t from = p->at;
    float best = 0;
    for (int n = 0; n < count; n++) {
        const size_t i = (size_t)neighbours[n].y * f->width + (size_t)neighbours[n].x;
        if (neighbours[n].weight > best && has_interreflections(f, i))
            best = neighbours[n].weight, from = i;
    }
    for (int t = 0; t < f->ninterreflections; t++)
        copy_footprints(f, &f->interreflections[t], p, from);
}

static void pool_hit(const RetexDenoiseFootprints *f, const RetexFootprintClass *g, const Pixel *p,
                     const RetexNeighbour *neighbours, int count)
{
    Pools pools;
    double all = 0;
    pool_class(&pools, f, g, 1, neighbours, count);
    for (int n = 0; n < count; n++)
        all +=
            neighbours[n].weight > NEGLIGIBLE && neighbours[n].weight < FOOTPRINT_VALUE_MAX ? neighbours[n].weight : 0;
    copy_footprints(f, g, p, p->at); /* its weight in a mixture is not changed, where it has one */
    if (pools.count)
        store_pool(&g->of[0], p, &pools.of[0], pools.of[0].uv.weight / all);
}

void retex_denoise_share_later(const RetexDenoiseFootprints *f, const RetexDenoiser *d, int x, int y,
                               const RetexNeighbour *neighbours, int count, RetexDenoisedRows *out)
{
    const Pixel p = pixel_at(f, out, x, y);
    if (!d->params.footprints)
        return;
    if (f->ninterreflections)
        keep_interreflections(f, &p, neighbours, count);
    for (int k = 0; k < f->nhits; k++)
        pool_hit(f, &f->hits[k], &p, neighbours, count);
}
