/* See filter.h. */
#include "denoise/filter.h"

#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "denoise/footprints.h"
#include "denoise/tile.h"
#include "set/set.h"

/* The results of a row of tiles stay in rows of their own until no other tile reads the pixels that they replace. */
typedef struct Filter {
    RetexDenoiser *denoiser;
    RetexDenoiseResult *result;
    RetexDenoiseScratch **scratch; /* by thread */
    int nthreads, tiles_x;
    RetexDenoisedRows outs[2], *out;
    RetexSignalSums *sums; /* by tile of the row, then signal: added up in order */
} Filter;

static void denoise_job(void *context, int index, int thread)
{
    Filter *w = context;
    const RetexDenoiser *d = w->denoiser;
    if (retex_budget_is_stopped(d->params.budget))
        return;
    retex_denoise_tile(d, w->scratch[thread], d->roi.x0 + index * DENOISE_STEP, w->out,
                       w->sums + (size_t)index * (size_t)d->signals.count);
}

static void close_rows(RetexDenoisedRows *out, int nparts)
{
    for (int k = 0; out->parts && k < nparts; k++)
        free(out->parts[k]);
    free(out->parts);
    out->parts = NULL;
}

static int open_rows(RetexDenoisedRows *out, const RetexDenoiser *d, const unsigned char *written, RetexError *err)
{
    const RetexSet *set = d->set;
    out->rows = 0;
    out->parts = calloc((size_t)set->nparts, sizeof *out->parts);
    for (int k = 0; out->parts && k < set->nparts; k++) {
        size_t floats = (size_t)DENOISE_STEP * (size_t)set->width * (size_t)set->parts[k].image.channels;
        if (written[k] && !(out->parts[k] = malloc(floats * sizeof(float))))
            return retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    }
    return out->parts ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
}

static int open_outs(Filter *w, RetexError *err)
{
    const RetexDenoiser *d = w->denoiser;
    unsigned char *own = calloc((size_t)d->set->nparts + 1, 1);
    int code = own ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    if (own) {
        retex_signals_mark_members(&d->signals, own, 1);
        if (d->footprints)
            retex_denoise_mark_written(d->footprints, d, own);
    }
    for (int k = 0; k < d->set->nparts && own; k++)
        w->result->written[k] |= own[k];
    for (int k = 0; k < 2 && !code; k++)
        code = open_rows(&w->outs[k], d, own, err);
    free(own);
    return code;
}

/* Copies the rows into the set. */
static void commit_rows(const RetexDenoisedRows *out, const RetexDenoiser *d)
{
    for (int part = 0; part < d->set->nparts; part++) {
        RetexImage *im = &d->set->parts[part].image;
        size_t channels = (size_t)im->channels, row = (size_t)(d->roi.x1 - d->roi.x0) * channels;
        for (int y = 0; out->parts[part] && y < out->rows; y++)
            memcpy(im->pixels + retex_image_index(im, d->roi.x0, out->first + y),
                   out->parts[part] + ((size_t)y * (size_t)im->width + (size_t)d->roi.x0) * channels,
                   row * sizeof(float));
    }
}

static void add_sums(Filter *w)
{
    int count = w->denoiser->signals.count;
    for (int k = 0; k < w->tiles_x * count; k++) {
        RetexSignalSums *sums = &w->result->sums[w->denoiser->first_signal + k % count];
        sums->lit += w->sums[k].lit;
        for (int c = 0; c < 3; c++) {
            sums->before[c] += w->sums[k].before[c];
            sums->lost[c] += w->sums[k].lost[c];
            sums->variance[c] += w->sums[k].variance[c];
        }
    }
}

static int open_filter(Filter *w, RetexError *err)
{
    RetexDenoiser *d = w->denoiser;
    size_t count = (size_t)d->signals.count;
    int code = RETEX_OK;
    w->tiles_x = (d->roi.x1 - d->roi.x0 + DENOISE_STEP - 1) / DENOISE_STEP;
    w->scratch = calloc((size_t)w->nthreads, sizeof *w->scratch);
    w->sums = calloc((size_t)w->tiles_x * count + 1, sizeof *w->sums);
    if (!w->scratch || !w->sums)
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    for (int k = 0; k < w->nthreads && k < w->tiles_x && !code; k++)
        code = retex_denoise_scratch_create(&w->scratch[k], d, err);
    if (!code && d->signals.of[0].lamp < 0)
        code = retex_denoise_footprints_open(&d->footprints, d, err);
    return code ? code : open_outs(w, err);
}

static void close_filter(Filter *w)
{
    for (int k = 0; w->scratch && k < w->nthreads; k++)
        retex_denoise_scratch_close(&w->scratch[k]);
    for (int k = 0; k < 2; k++)
        close_rows(&w->outs[k], w->denoiser->set->nparts);
    free(w->scratch);
    free(w->sums);
    retex_denoise_footprints_close(&w->denoiser->footprints);
}

/* The part of the signals' pixels that come before row y. */
static double progress_of(const RetexDenoiser *d, int y)
{
    const double rows = (double)(y - d->roi.y0) / (d->roi.y1 - d->roi.y0);
    return (d->first_signal + d->signals.count * rows) / d->nsignals;
}

static int run(Filter *w, RetexError *err)
{
    const RetexDenoiser *d = w->denoiser;
    int number = 0;
    for (int y = d->roi.y0; y < d->roi.y1; y += DENOISE_STEP, number++) {
        w->out = &w->outs[number % 2];
        w->out->first = y;
        w->out->rows = d->roi.y1 - y < DENOISE_STEP ? d->roi.y1 - y : DENOISE_STEP;
        memset(w->sums, 0, sizeof *w->sums * (size_t)w->tiles_x * (size_t)d->signals.count);
        retex_parallel(w->nthreads, w->tiles_x, denoise_job, w);
        const int code = retex_budget_check(d->params.budget, err);
        if (code)
            return code;
        add_sums(w);
        commit_rows(&w->outs[(number + 1) % 2], d); /* no tile reads the rows before any more */
        w->outs[(number + 1) % 2].rows = 0;
        if (d->params.progress)
            d->params.progress(d->params.progress_context, progress_of(d, y));
    }
    for (int k = 0; k < 2; k++)
        commit_rows(&w->outs[k], d);
    return RETEX_OK;
}

int retex_denoise_bundle(RetexDenoiser *bundle, const RetexDenoiser *all, int first)
{
    int end = first;
    while (end < all->signals.count && all->signals.of[end].lamp == all->signals.of[first].lamp)
        end++;
    *bundle = *all;
    bundle->signals.of += first, bundle->signals.count = end - first;
    bundle->first_signal = first;
    return end - first;
}

int retex_denoise_filter(RetexDenoiser *denoiser, RetexDenoiseResult *result, int nthreads, RetexError *err)
{
    Filter filter = {.denoiser = denoiser, .result = result, .nthreads = retex_threads(nthreads)};
    int code = open_filter(&filter, err);
    if (!code)
        code = run(&filter, err);
    close_filter(&filter);
    return code;
}

int retex_denoise_result_open(RetexDenoiseResult *result, const RetexDenoiser *denoiser, RetexError *err)
{
    result->sums = calloc((size_t)denoiser->signals.count + 1, sizeof *result->sums);
    result->written = calloc((size_t)denoiser->set->nparts + 1, sizeof *result->written);
    if (!result->sums || !result->written)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    retex_signals_mark_members(&denoiser->signals, result->written, 1);
    return RETEX_OK;
}

void retex_denoise_result_close(RetexDenoiseResult *result)
{
    free(result->sums);
    free(result->written);
}
