/* See estimate_row.h. Colours are interleaved: n values are n / 3 pixels. */
#include "retexture/estimate_row.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "retexture/polynomial_factors.h"
#include "set/set.h"

/* k_f and s_f by kind of footprint: hit, sharp, broad, later. */
static const float agreement[] = {0.3f, 0.05f, 0.1f, 0.1f};
static const float chance[] = {1, 0.3f, 1, 1};
/* Of what further hits change in the light of a closed room, so much is in doubt: 3 to 6 percent where one target has
 * all walls, 11 where an edited one has one of them. */
static const float doubt = 0.1f;

static size_t row_numbers(const RetexSet *set)
{
    return 3 * (size_t)set->width;
}

size_t retex_estimate_scratch(const RetexSet *set)
{
    /* the sum and the change by further hits first */
    return row_numbers(set) * (2 + (size_t)set->nfootprints + (size_t)set->nmixtures);
}

/* The product of a monomial's factors of quantity FURTHER at a number of its row. */
static float further_factor(const RetexSet *set, const RetexMonomial *m, size_t i)
{
    float product = 1;
    for (int k = 0; k < m->nfactors; k++)
        if (retex_polynomial_factor(set, m->slots[k]).quantity == RETEX_QUANTITY_FURTHER)
            product *= m->factors[k][i];
    return product;
}

/* Adds the derivatives of one term to those of the row, which are by slot, and the term itself to its sum, and to
 * `change` what further hits change in it. Slots of footprints and mixtures come first. */
static void add_term(const RetexSet *set, const RetexMonomial *m, size_t n, float *restrict sum,
                     float *restrict change, float *restrict derivatives)
{
    const int textures = set->nfootprints + set->nmixtures;
    for (size_t i = 0; i < n; i++) {
        float radiance = m->radiance[i];
        for (int k = 0; k < m->nfactors; k++)
            if (m->slots[k] >= textures)
                radiance *= m->factors[k][i];
        if (radiance == 0)
            continue;
        for (int k = 0; k < m->nfactors; k++) {
            float others = radiance;
            if (m->slots[k] >= textures)
                continue;
            for (int j = 0; j < m->nfactors; j++)
                if (j != k && m->slots[j] < textures)
                    others *= m->factors[j][i];
            derivatives[(size_t)m->slots[k] * n + i] += others;
        }
        for (int k = 0; k < m->nfactors; k++)
            if (m->slots[k] < textures)
                radiance *= m->factors[k][i];
        sum[i] += radiance;
        const float further = further_factor(set, m, i);
        if (further > 0)
            change[i] += radiance - radiance / further;
    }
}

/* A row of a part for row y of the picture; the part may be reduced. */
typedef struct PartRow {
    const float *row; /* NULL: black */
    int scale, channels;
} PartRow;

static int read_part(PartRow *of, const RetexPolynomialRow *row, int part, int y, RetexError *err)
{
    const RetexSet *set = row->polynomial->set;
    const RetexImage *image = &set->parts[part].image;
    *of = (PartRow){.scale = retex_set_scale(set, image), .channels = image->channels};
    return retex_row_reader_get(row->reader, part, y / of->scale, &of->row, err);
}

/* The value of colour c at pixel x of the picture; a part may have one channel for all colours. */
static float value_at(const PartRow *of, int x, int c)
{
    if (!of->row)
        return 0;
    return of->row[(size_t)(x / of->scale) * (size_t)of->channels + (of->channels == 3 ? (size_t)c : 0)];
}

static int is_zero(const float *row, size_t n)
{
    size_t i = 0;
    while (i < n && row[i] == 0)
        i++;
    return i == n;
}

/* Distributes the derivative of a mixture to its footprints by their shares. */
static int share_derivatives(const RetexPolynomialRow *row, const RetexMixture *mixture, int y, size_t n,
                             const float *restrict of_mixture, float *restrict derivatives, RetexError *err)
{
    PartRow of[RETEX_SHARES_MAX];
    if (is_zero(of_mixture, n)) /* no term uses the mixture */
        return RETEX_OK;
    for (int k = 0; k < mixture->nshares; k++) {
        int code = read_part(&of[k], row, mixture->shares[k].weight, y, err);
        if (code)
            return code;
    }
    for (size_t i = 0; i < n; i++) {
        float weights[RETEX_SHARES_MAX], sum = 0;
        if (of_mixture[i] == 0)
            continue;
        for (int k = 0; k < mixture->nshares; k++) {
            weights[k] = value_at(&of[k], (int)(i / 3), (int)(i % 3));
            sum += weights[k];
        }
        for (int k = 0; k < mixture->nshares && sum > 0; k++)
            derivatives[(size_t)mixture->shares[k].footprint * n + i] += of_mixture[i] * weights[k] / sum;
    }
    return RETEX_OK;
}

/* Adds the error that the variance of a footprint's texture causes. */
static int add_footprint(const RetexPolynomialRow *row, const RetexFootprint *f, int y, size_t n,
                         const float *variances, const float *restrict derivatives, float *restrict sum,
                         RetexError *err)
{
    const float k = agreement[f->kind], s = chance[f->kind];
    PartRow uv;
    int code = read_part(&uv, row, f->uv, y, err);
    const PartRow variance = {variances, uv.scale, 3};
    for (size_t i = 0; !code && i < n; i++) {
        const float d = derivatives[i];
        const int x = (int)(i / 3);
        if (d == 0)
            continue;
        const float paths = value_at(&uv, x, 2) * (float)row->polynomial->set->spp;
        sum[i] += d * d * value_at(&variance, x, (int)(i % 3)) * (k * k + s / fmaxf(paths, 1));
    }
    return code;
}

int retex_estimate_row(const RetexPolynomialRow *row, int y, const float *const *variances, float *scratch, float *out,
                       RetexError *err)
{
    const RetexSet *set = row->polynomial->set;
    const size_t n = row_numbers(set);
    float *sum = scratch, *change = scratch + n, *derivatives = scratch + 2 * n;
    int code = RETEX_OK;
    memset(scratch, 0, sizeof *scratch * retex_estimate_scratch(set));
    for (int t = 0; t < row->count; t++)
        add_term(set, &row->monomials[t], n, sum, change, derivatives);
    for (int m = 0; m < set->nmixtures && !code; m++)
        code = share_derivatives(row, &set->mixtures[m], y, n, derivatives + (size_t)(set->nfootprints + m) * n,
                                 derivatives, err);
    for (size_t i = 0; i < n; i++) {
        const float doubtful = set->further_hits ? doubt * change[i] : (float)set->folded * sum[i];
        sum[i] = doubtful * doubtful;
    }
    for (int f = 0; f < set->nfootprints && !code; f++)
        if (variances[f])
            code = add_footprint(row, &set->footprints[f], y, n, variances[f], derivatives + (size_t)f * n, sum, err);
    for (size_t i = 0; i < n; i++)
        out[i] = sum[i] <= FLT_MAX ? sqrtf(sum[i]) : FLT_MAX; /* derivatives of large colours may overflow to
                                                                 infinity and NaN */
    return code;
}
