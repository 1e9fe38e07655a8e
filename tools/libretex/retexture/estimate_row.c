/* See estimate_row.h. Colours are interleaved: n values are n / 3 pixels. */
#include "retexture/estimate_row.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <retex/host/assert.h>

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

/* ---- what there are derivatives by ---- */

int retex_derivatives_open(RetexDerivatives *d, const RetexEdited *edited, RetexError *err)
{
    const RetexView *view = &edited->view;
    RETEX_ASSERT(edited->of == EDITED_TERMS);
    *d = (RetexDerivatives){.edited = edited, .rows = malloc(sizeof *d->rows * (size_t)(view->nimages + 1))};
    if (!d->rows)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to estimate the error");
    for (int i = 0; i < view->nimages; i++) {
        const RetexViewImage *image = &view->images[i];
        const int varies = image->kind == VIEW_FOOTPRINT || image->kind == VIEW_GATE ||
                           (image->kind == VIEW_MIXTURE && image->finish != VIEW_ORIGINALS);
        d->rows[i] = varies ? d->count++ : -1;
    }
    return RETEX_OK;
}

void retex_derivatives_close(RetexDerivatives *d)
{
    free(d->rows);
    *d = (RetexDerivatives){0};
}

/* The row of an image of that kind, index and finish, or NULL. */
static const float *row_of(const RetexDerivatives *d, const float *derivatives, size_t n, RetexViewKind kind, int index,
                           int finish)
{
    const int image = retex_view_find(&d->edited->view, kind, index, finish);
    return image < 0 ? NULL : derivatives + (size_t)d->rows[image] * n;
}

/* The number of the row of light that meets a target again with a finish. */
static size_t later_row(const RetexDerivatives *d, int target, int finish)
{
    return (size_t)(d->count + target * RETEX_FINISHES_MAX + finish);
}

static size_t row_count(const RetexDerivatives *d)
{
    const int has_later = retex_set_has_finishes(d->edited->view.set);
    return has_later ? later_row(d, RETEX_MAX_TARGETS, 0) : (size_t)d->count;
}

size_t retex_estimate_scratch(const RetexDerivatives *d)
{
    /* the sum, the change by further hits, and light of a term beside the derivatives */
    return row_numbers(d->edited->view.set) * (3 + row_count(d));
}

/* ---- the derivatives of a term ---- */

/* A term, and of its factors, which begin at 1, the images at their own sizes and their rows of derivatives. */
typedef struct Factors {
    const RetexViewTerm *term;
    int count; /* radiance included */
    const RetexViewImage *images[VIEW_INPUTS_MAX];
    int rows[VIEW_INPUTS_MAX]; /* -1: it does not vary */
} Factors;

static Factors factors_of(const RetexDerivatives *d, const RetexViewTerm *term)
{
    const RetexView *view = &d->edited->view;
    Factors f = {.term = term, .count = term->product->ninputs};
    for (int k = 1; k < f.count; k++) {
        f.images[k] = retex_view_inner(view, term->product->inputs[k]);
        f.rows[k] = d->rows[f.images[k] - view->images];
    }
    return f;
}

/* The product of a term's factors of quantity FURTHER at a number of its row. */
static float further_factor(const Factors *f, size_t i)
{
    float product = 1;
    for (int k = 1; k < f->count; k++)
        if (f->images[k]->kind == VIEW_FURTHER)
            product *= f->term->rows[k][i];
    return product;
}

/* Adds light that meets a target with a map more than once. */
static void add_later(const RetexDerivatives *d, const Factors *f, size_t n, const float *light,
                      float *restrict derivatives)
{
    const RetexSet *set = d->edited->view.set;
    int hits = 0;
    for (int k = 1; k < f->count; k++)
        hits += f->rows[k] >= 0 && f->images[k]->kind != VIEW_GATE;
    for (int k = 1; k < f->count && hits > 1; k++) {
        const RetexViewImage *image = f->images[k];
        if (f->rows[k] < 0 || image->finish < 0)
            continue;
        const int footprint = image->kind == VIEW_FOOTPRINT ? image->index
                              : image->kind == VIEW_MIXTURE ? set->mixtures[image->index].shares[0].footprint
                                                            : -1;
        const int target = footprint < 0 ? image->index : set->footprints[footprint].target;
        float *to = derivatives + later_row(d, target, image->finish) * n;
        for (size_t i = 0; i < n; i++)
            to[i] += light[i];
    }
}

/* Adds the derivatives of one term to those of the row, and the term itself to its sum, and to `change` what further
 * hits change in it. light: scratch of n numbers. */
static void add_term(const RetexDerivatives *d, const RetexViewTerm *term, size_t n, float *restrict sum,
                     float *restrict change, float *restrict derivatives, float *restrict light)
{
    const Factors f = factors_of(d, term);
    for (size_t i = 0; i < n; i++) {
        float radiance = term->rows[0][i];
        light[i] = 0;
        for (int k = 1; k < f.count; k++)
            if (f.rows[k] < 0)
                radiance *= term->rows[k][i];
        if (radiance == 0)
            continue;
        for (int k = 1; k < f.count; k++) {
            float others = radiance;
            if (f.rows[k] < 0)
                continue;
            for (int j = 1; j < f.count; j++)
                if (j != k && f.rows[j] >= 0)
                    others *= term->rows[j][i];
            derivatives[(size_t)f.rows[k] * n + i] += others;
        }
        for (int k = 1; k < f.count; k++)
            if (f.rows[k] >= 0)
                radiance *= term->rows[k][i];
        sum[i] += light[i] = radiance;
        const float further = further_factor(&f, i);
        if (further > 0)
            change[i] += radiance - radiance / further;
    }
    if (retex_set_has_finishes(d->edited->view.set))
        add_later(d, &f, n, light, derivatives);
}

/* A row of a part for row y of the picture; the part may be reduced. */
typedef struct PartRow {
    const float *row; /* NULL: black */
    int scale, channels;
} PartRow;

static int read_part(PartRow *of, RetexViewReader *reader, int part, int y, RetexError *err)
{
    const RetexSet *set = reader->view->set;
    const RetexImage *image = &set->parts[part].image;
    *of = (PartRow){.scale = retex_set_scale(set, image), .channels = image->channels};
    return retex_row_reader_get(reader->set, part, y / of->scale, &of->row, err);
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
static int share_derivatives(const RetexDerivatives *d, RetexViewReader *reader, int image, int y, size_t n,
                             float *restrict derivatives, RetexError *err)
{
    const RetexViewImage *of_view = &reader->view->images[image];
    const RetexMixture *mixture = &reader->view->set->mixtures[of_view->index];
    const float *of_mixture = derivatives + (size_t)d->rows[image] * n;
    PartRow of[RETEX_SHARES_MAX];
    if (is_zero(of_mixture, n)) /* no term uses the mixture */
        return RETEX_OK;
    for (int k = 0; k < mixture->nshares; k++) {
        int code = read_part(&of[k], reader, mixture->shares[k].weight, y, err);
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
            derivatives[(size_t)d->rows[of_view->inputs[k]] * n + i] += of_mixture[i] * weights[k] / sum;
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

/* Rows of derivatives by the finishes of a map. */
typedef struct ByFinish {
    const float *rows[RETEX_FINISHES_MAX]; /* NULL: 0 */
} ByFinish;

static ByFinish by_finish(const RetexDerivatives *d, const float *derivatives, size_t n, RetexViewKind kind, int index,
                          const RowMap *map)
{
    ByFinish by = {{NULL}};
    for (int k = 0; k < map->count; k++)
        by.rows[k] = row_of(d, derivatives, n, kind, index, k);
    return by;
}

/* Adds the error that the variance of a footprint's texture causes, and that of the finish within it. means: of the
 * texture, as `variances`. */
static int add_footprint(const RetexDerivatives *d, RetexViewReader *reader, int footprint, int y, size_t n,
                         const RowMap *map, const float *variances, const float *means,
                         const float *restrict derivatives, float *restrict sum, RetexError *err)
{
    const RetexSet *set = reader->view->set;
    const RetexFootprint *f = &set->footprints[footprint];
    const float *colors = row_of(d, derivatives, n, VIEW_FOOTPRINT, footprint, -1);
    const ByFinish by = by_finish(d, derivatives, n, VIEW_FOOTPRINT, footprint, map);
    const float k = agreement[f->kind], s = chance[f->kind];
    PartRow uv;
    int code = read_part(&uv, reader, f->uv, y, err);
    const PartRow variance = {variances, uv.scale, 3}, mean = {means, uv.scale, 3};
    for (size_t i = 0; !code && i < n; i++) {
        const int x = (int)(i / 3), c = (int)(i % 3);
        float slope = colors ? colors[i] : 0, slopes[RETEX_FINISHES_MAX], scatter = 0;
        for (int q = 0; q < map->count; q++)
            slopes[q] = by.rows[q] ? by.rows[q][i] : 0;
        slope += mean_of(map, slopes, i, &scatter);
        if (slope == 0)
            continue;
        const float paths = value_at(&uv, x, 2) * (float)set->spp, a = map->count ? value_at(&mean, x, c) : 0;
        sum[i] += slope * slope * value_at(&variance, x, c) * (k * k + s / fmaxf(paths, 1)) +
                  a * a * scatter * (k * k + chance_of_finish / fmaxf(paths, 1));
    }
    return code;
}

/* Adds the error of gates, whose footprints agree with their light as broad ones do, and that of later hits, which have
 * the finish of the first: with factors f_k, the mean of f_k f_k stands for that of f_k f_l, and differs from it by the
 * variance of f_k. */
static void add_gates(const RetexDerivatives *d, int target, size_t n, const RowMap *map,
                      const float *restrict derivatives, float *restrict sum)
{
    const RetexSet *set = d->edited->view.set;
    const ByFinish by = by_finish(d, derivatives, n, VIEW_GATE, target, map);
    const float k = agreement[RETEX_FOOTPRINT_BROAD], part = k * k + chance_of_finish / fmaxf((float)set->spp, 1);
    for (size_t i = 0; i < n; i++) {
        float of_gate[RETEX_FINISHES_MAX], of_later[RETEX_FINISHES_MAX], scatter;
        for (int q = 0; q < map->count; q++) {
            of_gate[q] = by.rows[q] ? by.rows[q][i] : 0;
            const float light = derivatives[later_row(d, target, q) * n + i], weight = map->weights[q][i];
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
    float *light;       /* of a term */
    float *derivatives; /* row_count of them */
} RowScratch;

/* The sum of all terms, and its derivatives by footprints and gates. */
static int add_terms(const RetexDerivatives *d, RetexViewReader *reader, int y, const RowScratch *s, RetexError *err)
{
    const RetexSet *set = reader->view->set;
    const size_t n = row_numbers(set);
    const RetexViewTerm *terms;
    int count, code = retex_view_terms(reader, d->edited->sum, y, &terms, &count, err);
    for (int t = 0; t < count && !code; t++)
        add_term(d, &terms[t], n, s->sum, s->change, s->derivatives, s->light);
    const int finishes = retex_set_has_finishes(set) ? RETEX_FINISHES_MAX : 0;
    for (int finish = -1; finish < finishes; finish++) /* colours, then by finish */
        for (int m = 0; m < set->nmixtures && !code; m++) {
            const int image = retex_view_find(reader->view, VIEW_MIXTURE, m, finish);
            if (image >= 0)
                code = share_derivatives(d, reader, image, y, n, s->derivatives, err);
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
static int add_target(const RetexDerivatives *d, RetexViewReader *reader, int target, int y,
                      const float *const *variances, const float *const *means, const RowScratch *s, RetexError *err)
{
    const RetexView *view = reader->view;
    const RetexSet *set = view->set;
    const size_t n = row_numbers(set);
    const int finishes = view->mapped[target];
    RowMap map = {.count = finishes, .tilt = finishes ? set->targets[target].normal_tilt * M_PI / 180 : 0};
    int code = RETEX_OK;
    for (int k = 0; k < finishes && !code; k++)
        code = retex_view_row(reader, retex_view_find(view, VIEW_GATE, target, k), y, &map.weights[k], NULL, err);
    if (finishes && !code)
        add_gates(d, target, n, &map, s->derivatives, s->sum);
    for (int f = 0; f < set->nfootprints && !code; f++)
        if (variances[f] && set->footprints[f].target == target)
            code = add_footprint(d, reader, f, y, n, &map, variances[f], means[f], s->derivatives, s->sum, err);
    return code;
}

int retex_estimate_row(const RetexDerivatives *d, RetexViewReader *reader, int y, const float *const *variances,
                       const float *const *means, float *scratch, float *out, RetexError *err)
{
    const RetexSet *set = reader->view->set;
    const size_t n = row_numbers(set);
    const RowScratch s = {scratch, scratch + n, scratch + 2 * n, scratch + 3 * n};
    memset(scratch, 0, sizeof *scratch * retex_estimate_scratch(d));
    int code = add_terms(d, reader, y, &s, err);
    begin_errors(set, &s);
    for (int t = 0; t < set->ntargets && !code; t++)
        code = add_target(d, reader, t, y, variances, means, &s, err);
    for (size_t i = 0; i < n; i++)
        out[i] = s.sum[i] <= FLT_MAX ? sqrtf(s.sum[i]) : FLT_MAX; /* derivatives of large colours may overflow to
                                                                     infinity and NaN */
    return code;
}
