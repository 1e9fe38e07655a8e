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
 * s_f and k_f were measured for each kind of footprint in the scenes of tests/fidelity/error.sh.
 *
 * The formula is in estimate_row.c; here the texture's variance is looked up, row by row. */
#include <stdlib.h>

#include <retex/combine.h>
#include <retex/samples.h>

#include "retexture/estimate_row.h"
#include "retexture/polynomial_bands.h"
#include "retexture/sample_row.h"

typedef struct Estimate {
    RetexTexture *const *textures;
    RetexTexture *squares[RETEX_MAX_TARGETS];
} Estimate;

/* How footprints scatter along a row. */
typedef struct Scatter {
    float *scratch;
    const float **variances; /* by footprint: in one of the rows, or NULL: not at all */
    float **rows;
    int *at; /* by footprint: 1 + the row of its own size that this is */
} Scatter;

static void close_scatter(Scatter *s, const RetexSet *set)
{
    for (int f = 0; s->rows && f < set->nfootprints; f++)
        free(s->rows[f]);
    free(s->rows);
    free(s->variances);
    free(s->at);
    free(s->scratch);
}

static int open_scatter(Scatter *s, const RetexSet *set, RetexError *err)
{
    const size_t count = (size_t)set->nfootprints + 1;
    *s = (Scatter){malloc(sizeof *s->scratch * retex_estimate_scratch(set)), calloc(count, sizeof *s->variances),
                   calloc(count, sizeof *s->rows), calloc(count, sizeof *s->at)};
    if (s->scratch && s->variances && s->rows && s->at)
        return RETEX_OK;
    return retex_fail(err, RETEX_ENOMEM, "not enough memory to estimate the error");
}

/* Look up how a footprint scatters at the picture's row y, which several rows may have in common. */
static int look_up(Scatter *s, const Estimate *estimate, const RetexPolynomialRow *row, int footprint, int y,
                   RetexError *err)
{
    const RetexSet *set = row->polynomial->set;
    const RetexFootprint *f = &set->footprints[footprint];
    const RetexTexture *texture = estimate->textures[f->target];
    const int own = texture ? y / retex_set_footprint_scale(set, footprint) : 0;
    RetexFootprintRow from;
    if (!texture || s->at[footprint] == own + 1)
        return RETEX_OK;
    int code = retex_footprint_row_read(&from, row->reader, set, f, own, 0, err);
    float **to = &s->rows[footprint];
    if (!code && !*to && !(*to = malloc(sizeof **to * 3 * (size_t)from.width)))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to estimate the error");
    if (code)
        return code;
    if (from.uv)
        retex_variance_row(texture, estimate->squares[f->target], retex_footprint_filter(set, f), &from, *to);
    s->variances[footprint] = from.uv ? *to : NULL;
    s->at[footprint] = own + 1;
    return RETEX_OK;
}

static int estimate_band(const void *context, RetexPolynomialRow *row, int y0, int y1, float *rgb, RetexError *err)
{
    const RetexSet *set = row->polynomial->set;
    Scatter scatter;
    int code = open_scatter(&scatter, set, err);
    for (int y = y0; !code && y < y1; y++, rgb += 3 * (size_t)set->width) {
        code = retex_polynomial_row_make(row, y, err);
        for (int f = 0; !code && f < set->nfootprints; f++)
            code = look_up(&scatter, context, row, f, y, err);
        if (!code)
            code = retex_estimate_row(row, y, scatter.variances, scatter.scratch, rgb, err);
    }
    close_scatter(&scatter, set);
    return code;
}

int retex_estimate_error(const RetexSet *set, const RetexSamples *samples,
                         RetexTexture *const textures[RETEX_MAX_TARGETS], const RetexCombineParams *params,
                         RetexRowSink *sink, void *context, int nthreads, RetexError *err)
{
    Estimate estimate = {.textures = textures};
    RetexPolynomial polynomial;
    int code = retex_polynomial_open(&polynomial, set, samples, textures, params, 1, nthreads, err);
    for (int t = 0; !code && t < RETEX_MAX_TARGETS; t++)
        if (textures[t])
            code = retex_texture_square(&estimate.squares[t], textures[t], err);
    if (!code)
        code =
            retex_polynomial_bands(&polynomial, 0, set->height, estimate_band, &estimate, sink, context, nthreads, err);
    retex_textures_close(estimate.squares);
    retex_polynomial_close(&polynomial);
    return code;
}
