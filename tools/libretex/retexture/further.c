/* How light goes on beyond the hits that a set keeps apart: one ratio for the whole picture. From hit to hit, light in
 * a room tends to the eigenvector of light transport that has the largest eigenvalue, and then falls by that
 * eigenvalue, everywhere alike. A ratio of a pixel's own numbers would be noise. */
#include <stdlib.h>
#include <string.h>

#include <retex/host/set_build.h>

#include "base/half.h"
#include "set/rows.h"
#include "set/set.h"

/* Sums over the picture: light of the last order, that times the mean albedo of further hits, and light of the order
 * before. */
typedef struct FurtherSums {
    double last[3], reflected[3], before[3];
} FurtherSums;

/* The number of a term's factor of quantity FURTHER, or -1. */
static int further_factor(const RetexTerm *term)
{
    for (int k = 0; k < term->nfactors; k++)
        if (term->factors[k].quantity == RETEX_QUANTITY_FURTHER)
            return k;
    return -1;
}

/* Whether a term has the hits of another one but for the last. */
static int is_before(const RetexTerm *term, const RetexTerm *last)
{
    const int hits = retex_term_hits(last);
    return retex_term_is_light(term) && further_factor(term) < 0 && retex_term_hits(term) == hits - 1 &&
           memcmp(term->factors, last->factors, sizeof *term->factors * (size_t)(hits - 1)) == 0;
}

/* Rows of numbers as files have them, so that the ratio is the same whether a render keeps its parts in memory or in a
 * band store. */
typedef struct StoredRows {
    const RetexSet *set;
    RetexRowReader *reader;
    uint16_t *halves;
    float *light, *mean, *albedo, *weight, *weights; /* of a row; mean: of albedos by their weights, times weights */
} StoredRows;

static int open_rows(StoredRows *rows, const RetexSet *set, RetexError *err)
{
    const size_t width = (size_t)set->width;
    *rows = (StoredRows){.set = set};
    rows->halves = malloc(3 * width * sizeof *rows->halves);
    rows->light = malloc(15 * width * sizeof *rows->light);
    if (!rows->halves || !rows->light)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a row of the set");
    rows->mean = rows->light + 3 * width, rows->albedo = rows->mean + 3 * width;
    rows->weight = rows->albedo + 3 * width, rows->weights = rows->weight + 3 * width;
    return retex_row_reader_open(&rows->reader, set, err);
}

static void close_rows(StoredRows *rows)
{
    retex_row_reader_close(&rows->reader);
    free(rows->light);
    free(rows->halves);
}

/* Copies row y of a part; 0 where it is black. */
static int copy_row(StoredRows *rows, int part, int y, float *to, RetexError *err)
{
    const RetexPart *of = &rows->set->parts[part];
    const size_t count = (size_t)rows->set->width * (size_t)of->image.channels;
    const float *row;
    if (of->image.width != rows->set->width || of->image.channels > 3)
        return retex_fail(err, RETEX_EINVAL, "part `%s` is not of the picture's size", of->name);
    const int code = retex_row_reader_get(rows->reader, part, y, &row, err);
    memset(to, 0, count * sizeof *to);
    if (code || !row)
        return code;
    if (of->type == RETEX_FLOAT) {
        memcpy(to, row, count * sizeof *to);
        return RETEX_OK;
    }
    retex_half_from_float(rows->halves, row, count);
    retex_half_to_float(to, rows->halves, count);
    return RETEX_OK;
}

/* Adds a footprint to the mean albedo of the row. weight: a part, or -1 for 1. */
static int add_share(StoredRows *rows, int footprint, int weight, int y, RetexError *err)
{
    int code = copy_row(rows, rows->set->footprints[footprint].albedo, y, rows->albedo, err);
    if (!code && weight >= 0)
        code = copy_row(rows, weight, y, rows->weight, err);
    const int channels = weight >= 0 ? rows->set->parts[weight].image.channels : 0;
    for (int i = 0; i < 3 * rows->set->width && !code; i++) {
        const float w = channels == 3 ? rows->weight[i] : channels ? rows->weight[i / 3] : 1;
        rows->weights[i] += w;
        rows->mean[i] += w * rows->albedo[i];
    }
    return code;
}

/* Makes the mean albedo of a row, times its weights. */
static int mean_albedo(StoredRows *rows, RetexFactor factor, int y, RetexError *err)
{
    const RetexMixture *mixture = factor.kind == RETEX_FACTOR_MIXTURE ? &rows->set->mixtures[factor.index] : NULL;
    int code = RETEX_OK;
    memset(rows->mean, 0, 3 * (size_t)rows->set->width * sizeof *rows->mean);
    memset(rows->weights, 0, 3 * (size_t)rows->set->width * sizeof *rows->weights);
    if (!mixture)
        return add_share(rows, factor.index, -1, y, err);
    for (int k = 0; k < mixture->nshares && !code; k++)
        code = add_share(rows, mixture->shares[k].footprint, mixture->shares[k].weight, y, err);
    return code;
}

static void add_light(double sums[3], const StoredRows *rows)
{
    for (int i = 0; i < 3 * rows->set->width; i++)
        sums[i % 3] += (double)rows->light[i];
}

static void add_reflected(double sums[3], const StoredRows *rows)
{
    for (int i = 0; i < 3 * rows->set->width; i++)
        if (rows->weights[i] > 0)
            sums[i % 3] += (double)(rows->light[i] * rows->mean[i] / rows->weights[i]);
}

static int add_term(FurtherSums *sums, StoredRows *rows, const RetexTerm *last, int y, RetexError *err)
{
    const RetexSet *set = rows->set;
    int code = copy_row(rows, last->radiance, y, rows->light, err);
    if (!code)
        code = mean_albedo(rows, last->factors[further_factor(last)], y, err);
    if (code)
        return code;
    add_light(sums->last, rows);
    add_reflected(sums->reflected, rows);
    for (int t = 0; t < set->nterms && !code; t++) {
        if (!is_before(&set->terms[t], last))
            continue;
        code = copy_row(rows, set->terms[t].radiance, y, rows->light, err);
        if (!code)
            add_light(sums->before, rows);
    }
    return code;
}

/* The ratio q of last = q before (1 + q a + ... + (q a)^n), which grows with q; at most 1, as no light is made. */
static double solve(double last, double before, double albedo, int n)
{
    double low = 0, high = 1;
    for (int step = 0; step < 40; step++) {
        const double q = (low + high) / 2;
        double sum = 1;
        for (int k = 0; k < n; k++)
            sum = sum * q * albedo + 1;
        *(q * before * sum < last ? &low : &high) = q;
    }
    return (low + high) / 2;
}

int retex_set_find_further(RetexSet *set, RetexError *err)
{
    FurtherSums sums = {.last = {0}};
    StoredRows rows;
    int hits = 0, code = open_rows(&rows, set, err);
    for (int t = 0; t < set->nterms && !code; t++) {
        if (further_factor(&set->terms[t]) < 0)
            continue;
        hits = retex_term_hits(&set->terms[t]);
        for (int y = 0; y < set->height && !code; y++)
            code = add_term(&sums, &rows, &set->terms[t], y, err);
    }
    close_rows(&rows);
    if (code)
        return code;
    /* a path of n segments meets n - 1 surfaces, the last segment being that to the light */
    const int most = set->max_depth - 1 - hits;
    set->further_hits = !hits || most < 0 ? 0 : most > RETEX_FURTHER_HITS_MAX ? RETEX_FURTHER_HITS_MAX : most;
    for (int c = 0; c < 3; c++)
        set->further_ratio[c] =
            sums.last[c] > 0 && sums.before[c] > 0
                ? (float)solve(sums.last[c], sums.before[c], sums.reflected[c] / sums.last[c], set->further_hits)
                : 0;
    return RETEX_OK;
}
