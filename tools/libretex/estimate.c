/* The error to be expected of a retexture.
 *
 * A footprint stands for many places on its texture, each lit by its own share of the light; the retexture multiplies
 * the sum of the light by the mean of the texture. That is wrong by as much as light and texture happen to agree inside
 * the footprint, which grows with how far the texture scatters there and with how much light it multiplies:
 *
 *     e^2 = sum over footprints f of (dI/dA_f)^2 Var(A_f) (k_f^2 + s_f / n_f)  +  (folded I)^2
 *
 * dI/dA_f: the picture's derivative to the footprint's texture; Var(A_f): the texture's variance within it; n_f: the
 * paths that met it, for rendering again looks the texture up at as many places; s_f: what of that chance is left, for
 * samples of a pixel are spread evenly over what is seen sharply; k_f: how much light and texture agree beyond chance.
 * s_f and k_f were measured for each kind of footprint in the scenes of tests/fidelity/error.sh. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>
#include <retex/sample.h>

#include "polynomial.h"

#define ROWS_A_JOB 8

/* k_f and s_f by kind of footprint: hit, sharp, broad, later. */
static const float agreement[] = {0.3f, 0.05f, 0.1f, 0.1f};
static const float chance[] = {1, 0.3f, 1, 1};

typedef struct EstimateWork {
    RetexImage *dst;
    RetexRoi roi;
    const RetexSet *set;
    const RetexSamples *variances;
    Polynomial polynomial;
    float *scratch;     /* by thread: a row's derivatives, by footprint */
    RetexError *errors; /* by thread */
} EstimateWork;

/* Row of a factor's derivatives: footprints, then mixtures. */
static size_t derivative_row(const RetexSet *set, int factor)
{
    return (size_t)(factor >= 0 ? factor : set->nfootprints + RETEX_MIXTURE(factor));
}

/* Add to the row's derivatives those of one term, and to its sum the term itself. */
static void add_term(const RetexSet *set, const Monomial *m, size_t first, size_t n, float *restrict sum,
                     float *restrict derivatives)
{
    for (size_t i = 0; i < n; i++) {
        float radiance = m->radiance[first + i];
        for (int k = m->nfactors; k < m->nimages; k++)
            radiance *= m->factors[k][first + i];
        if (radiance == 0)
            continue;
        for (int k = 0; k < m->nfactors; k++) {
            float others = radiance;
            for (int j = 0; j < m->nfactors; j++)
                if (j != k)
                    others *= m->factors[j][first + i];
            derivatives[derivative_row(set, m->footprints[k]) * n + i] += others;
        }
        for (int k = 0; k < m->nfactors; k++)
            radiance *= m->factors[k][first + i];
        sum[i] += radiance;
    }
}

/* Value of colour c at the picture's pixel x, y in an image that may be smaller, and may have one channel for all. */
static float value_at(const RetexSet *set, const RetexImage *image, int x, int y, int c)
{
    const int scale = retex_set_scale(set, image);
    return image->pixels[retex_image_index(image, x / scale, y / scale) + (image->channels == 3 ? (size_t)c : 0)];
}

/* A mixture's derivative belongs to its footprints, by their shares. */
static void share_derivatives(const RetexSet *set, const RetexMixture *mixture, int x0, int y, size_t n,
                              const float *restrict of_mixture, float *restrict derivatives)
{
    for (size_t i = 0; i < n; i++) {
        float weights[RETEX_SHARES_MAX], sum = 0;
        if (of_mixture[i] == 0)
            continue;
        for (int k = 0; k < mixture->nshares; k++) {
            const RetexImage *image = &set->parts[mixture->shares[k].weight].image;
            weights[k] = value_at(set, image, x0 + (int)(i / 3), y, (int)(i % 3));
            sum += weights[k];
        }
        for (int k = 0; k < mixture->nshares && sum > 0; k++)
            derivatives[(size_t)mixture->shares[k].footprint * n + i] += of_mixture[i] * weights[k] / sum;
    }
}

static size_t scratch_rows(const RetexSet *set)
{
    return 1 + (size_t)set->nfootprints + (size_t)set->nmixtures; /* the sum first */
}

static void estimate_row(const EstimateWork *work, const PolynomialRow *row, int y, float *restrict scratch)
{
    const RetexSet *set = work->set;
    const RetexRoi *roi = &work->roi;
    size_t n = 3 * (size_t)(roi->x1 - roi->x0);
    float *sum = scratch, *derivatives = scratch + n;
    memset(scratch, 0, sizeof *scratch * n * scratch_rows(set));
    for (int t = 0; t < row->count; t++)
        add_term(set, &row->monomials[t], 3 * (size_t)roi->x0, n, sum, derivatives);
    for (int m = 0; m < set->nmixtures; m++)
        share_derivatives(set, &set->mixtures[m], roi->x0, y, n,
                          derivatives + ((size_t)set->nfootprints + (size_t)m) * n, derivatives);
    for (size_t i = 0; i < n; i++)
        sum[i] = (float)set->folded * sum[i] * (float)set->folded * sum[i];
    for (int f = 0; f < set->nfootprints; f++) {
        const RetexImage *variance = &work->variances->images[f];
        const float k = agreement[set->footprints[f].kind], s = chance[set->footprints[f].kind];
        const RetexImage *uv = set->footprints[f].uv >= 0 ? &set->parts[set->footprints[f].uv].image : NULL;
        if (!variance->pixels || !uv)
            continue;
        for (size_t i = 0; i < n; i++) {
            const float d = derivatives[(size_t)f * n + i];
            const int x = roi->x0 + (int)(i / 3);
            if (d == 0)
                continue;
            const float paths = value_at(set, uv, x, y, 2) * (float)set->spp;
            sum[i] += d * d * value_at(set, variance, x, y, (int)(i % 3)) * (k * k + s / fmaxf(paths, 1));
        }
    }
    float *out = work->dst->pixels + retex_image_index(work->dst, roi->x0, y);
    for (size_t i = 0; i < n; i++)
        if ((int)(i % 3) >= roi->c0 && (int)(i % 3) < roi->c1)
            out[i] = sqrtf(sum[i]);
}

static void estimate_job(void *context, int index, int thread)
{
    EstimateWork *work = context;
    RetexError *err = &work->errors[thread];
    size_t room = 3 * (size_t)work->set->width * scratch_rows(work->set);
    PolynomialRow row;
    int y = work->roi.y0 + index * ROWS_A_JOB, code = polynomial_row_open(&row, &work->polynomial, err);
    for (int k = 0; !code && k < ROWS_A_JOB && y < work->roi.y1; k++, y++) {
        code = polynomial_row_make(&row, y, err);
        if (!code)
            estimate_row(work, &row, y, work->scratch + room * (size_t)thread);
    }
    polynomial_row_close(&row);
}

int retex_estimate_error(RetexImage *dst, const RetexSet *set, const RetexSamples *samples,
                         const RetexSamples *variances, const RetexCombineParams *params, const RetexRoi *roi,
                         int nthreads, RetexError *err)
{
    EstimateWork work = {.dst = dst, .set = set, .variances = variances};
    if (!samples || !variances)
        return retex_fail(err, RETEX_EINVAL, "an error is estimated for samples and their variances");
    if (set->source)
        return retex_fail(err, RETEX_EINVAL, "the set is not in memory");
    int code = retex_samples_check(variances, set, err);
    if (!code)
        code = polynomial_open(&work.polynomial, set, samples, NULL, params, 1, nthreads, err);
    if (code)
        return code;
    code = retex_image_prepare(dst, set->width, set->height, 3, roi, &work.roi, err);
    nthreads = retex_threads(nthreads);
    work.errors = calloc((size_t)nthreads, sizeof *work.errors);
    work.scratch = calloc((size_t)nthreads * 3 * (size_t)set->width * scratch_rows(set), sizeof(float));
    if (!code && (!work.scratch || !work.errors))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to estimate the error");
    if (!code)
        retex_parallel(nthreads, (work.roi.y1 - work.roi.y0 + ROWS_A_JOB - 1) / ROWS_A_JOB, estimate_job, &work);
    for (int i = 0; !code && i < nthreads; i++)
        if (work.errors[i].code) {
            code = work.errors[i].code;
            if (err)
                *err = work.errors[i];
        }
    free(work.scratch);
    free(work.errors);
    polynomial_close(&work.polynomial);
    return code;
}
