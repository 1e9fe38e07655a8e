/* See estimate_row.h. Colours are interleaved: n values are n / 3 pixels. */
#include "retexture/estimate_row.h"

#include <float.h>
#include <math.h>
#include <string.h>
#include <retex/host/assert.h>

#include "retexture/polynomial_factors.h"
#include "retexture/polynomial_finishes.h"
#include "set/set.h"

/* k_f and s_f by kind of footprint: hit, sharp, broad, later. */
static const float agreement[] = {0.3f, 0.05f, 0.1f, 0.1f};
static const float chance[] = {1, 0.3f, 1, 1};
/* The same where a finish is chosen: its light comes from few directions, so single samples scatter more than colours
 * do. Measured with the maps of tests/fidelity/table/finish-maps.sh. */
static const float chance_of_finish = 4;
/* Of what further hits change in the light of a closed room, so much is in doubt: 3 to 6 percent where one target has
 * all walls, 11 where an edited one has one of them. */
static const float doubt = 0.1f;

static size_t row_numbers(const RetexSet *set)
{
    return 3 * (size_t)set->width;
}

/* ---- what there are derivatives by ----
 *
 * Rows of derivatives: of footprints and mixtures; where targets have finishes, of these with each finish, and of
 * gates; behind them, by target and finish, light that meets the target again. */

static int texture_count(const RetexSet *set)
{
    return set->nfootprints + set->nmixtures;
}

static int first_gate(const RetexSet *set)
{
    return texture_count(set) * (1 + RETEX_FINISHES_MAX);
}

static int first_later(const RetexSet *set)
{
    return first_gate(set) + RETEX_MAX_TARGETS * RETEX_FINISHES_MAX;
}

static int row_count(const RetexSet *set)
{
    return retex_set_has_finishes(set) ? first_later(set) + RETEX_MAX_TARGETS * RETEX_FINISHES_MAX : texture_count(set);
}

/* The row of a slot, or -1: further hits and images do not vary. Slots of textures come first; further hits follow,
 * then what has finishes, in the order of rows. */
static int derivative_row(const RetexSet *set, int slot)
{
    const int textures = texture_count(set), others = textures + set->nparts + textures;
    return slot < textures ? slot : slot >= others ? slot - others + textures : -1;
}

size_t retex_estimate_scratch(const RetexSet *set)
{
    /* the sum and the change by further hits first; last what gates need: weights by finish, and scratch */
    return row_numbers(set) * (2 + (size_t)row_count(set) + RETEX_FINISHES_MAX + 3);
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

/* Adds light that meets a target with a map more than once. */
static void add_later(const RetexSet *set, const RetexMonomial *m, const int rows[], size_t n, const float *light,
                      float *restrict derivatives)
{
    int hits = 0;
    for (int k = 0; k < m->nfactors; k++)
        hits += rows[k] >= 0 && rows[k] < first_gate(set);
    for (int k = 0; k < m->nfactors && hits > 1; k++) {
        const RetexFactor factor = retex_polynomial_factor(set, m->slots[k]);
        const int finish = retex_quantity_finish(factor.quantity);
        if (finish < 0)
            continue;
        const int of = factor.kind == RETEX_FACTOR_FOOTPRINT ? factor.index
                                                             : set->mixtures[factor.index].shares[0].footprint;
        const int target = factor.kind == POLYNOMIAL_GATE ? factor.index : set->footprints[of].target;
        float *to = derivatives + (size_t)(first_later(set) + target * RETEX_FINISHES_MAX + finish) * n;
        for (size_t i = 0; i < n; i++)
            to[i] += light[i];
    }
}

/* Adds the derivatives of one term to those of the row, and the term itself to its sum, and to `change` what further
 * hits change in it. light: scratch of n numbers. */
static void add_term(const RetexSet *set, const RetexMonomial *m, size_t n, float *restrict sum,
                     float *restrict change, float *restrict derivatives, float *restrict light)
{
    int rows[RETEX_MAX_FACTORS + 1];
    for (int k = 0; k < m->nfactors; k++) {
        RETEX_ASSERT(m->slots[k] >= 0); /* terms are apart: none has a product of reduced factors */
        rows[k] = derivative_row(set, m->slots[k]);
        RETEX_ASSERT(rows[k] < row_count(set));
    }
    for (size_t i = 0; i < n; i++) {
        float radiance = m->radiance[i];
        light[i] = 0;
        for (int k = 0; k < m->nfactors; k++)
            if (rows[k] < 0)
                radiance *= m->factors[k][i];
        if (radiance == 0)
            continue;
        for (int k = 0; k < m->nfactors; k++) {
            float others = radiance;
            if (rows[k] < 0)
                continue;
            for (int j = 0; j < m->nfactors; j++)
                if (j != k && rows[j] >= 0)
                    others *= m->factors[j][i];
            derivatives[(size_t)rows[k] * n + i] += others;
        }
        for (int k = 0; k < m->nfactors; k++)
            if (rows[k] >= 0)
                radiance *= m->factors[k][i];
        sum[i] += light[i] = radiance;
        const float further = further_factor(set, m, i);
        if (further > 0)
            change[i] += radiance - radiance / further;
    }
    if (retex_set_has_finishes(set))
        add_later(set, m, rows, n, light, derivatives);
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

/* ---- the error ---- */

/* A map of finishes in a row: weights of each, RGB, and light that meets the target again. */
typedef struct RowMap {
    int count;
    double tilt; /* radians, of a normal map; else 0 */
    const float *weights[RETEX_FINISHES_MAX];
} RowMap;

/* How much light varies with the normals that a footprint covers: their mean is the shorter, the more they differ.
 * values: by the three normals of which others are sums, from which follows how light changes along u and v. */
static float variance_of_normals(const RowMap *map, const float values[RETEX_FINISHES_MAX], size_t i)
{
    const float s = (float)sin(map->tilt), c = (float)cos(map->tilt);
    const float w0 = map->weights[0][i], w1 = map->weights[1][i], w2 = map->weights[2][i];
    const float x = w1 * s, y = w2 * s, z = w0 + (w1 + w2) * c;
    const float along_u = (values[1] - c * values[0]) / s, along_v = (values[2] - c * values[0]) / s;
    return fmaxf(1 - x * x - y * y - z * z, 0) / 2 * (along_u * along_u + along_v * along_v);
}

/* The mean of n numbers, and their variance, by the weights of finishes at a number of the row. */
static float mean_of(const RowMap *map, const float values[RETEX_FINISHES_MAX], size_t i, float *variance)
{
    float mean = 0, square = 0;
    for (int k = 0; k < map->count; k++) {
        mean += map->weights[k][i] * values[k];
        square += map->weights[k][i] * values[k] * values[k];
    }
    *variance = map->tilt > 0 ? variance_of_normals(map, values, i) : fmaxf(square - mean * mean, 0);
    return mean;
}

/* What the mean of f_k f_k differs by from that of f_k f_l. Weights of normals have either sign. */
static float difference_of_squares(const RowMap *map, const float values[RETEX_FINISHES_MAX], size_t i)
{
    float mean = 0, square = 0;
    for (int k = 0; k < map->count; k++) {
        mean += map->weights[k][i] * values[k];
        square += map->weights[k][i] * values[k] * values[k];
    }
    return fabsf(square - mean * mean);
}

/* Adds the error that the variance of a footprint's texture causes, and that of the finish within it. means: of the
 * texture, as `variances`. */
static int add_footprint(const RetexPolynomialRow *row, int footprint, int y, size_t n, const RowMap *map,
                         const float *variances, const float *means, const float *restrict derivatives,
                         float *restrict sum, RetexError *err)
{
    const RetexSet *set = row->polynomial->set;
    const RetexFootprint *f = &set->footprints[footprint];
    const size_t textures = (size_t)texture_count(set);
    const float k = agreement[f->kind], s = chance[f->kind];
    PartRow uv;
    int code = read_part(&uv, row, f->uv, y, err);
    const PartRow variance = {variances, uv.scale, 3}, mean = {means, uv.scale, 3};
    for (size_t i = 0; !code && i < n; i++) {
        const int x = (int)(i / 3), c = (int)(i % 3);
        float d = derivatives[(size_t)footprint * n + i], by_finish[RETEX_FINISHES_MAX], scatter = 0;
        for (int q = 0; q < map->count; q++)
            by_finish[q] = derivatives[((size_t)(1 + q) * textures + (size_t)footprint) * n + i];
        d += mean_of(map, by_finish, i, &scatter);
        if (d == 0)
            continue;
        const float paths = value_at(&uv, x, 2) * (float)set->spp, a = map->count ? value_at(&mean, x, c) : 0;
        sum[i] += d * d * value_at(&variance, x, c) * (k * k + s / fmaxf(paths, 1)) +
                  a * a * scatter * (k * k + chance_of_finish / fmaxf(paths, 1));
    }
    return code;
}

/* Adds the error of gates, whose footprints agree with their light as broad ones do, and that of later hits, which have
 * the finish of the first: with factors f_k, the mean of f_k f_k stands for that of f_k f_l, and differs from it by the
 * variance of f_k. */
static void add_gates(const RetexSet *set, int target, size_t n, const RowMap *map, const float *restrict derivatives,
                      float *restrict sum)
{
    const size_t gate = (size_t)(first_gate(set) + target * RETEX_FINISHES_MAX),
                 later = (size_t)(first_later(set) + target * RETEX_FINISHES_MAX);
    const float k = agreement[RETEX_FOOTPRINT_BROAD], part = k * k + chance_of_finish / fmaxf((float)set->spp, 1);
    for (size_t i = 0; i < n; i++) {
        float of_gate[RETEX_FINISHES_MAX], of_later[RETEX_FINISHES_MAX], scatter;
        for (int q = 0; q < map->count; q++) {
            of_gate[q] = derivatives[(gate + (size_t)q) * n + i];
            const float light = derivatives[(later + (size_t)q) * n + i], weight = map->weights[q][i];
            of_later[q] = light * weight > 0 ? sqrtf(light / weight) : 0;
        }
        mean_of(map, of_gate, i, &scatter);
        const float bias = difference_of_squares(map, of_later, i);
        sum[i] += part * scatter + bias * bias;
    }
}

/* The parts of the scratch memory, whose size is retex_estimate_scratch: rows of n numbers. */
typedef struct RowScratch {
    float *sum;         /* of all terms; then of squared errors */
    float *change;      /* what further hits change in it */
    float *derivatives; /* row_count of them */
    float *weights;     /* of finishes, RETEX_FINISHES_MAX rows */
    float *rest;        /* for what is done with a row */
} RowScratch;

static RowScratch divide_scratch(const RetexSet *set, float *scratch)
{
    const size_t n = row_numbers(set);
    RowScratch s = {.sum = scratch, .change = scratch + n, .derivatives = scratch + 2 * n};
    s.weights = s.derivatives + (size_t)row_count(set) * n;
    s.rest = s.weights + RETEX_FINISHES_MAX * n;
    return s;
}

/* The sum of all terms, and its derivatives by footprints and gates. */
static int add_terms(const RetexPolynomialRow *row, int y, const RowScratch *s, RetexError *err)
{
    const RetexSet *set = row->polynomial->set;
    const size_t n = row_numbers(set), textures = (size_t)texture_count(set);
    const size_t blocks = retex_set_has_finishes(set) ? 1 + RETEX_FINISHES_MAX : 1; /* colours, then by finish */
    int code = RETEX_OK;
    for (int m = 0; m < row->count; m++)
        add_term(set, &row->monomials[m], n, s->sum, s->change, s->derivatives, s->rest);
    for (size_t block = 0; block < blocks; block++) {
        float *of_footprints = s->derivatives + block * textures * n;
        const float *of_mixtures = of_footprints + (size_t)set->nfootprints * n;
        for (int m = 0; m < set->nmixtures && !code; m++)
            code = share_derivatives(row, &set->mixtures[m], y, n, of_mixtures + (size_t)m * n, of_footprints, err);
    }
    return code;
}

/* Begins the sum of squared errors with light whose further hits have original colours. */
static void begin_errors(const RetexSet *set, const RowScratch *s)
{
    for (size_t i = 0; i < row_numbers(set); i++) {
        const float doubtful = set->further_hits ? doubt * s->change[i] : (float)set->folded * s->sum[i];
        s->sum[i] = doubtful * doubtful;
    }
}

/* Adds the errors of a target's footprints, and of its finishes. */
static int add_target(const RetexPolynomialRow *row, int target, int y, const float *const *variances,
                      const float *const *means, const RowScratch *s, RetexError *err)
{
    const RetexPolynomial *p = row->polynomial;
    const RetexSet *set = p->set;
    const size_t n = row_numbers(set);
    const int finishes = p->mapped[target];
    RowMap map = {.count = finishes, .tilt = finishes ? set->targets[target].normal_tilt * M_PI / 180 : 0};
    float *rows[RETEX_FINISHES_MAX];
    int code = RETEX_OK;
    for (int k = 0; k < finishes; k++)
        map.weights[k] = rows[k] = s->weights + (size_t)k * n;
    if (finishes)
        code = retex_polynomial_gate_rows(p, row->reader, target, y, s->rest, rows, err);
    if (finishes && !code)
        add_gates(set, target, n, &map, s->derivatives, s->sum);
    for (int f = 0; f < set->nfootprints && !code; f++)
        if (variances[f] && set->footprints[f].target == target)
            code = add_footprint(row, f, y, n, &map, variances[f], means[f], s->derivatives, s->sum, err);
    return code;
}

int retex_estimate_row(const RetexPolynomialRow *row, int y, const float *const *variances, const float *const *means,
                       float *scratch, float *out, RetexError *err)
{
    const RetexSet *set = row->polynomial->set;
    const RowScratch s = divide_scratch(set, scratch);
    RETEX_ASSERT(row->polynomial->apart == POLYNOMIAL_APART);
    memset(scratch, 0, sizeof *scratch * retex_estimate_scratch(set));
    int code = add_terms(row, y, &s, err);
    begin_errors(set, &s);
    for (int t = 0; t < set->ntargets && !code; t++)
        code = add_target(row, t, y, variances, means, &s, err);
    for (size_t i = 0; i < row_numbers(set); i++)
        out[i] = s.sum[i] <= FLT_MAX ? sqrtf(s.sum[i]) : FLT_MAX; /* derivatives of large colours may overflow to
                                                                     infinity and NaN */
    return code;
}
