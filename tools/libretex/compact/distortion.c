/* See distortion.h. The trial textures are plane waves in each channel, whose mean over a Gaussian footprint is known
 * in closed form. */
#include "compact/distortion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color.h>
#include <retex/combine.h>
#include <retex/host/set_build.h>
#include <retex/parallel.h>
#include <retex/samples.h>

#include "compact/strips.h"
#include "compact/build.h"
#include "compact/image_noise.h"
#include "set/noise.h"
#include "set/samples.h"
#include "set/set.h"

#define TILE RETEX_COMPACT_STRIP_ROWS /* side of a tile in pixels, without margins */
#define MARGIN 16                     /* pixels on each side: two pixels of an image of scale 8 */
#define LENGTHS 3                     /* trials with waves, one for each wavelength; other trials have flat colours */
#define FLAT 1                        /* variance in wavelengths at which a filtered wave is flat */
#define PROBE 8                       /* distance in pixels of the samples by which difficulty is estimated */

/* ---- tiles ---- */

typedef struct Tile {
    int x, y; /* first pixel, without the margin */
    double difficulty;
} Tile;

typedef struct Mosaic {
    const RetexCompactLight *light; /* the light of a strip */
    int first, height;              /* first: the strip's first row; height: of the picture */
    RetexSet *result;
    int columns, count; /* tiles of the picture: in a row, and in all */
    Tile *tiles;
    Tile taken[RETEX_COMPACT_TILES];
} Mosaic;

/* A pixel's light, each cluster weighted by how far its UV is from that cluster's UV in another pixel. */
static double probe_pixels(const RetexCompactLight *light, size_t a, size_t b)
{
    const RetexSet *set = light->set;
    double sum = 0;
    for (int i = 0; i < light->nkinds; i++) {
        const RetexCompactKind *kind = &light->kinds[i];
        RetexCompactClusterLight of[RETEX_SHARES_MAX];
        if (kind->kind == RETEX_FOOTPRINT_INTERREFLECTION)
            continue;
        retex_compact_cluster_light(light, kind, RETEX_COMPACT_ALL_LAMPS, a, of);
        for (int k = 0; k < kind->count; k++) {
            const RetexFootprint *f = &set->footprints[kind->footprints[k]];
            float uv[2][3], spread[2][3];
            retex_footprint_ellipse(set, f, a, uv[0], spread[0]);
            retex_footprint_ellipse(set, f, b, uv[1], spread[1]);
            const double weight = retex_compact_luminance(of[k].single) + retex_compact_luminance(of[k].interreflected);
            double far = 0;
            for (int axis = 0; axis < 2 && weight > 0; axis++) {
                const double d = (double)uv[0][axis] - (double)uv[1][axis];
                const double s = (double)spread[0][axis] + (double)spread[1][axis];
                far += d * d / (d * d + s * s + 1e-12);
            }
            sum += weight > 0 && isfinite(weight) ? weight * far : 0;
        }
    }
    return sum;
}

static void find_difficulty(void *context, int column, int thread)
{
    const Mosaic *mosaic = context;
    const RetexSet *set = mosaic->light->set;
    Tile *tile = &mosaic->tiles[mosaic->first / TILE * mosaic->columns + column];
    (void)thread;
    *tile = (Tile){column * TILE, mosaic->first, 0};
    for (int y = 0; y + 1 < set->height; y += PROBE)
        for (int x = tile->x; x < tile->x + TILE && x + 1 < set->width; x += PROBE) {
            const size_t a = (size_t)y * (size_t)set->width + (size_t)x;
            tile->difficulty += probe_pixels(mosaic->light, a, a + (size_t)set->width + 1);
        }
}

static int compare_tiles(const void *a, const void *b)
{
    const Tile *one = a, *other = b;
    if (one->difficulty != other->difficulty)
        return one->difficulty < other->difficulty ? -1 : 1;
    const int below = (one->y > other->y) - (one->y < other->y);
    return below ? below : (one->x > other->x) - (one->x < other->x);
}

/* Choose the tiles that represent the picture. Tiles are sorted by difficulty and divided into strata of equal sums of
 * half their share of the difficulty plus half their share of the number. The median tile represents its stratum. */
static void choose_tiles(Mosaic *mosaic, double weights[RETEX_COMPACT_TILES])
{
    double all = 0, sum = 0;
    int first = 0;
    qsort(mosaic->tiles, (size_t)mosaic->count, sizeof *mosaic->tiles, compare_tiles);
    for (int i = 0; i < mosaic->count; i++)
        all += mosaic->tiles[i].difficulty;
    for (int i = 0, k = 0; i < mosaic->count && k < RETEX_COMPACT_TILES; i++) {
        const int left = mosaic->count - 1 - i, strata = RETEX_COMPACT_TILES - 1 - k; /* still to come */
        sum += 0.5 / mosaic->count + (all > 0 ? 0.5 * mosaic->tiles[i].difficulty / all : 0.5 / mosaic->count);
        if (left > strata && (k == RETEX_COMPACT_TILES - 1 || sum < (k + 1.0) / RETEX_COMPACT_TILES))
            continue;
        mosaic->taken[k] = mosaic->tiles[(first + i) / 2];
        weights[k++] = i + 1 - first;
        first = i + 1;
    }
}

static int clamp(int at, int size)
{
    return at < 0 ? 0 : at < size ? at : size - 1;
}

/* Copy the rows of a tile that are in the strip. */
static void copy_tile(RetexImage *to, int row, const RetexImage *from, const Mosaic *mosaic)
{
    const int side = TILE + 2 * MARGIN, x = mosaic->taken[row].x - MARGIN, y = mosaic->taken[row].y - MARGIN;
    for (int j = 0; j < side; j++) {
        const int fy = clamp(y + j, mosaic->height) - mosaic->first;
        for (int i = 0; i < side && fy >= 0 && fy < from->height; i++)
            memcpy(to->pixels + retex_image_index(to, i, row * side + j),
                   from->pixels + retex_image_index(from, clamp(x + i, from->width), fy),
                   (size_t)from->channels * sizeof(float));
    }
}

static int copy_tiles(void *context, const RetexCompactLight *light, int first, RetexError *err)
{
    Mosaic *mosaic = context;
    (void)err;
    mosaic->first = first;
    for (int i = 0; i < light->set->nparts; i++)
        for (int k = 0; k < RETEX_COMPACT_TILES && light->set->parts[i].image.pixels; k++)
            copy_tile(&mosaic->result->parts[i].image, k, &light->set->parts[i].image, mosaic);
    return RETEX_OK;
}

/* Make a set of the chosen tiles, one below the other. Originals, and parts that no term needs, become black. */
static int make_mosaic(RetexSet **result, const RetexCompactLight *light, Mosaic *mosaic, int nthreads, RetexError *err)
{
    const RetexSet *set = light->set;
    const int side = TILE + 2 * MARGIN;
    int code = retex_compact_copy_head(result, set, err);
    if (code)
        return code;
    RetexSet *tiles = mosaic->result = *result;
    tiles->width = side, tiles->height = side * RETEX_COMPACT_TILES;
    for (int i = 0; i < set->nparts && !code; i++) {
        const RetexPart *part = &set->parts[i];
        const int whole = part->image.width == set->width && part->image.height == set->height;
        code =
            retex_set_add_part(tiles, part->name, part->letters, part->type, whole ? 0 : 1, whole ? 0 : 1, NULL, err);
    }
    if (!code)
        code = retex_compact_strips(light, copy_tiles, mosaic, nthreads, err);
    return code ? code : retex_compact_copy_terms(tiles, set, err);
}

static int copy_whole(RetexSet **result, const RetexSet *set, RetexError *err)
{
    int code = retex_compact_copy_head(result, set, err), index;
    for (int i = 0; i < set->nparts && !code; i++)
        code = retex_compact_copy_part(*result, set, i, &index, err);
    return code ? code : retex_compact_copy_terms(*result, set, err);
}

/* ---- textures ---- */

/* One colour of a texture: 1/2 + 1/2 cos 2 pi (u fu + v fv + phase). */
typedef struct Wave {
    double frequency[2], phase;
} Wave;

/* The wave of a trial texture. Each trial has about four times the frequency of the one before. Frequency and phase
 * differ by colour channel and target; frequencies are integers along axes on which the target is periodic. The last
 * two trials have flat colours, dark or light: far from RETEX_COMPACT_GREY, for which gains are exact. */
static Wave make_wave(const RetexTarget *target, int number, int trial, int color)
{
    const double turn = 2.4 * (number + 3 * trial + 7 * color), many = 0.4 * pow(4, trial) * (1 + 0.4 * color);
    Wave wave = {{many * cos(turn), many * sin(turn)}, 0.3 * color + 0.17 * number};
    if (trial >= LENGTHS)
        return (Wave){{0, 0}, (number + trial + (color == 1)) % 2 ? 0.43 : 0.07};
    for (int axis = 0; axis < 2; axis++)
        if (target->periodic[axis])
            wave.frequency[axis] = rint(wave.frequency[axis]);
    return wave;
}

typedef struct WaveWork {
    const RetexSet *set;
    const RetexFootprint *footprint;
    RetexImage *image;
    Wave waves[3];
} WaveWork;

static void wave_row(void *context, int y, int thread)
{
    const WaveWork *work = context;
    const size_t width = (size_t)work->image->width, first = 3 * width * (size_t)y;
    (void)thread;
    for (size_t i = first; i < first + 3 * width; i += 3) {
        float *out = work->image->pixels + i, uv[3], spread[3];
        retex_footprint_ellipse(work->set, work->footprint, i / 3, uv, spread);
        for (int c = 0; c < 3 && uv[2] > 0; c++) {
            const double *f = work->waves[c].frequency;
            const double a = f[0] * (double)spread[0], b = f[1] * (double)spread[1];
            const double variance = a * a + b * b + 2 * (double)spread[2] * a * b;
            const double angle = f[0] * (double)uv[0] + f[1] * (double)uv[1] + work->waves[c].phase;
            out[c] = 0.5f;
            if (variance < FLAT)
                out[c] += (float)(0.5 * cos(2 * M_PI * angle) * exp(-2 * M_PI * M_PI * variance));
        }
    }
}

/* Filter a trial texture at one footprint. */
static int make_waves(RetexImage *image, const RetexSet *set, int footprint, int trial, int nthreads, RetexError *err)
{
    const RetexFootprint *f = &set->footprints[footprint];
    const RetexImage *uv = &set->parts[f->uv].image;
    WaveWork work = {set, f, image, {{{0}, 0}}};
    int code = retex_image_alloc(image, uv->width, uv->height, 3, err);
    if (code)
        return code;
    for (int c = 0; c < 3; c++)
        work.waves[c] = make_wave(&set->targets[f->target], f->target, trial, c);
    retex_parallel(nthreads, uv->height, wave_row, &work);
    return RETEX_OK;
}

/* ---- pictures ---- */

static float encoded(float x)
{
    if (!(x > 0))
        return 0;
    return x >= 1 ? 1 : retex_srgb_encodef(x);
}

static void encode_row(void *context, int y, int thread)
{
    RetexImage *image = context;
    float *row = image->pixels + retex_image_index(image, 0, y);
    (void)thread;
    for (int i = 0; i < 3 * image->width; i++)
        row[i] = encoded(row[i]);
}

/* What single lamps have of all light is not searched so, see lamps.h. */
static int trial_count(const RetexSet *set)
{
    int lamps = 0;
    for (int i = 0; i < set->nparameters && !retex_set_has_role(set, RETEX_ROLE_LAMP); i++)
        lamps += set->parameters[i].kind == RETEX_PARAMETER_COLOR;
    return RETEX_COMPACT_TEXTURE_TRIALS + 2 * (lamps < RETEX_COMPACT_LAMP_PARTS ? lamps : RETEX_COMPACT_LAMP_PARTS);
}

/* A trial's texture: with lamps off, waves of the middle length, or a flat colour. */
static int trial_texture(int trial)
{
    const int lamps = trial - RETEX_COMPACT_TEXTURE_TRIALS;
    return lamps < 0 ? trial : lamps % 2 ? LENGTHS : 1;
}

/* The parameters of a trial with lamps off; those that were off already are on. Every third lamp is of one part. */
static void switch_lamps(float values[][3], const RetexSet *set, int trial)
{
    const int part = (trial - RETEX_COMPACT_TEXTURE_TRIALS) / 2;
    for (int i = 0, lamp = 0; i < set->nparameters; i++) {
        const float *value = set->parameters[i].value;
        const int black = value[0] == 0 && value[1] == 0 && value[2] == 0;
        const int off = set->parameters[i].kind == RETEX_PARAMETER_COLOR && lamp++ % RETEX_COMPACT_LAMP_PARTS == part;
        for (int c = 0; c < 3; c++)
            values[i][c] = off ? (float)black : value[c];
    }
}

/* Make the linear picture of one trial. waves: a cache of filtered trial textures by footprint, which is filled as
 * needed; or NULL. */
static int make_picture(RetexImage *picture, const RetexSet *set, RetexImage *waves[][RETEX_COMPACT_WAVES], int trial,
                        int nthreads, RetexError *err)
{
    RetexSamples *samples = NULL;
    RetexCombineParams params = RETEX_COMBINE_INIT;
    float values[RETEX_PARAMETERS_MAX][3];
    const int texture = trial_texture(trial);
    int code = texture < RETEX_COMPACT_WAVES ? retex_samples_create(&samples, set, err) : RETEX_OK;
    for (int i = 0; texture < RETEX_COMPACT_WAVES && i < set->nfootprints && !code; i++) {
        RetexImage *image = waves ? waves[i][texture] : &samples->images[i];
        if (!image->pixels)
            code = make_waves(image, set, i, texture, nthreads, err);
        samples->images[i] = *image;
    }
    if (trial >= RETEX_COMPACT_TEXTURE_TRIALS) {
        switch_lamps(values, set, trial);
        params.parameters = values[0];
    }
    if (!code)
        code = retex_combine(picture, set, samples, &params, NULL, nthreads, err);
    if (samples && waves) /* the cache owns them */
        memset(samples->images, 0, (size_t)set->nfootprints * sizeof *samples->images);
    retex_samples_close(&samples);
    return code;
}

int retex_compact_trial_pictures(RetexImage pictures[RETEX_COMPACT_TRIALS], const RetexCompactLight *light, int kind,
                                 const RetexCompactScales *scales, RetexCompactCache *cache, int nthreads,
                                 RetexError *err)
{
    RetexSet *set;
    RetexImage *waves[RETEX_COMPACT_KINDS * RETEX_SHARES_MAX][RETEX_COMPACT_WAVES];
    int code = retex_compact_build_kind(&set, waves, light, kind, scales, cache, nthreads, err);
    for (int i = 0; !code && i < trial_count(set); i++)
        code = make_picture(&pictures[i], set, waves, i, nthreads, err);
    retex_set_close(&set);
    return code;
}

/* Estimate the mean square noise of the picture. Sets that are not denoised have parts of noise, which are added to the
 * picture. Denoised sets do not have them: their remaining noise is estimated from the high frequencies of a trial
 * picture of flat colours. */
static int measure_noise(RetexCompactReference *reference, int nthreads, RetexError *err)
{
    const RetexSet *set = reference->set;
    RetexImage picture = {0}, noise = {0};
    double sum = 0;
    if (set->denoised) {
        reference->noise = pow(RETEX_DENOISED_NOISE * retex_image_noise(&reference->pictures[LENGTHS], 255) / 255, 2);
        return RETEX_OK;
    }
    int code = retex_combine(&picture, set, NULL, NULL, NULL, nthreads, err);
    if (!code)
        code = retex_image_copy(&noise, &picture, err);
    const size_t count = (size_t)set->width * (size_t)set->height * 3;
    if (!code)
        code = retex_set_add_noise(noise.pixels, set, 0, set->height, err);
    for (size_t k = 0; k < count && !code; k++) {
        const double d = (double)encoded(noise.pixels[k]) - (double)encoded(picture.pixels[k]);
        sum += d * d;
    }
    reference->noise = code ? 0 : sum / (double)count;
    retex_image_free(&picture);
    retex_image_free(&noise);
    return code;
}

typedef struct Probing {
    Mosaic *mosaic;
    int nthreads;
} Probing;

static int probe_strip(void *context, const RetexCompactLight *light, int first, RetexError *err)
{
    const Probing *probing = context;
    (void)err;
    probing->mosaic->light = light, probing->mosaic->first = first;
    retex_parallel(probing->nthreads, probing->mosaic->columns, find_difficulty, probing->mosaic);
    return RETEX_OK;
}

static int set_mosaic(RetexCompactReference *reference, const RetexCompactLight *light, int nthreads, RetexError *err)
{
    const RetexSet *set = light->set;
    Mosaic mosaic = {.columns = (set->width + TILE - 1) / TILE, .height = set->height};
    Probing probing = {&mosaic, nthreads};
    mosaic.count = mosaic.columns * ((set->height + TILE - 1) / TILE);
    if (mosaic.count <= 3 * RETEX_COMPACT_TILES)
        return copy_whole(&reference->set, set, err);
    reference->tile = TILE + 2 * MARGIN;
    mosaic.tiles = malloc((size_t)mosaic.count * sizeof *mosaic.tiles);
    if (!mosaic.tiles)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for tiles");
    int code = retex_compact_strips(light, probe_strip, &probing, nthreads, err);
    if (!code) {
        choose_tiles(&mosaic, reference->weights);
        code = make_mosaic(&reference->set, light, &mosaic, nthreads, err);
    }
    free(mosaic.tiles);
    return code;
}

int retex_compact_reference_open(RetexCompactReference *reference, const RetexCompactLight *light, int nthreads,
                                 RetexError *err)
{
    *reference = (RetexCompactReference){0};
    int code = set_mosaic(reference, light, nthreads, err);
    for (int i = 0; !code && i < trial_count(reference->set); i++) {
        RetexImage *picture = &reference->pictures[i];
        code = make_picture(picture, reference->set, NULL, i, nthreads, err);
        if (!code)
            retex_parallel(nthreads, picture->height, encode_row, picture);
    }
    if (!code)
        code = measure_noise(reference, nthreads, err);
    if (code)
        retex_compact_reference_close(reference);
    return code;
}

void retex_compact_reference_close(RetexCompactReference *reference)
{
    for (int i = 0; i < RETEX_COMPACT_TRIALS; i++)
        retex_image_free(&reference->pictures[i]);
    retex_set_close(&reference->set);
}

/* ---- distortion ---- */

double retex_compact_row_weight(const RetexCompactReference *reference, int y)
{
    const int row = reference->tile ? y % reference->tile : 0;
    if (!reference->tile)
        return 1;
    return row >= MARGIN && row < reference->tile - MARGIN ? reference->weights[y / reference->tile] : 0;
}

int retex_compact_margin(const RetexCompactReference *reference)
{
    return reference->tile ? MARGIN : 0;
}

typedef struct ReadWork {
    const RetexCompactReference *reference;
    const RetexImage *const *parts; /* for each part of the set, its pictures by trial */
    int count, trial;
    double *rows; /* by row: sum of squared errors */
} ReadWork;

static void read_row(void *context, int y, int thread)
{
    const ReadWork *work = context;
    const RetexImage *should = &work->reference->pictures[work->trial];
    const int margin = retex_compact_margin(work->reference);
    double sum = 0;
    (void)thread;
    for (int x = margin; x < should->width - margin && retex_compact_row_weight(work->reference, y) > 0; x++)
        for (size_t c = retex_image_index(should, x, y), end = c + 3; c < end; c++) {
            float light = 0;
            for (int i = 0; i < work->count; i++)
                light += work->parts[i][work->trial].pixels[c];
            const double d = (double)encoded(light) - (double)should->pixels[c];
            sum += d * d;
        }
    work->rows[y] = sum;
}

int retex_compact_distortions(const RetexCompactReference *reference, const RetexImage *const parts[], int count,
                              double squares[RETEX_COMPACT_TRIALS], int nthreads, RetexError *err)
{
    const int width = reference->set->width - 2 * retex_compact_margin(reference), height = reference->set->height;
    ReadWork work = {reference, parts, count, 0, calloc((size_t)height, sizeof(double))};
    if (!work.rows)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for sums");
    memset(squares, 0, sizeof *squares * RETEX_COMPACT_TRIALS);
    for (work.trial = 0; work.trial < trial_count(reference->set); work.trial++) {
        double sum = 0, weights = 0;
        retex_parallel(nthreads, height, read_row, &work);
        for (int y = 0; y < height; y++) {
            sum += retex_compact_row_weight(reference, y) * work.rows[y];
            weights += retex_compact_row_weight(reference, y);
        }
        squares[work.trial] = sum / (weights * 3 * width);
    }
    free(work.rows);
    return RETEX_OK;
}
