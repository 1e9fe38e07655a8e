/* See tile.h. Weights are those of Rousselle et al. 2012, limited by features as in Rousselle et al. 2013. There are
 * several candidate filters; the error of each is estimated by comparing its result in one half of the samples with the
 * other half. */
#include "denoise/results.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <retex/host/assert.h>

#include "denoise/features.h"
#include "denoise/fireflies.h"
#include "denoise/planes_kernel.h"
#include "denoise/tile.h"
#include "set/set.h"

#define STRENGTH 0.45f /* in standard deviations, at params.strength 1: k of Rousselle et al. 2012 */
#define LEAST_MODULATION 0.2f
#define LEAST_DIFFERENCE 1e-6f /* squared relative difference below which nothing is visible */
#define ERROR_RADIUS 2         /* radius of the patch over which candidates are compared */
#define CHOICE_RADIUS 2        /* radius over which the choice is smoothed */
#define SPIKE 40               /* times the variance around: such a squared difference of halves is a spike */

_Static_assert(ERROR_RADIUS + CHOICE_RADIUS <= DENOISE_MARGIN, "what is chosen must not depend on tiles");

struct RetexDenoiseScratch {
    float *memory;
    float *features; /* DENOISE_FEATURES_SCRATCH planes */
    float *spare;    /* a plane */
    float *stays[2]; /* planes: what fireflies leave of each half */
    float *scratch, *errors[CHOICES];
    RetexDenoiseDisplacement *window; /* the nearest first */
    int nwindow;
    RetexDenoiseSimilarity *alike;   /* by displacement of the window */
    float *weights[DENOISE_WEIGHTS]; /* of displacements */
    RetexTileSignal signal;
    float **pointers;
};

/* ---- scratch memory ---- */

/* The layout is computed twice: first from NULL, to find its size. */
typedef struct Layout {
    float *memory;
    size_t used;
} Layout;

static float *take(Layout *l, size_t floats)
{
    float *p = l->memory ? l->memory + l->used : NULL;
    l->used += (floats + 15) / 16 * 16;
    return p;
}

/* The images of a signal: one for all clusters. */
static int count_images(const RetexSignal *signal, int *nclusters)
{
    *nclusters = 0;
    for (int k = 0; k < signal->nmembers; k++)
        *nclusters += signal->members[k].cluster >= 0;
    return signal->nmembers - *nclusters + (*nclusters > 0);
}

/* The planes of the signal with the most images. */
static int most_planes(const RetexDenoiser *d)
{
    int most = 0, nclusters;
    for (int s = 0; s < d->signals.count; s++) {
        const int count = 3 * count_images(&d->signals.of[s], &nclusters);
        most = count > most ? count : most;
    }
    return most;
}

static void plan_signal(RetexTileSignal *r, Layout *l, int nplanes, float **pointers)
{
    r->kind = take(l, DENOISE_PLANE), r->mean_modulation = take(l, DENOISE_PLANE);
    for (int c = 0; c < 3; c++) {
        r->variance[c] = take(l, DENOISE_PLANE), r->modulation[c] = take(l, DENOISE_PLANE);
        r->lost[c] = take(l, DENOISE_PLANE);
        r->half[0][c] = take(l, DENOISE_PLANE), r->half[1][c] = take(l, DENOISE_PLANE);
    }
    for (int k = 0; k < DENOISE_CANDIDATES; k++)
        for (int h = 0; h < 2; h++) {
            r->candidates[k].norm[h] = take(l, DENOISE_PIXELS);
            for (int c = 0; c < 3; c++)
                r->candidates[k].sum[h][c] = take(l, DENOISE_PIXELS);
        }
    for (int k = 0; k < CHOICES; k++)
        r->chosen[k] = take(l, DENOISE_PIXELS);
    for (int k = 0; k < NEIGHBOURS_MAX; k++)
        r->neighbours[k] = take(l, DENOISE_PIXELS);
    r->planes = pointers, r->sums = r->planes + nplanes;
    r->lit_planes = (const float **)(r->sums + nplanes), r->lit_sums = r->sums + 2 * nplanes;
    for (int k = 0; k < nplanes; k++)
        r->planes[k] = take(l, DENOISE_PLANE), r->sums[k] = take(l, DENOISE_PIXELS);
}

static void plan_scratch(RetexDenoiseScratch *work, Layout *l, int nplanes)
{
    l->used = 0;
    work->features = take(l, (size_t)DENOISE_FEATURES_SCRATCH * DENOISE_PLANE);
    work->spare = take(l, DENOISE_PLANE);
    work->stays[0] = take(l, DENOISE_PLANE), work->stays[1] = take(l, DENOISE_PLANE);
    work->scratch = take(l, DENOISE_SCRATCH);
    for (int k = 0; k < CHOICES; k++)
        work->errors[k] = take(l, DENOISE_PIXELS);
    for (int k = 0; k < DENOISE_WEIGHTS; k++)
        work->weights[k] = take(l, DENOISE_PIXELS);
    work->alike = (RetexDenoiseSimilarity *)take(l, (size_t)work->nwindow * sizeof *work->alike / sizeof(float));
    plan_signal(&work->signal, l, nplanes, work->pointers);
}

enum { WINDOW_MOST = (2 * DENOISE_RADIUS_MAX + 1) * (2 * DENOISE_RADIUS_MAX + 1) };

/* Light of lamps is many signals: the whole radius would gain .006 dB, and take a tenth more time. */
static int radius_of(const RetexDenoiser *d)
{
    return d->signals.of[0].lamp < 0 ? d->params.radius : (4 * d->params.radius + 4) / 5;
}

/* Displacements in a disc, the nearest first: those that only some candidates reach come last. */
static void plan_window(RetexDenoiseScratch *work, int radius)
{
    work->nwindow = 0;
    for (int squared = 0; squared <= radius * radius + radius; squared++)
        for (int dy = -radius; dy <= radius; dy++)
            for (int dx = -radius; dx <= radius; dx++)
                if (dx * dx + dy * dy == squared)
                    work->window[work->nwindow++] = (RetexDenoiseDisplacement){dx, dy};
    RETEX_ASSERT(work->nwindow <= WINDOW_MOST && work->window[0].dx == 0 && work->window[0].dy == 0);
}

int retex_denoise_scratch_create(RetexDenoiseScratch **out, const RetexDenoiser *d, RetexError *err)
{
    RetexDenoiseScratch *work = *out = calloc(1, sizeof *work);
    const int nplanes = most_planes(d);
    Layout layout = {NULL, 0};
    if (work) {
        work->pointers = calloc(4 * (size_t)nplanes + 1, sizeof *work->pointers);
        work->window = malloc(sizeof *work->window * WINDOW_MOST);
    }
    if (work && work->pointers && work->window) {
        plan_window(work, radius_of(d));
        plan_scratch(work, &layout, nplanes);
        layout.memory = work->memory = calloc(layout.used, sizeof(float));
    }
    if (!work || !work->memory) {
        retex_denoise_scratch_close(out);
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise a tile");
    }
    plan_scratch(work, &layout, nplanes);
    return RETEX_OK;
}

void retex_denoise_scratch_close(RetexDenoiseScratch **out)
{
    RetexDenoiseScratch *work = *out;
    if (!work)
        return;
    free(work->memory);
    free(work->pointers);
    free(work->window);
    free(work);
    *out = NULL;
}

/* ---- signals ---- */

/* Loads the images to filter. Their sum goes to the planes of the first half; that of which there is noise to those of
 * the second. */
static void load_members(RetexTileSignal *r, RetexDenoiseScratch *work, const RetexDenoiser *d,
                         const RetexSignal *signal, int x0, int y0)
{
    int image = r->nclusters > 0;
    for (int k = 0; k < r->nplanes; k++)
        memset(r->planes[k], 0, sizeof(float) * DENOISE_PLANE);
    for (int c = 0; c < 3; c++) {
        memset(r->half[0][c], 0, sizeof(float) * DENOISE_PLANE);
        memset(r->half[1][c], 0, sizeof(float) * DENOISE_PLANE);
    }
    for (int k = 0; k < signal->nmembers; k++) {
        const RetexSignalMember *m = &signal->members[k];
        int to = m->cluster >= 0 ? 0 : image++;
        RETEX_ASSERT(3 * to + 2 < r->nplanes); /* of clusters there is one image, the first */
        for (int c = 0; c < 3; c++) {
            retex_denoise_load_plane(work->spare, d->set, m->part, c, x0, y0);
            retex_denoise_add_plane(r->planes[3 * to + c], r->half[0][c], work->spare, m->bright);
            for (int i = 0; i < DENOISE_PLANE; i++)
                r->half[1][c][i] += m->weight * work->spare[i];
        }
    }
}

/* The albedo of the seen surface; for targets, white in the guide, DENOISE_TARGET_BRIGHTNESS. */
static void find_seen_modulation(RetexTileSignal *r, RetexDenoiseScratch *work, const RetexDenoiser *d, int x0, int y0)
{
    for (int c = 0; c < 3; c++)
        retex_denoise_load_plane(r->modulation[c], d->set, d->features[RETEX_FEATURE_SEEN_ALBEDO], c, x0, y0);
    for (int t = 0; t < d->set->ntargets; t++) {
        if (d->signals.covers[t] < 0)
            continue;
        retex_denoise_load_plane(work->spare, d->set, d->signals.covers[t], 0, x0, y0);
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < DENOISE_PLANE; i++)
                r->modulation[c][i] -= (1 - DENOISE_TARGET_BRIGHTNESS) * work->spare[i];
    }
}

/* The factor by which guides expect the pixel's light to be multiplied; the light is divided by it before pixels are
 * compared. Light directly from a target is proportional to the target's coverage, other light to the albedo of the
 * seen surface. Factors below LEAST_MODULATION are raised to it: guides of few samples have large relative errors
 * there. */
static void find_modulation(RetexTileSignal *r, RetexDenoiseScratch *work, const RetexDenoiser *d,
                            const RetexSignal *signal, int x0, int y0)
{
    const int sharp = signal->kind == RETEX_FOOTPRINT_SHARP && signal->target >= 0,
              any = signal->kind == RETEX_FOOTPRINT_HIT && signal->target >= 0;
    retex_denoise_load_kind(r->kind, d, signal, x0, y0);
    if (sharp)
        retex_denoise_load_plane(work->spare, d->set, signal->cover, 0, x0, y0);
    for (int i = 0; i < DENOISE_PLANE && (sharp || any); i++)
        for (int c = 0; c < 3; c++)
            r->modulation[c][i] = sharp && r->kind[i] > 0 ? work->spare[i] : 1;
    if (!sharp && !any)
        find_seen_modulation(r, work, d, x0, y0);
    for (int i = 0; i < DENOISE_PLANE; i++) {
        for (int c = 0; c < 3; c++)
            r->modulation[c][i] = fmaxf(r->modulation[c][i], LEAST_MODULATION);
        r->mean_modulation[i] = (r->modulation[0][i] + r->modulation[1][i] + r->modulation[2][i]) / 3;
    }
}

/* The part of a pixel's samples that is in the first half. */
static float first_part(const RetexDenoiser *d)
{
    return (float)(d->set->spp / 2) / (float)d->set->spp;
}

/* 1 if noise is rounded to two bits, see retex_set_round. */
static int has_rounded_noise(const RetexDenoiser *d)
{
    return d->set->nterms > 0;
}

/* Of light with other weights there is as much noise, relative to it. */
static void scale_noise(float *noise, const float *total, const float *of_noise)
{
    for (int i = 0; i < DENOISE_PLANE; i++)
        noise[i] = of_noise[i] > 0 && total[i] != of_noise[i] ? noise[i] * (total[i] / of_noise[i]) : noise[i];
}

/* Computes both halves from the total and its noise. Rounded noise may be more than the total: it is limited to that,
 * so that no half is less than 0. */
static void split_halves(RetexTileSignal *r, RetexDenoiseScratch *work, const RetexDenoiser *d,
                         const RetexSignal *signal, int x0, int y0)
{
    const float second = 2 * first_part(d), weights[2] = {2 - second, second};
    for (int c = 0; c < 3; c++) {
        retex_denoise_load_plane(work->spare, d->set, signal->noise, c, x0, y0);
        scale_noise(work->spare, r->half[0][c], r->half[1][c]);
        retex_denoise_split_plane(r->half[0][c], r->half[1][c], r->modulation[c], work->spare, weights,
                                  has_rounded_noise(d));
    }
}

/* Lowers fireflies in the halves and, in the same proportion, in the images. */
static void lower_fireflies(RetexTileSignal *r, RetexDenoiseScratch *work, const RetexDenoiser *d, const float *valid)
{
    const float part = first_part(d);
    retex_denoise_lower_fireflies(r->half, work->stays, r->kind, valid,
                                  has_rounded_noise(d) ? DENOISE_UNKNOWN_HALF : 0);
    for (int i = 0; i < DENOISE_PLANE; i++) {
        const float first = work->stays[0][i], second = work->stays[1][i];
        for (int c = 0; c < 3; c++)
            r->lost[c][i] = 0;
        for (int c = 0; c < 3 && (first < 1 || second < 1); c++) {
            const float a = r->half[0][c][i], b = r->half[1][c][i],
                        before = part * (a / first) + (1 - part) * (b / second), after = part * a + (1 - part) * b,
                        scale = before > 0 ? after / before : 1;
            r->lost[c][i] = before - after;
            for (int k = 0; k < r->nplanes; k += 3)
                r->planes[k + c][i] *= scale;
        }
    }
}

/* Lists the planes with light, and finds whether there is any. */
static int is_empty(RetexTileSignal *r)
{
    int empty = 1;
    r->nlit = 0;
    for (int k = 0; k < r->nplanes; k++) {
        if (retex_denoise_plane_is_zero(r->planes[k]))
            continue;
        r->lit_planes[r->nlit] = r->planes[k], r->lit_sums[r->nlit++] = r->sums[k];
        empty = 0;
    }
    if (r->nplanes <= 3) /* the total is filtered */
        r->nlit = 0;
    for (int c = 0; c < 3 && empty; c++)
        empty = retex_denoise_plane_is_zero(r->half[0][c]) && retex_denoise_plane_is_zero(r->half[1][c]);
    return empty;
}

static RetexDenoiseSignal start_signal(RetexTileSignal *r, RetexDenoiseScratch *work, const RetexDenoiser *d)
{
    RetexDenoiseSignal s = {.kind = r->kind,
                            .modulation = r->mean_modulation,
                            .strength = STRENGTH * STRENGTH * d->params.strength * d->params.strength,
                            .scratch = work->scratch};
    double level = 0;
    for (int c = 0; c < 3; c++) {
        s.variance[c] = r->variance[c];
        s.half[0][c] = r->half[0][c], s.half[1][c] = r->half[1][c];
        for (int i = 0; i < DENOISE_PLANE; i++)
            level += fabsf(r->half[0][c][i]);
    }
    level /= 3 * DENOISE_PLANE;
    s.epsilon = fmaxf(1e-20f, LEAST_DIFFERENCE * (float)(level * level));
    memcpy(s.candidates, r->candidates, sizeof s.candidates);
    for (int k = 0; k < DENOISE_CANDIDATES; k++)
        for (int h = 0; h < 2; h++) {
            memset(r->candidates[k].norm[h], 0, sizeof(float) * DENOISE_PIXELS);
            for (int c = 0; c < 3; c++)
                memset(r->candidates[k].sum[h][c], 0, sizeof(float) * DENOISE_PIXELS);
        }
    for (int k = 0; k < r->nplanes; k++)
        memset(r->sums[k], 0, sizeof(float) * DENOISE_PIXELS);
    return s;
}

/* ---- choosing ---- */

/* Replaces an image of the tile by its mean over `radius` pixels to each side. */
static void box(float *restrict image, float *restrict spare, int radius)
{
    for (int y = 0; y < DENOISE_TILE; y++)
        for (int x = 0; x < DENOISE_TILE; x++) {
            int x0 = x < radius ? 0 : x - radius, x1 = x + radius < DENOISE_TILE ? x + radius : DENOISE_TILE - 1;
            float sum = 0;
            for (int k = x0; k <= x1; k++)
                sum += image[y * DENOISE_TILE + k];
            spare[y * DENOISE_TILE + x] = sum / (float)(x1 - x0 + 1);
        }
    for (int y = 0; y < DENOISE_TILE; y++) {
        int y0 = y < radius ? 0 : y - radius, y1 = y + radius < DENOISE_TILE ? y + radius : DENOISE_TILE - 1;
        for (int x = 0; x < DENOISE_TILE; x++) {
            float sum = 0;
            for (int k = y0; k <= y1; k++)
                sum += spare[k * DENOISE_TILE + x];
            image[y * DENOISE_TILE + x] = sum / (float)(y1 - y0 + 1);
        }
    }
}

/* Turns the sums of the candidates into means. */
static void find_means(RetexTileSignal *r)
{
    for (int k = 0; k < DENOISE_CANDIDATES; k++)
        for (int h = 0; h < 2; h++)
            for (int c = 0; c < 3; c++) {
                float *restrict sum = r->candidates[k].sum[h][c];
                const float *restrict norm = r->candidates[k].norm[h];
                for (int i = 0; i < DENOISE_PIXELS; i++)
                    sum[i] /= norm[i];
            }
}

/* Adds the squared differences of both halves of a choice, one colour of a row, to the other halves. */
static void add_errors(float *restrict errors, const float *restrict first, const float *restrict second,
                       const float *restrict a, const float *restrict b, const float *restrict variance, float epsilon)
{
    for (int x = 0; x < DENOISE_TILE; x++) {
        const float d = first[x] - b[x], e = second[x] - a[x];
        errors[x] += (d * d + e * e) / (epsilon + variance[x]);
    }
}

/* The squared difference of each choice to the other half, in units of noise, averaged around each pixel. */
static void find_errors(const RetexTileSignal *r, RetexDenoiseScratch *work, float epsilon, const float *valid)
{
    for (int k = 0; k < CHOICES; k++) {
        float *errors = work->errors[k];
        memset(errors, 0, sizeof *errors * DENOISE_PIXELS);
        for (int y = 0; y < DENOISE_TILE; y++) {
            const size_t i = (size_t)y * DENOISE_TILE, p = denoise_at(0, y);
            for (int c = 0; c < 3; c++) {
                const float *a = r->half[0][c] + p, *b = r->half[1][c] + p,
                            *first = k ? r->candidates[k - 1].sum[0][c] + i : a,
                            *second = k ? r->candidates[k - 1].sum[1][c] + i : b;
                add_errors(errors + i, first, second, a, b, r->variance[c] + p, epsilon);
            }
            for (int x = 0; x < DENOISE_TILE; x++)
                errors[i + (size_t)x] = valid[p + (size_t)x] > 0 ? errors[i + (size_t)x] : 0;
        }
        box(errors, work->spare, ERROR_RADIUS);
    }
}

/* The choice with the smallest estimated error. The halves differ by the variance of both, V each: without a filter the
 * squared difference, counted twice, is 4V; for a candidate it is twice its own error plus V. */
static int best_choice(const RetexDenoiseScratch *work, size_t i)
{
    float variance = 0.25f * work->errors[0][i], least = variance;
    int best = 0;
    for (int k = 1; k < CHOICES; k++) {
        float error = 0.5f * work->errors[k][i] - variance;
        if (error < least)
            least = error, best = k;
    }
    return best;
}

/* A single bright path in one half: other pixels are better without it and keep their own choice. */
static int is_spike(const RetexTileSignal *r, size_t p)
{
    float squared = 0, variance = 0;
    for (int c = 0; c < 3; c++) {
        float d = r->half[0][c][p] - r->half[1][c][p];
        squared += d * d, variance += r->variance[c][p];
    }
    return squared > SPIKE * variance;
}

static void choose(RetexTileSignal *r, RetexDenoiseScratch *work, float epsilon, const float *valid)
{
    unsigned char best[DENOISE_PIXELS];
    find_means(r);
    find_errors(r, work, epsilon, valid);
    for (size_t i = 0; i < DENOISE_PIXELS; i++) {
        best[i] = (unsigned char)best_choice(work, i);
        for (int k = 0; k < CHOICES; k++)
            r->chosen[k][i] = k == best[i];
    }
    for (int k = 0; k < CHOICES; k++)
        box(r->chosen[k], work->spare, CHOICE_RADIUS);
    for (int y = 0; y < DENOISE_TILE; y++)
        for (int x = 0; x < DENOISE_TILE; x++) {
            size_t i = (size_t)y * DENOISE_TILE + (size_t)x;
            for (int k = 0; k < CHOICES && is_spike(r, denoise_at(x, y)); k++)
                r->chosen[k][i] = k == best[i];
        }
}

/* ---- the window ---- */

static void find_similarities(RetexDenoiseScratch *work, const RetexDenoiser *d, const RetexDenoiseFeatures *features)
{
    for (int n = 0; n < work->nwindow; n++)
        retex_denoise_features_kernel(work->alike + n, features, work->window[n].dx, work->window[n].dy,
                                      d->params.scalar);
}

/* Adds the pixels at `count` displacements of the window, from the `first` on, to the sums of the signal. */
static void search_part(const RetexDenoiser *d, RetexDenoiseScratch *work, const RetexDenoiseSignal *signal, int first,
                        int count)
{
    const RetexTileSignal *r = &work->signal;
    const RetexDenoiseImages images = {r->nlit, r->lit_planes, r->lit_sums};
    RETEX_ASSERT(count <= DENOISE_WEIGHTS && first + count <= work->nwindow);
    const int are_kept = r->nlit || r->nclusters;
    for (int n = 0; n < count; n += DENOISE_BATCH) {
        RetexDenoiseBatch batch = {.count = count - n < DENOISE_BATCH ? count - n : DENOISE_BATCH};
        for (int k = 0; k < batch.count; k++) {
            batch.of[k] = work->window[first + n + k], batch.alike[k] = work->alike + first + n + k;
            batch.weights[k] = are_kept ? work->weights[n + k] : NULL;
        }
        retex_denoise_signal_kernel(signal, &batch, d->params.scalar);
    }
    retex_denoise_images_kernel(&images, work->window + first, (const float *const *)work->weights, count,
                                d->params.scalar);
    for (int n = 0; n < count && r->nclusters; n++) {
        const int number = retex_tile_neighbour(d, work->window[first + n].dx, work->window[first + n].dy);
        if (number >= 0)
            memcpy(r->neighbours[number], work->weights[n], sizeof(float) * DENOISE_PIXELS);
    }
}

/* ---- the tile ---- */

static void filter_signal(const RetexDenoiser *d, RetexDenoiseScratch *work, const RetexDenoiseFeatures *features,
                          const RetexSignal *signal, int x0, int y0)
{
    RetexTileSignal *r = &work->signal;
    r->nplanes = 3 * count_images(signal, &r->nclusters);
    load_members(r, work, d, signal, x0, y0);
    find_modulation(r, work, d, signal, x0, y0);
    split_halves(r, work, d, signal, x0, y0);
    lower_fireflies(r, work, d, features->valid);
    for (int c = 0; c < 3; c++)
        retex_denoise_variance_plane(r->variance[c], r->half[0][c], r->half[1][c], work->spare);
    const RetexDenoiseSignal sums = start_signal(r, work, d);
    r->is_empty = is_empty(r);
    if (r->is_empty)
        return;
    for (int first = 0; first < work->nwindow; first += DENOISE_WEIGHTS) {
        const int left = work->nwindow - first;
        search_part(d, work, &sums, first, left < DENOISE_WEIGHTS ? left : DENOISE_WEIGHTS);
    }
    choose(r, work, sums.epsilon, features->valid);
}

static void pool_footprints(const RetexDenoiser *d, const RetexDenoiseScratch *work, int left, RetexDenoisedRows *out)
{
    const float *alike[NEIGHBOURS_MAX] = {NULL}; /* corners of the grid may lie outside of the window */
    for (int n = 0; n < work->nwindow; n++) {
        const int number = retex_tile_neighbour(d, work->window[n].dx, work->window[n].dy);
        if (number >= 0)
            alike[number] = work->alike[n].strict;
    }
    retex_tile_pool(d, alike, left, out);
}

void retex_denoise_tile(const RetexDenoiser *d, RetexDenoiseScratch *work, int left, RetexDenoisedRows *out,
                        RetexSignalSums *sums)
{
    const int x0 = left - DENOISE_MARGIN, y0 = out->first - DENOISE_MARGIN;
    RetexDenoiseFeatures features;
    retex_denoise_load_features(&features, work->features, d, x0, y0);
    find_similarities(work, d, &features);
    for (int s = 0; s < d->signals.count; s++) {
        filter_signal(d, work, &features, &d->signals.of[s], x0, y0);
        retex_tile_finish(&work->signal, d, &d->signals.of[s], left, out, &sums[s]);
    }
    if (d->params.footprints && d->footprints && d->set->nfootprints)
        pool_footprints(d, work, left, out);
}
