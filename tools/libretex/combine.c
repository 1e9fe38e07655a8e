/* Recombination: I = sum over terms of radiance times the product of the factors (supplement 4.2, Eq. 4, and 4.3).
 *
 * What a term means - no hit, dependent, independent, cross - is the set's business; here it is a polynomial. A
 * factor is the new texture's sample at its footprint or, where the target keeps its original, the footprint's mean
 * original albedo, which is exact for it. Bands of rows are made side by side; nothing of the picture's size is. */
#include <retex/sample.h>

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "combine_kernel.h"
#include "combine_rows.h"
#include "polynomial.h"

#define SPAN_PIXELS 512 /* its sum and one span of each image fit the first two caches */

typedef struct CombineWork {
    const Polynomial *polynomial;
    int y0, y1; /* of the picture */
    int band;   /* rows a job */
    RetexRowSink *sink;
    void *context;
    atomic_int code;
    struct CombineThread {
        PolynomialRow row; /* opened when the thread has its first band */
        float *rows;
        RetexError err;
    } * threads;
} CombineWork;

static void combine_row(const PolynomialRow *row, int width, float *restrict out)
{
    for (int x = 0; x < width; x += SPAN_PIXELS) {
        size_t first = 3 * (size_t)x, numbers = 3 * (size_t)(width - x < SPAN_PIXELS ? width - x : SPAN_PIXELS);
        memset(out + first, 0, numbers * sizeof *out);
        for (int t = 0; t < row->count; t++) {
            const Monomial *m = &row->monomials[t];
            const float *factors[RETEX_MAX_FACTORS + 2];
            for (int k = 0; k < m->nimages; k++)
                factors[k] = m->factors[k] + first;
            combine_term_kernel(out + first, m->radiance + first, factors, m->nimages, numbers);
        }
    }
}

static int combine_band(const CombineWork *work, struct CombineThread *own, int y0, int y1, RetexError *err)
{
    const int width = work->polynomial->set->width;
    int code = own->row.polynomial ? RETEX_OK : polynomial_row_open(&own->row, work->polynomial, err);
    if (!code && !own->rows && !(own->rows = malloc(sizeof *own->rows * 3 * (size_t)width * (size_t)work->band)))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    for (int y = y0; !code && y < y1; y++) {
        code = polynomial_row_make(&own->row, y, err);
        if (!code)
            combine_row(&own->row, width, own->rows + 3 * (size_t)width * (size_t)(y - y0));
    }
    return code ? code : work->sink(work->context, y0, y1, own->rows, err);
}

static void combine_job(void *context, int index, int thread)
{
    CombineWork *work = context;
    struct CombineThread *own = &work->threads[thread];
    /* bands begin at multiples of their height, wherever the region does */
    int first = work->y0 / work->band + index, y0 = first * work->band, y1 = y0 + work->band;
    if (work->code)
        return;
    int code = combine_band(work, own, y0 > work->y0 ? y0 : work->y0, y1 < work->y1 ? y1 : work->y1, &own->err);
    if (code)
        atomic_store(&work->code, code);
}

static int combine(const Polynomial *polynomial, int y0, int y1, RetexRowSink *sink, void *context, int nthreads,
                   RetexError *err)
{
    const int threads = retex_threads(nthreads);
    CombineWork work = {polynomial, y0, y1, RETEX_PICTURE_BAND, sink, context, 0, NULL};
    if (!(work.threads = calloc((size_t)threads, sizeof *work.threads)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    if (y1 > y0)
        retex_parallel(threads, (y1 - 1) / work.band - y0 / work.band + 1, combine_job, &work);
    for (int i = 0; i < threads; i++) {
        if (work.code && work.threads[i].err.code && err)
            *err = work.threads[i].err;
        polynomial_row_close(&work.threads[i].row);
        free(work.threads[i].rows);
    }
    free(work.threads);
    return work.code;
}

int retex_retexture(const RetexSet *set, const RetexSamples *samples, RetexTexture *const textures[RETEX_MAX_TARGETS],
                    const RetexCombineParams *params, RetexRowSink *sink, void *context, int nthreads, RetexError *err)
{
    Polynomial polynomial;
    int code = polynomial_open(&polynomial, set, samples, textures, params, 0, nthreads, err);
    if (code)
        return code;
    code = combine(&polynomial, 0, set->height, sink, context, nthreads, err);
    polynomial_close(&polynomial);
    return code;
}

/* ---- with the originals, some rows ---- */

static int open_original(Polynomial *polynomial, const RetexSet *set, RetexError *err)
{
    const RetexCombineParams all = {sizeof all, 3};
    return polynomial_open(polynomial, set, NULL, NULL, &all, 0, 1, err);
}

int combine_check(const RetexSet *set)
{
    Polynomial polynomial;
    int code = open_original(&polynomial, set, NULL);
    polynomial_close(&polynomial);
    return code;
}

int combine_original_rows(float *out, const RetexSet *set, int y0, int y1, RetexError *err)
{
    const size_t length = 3 * (size_t)set->width;
    Polynomial polynomial;
    PolynomialRow row = {0};
    int code = open_original(&polynomial, set, err);
    if (!code)
        code = polynomial_row_open(&row, &polynomial, err);
    for (int y = y0; !code && y < y1; y++) {
        code = polynomial_row_make(&row, y, err);
        if (!code)
            combine_row(&row, set->width, out + length * (size_t)(y - y0));
    }
    polynomial_row_close(&row);
    polynomial_close(&polynomial);
    return code;
}

/* ---- into an image ---- */

typedef struct Region {
    RetexImage *dst;
    RetexRoi roi;
} Region;

static int copy_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    const Region *region = context;
    const RetexRoi *roi = &region->roi;
    (void)err;
    for (int y = y0; y < y1; y++) {
        const float *from = rows + 3 * ((size_t)(y - y0) * (size_t)region->dst->width + (size_t)roi->x0);
        float *to = region->dst->pixels + retex_image_index(region->dst, roi->x0, y);
        for (int x = roi->x0; x < roi->x1; x++, from += 3, to += 3)
            for (int c = roi->c0; c < roi->c1; c++)
                to[c] = from[c];
    }
    return RETEX_OK;
}

int retex_combine(RetexImage *dst, const RetexSet *set, const RetexSamples *samples, const RetexCombineParams *params,
                  const RetexRoi *roi, int nthreads, RetexError *err)
{
    Region region = {.dst = dst};
    Polynomial polynomial;
    int code = polynomial_open(&polynomial, set, samples, NULL, params, 0, nthreads, err);
    if (code)
        return code;
    code = retex_image_prepare(dst, set->width, set->height, 3, roi, &region.roi, err);
    if (!code)
        code = combine(&polynomial, region.roi.y0, region.roi.y1, copy_rows, &region, nthreads, err);
    polynomial_close(&polynomial);
    return code;
}
