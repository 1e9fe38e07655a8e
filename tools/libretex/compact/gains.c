/* Gains: a term's radiance divided by the sum of its kind's. See gains.h. */
#include "compact/gains.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "set/set.h"

typedef struct Source {
    const float *radiance, *uv; /* uv: means and coverage of its footprint, or NULL */
    double share;
} Source;

typedef struct GainWork {
    const RetexCompactLight *light;
    const RetexCompactKind *kind;
    RetexImage *sum, *gain; /* of the whole picture */
    int first;              /* the picture's row of the light's first row */
    int number;             /* of a term, or, for a sum, lamps */
    RetexCompactMixed mixed;
    int scale;
    Source *sources;
    int count;
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
        retex_compact_cluster_light(work->light, work->kind, work->number, pixel, of);
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
    GainWork work = {.light = light, .kind = kind, .sum = sum, .first = first, .number = lamps};
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

/* List the old terms whose radiance a new term has, with their shares. Radiance with a footprint counts only where that
 * is covered. */
static int list_sources(GainWork *work, RetexError *err)
{
    const RetexSet *set = work->light->set;
    const RetexCompactKind *kind = work->kind;
    const int gain = work->number - work->light->nlamps;
    work->sources = malloc((2 * (size_t)kind->ninterreflections + RETEX_SHARES_MAX) * sizeof *work->sources);
    if (!work->sources)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", kind->ninterreflections);
    for (int k = 0; k < kind->count && gain < 0; k++)
        if (kind->single[work->number][k] >= 0)
            work->sources[work->count++] =
                (Source){set->parts[set->terms[kind->single[work->number][k]].radiance].image.pixels,
                         set->parts[set->footprints[kind->footprints[k]].uv].image.pixels, 1};
    for (int i = 0; i < 2 * kind->ninterreflections && gain >= 0; i++) {
        const RetexCompactInterreflection *part = &kind->interreflections[i / 2];
        if (part->in[work->mixed][i % 2].gain == gain)
            work->sources[work->count++] = (Source){set->parts[set->terms[part->term].radiance].image.pixels, NULL,
                                                    part->in[work->mixed][i % 2].share};
    }
    return RETEX_OK;
}

/* A new term's radiance in a pixel: the sum of its sources. */
static void term_light(const GainWork *work, size_t pixel, double rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = 0;
    if (work->number >= work->light->nlamps && !retex_compact_has_interreflections(work->light, work->kind, pixel))
        return;
    for (int i = 0; i < work->count; i++) {
        const Source *source = &work->sources[i];
        if (source->uv && !(source->uv[3 * pixel + 2] > 0))
            continue;
        for (size_t c = 0; c < 3; c++)
            rgb[c] += source->share * (double)source->radiance[3 * pixel + c];
    }
}

/* Compute a row of gains. A gain of -1 marks a hole: a block without light. */
static void gain_row(void *context, int by, int thread)
{
    const GainWork *work = context;
    const RetexSet *set = work->light->set;
    (void)thread;
    for (int bx = 0; bx < work->gain->width; bx++) {
        double of[3] = {0}, all[3] = {0}, light[3];
        for (int y = by * work->scale; y < (by + 1) * work->scale && y < set->height; y++)
            for (int x = bx * work->scale; x < (bx + 1) * work->scale && x < set->width; x++) {
                const size_t pixel = (size_t)y * (size_t)set->width + (size_t)x;
                const float *sum = work->sum->pixels + retex_image_index(work->sum, x, work->first + y);
                term_light(work, pixel, light);
                for (int c = 0; c < 3; c++) {
                    of[c] += light[c];
                    all[c] += (double)sum[c];
                }
            }
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
    GainWork work = {light, kind, &borrowed, gain, first, number, mixed, scale, NULL, 0};
    int code = list_sources(&work, err);
    if (code)
        return code;
    retex_parallel(nthreads, (light->set->height + scale - 1) / scale, gain_row, &work);
    free(work.sources);
    return RETEX_OK;
}

int retex_compact_gain_end(RetexImage *gain, RetexError *err)
{
    return fill_holes(gain, err);
}

int retex_compact_make_gain(RetexImage *gain, const RetexCompactLight *light, const RetexCompactKind *kind,
                            const RetexImage *sum, int number, RetexCompactMixed mixed, int scale, int nthreads,
                            RetexError *err)
{
    int code = retex_compact_gain_begin(gain, light, scale, err);
    if (!code)
        code = retex_compact_gain_rows(gain, light, kind, sum, number, mixed, scale, 0, nthreads, err);
    return code ? code : retex_compact_gain_end(gain, err);
}
