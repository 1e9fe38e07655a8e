/* Clusters of light in UV: gathers those of a block of pixels and merges them. See clusters.h. */
#include "compact/clusters.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "base/uv_pool.h"
#include "compact/uniform.h"
#include "set/set.h"

#define SHARE_STEP (1.0 / 512)   /* quantizer step of weights */
#define LEAST_SHARE (1.0 / 1024) /* clusters with a smaller share of their block's light are dropped */
#define WHOLE_NOISE 0.3          /* with less noise to be removed, quadrants keep their light, as ellipses */
#define MORE_VARIANCE 0.25       /* relative variance by which a cluster may grow when merged */
#define LITTLE_LIGHT 0.1         /* share of interreflected light up to which it has the weights of all light */
#define UNKNOWN_SAMPLES 1024     /* samples of a pixel, if the set does not have their number */
#define TEXEL (1.0 / (1 << 26))  /* UV variance of a texel of a texture 8192 wide */

typedef struct Pool {
    RetexUvPool uv;
    double noise;           /* RetexCompactLight's */
    double weight, squares; /* light gathered: sum, and sum of squares divided by the numbers of samples */
    RetexCompactClusterLight light[RETEX_UV_POOL + 1]; /* by the clusters' numbers */
    unsigned numbers;                                  /* bits of those that clusters have */
    double whole;                          /* weight of the pixel, if it is a parallelogram */
    RetexCompactClusterLight whole_light;
    const RetexFootprint *whole_as; /* its UV and axes */
} Pool;

typedef struct ClustersWork {
    RetexCompactClusters *clusters;
    const RetexCompactLight *light;
    const RetexCompactKind *kind;
    int scale, first; /* first: the strip's first row of blocks */
} ClustersWork;

static void add_light(RetexCompactClusterLight *to, const RetexCompactClusterLight *light)
{
    for (int c = 0; c < 3; c++) {
        to->single[c] += light->single[c];
        to->interreflected[c] += light->interreflected[c];
    }
}

static const RetexCompactClusterLight *light_of(const Pool *pool, int i)
{
    return &pool->light[pool->uv.of[i].number];
}

static void merge_light(void *context, int into, int from)
{
    Pool *pool = context;
    add_light(&pool->light[into], &pool->light[from]);
    pool->numbers &= ~(1u << from);
}

static void add_cluster(Pool *pool, const RetexUvStats *place, const RetexCompactClusterLight *light)
{
    int number = 0;
    while (pool->numbers >> number & 1)
        number++;
    pool->numbers |= 1u << number;
    pool->light[number] = *light;
    retex_uv_pool_add(&pool->uv, place, number);
}

/* Second moments of a cluster, plus those of a texel, which are negligible. */
typedef struct Shape {
    double uu, uv, vv, area;
} Shape;

static Shape shape_of(const RetexUvStats *place)
{
    Shape shape = {place->m2[0] / place->weight + TEXEL, place->m2[1] / place->weight,
                   place->m2[2] / place->weight + TEXEL, 0};
    shape.area = sqrt(fmax(shape.uu * shape.vv - shape.uv * shape.uv, 0));
    return shape;
}

/* Whether merging enlarges the variances along u and v, and the area, by at most a factor. */
static int are_same(const Shape *each, const Shape *merged, double more)
{
    int same = 1;
    for (int k = 0; k < 2; k++)
        same &=
            merged->uu <= more * each[k].uu && merged->vv <= more * each[k].vv && merged->area <= more * each[k].area;
    return same;
}

/* Whether two clusters are so alike that no texture shows whether they are merged. */
static int are_indistinguishable(const Pool *pool, int i, int j)
{
    const double more = 1 + pool->noise * MORE_VARIANCE;
    const RetexUvStats *const places[] = {&pool->uv.of[i].place, &pool->uv.of[j].place};
    RetexUvStats both = *places[0];
    retex_uv_stats_merge(&both, places[1], pool->uv.periodic);
    const Shape each[] = {shape_of(places[0]), shape_of(places[1])}, merged = shape_of(&both);
    for (int k = 0; k < 2; k++)
        if (each[k].uu > more * merged.uu || each[k].vv > more * merged.vv)
            return 0;
    return are_same(each, &merged, more);
}

static void merge_places(Pool *pool)
{
    for (int i = 1; i < pool->uv.count; i++)
        for (int j = 0; j < i; j++)
            if (are_indistinguishable(pool, i, j)) {
                retex_uv_pool_merge(&pool->uv, j, i);
                i = 0;
                break;
            }
}

/* Merge sharp clusters as long as one merging is expected to change the block less than its noise: light that comes
 * from where the texture is black or white as chance has it varies by its square over the number of samples. Where
 * less noise may be removed, far less than that. */
static void merge_within_noise(Pool *pool)
{
    const double most = pow(pool->noise, 6) * pool->squares;
    while (pool->uv.count > 1) {
        int first = 1, second = 0;
        double least = INFINITY;
        for (int i = 1; i < pool->uv.count; i++)
            for (int j = 0; j < i; j++) {
                const double error2 =
                    retex_uv_stats_shape_gain(&pool->uv.of[i].place, &pool->uv.of[j].place, pool->uv.periodic);
                if (error2 < least)
                    least = error2, first = i, second = j;
            }
        if (least > most)
            return;
        retex_uv_pool_merge(&pool->uv, second, first);
    }
}

static void remove_faint(Pool *pool)
{
    double all = pool->whole;
    for (int i = 0; i < pool->uv.count; i++)
        all += pool->uv.of[i].place.weight;
    for (int i = pool->uv.count - 1; i >= 0; i--)
        if (pool->uv.of[i].place.weight < pool->noise * LEAST_SHARE * all)
            retex_uv_pool_remove(&pool->uv, i);
}

/* ---- blocks ---- */

typedef struct Albedo {
    double sum[3], weight[3];
} Albedo;

/* Whether a footprint is a part of the pixel as a parallelogram: all such that share UV and axes. */
static int is_of_whole(const ClustersWork *work, const RetexFootprint *f, const Pool *pool)
{
    return work->clusters->whole >= 0 && retex_footprint_has_axes(work->light->set, f) &&
           (!pool->whole_as || (pool->whole_as->uv == f->uv && pool->whole_as->spread == f->spread));
}

static void gather_cluster(const ClustersWork *work, int k, size_t pixel, const RetexCompactClusterLight *light,
                           Pool *pool, Albedo *albedo)
{
    const RetexSet *set = work->light->set;
    const RetexFootprint *f = &set->footprints[work->kind->footprints[k]];
    const float *met = set->parts[f->albedo].image.pixels + 3 * pixel;
    float uv[3], spread[3];
    const double rgb[] = {light->single[0] + light->interreflected[0], light->single[1] + light->interreflected[1],
                          light->single[2] + light->interreflected[2]};
    const double weight = retex_compact_luminance(rgb);
    RetexUvStats place;
    retex_footprint_ellipse(set, f, pixel, uv, spread);
    if (!(uv[2] > 0) || !(weight > 0) || !isfinite(weight))
        return;
    if (is_of_whole(work, f, pool)) {
        pool->whole_as = f;
        pool->whole += weight;
        add_light(&pool->whole_light, light);
    } else {
        retex_uv_stats_load(&place, weight, uv, spread);
        add_cluster(pool, &place, light);
    }
    pool->weight += weight;
    pool->squares += weight * weight / ((double)uv[2] * (set->spp > 0 ? set->spp : UNKNOWN_SAMPLES));
    for (int c = 0; c < 3; c++) {
        albedo->sum[c] += rgb[c] * (double)met[c];
        albedo->weight[c] += rgb[c];
    }
}

/* Sum of the weights of all targets' interreflection footprints in a pixel; their shares are relative to this sum. */
static double sum_of_shares(const RetexCompactLight *light, size_t pixel)
{
    const RetexSet *set = light->set;
    double sum = 0;
    for (int i = 0; i < light->nkinds; i++) {
        const RetexCompactKind *kind = &light->kinds[i];
        for (int k = 0; k < kind->count && kind->kind == RETEX_FOOTPRINT_INTERREFLECTION; k++)
            if (set->parts[set->footprints[kind->footprints[k]].uv].image.pixels[3 * pixel + 2] > 0)
                sum += kind->share[k] >= 0 ? (double)set->parts[kind->share[k]].image.pixels[pixel] : 1;
    }
    return sum;
}

/* Light of all terms with interreflections, without that of single lamps, which it has, divided among interreflection
 * footprints by their shares. */
static double interreflected_light(const ClustersWork *work, size_t pixel,
                                   RetexCompactClusterLight of[RETEX_SHARES_MAX])
{
    const RetexSet *set = work->light->set;
    const double sum = sum_of_shares(work->light, pixel);
    double interreflected = 0;
    for (int i = 0; i < set->nterms; i++) {
        const float grey = work->light->greys[i];
        if (grey == 0 || work->light->lamps[work->light->lamps_of[i]].alone)
            continue;
        const float *rgb = set->parts[set->terms[i].radiance].image.pixels + 3 * pixel;
        const double *value = work->light->lamps[work->light->lamps_of[i]].value;
        interreflected += retex_compact_luminance((const double[3]){value[0] * (double)(grey * rgb[0]),
                                                                    value[1] * (double)(grey * rgb[1]),
                                                                    value[2] * (double)(grey * rgb[2])});
    }
    for (int k = 0; k < work->kind->count; k++) {
        const int share = work->kind->share[k];
        const double part = share >= 0 ? (double)set->parts[share].image.pixels[pixel] : 1;
        const double weight = sum > 0 ? interreflected * part / sum : 0;
        of[k] = (RetexCompactClusterLight){.interreflected = {weight, weight, weight}};
    }
    return interreflected;
}

/* Gather all clusters of a block. Returns the light that weights are relative to: that of all targets for
 * interreflection footprints, which are weighted across targets; else 0, for their own sum. */
static double gather_block(const ClustersWork *work, int bx, int by, Pool *pool, Albedo *albedo)
{
    const RetexSet *set = work->light->set;
    RetexCompactClusterLight light[RETEX_SHARES_MAX];
    double all = 0;
    for (int y = by * work->scale; y < (by + 1) * work->scale && y < set->height; y++)
        for (int x = bx * work->scale; x < (bx + 1) * work->scale && x < set->width; x++) {
            const size_t pixel = (size_t)y * (size_t)set->width + (size_t)x;
            if (work->kind->kind == RETEX_FOOTPRINT_INTERREFLECTION)
                all += interreflected_light(work, pixel, light);
            else
                retex_compact_cluster_light(work->light, work->kind, RETEX_COMPACT_ALL_LAMPS, pixel, light);
            for (int k = 0; k < work->kind->count; k++)
                gather_cluster(work, k, pixel, &light[k], pool, albedo);
        }
    return all;
}

/* The light that a weight is a share of. */
typedef enum Part { PART_ALL, PART_SINGLE, PART_INTERREFLECTED } Part;

/* That of cluster i; -1: of the whole pixel. */
static double part_of(const Pool *pool, int i, Part part)
{
    const RetexCompactClusterLight *light = i < 0 ? &pool->whole_light : light_of(pool, i);
    return part == PART_SINGLE           ? retex_compact_luminance(light->single)
           : part == PART_INTERREFLECTED ? retex_compact_luminance(light->interreflected)
           : i < 0                       ? pool->whole
                                         : pool->uv.of[i].place.weight;
}

/* A share as it is stored: positive ones never round to 0. */
static float rounded_share(double part, double all)
{
    const double share = all > 0 ? part / all : 0;
    return share > 0 ? (float)(fmax(rint(share / SHARE_STEP), 1) * SHARE_STEP) : 0;
}

/* Store each cluster's share of the light `part`, relative to `all`, or to the clusters' own sum if `all` is 0. If the
 * clusters have no such light, store their shares of all light instead. */
static void store_weights(RetexImage *images, int whole, size_t block, const Pool *pool, Part part, double all)
{
    double own = part_of(pool, -1, part);
    for (int i = 0; i < pool->uv.count; i++)
        own += part_of(pool, i, part);
    if (!(all > 0))
        all = own;
    for (int i = 0; i < pool->uv.count; i++)
        images[i].pixels[block] = rounded_share(part_of(pool, i, part), all);
    if (whole >= 0)
        images[whole].pixels[block] = rounded_share(part_of(pool, -1, part), all);
    if (!(all > 0) && part != PART_ALL)
        store_weights(images, whole, block, pool, PART_ALL, 0);
}

/* Copy the UV and the axes that the set has of a whole pixel. */
static void store_whole(const ClustersWork *work, size_t block, const RetexFootprint *f)
{
    const int whole = work->clusters->whole;
    const RetexPart *parts = work->light->set->parts;
    const size_t pixel = block - (size_t)work->first * (size_t)parts[f->uv].image.width;
    float *uv = work->clusters->uv[whole].pixels + 3 * block;
    memcpy(uv, parts[f->uv].image.pixels + 3 * pixel, 2 * sizeof *uv);
    uv[2] = 1;
    memcpy(work->clusters->spread[whole].pixels + RETEX_AXES * block,
           parts[f->spread].image.pixels + RETEX_AXES * pixel, RETEX_AXES * sizeof *uv);
}

static void sum_light(const ClustersWork *work, int row, const Pool *pool)
{
    for (int i = -1; i < pool->uv.count && work->clusters->split; i++) {
        work->clusters->further[row] += part_of(pool, i, PART_INTERREFLECTED);
        work->clusters->all[row] += part_of(pool, i, PART_ALL);
    }
}

static void store_block(const ClustersWork *work, size_t block, const Pool *pool, double all, const Albedo *albedo)
{
    RetexCompactClusters *clusters = work->clusters;
    double sum = 0, weights = 0;
    for (int i = 0; i < pool->uv.count; i++) {
        float *uv = clusters->uv[i].pixels + 3 * block;
        retex_uv_stats_store(&pool->uv.of[i].place, uv, clusters->spread[i].pixels + 3 * block);
        uv[2] = 1;
    }
    if (pool->whole_as)
        store_whole(work, block, pool->whole_as);
    store_weights(clusters->weight, clusters->whole, block, pool, clusters->split ? PART_SINGLE : PART_ALL, all);
    if (clusters->split)
        store_weights(clusters->interreflected, clusters->whole, block, pool, PART_INTERREFLECTED, 0);
    for (int c = 0; c < 3; c++)
        sum += albedo->sum[c], weights += albedo->weight[c];
    for (int c = 0; c < 3; c++)
        clusters->albedo.pixels[3 * block + (size_t)c] =
            (float)(albedo->weight[c] > 0 ? albedo->sum[c] / albedo->weight[c]
                    : weights > 0         ? sum / weights
                                          : 0);
}

/* Store the sum of a pixel's clusters as a candidate of uniform pixels. A pixel with several clusters is one only if
 * the kind has four, for quarters. */
static void store_pixel(const ClustersWork *work, size_t block, const Pool *pool)
{
    RetexUniformPixel *pixel = &work->clusters->pixels[block];
    if (pool->whole_as) {
        const float *uv = work->clusters->uv[work->clusters->whole].pixels + 3 * block;
        *pixel = (RetexUniformPixel){{(double)uv[0], (double)uv[1]}, {0, 0, 0}, RETEX_UNIFORM_EXACT};
        return;
    }
    if (pool->uv.count == 0 || (pool->uv.count > 1 && work->clusters->count < 4))
        return;
    RetexUvStats sum = pool->uv.of[0].place;
    for (int i = 1; i < pool->uv.count; i++)
        retex_uv_stats_merge(&sum, &pool->uv.of[i].place, pool->uv.periodic);
    for (int k = 0; k < 2; k++)
        pixel->mean[k] = sum.mean[k];
    for (int k = 0; k < 3; k++)
        pixel->variances[k] = (float)(sum.m2[k] / sum.weight);
    pixel->samples = (float)(pool->weight * pool->weight / pool->squares);
}

static void blocks_job(void *context, int by, int thread)
{
    const ClustersWork *work = context;
    const int width = work->clusters->albedo.width;
    (void)thread;
    for (int bx = 0; bx < width; bx++) {
        const size_t block = (size_t)(work->first + by) * (size_t)width + (size_t)bx;
        Pool pool = {.noise = work->light->noise};
        pool.uv = (RetexUvPool){.periodic = work->light->set->targets[work->kind->target].periodic,
                                .sharp = work->kind->kind == RETEX_FOOTPRINT_SHARP,
                                .merged = merge_light,
                                .context = &pool};
        Albedo albedo = {0};
        const double all = gather_block(work, bx, by, &pool, &albedo);
        remove_faint(&pool);
        while (pool.uv.count > work->kind->count)
            retex_uv_pool_merge_cheapest(&pool.uv);
        merge_places(&pool);
        if (pool.uv.sharp)
            merge_within_noise(&pool);
        retex_uv_pool_sort(&pool.uv);
        sum_light(work, work->first + by, &pool);
        store_block(work, block, &pool, all, &albedo);
        if (work->clusters->pixels)
            store_pixel(work, block, &pool);
        work->clusters->lit[block] = pool.uv.count > 0 || pool.whole_as;
    }
}

/* Copy a block. weight: factor on its weights, small for interreflections, because other targets may have light
 * there. */
static void copy_block(RetexCompactClusters *clusters, size_t to, size_t from, float weight)
{
    for (int k = 0; k < clusters->count; k++) {
        memcpy(clusters->uv[k].pixels + 3 * to, clusters->uv[k].pixels + 3 * from, 3 * sizeof(float));
        memcpy(clusters->spread[k].pixels + 3 * to, clusters->spread[k].pixels + 3 * from, 3 * sizeof(float));
        clusters->weight[k].pixels[to] = weight * clusters->weight[k].pixels[from];
        if (clusters->interreflected[k].pixels)
            clusters->interreflected[k].pixels[to] = clusters->interreflected[k].pixels[from];
    }
    memcpy(clusters->albedo.pixels + 3 * to, clusters->albedo.pixels + 3 * from, 3 * sizeof(float));
}

/* Fill blocks without light from a lit neighbour: left or right, else above or below, else diagonal. */
static void fill_holes(RetexCompactClusters *clusters, const unsigned char *lit, float weight)
{
    static const int beside[8][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    const int width = clusters->albedo.width, height = clusters->albedo.height;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int k = 0; k < 8 && !lit[y * width + x]; k++) {
                const int nx = x + beside[k][0], ny = y + beside[k][1];
                if (nx < 0 || ny < 0 || nx >= width || ny >= height || !lit[ny * width + nx])
                    continue;
                copy_block(clusters, (size_t)(y * width + x), (size_t)(ny * width + nx), weight);
                break;
            }
}

/* ---- all blocks ---- */

static int alloc_images(RetexCompactClusters *clusters, const RetexCompactLight *light, RetexError *err)
{
    const int scale = clusters->scale;
    const int width = (light->set->width + scale - 1) / scale, height = (light->set->height + scale - 1) / scale;
    const size_t blocks = (size_t)width * (size_t)height;
    const int count = clusters->whole >= 0 ? clusters->whole + 1 : clusters->count;
    int code = retex_image_alloc(&clusters->albedo, width, height, 3, err);
    for (int k = 0; k < count && !code; k++) {
        code = retex_image_alloc(&clusters->uv[k], width, height, 3, err);
        if (!code)
            code = retex_image_alloc(&clusters->spread[k], width, height, k == clusters->whole ? RETEX_AXES : 3, err);
        if (!code)
            code = retex_image_alloc(&clusters->weight[k], width, height, 1, err);
        if (!code && clusters->split)
            code = retex_image_alloc(&clusters->interreflected[k], width, height, 1, err);
    }
    clusters->lit = calloc(blocks, sizeof *clusters->lit);
    clusters->pixels = clusters->whole >= 0 ? calloc(blocks, sizeof *clusters->pixels) : NULL;
    clusters->further = calloc((size_t)height, sizeof *clusters->further);
    clusters->all = calloc((size_t)height, sizeof *clusters->all);
    if (!code &&
        (!clusters->lit || !clusters->further || !clusters->all || (clusters->whole >= 0 && !clusters->pixels)))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory for footprints");
    return code;
}

static void free_work(RetexCompactClusters *clusters)
{
    free(clusters->lit);
    free(clusters->pixels);
    free(clusters->further);
    free(clusters->all);
    clusters->further = clusters->all = NULL;
    clusters->lit = NULL;
    clusters->pixels = NULL;
}

static void free_cluster(RetexCompactClusters *clusters, int k)
{
    retex_image_free(&clusters->uv[k]);
    retex_image_free(&clusters->spread[k]);
    retex_image_free(&clusters->weight[k]);
    retex_image_free(&clusters->interreflected[k]);
}

static int is_empty(const RetexCompactClusters *clusters, int k)
{
    const size_t blocks = (size_t)clusters->uv[k].width * (size_t)clusters->uv[k].height;
    for (size_t i = 0; i < blocks; i++)
        if (clusters->uv[k].pixels[3 * i + 2] > 0)
            return 0;
    return 1;
}

int retex_compact_clusters_begin(RetexCompactClusters *clusters, const RetexCompactLight *light,
                                 const RetexCompactKind *kind, int scale, RetexError *err)
{
    const int sharp = kind->kind == RETEX_FOOTPRINT_SHARP;
    const int whole = sharp && scale == 1 && light->noise >= WHOLE_NOISE && strcmp(light->set->filter, "box") == 0 &&
                      kind->count < RETEX_SHARES_MAX;
    *clusters = (RetexCompactClusters){.count = kind->count,
                                       .whole = whole ? kind->count : -1,
                                       .scale = scale,
                                       .split = kind->ninterreflections && (sharp || !(light->noise > 0))};
    int code = alloc_images(clusters, light, err);
    if (code)
        retex_compact_clusters_free(clusters);
    return code;
}

void retex_compact_clusters_rows(RetexCompactClusters *clusters, const RetexCompactLight *light,
                                 const RetexCompactKind *kind, int first, int nthreads)
{
    const int scale = clusters->scale;
    ClustersWork work = {clusters, light, kind, scale, first / scale};
    retex_parallel(nthreads, (light->set->height + scale - 1) / scale, blocks_job, &work);
}

/* Give interreflected light no weights of its own where there is little of it. */
static void join_little_light(RetexCompactClusters *clusters, double noise)
{
    double further = 0, all = 0;
    for (int y = 0; y < clusters->albedo.height; y++)
        further += clusters->further[y], all += clusters->all[y];
    for (int k = 0; k < RETEX_SHARES_MAX && further <= noise * LITTLE_LIGHT * all; k++)
        retex_image_free(&clusters->interreflected[k]);
}

/* Leave out clusters that no pixel has, and count that of whole pixels, behind all others. */
static void count_clusters(RetexCompactClusters *clusters)
{
    const int whole = clusters->whole;
    while (clusters->count > 1 && is_empty(clusters, clusters->count - 1))
        free_cluster(clusters, --clusters->count);
    clusters->whole = -1;
    if (whole < 0)
        return;
    if (is_empty(clusters, whole)) {
        free_cluster(clusters, whole);
        return;
    }
    RetexImage *const images[] = {clusters->uv, clusters->spread, clusters->weight, clusters->interreflected};
    clusters->whole = clusters->count++;
    for (int i = 0; i < 4 && clusters->whole != whole; i++) {
        images[i][clusters->whole] = images[i][whole];
        images[i][whole] = (RetexImage){0};
    }
}

int retex_compact_clusters_end(RetexCompactClusters *clusters, const RetexCompactLight *light,
                               const RetexCompactKind *kind, int nthreads, RetexError *err)
{
    const int *periodic = light->set->targets[kind->target].periodic;
    int code = RETEX_OK;
    if (clusters->pixels)
        code = retex_compact_smooth_uniform(clusters, clusters->pixels, periodic, light->noise, nthreads, err);
    if (clusters->pixels && !code)
        code = retex_compact_split_uneven(clusters, periodic, nthreads, err);
    if (clusters->scale > 1)
        fill_holes(clusters, clusters->lit, kind->kind == RETEX_FOOTPRINT_INTERREFLECTION ? (float)SHARE_STEP : 1);
    if (clusters->split)
        join_little_light(clusters, light->noise);
    free_work(clusters);
    count_clusters(clusters);
    if (code)
        retex_compact_clusters_free(clusters);
    return code;
}

void retex_compact_clusters_free(RetexCompactClusters *clusters)
{
    for (int k = 0; k < RETEX_SHARES_MAX; k++)
        free_cluster(clusters, k);
    retex_image_free(&clusters->albedo);
    free_work(clusters);
    clusters->count = 0;
}
