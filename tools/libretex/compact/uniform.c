/* See uniform.h. A pixel that sees one surface directly covers a parallelogram in UV, which the mean UV of the pixels
 * around it predict. Its clusters are some partition of its samples, weighted by light, so a few bright samples may
 * outweigh all others. This noise costs more bytes than all else in sharp footprints, and denoising of light does not
 * remove it. With more samples the clusters would converge to the quarters of the parallelogram, which vary smoothly
 * and compress to almost nothing. A pixel is uniform if its mean UV lies as near to the map fitted to its neighbours as
 * its number of samples n makes likely: the variance of the mean is that of the parallelogram divided by n.
 *
 * Near a horizon UV grow without bound, which quadratics cannot follow: five pixels below it their steps are a seventh
 * too long. In perspective, the UV of a plane are linear functions divided by a common linear function, the depth. So
 * where the curvature of both axes fits one depth, the maps are quadratics divided by it. */
#include "compact/uniform.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/assert.h>
#include <retex/parallel.h>

#include "set/steps.h"
#include "texture/filter.h"

#define TEXEL (1.0 / (1 << 26))   /* UV variance of a texel of a texture 8192 wide */
#define DISTANCE_DEVIATIONS_MAX 3 /* largest distance of a mean from its map, in standard deviations, */
#define DISTANCE_TOLERANCE 0.02   /* plus this many pixels */
/* Of independent samples: the median squared distance from a map that is fitted to them, relative to their mean squared
 * distance from the true map. */
#define DISTANCE_MEDIAN 0.55
#define VARIANCE_DEVIATIONS_MAX 3 /* largest relative error of a variance, times the root of the number of samples, */
#define VARIANCE_TOLERANCE 0.4    /* or this, if larger */
#define CORRELATION_TOLERANCE 0.3 /* the same for covariances, relative to the geometric mean of the variances */
#define CLUSTER_DISTANCE_MAX 0.75 /* of a cluster from the pixel's centre, in pixels along each side */
#define FIRST_FIT_FACTOR 9        /* by which the squared limit of distances is larger for the first map */
/* Change of depth per pixel. A smaller one changes UV steps by only half a percent; with the largest one the depth at a
 * corner of the window is a fifth. */
#define DEPTH_SLOPE_MIN 0.04
#define DEPTH_SLOPE_MAX 0.4
#define DEPTH_CURVATURE_MAX 0.25   /* of the map that remains with a depth, relative to the squared depth */
#define SMOOTHED_DISTANCE_MAX 0.02 /* largest squared distance of smoothed means from the last map, in pixels */
enum { RADIUS = 2, SIDE = 2 * RADIUS + 1, FITTED_MIN = 12, PASSES = 3 /* of fitting */ };

/* ---- the map ---- */

/* UV around a pixel, relative to its own mean, times depth: coefficients of a quadratic in pixels for each axis. */
enum { CONSTANT, RIGHT, DOWN, RIGHT_RIGHT, RIGHT_DOWN, DOWN_DOWN, TERMS };
typedef struct Map {
    double of[2][TERMS];
    double depth[2]; /* gradient of the depth, right and down; depth is 1 at the pixel's centre */
} Map;

/* The coefficients of a map that storing a pixel needs. */
typedef struct UvMap {
    double mean[2];
    float right[2], down[2], depth[2];
    int is_uniform;
} UvMap;

typedef struct SmoothWork {
    RetexCompactClusters *clusters;
    RetexUniformPixel *pixels;
    UvMap *maps;
    const int *periodic;
    int width, height;
    int pass;       /* -1: only distances are measured, for scatter */
    double noise;   /* share of the expected noise that may be removed */
    double scatter; /* variance of means about their maps, relative to that of independent samples */
    float *distances;
} SmoothWork;

/* Squared UV step of an axis from a pixel to the next. */
static double step_of(const Map *map, int axis)
{
    return map->of[axis][RIGHT] * map->of[axis][RIGHT] + map->of[axis][DOWN] * map->of[axis][DOWN];
}

/* d: a pixel's UV relative to the centre's, times depth. Returns the squared distance from the map, in pixels. */
static double map_distance(const SmoothWork *work, const Map *map, const RetexUniformPixel *center,
                           const RetexUniformPixel *each, const double terms[TERMS], double d[2])
{
    double distance = 0;
    for (int a = 0; a < 2; a++) {
        double at = 0;
        d[a] = each->mean[a] - center->mean[a];
        d[a] -= work->periodic[a] ? rint(d[a]) : 0;
        for (int k = 0; k < TERMS && map; k++)
            at += map->of[a][k] * terms[k];
        d[a] *= map ? 1 + map->depth[0] * terms[RIGHT] + map->depth[1] * terms[DOWN] : 1;
        if (map)
            distance += (d[a] - at) * (d[a] - at) / (step_of(map, a) + TEXEL);
    }
    return distance;
}

/* Expected squared distance of a mean from its map, in pixels: each variance of a parallelogram is a twelfth of its
 * squared side. Stratified samples come nearer than independent ones. */
static double expected_distance(const SmoothWork *work, const RetexUniformPixel *place)
{
    return work->scatter * 2 / (12 * (double)place->samples);
}

static double distance_limit(const SmoothWork *work, const RetexUniformPixel *place)
{
    return work->noise * work->noise *
           (DISTANCE_DEVIATIONS_MAX * DISTANCE_DEVIATIONS_MAX * expected_distance(work, place) +
            DISTANCE_TOLERANCE * DISTANCE_TOLERANCE);
}

/* Gaussian elimination. Returns 0 if there is no unique solution. */
static int solve(double rows[TERMS][TERMS + 2])
{
    for (int i = 0; i < TERMS; i++) {
        int pivot = i;
        for (int j = i + 1; j < TERMS; j++)
            if (fabs(rows[j][i]) > fabs(rows[pivot][i]))
                pivot = j;
        if (!(fabs(rows[pivot][i]) > 0.5))
            return 0;
        for (int k = 0; k < TERMS + 2; k++) {
            const double swapped = rows[i][k];
            rows[i][k] = rows[pivot][k];
            rows[pivot][k] = swapped;
        }
        for (int j = 0; j < TERMS; j++) {
            const double times = j == i ? 0 : rows[j][i] / rows[i][i];
            for (int k = i; k < TERMS + 2; k++)
                rows[j][k] -= times * rows[i][k];
        }
    }
    return 1;
}

/* The mean UVs around a pixel, relative to its own, to which a map is fitted. */
typedef struct Window {
    double dx[SIDE * SIDE], dy[SIDE * SIDE], d[SIDE * SIDE][2];
    int count;
} Window;

/* Least squares; with all pixels of the window the solution is known in closed form. */
static int fit_window(Map *map, const Window *window)
{
    double rows[TERMS][TERMS + 2] = {{0}};
    const int whole = window->count == SIDE * SIDE;
    for (int i = 0; i < window->count; i++) {
        const double dx = window->dx[i], dy = window->dy[i], terms[TERMS] = {1, dx, dy, dx * dx, dx * dy, dy * dy};
        const double weights[TERMS] = {(27 - 5 * (terms[3] + terms[5])) / 175,
                                       dx / 50,
                                       dy / 50,
                                       (terms[3] - 2) / 70,
                                       terms[4] / 100,
                                       (terms[5] - 2) / 70};
        for (int k = 0; k < TERMS; k++) {
            for (int l = 0; l < TERMS && !whole; l++)
                rows[k][l] += terms[k] * terms[l];
            for (int a = 0; a < 2; a++)
                rows[k][TERMS + a] += (whole ? weights[k] : terms[k]) * window->d[i][a];
        }
    }
    if (!whole && (window->count < FITTED_MIN || !solve(rows)))
        return 0;
    for (int k = 0; k < TERMS; k++)
        for (int a = 0; a < 2; a++)
            map->of[a][k] = rows[k][TERMS + a] / (whole ? 1 : rows[k][k]);
    return 1;
}

/* The same map over another depth, up to second order. */
static void change_depth(Map *map, const double depth[2])
{
    const double right = depth[0] - map->depth[0], down = depth[1] - map->depth[1];
    for (int a = 0; a < 2; a++) {
        double *of = map->of[a];
        of[RIGHT_RIGHT] += right * of[RIGHT];
        of[RIGHT_DOWN] += right * of[DOWN] + down * of[RIGHT];
        of[DOWN_DOWN] += down * of[DOWN];
        of[RIGHT] += right * of[CONSTANT];
        of[DOWN] += down * of[CONSTANT];
        map->depth[a] = depth[a];
    }
}

/* The curvature of a map, in squared pixels. */
static double map_curvature(const Map *map)
{
    double curvature = 0;
    for (int a = 0; a < 2; a++)
        for (int k = RIGHT_RIGHT; k < TERMS; k++)
            curvature += map->of[a][k] * map->of[a][k] / (step_of(map, a) + TEXEL);
    return curvature;
}

/* Find the depth that minimizes the map's curvature. It is used only if it is large enough and leaves little
 * curvature. */
static void find_depth(Map *map)
{
    double both = TEXEL, mixed = 0, curvature[2] = {0}, depth[2];
    for (int a = 0; a < 2; a++) {
        const double *of = map->of[a], step = step_of(map, a) + TEXEL;
        both += step_of(map, a) / step;
        mixed += of[RIGHT] * of[DOWN] / step;
        curvature[0] += (of[RIGHT] * of[RIGHT_RIGHT] + of[DOWN] * of[RIGHT_DOWN]) / step;
        curvature[1] += (of[RIGHT] * of[RIGHT_DOWN] + of[DOWN] * of[DOWN_DOWN]) / step;
    }
    for (int i = 0; i < 2; i++)
        depth[i] = map->depth[i] - (both * curvature[i] - mixed * curvature[1 - i]) / (both * both - mixed * mixed);
    const double size = depth[0] * depth[0] + depth[1] * depth[1];
    Map over = *map;
    change_depth(&over, depth);
    if (size < DEPTH_SLOPE_MIN * DEPTH_SLOPE_MIN || fabs(depth[0]) + fabs(depth[1]) > DEPTH_SLOPE_MAX ||
        map_curvature(&over) > DEPTH_CURVATURE_MAX * size)
        change_depth(map, (const double[2]){0});
    else
        *map = over;
}

/* Fit the map around a pixel, over the depth of the last map, if any. Outliers are left out: means farther from the
 * last map than `times` the limit or, in the smoothing passes, than SMOOTHED_DISTANCE_MAX. */
static int fit_map(Map *map, const SmoothWork *work, int x, int y, const Map *last, double times)
{
    const RetexUniformPixel *center = &work->pixels[y * work->width + x];
    Window window;
    window.count = 0;
    for (int j = y - RADIUS; j <= y + RADIUS; j++)
        for (int i = x - RADIUS; i <= x + RADIUS; i++) {
            if (i < 0 || j < 0 || i >= work->width || j >= work->height)
                continue;
            const RetexUniformPixel *each = &work->pixels[j * work->width + i];
            const double dx = i - x, dy = j - y, terms[TERMS] = {1, dx, dy, dx * dx, dx * dy, dy * dy};
            if (!(each->samples > 0))
                continue;
            const double distance = map_distance(work, last, center, each, terms, window.d[window.count]);
            if (last && distance > (work->pass > 0 ? SMOOTHED_DISTANCE_MAX : times * distance_limit(work, each)))
                continue;
            window.dx[window.count] = dx;
            window.dy[window.count++] = dy;
        }
    if (!fit_window(map, &window))
        return 0;
    for (int i = 0; i < 2; i++)
        map->depth[i] = last ? last->depth[i] : 0;
    find_depth(map);
    return 1;
}

/* Squared distance of a pixel's own mean from its map, in pixels. */
static double center_distance(const Map *map)
{
    double distance = 0;
    for (int a = 0; a < 2; a++)
        distance += map->of[a][CONSTANT] * map->of[a][CONSTANT] / (step_of(map, a) + TEXEL);
    return distance;
}

/* Whether a pixel's mean and variances agree with the map. */
static int agrees_with_map(const SmoothWork *work, const Map *map, const RetexUniformPixel *own)
{
    const double few = VARIANCE_DEVIATIONS_MAX / sqrt((double)own->samples);
    double variances[3];
    for (int k = 0; k < 3; k++) {
        const int a = k / 2, b = (k + 1) / 2;
        variances[k] = (map->of[a][RIGHT] * map->of[b][RIGHT] + map->of[a][DOWN] * map->of[b][DOWN]) / 12;
    }
    for (int k = 0; k < 3; k += 2) {
        const double should = variances[k] + TEXEL, is = (double)own->variances[k] + TEXEL;
        if (fabs(is - should) > fmax(few, VARIANCE_TOLERANCE) * should)
            return 0;
    }
    const double difference = (double)own->variances[1] - variances[1];
    return center_distance(map) <= distance_limit(work, own) &&
           fabs(difference) <= fmax(few, CORRELATION_TOLERANCE) * sqrt((variances[0] + TEXEL) * (variances[2] + TEXEL));
}

/* Whether all clusters of a pixel lie in its parallelogram. */
static int are_inside(const SmoothWork *work, size_t pixel, const Map *map)
{
    const RetexUniformPixel *own = &work->pixels[pixel];
    const double a = map->of[0][RIGHT], b = map->of[0][DOWN], c = map->of[1][RIGHT], d = map->of[1][DOWN];
    const double area = a * d - b * c;
    for (int k = 0; k < work->clusters->count; k++) {
        const float *uv = work->clusters->uv[k].pixels + 3 * pixel;
        double to[2];
        if (!(uv[2] > 0))
            continue;
        for (int axis = 0; axis < 2; axis++) {
            to[axis] = (double)uv[axis] - own->mean[axis];
            to[axis] -= (work->periodic[axis] ? rint(to[axis]) : 0) + map->of[axis][CONSTANT];
        }
        if (fabs(d * to[0] - b * to[1]) > CLUSTER_DISTANCE_MAX * fabs(area) + sqrt(TEXEL) * (fabs(b) + fabs(d)) ||
            fabs(a * to[1] - c * to[0]) > CLUSTER_DISTANCE_MAX * fabs(area) + sqrt(TEXEL) * (fabs(a) + fabs(c)))
            return 0;
    }
    return 1;
}

/* ---- the picture ---- */

static void store_map(UvMap *to, const SmoothWork *work, size_t pixel, const Map *map)
{
    for (int a = 0; a < 2; a++) {
        to->mean[a] = work->pixels[pixel].mean[a] + map->of[a][CONSTANT];
        to->mean[a] -= work->periodic[a] ? floor(to->mean[a]) : 0;
        to->right[a] = (float)(map->of[a][RIGHT] - map->depth[0] * map->of[a][CONSTANT]);
        to->down[a] = (float)(map->of[a][DOWN] - map->depth[1] * map->of[a][CONSTANT]);
        to->depth[a] = (float)map->depth[a];
    }
    to->is_uniform = 1;
}

/* The map of a pixel that is a parallelogram already. */
static void copy_exact(UvMap *to, const SmoothWork *work, size_t pixel)
{
    const float *axes = work->clusters->spread[work->clusters->whole].pixels + RETEX_AXES * pixel;
    *to = (UvMap){
        {work->pixels[pixel].mean[0], work->pixels[pixel].mean[1]}, {axes[0], axes[1]}, {axes[2], axes[3]}, {0, 0}, 1};
}

/* Whether a pixel is uniform. Edges distort the first map, so maps are fitted again without outliers. */
static int is_uniform(Map *map, const SmoothWork *work, int x, int y)
{
    const size_t pixel = (size_t)y * (size_t)work->width + (size_t)x;
    Map rough, better;
    return fit_map(&rough, work, x, y, NULL, 0) && fit_map(&better, work, x, y, &rough, FIRST_FIT_FACTOR) &&
           fit_map(map, work, x, y, &better, 1) && agrees_with_map(work, map, &work->pixels[pixel]) &&
           are_inside(work, pixel, map);
}

/* Fit the map of a uniform pixel again, to the smoothed neighbours. 0 where that would remove more than noise. */
static int is_smoothed(Map *map, const SmoothWork *work, int x, int y)
{
    const size_t pixel = (size_t)y * (size_t)work->width + (size_t)x;
    const UvMap *before = &work->maps[pixel];
    const Map last = {{{0, (double)before->right[0], (double)before->down[0]},
                       {0, (double)before->right[1], (double)before->down[1]}},
                      {(double)before->depth[0], (double)before->depth[1]}};
    return fit_map(map, work, x, y, &last, 0) && center_distance(map) <= expected_distance(work, &work->pixels[pixel]);
}

/* Pass 0 finds the uniform pixels; the passes after it smooth the noise that remains. */
static void fit_row(void *context, int y, int thread)
{
    const SmoothWork *work = context;
    (void)thread;
    for (int x = 0; x < work->width; x++) {
        const size_t pixel = (size_t)y * (size_t)work->width + (size_t)x;
        const RetexUniformPixel *own = &work->pixels[pixel];
        Map map;
        if (!(own->samples > 0))
            continue;
        if (own->samples >= RETEX_UNIFORM_EXACT) {
            if (work->pass == 0)
                copy_exact(&work->maps[pixel], work, pixel);
            continue;
        }
        if (work->pass < 0 && fit_map(&map, work, x, y, NULL, 0))
            work->distances[pixel] = (float)(center_distance(&map) / expected_distance(work, own));
        else if (work->pass >= 0 && (work->pass ? is_smoothed(&map, work, x, y) : is_uniform(&map, work, x, y)))
            store_map(&work->maps[pixel], work, pixel, &map);
    }
}

/* Copy the smoothed means, from which the next pass starts. */
static void start_pass_row(void *context, int y, int thread)
{
    const SmoothWork *work = context;
    (void)thread;
    for (size_t i = (size_t)y * (size_t)work->width; i < (size_t)(y + 1) * (size_t)work->width; i++) {
        RetexUniformPixel *place = &work->pixels[i];
        place->samples = work->maps[i].is_uniform ? place->samples : 0;
        place->mean[0] = work->maps[i].mean[0];
        place->mean[1] = work->maps[i].mean[1];
    }
}

static void clear_cluster(RetexCompactClusters *clusters, int k, size_t pixel)
{
    memset(clusters->uv[k].pixels + 3 * pixel, 0, 3 * sizeof(float));
    memset(clusters->spread[k].pixels + 3 * pixel, 0, 3 * sizeof(float));
    clusters->weight[k].pixels[pixel] = 0;
    if (clusters->interreflected[k].pixels)
        clusters->interreflected[k].pixels[pixel] = 0;
}

static void store_weights(RetexCompactClusters *clusters, int k, size_t pixel, float weight, float interreflected)
{
    clusters->weight[k].pixels[pixel] = weight;
    if (clusters->interreflected[k].pixels)
        clusters->interreflected[k].pixels[pixel] = interreflected;
}

/* Store a uniform pixel as a whole, in place of its clusters. */
static void store_uniform(const SmoothWork *work, size_t pixel)
{
    const UvMap *map = &work->maps[pixel];
    RetexCompactClusters *clusters = work->clusters;
    float *uv = clusters->uv[clusters->whole].pixels + 3 * pixel;
    float *axes = clusters->spread[clusters->whole].pixels + RETEX_AXES * pixel;
    for (int k = 0; k < clusters->count; k++)
        clear_cluster(clusters, k, pixel);
    for (int a = 0; a < 2; a++)
        uv[a] = (float)map->mean[a], axes[a] = map->right[a], axes[2 + a] = map->down[a];
    uv[2] = 1;
    store_weights(clusters, clusters->whole, pixel, 1, 1);
}

static void store_row(void *context, int y, int thread)
{
    const SmoothWork *work = context;
    (void)thread;
    for (int x = 0; x < work->width; x++) {
        const size_t pixel = (size_t)y * (size_t)work->width + (size_t)x;
        if (work->maps[pixel].is_uniform && work->pixels[pixel].samples < RETEX_UNIFORM_EXACT)
            store_uniform(work, pixel);
    }
}

static int compare_floats(const void *a, const void *b)
{
    const float one = *(const float *)a, other = *(const float *)b;
    return (one > other) - (one < other);
}

/* Measure how far means scatter about their maps. Most distances are noise; the few at edges of light are larger, so
 * the median is used. */
static int measure_scatter(SmoothWork *work, int nthreads, RetexError *err)
{
    const size_t all = (size_t)work->width * (size_t)work->height;
    size_t count = 0;
    work->scatter = 1, work->pass = -1;
    work->distances = calloc(all, sizeof *work->distances);
    if (!work->distances)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for footprints");
    retex_parallel(nthreads, work->height, fit_row, work);
    for (size_t i = 0; i < all; i++)
        if (work->distances[i] > 0)
            work->distances[count++] = work->distances[i];
    qsort(work->distances, count, sizeof *work->distances, compare_floats);
    if (count)
        work->scatter = fmin((double)work->distances[count / 2] / DISTANCE_MEDIAN, 1);
    free(work->distances);
    return RETEX_OK;
}

int retex_compact_smooth_uniform(RetexCompactClusters *clusters, RetexUniformPixel *pixels, const int periodic[2],
                                 double noise, int nthreads, RetexError *err)
{
    SmoothWork work = {.clusters = clusters, .pixels = pixels, .periodic = periodic, .noise = noise};
    work.width = clusters->albedo.width, work.height = clusters->albedo.height;
    int code = measure_scatter(&work, nthreads, err);
    if (code)
        return code;
    work.maps = calloc((size_t)work.width * (size_t)work.height, sizeof *work.maps);
    if (!work.maps)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for footprints");
    for (work.pass = 0; work.pass < PASSES; work.pass++) {
        retex_parallel(nthreads, work.height, fit_row, &work);
        retex_parallel(nthreads, work.height, start_pass_row, &work);
    }
    retex_parallel(nthreads, work.height, store_row, &work);
    free(work.maps);
    return RETEX_OK;
}

/* ---- whole pixels that are no steps ---- */

typedef struct SplitWork {
    RetexCompactClusters *clusters;
    const int *periodic;
    unsigned char *is_uneven; /* by pixel */
    int *count;               /* by row: how many are */
} SplitWork;

/* Whether a pixel has axes that the steps to its neighbours are not. */
static int is_uneven(const SplitWork *work, int x, int y)
{
    const RetexImage *uv = &work->clusters->uv[work->clusters->whole];
    const RetexImage *axes = &work->clusters->spread[work->clusters->whole];
    const float *of = axes->pixels + retex_image_index(axes, x, y);
    double steps[RETEX_AXES];
    retex_steps_at(steps, uv, x, y, work->periodic);
    return !retex_steps_fit(steps, of, RETEX_STEPS_TOLERANCE);
}

static int find_free(const RetexCompactClusters *clusters, int first, size_t pixel)
{
    while (first < clusters->count && clusters->uv[first].pixels[3 * pixel + 2] > 0)
        first++;
    return first;
}

/* Mark those that are, and for which there is room as clusters. */
static void find_uneven(void *context, int y, int thread)
{
    const SplitWork *work = context;
    const RetexImage *uv = &work->clusters->uv[work->clusters->whole];
    (void)thread;
    work->count[y] = 0;
    for (int x = 0; x < uv->width; x++) {
        const size_t at = (size_t)y * (size_t)uv->width + (size_t)x;
        work->is_uneven[at] = uv->pixels[3 * at + 2] > 0 && is_uneven(work, x, y) &&
                              find_free(work->clusters, 0, at) < work->clusters->count;
        work->count[y] += work->is_uneven[at];
    }
}

/* Store a part of a whole pixel as a cluster: a quarter, or all of it. `of`: its middle and sides. */
static void store_ellipse(const SplitWork *work, int k, size_t pixel, const RetexParallelogram *of)
{
    RetexCompactClusters *clusters = work->clusters;
    RetexUvStats place = {.weight = 1};
    for (int a = 0; a < 2; a++) {
        place.mean[a] = (double)of->uv[a] - (work->periodic[a] ? floor((double)of->uv[a]) : 0);
        place.m2[2 * a] =
            ((double)of->sides[a] * (double)of->sides[a] + (double)of->sides[2 + a] * (double)of->sides[2 + a]) / 12;
    }
    place.m2[1] = ((double)of->sides[0] * (double)of->sides[1] + (double)of->sides[2] * (double)of->sides[3]) / 12;
    float *uv = clusters->uv[k].pixels + 3 * pixel;
    retex_uv_stats_store(&place, uv, clusters->spread[k].pixels + 3 * pixel);
    uv[2] = 1;
}

static int count_free(const RetexCompactClusters *clusters, size_t pixel)
{
    int count = 0;
    for (int k = find_free(clusters, 0, pixel); k < clusters->count; k = find_free(clusters, k + 1, pixel))
        count++;
    return count;
}

/* The shape of part 0 to 3 of four, or of the only one: the pixel itself. */
static RetexTextureFilter shape_of_part(int part, int parts)
{
    return (RetexTextureFilter)(RETEX_TEXTURE_PARALLELOGRAM + (parts == 1 ? 0 : 1 + part));
}

/* Makes clusters of a whole pixel, of which at least one is free (find_uneven): its quarters, each with a quarter of
 * its weight, or where fewer than four are free one of all of it. The whole pixel is none then. */
static void split_pixel(const SplitWork *work, size_t pixel)
{
    RetexCompactClusters *clusters = work->clusters;
    const int whole = clusters->whole;
    float *uv = clusters->uv[whole].pixels + 3 * pixel, *axes = clusters->spread[whole].pixels + RETEX_AXES * pixel;
    const float weight = clusters->weight[whole].pixels[pixel];
    const float interreflected =
        clusters->interreflected[whole].pixels ? clusters->interreflected[whole].pixels[pixel] : 0;
    const int parts = count_free(clusters, pixel) < RETEX_QUADRANTS ? 1 : RETEX_QUADRANTS;
    for (int part = 0; part < parts; part++) {
        const RetexParallelogram of = retex_parallelogram(shape_of_part(part, parts), uv, axes);
        const int k = find_free(clusters, 0, pixel); /* those before have coverage now */
        RETEX_ASSERT(k < clusters->count);
        store_ellipse(work, k, pixel, &of);
        store_weights(clusters, k, pixel, weight / (float)parts, interreflected / (float)parts);
    }
    memset(uv, 0, 3 * sizeof *uv);
    memset(axes, 0, RETEX_AXES * sizeof *axes);
    store_weights(clusters, whole, pixel, 0, 0);
}

static void split_row(void *context, int y, int thread)
{
    const SplitWork *work = context;
    const size_t width = (size_t)work->clusters->albedo.width;
    (void)thread;
    for (size_t i = (size_t)y * width; i < (size_t)(y + 1) * width && work->count[y]; i++)
        if (work->is_uneven[i])
            split_pixel(work, i);
}

static int any_row(const int *count, int height)
{
    int any = 0;
    for (int y = 0; y < height; y++)
        any |= count[y] > 0;
    return any;
}

int retex_compact_split_uneven(RetexCompactClusters *clusters, const int periodic[2], int nthreads, RetexError *err)
{
    const int width = clusters->albedo.width, height = clusters->albedo.height;
    SplitWork work = {clusters, periodic, malloc((size_t)width * (size_t)height),
                      malloc((size_t)height * sizeof *work.count)};
    int code = work.is_uneven && work.count ? 0 : retex_fail(err, RETEX_ENOMEM, "not enough memory for footprints");
    for (int left = !code; left;) { /* what is split may leave neighbours without a step */
        retex_parallel(nthreads, height, find_uneven, &work);
        left = any_row(work.count, height);
        retex_parallel(nthreads, height, split_row, &work);
    }
    free(work.is_uneven);
    free(work.count);
    return code;
}
