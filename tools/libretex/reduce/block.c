/* Merges the footprints of a block of pixels, with their light. See block.h.
 *
 * Each pixel's footprint is a cluster of light in UV. Those of a kind are merged by cheapest pair until the reduced
 * pixel has room for them; each takes its light, of every term, and its weights along. Where a surface fills the block,
 * seen sharply, the pixels' parallelograms become the block's. */
#include "reduce/block.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color.h>
#include <retex/host/rounding.h>

#include "base/uv_pool.h"
#include "set/set.h"
#include "set/strip.h"

#define PIXELS (RETEX_REDUCE_SIDE * RETEX_REDUCE_SIDE)
#define MOST_BEND 0.25              /* of a pixel's extent, by which pixels may be off a block's parallelogram */
#define UV_STEP (1.0 / 64)          /* of a block's extent, to which the place of its parallelogram is rounded */
#define UV_FINEST (1.0 / (1 << 20)) /* but not finer */

/* A footprint of a pixel of the block. */
typedef struct Source {
    int pixel, member; /* number of the pixel in the block; member of its kind */
    int into;          /* the source that it was merged into, itself where it was not */
    int to;            /* of a source that was not merged: the member that it goes to; -1: none */
    float uv[3], spread[3];
    double light[3];
} Source;

struct RetexReduceScratch {
    double share[RETEX_MIXTURES_MAX][PIXELS][3]; /* by weights and pixel: what a weight is multiplied by */
    double light[RETEX_MIXTURES_MAX];            /* sums of the light that weights divide; 0: there is none */
    int nsources;
    Source sources[PIXELS * RETEX_SHARES_MAX];
};

RetexReduceScratch *retex_reduce_scratch_create(void)
{
    return malloc(sizeof(RetexReduceScratch));
}

/* ---- pixels ---- */

static int count_of(const RetexReduceBlock *block)
{
    return block->width * block->height;
}

static const float *pixel_of(const RetexReduceBlock *block, int part, int pixel)
{
    const int x = block->x + pixel % block->width, y = block->y + pixel / block->width;
    return retex_pixel_at(block->rows, part, (size_t)y * (size_t)block->rows->width + (size_t)x);
}

static float *made_pixel(const RetexReduceBlock *block, int part)
{
    return retex_pixel_at(block->plan->reduced, part, block->to);
}

static double luminance_of(const RetexReduceBlock *block, const RetexReduceLight *light, int count, int pixel)
{
    double sum[3] = {0};
    for (int i = 0; i < count; i++) {
        const float *rgb = pixel_of(block, light[i].part, pixel);
        for (int c = 0; c < 3; c++)
            sum[c] += light[i].value[c] * (double)rgb[c];
    }
    const double all = retex_luminance(sum[0], sum[1], sum[2]);
    return all > 0 && isfinite(all) ? all : 0;
}

static void average(const RetexReduceBlock *block, int part, int made)
{
    const int channels = block->rows->parts[part].image.channels;
    for (int c = 0; c < channels; c++) {
        double sum = 0;
        for (int i = 0; i < count_of(block); i++)
            sum += (double)pixel_of(block, part, i)[c];
        made_pixel(block, made)[c] = (float)(sum / count_of(block));
    }
}

static void copy_centre(const RetexReduceBlock *block, int part, int made)
{
    const int centre = block->height / 2 * block->width + block->width / 2;
    memcpy(made_pixel(block, made), pixel_of(block, part, centre),
           (size_t)block->rows->parts[part].image.channels * sizeof(float));
}

/* ---- weights ---- */

/* Weights are shares of the light that they divide, pixel by pixel: find what makes them this light. Without any light
 * they count as if all pixels had the same. */
static void find_shares(const RetexReduceBlock *block, RetexReduceScratch *scratch, int number)
{
    const RetexReduceWeights *weights = &block->plan->weights[number];
    double light[PIXELS], all = 0;
    for (int i = 0; i < count_of(block); i++)
        all += light[i] = luminance_of(block, weights->light, weights->nlight, i);
    scratch->light[number] = all;
    for (int i = 0; i < count_of(block); i++) {
        double sum[3] = {0};
        for (int k = 0; k < weights->nparts; k++) {
            const int channels = block->rows->parts[weights->parts[k]].image.channels;
            for (int c = 0; c < 3; c++)
                sum[c] += (double)pixel_of(block, weights->parts[k], i)[channels == 3 ? c : 0];
        }
        for (int c = 0; c < 3; c++)
            scratch->share[number][i][c] = sum[c] > 0 ? (all > 0 ? light[i] : 1) / sum[c] : 0;
    }
}

/* What a column has of a source: its light, or its weight times the light that this divides. */
static void column_of(const RetexReduceBlock *block, const RetexReduceScratch *scratch, const RetexReduceColumn *column,
                      const Source *source, double of[3])
{
    const int part = column->from[source->member];
    for (int c = 0; c < 3; c++)
        of[c] = part < 0 ? 0 : (double)pixel_of(block, part, source->pixel)[column->channels == 3 ? c : 0];
    for (int c = 0; c < 3 && column->weights >= 0; c++)
        of[c] *= scratch->share[column->weights][source->pixel][c];
}

/* ---- sources ---- */

static void find_light(const RetexReduceBlock *block, const RetexReduceScratch *scratch, const RetexReduceKind *kind,
                       Source *source)
{
    const double alone = luminance_of(block, kind->light, kind->nlight, source->pixel);
    for (int c = 0; c < 3; c++)
        source->light[c] = alone;
    for (int i = 0; i < kind->ncolumns; i++) {
        const RetexReduceColumn *column = &kind->columns[i];
        double of[3];
        column_of(block, scratch, column, source, of);
        for (int c = 0; c < 3; c++)
            source->light[c] += column->weights < 0                   ? column->value[c] * of[c]
                                : scratch->light[column->weights] > 0 ? of[c]
                                                                      : 0;
    }
}

static double weight_of(const Source *source)
{
    const double weight = retex_luminance(source->light[0], source->light[1], source->light[2]);
    return weight > 0 && isfinite(weight) ? weight : 0;
}

/* Gather the footprints of a kind. If none has light, their coverage counts. */
static void gather(const RetexReduceBlock *block, RetexReduceScratch *scratch, const RetexReduceKind *kind)
{
    double all = 0;
    int count = 0;
    for (int i = 0; i < count_of(block); i++)
        for (int k = 0; k < kind->count; k++) {
            const RetexFootprint *f = &block->rows->footprints[kind->from[k]];
            Source *source = &scratch->sources[count];
            if (!(pixel_of(block, f->uv, i)[2] > 0))
                continue;
            const int x = block->x + i % block->width, y = block->y + i / block->width;
            *source = (Source){.pixel = i, .member = k, .into = count, .to = -1};
            retex_footprint_ellipse(block->rows, f, (size_t)y * (size_t)block->rows->width + (size_t)x, source->uv,
                                    source->spread);
            find_light(block, scratch, kind, source);
            all += weight_of(source);
            count++;
        }
    scratch->nsources = 0;
    for (int i = 0; i < count; i++) {
        Source *source = &scratch->sources[i];
        for (int c = 0; c < 3 && !(all > 0); c++)
            source->light[c] = (double)source->uv[2];
        if (weight_of(source) > 0) {
            scratch->sources[scratch->nsources] = *source;
            scratch->sources[scratch->nsources].into = scratch->nsources;
            scratch->nsources++;
        }
    }
}

/* ---- parallelograms ---- */

/* A block's parallelogram: its middle, and its pixels' axes. */
typedef struct Map {
    double uv[2], axes[RETEX_AXES];
    double coverage; /* sum over pixels */
    int pixels;      /* that have one */
} Map;

/* Steps of pixels from the block's middle to that of a pixel. */
static void steps_to(const RetexReduceBlock *block, int pixel, double steps[2])
{
    steps[0] = pixel % block->width + 0.5 - 0.5 * block->width;
    steps[1] = pixel / block->width + 0.5 - 0.5 * block->height;
}

static Map find_map(const RetexReduceBlock *block, const RetexReduceKind *kind)
{
    const RetexFootprint *f = &block->rows->footprints[kind->from[kind->map[0]]];
    const int *periodic = block->rows->targets[kind->target].periodic;
    double first[2] = {0};
    Map map = {.pixels = 0};
    for (int i = 0; i < count_of(block); i++) {
        const float *uv = pixel_of(block, f->uv, i), *axes = pixel_of(block, f->spread, i);
        double steps[2];
        if (!(uv[2] > 0))
            continue;
        steps_to(block, i, steps);
        for (int k = 0; k < 2; k++) {
            first[k] = map.pixels ? first[k] : (double)uv[k];
            map.uv[k] += retex_uv_stats_difference((double)uv[k], first[k], periodic[k]) - steps[0] * (double)axes[k] -
                         steps[1] * (double)axes[2 + k];
        }
        for (int k = 0; k < RETEX_AXES; k++)
            map.axes[k] += (double)axes[k];
        map.coverage += (double)uv[2];
        map.pixels++;
    }
    for (int k = 0; k < RETEX_AXES && map.pixels; k++)
        map.axes[k] /= map.pixels;
    for (int k = 0; k < 2 && map.pixels; k++)
        map.uv[k] = first[k] + map.uv[k] / map.pixels;
    return map;
}

/* Whether a surface fills the block, and its pixels lie in it as in one parallelogram. */
static int is_even(const RetexReduceBlock *block, const RetexReduceKind *kind, const Map *map)
{
    const RetexFootprint *f = &block->rows->footprints[kind->from[kind->map[0]]];
    const int *periodic = block->rows->targets[kind->target].periodic;
    int even = map->pixels == count_of(block);
    for (int i = 0; i < count_of(block) && even; i++) {
        const float *uv = pixel_of(block, f->uv, i);
        double steps[2];
        steps_to(block, i, steps);
        for (int k = 0; k < 2; k++) {
            const double there = map->uv[k] + steps[0] * map->axes[k] + steps[1] * map->axes[2 + k];
            const double extent = fabs(map->axes[k]) + fabs(map->axes[2 + k]);
            even &= fabs(retex_uv_stats_difference((double)uv[k], there, periodic[k])) <= MOST_BEND * extent;
        }
    }
    return even;
}

/* The member of the block's quarter that a pixel's quarter is in. */
static int quarter_member(const RetexReduceBlock *block, const RetexReduceKind *kind, const Source *source)
{
    const int quadrant = block->rows->footprints[kind->from[source->member]].quadrant - 1;
    const int x = 2 * (source->pixel % block->width) + (quadrant & 1 && quadrant >= 0);
    const int y = 2 * (source->pixel / block->width) + (quadrant & 2 && quadrant >= 0);
    return kind->map[(x >= block->width) + 2 * (y >= block->height)];
}

static void store_map(const RetexReduceBlock *block, const RetexReduceKind *kind, const Map *map)
{
    const RetexFootprint *f = &block->plan->reduced->footprints[kind->to[kind->map[0]]];
    const int *periodic = block->rows->targets[kind->target].periodic;
    float *uv = made_pixel(block, f->uv), *axes = made_pixel(block, f->spread);
    for (int k = 0; k < 2; k++) {
        const double extent = fabs(map->axes[k]) * block->width + fabs(map->axes[2 + k]) * block->height;
        const double mean = periodic[k] ? map->uv[k] - floor(map->uv[k]) : map->uv[k];
        uv[k] = (float)retex_round_to(mean, fmax(UV_STEP * extent, UV_FINEST)) + 0.0f; /* no -0 */
        axes[k] = (float)(map->axes[k] * block->width);
        axes[2 + k] = (float)(map->axes[2 + k] * block->height);
    }
    uv[2] = retex_round_coverage(fmin(map->coverage / count_of(block), 1));
}

/* Give the light of parallelograms to that of the block, if it is one, or nothing else is there for it. */
static int place_map(const RetexReduceBlock *block, RetexReduceScratch *scratch, const RetexReduceKind *kind)
{
    if (kind->map[0] < 0)
        return 0;
    const Map map = find_map(block, kind);
    if (!map.pixels || (kind->nellipses && !is_even(block, kind, &map)))
        return 0;
    store_map(block, kind, &map);
    for (int i = 0; i < scratch->nsources; i++) {
        Source *source = &scratch->sources[i];
        if (retex_footprint_has_axes(block->rows, &block->rows->footprints[kind->from[source->member]]))
            source->to = quarter_member(block, kind, source);
    }
    return 1;
}

/* ---- merging ---- */

static void merge_sources(void *context, int into, int from)
{
    RetexReduceScratch *scratch = context;
    scratch->sources[from].into = into;
}

/* The member that a source's light goes to. */
static int member_of(const RetexReduceScratch *scratch, int source)
{
    while (scratch->sources[source].into != source)
        source = scratch->sources[source].into;
    return scratch->sources[source].to;
}

/* Merge what is not in parallelograms until there is a member for each cluster, and store the clusters. */
static void merge(const RetexReduceBlock *block, RetexReduceScratch *scratch, const RetexReduceKind *kind)
{
    RetexUvPool pool = {.periodic = block->rows->targets[kind->target].periodic,
                        .sharp = kind->kind == RETEX_FOOTPRINT_SHARP,
                        .merged = merge_sources,
                        .context = scratch};
    double coverage[RETEX_SHARES_MAX] = {0};
    for (int i = 0; i < scratch->nsources; i++) {
        const Source *source = &scratch->sources[i];
        RetexUvStats place;
        retex_uv_stats_load(&place, weight_of(source), source->uv, source->spread);
        if (source->to < 0)
            retex_uv_pool_add(&pool, &place, i);
    }
    while (pool.count > kind->nellipses)
        retex_uv_pool_merge_cheapest(&pool);
    retex_uv_pool_sort(&pool);
    for (int k = 0; k < pool.count; k++)
        scratch->sources[pool.of[k].number].to = kind->ellipses[k];
    for (int i = 0; i < scratch->nsources; i++)
        coverage[member_of(scratch, i)] += (double)scratch->sources[i].uv[2];
    for (int k = 0; k < pool.count; k++) {
        const RetexFootprint *f = &block->plan->reduced->footprints[kind->to[kind->ellipses[k]]];
        float *uv = made_pixel(block, f->uv);
        retex_uv_stats_store(&pool.of[k].place, uv, made_pixel(block, f->spread));
        uv[2] = retex_round_coverage(fmin(coverage[kind->ellipses[k]] / count_of(block), 1));
    }
}

/* ---- light and albedo ---- */

/* The sum over a member's sources. Light is the mean over pixels, weights are shares of all light that they divide. */
static void store_column(const RetexReduceBlock *block, const RetexReduceScratch *scratch, const RetexReduceKind *kind,
                         const RetexReduceColumn *column)
{
    double sums[RETEX_SHARES_MAX][3] = {{0}};
    const double light = column->weights < 0 ? 0 : scratch->light[column->weights];
    const double all = column->weights >= 0 && light > 0 ? light : count_of(block);
    for (int i = 0; i < scratch->nsources; i++) {
        double of[3];
        column_of(block, scratch, column, &scratch->sources[i], of);
        for (int c = 0; c < 3; c++)
            sums[member_of(scratch, i)][c] += of[c];
    }
    for (int k = 0; k < kind->count; k++)
        for (int c = 0; c < column->channels; c++) {
            const double sum = sums[k][c] / all;
            made_pixel(block, column->to[k])[c] = column->weights >= 0 && sum > 0 ? retex_round_share(sum) : (float)sum;
        }
}

static void store_albedo(const RetexReduceBlock *block, const RetexReduceScratch *scratch, const RetexReduceKind *kind)
{
    double sums[RETEX_SHARES_MAX][3] = {{0}}, light[RETEX_SHARES_MAX][3] = {{0}};
    for (int i = 0; i < scratch->nsources; i++) {
        const Source *source = &scratch->sources[i];
        const RetexFootprint *from = &block->rows->footprints[kind->from[source->member]];
        const float *albedo = pixel_of(block, from->albedo, source->pixel);
        const int member = kind->albedo_of[member_of(scratch, i)];
        for (int c = 0; c < 3; c++) {
            sums[member][c] += source->light[c] * (double)albedo[c];
            light[member][c] += source->light[c];
        }
    }
    for (int k = 0; k < kind->count; k++)
        for (int c = 0; c < 3 && kind->albedo_of[k] == k; c++)
            made_pixel(block, block->plan->reduced->footprints[kind->to[k]].albedo)[c] =
                (float)(light[k][c] > 0 ? sums[k][c] / light[k][c] : 0);
}

/* ---- all of it ---- */

void retex_reduce_block(const RetexReduceBlock *block, RetexReduceScratch *scratch)
{
    const RetexReducePlan *plan = block->plan;
    for (int i = 0; i < block->rows->nparts; i++)
        if (plan->rules[i] == RETEX_REDUCE_MEAN)
            average(block, i, plan->to[i]);
        else if (plan->rules[i] == RETEX_REDUCE_CENTRE)
            copy_centre(block, i, plan->to[i]);
    for (int i = 0; i < plan->nweights; i++)
        find_shares(block, scratch, i);
    for (int i = 0; i < plan->nkinds; i++) {
        const RetexReduceKind *kind = &plan->kinds[i];
        gather(block, scratch, kind);
        place_map(block, scratch, kind);
        merge(block, scratch, kind);
        for (int k = 0; k < kind->ncolumns; k++)
            store_column(block, scratch, kind, &kind->columns[k]);
        store_albedo(block, scratch, kind);
    }
}
