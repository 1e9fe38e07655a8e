/* See polynomial_factors.h. */
#include "retexture/polynomial_factors.h"

#include <string.h>
#include <retex/host/assert.h>

#include "retexture/kept_samples.h"
#include "retexture/mixture_kernel.h"
#include "retexture/sample_row.h"
#include "set/samples.h"
#include "set/set.h"
#include "texture/pyramid.h"

/* ---- what a factor is made of ---- */

int retex_polynomial_has_term(const RetexPolynomial *p, const RetexTerm *term, const float weight[3])
{
    if (p->picture || term->role == RETEX_ROLE_PICTURE || (term->role == RETEX_ROLE_CROSS2 && p->cross < 2) ||
        (term->role == RETEX_ROLE_CROSS3 && p->cross < 3) ||
        (term->role == RETEX_ROLE_LAMP_PICTURE) != p->lamp_pictures)
        return 0;
    return weight[0] != 0 || weight[1] != 0 || weight[2] != 0;
}

/* Whether a factor is one that has a row, with an index of the list of its kind. */
static int has_slot(const RetexSet *set, RetexFactor factor)
{
    const int finish = retex_quantity_finish(factor.quantity);
    const int count = factor.kind == RETEX_FACTOR_FOOTPRINT ? set->nfootprints
                      : factor.kind == RETEX_FACTOR_MIXTURE ? set->nmixtures
                      : factor.kind == RETEX_FACTOR_IMAGE   ? set->nparts
                      : factor.kind == POLYNOMIAL_GATE      ? set->ntargets
                                                            : 0; /* of parameters, which are numbers */
    return factor.index >= 0 && factor.index < count && finish < RETEX_FINISHES_MAX &&
           (factor.kind != RETEX_FACTOR_IMAGE || factor.quantity == RETEX_QUANTITY_COLOR) &&
           (factor.kind != POLYNOMIAL_GATE || finish >= 0);
}

/* Slots of textures, footprints before mixtures, come in a block for each quantity; behind the first block are parts,
 * behind the last one gates. With 3 footprints, 1 mixture and 5 parts:
 *     0..3 colours, 4..8 parts, 9..12 FURTHER, 13..16 of finish 0, and so on: mixture 0 of finish 0 is slot 16. */
_Static_assert(RETEX_QUANTITY_COLOR == 0 && RETEX_QUANTITIES == 2, "the first block is of colours, finishes follow");

static int textures_of(const RetexSet *set)
{
    return set->nfootprints + set->nmixtures;
}

static int first_gate(const RetexSet *set)
{
    return (RETEX_QUANTITIES + RETEX_FINISHES_MAX) * textures_of(set) + set->nparts;
}

int retex_polynomial_slot_count(const RetexSet *set)
{
    return first_gate(set) + RETEX_FINISHES_MAX * RETEX_MAX_TARGETS;
}

static RetexFactor with_quantity(RetexFactor factor, int quantity)
{
    factor.quantity = (RetexQuantity)quantity;
    return factor;
}

RetexFactor retex_polynomial_factor(const RetexSet *set, int slot)
{
    const int textures = textures_of(set), gate = slot - first_gate(set);
    RETEX_ASSERT(slot >= 0 && slot < retex_polynomial_slot_count(set));
    if (slot >= textures && slot < textures + set->nparts)
        return retex_factor(RETEX_FACTOR_IMAGE, slot - textures);
    if (gate >= 0)
        return with_quantity(retex_factor(POLYNOMIAL_GATE, gate / RETEX_FINISHES_MAX),
                             POLYNOMIAL_FINISHED(gate % RETEX_FINISHES_MAX));
    const int number = slot < textures ? slot : slot - set->nparts; /* among textures of all quantities */
    const int texture = number % textures;
    const RetexFactor factor = texture < set->nfootprints
                                   ? retex_factor(RETEX_FACTOR_FOOTPRINT, texture)
                                   : retex_factor(RETEX_FACTOR_MIXTURE, texture - set->nfootprints);
    return with_quantity(factor, number / textures);
}

static int find_slot(const RetexSet *set, RetexFactor factor)
{
    if (factor.kind == RETEX_FACTOR_IMAGE)
        return textures_of(set) + factor.index;
    if (factor.kind == POLYNOMIAL_GATE)
        return first_gate(set) + factor.index * RETEX_FINISHES_MAX + retex_quantity_finish(factor.quantity);
    const int texture = factor.kind == RETEX_FACTOR_MIXTURE ? set->nfootprints + factor.index : factor.index;
    const int parts_before = factor.quantity == RETEX_QUANTITY_COLOR ? 0 : set->nparts;
    return (int)factor.quantity * textures_of(set) + parts_before + texture;
}

/* Whether the way back leads to the same factor. */
static int is_slot_of(const RetexSet *set, int slot, RetexFactor factor)
{
    const RetexFactor back = retex_polynomial_factor(set, slot);
    return back.kind == factor.kind && back.quantity == factor.quantity && back.index == factor.index;
}

int retex_polynomial_slot(const RetexSet *set, RetexFactor factor)
{
    RETEX_ASSERT(has_slot(set, factor));
    const int slot = find_slot(set, factor);
    RETEX_ASSERT(is_slot_of(set, slot, factor));
    return slot;
}

/* Whether the textures of a factor of quantity FURTHER are all original: then it is 1. */
int retex_polynomial_is_one(const RetexPolynomial *p, RetexFactor factor)
{
    int edited = 0;
    if (factor.quantity != RETEX_QUANTITY_FURTHER)
        return 0;
    if (factor.kind == RETEX_FACTOR_FOOTPRINT)
        return !p->edited[p->set->footprints[factor.index].target];
    const RetexMixture *mixture = &p->set->mixtures[factor.index];
    for (int k = 0; k < mixture->nshares; k++)
        edited |= p->edited[p->set->footprints[mixture->shares[k].footprint].target];
    return !edited;
}

const RetexImage *retex_polynomial_part_image(const RetexSet *set, int part, int least, int most)
{
    if (part < 0 || part >= set->nparts)
        return NULL;
    const RetexImage *im = &set->parts[part].image;
    return im->channels >= least && im->channels <= most ? im : NULL;
}

/* The image that has the size of a footprint's samples: UV, the samples themselves, or the original albedo. NULL where
 * the footprint is absent. */
static const RetexImage *footprint_shape(const RetexPolynomial *p, int footprint)
{
    const RetexSet *set = p->set;
    if (footprint < 0 || footprint >= set->nfootprints)
        return NULL;
    const RetexFootprint *f = &set->footprints[footprint];
    if (p->textures && p->textures[f->target])
        return retex_polynomial_part_image(set, f->uv, 3, 3);
    if (p->samples && retex_samples_have(p->samples, footprint))
        return &p->samples->images[footprint];
    return retex_polynomial_part_image(set, f->albedo, 3, 3);
}

static const RetexImage *mixture_shape(const RetexPolynomial *p, int mixture)
{
    const RetexImage *shape = NULL;
    if (mixture >= p->set->nmixtures)
        return NULL;
    const RetexMixture *m = &p->set->mixtures[mixture];
    for (int k = 0; k < m->nshares; k++) {
        const RetexImage *image = footprint_shape(p, m->shares[k].footprint);
        const RetexImage *weight = retex_polynomial_part_image(p->set, m->shares[k].weight, 1, 3);
        if (!image || !weight || weight->channels == 2 || weight->width != image->width ||
            weight->height != image->height ||
            (shape && (shape->width != image->width || shape->height != image->height)))
            return NULL;
        shape = image;
    }
    return shape;
}

const RetexImage *retex_polynomial_factor_image(const RetexPolynomial *p, RetexFactor factor)
{
    if (factor.kind == RETEX_FACTOR_FOOTPRINT)
        return footprint_shape(p, factor.index);
    if (factor.kind == RETEX_FACTOR_MIXTURE)
        return mixture_shape(p, factor.index);
    const RetexImage *image = retex_polynomial_part_image(p->set, factor.index, 1, 3);
    return image && image->channels != 2 ? image : NULL;
}

/* ---- rows at a footprint's own size ---- */

/* Clears the filled span of a buffer outside of the new span; values inside keep what they were. */
static void refill(RetexRowBuffer *buffer, RetexRowSpan span)
{
    const RetexRowSpan old = buffer->filled;
    RETEX_ASSERT(retex_span_is_empty(span) || span.begin >= 0);
    if (!retex_span_is_empty(old))
        memset(buffer->values + 3 * (size_t)old.begin, 0, 3 * (size_t)(old.end - old.begin) * sizeof *buffer->values);
    buffer->filled = span;
}

/* The texture of a footprint with a finish, or with that which the target has. */
static const RetexTexture *texture_of(const RetexTexture *texture, int finish)
{
    RETEX_ASSERT(!texture || finish < 0 || (texture->finishes && finish < texture->finishes->count));
    return texture && finish >= 0 ? texture->finishes->colors[finish] : texture;
}

/* Filters the texture at a row of the footprint. */
static int filter_row(const RetexPolynomial *p, RetexRowReader *reader, RetexFactor factor, const RetexTexture *texture,
                      int y, RetexRowBuffer *buffer, const float **row, RetexRowSpan *span, RetexError *err)
{
    static const float clear[3 * RETEX_MAX_SIZE];
    const RetexSet *set = p->set;
    const RetexFootprint *f = &set->footprints[factor.index];
    const int finish = retex_quantity_finish(factor.quantity);
    RetexFootprintRow from;
    int code = retex_footprint_row_read(&from, reader, set, f, y, !retex_texture_is_opaque(texture), err);
    *row = NULL;
    if (from.width == set->width) /* a reduced one is made whole, once */
        from.span = retex_span_intersection(from.span, p->columns);
    if (code || !from.uv || retex_span_is_empty(from.span))
        return code;
    refill(buffer, from.span);
    if (from.albedo && finish >= 0 && finish != p->shown[f->target]) /* what is clear has another finish */
        from.albedo = clear;
    const RetexFootprintRow within = retex_footprint_row_cut(&from, from.span);
    retex_sample_row(texture, retex_footprint_filter(set, f), &within, buffer->values + 3 * (size_t)from.span.begin);
    *row = buffer->values;
    *span = from.span;
    return RETEX_OK;
}

/* The same, or the row that is kept. */
static int filter_or_find_row(const RetexPolynomial *p, RetexRowReader *reader, RetexFactor factor,
                              const RetexTexture *texture, int y, RetexRowBuffer *buffer, const float **row,
                              RetexRowSpan *span, RetexError *err)
{
    const int finish = retex_quantity_finish(factor.quantity);
    RetexKeptSamples *kept = p->kept ? p->kept[p->set->footprints[factor.index].target] : NULL;
    if (!kept || (finish >= 0 && !retex_texture_is_opaque(texture))) /* what is clear depends on the finish shown */
        return filter_row(p, reader, factor, texture, y, buffer, row, span, err);
    const RetexKeptRow *found = retex_kept_samples_find(kept, factor.index, finish, y, p->columns);
    if (!found) {
        const int code = filter_row(p, reader, factor, texture, y, buffer, row, span, err);
        if (!code)
            retex_kept_samples_add(kept, factor.index, finish, y, p->columns, *row ? *span : (RetexRowSpan){0, 0},
                                   *row);
        return code;
    }
    *row = NULL;
    if (retex_span_is_empty(found->span))
        return RETEX_OK;
    refill(buffer, found->span);
    memcpy(buffer->values + 3 * (size_t)found->span.begin, found->colors,
           3 * (size_t)(found->span.end - found->span.begin) * sizeof *found->colors);
    *row = buffer->values;
    *span = found->span;
    return RETEX_OK;
}

int retex_polynomial_footprint_row(const RetexPolynomial *p, RetexRowReader *reader, RetexFactor factor, int y,
                                   RetexRowBuffer *buffer, const float **row, RetexRowSpan *span, RetexError *err)
{
    const RetexFootprint *f = &p->set->footprints[factor.index];
    const int finish = retex_quantity_finish(factor.quantity);
    const RetexTexture *texture = texture_of(p->textures ? p->textures[f->target] : NULL, finish);
    if (!texture && p->samples && retex_samples_have(p->samples, factor.index)) {
        const int sample = finish < 0 ? factor.index
                                      : retex_samples_find(p->samples, f->target, factor.index, finish);
        if (sample < 0)
            return retex_fail(err, RETEX_EFORMAT, "the samples lack footprint %d with finish %d", factor.index,
                              finish);
        *span = (RetexRowSpan){0, p->samples->images[factor.index].width};
        return retex_row_reader_sample(reader, sample, y, row, err);
    }
    return texture ? filter_or_find_row(p, reader, factor, texture, y, buffer, row, span, err)
                   : retex_row_reader_get_span(reader, f->albedo, y, row, span, err);
}

/* 1 if every share has one weight a pixel, not one for each colour. */
static int has_single_weights(const RetexSet *set, const RetexMixture *m)
{
    int single = 1;
    for (int k = 0; k < m->nshares; k++)
        single = single && set->parts[m->shares[k].weight].image.channels == 1;
    return single;
}

int retex_polynomial_mixture_row(const RetexPolynomial *p, RetexRowReader *reader, RetexFactor mixture, int y,
                                 RetexFactorRow *factor_row, void *context, float *weights, RetexRowBuffer *sum,
                                 RetexError *err)
{
    RETEX_ASSERT(mixture.kind == RETEX_FACTOR_MIXTURE && mixture.index < p->set->nmixtures);
    const RetexMixture *m = &p->set->mixtures[mixture.index];
    RetexFactor footprint = {RETEX_FACTOR_FOOTPRINT, mixture.quantity, 0};
    const int single = has_single_weights(p->set, m), numbers = single ? 1 : 3;
    const float *weight, *factor;
    RetexRowSpan spans[RETEX_SHARES_MAX], all = {0, 0};
    int code = RETEX_OK;
    for (int k = 0; k < m->nshares && !code; k++) {
        code = retex_row_reader_get_span(reader, m->shares[k].weight, y, &weight, &spans[k], err);
        spans[k] = code || !weight ? (RetexRowSpan){0, 0} : spans[k];
        all = retex_span_union(all, spans[k]);
    }
    refill(sum, all);
    if (code || retex_span_is_empty(all))
        return code;
    const size_t first = (size_t)all.begin;
    memset(weights + (size_t)numbers * first, 0, sizeof *weights * (size_t)(numbers * (all.end - all.begin)));
    for (int k = 0; k < m->nshares; k++) {
        if (retex_span_is_empty(spans[k]))
            continue;
        code = retex_row_reader_get(reader, m->shares[k].weight, y, &weight, err);
        footprint.index = m->shares[k].footprint;
        if (!code)
            code = factor_row(context, footprint, y, &factor, err);
        if (code)
            return code;
        const int channels = p->set->parts[m->shares[k].weight].image.channels;
        const size_t at = (size_t)spans[k].begin;
        const int count = spans[k].end - spans[k].begin;
        factor = factor ? factor + 3 * at : NULL;
        if (single)
            retex_mixture_add(sum->values + 3 * at, weights + at, weight + at, factor, count);
        else
            retex_mixture_add_colors(sum->values + 3 * at, weights + 3 * at, weight + (size_t)channels * at, channels,
                                     factor, count);
    }
    if (single)
        retex_mixture_divide(sum->values + 3 * first, weights + first, all.end - all.begin);
    else
        retex_mixture_divide_colors(sum->values + 3 * first, weights + 3 * first, all.end - all.begin);
    return RETEX_OK;
}

/* ---- further hits ---- */

typedef struct Originals {
    const RetexSet *set;
    RetexRowReader *reader;
} Originals;

static int original_row(void *context, RetexFactor footprint, int y, const float **row, RetexError *err)
{
    const Originals *of = context;
    const int albedo = of->set->footprints[footprint.index].albedo;
    if (albedo < 0)
        return retex_fail(err, RETEX_EFORMAT, "footprint %d of the set lacks its original albedo", footprint.index);
    return retex_row_reader_get(of->reader, albedo, y, row, err);
}

static int copy_original_row(Originals *of, int footprint, int y, RetexRowBuffer *values, RetexError *err)
{
    const float *row;
    const int code = original_row(of, retex_factor(RETEX_FACTOR_FOOTPRINT, footprint), y, &row, err);
    if (code)
        return code;
    const int width = of->set->parts[of->set->footprints[footprint].albedo].image.width;
    refill(values, (RetexRowSpan){0, width});
    if (row)
        memcpy(values->values, row, 3 * (size_t)width * sizeof *row);
    return RETEX_OK;
}

/* 1 + x + ... + x^n. */
static float series(float x, int n)
{
    float sum = 1;
    for (int k = 0; k < n; k++)
        sum = sum * x + 1;
    return sum;
}

int retex_polynomial_further_row(const RetexPolynomial *p, RetexRowReader *reader, RetexFactor factor, int y,
                                 const float *colors, float *weights, RetexRowBuffer *values, RetexError *err)
{
    const float *q = p->set->further_ratio;
    const int n = p->set->further_hits;
    Originals of = {p->set, reader};
    RETEX_ASSERT(factor.quantity == RETEX_QUANTITY_FURTHER && n > 0);
    int code = factor.kind == RETEX_FACTOR_FOOTPRINT
                   ? copy_original_row(&of, factor.index, y, values, err)
                   : retex_polynomial_mixture_row(p, reader, factor, y, original_row, &of, weights, values, err);
    for (int x = values->filled.begin; x < values->filled.end && !code; x++)
        for (int c = 0; c < 3; c++) {
            float *value = &values->values[3 * x + c];
            *value = series(colors ? q[c] * colors[3 * x + c] : 0, n) / series(q[c] * *value, n);
        }
    return code;
}

void retex_row_gray_to_rgb(float *row, size_t width)
{
    for (size_t i = width; i-- > 0;)
        row[3 * i] = row[3 * i + 1] = row[3 * i + 2] = row[i];
}
