/* See polynomial_groups.h. */
#include "retexture/polynomial_groups.h"

#include <stdlib.h>
#include <string.h>

#include <retex/host/assert.h>
#include <retex/parallel.h>

#include "retexture/combine_kernel.h"
#include "retexture/enlarge.h"
#include "base/jobs.h"
#include "retexture/polynomial_factors.h"
#include "retexture/polynomial_finishes.h"
#include "set/set.h"

#define ROWS_A_JOB 64 /* rows of a pack's strip */

/* 1 of gates, which are made for the picture, and of what is 1. */
static int factor_scale(const RetexPolynomial *p, RetexFactor factor)
{
    const int is_number = factor.kind == POLYNOMIAL_GATE || retex_polynomial_is_one(p, factor);
    const RetexImage *shape = is_number ? NULL : retex_polynomial_factor_image(p, factor);
    return is_number ? 1 : shape ? retex_set_scale(p->set, shape) : 0;
}

int retex_polynomial_group_scale(const RetexPolynomial *p, const RetexPolynomialTerm *term)
{
    int scale = 0;
    for (int k = 0; k < term->nfactors; k++) {
        const int other = factor_scale(p, term->factors[k]);
        scale = other > 1 && (!scale || other < scale) ? other : scale;
    }
    return scale;
}

/* ---- which terms go together ---- */

static int are_together(const struct RetexPolynomialGroup *a, const struct RetexPolynomialGroup *b, int radiance)
{
    const int same = a->scale ? a->radiances[0].part == radiance : a->weighted;
    return same && a->scale == b->scale && a->weighted == b->weighted && a->nfactors == b->nfactors &&
           memcmp(a->factors, b->factors, sizeof *a->factors * (size_t)a->nfactors) == 0;
}

/* The group of a term, which is added if it is new; NULL: no memory. */
static struct RetexPolynomialGroup *group_of(RetexPolynomial *p, const RetexPolynomialTerm *term)
{
    struct RetexPolynomialGroup wanted = {.scale = p->apart ? 0 : retex_polynomial_group_scale(p, term)};
    wanted.weighted = term->weighted && !wanted.scale; /* else the product is weighted */
    for (int k = 0; k < term->nfactors; k++)
        if (!retex_polynomial_is_one(p, term->factors[k]) &&
            (p->apart || factor_scale(p, term->factors[k]) == 1))
            wanted.factors[wanted.nfactors++] = term->factors[k];
    for (int g = 0; g < p->ngroups && !p->apart; g++)
        if (are_together(&p->groups[g], &wanted, term->radiance))
            return &p->groups[g];
    wanted.terms = calloc((size_t)p->set->nterms, sizeof *wanted.terms);
    wanted.radiances = calloc((size_t)p->set->nterms, sizeof *wanted.radiances);
    p->groups[p->ngroups] = wanted; /* closed with the others */
    return wanted.terms && wanted.radiances ? &p->groups[p->ngroups++] : (p->ngroups++, NULL);
}

static int add_term(RetexPolynomial *p, int number, RetexError *err)
{
    const RetexPolynomialTerm *term = &p->terms[number];
    RetexWeightedRadiance radiance = {.part = term->radiance};
    memcpy(radiance.weight, term->weight, sizeof radiance.weight);
    struct RetexPolynomialGroup *group = group_of(p, term);
    if (!group)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", p->set->nterms);
    if (!group->scale || !group->nradiances)
        group->radiances[group->nradiances++] = radiance;
    group->terms[group->nterms++] = number;
    RETEX_ASSERT(!group->scale || group->nradiances == 1); /* terms with a product share one radiance */
    return RETEX_OK;
}

/* ---- their products ---- */

typedef struct ProductThread {
    RetexRowReader *reader;
    float **rows; /* by slot, at the size of the group */
} ProductThread;

typedef struct ProductWork {
    const RetexPolynomial *polynomial;
    struct RetexPolynomialGroup *group;
    ProductThread *threads;
} ProductWork;

/* The row of a reduced factor at the size of the group, with three channels; NULL: black. made[slot]: 1 if it is made
 * already. */
static int reduced_row(const ProductWork *work, ProductThread *own, RetexFactor factor, int y, char *made,
                       const float **row, RetexError *err)
{
    const RetexPolynomial *p = work->polynomial;
    const RetexImage *product = &work->group->product;
    const int slot = retex_polynomial_slot(p->set, factor);
    const RetexImage *image = &p->reduced[slot];
    int channels = image->channels;
    *row = own->rows[slot];
    if (made[slot])
        return RETEX_OK;
    if (!own->rows[slot] && !(own->rows[slot] = malloc(sizeof(float) * 3 * (size_t)product->width)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    if (image->pixels) {
        RETEX_ASSERT(retex_set_scale(p->set, image) % work->group->scale == 0); /* the group has the finest of all */
        const int ratio = retex_set_scale(p->set, image) / work->group->scale;
        retex_enlarge_rows(image, ratio, product->width, y, y + 1, own->rows[slot]);
    } else { /* an image that has the group's size */
        const float *from;
        RETEX_ASSERT(factor.kind == RETEX_FACTOR_IMAGE &&
                     p->set->parts[factor.index].image.width == product->width);
        int code = retex_row_reader_get(own->reader, factor.index, y, &from, err);
        *row = NULL;
        if (code || !from)
            return code;
        channels = p->set->parts[factor.index].image.channels;
        memcpy(own->rows[slot], from, sizeof *from * (size_t)product->width * (size_t)channels);
    }
    if (channels == 1)
        retex_row_gray_to_rgb(own->rows[slot], (size_t)product->width);
    made[slot] = 1;
    *row = own->rows[slot];
    return RETEX_OK;
}

/* Gives all pixels of a row one colour; it has been filled so before, or is 0. */
static void fill_row(float *row, const float color[3], size_t count)
{
    RETEX_ASSERT(memcmp(row, row + count - 3, 3 * sizeof *row) == 0); /* the first pixel tells of all */
    for (size_t i = 0; i < count && (i || memcmp(row, color, 3 * sizeof *color) != 0); i += 3)
        memcpy(row + i, color, 3 * sizeof *color);
}

/* Adds the product of one term's reduced factors, and of its parameters, to a row. */
static int add_product(const ProductWork *work, ProductThread *own, const RetexPolynomialTerm *term, int y, char *made,
                       float *weights, float *sum, RetexError *err)
{
    const RetexPolynomial *p = work->polynomial;
    const size_t count = 3 * (size_t)work->group->product.width;
    const float *rows[RETEX_MAX_FACTORS];
    int used = 0, code = RETEX_OK;
    for (int k = 0; k < term->nfactors && !code; k++) {
        if (factor_scale(p, term->factors[k]) <= 1)
            continue;
        code = reduced_row(work, own, term->factors[k], y, made, &rows[used], err);
        if (!code && !rows[used++])
            return RETEX_OK;
    }
    fill_row(weights, term->weight, count);
    if (!code)
        retex_combine_term_kernel(sum, weights, rows, used, count);
    return code;
}

static int open_thread(const ProductWork *work, ProductThread *own, RetexError *err)
{
    const RetexSet *set = work->polynomial->set;
    if (own->reader)
        return RETEX_OK;
    int code = retex_row_reader_open(&own->reader, set, work->polynomial->samples, err);
    own->rows = calloc((size_t)retex_polynomial_slot_count(set) + 1, sizeof *own->rows);
    return code || own->rows ? code : retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
}

static int product_job(void *context, int index, int thread, RetexError *err)
{
    const ProductWork *work = context;
    ProductThread *own = &work->threads[thread];
    RetexImage *product = &work->group->product;
    const RetexSet *set = work->polynomial->set;
    int code = open_thread(work, own, err);
    float *weights = calloc(3 * (size_t)product->width, sizeof *weights); /* of the last term that was added */
    char *made = malloc((size_t)retex_polynomial_slot_count(set) + 1);
    if (!code && (!weights || !made))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    for (int y = index * ROWS_A_JOB; !code && y < (index + 1) * ROWS_A_JOB && y < product->height; y++) {
        float *sum = product->pixels + retex_image_index(product, 0, y);
        memset(made, 0, (size_t)retex_polynomial_slot_count(set) + 1);
        /* it is 0 already, but reading a fresh page before writing to it causes two page faults and slows other
         * threads */
        memset(sum, 0, sizeof *sum * 3 * (size_t)product->width);
        for (int k = 0; k < work->group->nterms && !code; k++)
            code = add_product(work, own, &work->polynomial->terms[work->group->terms[k]], y, made, weights, sum, err);
    }
    free(weights);
    free(made);
    return code;
}

static int make_product(const RetexPolynomial *p, struct RetexPolynomialGroup *group, int nthreads, RetexError *err)
{
    const int threads = retex_threads(nthreads), scale = group->scale;
    ProductWork work = {p, group, NULL};
    int code = retex_image_alloc(&group->product, (p->set->width + scale - 1) / scale,
                                 (p->set->height + scale - 1) / scale, 3, err);
    if (code)
        return code;
    if (!(work.threads = calloc((size_t)threads, sizeof *work.threads)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    code = retex_jobs_run(threads, (group->product.height + ROWS_A_JOB - 1) / ROWS_A_JOB, product_job, &work, err);
    for (int i = 0; i < threads; i++) {
        ProductThread *own = &work.threads[i];
        retex_row_reader_close(&own->reader);
        for (int k = 0; own->rows && k < retex_polynomial_slot_count(p->set); k++)
            free(own->rows[k]);
        free(own->rows);
    }
    free(work.threads);
    return code;
}

/* ---- all of them ---- */

static int is_one_plain_part(const struct RetexPolynomialGroup *group)
{
    const float *weight = group->radiances[0].weight;
    return group->nradiances == 1 && weight[0] == 1 && weight[1] == 1 && weight[2] == 1;
}

int retex_polynomial_groups_open(RetexPolynomial *p, int nthreads, RetexError *err)
{
    int code = RETEX_OK;
    if (!(p->groups = calloc((size_t)p->set->nterms + 1, sizeof *p->groups)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", p->set->nterms);
    for (int t = 0; t < p->set->nterms && !code; t++)
        if (p->terms[t].radiance >= 0)
            code = add_term(p, t, err);
    for (int g = 0; g < p->ngroups; g++)
        p->groups[g].weighted = p->groups[g].weighted && !is_one_plain_part(&p->groups[g]);
    for (int g = 0; g < p->ngroups && !code; g++)
        RETEX_ASSERT(p->groups[g].weighted || p->groups[g].nradiances == 1); /* else one would be read of several */
    for (int g = 0; g < p->ngroups && !code; g++)
        if (p->groups[g].scale)
            code = make_product(p, &p->groups[g], nthreads, err);
    return code;
}

void retex_polynomial_groups_close(RetexPolynomial *p)
{
    for (int g = 0; g < p->ngroups; g++) {
        retex_image_free(&p->groups[g].product);
        free(p->groups[g].terms);
        free(p->groups[g].radiances);
    }
    free(p->groups);
    p->groups = NULL;
    p->ngroups = 0;
}
