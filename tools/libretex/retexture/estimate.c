/* The expected error of a retexture.
 *
 * A footprint stands for many places on its texture, each lit by its own share of the light; the retexture multiplies
 * the sum of the light by the mean of the texture. The error is the covariance of light and texture inside the
 * footprint. It grows with the variance of the texture there and with the light that multiplies it:
 *
 *     e^2 = sum over footprints f of (dI/dA_f)^2 Var(A_f) (k_f^2 + s_f / n_f)  +  F^2
 *
 * dI/dA_f: derivative of the picture by the texture's value at the footprint; Var(A_f): variance of the texture within
 * the footprint; n_f: number of paths that met it, because a new render would look the texture up at as many places;
 * s_f: the fraction of that noise which remains, because the samples of a pixel are stratified over surfaces that are
 * seen sharply; k_f: the correlation of light and texture beyond noise. s_f and k_f were measured for each kind of
 * footprint in the scenes of tests/fidelity/error.sh. F is what light with more hits than the set keeps may be off by:
 * a tenth of what the factors of quantity FURTHER change, or without them all of it, folded I. Where the texture
 * has a map of finishes, the finish varies within footprints as the colour does, and F has what gates and later hits
 * may be off by, too. The formula is in estimate_row.c; here the variance of the texture is computed, row by row. */
#include <stdlib.h>

#include <retex/combine.h>

#include "base/params.h"
#include "retexture/estimate_row.h"
#include "retexture/strips.h"
#include "retexture/sample_row.h"
#include "set/parts.h"
#include "texture/pyramid.h"

typedef struct Estimate {
    RetexEdited edited;
    RetexDerivatives derivatives;
    RetexTexture *const *textures;
    RetexTexture *squares[RETEX_MAX_TARGETS];
} Estimate;

/* Variance of the textures within the footprints of a row. */
typedef struct Scatter {
    float *scratch;
    const float **variances; /* by footprint: points into rows, or NULL: 0 */
    const float **means;     /* by footprint, for maps of finishes: points behind the variances */
    float **rows;
    int *at; /* by footprint: 1 + the row, at the footprint's own size, that is loaded */
} Scatter;

static void close_scatter(Scatter *s, const RetexSet *set)
{
    for (int f = 0; s->rows && f < set->nfootprints; f++)
        free(s->rows[f]);
    free(s->rows);
    free(s->variances);
    free(s->means);
    free(s->at);
    free(s->scratch);
}

static int open_scatter(Scatter *s, const Estimate *estimate, RetexError *err)
{
    const RetexSet *set = estimate->edited.view.set;
    const size_t count = (size_t)set->nfootprints + 1;
    const size_t scratch = retex_estimate_scratch(&estimate->derivatives);
    *s = (Scatter){malloc(sizeof *s->scratch * scratch), calloc(count, sizeof *s->variances),
                   calloc(count, sizeof *s->means), calloc(count, sizeof *s->rows), calloc(count, sizeof *s->at)};
    if (s->scratch && s->variances && s->means && s->rows && s->at)
        return RETEX_OK;
    return retex_fail(err, RETEX_ENOMEM, "not enough memory to estimate the error");
}

/* Loads the variance of a footprint for row y of the picture; several rows of the picture may share one of a reduced
 * footprint. */
static int look_up(Scatter *s, const Estimate *estimate, const RetexViewReader *reader, int footprint, int y,
                   RetexError *err)
{
    const RetexSet *set = reader->view->set;
    const RetexFootprint *f = &set->footprints[footprint];
    const RetexTexture *texture = estimate->textures[f->target];
    const int own = texture ? y / retex_set_footprint_scale(set, footprint) : 0;
    RetexFootprintRow from;
    if (!texture || s->at[footprint] == own + 1)
        return RETEX_OK;
    int code = retex_footprint_row_read(&from, reader->set, set, f, own, 0, err);
    float **to = &s->rows[footprint];
    const size_t numbers = 3 * (size_t)from.width, rows = retex_texture_has_finishes(texture) ? 2 : 1;
    if (!code && !*to && !(*to = malloc(sizeof **to * rows * numbers)))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to estimate the error");
    if (code)
        return code;
    if (from.uv)
        retex_variance_row(texture, estimate->squares[f->target], retex_footprint_filter(set, f), &from, *to);
    if (from.uv && rows > 1)
        retex_sample_row(texture, retex_footprint_filter(set, f), &from, *to + numbers);
    s->variances[footprint] = from.uv ? *to : NULL;
    s->means[footprint] = from.uv && rows > 1 ? *to + numbers : NULL;
    s->at[footprint] = own + 1;
    return RETEX_OK;
}

static int estimate_strip(const void *context, RetexViewReader *reader, int y0, int y1, float *rgb, RetexError *err)
{
    const Estimate *estimate = context;
    const RetexSet *set = reader->view->set;
    Scatter scatter;
    int code = open_scatter(&scatter, estimate, err);
    for (int y = y0; !code && y < y1; y++, rgb += 3 * (size_t)set->width) {
        for (int f = 0; !code && f < set->nfootprints; f++)
            code = look_up(&scatter, estimate, reader, f, y, err);
        if (!code)
            code = retex_estimate_row(&estimate->derivatives, reader, y, scatter.variances, scatter.means,
                                      scatter.scratch, rgb, err);
    }
    close_scatter(&scatter, set);
    return code;
}

int retex_estimate_error(const RetexSet *set, RetexTexture *const textures[RETEX_MAX_TARGETS],
                         const RetexCombineParams *params, RetexRowSink *sink, void *context, int nthreads,
                         RetexError *err)
{
    Estimate estimate = {.textures = textures};
    RetexCombineParams own = RETEX_COMBINE_INIT;
    if (RETEX_PARAMS_COPY(&own, params, err))
        return RETEX_EINVAL;
    RetexRowSpan rows = {0, set->height};
    if (own.y1 > own.y0)
        rows = retex_span_intersection(rows, (RetexRowSpan){own.y0, own.y1});
    int code = retex_edited_open(&estimate.edited, set, textures, &own, EDITED_TERMS, nthreads, err);
    if (!code)
        code = retex_derivatives_open(&estimate.derivatives, &estimate.edited, err);
    for (int t = 0; !code && t < RETEX_MAX_TARGETS; t++)
        if (textures[t])
            code = retex_texture_square(&estimate.squares[t], textures[t], nthreads, err);
    if (!code)
        code = retex_view_strips(&estimate.edited.view, rows.begin, rows.end, estimate_strip, &estimate, sink, context,
                                 nthreads, err);
    retex_textures_close(estimate.squares);
    retex_derivatives_close(&estimate.derivatives);
    retex_edited_close(&estimate.edited);
    return code;
}
