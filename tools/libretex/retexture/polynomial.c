/* See polynomial.h. */
#include "retexture/polynomial.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <retex/host/assert.h>

#include "retexture/combine_kernel.h"
#include "retexture/enlarge.h"
#include "retexture/kept_samples.h"
#include "retexture/polynomial_factors.h"
#include "retexture/polynomial_finishes.h"
#include "retexture/polynomial_groups.h"
#include "retexture/polynomial_reduced.h"
#include "set/set.h"

#define MISSING 1 /* the code where the set lacks a part that a term needs */

#define ALL_CROSS_TERMS 3

int retex_polynomial_common(const RetexPolynomial *p, float common[3], int least[3])
{
    const RetexSet *set = p->set;
    int apart = p->lamp_pictures;
    for (int t = 0; t < set->ntargets; t++)
        apart |= p->mapped[t];
    for (int c = 0; c < 3; c++) {
        common[c] = apart ? 0 : FLT_MAX;
        least[c] = -1;
        for (int i = 0; i < set->nparameters && !apart; i++) {
            const float kept = set->parameters[i].kept[c], value = p->parameters[i][c];
            if (set->parameters[i].kind == RETEX_PARAMETER_COLOR && kept > 0 && value / kept < common[c])
                common[c] = value / kept, least[c] = i;
        }
        common[c] = !apart && least[c] < 0 ? 1 : common[c];
    }
    return apart;
}

float retex_polynomial_beyond(float value, float kept, float common)
{
    return kept > 0 && value / kept <= common ? 0 : fmaxf(value - common * kept, 0);
}

/* Takes from the lamps what all have in common, which comes with all light. */
static void share_light(RetexPolynomial *p)
{
    int least[3];
    if (!p->lamps || p->apart == POLYNOMIAL_LAMPS_APART)
        return;
    retex_polynomial_common(p, p->common, least);
    for (int i = 0; i < p->set->nparameters; i++)
        for (int c = 0; c < 3 && p->set->parameters[i].kind == RETEX_PARAMETER_COLOR; c++)
            p->parameters[i][c] =
                retex_polynomial_beyond(p->parameters[i][c], p->set->parameters[i].kept[c], p->common[c]);
}

/* Finds the targets that have a texture or samples. Returns their number. */
static int find_edited_targets(RetexPolynomial *p)
{
    const RetexSet *set = p->set;
    int count = 0;
    for (int f = 0; f < set->nfootprints; f++) {
        const int t = set->footprints[f].target;
        p->edited[t] |= (p->textures && p->textures[t]) || (p->samples && retex_samples_have(p->samples, f));
    }
    for (int t = 0; t < set->ntargets; t++)
        count += p->edited[t];
    return count;
}

/* Sets the values of parameters: those that are given, and the weight of corrections of edited targets, of which there
 * are so many. Returns 1 if any is not as rendered, corrections left out. */
static int set_parameters(RetexPolynomial *p, const float *given, int is_corrected, int nedited)
{
    const RetexSet *set = p->set;
    int is_changed = 0;
    for (int i = 0; i < set->nparameters; i++) {
        const RetexParameter *parameter = &set->parameters[i];
        const float *value = given ? given + 3 * i : parameter->value;
        if (parameter->kind == RETEX_PARAMETER_CORRECTION) {
            const int counts = is_corrected && p->edited[parameter->target];
            const float weight = counts ? (float)retex_correction_weight(set->ntargets, nedited) : 0;
            p->parameters[i][0] = p->parameters[i][1] = p->parameters[i][2] = weight;
            continue;
        }
        for (int c = 0; c < 3; c++) {
            p->parameters[i][c] = value[c];
            is_changed |= value[c] != parameter->value[c];
        }
    }
    return is_changed;
}

/* Finds what is edited, and what stands for the sum of terms then. Corrections, and the picture of part 0, are those of
 * all cross terms. */
static void find_edited(RetexPolynomial *p, const RetexCombineParams *params)
{
    const RetexSet *set = p->set;
    const int nedited = find_edited_targets(p);
    const int is_corrected = p->apart != POLYNOMIAL_APART && p->cross == ALL_CROSS_TERMS;
    const int is_changed = set_parameters(p, params->parameters, is_corrected, nedited);
    const int is_original = !params->terms_only && is_corrected && nedited == 0;
    const int is_plain_picture = set->nterms == 0 && set->nparts > 0 && set->parts[0].image.channels == 3;
    p->lamps = retex_set_has_role(set, RETEX_ROLE_LAMP);
    p->picture = is_plain_picture || (set->nterms && is_original && !is_changed &&
                                      retex_set_has_role(set, RETEX_ROLE_PICTURE));
    p->lamp_pictures = is_original && is_changed && retex_set_has_role(set, RETEX_ROLE_LAMP_PICTURE);
}

/* ---- opening ---- */

static int has_cross_terms(const RetexSet *set)
{
    for (int t = 0; t < set->nterms; t++)
        if (set->terms[t].role == RETEX_ROLE_CROSS2 || set->terms[t].role == RETEX_ROLE_CROSS3)
            return 1;
    return 0;
}

/* Allocates the image of a factor that is reduced, to be filled in later. An image of that scale is read row by row,
 * when it is needed. */
static int open_factor(RetexPolynomial *p, RetexFactor factor, int scale, RetexError *err)
{
    if (factor.kind == POLYNOMIAL_GATE || retex_polynomial_is_one(p, factor))
        return RETEX_OK;
    const RetexImage *shape = retex_polynomial_factor_image(p, factor);
    const int own = shape ? retex_set_scale(p->set, shape) : 0;
    if (!own && factor.kind == RETEX_FACTOR_MIXTURE && factor.index < p->set->nmixtures)
        return retex_fail(err, RETEX_EFORMAT, "a mixture of the set lacks a footprint or its weight");
    if (!own)
        return MISSING;
    RetexImage *image = &p->reduced[retex_polynomial_slot(p->set, factor)];
    if (image->pixels || own == 1 || (factor.kind == RETEX_FACTOR_IMAGE && own == scale))
        return RETEX_OK;
    return retex_image_alloc(image, shape->width, shape->height,
                             factor.kind == RETEX_FACTOR_IMAGE ? shape->channels : 3, err);
}

static int lacks_parts(int number, RetexError *err)
{
    return retex_fail(err, RETEX_EFORMAT, "term %d of the set lacks its radiance or one of its footprints", number);
}

static int open_term(RetexPolynomial *p, int number, RetexError *err)
{
    RetexPolynomialTerm *term = &p->terms[number];
    if (p->set->terms[number].nfactors < 0 || p->set->terms[number].nfactors > RETEX_MAX_FACTORS)
        return lacks_parts(number, err);
    retex_polynomial_factor_finishes(p, &p->set->terms[number], term);
    term->radiance = -1;
    if (!retex_polynomial_has_term(p, &p->set->terms[number], term->weight))
        return RETEX_OK;
    term->radiance = p->set->terms[number].radiance;
    const RetexImage *radiance = retex_polynomial_part_image(p->set, p->set->terms[number].radiance, 3, 3);
    const int sound = radiance && retex_set_scale(p->set, radiance) == 1;
    int code = sound ? RETEX_OK : MISSING;
    const int scale = sound && !p->apart ? retex_polynomial_group_scale(p, term) : 1;
    for (int k = 0; k < term->nfactors && !code; k++)
        code = open_factor(p, term->factors[k], scale, err);
    if (code == MISSING)
        code = lacks_parts(number, err);
    return code;
}

void retex_polynomial_close(RetexPolynomial *p)
{
    if (!p->set)
        return;
    for (int i = 0; p->reduced && i < retex_polynomial_slot_count(p->set); i++)
        retex_image_free(&p->reduced[i]);
    free(p->reduced);
    free(p->terms);
    retex_polynomial_gates_close(p);
    retex_polynomial_groups_close(p);
    *p = (RetexPolynomial){0};
}

int retex_polynomial_open(RetexPolynomial *p, const RetexSet *set, const RetexSamples *samples,
                          RetexTexture *const *textures, const RetexCombineParams *params, RetexPolynomialTerms apart,
                          int nthreads, RetexError *err)
{
    static const RetexCombineParams defaults = RETEX_COMBINE_INIT;
    const RetexCombineParams given = params ? *params : defaults;
    *p = (RetexPolynomial){.set = set, .samples = samples, .textures = textures, .apart = apart, .cross = given.cross,
                           .kept = given.kept, .common = {1, 1, 1}};
    p->columns = (RetexRowSpan){0, set->width};
    if (p->cross != 0 && p->cross != 2 && p->cross != 3)
        return retex_fail(err, RETEX_EINVAL, "cross terms go up to 0, 2 or 3 hits, not %d", p->cross);
    for (int i = 0; given.parameters && i < 3 * set->nparameters; i++)
        if (!(given.parameters[i] >= 0 && given.parameters[i] <= FLT_MAX))
            return retex_fail(err, RETEX_EINVAL, "parameter %s is %g", set->parameters[i / 3].name,
                              (double)given.parameters[i]);
    if (!has_cross_terms(set))
        p->cross = ALL_CROSS_TERMS;
    int code = samples ? retex_samples_check(samples, set, err) : RETEX_OK;
    for (int t = 0; p->kept && t < set->ntargets && !code; t++)
        code = p->kept[t] ? retex_kept_samples_check(p->kept[t], set, t, err) : RETEX_OK;
    if (code)
        return code;
    find_edited(p, &given);
    code = retex_polynomial_find_maps(p, err);
    share_light(p);
    p->reduced = calloc((size_t)retex_polynomial_slot_count(set) + 1, sizeof *p->reduced);
    p->terms = calloc((size_t)set->nterms + 1, sizeof *p->terms);
    if (!code && (!p->reduced || !p->terms))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", set->nterms);
    for (int i = 0; i < set->nterms && !code; i++)
        code = open_term(p, i, err);
    if (!code)
        code = retex_polynomial_reduced_make(p, nthreads, err);
    if (!code)
        code = retex_polynomial_gates_open(p, nthreads, err);
    if (!code)
        code = retex_polynomial_groups_open(p, nthreads, err);
    if (code)
        retex_polynomial_close(p);
    return code;
}

/* ---- a row ---- */

static const float black_row[1]; /* marks a row that is 0 everywhere */

static float *buffer_values(RetexPolynomialRow *row, int slot, RetexError *err)
{
    RETEX_ASSERT(slot < retex_polynomial_slot_count(row->polynomial->set) + row->polynomial->ngroups);
    RetexRowBuffer *buffer = &row->buffers[slot];
    if (!buffer->values && !(buffer->values = calloc(3 * (size_t)row->polynomial->set->width, sizeof *buffer->values)))
        retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    return buffer->values;
}

static int footprint_row(void *context, RetexFactor footprint, int y, const float **made, RetexError *err);
static int factor_row(RetexPolynomialRow *row, RetexFactor factor, int y, const float **made, RetexError *err);

/* A copy of an image's row, with three channels; or NULL. */
static int image_row(RetexPolynomialRow *row, int part, int y, float *values, const float **made, RetexError *err)
{
    const int channels = row->polynomial->set->parts[part].image.channels;
    const size_t width = (size_t)row->polynomial->set->width;
    int code = retex_row_reader_get(row->reader, part, y, made, err);
    if (code || !*made || channels == 3)
        return code;
    memcpy(values, *made, sizeof *values * width);
    retex_row_gray_to_rgb(values, width);
    *made = values;
    return RETEX_OK;
}

/* Makes the gates of all finishes of a target. */
static int make_gates(RetexPolynomialRow *row, int target, int y, RetexError *err)
{
    const RetexPolynomial *p = row->polynomial;
    float *rows[RETEX_FINISHES_MAX];
    RetexFactor gate = retex_factor(POLYNOMIAL_GATE, target);
    for (int k = 0; k < p->mapped[target]; k++) {
        gate.quantity = POLYNOMIAL_FINISHED(k);
        const int slot = retex_polynomial_slot(p->set, gate);
        if (!(rows[k] = buffer_values(row, slot, err)))
            return RETEX_ENOMEM;
        row->made[slot] = rows[k];
        row->spans[slot] = (RetexRowSpan){0, p->set->width};
    }
    return retex_polynomial_gate_rows(p, row->reader, target, y, row->weights, rows, err);
}

static int make_slot(RetexPolynomialRow *row, RetexFactor factor, int slot, int y, RetexError *err)
{
    const RetexPolynomial *p = row->polynomial;
    const RetexImage *small = &p->reduced[slot];
    const int width = p->set->width;
    float *values = buffer_values(row, slot, err);
    int code = RETEX_OK;
    if (!values)
        return RETEX_ENOMEM;
    if (factor.kind == POLYNOMIAL_GATE)
        return make_gates(row, factor.index, y, err);
    /* what is smaller than the picture has been made when the polynomial was opened */
    RETEX_ASSERT(small->pixels || retex_polynomial_factor_image(p, factor)->width == width);
    row->made[slot] = values;
    row->spans[slot] = (RetexRowSpan){0, width};
    if (small->pixels) {
        retex_enlarge_rows(small, retex_set_scale(p->set, small), width, y, y + 1, values);
        if (small->channels == 1)
            retex_row_gray_to_rgb(values, (size_t)width);
    } else if (factor.kind == RETEX_FACTOR_IMAGE) {
        code = image_row(row, factor.index, y, values, &row->made[slot], err);
    } else if (factor.quantity == RETEX_QUANTITY_FURTHER) {
        const float *colors;
        code = factor_row(row, retex_factor(factor.kind, factor.index), y, &colors, err);
        if (!code)
            code =
                retex_polynomial_further_row(p, row->reader, factor, y, colors, row->weights, &row->buffers[slot], err);
        row->spans[slot] = row->buffers[slot].filled;
    } else if (factor.kind == RETEX_FACTOR_MIXTURE) {
        code = retex_polynomial_mixture_row(p, row->reader, factor, y, footprint_row, row, row->weights,
                                            &row->buffers[slot], err);
        row->spans[slot] = row->buffers[slot].filled;
    } else {
        code = retex_polynomial_footprint_row(p, row->reader, factor, y, &row->buffers[slot], &row->made[slot],
                                              &row->spans[slot], err);
    }
    if (!code && (!row->made[slot] || retex_span_is_empty(row->spans[slot])))
        row->made[slot] = black_row;
    RETEX_ASSERT(code || row->made[slot] == black_row ||
                 retex_span_holds(row->spans[slot], row->made[slot], width, 3));
    return code;
}

static int factor_row(RetexPolynomialRow *row, RetexFactor factor, int y, const float **made, RetexError *err)
{
    const int slot = retex_polynomial_slot(row->polynomial->set, factor);
    int code = row->made[slot] ? RETEX_OK : make_slot(row, factor, slot, y, err);
    *made = row->made[slot] == black_row ? NULL : row->made[slot];
    return code;
}

static int footprint_row(void *context, RetexFactor footprint, int y, const float **made, RetexError *err)
{
    return factor_row(context, footprint, y, made, err);
}

/* Makes the rows of all factors of the picture's size; *black: one of them is 0 everywhere in the row. */
static int factor_rows(RetexPolynomialRow *row, RetexMonomial *m, const struct RetexPolynomialGroup *group, int y,
                       int *black, RetexError *err)
{
    int code = RETEX_OK;
    m->nfactors = group->nfactors;
    m->span = (RetexRowSpan){0, row->polynomial->set->width};
    for (int k = 0; k < group->nfactors && !code && !*black; k++) {
        const int slot = m->slots[k] = retex_polynomial_slot(row->polynomial->set, group->factors[k]);
        code = factor_row(row, group->factors[k], y, &m->factors[k], err);
        m->span = retex_span_intersection(m->span, row->spans[slot]);
        *black = !m->factors[k] || retex_span_is_empty(m->span);
    }
    return code;
}

/* The group's radiance: one part, or the sum of several with their weights. NULL: black. */
static int radiance_row(RetexPolynomialRow *row, const struct RetexPolynomialGroup *group, int slot, int y,
                        const float **made, RetexError *err)
{
    const size_t width = (size_t)row->polynomial->set->width;
    const float *from;
    if (!group->weighted)
        return retex_row_reader_get(row->reader, group->radiances[0].part, y, made, err);
    float *sum = buffer_values(row, slot, err);
    if (!sum)
        return RETEX_ENOMEM;
    memset(sum, 0, sizeof *sum * 3 * width);
    *made = NULL;
    for (int i = 0; i < group->nradiances; i++) {
        int code = retex_row_reader_get(row->reader, group->radiances[i].part, y, &from, err);
        if (code)
            return code;
        if (!from)
            continue;
        retex_combine_add_weighted(sum, from, group->radiances[i].weight, width);
        *made = sum;
    }
    return RETEX_OK;
}

static int make_group(RetexPolynomialRow *row, const struct RetexPolynomialGroup *group, int y, RetexError *err)
{
    const RetexPolynomial *p = row->polynomial;
    const int slot = retex_polynomial_slot_count(p->set) + (int)(group - p->groups);
    RETEX_ASSERT(group->nterms > 0 && row->count < p->set->nterms);
    RetexMonomial *m = &row->monomials[row->count];
    m->term = group->terms[0];
    int code = radiance_row(row, group, slot, y, &m->radiance, err), black = !m->radiance;
    if (!code)
        code = factor_rows(row, m, group, y, &black, err);
    if (group->scale && !code && !black) {
        float *values = buffer_values(row, slot, err);
        code = values ? RETEX_OK : RETEX_ENOMEM;
        if (values)
            retex_enlarge_rows(&group->product, group->scale, p->set->width, y, y + 1, values);
        m->factors[m->nfactors] = values;
        m->slots[m->nfactors++] = -1;
    }
    row->count += !code && !black;
    return code;
}

void retex_polynomial_row_begin(RetexPolynomialRow *row)
{
    memset(row->made, 0, sizeof *row->made * (size_t)retex_polynomial_slot_count(row->polynomial->set));
    row->count = 0;
}

int retex_polynomial_row_factor(RetexPolynomialRow *row, int slot, int y, const float **values, RetexError *err)
{
    return factor_row(row, retex_polynomial_factor(row->polynomial->set, slot), y, values, err);
}

int retex_polynomial_row_make(RetexPolynomialRow *row, int y, RetexError *err)
{
    const RetexPolynomial *p = row->polynomial;
    int code = RETEX_OK;
    RETEX_ASSERT(y >= 0 && y < p->set->height);
    retex_polynomial_row_begin(row);
    for (int g = 0; g < p->ngroups && !code; g++)
        code = make_group(row, &p->groups[g], y, err);
    return code;
}

void retex_polynomial_row_close(RetexPolynomialRow *row)
{
    if (!row->polynomial)
        return;
    const int slots = retex_polynomial_slot_count(row->polynomial->set) + row->polynomial->ngroups;
    for (int i = 0; row->buffers && i < slots; i++)
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
    row->weights = malloc(sizeof *row->weights * 8 * (size_t)set->width);
    if (!code && (!row->monomials || !row->made || !row->spans || !row->buffers || !row->weights))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    if (code)
        retex_polynomial_row_close(row);
    return code;
}
