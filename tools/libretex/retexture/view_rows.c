/* See view_rows.h. What target maps of finishes need is in view_gates.c. */
#include "retexture/view_rows.h"

#include <stdlib.h>
#include <string.h>

#include <retex/host/assert.h>

#include "retexture/combine_kernel.h"
#include "retexture/enlarge.h"
#include "retexture/kept_samples.h"
#include "retexture/mixture_kernel.h"
#include "retexture/sample_row.h"
#include "set/set.h"
#include "texture/pyramid.h"

#define SPAN_PIXELS 512 /* the sum and one span of each image fit the first two levels of cache */

/* Clears what was filled of a row outside of the new span; values inside keep what they were. */
static void refill(RetexRowBuffer *buffer, RetexRowSpan span)
{
    const RetexRowSpan old = buffer->filled;
    RETEX_ASSERT(retex_span_is_empty(span) || span.begin >= 0);
    if (!retex_span_is_empty(old))
        memset(buffer->values + 3 * (size_t)old.begin, 0, 3 * (size_t)(old.end - old.begin) * sizeof *buffer->values);
    buffer->filled = span;
}

/* Expands a row of one channel to three, in place. */
static void gray_to_rgb(float *row, size_t width)
{
    for (size_t i = width; i-- > 0;)
        row[3 * i] = row[3 * i + 1] = row[3 * i + 2] = row[i];
}

/* ---- parts, and what is enlarged ---- */

int retex_view_make_part(RetexViewReader *reader, const RetexViewImage *image, RetexViewRow *own, int y,
                         RetexError *err)
{
    const int channels = reader->view->set->parts[image->index].image.channels;
    int code = retex_row_reader_get_span(reader->set, image->index, y, &own->row, &own->span, err);
    if (code || !own->row || channels == image->channels)
        return code;
    RETEX_ASSERT(channels == 1 && image->channels == 3);
    memcpy(own->buffer.values, own->row, sizeof *own->row * (size_t)image->width);
    gray_to_rgb(own->buffer.values, (size_t)image->width);
    own->row = own->buffer.values;
    return RETEX_OK;
}

int retex_view_make_enlarged(RetexViewReader *reader, const RetexViewImage *image, RetexViewRow *own, int y,
                             RetexError *err)
{
    const RetexViewImage *small = &reader->view->images[image->inputs[0]];
    (void)err;
    RETEX_ASSERT(small->is_made && small->scale % image->scale == 0);
    retex_enlarge_rows(&small->kept, small->scale / image->scale, image->width, y, y + 1, own->buffer.values);
    if (small->channels == 1)
        gray_to_rgb(own->buffer.values, (size_t)image->width);
    own->row = own->buffer.values;
    return RETEX_OK;
}

/* ---- footprints ---- */

/* The texture of a footprint with a finish, or with that which the target has. */
static const RetexTexture *texture_of(const RetexTexture *texture, int finish)
{
    RETEX_ASSERT(!texture || finish < 0 || (texture->finishes && finish < texture->finishes->count));
    return texture && finish >= 0 ? texture->finishes->colors[finish] : texture;
}

/* Filters the texture at a row of the footprint. */
static int filter_row(RetexViewReader *reader, const RetexViewImage *image, const RetexTexture *texture,
                      RetexViewRow *own, int y, RetexError *err)
{
    static const float clear[3 * RETEX_MAX_SIZE];
    const RetexView *view = reader->view;
    const RetexFootprint *f = &view->set->footprints[image->index];
    RetexFootprintRow from;
    int code = retex_footprint_row_read(&from, reader->set, view->set, f, y, !retex_texture_is_opaque(texture), err);
    if (image->scale == 1) /* a smaller one is made whole, once */
        from.span = retex_span_intersection(from.span, view->columns);
    if (code || !from.uv || retex_span_is_empty(from.span))
        return code;
    refill(&own->buffer, from.span);
    if (from.albedo && image->finish >= 0 && image->finish != view->shown[f->target])
        from.albedo = clear; /* what is clear has another finish */
    const RetexFootprintRow within = retex_footprint_row_cut(&from, from.span);
    retex_sample_row(texture, retex_footprint_filter(view->set, f), &within,
                     own->buffer.values + 3 * (size_t)from.span.begin);
    own->row = own->buffer.values;
    own->span = from.span;
    return RETEX_OK;
}

/* The same, or the row that is kept. */
static int filter_or_find_row(RetexViewReader *reader, const RetexViewImage *image, const RetexTexture *texture,
                              RetexViewRow *own, int y, RetexError *err)
{
    const RetexView *view = reader->view;
    RetexKeptSamples *kept = view->kept ? view->kept[view->set->footprints[image->index].target] : NULL;
    if (!kept || (image->finish >= 0 && !retex_texture_is_opaque(texture))) /* the finish shown decides what is clear */
        return filter_row(reader, image, texture, own, y, err);
    const RetexKeptRow *found = retex_kept_samples_find(kept, image->index, image->finish, y, view->columns);
    if (!found) {
        const int code = filter_row(reader, image, texture, own, y, err);
        if (!code)
            retex_kept_samples_add(kept, image->index, image->finish, y, view->columns,
                                   own->row ? own->span : (RetexRowSpan){0, 0}, own->row);
        return code;
    }
    if (retex_span_is_empty(found->span))
        return RETEX_OK;
    refill(&own->buffer, found->span);
    memcpy(own->buffer.values + 3 * (size_t)found->span.begin, found->colors,
           3 * (size_t)(found->span.end - found->span.begin) * sizeof *found->colors);
    own->row = own->buffer.values;
    own->span = found->span;
    return RETEX_OK;
}

int retex_view_make_footprint(RetexViewReader *reader, const RetexViewImage *image, RetexViewRow *own, int y,
                              RetexError *err)
{
    const RetexView *view = reader->view;
    const int footprint = image->index, finish = image->finish;
    const RetexFootprint *f = &view->set->footprints[footprint];
    const RetexTexture *texture = texture_of(view->textures ? view->textures[f->target] : NULL, finish);
    if (texture)
        return filter_or_find_row(reader, image, texture, own, y, err);
    const int part = !f->sampled ? f->albedo : finish < 0 ? f->sampled - 1 : f->finished[finish] - 1;
    if (part < 0)
        return retex_fail(err, RETEX_EFORMAT, "the samples lack footprint %d with finish %d", footprint, finish);
    return retex_row_reader_get_span(reader->set, part, y, &own->row, &own->span, err);
}

/* ---- mixtures, and further hits ---- */

/* 1 if every share has one weight a pixel, not one for each colour. */
static int has_single_weights(const RetexSet *set, const RetexMixture *m)
{
    int single = 1;
    for (int k = 0; k < m->nshares; k++)
        single = single && set->parts[m->shares[k].weight].image.channels == 1;
    return single;
}

/* Finds where the shares of a mixture have weights in a row, and in *all where any has. */
static int find_spans(RetexViewReader *reader, const RetexMixture *m, int y, RetexRowSpan spans[RETEX_SHARES_MAX],
                      RetexRowSpan *all, RetexError *err)
{
    int code = RETEX_OK;
    *all = (RetexRowSpan){0, 0};
    for (int k = 0; k < m->nshares && !code; k++) {
        const float *weight;
        code = retex_row_reader_get_span(reader->set, m->shares[k].weight, y, &weight, &spans[k], err);
        spans[k] = code || !weight ? (RetexRowSpan){0, 0} : spans[k];
        *all = retex_span_union(*all, spans[k]);
    }
    return code;
}

/* Adds a share to the row, and its weights to those of the row. */
static int add_share(RetexViewReader *reader, const RetexViewImage *image, int share, RetexRowSpan span, int is_single,
                     float *sum, int y, RetexError *err)
{
    const int part = reader->view->set->mixtures[image->index].shares[share].weight;
    const int channels = reader->view->set->parts[part].image.channels, count = span.end - span.begin;
    const size_t at = (size_t)span.begin;
    const float *weight, *factor;
    int code = retex_row_reader_get(reader->set, part, y, &weight, err);
    if (!code)
        code = retex_view_row(reader, image->inputs[share], y, &factor, NULL, err);
    if (code)
        return code;
    factor = factor ? factor + 3 * at : NULL;
    if (is_single)
        retex_mixture_add(sum + 3 * at, reader->weights + at, weight + at, factor, count);
    else
        retex_mixture_add_colors(sum + 3 * at, reader->weights + 3 * at, weight + (size_t)channels * at, channels,
                                 factor, count);
    return RETEX_OK;
}

int retex_view_make_mixture(RetexViewReader *reader, const RetexViewImage *image, RetexViewRow *own, int y,
                            RetexError *err)
{
    const RetexMixture *m = &reader->view->set->mixtures[image->index];
    const int is_single = has_single_weights(reader->view->set, m);
    RetexRowSpan spans[RETEX_SHARES_MAX], all;
    float *sum = own->buffer.values;
    int code = find_spans(reader, m, y, spans, &all, err);
    refill(&own->buffer, all);
    own->row = sum;
    own->span = all;
    if (code || retex_span_is_empty(all))
        return code;
    const size_t first = (size_t)all.begin, numbers = is_single ? 1 : 3;
    const int width = all.end - all.begin;
    memset(reader->weights + numbers * first, 0, sizeof *reader->weights * numbers * (size_t)width);
    for (int k = 0; k < m->nshares && !code; k++)
        if (!retex_span_is_empty(spans[k]))
            code = add_share(reader, image, k, spans[k], is_single, sum, y, err);
    if (code)
        return code;
    if (is_single)
        retex_mixture_divide(sum + 3 * first, reader->weights + first, width);
    else
        retex_mixture_divide_colors(sum + 3 * first, reader->weights + 3 * first, width);
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

int retex_view_make_further(RetexViewReader *reader, const RetexViewImage *image, RetexViewRow *own, int y,
                            RetexError *err)
{
    const RetexSet *set = reader->view->set;
    const float *q = set->further_ratio, *colors, *originals;
    const int n = set->further_hits;
    float *values = own->buffer.values;
    RetexRowSpan span;
    RETEX_ASSERT(n > 0);
    int code = retex_view_row(reader, image->inputs[0], y, &colors, NULL, err);
    if (!code)
        code = retex_view_row(reader, image->inputs[1], y, &originals, &span, err);
    if (code)
        return code;
    if (reader->view->images[image->inputs[1]].kind == VIEW_PART) /* of a mixture only where that has weights */
        span = (RetexRowSpan){0, image->width};
    refill(&own->buffer, span);
    for (int x = span.begin; x < span.end; x++)
        for (int c = 0; c < 3; c++) {
            const float color = colors ? colors[3 * x + c] : 0, original = originals ? originals[3 * x + c] : 0;
            values[3 * x + c] = series(q[c] * color, n) / series(q[c] * original, n);
        }
    own->row = values;
    own->span = span;
    return RETEX_OK;
}

/* ---- sums ---- */

/* The rows of a product's inputs; *black: one of them is 0 everywhere, or all are somewhere. */
static int find_inputs(RetexViewReader *reader, const RetexViewProduct *product, int y, RetexViewTerm *term, int *black,
                       RetexError *err)
{
    int code = RETEX_OK;
    *term = (RetexViewTerm){.product = product, .span = {0, reader->view->set->width}};
    *black = 0;
    for (int k = 0; k < product->ninputs && !code && !*black; k++) {
        RetexRowSpan span;
        code = retex_view_row(reader, product->inputs[k], y, &term->rows[k], &span, err);
        term->span = retex_span_intersection(term->span, span);
        *black = !code && (!term->rows[k] || retex_span_is_empty(term->span));
    }
    return code;
}

/* Finds the products of a row that are not black into own->terms. Returns their number, or a RetexCode. */
static int find_terms(RetexViewReader *reader, const RetexViewImage *image, RetexViewRow *own, int y, RetexError *err)
{
    int count = 0;
    RETEX_ASSERT(image->kind == VIEW_SUM);
    if (!own->terms && !(own->terms = malloc(sizeof *own->terms * (size_t)(image->nproducts + 1))))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    for (int i = 0; i < image->nproducts; i++) {
        int black;
        const int code = find_inputs(reader, &image->products[i], y, &own->terms[count], &black, err);
        if (code)
            return code;
        count += !black;
    }
    return count;
}

int retex_view_terms(RetexViewReader *reader, int image, int y, const RetexViewTerm **terms, int *count,
                     RetexError *err)
{
    RetexViewRow *own = &reader->rows[image];
    const int found = find_terms(reader, &reader->view->images[image], own, y, err);
    *terms = own->terms;
    *count = found < 0 ? 0 : found;
    return found < 0 ? found : RETEX_OK;
}

/* Adds a product to the row where it is within the span. */
static void add_product(const RetexViewTerm *term, RetexRowSpan span, float *sum)
{
    const RetexViewProduct *product = term->product;
    const size_t at = 3 * (size_t)span.begin, pixels = (size_t)(span.end - span.begin);
    const float *rows[VIEW_INPUTS_MAX + 1];
    float weights[3 * SPAN_PIXELS];
    for (int k = 0; k < product->ninputs; k++)
        rows[1 + k] = term->rows[k] + at;
    if (!retex_view_has_weight(product->weight)) {
        retex_combine_term_kernel(sum + at, rows[1], rows + 2, product->ninputs - 1, 3 * pixels);
        return;
    }
    if (product->ninputs == 1) {
        retex_combine_add_weighted(sum + at, rows[1], product->weight, pixels);
        return;
    }
    for (size_t i = 0; i < pixels; i++)
        memcpy(weights + 3 * i, product->weight, sizeof product->weight);
    retex_combine_term_kernel(sum + at, weights, rows + 1, product->ninputs, 3 * pixels);
}

int retex_view_make_sum(RetexViewReader *reader, const RetexViewImage *image, RetexViewRow *own, int y,
                        RetexError *err)
{
    const RetexRowSpan columns = image->scale == 1 ? reader->view->columns : (RetexRowSpan){0, image->width};
    float *sum = own->buffer.values;
    const int count = find_terms(reader, image, own, y, err);
    if (count <= 0)
        return count;
    memset(sum, 0, 3 * (size_t)image->width * sizeof *sum);
    for (int x = columns.begin; x < columns.end; x += SPAN_PIXELS) {
        const int end = columns.end - x < SPAN_PIXELS ? columns.end : x + SPAN_PIXELS;
        for (int i = 0; i < count; i++) {
            const RetexRowSpan span = retex_span_intersection(own->terms[i].span, (RetexRowSpan){x, end});
            if (!retex_span_is_empty(span))
                add_product(&own->terms[i], span, sum);
        }
    }
    own->row = sum;
    own->span = columns;
    return RETEX_OK;
}
