/* Recombination: I = sum over terms of radiance times the product of the factors (supplement 4.2, Eq. 4, and 4.3).
 *
 * What a term means - no hit, dependent, independent, cross - is the set's business; here it is a polynomial. A
 * factor is the new texture's sample at its footprint or, where the target keeps its original, the footprint's mean
 * original albedo, which is exact for it. */
#include <retex/combine.h>
#include <retex/samples.h>

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/params.h"
#include "base/image.h"
#include "retexture/combine_kernel.h"
#include "retexture/combine_check.h"
#include "retexture/develop.h"
#include "base/value_check.h"
#include "retexture/polynomial_strips.h"
#include "set/set.h"

#define SPAN_PIXELS 512 /* the sum and one span of each image fit the first two levels of cache */

static void combine_row(const RetexPolynomialRow *row, int width, float *restrict out)
{
    const RetexRowSpan columns = row->polynomial->columns;
    if (columns.begin > 0 || columns.end < width)
        memset(out, 0, 3 * (size_t)width * sizeof *out);
    for (int x = columns.begin; x < columns.end; x += SPAN_PIXELS) {
        const int end = columns.end - x < SPAN_PIXELS ? columns.end : x + SPAN_PIXELS;
        const size_t first = 3 * (size_t)x, numbers = 3 * (size_t)(end - x);
        memset(out + first, 0, numbers * sizeof *out);
        for (int t = 0; t < row->count; t++) {
            const RetexMonomial *m = &row->monomials[t];
            const RetexRowSpan span = retex_span_intersection(m->span, (RetexRowSpan){x, end});
            const float *factors[RETEX_MAX_FACTORS + 1];
            if (retex_span_is_empty(span))
                continue;
            const size_t begin = 3 * (size_t)span.begin;
            for (int k = 0; k < m->nfactors; k++)
                factors[k] = m->factors[k] + begin;
            retex_combine_term_kernel(out + begin, m->radiance + begin, factors, m->nfactors,
                                      3 * (size_t)(span.end - span.begin));
        }
    }
}

/* A product of many large colours may be beyond the largest float, and infinities of both signs add to NaN. Such values
 * of the row are computed again in doubles and limited to the largest float. */
static void limit_row(const RetexPolynomialRow *row, size_t count, float *restrict out)
{
    for (size_t i = 0; i < count; i++) {
        double sum = 0;
        if (isfinite(out[i]))
            continue;
        for (int t = 0; t < row->count; t++) {
            const RetexMonomial *m = &row->monomials[t];
            const int pixel = (int)(i / 3), inside = pixel >= m->span.begin && pixel < m->span.end;
            double product = inside ? m->radiance[i] : 0;
            for (int k = 0; inside && k < m->nfactors && product != 0; k++) {
                const float factor = m->factors[k][i]; /* NaN comes from 0 times infinity when a small image is
                                                          enlarged */
                product = isnan(factor) ? 0 : fmin(fmax(product * factor, -1e200), 1e200);
            }
            sum += product;
        }
        out[i] = (float)fmin(fmax(sum, -FLT_MAX), FLT_MAX);
    }
}

static int copy_picture(RetexPolynomialRow *row, int y, float *out, RetexError *err)
{
    const size_t count = 3 * (size_t)row->polynomial->set->width;
    const float *picture;
    int code = retex_row_reader_get(row->reader, 0, y, &picture, err);
    memset(out, 0, count * sizeof *out);
    if (!code && picture)
        memcpy(out, picture, count * sizeof *out);
    return code;
}

static int combine_strip(const void *context, RetexPolynomialRow *row, int y0, int y1, float *rgb, RetexError *err)
{
    const RetexDeveloper *developer = context; /* or NULL */
    const int width = row->polynomial->set->width;
    int code = RETEX_OK;
    for (int y = y0; !code && y < y1; y++, rgb += 3 * (size_t)width) {
        if (row->polynomial->picture)
            code = copy_picture(row, y, rgb, err);
        else
            code = retex_polynomial_row_make(row, y, err);
        if (!code && !row->polynomial->picture)
            combine_row(row, width, rgb);
        for (size_t i = 0; !code && row->polynomial->has_normals && i < 3 * (size_t)width; i++)
            rgb[i] = rgb[i] < 0 ? 0 : rgb[i]; /* a sum of light with three normals goes on below 0 behind the horizon */
        if (!code && retex_floats_have_nonfinite(rgb, 3 * (size_t)width))
            limit_row(row, 3 * (size_t)width, rgb);
        if (!code && developer && developer->is_needed)
            retex_develop_kernel(developer, rgb, (size_t)width);
    }
    return code;
}

/* The developer of a picture: its automatic exposure needs a first pass. */
static int open_developer(RetexDeveloper *developer, const RetexSet *set, const RetexSamples *samples,
                          RetexTexture *const *textures, const RetexCombineParams *params, int nthreads,
                          RetexError *err)
{
    RetexDevelop own = RETEX_DEVELOP_INIT;
    double stops = 0;
    int code = RETEX_PARAMS_COPY(&own, params->develop, err);
    if (!code)
        code = retex_developer_open(developer, &own, 0, err);
    if (code || !own.auto_exposure)
        return code;
    code = retex_auto_exposure(&stops, set, samples, textures, params, nthreads, err);
    return code ? code : retex_developer_open(developer, &own, stops, err);
}

int retex_retexture(const RetexSet *set, const RetexSamples *samples, RetexTexture *const textures[RETEX_MAX_TARGETS],
                    const RetexCombineParams *params, RetexRowSink *sink, void *context, int nthreads, RetexError *err)
{
    RetexCombineParams own = RETEX_COMBINE_INIT;
    RetexDeveloper developer;
    RetexPolynomial polynomial;
    int code = RETEX_PARAMS_COPY(&own, params, err);
    if (!code)
        code = open_developer(&developer, set, samples, textures, &own, nthreads, err);
    if (!code)
        code = retex_polynomial_open(&polynomial, set, samples, textures, &own, POLYNOMIAL_GROUPED, nthreads, err);
    if (code)
        return code;
    RetexRowSpan rows = {0, set->height};
    if (own.y1 > own.y0)
        rows = retex_span_intersection(rows, (RetexRowSpan){own.y0, own.y1});
    if (own.x1 > own.x0)
        polynomial.columns = retex_span_intersection(polynomial.columns, (RetexRowSpan){own.x0, own.x1});
    code = retex_polynomial_strips(&polynomial, rows.begin, rows.end, combine_strip, &developer, sink, context,
                                   nthreads, err);
    retex_polynomial_close(&polynomial);
    return code;
}

int retex_auto_exposure(double *exposure, const RetexSet *set, const RetexSamples *samples,
                        RetexTexture *const textures[RETEX_MAX_TARGETS], const RetexCombineParams *params, int nthreads,
                        RetexError *err)
{
    RetexCombineParams own = RETEX_COMBINE_INIT;
    RetexMeter meter = {0};
    int code = RETEX_PARAMS_COPY(&own, params, err);
    own.x0 = own.x1 = own.y0 = own.y1 = 0;
    own.develop = NULL;
    if (!code)
        code = retex_meter_open(&meter, set->width, set->height, err);
    if (!code)
        code = retex_retexture(set, samples, textures, &own, retex_meter_rows, &meter, nthreads, err);
    *exposure = retex_meter_close(&meter);
    return code;
}

int retex_combine_check(const RetexSet *set, RetexError *err)
{
    RetexCombineParams all = RETEX_COMBINE_INIT;
    RetexPolynomial polynomial;
    all.terms_only = 1;
    int code = retex_polynomial_open(&polynomial, set, NULL, NULL, &all, POLYNOMIAL_GROUPED, 1, err);
    retex_polynomial_close(&polynomial);
    return code == RETEX_ENOMEM ? code : code == RETEX_OK;
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
    RetexTexture *const none[RETEX_MAX_TARGETS] = {NULL};
    RetexCombineParams own = RETEX_COMBINE_INIT;
    RetexDeveloper developer;
    RetexPolynomial polynomial;
    int code = RETEX_PARAMS_COPY(&own, params, err);
    if (!code)
        code = open_developer(&developer, set, samples, none, &own, nthreads, err);
    if (!code)
        code = retex_polynomial_open(&polynomial, set, samples, NULL, &own, POLYNOMIAL_GROUPED, nthreads, err);
    if (code)
        return code;
    code = retex_image_prepare(dst, set->width, set->height, 3, roi, &region.roi, err);
    if (!code)
        code = retex_polynomial_strips(&polynomial, region.roi.y0, region.roi.y1, combine_strip, &developer, copy_rows,
                                       &region, nthreads, err);
    retex_polynomial_close(&polynomial);
    return code;
}
