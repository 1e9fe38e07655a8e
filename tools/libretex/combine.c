/* Recombination: I = sum over terms of radiance times the product of the factors (supplement 4.2, Eq. 4, and 4.3).
 *
 * What a term means - no hit, dependent, independent, cross - is the set's business; here it is a polynomial. A
 * factor is the new texture's sample at its footprint or, where the target keeps its original, the footprint's mean
 * original albedo, which is exact for it. */
#include <retex/sample.h>

#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "combine_kernel.h"

#define SPAN_PIXELS 512 /* its sum and one span of each image fit the first two caches */
#define ROWS_A_JOB 8

/* A term with its images found. */
typedef struct Monomial {
    const float *radiance;
    int nfactors;
    const float *factors[RETEX_MAX_FACTORS];
} Monomial;

typedef struct CombineWork {
    RetexImage *dst;
    RetexRoi roi;
    Monomial *monomials;
    int nmonomials;
} CombineWork;

/* ---- preparation ---- */

/* Pixels of an RGB part of the set's size; NULL where there is none. */
static const float *find_pixels(const RetexSet *set, int part)
{
    if (part < 0 || part >= set->nparts)
        return NULL;
    const RetexImage *im = &set->parts[part].image;
    return im->width == set->width && im->height == set->height && im->channels == 3 ? im->pixels : NULL;
}

static const float *find_factor(const RetexSet *set, const RetexSamples *samples, int footprint)
{
    if (footprint < 0 || footprint >= set->nfootprints)
        return NULL;
    if (samples && samples->images[footprint].pixels)
        return samples->images[footprint].pixels;
    return find_pixels(set, set->footprints[footprint].albedo);
}

static int is_left_out(const RetexTerm *term, int cross)
{
    return (term->kind == RETEX_TERM_CROSS2 && cross < 2) || (term->kind == RETEX_TERM_CROSS3 && cross < 3);
}

static int prepare_monomials(CombineWork *work, const RetexSet *set, const RetexSamples *samples, int cross,
                             RetexError *err)
{
    work->monomials = calloc((size_t)set->nterms + 1, sizeof *work->monomials);
    if (!work->monomials)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", set->nterms);
    for (int i = 0; i < set->nterms; i++) {
        const RetexTerm *term = &set->terms[i];
        if (is_left_out(term, cross))
            continue;
        Monomial *m = &work->monomials[work->nmonomials++];
        m->radiance = find_pixels(set, term->radiance);
        m->nfactors = term->nfactors;
        int complete = m->radiance && term->nfactors >= 0 && term->nfactors <= RETEX_MAX_FACTORS;
        for (int k = 0; complete && k < term->nfactors; k++) {
            m->factors[k] = find_factor(set, samples, term->factors[k]);
            complete = m->factors[k] != NULL;
        }
        if (!complete)
            return retex_fail(err, RETEX_EFORMAT, "term %d of the set lacks its radiance or one of its footprints", i);
    }
    return RETEX_OK;
}

/* ---- the work itself ---- */

static void combine_span(const CombineWork *work, size_t first, size_t pixels)
{
    float sum[3 * SPAN_PIXELS] = {0};
    const RetexRoi *roi = &work->roi;
    for (int t = 0; t < work->nmonomials; t++) {
        const Monomial *m = &work->monomials[t];
        const float *factors[RETEX_MAX_FACTORS];
        for (int k = 0; k < m->nfactors; k++)
            factors[k] = m->factors[k] + 3 * first;
        combine_term_kernel(sum, m->radiance + 3 * first, factors, m->nfactors, 3 * pixels);
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
    static const RetexCombineParams defaults = RETEX_COMBINE_INIT;
    CombineWork work = {.dst = dst};
    if (!params)
        params = &defaults;
    if (params->cross != 0 && params->cross != 2 && params->cross != 3)
        return retex_fail(err, RETEX_EINVAL, "cross terms go up to 0, 2 or 3 hits, not %d", params->cross);
    int code = samples ? retex_samples_check(samples, set, err) : RETEX_OK;
    if (!code)
        code = prepare_monomials(&work, set, samples, params->cross, err);
    if (!code)
        code = retex_image_prepare(dst, set->width, set->height, 3, roi, &work.roi, err);
    if (!code)
        retex_parallel(nthreads, (work.roi.y1 - work.roi.y0 + ROWS_A_JOB - 1) / ROWS_A_JOB, combine_job, &work);
    free(work.monomials);
    return code;
}
