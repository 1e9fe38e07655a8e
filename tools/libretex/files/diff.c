/* Compares two files: matches parts and channels by name, then compares values. See retex/diff.h. Parts differ too if
 * their sizes differ, or if a part or a channel is in one file only. */
#include <retex/diff.h>
#include <retex/nearest.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/params.h"
#include "files/layers.h"

/* Record why parts differ. Only the first reason is kept. */
#define REASON(part, ...) ((part)->reason[0] ? 0 : snprintf((part)->reason, sizeof(part)->reason, __VA_ARGS__))

typedef struct Pair {
    const RetexDiffParams *params;
    int nthreads;
    RetexLayer a, b;
    int exact; /* 1: retex_layers_is_exact is 1 for both files */
} Pair;

/* Two open files, and what has been found out about them. */
typedef struct Comparison {
    RetexDiff *diff;
    RetexLayers *a, *b;
    const RetexDiffParams *params;
    int nthreads;
} Comparison;

static int is_color(const char *channel)
{
    return strcmp(channel, "R") == 0 || strcmp(channel, "G") == 0 || strcmp(channel, "B") == 0;
}

/* Check that the other layer has each channel of one layer. Alpha may be missing if a reader may have added it. */
static void check_channels(RetexDiffPart *part, const Pair *pair, int swapped)
{
    const RetexLayer *a = swapped ? &pair->b : &pair->a, *b = swapped ? &pair->a : &pair->b;
    for (int c = 0; c < a->image.channels; c++)
        if (retex_layer_find(b, a->channels[c]) < 0 && (pair->exact || strcmp(a->channels[c], "A") != 0))
            REASON(part, "channel %s is missing in the %s", a->channels[c], swapped ? "first" : "second");
}

/* Copy R,G,B (or Y thrice) into a picture of 3 channels: 0 where the layer has no colour. */
static int extract_color(RetexImage *color, const RetexLayer *layer, RetexError *err)
{
    static const char *const names[3] = {"R", "G", "B"};
    int from[3], y = retex_layer_find(layer, "Y");
    for (int c = 0; c < 3; c++) {
        from[c] = retex_layer_find(layer, names[c]);
        if (from[c] < 0 && y < 0)
            return 0;
    }
    if (from[0] < 0 || from[1] < 0 || from[2] < 0)
        from[0] = from[1] = from[2] = y;
    if (y < 0 && (from[0] < 0 || from[1] < 0 || from[2] < 0))
        return 0;
    int code = retex_image_alloc(color, layer->image.width, layer->image.height, 3, err);
    if (code)
        return code;
    size_t pixels = (size_t)color->width * (size_t)color->height, channels = (size_t)layer->image.channels;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++)
            color->pixels[3 * i + c] = layer->image.pixels[i * channels + (size_t)from[c]];
    return 1;
}

/* Compute PSNR, relMSE, FLIP and MAE of the colour channels. */
static int compare_color(RetexDiffPart *part, const Pair *pair, RetexError *err)
{
    RetexImage a = {0}, b = {0};
    int code = extract_color(&a, &pair->a, err);
    if (code == 1)
        code = extract_color(&b, &pair->b, err);
    if (code == 1) {
        part->has_color = 1;
        code = retex_metrics(&part->metrics, &a, &b, pair->nthreads, err);
    }
    retex_image_free(&a);
    retex_image_free(&b);
    return code;
}

/* Add the errors of one channel, over all pixels. */
static void compare_channel(RetexDiffPart *part, const Pair *pair, int ca, int cb, double *sum)
{
    const RetexImage *a = &pair->a.image, *b = &pair->b.image;
    RetexMetrics *m = &part->metrics;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            double va = (double)a->pixels[retex_image_index(a, x, y) + (size_t)ca];
            double vb = (double)b->pixels[retex_image_index(b, x, y) + (size_t)cb];
            if (!isfinite(va) || !isfinite(vb)) {
                m->nonfinite += !(pair->params->allow_inf && va == vb);
                continue;
            }
            double difference = fabs(va - vb);
            *sum += difference;
            m->max_rel = fmax(m->max_rel, difference / fmax(fabs(vb), 1e-3));
            if (difference > m->max_abs || !part->worst_channel[0]) {
                m->max_abs = difference;
                m->worst.x = x;
                m->worst.y = y;
                snprintf(part->worst_channel, sizeof part->worst_channel, "%s", pair->a.channels[ca]);
                m->worst.channel = part->worst_channel[0];
            }
        }
}

/* Compute the part's errors over all channels. *other gets those of channels that are not colour. */
static void compare_channels(RetexDiffPart *part, const Pair *pair, RetexDiffPart *other)
{
    double sum = 0, ignored = 0, n = 0;
    part->metrics.max_abs = part->metrics.max_rel = 0;
    part->metrics.nonfinite = 0;
    for (int c = 0; c < pair->a.image.channels; c++) {
        const char *name = pair->a.channels[c];
        int twin = retex_layer_find(&pair->b, name);
        if (twin < 0)
            continue; /* an alpha that the reader added */
        compare_channel(part, pair, c, twin, &sum);
        n += (double)pair->a.image.width * pair->a.image.height;
        if (!(part->has_color && (is_color(name) || strcmp(name, "Y") == 0)))
            compare_channel(other, pair, c, twin, &ignored);
    }
    if (!part->has_color)
        part->metrics.mae = sum / n;
}

static void apply_limits(RetexDiffPart *part, const RetexDiffPart *other, const RetexDiffParams *p)
{
    const RetexMetrics *m = &part->metrics;
    int any_color_limit = p->fail_psnr >= 0 || p->fail_relmse >= 0 || p->fail_flip >= 0;
    int any_limit = p->fail_abs >= 0 || p->fail_rel >= 0;
    if (m->nonfinite)
        REASON(part, "%ld samples are NaN or infinite", m->nonfinite);
    if (part->has_color && p->fail_psnr >= 0 && !(m->psnr >= p->fail_psnr))
        REASON(part, "psnr %.3f is below %g", m->psnr, p->fail_psnr);
    if (part->has_color && p->fail_relmse >= 0 && !(m->relmse <= p->fail_relmse))
        REASON(part, "relmse %.6g is above %g", m->relmse, p->fail_relmse);
    if (part->has_color && p->fail_flip >= 0 && !(m->flip_mean <= p->fail_flip))
        REASON(part, "flip %.6g is above %g", m->flip_mean, p->fail_flip);
    if (p->fail_abs >= 0 && !(m->max_abs <= p->fail_abs))
        REASON(part, "the largest difference, %.6g, is above %g", m->max_abs, p->fail_abs);
    if (p->fail_rel >= 0 && !(m->max_rel <= p->fail_rel))
        REASON(part, "the largest relative difference, %.6g, is above %g", m->max_rel, p->fail_rel);
    if (!any_limit && (!any_color_limit || !part->has_color) && m->max_abs > 0)
        REASON(part, "values differ, by up to %.6g", m->max_abs);
    if (!any_limit && other->metrics.max_abs > 0)
        REASON(part, "channel %s, which no limit applies to, differs by up to %.6g", other->worst_channel,
               other->metrics.max_abs);
}

static int compare_pair(RetexDiffPart *part, const Pair *pair, RetexError *err)
{
    const RetexImage *a = &pair->a.image, *b = &pair->b.image;
    RetexDiffPart other = {0};
    part->width = a->width;
    part->height = a->height;
    part->channels = a->channels;
    if (a->width != b->width || a->height != b->height)
        REASON(part, "sizes differ: %d x %d and %d x %d", a->width, a->height, b->width, b->height);
    check_channels(part, pair, 0);
    check_channels(part, pair, 1);
    if (part->reason[0])
        return 0;
    part->compared = 1;
    int code = compare_color(part, pair, err);
    if (code < 0)
        return code;
    compare_channels(part, pair, &other);
    apply_limits(part, &other, pair->params);
    return 0;
}

/* Read and compare part ia of a with part ib of b. */
static int compare_parts(const Comparison *files, int ia, int ib, RetexError *err)
{
    RetexDiff *diff = files->diff;
    RetexDiffPart *part = &diff->parts[diff->nparts++];
    Pair pair = {.params = files->params,
                 .nthreads = files->nthreads,
                 .exact = retex_layers_is_exact(files->a) && retex_layers_is_exact(files->b)};
    snprintf(part->name, sizeof part->name, "%s", retex_layers_name(files->a, ia));
    int code = retex_layers_read(&pair.a, files->a, ia, err);
    if (!code)
        code = retex_layers_read(&pair.b, files->b, ib, err);
    if (!code)
        code = compare_pair(part, &pair, err);
    retex_layer_free(&pair.a);
    retex_layer_free(&pair.b);
    if (!code && part->reason[0]) {
        diff->differs = 1;
        if (!diff->reason[0])
            memcpy(diff->reason, part->reason, sizeof diff->reason);
    }
    return code;
}

static int compare_all(const Comparison *files, RetexError *err)
{
    RetexDiff *diff = files->diff;
    RetexLayers *a = files->a, *b = files->b;
    int code = 0;
    for (int i = 0; !code && i < retex_layers_count(a); i++) {
        int twin = retex_layers_find(b, retex_layers_name(a, i));
        if (twin >= 0)
            code = compare_parts(files, i, twin, err);
        else
            REASON(diff, "part '%s' is missing in the second", retex_layers_name(a, i));
    }
    for (int i = 0; !code && i < retex_layers_count(b); i++)
        if (retex_layers_find(a, retex_layers_name(b, i)) < 0)
            REASON(diff, "part '%s' is missing in the first", retex_layers_name(b, i));
    diff->differs = diff->reason[0] != 0;
    return code;
}

static int fail_part(const RetexLayers *a, const RetexLayers *b, const char *part, RetexError *err)
{
    RetexNearest nearest = {part, NULL, 0};
    char meant[RETEX_MEANT_SIZE];
    for (int i = 0; i < retex_layers_count(a); i++)
        retex_nearest_try(&nearest, retex_layers_name(a, i));
    for (int i = 0; i < retex_layers_count(b); i++)
        retex_nearest_try(&nearest, retex_layers_name(b, i));
    return retex_fail(err, RETEX_ENOTFOUND, "neither file has a part '%s'%s", part, retex_meant(nearest.best, meant));
}

/* Compare only the part that the parameters name. */
static int compare_one(const Comparison *files, RetexError *err)
{
    const char *part = files->params->part;
    int ia = part ? retex_layers_find(files->a, part) : 0;
    int ib = part ? retex_layers_find(files->b, part) : 0;
    if (ia < 0 && ib < 0)
        return fail_part(files->a, files->b, part, err);
    if (ia < 0 || ib < 0) {
        files->diff->differs = 1;
        REASON(files->diff, "part '%s' is missing in the %s", part, ia < 0 ? "first" : "second");
        return 0;
    }
    return compare_parts(files, ia, ib, err);
}

int retex_diff(RetexDiff **result, const char *a, const char *b, const RetexDiffParams *given, int nthreads,
               RetexError *err)
{
    RetexDiffParams params = RETEX_DIFF_INIT;
    RetexAccess access = RETEX_ACCESS_INIT;
    *result = NULL;
    if (RETEX_PARAMS_COPY(&params, given, err) || RETEX_PARAMS_COPY(&access, params.access, err))
        return RETEX_EINVAL;
    if (strcmp(a, "-") == 0 && strcmp(b, "-") == 0)
        return retex_fail(err, RETEX_EINVAL, "only one of the two files can be standard input");
    RetexDiff *diff = calloc(1, sizeof *diff);
    const RetexReadParams reading = {.size = sizeof reading,
                                     .access = params.access,
                                     .budget = params.budget,
                                     .pixel_bytes = 16,
                                     .warn = access.accept_damaged ? params.warn : NULL,
                                     .warn_context = params.warn_context};
    Comparison files = {.diff = diff, .params = &params, .nthreads = nthreads};
    int code =
        diff ? retex_layers_open(&files.a, a, &reading, nthreads, err) : retex_fail(err, RETEX_ENOMEM, "no memory");
    if (!code)
        code = retex_layers_open(&files.b, b, &reading, nthreads, err);
    if (!code) {
        diff->parts = calloc((size_t)retex_layers_count(files.a), sizeof *diff->parts);
        code = !diff->parts       ? retex_fail(err, RETEX_ENOMEM, "no memory to compare %s", a)
               : params.all_parts ? compare_all(&files, err)
                                  : compare_one(&files, err);
    }
    retex_layers_close(&files.a);
    retex_layers_close(&files.b);
    if (code)
        retex_diff_close(&diff);
    *result = diff;
    return code;
}

void retex_diff_close(RetexDiff **diff)
{
    if (!diff || !*diff)
        return;
    free((*diff)->parts);
    free(*diff);
    *diff = NULL;
}
