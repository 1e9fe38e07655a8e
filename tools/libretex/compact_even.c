/* See compact_even.h. A pixel that sees a surface through nothing but air has the UV of a parallelogram, known by the
 * means of the pixels around it. Its clusters are some partition of its samples: noise, which costs more than all else
 * that sharp footprints store. The quarters of the parallelogram stand for the same, vary smoothly, and fit the pixel
 * better. */
#include "compact_even.h"

#include <math.h>
#include <stdlib.h>

#include <retex/parallel.h>

#define TEXEL (1.0 / (1 << 26)) /* variance of UV, of a texel of 8192 */
#define FILL 0.6                /* of the area of a place, what its parts have at least */
#define DENSITY 3               /* ratio of light an area in parts of one place, at most */
#define OFF_LEAST 0.02          /* pixels that a mean may always be off its map's, */
#define OFF_MOST 0.12           /* or at most, */
#define OFF_TIMES 3.5           /* in between so many times what half of them are */
#define VARIANCE_MOST 1.5       /* ratio of a pixel's variances to its map's, at most, and at least its inverse */
#define CORRELATION_MOST 0.3    /* that they may differ by */
#define ROUGH 9                 /* times that, squared, about a first map */
enum { REACH = 2, FITTED_LEAST = 12 };

static double area_of(const UvStats *place)
{
    const double uu = place->m2[0] / place->weight + TEXEL, uv = place->m2[1] / place->weight;
    const double vv = place->m2[2] / place->weight + TEXEL;
    return sqrt(fmax(uu * vv - uv * uv, TEXEL * TEXEL));
}

int compact_even_sum(UvStats *sum, const UvStats *const parts[], int count, const int periodic[2])
{
    double area = 0, least = INFINITY, most = 0;
    for (int k = 0; k < count; k++) {
        const double own = area_of(parts[k]), density = parts[k]->weight / own;
        area += own;
        least = fmin(least, density);
        most = fmax(most, density);
        if (k == 0)
            *sum = *parts[0];
        else
            uv_stats_merge(sum, parts[k], periodic);
    }
    return count > 0 && most <= DENSITY * least && area >= FILL * area_of(sum);
}

/* ---- the map ---- */

/* UV about a pixel, from its own mean: of each axis the value in the middle, how much it changes from a pixel to the
 * next one right and down, and what bends it: squares and the product. */
enum { MIDDLE, RIGHT, DOWN, TERMS = 6 };
typedef struct Map {
    double of[2][TERMS];
} Map;

/* Of an axis, squared, from a pixel to the next. */
static double step_of(const Map *map, int axis)
{
    return map->of[axis][RIGHT] * map->of[axis][RIGHT] + map->of[axis][DOWN] * map->of[axis][DOWN];
}

typedef struct EvenWork {
    CompactClusters *clusters;
    const UvStats *whole;
    const int *periodic;
    int width, height;
    double off; /* pixels that a mean may be off its map's, squared */
    float *offs;
} EvenWork;

/* How far a pixel's UV are from the map of another, and by how many pixels, squared. */
static double off_map(const EvenWork *work, const Map *map, const UvStats *center, const UvStats *each,
                      const double terms[TERMS], double d[2])
{
    double off = 0;
    for (int a = 0; a < 2; a++) {
        double at = 0;
        d[a] = each->mean[a] - center->mean[a];
        d[a] -= work->periodic[a] ? rint(d[a]) : 0;
        for (int k = 0; k < TERMS && map; k++)
            at += map->of[a][k] * terms[k];
        if (map)
            off += (d[a] - at) * (d[a] - at) / (step_of(map, a) + TEXEL);
    }
    return off;
}

/* Gaussian elimination; 0 where there is no one solution. */
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

/* Least squares of means about a pixel; those that are farther from the last map than `most` are left out. */
static int fit_map(Map *map, const EvenWork *work, int x, int y, const Map *last, double most)
{
    const UvStats *center = &work->whole[y * work->width + x];
    double rows[TERMS][TERMS + 2] = {{0}}, d[2];
    int count = 0;
    for (int j = y - REACH; j <= y + REACH; j++)
        for (int i = x - REACH; i <= x + REACH; i++) {
            if (i < 0 || j < 0 || i >= work->width || j >= work->height)
                continue;
            const UvStats *each = &work->whole[j * work->width + i];
            const double dx = i - x, dy = j - y, terms[TERMS] = {1, dx, dy, dx * dx, dx * dy, dy * dy};
            if (!(each->weight > 0) || off_map(work, last, center, each, terms, d) > most)
                continue;
            count++;
            for (int k = 0; k < TERMS; k++) {
                for (int l = 0; l < TERMS; l++)
                    rows[k][l] += terms[k] * terms[l];
                rows[k][TERMS] += terms[k] * d[0];
                rows[k][TERMS + 1] += terms[k] * d[1];
            }
        }
    if (count < FITTED_LEAST || !solve(rows))
        return 0;
    for (int k = 0; k < TERMS; k++)
        for (int a = 0; a < 2; a++)
            map->of[a][k] = rows[k][TERMS + a] / rows[k][k];
    return 1;
}

/* How many pixels a pixel's own mean is off its map's, squared. */
static double off_middle(const Map *map)
{
    double off = 0;
    for (int a = 0; a < 2; a++)
        off += map->of[a][MIDDLE] * map->of[a][MIDDLE] / (step_of(map, a) + TEXEL);
    return off;
}

/* Whether a pixel's own mean and variances are the map's. */
static int suits(const EvenWork *work, const Map *map, const UvStats *own)
{
    double variances[3];
    for (int k = 0; k < 3; k++) {
        const int a = k / 2, b = (k + 1) / 2;
        variances[k] = (map->of[a][RIGHT] * map->of[b][RIGHT] + map->of[a][DOWN] * map->of[b][DOWN]) / 12;
    }
    for (int k = 0; k < 3; k += 2) {
        const double should = variances[k] + TEXEL, is = own->m2[k] / own->weight + TEXEL;
        if (is > VARIANCE_MOST * should || should > VARIANCE_MOST * is)
            return 0;
    }
    const double difference = own->m2[1] / own->weight - variances[1];
    return off_middle(map) <= work->off &&
           fabs(difference) <= CORRELATION_MOST * sqrt((variances[0] + TEXEL) * (variances[2] + TEXEL));
}

/* The whole pixel, or its quarters, in the order of u + v. */
static void store_even(const EvenWork *work, size_t pixel, const Map *map)
{
    CompactClusters *clusters = work->clusters;
    const int count = clusters->uv[clusters->count > 1].pixels[3 * pixel + 2] > 0 ? 4 : 1;
    const double share = count == 4 ? 0.25 : 1, part = share / 12;
    const double a = map->of[0][RIGHT] + map->of[1][RIGHT], b = map->of[0][DOWN] + map->of[1][DOWN];
    const double first = a < 0 ? -1 : 1, second = b < 0 ? -1 : 1;
    for (int k = 0; k < clusters->count; k++) {
        const int right = k == 3 || k == (fabs(a) < fabs(b) ? 1 : 2), down = k == 3 || (!right && k > 0);
        UvStats place = {.weight = 1};
        for (int axis = 0; axis < 2; axis++) {
            const double side = count == 4 ? first * (right ? 0.25 : -0.25) * map->of[axis][RIGHT] +
                                                 second * (down ? 0.25 : -0.25) * map->of[axis][DOWN]
                                           : 0;
            place.mean[axis] = work->whole[pixel].mean[axis] + map->of[axis][MIDDLE] + side;
            place.mean[axis] -= work->periodic[axis] ? floor(place.mean[axis]) : 0;
            place.m2[2 * axis] = part * step_of(map, axis);
        }
        place.m2[1] = part * (map->of[0][RIGHT] * map->of[1][RIGHT] + map->of[0][DOWN] * map->of[1][DOWN]);
        float *uv = clusters->uv[k].pixels + 3 * pixel, *spread = clusters->spread[k].pixels + 3 * pixel;
        if (k < count) {
            uv_stats_store(&place, uv, spread);
            uv[2] = 1;
        }
        clusters->weight[k].pixels[pixel] = k < count ? (float)share : 0;
        if (clusters->again[k].pixels)
            clusters->again[k].pixels[pixel] = k < count ? (float)share : 0;
    }
}

static void smooth_row(void *context, int y, int thread)
{
    const EvenWork *work = context;
    (void)thread;
    for (int x = 0; x < work->width; x++) {
        const size_t pixel = (size_t)y * (size_t)work->width + (size_t)x;
        Map rough, better, map;
        /* an edge draws the first map to it */
        if (work->whole[pixel].weight > 0 && fit_map(&rough, work, x, y, NULL, INFINITY) &&
            fit_map(&better, work, x, y, &rough, ROUGH * work->off) && fit_map(&map, work, x, y, &better, work->off) &&
            suits(work, &map, &work->whole[pixel]))
            store_even(work, pixel, &map);
    }
}

static void off_row(void *context, int y, int thread)
{
    const EvenWork *work = context;
    Map map;
    (void)thread;
    for (int x = 0; x < work->width; x++) {
        const int pixel = y * work->width + x;
        work->offs[pixel] =
            work->whole[pixel].weight > 0 && fit_map(&map, work, x, y, NULL, INFINITY) ? (float)off_middle(&map) : -1;
    }
}

static int compare_floats(const void *a, const void *b)
{
    const float one = *(const float *)a, other = *(const float *)b;
    return (one > other) - (one < other);
}

/* Means are off by noise, which is alike everywhere, and by edges of light, of which there are few. */
static double find_off(EvenWork *work, int nthreads)
{
    int count = 0;
    retex_parallel(nthreads, work->height, off_row, work);
    for (int i = 0; i < work->width * work->height; i++)
        if (work->offs[i] >= 0)
            work->offs[count++] = work->offs[i];
    qsort(work->offs, (size_t)count, sizeof *work->offs, compare_floats);
    const double off = count ? OFF_TIMES * sqrt((double)work->offs[count / 2]) : 0;
    return pow(fmin(fmax(off, OFF_LEAST), OFF_MOST), 2);
}

int compact_even_smooth(CompactClusters *clusters, const UvStats *whole, const int periodic[2], int nthreads,
                        RetexError *err)
{
    EvenWork work = {clusters, whole, periodic, clusters->albedo.width, clusters->albedo.height, 0, NULL};
    work.offs = malloc((size_t)work.width * (size_t)work.height * sizeof *work.offs);
    if (!work.offs)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for footprints");
    work.off = find_off(&work, nthreads);
    free(work.offs);
    retex_parallel(nthreads, work.height, smooth_row, &work);
    return RETEX_OK;
}
