/* See second.h. */
#include "denoise/second.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/assert.h>
#include <retex/parallel.h>

#include "denoise/features.h"
#include "denoise/planes_kernel.h"
#include "denoise/second_kernel.h"
#include "denoise/totals.h"
#include "set/set.h"

#define LEAST_DIFFERENCE 1e-6f /* squared relative difference below which nothing is visible */
#define LARGEST 1e30f          /* of what is divided */
#define TRUST 0.5f             /* a level's estimated error must be less than so much of the first pass' */

enum { CHOICES = DENOISE_LEVELS + 1 /* as the first pass left it, and as each level does */ };

static const int steps[DENOISE_LEVELS] = {1, 4, 8};

/* How far beyond the tile each level is computed: as far as the next one reads, and the last as far as choosing reads
 * beyond the pixels that are finished. */
static const int around[DENOISE_LEVELS] = {10, 6, -2};
_Static_assert(10 + 1 + 1 <= DENOISE_HALO, "the first level and the variance read within the planes");
_Static_assert(DENOISE_MARGIN - 2 >= 2, "a choice is that of three pixels across, by errors of three across");

/* Scratch memory of a thread. */
typedef struct Scratch {
    float *memory, *features, *spare;
    RetexDenoiseLight *first, *levels[2]; /* by signal: what the first pass left; two levels in turn */
    float **kinds;
    unsigned char *empty; /* by signal: 1 = no light around the tile */
    float *epsilons;
    float **means;  /* by signal: CHOICES - 1 levels of RGB, DENOISE_PIXELS each: mean of both halves */
    float **errors; /* by signal: CHOICES times DENOISE_PIXELS */
} Scratch;

typedef struct Second {
    const RetexDenoiser *denoiser;
    RetexDenoisePassed *passed;
    Scratch *scratch;
    RetexSignalSums *sums; /* by tile of the row, then signal: added up in order */
    int y, tiles_x;
} Second;

/* ---- memory ---- */

static void close_scratch(Scratch *work)
{
    free(work->memory);
    free(work->first);
    free(work->levels[0]);
    free(work->levels[1]);
    free(work->kinds);
    free(work->empty);
    free(work->epsilons);
    free(work->means);
    free(work->errors);
}

static float *take(float **memory, size_t floats)
{
    float *taken = *memory;
    *memory += floats;
    return taken;
}

static void take_light(RetexDenoiseLight *light, float **memory)
{
    for (int c = 0; c < 3; c++) {
        light->half[0][c] = take(memory, DENOISE_PLANE), light->half[1][c] = take(memory, DENOISE_PLANE);
        light->variance[c] = take(memory, DENOISE_PLANE);
    }
}

static int open_scratch(Scratch *work, int nsignals, RetexError *err)
{
    const size_t n = (size_t)nsignals, planes = DENOISE_FEATURES_SCRATCH + 1 + (3 * 9 + 1) * n,
                 tiles = n * (3 * (CHOICES - 1) + CHOICES);
    work->memory = calloc(planes * DENOISE_PLANE + tiles * DENOISE_PIXELS, sizeof(float));
    work->first = calloc(n + 1, sizeof *work->first);
    for (int k = 0; k < 2; k++)
        work->levels[k] = calloc(n + 1, sizeof *work->levels[k]);
    work->kinds = calloc(n + 1, sizeof *work->kinds);
    work->empty = calloc(n + 1, sizeof *work->empty);
    work->epsilons = calloc(n + 1, sizeof *work->epsilons);
    work->means = calloc(n + 1, sizeof *work->means);
    work->errors = calloc(n + 1, sizeof *work->errors);
    if (!work->memory || !work->first || !work->levels[0] || !work->levels[1] || !work->kinds || !work->empty ||
        !work->epsilons || !work->means || !work->errors)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise a tile");
    float *memory = work->memory;
    work->features = take(&memory, (size_t)DENOISE_FEATURES_SCRATCH * DENOISE_PLANE);
    work->spare = take(&memory, DENOISE_PLANE);
    for (int s = 0; s < nsignals; s++) {
        take_light(&work->first[s], &memory);
        take_light(&work->levels[0][s], &memory), take_light(&work->levels[1][s], &memory);
        work->kinds[s] = take(&memory, DENOISE_PLANE);
        work->means[s] = take(&memory, 3 * (CHOICES - 1) * DENOISE_PIXELS);
        work->errors[s] = take(&memory, CHOICES * DENOISE_PIXELS);
    }
    return RETEX_OK;
}

/* ---- what the first pass left ---- */

static int clamp(int x, int least, int most)
{
    return x < least ? least : x > most ? most : x;
}

/* Loads the halves of a signal around the tile at (x0, y0). Pixels that were not filtered repeat the border. */
static void load_halves(RetexDenoiseLight *light, const Second *w, int signal, int x0, int y0)
{
    const RetexDenoiser *d = w->denoiser;
    for (int y = -DENOISE_HALO; y < DENOISE_TILE + DENOISE_HALO; y++)
        for (int x = -DENOISE_HALO; x < DENOISE_PITCH - DENOISE_HALO; x++) {
            const int row = clamp(y0 + y - w->passed->first, 0, w->passed->rows - 1),
                      column = clamp(x0 + x, d->roi.x0, d->roi.x1 - 1);
            const float *from = retex_denoise_passed_at(w->passed, d, signal, column, w->passed->first + row);
            const size_t at = denoise_at(x, y);
            for (int c = 0; c < 3; c++) {
                light->half[0][c][at] = fminf(from[DENOISE_PASSED_HALVES + c], LARGEST);
                light->half[1][c][at] = fminf(from[DENOISE_PASSED_HALVES + 3 + c], LARGEST);
            }
        }
}

/* The variance of a half: half the squared difference of both, averaged over 3 x 3 pixels. */
static void find_variance(RetexDenoiseLight *light, float *restrict spare, float epsilon)
{
    for (int c = 0; c < 3; c++) {
        const float *restrict a = light->half[0][c], *restrict b = light->half[1][c];
        float *restrict v = light->variance[c];
        for (int i = 1; i < DENOISE_PLANE - 1; i++) {
            float before = a[i - 1] - b[i - 1], here = a[i] - b[i], after = a[i + 1] - b[i + 1];
            spare[i] = before * before + here * here + after * after;
        }
        spare[0] = spare[1], spare[DENOISE_PLANE - 1] = spare[DENOISE_PLANE - 2];
        for (int i = DENOISE_PITCH; i < DENOISE_PLANE - DENOISE_PITCH; i++)
            v[i] = (spare[i - DENOISE_PITCH] + spare[i] + spare[i + DENOISE_PITCH]) / 18 + epsilon;
        for (int i = 0; i < DENOISE_PITCH; i++)
            v[i] = v[i + DENOISE_PITCH], v[DENOISE_PLANE - 1 - i] = v[DENOISE_PLANE - 1 - i - DENOISE_PITCH];
    }
}

static float find_epsilon(const RetexDenoiseLight *light)
{
    double level = 0;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < DENOISE_PLANE; i++)
            level += fabsf(light->half[0][c][i]);
    level /= 3 * DENOISE_PLANE;
    return fmaxf(1e-20f, LEAST_DIFFERENCE * (float)fmin(level * level, (double)LARGEST));
}

static int is_empty(const RetexDenoiseLight *light)
{
    int empty = 1;
    for (int k = 0; k < 6 && empty; k++)
        empty = retex_denoise_plane_is_zero(light->half[k / 3][k % 3]);
    return empty;
}

/* Pixels count where they were filtered. */
static void limit_valid(const Second *w, float *valid, int x0, int y0)
{
    const RetexRoi *roi = &w->denoiser->roi;
    const int first = w->passed->first, end = first + w->passed->rows;
    for (int y = -DENOISE_HALO; y < DENOISE_TILE + DENOISE_HALO; y++)
        for (int x = -DENOISE_HALO; x < DENOISE_PITCH - DENOISE_HALO; x++)
            if (x0 + x < roi->x0 || x0 + x >= roi->x1 || y0 + y < first || y0 + y >= end)
                valid[denoise_at(x, y)] = 0;
}

/* ---- choosing ---- */

/* How far each half, as it is now, is from what the first pass made of the other half. */
static void find_error(float *error, const RetexDenoiseLight *light, const RetexDenoiseLight *first, const float *valid)
{
    for (int y = 0; y < DENOISE_TILE; y++)
        for (int x = 0; x < DENOISE_TILE; x++) {
            const size_t p = denoise_at(x, y);
            float sum = 0;
            for (int c = 0; c < 3; c++) {
                const float a = light->half[0][c][p] - first->half[1][c][p],
                            b = light->half[1][c][p] - first->half[0][c][p];
                sum += (a * a + b * b) / first->variance[c][p];
            }
            error[y * DENOISE_TILE + x] = valid[p] > 0 ? sum : 0;
        }
}

static void keep_level(const Scratch *work, int signal, int level, const float *valid)
{
    const RetexDenoiseLight *light = &work->levels[level % 2][signal];
    float *means = work->means[signal] + (size_t)level * 3 * DENOISE_PIXELS;
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < DENOISE_TILE; y++)
            for (int x = 0; x < DENOISE_TILE; x++) {
                const size_t p = denoise_at(x, y);
                means[c * DENOISE_PIXELS + y * DENOISE_TILE + x] = 0.5f * (light->half[0][c][p] + light->half[1][c][p]);
            }
    find_error(work->errors[signal] + (size_t)(level + 1) * DENOISE_PIXELS, light, &work->first[signal], valid);
}

/* The choice with the least estimated error around the pixel. The first pass' halves differ by the variance V of both:
 * the squared difference, counted twice, is 4V. That of a level is twice its own error, and 2V. */
static int best_choice(const float *errors, int x, int y)
{
    float sums[CHOICES] = {0};
    for (int k = 0; k < CHOICES; k++)
        for (int v = y - 1; v <= y + 1; v++)
            for (int u = x - 1; u <= x + 1; u++)
                sums[k] += errors[k * DENOISE_PIXELS + v * DENOISE_TILE + u];
    const float variance = 0.25f * sums[0];
    float least = variance;
    int best = 0;
    for (int k = 1; k < CHOICES; k++) {
        const float error = 0.5f * sums[k] - variance;
        if (error < (best ? 1 : TRUST) * least)
            least = error, best = k;
    }
    return best;
}

/* The choices of a tile, but for its border of two pixels. */
static void choose(const float *errors, unsigned char *choices)
{
    for (int y = 2; y < DENOISE_TILE - 2; y++)
        for (int x = 2; x < DENOISE_TILE - 2; x++)
            choices[y * DENOISE_TILE + x] = (unsigned char)best_choice(errors, x, y);
}

/* The mean of what is chosen for the pixel and those around it. */
static void mix_choices(float light[3], const Scratch *work, int signal, const unsigned char *choices,
                        const float *valid, int x, int y)
{
    const RetexDenoiseLight *first = &work->first[signal];
    const int i = y * DENOISE_TILE + x;
    int counts[CHOICES] = {0}, count = 0;
    for (int v = y - 1; v <= y + 1; v++)
        for (int u = x - 1; u <= x + 1; u++)
            if (valid[denoise_at(u, v)] > 0)
                counts[choices[v * DENOISE_TILE + u]]++, count++;
    RETEX_ASSERT(count > 0); /* the pixel was filtered itself */
    for (int c = 0; c < 3; c++) {
        const size_t p = denoise_at(x, y);
        float sum = (float)counts[0] * 0.5f * (first->half[0][c][p] + first->half[1][c][p]);
        for (int k = 1; k < CHOICES; k++)
            sum += (float)counts[k] * work->means[signal][((k - 1) * 3 + c) * DENOISE_PIXELS + i];
        light[c] = fmaxf(0, sum / (float)count);
    }
}

/* ---- tiles ---- */

static float factor_of(float light, float before)
{
    const float quotient = light / before;
    return before > 0 && quotient < LARGEST ? quotient : 1;
}

/* Writes the factors of one signal over a tile. */
static void store_factors(const Second *w, const Scratch *work, const float *valid, int signal, int x0, int y0,
                          RetexSignalSums *sums)
{
    const RetexDenoiser *d = w->denoiser;
    unsigned char choices[DENOISE_PIXELS];
    choose(work->errors[signal], choices);
    for (int y = DENOISE_MARGIN; y < DENOISE_MARGIN + DENOISE_STEP && y0 + y < d->roi.y1; y++)
        for (int x = DENOISE_MARGIN; x < DENOISE_MARGIN + DENOISE_STEP && x0 + x < d->roi.x1; x++) {
            float *passed = retex_denoise_passed_at(w->passed, d, signal, x0 + x, y0 + y), light[3];
            float *total = passed + DENOISE_PASSED_TOTAL, old[3], new[3];
            mix_choices(light, work, signal, choices, valid, x, y);
            for (int c = 0; c < 3; c++) {
                const float half = passed[DENOISE_PASSED_HALVES + c] + passed[DENOISE_PASSED_HALVES + 3 + c];
                old[c] = total[c];
                new[c] = total[c] * factor_of(light[c], fmaxf(0, 0.5f * half));
            }
            retex_denoise_mix_total(old, d, signal, x0 + x, y0 + y);
            retex_denoise_mix_total(new, d, signal, x0 + x, y0 + y);
            for (int c = 0; c < 3; c++) {
                total[c] = factor_of(new[c], old[c]); /* which no other pixel reads */
                sums->after[c] += old[c] * total[c];
            }
        }
}

/* Loads a signal around the tile, and how far its halves are apart. */
static void load_signal(const Second *w, const Scratch *work, int signal, const float *valid, int x0, int y0)
{
    const RetexDenoiser *d = w->denoiser;
    RetexDenoiseLight *first = &work->first[signal];
    load_halves(first, w, signal, x0, y0);
    work->empty[signal] = (unsigned char)is_empty(first);
    if (work->empty[signal]) {
        memset(work->means[signal], 0, 3 * (CHOICES - 1) * DENOISE_PIXELS * sizeof(float));
        memset(work->errors[signal], 0, CHOICES * DENOISE_PIXELS * sizeof(float));
        return;
    }
    work->epsilons[signal] = find_epsilon(first);
    find_variance(first, work->spare, work->epsilons[signal]);
    retex_denoise_load_kind(work->kinds[signal], d, &d->signals.of[signal], x0, y0);
    find_error(work->errors[signal], first, first, valid);
}

/* Makes a level of all signals: the first of what the first pass left, each other of the one before it. */
static void make_level(const Second *w, const Scratch *work, const RetexDenoiseFeatures *features, int number)
{
    const RetexDenoiser *d = w->denoiser;
    const RetexDenoiseLevel level = {.step = steps[number],
                                     .around = around[number],
                                     .features = features,
                                     .nsignals = d->signals.count,
                                     .kinds = (const float *const *)work->kinds,
                                     .empty = work->empty,
                                     .epsilons = work->epsilons,
                                     .from = number ? work->levels[(number + 1) % 2] : work->first,
                                     .to = work->levels[number % 2]};
    retex_denoise_level_kernel(&level, d->params.scalar);
    for (int signal = 0; signal < d->signals.count; signal++)
        if (!work->empty[signal])
            keep_level(work, signal, number, features->valid);
}

static void second_job(void *context, int index, int thread)
{
    const Second *w = context;
    const RetexDenoiser *d = w->denoiser;
    const Scratch *work = &w->scratch[thread];
    const int x0 = d->roi.x0 + index * DENOISE_STEP - DENOISE_MARGIN, y0 = w->y - DENOISE_MARGIN;
    RetexSignalSums *sums = w->sums + (size_t)index * (size_t)d->signals.count;
    RetexDenoiseFeatures features;
    if (retex_budget_is_stopped(d->params.budget))
        return;
    retex_denoise_load_features(&features, work->features, d, x0, y0);
    limit_valid(w, features.valid, x0, y0);
    for (int signal = 0; signal < d->signals.count; signal++)
        load_signal(w, work, signal, features.valid, x0, y0);
    for (int level = 0; level < DENOISE_LEVELS; level++)
        make_level(w, work, &features, level);
    for (int signal = 0; signal < d->signals.count; signal++)
        store_factors(w, work, features.valid, signal, x0, y0, &sums[signal]);
}

static void add_sums(const Second *w, RetexSignalSums *sums)
{
    const int count = w->denoiser->signals.count;
    for (int k = 0; k < w->tiles_x * count; k++)
        for (int c = 0; c < 3; c++)
            sums[w->denoiser->first_signal + k % count].after[c] += w->sums[k].after[c];
}

int retex_denoise_second(const RetexDenoiser *d, RetexDenoisePassed *passed, RetexSignalSums *sums, int nthreads,
                         RetexError *err)
{
    const int threads = retex_threads(nthreads), tiles_x = (d->roi.x1 - d->roi.x0 + DENOISE_STEP - 1) / DENOISE_STEP;
    Second w = {.denoiser = d, .passed = passed, .tiles_x = tiles_x};
    int code = RETEX_OK;
    w.scratch = calloc((size_t)threads, sizeof *w.scratch);
    w.sums = calloc((size_t)tiles_x * (size_t)d->signals.count + 1, sizeof *w.sums);
    if (!w.scratch || !w.sums)
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    for (int k = 0; k < threads && k < tiles_x && !code; k++)
        code = open_scratch(&w.scratch[k], d->signals.count, err);
    for (w.y = d->roi.y0; w.y < d->roi.y1 && !code; w.y += DENOISE_STEP) {
        memset(w.sums, 0, sizeof *w.sums * (size_t)tiles_x * (size_t)d->signals.count);
        retex_parallel(threads, tiles_x, second_job, &w);
        code = retex_budget_check(d->params.budget, err);
        if (!code)
            add_sums(&w, sums);
    }
    for (int k = 0; w.scratch && k < threads; k++)
        close_scratch(&w.scratch[k]);
    free(w.scratch);
    free(w.sums);
    return code;
}
