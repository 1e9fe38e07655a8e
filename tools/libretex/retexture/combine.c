/* Recombination: I = sum over terms of radiance times the product of the factors (supplement 4.2, Eq. 4, and 4.3).
 *
 * What a term means - no hit, dependent, independent, cross - is the set's business; here it is a product of images
 * (edited.h). A factor is the new texture's sample at its footprint or, where the target keeps its original, the
 * footprint's mean original albedo, which is exact for it. */
#include <retex/combine.h>

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/params.h"
#include "base/image.h"
#include "retexture/combine_check.h"
#include "retexture/develop.h"
#include "retexture/edited.h"
#include "retexture/strips.h"
#include "base/value_check.h"
#include "set/set.h"

/* A product of many large colours may be beyond the largest float, and infinities of both signs add to NaN. Such values
 * of the row are computed again in doubles and limited to the largest float. */
static int limit_row(RetexViewReader *reader, int sum, int y, float *restrict out, RetexError *err)
{
    const RetexViewTerm *terms;
    const size_t numbers = 3 * (size_t)reader->view->set->width;
    int count;
    const int code = retex_view_terms(reader, sum, y, &terms, &count, err);
    for (size_t i = 0; i < numbers && !code; i++) {
        double value = 0;
        if (isfinite(out[i]))
            continue;
        for (int t = 0; t < count; t++) {
            const RetexViewTerm *term = &terms[t];
            const int pixel = (int)(i / 3), inside = pixel >= term->span.begin && pixel < term->span.end;
            double product = inside ? 1 : 0;
            for (int k = 0; inside && k < term->product->ninputs && product != 0; k++) {
                const float factor = term->rows[k][i]; /* NaN comes from 0 times infinity when a small image is
                                                          enlarged */
                product = isnan(factor) ? 0 : fmin(fmax(product * factor, -1e200), 1e200);
            }
            value += product;
        }
        out[i] = (float)fmin(fmax(value, -FLT_MAX), FLT_MAX);
    }
    return code;
}

/* A picture that is made: what it is the sum of, and how it is developed. */
typedef struct Combining {
    RetexEdited edited;
    RetexDeveloper developer;
} Combining;

/* Makes a row of the sum, or copies it from the picture of the set. */
static int combine_row(const RetexEdited *edited, RetexViewReader *reader, int y, float *out, RetexError *err)
{
    const size_t numbers = 3 * (size_t)edited->view.set->width;
    const float *row;
    int code = edited->picture ? retex_row_reader_get(reader->set, 0, y, &row, err)
                               : retex_view_row(reader, edited->sum, y, &row, NULL, err);
    if (!code && row)
        memcpy(out, row, numbers * sizeof *out);
    else
        memset(out, 0, numbers * sizeof *out);
    for (size_t i = 0; !code && edited->has_normals && i < numbers; i++)
        out[i] = out[i] < 0 ? 0 : out[i]; /* a sum of light with three normals goes on below 0 behind the horizon */
    if (!code && retex_floats_have_nonfinite(out, numbers))
        code = limit_row(reader, edited->sum, y, out, err);
    return code;
}

static int combine_strip(const void *context, RetexViewReader *reader, int y0, int y1, float *rgb, RetexError *err)
{
    const Combining *combining = context;
    const int width = reader->view->set->width;
    int code = RETEX_OK;
    for (int y = y0; !code && y < y1; y++, rgb += 3 * (size_t)width) {
        code = combine_row(&combining->edited, reader, y, rgb, err);
        if (!code && combining->developer.is_needed)
            retex_develop_kernel(&combining->developer, rgb, (size_t)width);
    }
    return code;
}

/* The developer of a picture: its automatic exposure needs a first pass. */
static int open_developer(RetexDeveloper *developer, const RetexSet *set, RetexTexture *const *textures,
                          const RetexCombineParams *params, int nthreads, RetexError *err)
{
    RetexDevelop own = RETEX_DEVELOP_INIT;
    double stops = 0;
    int code = RETEX_PARAMS_COPY(&own, params->develop, err);
    if (!code)
        code = retex_developer_open(developer, &own, 0, err);
    if (code || !own.auto_exposure)
        return code;
    code = retex_auto_exposure(&stops, set, textures, params, nthreads, err);
    return code ? code : retex_developer_open(developer, &own, stops, err);
}

static int open_combining(Combining *combining, const RetexSet *set, RetexTexture *const *textures,
                          const RetexCombineParams *params, int nthreads, RetexError *err)
{
    const int code = open_developer(&combining->developer, set, textures, params, nthreads, err);
    return code ? code : retex_edited_open(&combining->edited, set, textures, params, EDITED_PICTURE, nthreads, err);
}

int retex_retexture(const RetexSet *set, RetexTexture *const textures[RETEX_MAX_TARGETS],
                    const RetexCombineParams *params, RetexRowSink *sink, void *context, int nthreads, RetexError *err)
{
    RetexCombineParams own = RETEX_COMBINE_INIT;
    Combining combining;
    RetexView *view = &combining.edited.view;
    int code = RETEX_PARAMS_COPY(&own, params, err);
    if (!code)
        code = open_combining(&combining, set, textures, &own, nthreads, err);
    if (code)
        return code;
    RetexRowSpan rows = {0, set->height};
    if (own.y1 > own.y0)
        rows = retex_span_intersection(rows, (RetexRowSpan){own.y0, own.y1});
    if (own.x1 > own.x0)
        view->columns = retex_span_intersection(view->columns, (RetexRowSpan){own.x0, own.x1});
    code = retex_view_strips(view, rows.begin, rows.end, combine_strip, &combining, sink, context, nthreads, err);
    retex_edited_close(&combining.edited);
    return code;
}

int retex_auto_exposure(double *exposure, const RetexSet *set, RetexTexture *const textures[RETEX_MAX_TARGETS],
                        const RetexCombineParams *params, int nthreads, RetexError *err)
{
    RetexCombineParams own = RETEX_COMBINE_INIT;
    RetexMeter meter = {0};
    int code = RETEX_PARAMS_COPY(&own, params, err);
    own.x0 = own.x1 = own.y0 = own.y1 = 0;
    own.develop = NULL;
    if (!code)
        code = retex_meter_open(&meter, set->width, set->height, err);
    if (!code)
        code = retex_retexture(set, textures, &own, retex_meter_rows, &meter, nthreads, err);
    *exposure = retex_meter_close(&meter);
    return code;
}

int retex_combine_check(const RetexSet *set, RetexError *err)
{
    RetexCombineParams all = RETEX_COMBINE_INIT;
    RetexEdited edited;
    all.terms_only = 1;
    int code = retex_edited_open(&edited, set, NULL, &all, EDITED_PICTURE, 1, err);
    retex_edited_close(&edited);
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

int retex_combine(RetexImage *dst, const RetexSet *set, const RetexCombineParams *params, const RetexRoi *roi,
                  int nthreads, RetexError *err)
{
    Region region = {.dst = dst};
    RetexTexture *const none[RETEX_MAX_TARGETS] = {NULL};
    RetexCombineParams own = RETEX_COMBINE_INIT;
    Combining combining;
    int code = RETEX_PARAMS_COPY(&own, params, err);
    if (!code)
        code = open_combining(&combining, set, none, &own, nthreads, err);
    if (code)
        return code;
    code = retex_image_prepare(dst, set->width, set->height, 3, roi, &region.roi, err);
    if (!code)
        code = retex_view_strips(&combining.edited.view, region.roi.y0, region.roi.y1, combine_strip, &combining,
                                 copy_rows, &region, nthreads, err);
    retex_edited_close(&combining.edited);
    return code;
}
