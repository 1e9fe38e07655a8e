/* Gains: a term's radiance divided by the sum of its kind's. See gains.h. */
#include "compact/gains.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "retexture/enlarge.h"
#include "set/set.h"

typedef struct Source {
    const float *radiance, *uv; /* uv: means and coverage of its footprint, or NULL */
    double share;
} Source;

/* The old terms whose radiance a new term has. */
typedef struct TermLight {
    const RetexCompactLight *light;
    const RetexCompactKind *kind;
    int interreflected;
    Source *sources;
    int count;
} TermLight;

typedef struct GainWork {
    const RetexCompactLight *light;
    const RetexCompactKind *kind;
    RetexImage *sum, *gain; /* of the whole picture */
    int first;              /* the picture's row of the light's first row */
    int lamps;              /* of a sum */
    int scale;
    TermLight of;
} GainWork;

static void sum_row(void *context, int y, int thread)
{
    const GainWork *work = context;
    const RetexSet *set = work->light->set;
    float *sum = work->sum->pixels + retex_image_index(work->sum, 0, work->first + y);
    (void)thread;
    for (int x = 0; x < set->width; x++) {
        const size_t pixel = (size_t)y * (size_t)set->width + (size_t)x;
        RetexCompactClusterLight of[RETEX_SHARES_MAX];
        double all[3] = {0};
        retex_compact_cluster_light(work->light, work->kind, work->lamps, pixel, of);
        for (int k = 0; k < work->kind->count; k++)
            for (int c = 0; c < 3; c++)
                all[c] += of[k].single[c] + of[k].interreflected[c];
        for (int c = 0; c < 3; c++)
            sum[3 * x + c] = (float)all[c];
    }
}

void retex_compact_sum_rows(RetexImage *sum, const RetexCompactLight *light, const RetexCompactKind *kind, int lamps,
                            int first, int nthreads)
{
    GainWork work = {.light = light, .kind = kind, .sum = sum, .first = first, .lamps = lamps};
    retex_parallel(nthreads, light->set->height, sum_row, &work);
}

int retex_compact_sum_light(RetexImage *sum, const RetexCompactLight *light, const RetexCompactKind *kind, int lamps,
                            int nthreads, RetexError *err)
{
    int code = retex_image_alloc(sum, light->set->width, light->set->height, 3, err);
    if (!code)
        retex_compact_sum_rows(sum, light, kind, lamps, 0, nthreads);
    return code;
}

/* ---- the light of a term ---- */

/* List the old terms whose radiance a new term has, with their shares. Radiance with a footprint counts only where that
 * is covered. */
static int open_term_light(TermLight *of, const RetexCompactLight *light, const RetexCompactKind *kind,
                           RetexCompactMixed mixed, int number, RetexError *err)
{
    const RetexSet *set = light->set;
    const int gain = number - light->nlamps;
    *of = (TermLight){.light = light, .kind = kind, .interreflected = gain >= 0};
    of->sources = malloc((2 * (size_t)kind->ninterreflections + RETEX_SHARES_MAX) * sizeof *of->sources);
    if (!of->sources)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", kind->ninterreflections);
    for (int k = 0; k < kind->count && gain < 0; k++) {
        const int old = kind->single[number][k];
        if (old < 0 || (k && old == kind->single[number][k - 1])) /* a term of several footprints counts once */
            continue;
        const int several = k + 1 < kind->count && old == kind->single[number][k + 1];
        of->sources[of->count++] =
            (Source){set->parts[set->terms[old].radiance].image.pixels,
                     several ? NULL : set->parts[set->footprints[kind->footprints[k]].uv].image.pixels, 1};
    }
    for (int i = 0; i < 2 * kind->ninterreflections && gain >= 0; i++) {
        const RetexCompactInterreflection *part = &kind->interreflections[i / 2];
        if (part->in[mixed][i % 2].gain == gain)
            of->sources[of->count++] =
                (Source){set->parts[set->terms[part->term].radiance].image.pixels, NULL, part->in[mixed][i % 2].share};
    }
    return RETEX_OK;
}

/* A new term's radiance in a pixel: the sum of its sources. */
static void term_light(const TermLight *of, size_t pixel, double rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int i = 0; i < of->count; i++) {
        const Source *source = &of->sources[i];
        if (source->uv && !(source->uv[3 * pixel + 2] > 0))
            continue;
        for (size_t c = 0; c < 3; c++)
            rgb[c] += source->share * (double)source->radiance[3 * pixel + c];
    }
    if (of->interreflected && (rgb[0] != 0 || rgb[1] != 0 || rgb[2] != 0) &&
        !retex_compact_has_interreflections(of->light, of->kind, pixel))
        rgb[0] = rgb[1] = rgb[2] = 0;
}

int retex_compact_term_light(RetexImage *image, const RetexCompactLight *light, const RetexCompactKind *kind,
                             RetexCompactMixed mixed, int number, RetexError *err)
{
    TermLight of;
    double rgb[3];
    int code = retex_image_alloc(image, light->set->width, light->set->height, 3, err);
    if (!code)
        code = open_term_light(&of, light, kind, mixed, number, err);
    if (code)
        return code;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++) {
        term_light(&of, i, rgb);
        for (size_t c = 0; c < 3; c++)
            image->pixels[3 * i + c] = (float)rgb[c];
    }
    free(of.sources);
    return RETEX_OK;
}

/* ---- gains ---- */

/* Add a pixel's light to that of its block. */
static void add_pixel(const GainWork *work, int x, int y, double of[3], double all[3])
{
    const size_t pixel = (size_t)y * (size_t)work->light->set->width + (size_t)x;
    const float *sum = work->sum->pixels + retex_image_index(work->sum, x, work->first + y);
    double light[3];
    term_light(&work->of, pixel, light);
    for (int c = 0; c < 3; c++)
        of[c] += light[c], all[c] += (double)sum[c];
}

/* Compute a row of gains. A gain of -1 marks a hole: a block without light. */
static void gain_row(void *context, int by, int thread)
{
    const GainWork *work = context;
    const RetexSet *set = work->light->set;
    (void)thread;
    for (int bx = 0; bx < work->gain->width; bx++) {
        double of[3] = {0}, all[3] = {0};
        for (int y = by * work->scale; y < (by + 1) * work->scale && y < set->height; y++)
            for (int x = bx * work->scale; x < (bx + 1) * work->scale && x < set->width; x++)
                add_pixel(work, x, y, of, all);
        float *gain = work->gain->pixels + retex_image_index(work->gain, bx, work->first / work->scale + by);
        for (int c = 0; c < 3; c++)
            gain[c] = all[c] > 0 ? (float)(of[c] / all[c]) : -1;
    }
}

/* Fill holes with averages of their surroundings (pull-push): each hole takes its value from an image of half the size,
 * whose pixels are means of valid pixels and whose own holes are filled first, recursively. */
static int fill_holes(RetexImage *image, RetexError *err)
{
    const int width = (image->width + 1) / 2, height = (image->height + 1) / 2;
    RetexImage half = {0};
    int holes = 0;
    int code = retex_image_alloc(&half, width, height, 3, err);
    if (code)
        return code;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++) {
                float sum = 0, count = 0;
                for (int k = 0; k < 4; k++) {
                    const int px = 2 * x + k % 2, py = 2 * y + k / 2;
                    const float value = px < image->width && py < image->height
                                            ? image->pixels[retex_image_index(image, px, py) + (size_t)c]
                                            : -1;
                    if (value >= 0)
                        sum += value, count++;
                }
                half.pixels[retex_image_index(&half, x, y) + (size_t)c] = count > 0 ? sum / count : -1;
                holes |= !(count > 0);
            }
    if (holes && (width > 1 || height > 1))
        code = fill_holes(&half, err);
    for (int y = 0; y < image->height && !code; y++)
        for (int x = 0; x < image->width; x++)
            for (int c = 0; c < 3; c++) {
                float *value = image->pixels + retex_image_index(image, x, y) + c;
                if (*value < 0)
                    *value = fmaxf(half.pixels[retex_image_index(&half, x / 2, y / 2) + (size_t)c], 0);
            }
    retex_image_free(&half);
    return code;
}

int retex_compact_gain_begin(RetexImage *gain, const RetexCompactLight *light, int scale, RetexError *err)
{
    return retex_image_alloc(gain, (light->set->width + scale - 1) / scale, (light->set->height + scale - 1) / scale, 3,
                             err);
}

int retex_compact_gain_rows(RetexImage *gain, const RetexCompactLight *light, const RetexCompactKind *kind,
                            const RetexImage *sum, int number, RetexCompactMixed mixed, int scale, int first,
                            int nthreads, RetexError *err)
{
    RetexImage borrowed = *sum;
    GainWork work = {.light = light, .kind = kind, .sum = &borrowed, .gain = gain, .first = first, .scale = scale};
    int code = open_term_light(&work.of, light, kind, mixed, number, err);
    if (!code)
        retex_parallel(nthreads, (light->set->height + scale - 1) / scale, gain_row, &work);
    free(work.of.sources);
    return code;
}

/* All light that has a gain: blocks times their shares, or the light times the enlarged gain. */
static int sum_of_gain(double sum[3], const RetexImage *gain, const RetexImage *light, int scale, int enlarges,
                       RetexError *err)
{
    float *row = malloc(sizeof *row * 3 * (size_t)light->width);
    sum[0] = sum[1] = sum[2] = 0;
    for (int y = 0; y < light->height && row; y++) {
        const float *of = light->pixels + retex_image_index(light, 0, y);
        const float *blocks = gain->pixels + retex_image_index(gain, 0, y / scale);
        if (enlarges)
            retex_enlarge_rows(gain, scale, light->width, y, y + 1, row);
        for (int i = 0; i < 3 * light->width; i++)
            sum[i % 3] +=
                (double)of[i] * (enlarges ? (double)row[i] : fmax((double)blocks[3 * (i / 3 / scale) + i % 3], 0));
    }
    free(row);
    return row ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory for gains");
}

/* Enlarging moves light from block to block; the mean stays. */
int retex_compact_gain_end(RetexImage *gain, const RetexImage *sum, int scale, RetexError *err)
{
    double wanted[3], made[3];
    int code = sum_of_gain(wanted, gain, sum, scale, 0, err);
    if (!code)
        code = fill_holes(gain, err);
    if (code || scale == 1)
        return code;
    code = sum_of_gain(made, gain, sum, scale, 1, err);
    for (size_t i = 0; i < retex_image_index(gain, 0, gain->height) && !code; i++)
        if (made[i % 3] > 0)
            gain->pixels[i] = (float)((double)gain->pixels[i] * wanted[i % 3] / made[i % 3]);
    return code;
}

int retex_compact_share(RetexImage *share, const RetexImage *of, const RetexImage *all, int scale, int nthreads,
                        RetexError *err)
{
    RetexSet set = {.width = all->width, .height = all->height};
    const RetexCompactLight light = {.set = &set};
    RetexImage sum = *all;
    Source source = {of->pixels, NULL, 1};
    GainWork work = {.light = &light, .sum = &sum, .gain = share, .scale = scale};
    work.of = (TermLight){.sources = &source, .count = 1};
    int code = retex_compact_gain_begin(share, &light, scale, err);
    if (!code)
        retex_parallel(nthreads, share->height, gain_row, &work);
    return code ? code : retex_compact_gain_end(share, all, scale, err);
}
