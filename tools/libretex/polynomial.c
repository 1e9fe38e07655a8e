/* See polynomial.h. */
#include "polynomial.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "enlarge.h"
#include "polynomial_groups.h"
#include "sample_row.h"

#define ROWS_A_JOB 64 /* a pack's band */
#define MISSING 1     /* the code where the set has not what a term refers to */

/* ---- what a factor is made of ---- */

int slot_of_factor(const RetexSet *set, int factor)
{
    return factor >= 0 ? factor : set->nfootprints + RETEX_MIXTURE(factor);
}

int slot_of_gain(const RetexSet *set, int part)
{
    return set->nfootprints + set->nmixtures + part;
}

int slot_count(const RetexSet *set)
{
    return slot_of_gain(set, set->nparts);
}

static const RetexImage *find_part(const RetexSet *set, int part, int least, int most)
{
    if (part < 0 || part >= set->nparts)
        return NULL;
    const RetexImage *im = &set->parts[part].image;
    return im->channels >= least && im->channels <= most ? im : NULL;
}

/* The image whose size a footprint's samples have: the UV they will be made from, they themselves, or the original
 * albedo. NULL where the footprint is not there. */
static const RetexImage *footprint_shape(const Polynomial *p, int footprint)
{
    const RetexSet *set = p->set;
    if (footprint < 0 || footprint >= set->nfootprints)
        return NULL;
    const RetexFootprint *f = &set->footprints[footprint];
    if (p->textures && p->textures[f->target])
        return find_part(set, f->uv, 3, 3);
    if (p->samples && p->samples->images[footprint].pixels)
        return &p->samples->images[footprint];
    return find_part(set, f->albedo, 3, 3);
}

static const RetexImage *mixture_shape(const Polynomial *p, int mixture)
{
    const RetexImage *shape = NULL;
    if (mixture >= p->set->nmixtures)
        return NULL;
    const RetexMixture *m = &p->set->mixtures[mixture];
    for (int k = 0; k < m->nshares; k++) {
        const RetexImage *image = footprint_shape(p, m->shares[k].footprint);
        const RetexImage *weight = find_part(p->set, m->shares[k].weight, 1, 3);
        if (!image || !weight || weight->channels == 2 || weight->width != image->width ||
            weight->height != image->height ||
            (shape && (shape->width != image->width || shape->height != image->height)))
            return NULL;
        shape = image;
    }
    return shape;
}

const RetexImage *factor_shape(const Polynomial *p, int factor)
{
    return factor >= 0 ? footprint_shape(p, factor) : mixture_shape(p, RETEX_MIXTURE(factor));
}

int term_is_left_out(const RetexTerm *term, int cross)
{
    return (term->kind == RETEX_TERM_CROSS2 && cross < 2) || (term->kind == RETEX_TERM_CROSS3 && cross < 3);
}

/* ---- rows at a footprint's own size ---- */

static const float zeros[3 * RETEX_MAX_SIZE];

static int make_footprint_row(const Polynomial *p, RowReader *reader, int footprint, int y, float *scratch,
                              const float **row, RetexError *err)
{
    const RetexSet *set = p->set;
    const RetexFootprint *f = &set->footprints[footprint];
    const RetexTexture *texture = p->textures ? p->textures[f->target] : NULL;
    if (!texture && p->samples && p->samples->images[footprint].pixels) {
        const RetexImage *image = &p->samples->images[footprint];
        *row = image->pixels + retex_image_index(image, 0, y);
        return RETEX_OK;
    }
    if (!texture)
        return row_reader_get(reader, f->albedo, y, row, err);
    FootprintRow from = {.spreads = set->parts[f->spread].image.channels, .width = set->parts[f->uv].image.width};
    int code = row_reader_get(reader, f->uv, y, &from.uv, err);
    *row = NULL;
    if (code || !from.uv)
        return code;
    code = row_reader_get(reader, f->spread, y, &from.spread, err);
    if (!code && !retex_texture_is_opaque(texture)) {
        code = row_reader_get(reader, f->albedo, y, &from.albedo, err);
        from.albedo = from.albedo ? from.albedo : zeros;
    }
    if (code)
        return code;
    from.spread = from.spread ? from.spread : zeros;
    sample_row(texture, footprint_filter(set, f), &from, scratch);
    *row = scratch;
    return RETEX_OK;
}

/* Add a share's weights, and its texture (NULL: black) times them. */
static void add_share(float *restrict sum, float *restrict weights, const float *restrict w, int channels,
                      const float *restrict factor, int width)
{
    size_t step = channels == 3;
    for (size_t i = 0; i < (size_t)width && !factor; i++)
        for (size_t c = 0; c < 3; c++)
            weights[3 * i + c] += w[step ? 3 * i + c : i];
    if (!factor)
        return;
    for (size_t i = 0; i < (size_t)width; i++)
        for (size_t c = 0; c < 3; c++) {
            float share = w[step ? 3 * i + c : i];
            weights[3 * i + c] += share;
            sum[3 * i + c] += share * factor[3 * i + c];
        }
}

/* A colour that has no weight takes the mean of those that have. */
static void divide(float *restrict sum, const float *restrict weights, int width)
{
    for (int i = 0; i < width; i++, sum += 3, weights += 3) {
        float all = weights[0] + weights[1] + weights[2], mean = all > 0 ? (sum[0] + sum[1] + sum[2]) / all : 0;
        for (int c = 0; c < 3; c++)
            sum[c] = weights[c] > 0 ? sum[c] / weights[c] : mean;
    }
}

/* One factor of a mixture: its row, or NULL where it is black. */
typedef int FactorRow(void *context, int footprint, int y, const float **row, RetexError *err);

static int make_mixture_row(const Polynomial *p, RowReader *reader, int mixture, int y, FactorRow *factor_row,
                            void *context, float *weights, float *sum, RetexError *err)
{
    const RetexMixture *m = &p->set->mixtures[mixture];
    const int width = p->set->parts[m->shares[0].weight].image.width;
    memset(sum, 0, sizeof *sum * 3 * (size_t)width);
    memset(weights, 0, sizeof *weights * 3 * (size_t)width);
    for (int k = 0; k < m->nshares; k++) {
        const float *weight, *factor;
        int code = row_reader_get(reader, m->shares[k].weight, y, &weight, err);
        if (!code && weight)
            code = factor_row(context, m->shares[k].footprint, y, &factor, err);
        if (code)
            return code;
        if (weight)
            add_share(sum, weights, weight, p->set->parts[m->shares[k].weight].image.channels, factor, width);
    }
    divide(sum, weights, width);
    return RETEX_OK;
}

/* ---- what is smaller than the picture ---- */

/* Making one image on all threads, row by row. */
typedef struct SmallWork {
    const Polynomial *polynomial;
    RetexImage *image;
    int slot; /* footprint, mixture or gain */
    atomic_int code;
    struct SmallRow *threads;
} SmallWork;

/* One thread's means. */
typedef struct SmallRow {
    const Polynomial *polynomial;
    RowReader *reader;
    float *scratch; /* of one footprint, and of weights */
    RetexError err;
} SmallRow;

static int small_factor_row(void *context, int footprint, int y, const float **row, RetexError *err)
{
    SmallRow *small = context;
    return make_footprint_row(small->polynomial, small->reader, footprint, y, small->scratch, row, err);
}

static int make_small_row(const SmallWork *work, SmallRow *small, float *weights, int y, RetexError *err)
{
    const Polynomial *p = work->polynomial;
    const RetexSet *set = p->set;
    RetexImage *image = work->image;
    float *out = image->pixels + retex_image_index(image, 0, y);
    if (work->slot >= set->nfootprints && work->slot < slot_of_gain(set, 0))
        return make_mixture_row(p, small->reader, work->slot - set->nfootprints, y, small_factor_row, small, weights,
                                out, err);
    const float *row;
    int code = work->slot < set->nfootprints
                   ? small_factor_row(small, work->slot, y, &row, err)
                   : row_reader_get(small->reader, work->slot - slot_of_gain(set, 0), y, &row, err);
    size_t bytes = sizeof *out * (size_t)image->width * (size_t)image->channels;
    if (!code && row)
        memcpy(out, row, bytes);
    return code;
}

static void make_small_job(void *context, int index, int thread)
{
    SmallWork *work = context;
    SmallRow *own = &work->threads[thread];
    const int width = work->image->width, height = work->image->height;
    int code = RETEX_OK;
    if (work->code)
        return;
    own->polynomial = work->polynomial;
    if (!own->reader)
        code = row_reader_open(&own->reader, work->polynomial->set, &own->err);
    if (!code && !own->scratch && !(own->scratch = malloc(sizeof *own->scratch * 6 * (size_t)width)))
        code = retex_fail(&own->err, RETEX_ENOMEM, "not enough memory to combine");
    for (int y = index * ROWS_A_JOB; !code && y < (index + 1) * ROWS_A_JOB && y < height; y++)
        code = make_small_row(work, own, own->scratch + 3 * (size_t)width, y, &own->err);
    if (code)
        atomic_store(&work->code, code);
}

static int make_small(const Polynomial *p, int slot, const RetexImage *shape, int channels, RetexImage *image,
                      int nthreads, RetexError *err)
{
    SmallWork work = {p, image, slot, 0, NULL};
    const int threads = retex_threads(nthreads);
    int code = retex_image_alloc(image, shape->width, shape->height, channels, err);
    if (code)
        return code;
    if (!(work.threads = calloc((size_t)threads, sizeof *work.threads)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    retex_parallel(threads, (image->height + ROWS_A_JOB - 1) / ROWS_A_JOB, make_small_job, &work);
    for (int i = 0; i < threads; i++) {
        if (work.code && work.threads[i].err.code && err)
            *err = work.threads[i].err;
        row_reader_close(&work.threads[i].reader);
        free(work.threads[i].scratch);
    }
    free(work.threads);
    return work.code;
}

static int open_factor(Polynomial *p, int factor, int nthreads, RetexError *err)
{
    const RetexImage *shape = factor_shape(p, factor);
    RetexImage *image = factor >= 0 ? p->footprints + factor : p->mixtures + RETEX_MIXTURE(factor);
    if (factor < 0 && RETEX_MIXTURE(factor) < p->set->nmixtures && (!shape || !retex_set_scale(p->set, shape)))
        return retex_fail(err, RETEX_EFORMAT, "a mixture of the set lacks a footprint or its weight");
    if (!shape || !retex_set_scale(p->set, shape))
        return MISSING;
    if (image->pixels || retex_set_scale(p->set, shape) == 1)
        return RETEX_OK;
    return make_small(p, slot_of_factor(p->set, factor), shape, 3, image, nthreads, err);
}

/* A gain of that scale is read when its rows are needed. */
static int open_gain(Polynomial *p, int part, int scale, int nthreads, RetexError *err)
{
    const RetexImage *shape = find_part(p->set, part, 1, 3);
    if (!shape || shape->channels == 2 || !retex_set_scale(p->set, shape))
        return MISSING;
    if (p->gains[part].pixels || retex_set_scale(p->set, shape) == scale || retex_set_scale(p->set, shape) == 1)
        return RETEX_OK;
    return make_small(p, slot_of_gain(p->set, part), shape, shape->channels, &p->gains[part], nthreads, err);
}

static int open_term(Polynomial *p, int number, int nthreads, RetexError *err)
{
    const RetexTerm *term = &p->set->terms[number];
    const RetexImage *radiance = find_part(p->set, term->radiance, 3, 3);
    int code =
        radiance && retex_set_scale(p->set, radiance) == 1 && term->nfactors >= 0 && term->nfactors <= RETEX_MAX_FACTORS
            ? RETEX_OK
            : MISSING;
    for (int k = 0; k < term->nfactors && !code; k++)
        code = open_factor(p, term->factors[k], nthreads, err);
    if (!code && term->gain)
        code = open_gain(p, term->gain, p->apart ? 1 : group_scale(p, term), nthreads, err);
    if (code == MISSING)
        code = retex_fail(err, RETEX_EFORMAT, "term %d of the set lacks its radiance or one of its footprints", number);
    return code;
}

static void free_images(RetexImage **images, int count)
{
    for (int i = 0; *images && i < count; i++)
        retex_image_free(&(*images)[i]);
    free(*images);
    *images = NULL;
}

void polynomial_close(Polynomial *p)
{
    if (!p->set)
        return;
    free_images(&p->footprints, p->set->nfootprints);
    free_images(&p->mixtures, p->set->nmixtures);
    free_images(&p->gains, p->set->nparts);
    polynomial_groups_close(p);
    *p = (Polynomial){0};
}

int polynomial_open(Polynomial *p, const RetexSet *set, const RetexSamples *samples, RetexTexture *const *textures,
                    const RetexCombineParams *params, int apart, int nthreads, RetexError *err)
{
    static const RetexCombineParams defaults = RETEX_COMBINE_INIT;
    *p = (Polynomial){.set = set, .samples = samples, .textures = textures, .apart = apart};
    p->cross = params ? params->cross : defaults.cross;
    if (p->cross != 0 && p->cross != 2 && p->cross != 3)
        return retex_fail(err, RETEX_EINVAL, "cross terms go up to 0, 2 or 3 hits, not %d", p->cross);
    int code = samples ? retex_samples_check(samples, set, err) : RETEX_OK;
    if (code)
        return code;
    p->footprints = calloc((size_t)set->nfootprints + 1, sizeof *p->footprints);
    p->mixtures = calloc((size_t)set->nmixtures + 1, sizeof *p->mixtures);
    p->gains = calloc((size_t)set->nparts + 1, sizeof *p->gains);
    if (!p->footprints || !p->mixtures || !p->gains)
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", set->nterms);
    for (int i = 0; i < set->nterms && !code; i++)
        if (!term_is_left_out(&set->terms[i], p->cross))
            code = open_term(p, i, nthreads, err);
    if (!code && !apart)
        code = polynomial_groups_open(p, nthreads, err);
    if (code)
        polynomial_close(p);
    return code;
}

/* ---- a row ---- */

static const float black_row[1]; /* stands for one that is 0 all over */

static float *scratch_of(PolynomialRow *row, int slot, RetexError *err)
{
    if (!row->scratch[slot] && !(row->scratch[slot] = malloc(sizeof(float) * 3 * (size_t)row->polynomial->set->width)))
        retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    return row->scratch[slot];
}

void spread_channel(float *row, size_t width)
{
    for (size_t i = width; i-- > 0;)
        row[3 * i] = row[3 * i + 1] = row[3 * i + 2] = row[i];
}

static int full_factor_row(void *context, int factor, int y, const float **made, RetexError *err);

static int make_slot(PolynomialRow *row, int factor, int y, RetexError *err)
{
    const Polynomial *p = row->polynomial;
    const int slot = slot_of_factor(p->set, factor), width = p->set->width;
    const RetexImage *small = factor >= 0 ? &p->footprints[factor] : &p->mixtures[RETEX_MIXTURE(factor)];
    float *scratch = scratch_of(row, slot, err);
    if (!scratch)
        return RETEX_ENOMEM;
    row->made[slot] = scratch;
    if (small->pixels) {
        retex_enlarge_rows(small, retex_set_scale(p->set, small), width, y, y + 1, scratch);
        return RETEX_OK;
    }
    if (factor < 0)
        return make_mixture_row(p, row->reader, RETEX_MIXTURE(factor), y, full_factor_row, row, row->weights, scratch,
                                err);
    int code = make_footprint_row(p, row->reader, factor, y, scratch, &row->made[slot], err);
    if (!code && !row->made[slot])
        row->made[slot] = black_row;
    return code;
}

static int full_factor_row(void *context, int factor, int y, const float **made, RetexError *err)
{
    PolynomialRow *row = context;
    const int slot = slot_of_factor(row->polynomial->set, factor);
    int code = row->made[slot] ? RETEX_OK : make_slot(row, factor, y, err);
    *made = row->made[slot] == black_row ? NULL : row->made[slot];
    return code;
}

static int gain_row(PolynomialRow *row, int part, int y, const float **made, RetexError *err)
{
    const Polynomial *p = row->polynomial;
    const RetexImage *image = &p->set->parts[part].image;
    const int slot = slot_of_gain(p->set, part), width = p->set->width;
    if (!row->made[slot]) {
        float *scratch = scratch_of(row, slot, err);
        if (!scratch)
            return RETEX_ENOMEM;
        row->made[slot] = scratch;
        if (p->gains[part].pixels) {
            retex_enlarge_rows(&p->gains[part], retex_set_scale(p->set, image), width, y, y + 1, scratch);
        } else {
            const float *own;
            int code = row_reader_get(row->reader, part, y, &own, err);
            if (code)
                return code;
            if (own)
                memcpy(scratch, own, sizeof *own * (size_t)width * (size_t)image->channels);
            else
                row->made[slot] = black_row;
        }
        if (image->channels == 1 && row->made[slot] == scratch)
            spread_channel(scratch, (size_t)width);
    }
    *made = row->made[slot] == black_row ? NULL : row->made[slot];
    return RETEX_OK;
}

/* The factors of the picture's size; *black: one of them is 0 all over the row. */
static int factor_rows(PolynomialRow *row, Monomial *m, const int *factors, int count, int y, int *black,
                       RetexError *err)
{
    int code = RETEX_OK;
    m->nfactors = m->nimages = count;
    for (int k = 0; k < count && !code && !*black; k++) {
        code = full_factor_row(row, m->footprints[k] = factors[k], y, &m->factors[k], err);
        *black = !m->factors[k];
    }
    return code;
}

static int make_term(PolynomialRow *row, const RetexTerm *term, int y, RetexError *err)
{
    Monomial *m = &row->monomials[row->count];
    int code = row_reader_get(row->reader, term->radiance, y, &m->radiance, err), black = !m->radiance;
    if (!code)
        code = factor_rows(row, m, term->factors, term->nfactors, y, &black, err);
    if (term->gain && !code && !black) {
        code = gain_row(row, term->gain, y, &m->factors[m->nimages], err);
        black = !m->factors[m->nimages++];
    }
    row->count += !code && !black;
    return code;
}

static int make_group(PolynomialRow *row, const struct PolynomialGroup *group, int y, RetexError *err)
{
    const Polynomial *p = row->polynomial;
    Monomial *m = &row->monomials[row->count];
    int code = row_reader_get(row->reader, group->radiance, y, &m->radiance, err), black = !m->radiance;
    if (!code)
        code = factor_rows(row, m, group->factors, group->nfactors, y, &black, err);
    if (group->gain && !code && !black) {
        code = gain_row(row, group->gain, y, &m->factors[m->nimages], err);
        black = !m->factors[m->nimages++];
    }
    if (group->scale && !code && !black) {
        float *scratch = scratch_of(row, slot_count(p->set) + (int)(group - p->groups), err);
        code = scratch ? RETEX_OK : RETEX_ENOMEM;
        if (scratch)
            retex_enlarge_rows(&group->product, group->scale, p->set->width, y, y + 1, scratch);
        m->factors[m->nimages++] = scratch;
    }
    row->count += !code && !black;
    return code;
}

int polynomial_row_make(PolynomialRow *row, int y, RetexError *err)
{
    const Polynomial *p = row->polynomial;
    int code = RETEX_OK;
    memset(row->made, 0, sizeof *row->made * (size_t)slot_count(p->set));
    row->count = 0;
    for (int g = 0; g < p->ngroups && !code; g++)
        code = make_group(row, &p->groups[g], y, err);
    for (int t = 0; t < p->set->nterms && !code && p->apart; t++)
        if (!term_is_left_out(&p->set->terms[t], p->cross))
            code = make_term(row, &p->set->terms[t], y, err);
    return code;
}

void polynomial_row_close(PolynomialRow *row)
{
    if (!row->polynomial)
        return;
    for (int i = 0; row->scratch && i < slot_count(row->polynomial->set) + row->polynomial->ngroups; i++)
        free(row->scratch[i]);
    free(row->scratch);
    free(row->made);
    free(row->weights);
    free(row->monomials);
    row_reader_close(&row->reader);
    *row = (PolynomialRow){0};
}

int polynomial_row_open(PolynomialRow *row, const Polynomial *polynomial, RetexError *err)
{
    const RetexSet *set = polynomial->set;
    const size_t slots = (size_t)(slot_count(set) + polynomial->ngroups) + 1;
    *row = (PolynomialRow){.polynomial = polynomial};
    int code = row_reader_open(&row->reader, set, err);
    row->monomials = calloc((size_t)set->nterms + 1, sizeof *row->monomials);
    row->made = calloc(slots, sizeof *row->made);
    row->scratch = calloc(slots, sizeof *row->scratch);
    row->weights = malloc(sizeof *row->weights * 3 * (size_t)set->width);
    if (!code && (!row->monomials || !row->made || !row->scratch || !row->weights))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    if (code)
        polynomial_row_close(row);
    return code;
}
