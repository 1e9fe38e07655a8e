/* See polynomial.h. */
#include "retexture/polynomial.h"

#include <stdlib.h>
#include <string.h>

#include "retexture/enlarge.h"
#include "retexture/polynomial_factors.h"
#include "retexture/polynomial_groups.h"
#include "retexture/polynomial_reduced.h"

#define MISSING 1 /* the code where the set lacks a part that a term needs */

#define ALL_CROSS_TERMS 3

/* Finds what is edited. Corrections, and the picture of part 0, are those of all cross terms. */
static void find_edited(RetexPolynomial *p)
{
    const RetexSet *set = p->set;
    int count = 0;
    for (int f = 0; f < set->nfootprints; f++) {
        const int t = set->footprints[f].target;
        p->edited[t] |= (p->textures && p->textures[t]) || (p->samples && retex_samples_have(p->samples, f));
    }
    for (int t = 0; t < set->ntargets; t++)
        count += p->edited[t];
    p->picture = set->exact_picture && !count && !p->apart && p->cross == ALL_CROSS_TERMS;
    p->correction = p->apart || p->cross < ALL_CROSS_TERMS ? 0 : (float)retex_correction_weight(set->ntargets, count);
}

/* ---- opening ---- */

static int has_cross_terms(const RetexSet *set)
{
    for (int t = 0; t < set->nterms; t++)
        if (set->terms[t].kind == RETEX_TERM_CROSS2 || set->terms[t].kind == RETEX_TERM_CROSS3)
            return 1;
    return 0;
}

/* Allocates the image of a factor that is reduced, to be filled in later. */
static int open_factor(RetexPolynomial *p, int factor, RetexError *err)
{
    const RetexImage *shape = retex_polynomial_factor_image(p, factor);
    RetexImage *image = factor >= 0 ? p->footprints + factor : p->mixtures + RETEX_MIXTURE(factor);
    if (factor < 0 && RETEX_MIXTURE(factor) < p->set->nmixtures && (!shape || !retex_set_scale(p->set, shape)))
        return retex_fail(err, RETEX_EFORMAT, "a mixture of the set lacks a footprint or its weight");
    if (!shape || !retex_set_scale(p->set, shape))
        return MISSING;
    if (image->pixels || retex_set_scale(p->set, shape) == 1)
        return RETEX_OK;
    return retex_image_alloc(image, shape->width, shape->height, 3, err);
}

/* A gain of that scale is read row by row, when it is needed. */
static int open_gain(RetexPolynomial *p, int part, int scale, RetexError *err)
{
    const RetexImage *shape = retex_polynomial_part_image(p->set, part, 1, 3);
    if (!shape || shape->channels == 2 || !retex_set_scale(p->set, shape))
        return MISSING;
    if (p->gains[part].pixels || retex_set_scale(p->set, shape) == scale || retex_set_scale(p->set, shape) == 1)
        return RETEX_OK;
    return retex_image_alloc(&p->gains[part], shape->width, shape->height, shape->channels, err);
}

static int open_term(RetexPolynomial *p, int number, RetexError *err)
{
    const RetexTerm *term = &p->set->terms[number];
    const RetexImage *radiance = retex_polynomial_part_image(p->set, term->radiance, 3, 3);
    int code =
        radiance && retex_set_scale(p->set, radiance) == 1 && term->nfactors >= 0 && term->nfactors <= RETEX_MAX_FACTORS
            ? RETEX_OK
            : MISSING;
    for (int k = 0; k < term->nfactors && !code; k++)
        code = open_factor(p, term->factors[k], err);
    if (!code && term->gain)
        code = open_gain(p, term->gain, p->apart ? 1 : retex_polynomial_group_scale(p, term), err);
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

void retex_polynomial_close(RetexPolynomial *p)
{
    if (!p->set)
        return;
    free_images(&p->footprints, p->set->nfootprints);
    free_images(&p->mixtures, p->set->nmixtures);
    free_images(&p->gains, p->set->nparts);
    retex_polynomial_groups_close(p);
    *p = (RetexPolynomial){0};
}

int retex_polynomial_open(RetexPolynomial *p, const RetexSet *set, const RetexSamples *samples,
                          RetexTexture *const *textures, const RetexCombineParams *params, int apart, int nthreads,
                          RetexError *err)
{
    static const RetexCombineParams defaults = RETEX_COMBINE_INIT;
    *p = (RetexPolynomial){.set = set, .samples = samples, .textures = textures, .apart = apart};
    p->columns = (RetexRowSpan){0, set->width};
    p->cross = params ? params->cross : defaults.cross;
    if (p->cross != 0 && p->cross != 2 && p->cross != 3)
        return retex_fail(err, RETEX_EINVAL, "cross terms go up to 0, 2 or 3 hits, not %d", p->cross);
    if (!has_cross_terms(set))
        p->cross = ALL_CROSS_TERMS;
    int code = samples ? retex_samples_check(samples, set, err) : RETEX_OK;
    if (code)
        return code;
    find_edited(p);
    p->footprints = calloc((size_t)set->nfootprints + 1, sizeof *p->footprints);
    p->mixtures = calloc((size_t)set->nmixtures + 1, sizeof *p->mixtures);
    p->gains = calloc((size_t)set->nparts + 1, sizeof *p->gains);
    if (!p->footprints || !p->mixtures || !p->gains)
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", set->nterms);
    for (int i = 0; i < set->nterms && !code; i++)
        if (retex_polynomial_has_term(p, &set->terms[i]))
            code = open_term(p, i, err);
    if (!code)
        code = retex_polynomial_reduced_make(p, nthreads, err);
    if (!code && !apart)
        code = retex_polynomial_groups_open(p, nthreads, err);
    if (code)
        retex_polynomial_close(p);
    return code;
}

/* ---- a row ---- */

static const float black_row[1]; /* marks a row that is 0 everywhere */

static float *buffer_values(RetexPolynomialRow *row, int slot, RetexError *err)
{
    RetexRowBuffer *buffer = &row->buffers[slot];
    if (!buffer->values && !(buffer->values = calloc(3 * (size_t)row->polynomial->set->width, sizeof *buffer->values)))
        retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    return buffer->values;
}

static int full_factor_row(void *context, int factor, int y, const float **made, RetexError *err);

static int make_slot(RetexPolynomialRow *row, int factor, int y, RetexError *err)
{
    const RetexPolynomial *p = row->polynomial;
    const int slot = retex_polynomial_slot_of_factor(p->set, factor), width = p->set->width;
    const RetexImage *small = factor >= 0 ? &p->footprints[factor] : &p->mixtures[RETEX_MIXTURE(factor)];
    float *values = buffer_values(row, slot, err);
    int code = RETEX_OK;
    if (!values)
        return RETEX_ENOMEM;
    row->made[slot] = values;
    row->spans[slot] = (RetexRowSpan){0, width};
    if (small->pixels) {
        retex_enlarge_rows(small, retex_set_scale(p->set, small), width, y, y + 1, values);
    } else if (factor < 0) {
        code = retex_polynomial_mixture_row(p, row->reader, RETEX_MIXTURE(factor), y, full_factor_row, row,
                                            row->weights, &row->buffers[slot], err);
        row->spans[slot] = row->buffers[slot].filled;
    } else {
        code = retex_polynomial_footprint_row(p, row->reader, factor, y, &row->buffers[slot], &row->made[slot],
                                              &row->spans[slot], err);
    }
    if (!code && (!row->made[slot] || retex_span_is_empty(row->spans[slot])))
        row->made[slot] = black_row;
    return code;
}

static int full_factor_row(void *context, int factor, int y, const float **made, RetexError *err)
{
    RetexPolynomialRow *row = context;
    const int slot = retex_polynomial_slot_of_factor(row->polynomial->set, factor);
    int code = row->made[slot] ? RETEX_OK : make_slot(row, factor, y, err);
    *made = row->made[slot] == black_row ? NULL : row->made[slot];
    return code;
}

static int gain_row(RetexPolynomialRow *row, int part, int y, const float **made, RetexError *err)
{
    const RetexPolynomial *p = row->polynomial;
    const RetexImage *image = &p->set->parts[part].image;
    const int slot = retex_polynomial_slot_of_gain(p->set, part), width = p->set->width;
    if (!row->made[slot]) {
        float *values = buffer_values(row, slot, err);
        if (!values)
            return RETEX_ENOMEM;
        row->made[slot] = values;
        if (p->gains[part].pixels) {
            retex_enlarge_rows(&p->gains[part], retex_set_scale(p->set, image), width, y, y + 1, values);
        } else {
            const float *own;
            int code = retex_row_reader_get(row->reader, part, y, &own, err);
            if (code)
                return code;
            if (own)
                memcpy(values, own, sizeof *own * (size_t)width * (size_t)image->channels);
            else
                row->made[slot] = black_row;
        }
        if (image->channels == 1 && row->made[slot] == values)
            retex_row_gray_to_rgb(values, (size_t)width);
    }
    *made = row->made[slot] == black_row ? NULL : row->made[slot];
    return RETEX_OK;
}

/* Makes the rows of all factors of the picture's size; *black: one of them is 0 everywhere in the row. */
static int factor_rows(RetexPolynomialRow *row, RetexMonomial *m, const int *factors, int count, int y, int *black,
                       RetexError *err)
{
    int code = RETEX_OK;
    m->nfactors = m->nimages = count;
    m->span = (RetexRowSpan){0, row->polynomial->set->width};
    for (int k = 0; k < count && !code && !*black; k++) {
        code = full_factor_row(row, m->footprints[k] = factors[k], y, &m->factors[k], err);
        m->span = retex_span_intersection(
            m->span, row->spans[retex_polynomial_slot_of_factor(row->polynomial->set, factors[k])]);
        *black = !m->factors[k] || retex_span_is_empty(m->span);
    }
    return code;
}

static int make_term(RetexPolynomialRow *row, const RetexTerm *term, int y, RetexError *err)
{
    RetexMonomial *m = &row->monomials[row->count];
    int code = retex_row_reader_get(row->reader, term->radiance, y, &m->radiance, err), black = !m->radiance;
    if (!code)
        code = factor_rows(row, m, term->factors, term->nfactors, y, &black, err);
    if (term->gain && !code && !black) {
        code = gain_row(row, term->gain, y, &m->factors[m->nimages], err);
        black = !m->factors[m->nimages++];
    }
    row->count += !code && !black;
    return code;
}

/* A row of the weight of corrections. */
static int weight_row(RetexPolynomialRow *row, const float **made, RetexError *err)
{
    const RetexPolynomial *p = row->polynomial;
    const int slot = retex_polynomial_slot_count(p->set) + p->ngroups;
    float *values = buffer_values(row, slot, err);
    if (!values)
        return RETEX_ENOMEM;
    if (values[0] != p->correction)
        for (size_t i = 0; i < 3 * (size_t)p->set->width; i++)
            values[i] = p->correction;
    *made = values;
    return RETEX_OK;
}

static int make_group(RetexPolynomialRow *row, const struct RetexPolynomialGroup *group, int y, RetexError *err)
{
    const RetexPolynomial *p = row->polynomial;
    RetexMonomial *m = &row->monomials[row->count];
    int code = retex_row_reader_get(row->reader, group->radiance, y, &m->radiance, err), black = !m->radiance;
    if (!code)
        code = factor_rows(row, m, group->factors, group->nfactors, y, &black, err);
    if (group->gain && !code && !black) {
        code = gain_row(row, group->gain, y, &m->factors[m->nimages], err);
        black = !m->factors[m->nimages++];
    }
    if (group->scale && !code && !black) {
        float *values = buffer_values(row, retex_polynomial_slot_count(p->set) + (int)(group - p->groups), err);
        code = values ? RETEX_OK : RETEX_ENOMEM;
        if (values)
            retex_enlarge_rows(&group->product, group->scale, p->set->width, y, y + 1, values);
        m->factors[m->nimages++] = values;
    }
    if (group->corrects && p->correction != 1 && !code && !black)
        code = weight_row(row, &m->factors[m->nimages++], err);
    row->count += !code && !black;
    return code;
}

int retex_polynomial_row_make(RetexPolynomialRow *row, int y, RetexError *err)
{
    const RetexPolynomial *p = row->polynomial;
    int code = RETEX_OK;
    memset(row->made, 0, sizeof *row->made * (size_t)retex_polynomial_slot_count(p->set));
    row->count = 0;
    for (int g = 0; g < p->ngroups && !code; g++)
        code = make_group(row, &p->groups[g], y, err);
    for (int t = 0; t < p->set->nterms && !code && p->apart; t++)
        if (retex_polynomial_has_term(p, &p->set->terms[t]))
            code = make_term(row, &p->set->terms[t], y, err);
    return code;
}

void retex_polynomial_row_close(RetexPolynomialRow *row)
{
    if (!row->polynomial)
        return;
    for (int i = 0; row->buffers && i <= retex_polynomial_slot_count(row->polynomial->set) + row->polynomial->ngroups;
         i++)
        free(row->buffers[i].values);
    free(row->buffers);
    free(row->spans);
    free(row->made);
    free(row->weights);
    free(row->monomials);
    retex_row_reader_close(&row->reader);
    *row = (RetexPolynomialRow){0};
}

int retex_polynomial_row_open(RetexPolynomialRow *row, const RetexPolynomial *polynomial, RetexError *err)
{
    const RetexSet *set = polynomial->set;
    const size_t slots = (size_t)(retex_polynomial_slot_count(set) + polynomial->ngroups) + 1;
    *row = (RetexPolynomialRow){.polynomial = polynomial};
    int code = retex_row_reader_open(&row->reader, set, polynomial->samples, err);
    row->monomials = calloc((size_t)set->nterms + 1, sizeof *row->monomials);
    row->made = calloc(slots, sizeof *row->made);
    row->spans = calloc(slots, sizeof *row->spans);
    row->buffers = calloc(slots, sizeof *row->buffers);
    row->weights = malloc(sizeof *row->weights * 3 * (size_t)set->width);
    if (!code && (!row->monomials || !row->made || !row->spans || !row->buffers || !row->weights))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    if (code)
        retex_polynomial_row_close(row);
    return code;
}
