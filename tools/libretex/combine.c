/* Recombination: I = sum over terms of radiance times the product of the factors (supplement 4.2, Eq. 4, and 4.3).
 *
 * What a term means - no hit, dependent, independent, cross - is the set's business; here it is a polynomial. A
 * factor is the new texture's sample at its footprint or, where the target keeps its original, the footprint's mean
 * original albedo, which is exact for it. */
#include <retex/sample.h>

#include <string.h>

#include <retex/parallel.h>

#include "combine_kernel.h"
#include "polynomial.h"

#define SPAN_PIXELS 512 /* its sum and one span of each image fit the first two caches */
#define ROWS_A_JOB 8

typedef struct CombineWork {
    RetexImage *dst;
    RetexRoi roi;
    Polynomial polynomial;
} CombineWork;

static void combine_span(const CombineWork *work, size_t first, size_t pixels)
{
    float sum[3 * SPAN_PIXELS] = {0};
    const RetexRoi *roi = &work->roi;
    for (int t = 0; t < work->polynomial.count; t++) {
        const Monomial *m = &work->polynomial.monomials[t];
        const float *factors[RETEX_MAX_FACTORS + 1];
        for (int k = 0; k < m->nimages; k++)
            factors[k] = m->factors[k] + 3 * first;
        combine_term_kernel(sum, m->radiance + 3 * first, factors, m->nimages, 3 * pixels);
    }
    float *out = work->dst->pixels + 3 * first;
    if (roi->c0 == 0 && roi->c1 == 3) {
        memcpy(out, sum, 3 * pixels * sizeof *out);
        return;
    }
    for (size_t i = 0; i < pixels; i++)
        for (int c = roi->c0; c < roi->c1; c++)
            out[3 * i + (size_t)c] = sum[3 * i + (size_t)c];
}

static void combine_job(void *context, int index, int thread)
{
    const CombineWork *work = context;
    const RetexRoi *roi = &work->roi;
    (void)thread;
    int first = roi->y0 + index * ROWS_A_JOB, last = first + ROWS_A_JOB < roi->y1 ? first + ROWS_A_JOB : roi->y1;
    for (int y = first; y < last; y++)
        for (int x = roi->x0; x < roi->x1; x += SPAN_PIXELS) {
            int pixels = roi->x1 - x < SPAN_PIXELS ? roi->x1 - x : SPAN_PIXELS;
            combine_span(work, (size_t)y * (size_t)work->dst->width + (size_t)x, (size_t)pixels);
        }
}

int retex_combine(RetexImage *dst, const RetexSet *set, const RetexSamples *samples, const RetexCombineParams *params,
                  const RetexRoi *roi, int nthreads, RetexError *err)
{
    CombineWork work = {.dst = dst};
    int code = polynomial_open(&work.polynomial, set, samples, params, err);
    if (!code)
        code = retex_image_prepare(dst, set->width, set->height, 3, roi, &work.roi, err);
    if (!code)
        retex_parallel(nthreads, (work.roi.y1 - work.roi.y0 + ROWS_A_JOB - 1) / ROWS_A_JOB, combine_job, &work);
    polynomial_close(&work.polynomial, set);
    return code;
}
