/* See compact_meter.h. The textures are plane waves in each colour, whose mean over a Gaussian footprint is known. */
#include "compact_meter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>
#include <retex/sample.h>

#include "compact_build.h"
#include "set_parts.h"

#define WAVE_TRIALS (COMPACT_TRIALS - 1)
#define TILE 64   /* pixels of a tile that count */
#define MARGIN 16 /* on each side: two pixels of what is smallest */
#define TILES_MOST 16

/* ---- tiles ---- */

typedef struct Mosaic {
    int columns, rows, count; /* of the picture's tiles; how many are taken */
} Mosaic;

/* The picture's tile that is taken as the k-th, evenly in the order of reading. */
static void find_tile(const Mosaic *mosaic, int k, int *x, int *y)
{
    const int all = mosaic->columns * mosaic->rows, place = (int)(((long)2 * k + 1) * all / (2L * mosaic->count));
    *x = place % mosaic->columns * TILE - MARGIN;
    *y = place / mosaic->columns * TILE - MARGIN;
}

static void copy_tile(RetexImage *to, int row, const RetexImage *from, int x, int y)
{
    const int side = TILE + 2 * MARGIN;
    for (int j = 0; j < side; j++)
        for (int i = 0; i < side; i++) {
            int fx = x + i < 0 ? 0 : x + i, fy = y + j < 0 ? 0 : y + j;
            fx = fx < from->width ? fx : from->width - 1;
            fy = fy < from->height ? fy : from->height - 1;
            memcpy(to->pixels + retex_image_index(to, i, row * side + j),
                   from->pixels + retex_image_index(from, fx, fy), (size_t)from->channels * sizeof(float));
        }
}

/* A set as tall as tiles are many. Originals and what no term needs become black. */
static int make_mosaic(RetexSet **result, const RetexSet *set, const Mosaic *mosaic, RetexError *err)
{
    const int side = TILE + 2 * MARGIN;
    int code = compact_copy_head(result, set, err);
    if (code)
        return code;
    RetexSet *tiles = *result;
    tiles->width = side, tiles->height = side * mosaic->count;
    for (int i = 0; i < set->nparts && !code; i++) {
        const RetexPart *part = &set->parts[i];
        const int whole = part->image.width == set->width && part->image.height == set->height;
        code =
            retex_set_add_part(tiles, part->name, part->letters, part->type, whole ? 0 : 1, whole ? 0 : 1, NULL, err);
        for (int k = 0; k < mosaic->count && !code && whole; k++) {
            int x, y;
            find_tile(mosaic, k, &x, &y);
            copy_tile(&tiles->parts[i].image, k, &part->image, x, y);
        }
    }
    for (int i = 0; i < set->nfootprints && !code; i++)
        code = retex_set_add_footprint(tiles, &set->footprints[i], NULL, err);
    for (int i = 0; i < set->nmixtures && !code; i++)
        code = retex_set_add_mixture(tiles, &set->mixtures[i], NULL, err);
    for (int i = 0; i < set->nterms && !code; i++)
        code = retex_set_add_term(tiles, &set->terms[i], NULL, err);
    return code;
}

static int copy_whole(RetexSet **result, const RetexSet *set, RetexError *err)
{
    int code = compact_copy_head(result, set, err), index;
    for (int i = 0; i < set->nparts && !code; i++)
        code = compact_copy_part(*result, &set->parts[i], &index, err);
    for (int i = 0; i < set->nfootprints && !code; i++)
        code = retex_set_add_footprint(*result, &set->footprints[i], NULL, err);
    for (int i = 0; i < set->nmixtures && !code; i++)
        code = retex_set_add_mixture(*result, &set->mixtures[i], NULL, err);
    for (int i = 0; i < set->nterms && !code; i++)
        code = retex_set_add_term(*result, &set->terms[i], NULL, err);
    return code;
}

/* ---- textures ---- */

/* One colour of a texture: 1/2 + 1/2 cos 2 pi (u fu + v fv + phase). */
typedef struct Wave {
    double frequency[2], phase;
} Wave;

/* Waves of a trial, about four times as many a unit of UV as in the one before it; other ones for each colour and
 * target, and whole ones where a target closes. */
static Wave make_wave(const RetexTarget *target, int number, int trial, int color)
{
    const double turn = 2.4 * (number + 3 * trial + 7 * color), many = 0.4 * pow(4, trial) * (1 + 0.4 * color);
    Wave wave = {{many * cos(turn), many * sin(turn)}, 0.3 * color + 0.17 * number};
    for (int axis = 0; axis < 2; axis++)
        if (target->periodic[axis])
            wave.frequency[axis] = rint(wave.frequency[axis]);
    return wave;
}

typedef struct SampleWork {
    const RetexSet *set;
    const RetexFootprint *footprint;
    RetexImage *image;
    Wave waves[3];
} SampleWork;

static void sample_row(void *context, int y, int thread)
{
    const SampleWork *work = context;
    const RetexImage *uvs = &work->set->parts[work->footprint->uv].image;
    const RetexImage *spreads = &work->set->parts[work->footprint->spread].image;
    (void)thread;
    for (int x = 0; x < work->image->width; x++) {
        const float *uv = uvs->pixels + retex_image_index(uvs, x, y);
        const float *spread = spreads->pixels + retex_image_index(spreads, x, y);
        float *out = work->image->pixels + retex_image_index(work->image, x, y);
        for (int c = 0; c < 3 && uv[2] > 0; c++) {
            const double *f = work->waves[c].frequency;
            const double a = f[0] * (double)spread[0], b = f[1] * (double)spread[1];
            const double variance = a * a + b * b + 2 * (double)spread[2] * a * b;
            const double angle = f[0] * (double)uv[0] + f[1] * (double)uv[1] + work->waves[c].phase;
            out[c] = (float)(0.5 + 0.5 * cos(2 * M_PI * angle) * exp(-2 * M_PI * M_PI * variance));
        }
    }
}

static int sample_waves(RetexSamples **result, const RetexSet *set, int trial, int nthreads, RetexError *err)
{
    RetexSamples *samples = *result = calloc(1, sizeof *samples);
    if (samples)
        samples->images = calloc((size_t)set->nfootprints + 1, sizeof *samples->images);
    if (!samples || !samples->images)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for samples");
    samples->width = set->width, samples->height = set->height;
    samples->ntargets = set->ntargets, samples->nimages = set->nfootprints;
    for (int t = 0; t < set->ntargets; t++)
        memcpy(samples->target_names[t], set->targets[t].name, sizeof samples->target_names[t]);
    for (int i = 0; i < set->nfootprints; i++) {
        const RetexFootprint *f = &set->footprints[i];
        const RetexImage *uv = &set->parts[f->uv].image;
        SampleWork work = {.set = set, .footprint = f, .image = &samples->images[i]};
        int code = retex_image_alloc(&samples->images[i], uv->width, uv->height, 3, err);
        if (code)
            return code;
        for (int c = 0; c < 3; c++)
            work.waves[c] = make_wave(&set->targets[f->target], f->target, trial, c);
        samples->footprint_target[i] = f->target;
        samples->footprint_hit[i] = f->hit;
        retex_parallel(nthreads, uv->height, sample_row, &work);
    }
    return RETEX_OK;
}

/* ---- pictures ---- */

static float encoded(float x)
{
    if (!(x > 0))
        return 0;
    return x >= 1 ? 1 : x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1 / 2.4f) - 0.055f;
}

static void encode_row(void *context, int y, int thread)
{
    RetexImage *image = context;
    float *row = image->pixels + retex_image_index(image, 0, y);
    (void)thread;
    for (int i = 0; i < 3 * image->width; i++)
        row[i] = encoded(row[i]);
}

static int make_picture(RetexImage *picture, const RetexSet *set, int trial, int nthreads, RetexError *err)
{
    RetexSamples *samples = NULL;
    int code = trial < WAVE_TRIALS ? sample_waves(&samples, set, trial, nthreads, err) : RETEX_OK;
    if (!code)
        code = retex_combine(picture, set, samples, NULL, NULL, nthreads, err);
    if (!code)
        retex_parallel(nthreads, picture->height, encode_row, picture);
    retex_samples_close(&samples);
    return code;
}

/* Parts of noise on a picture of the originals, those of targets by half, for they are divided so. */
static int measure_noise(CompactMeter *meter, int nthreads, RetexError *err)
{
    const RetexSet *set = meter->set;
    RetexImage picture = {0}, noise = {0};
    double sum = 0;
    int code = retex_combine(&picture, set, NULL, NULL, NULL, nthreads, err);
    if (!code)
        code = retex_image_copy(&noise, &picture, err);
    const size_t count = (size_t)set->width * (size_t)set->height * 3;
    for (int i = 1; i < set->nparts && !code; i++) {
        const RetexPart *part = &set->parts[i];
        const float share = strcmp(part->name, "noise_indep") == 0 ? 1 : 0.5f;
        if (!part_is_denoise_data(set, i) || strncmp(part->name, "noise_", 6) != 0 || part->image.channels != 3)
            continue;
        for (size_t k = 0; k < count; k++)
            noise.pixels[k] += share * part->image.pixels[k];
    }
    for (size_t k = 0; k < count && !code; k++) {
        const double d = (double)encoded(noise.pixels[k]) - (double)encoded(picture.pixels[k]);
        sum += d * d;
    }
    meter->noise = code ? 0 : sum / (double)count;
    retex_image_free(&picture);
    retex_image_free(&noise);
    return code;
}

int compact_meter_open(CompactMeter *meter, const RetexSet *set, int nthreads, RetexError *err)
{
    Mosaic mosaic = {(set->width + TILE - 1) / TILE, (set->height + TILE - 1) / TILE, TILES_MOST};
    *meter = (CompactMeter){0};
    const int small = mosaic.columns * mosaic.rows <= 3 * TILES_MOST;
    meter->tile = small ? 0 : TILE + 2 * MARGIN;
    int code = small ? copy_whole(&meter->set, set, err) : make_mosaic(&meter->set, set, &mosaic, err);
    for (int i = 0; i < COMPACT_TRIALS && !code; i++)
        code = make_picture(&meter->pictures[i], meter->set, i, nthreads, err);
    if (!code)
        code = measure_noise(meter, nthreads, err);
    if (code)
        compact_meter_close(meter);
    return code;
}

void compact_meter_close(CompactMeter *meter)
{
    for (int i = 0; i < COMPACT_TRIALS; i++)
        retex_image_free(&meter->pictures[i]);
    retex_set_close(&meter->set);
}

static int counts(const CompactMeter *meter, int x, int y)
{
    const int last = meter->tile - MARGIN, row = meter->tile ? y % meter->tile : 0;
    return !meter->tile || (x >= MARGIN && x < last && row >= MARGIN && row < last);
}

int compact_meter_read(const CompactMeter *meter, const RetexSet *compact, double squares[COMPACT_TRIALS], int nthreads,
                       RetexError *err)
{
    for (int i = 0; i < COMPACT_TRIALS; i++) {
        RetexImage picture = {0};
        const RetexImage *should = &meter->pictures[i];
        double sum = 0, count = 0;
        int code = make_picture(&picture, compact, i, nthreads, err);
        for (int y = 0; y < should->height && !code; y++)
            for (int x = 0; x < should->width; x++) {
                if (!counts(meter, x, y))
                    continue;
                const size_t first = retex_image_index(should, x, y);
                for (size_t c = first; c < first + 3; c++) {
                    const double d = (double)picture.pixels[c] - (double)should->pixels[c];
                    sum += d * d;
                }
                count += 3;
            }
        retex_image_free(&picture);
        if (code)
            return code;
        squares[i] = sum / count;
    }
    return RETEX_OK;
}
