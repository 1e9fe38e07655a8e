/* See polynomial_factors.h. */
#include "polynomial_factors.h"

#include <string.h>

#include "mixture_kernel.h"
#include "sample_row.h"

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

const RetexImage *find_part(const RetexSet *set, int part, int least, int most)
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
    if (p->samples && retex_samples_have(p->samples, footprint))
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

/* ---- rows at a footprint's own size ---- */

int make_footprint_row(const Polynomial *p, RowReader *reader, int footprint, int y, float *scratch, const float **row,
                       RetexError *err)
{
    const RetexSet *set = p->set;
    const RetexFootprint *f = &set->footprints[footprint];
    const RetexTexture *texture = p->textures ? p->textures[f->target] : NULL;
    if (!texture && p->samples && retex_samples_have(p->samples, footprint))
        return row_reader_sample(reader, footprint, y, row, err);
    if (!texture)
        return row_reader_get(reader, f->albedo, y, row, err);
    FootprintRow from;
    int code = footprint_row_read(&from, reader, set, f, y, !retex_texture_is_opaque(texture), err);
    *row = NULL;
    if (code || !from.uv)
        return code;
    sample_row(texture, footprint_filter(set, f), &from, scratch);
    *row = scratch;
    return RETEX_OK;
}

/* 1 where every share has one weight a pixel, not one a colour. */
static int has_single_weights(const RetexSet *set, const RetexMixture *m)
{
    int single = 1;
    for (int k = 0; k < m->nshares; k++)
        single = single && set->parts[m->shares[k].weight].image.channels == 1;
    return single;
}

int make_mixture_row(const Polynomial *p, RowReader *reader, int mixture, int y, FactorRow *factor_row, void *context,
                     float *weights, float *sum, RetexError *err)
{
    const RetexMixture *m = &p->set->mixtures[mixture];
    const int width = p->set->parts[m->shares[0].weight].image.width, single = has_single_weights(p->set, m);
    memset(sum, 0, sizeof *sum * 3 * (size_t)width);
    memset(weights, 0, sizeof *weights * (single ? 1 : 3) * (size_t)width);
    for (int k = 0; k < m->nshares; k++) {
        const float *weight, *factor;
        int code = row_reader_get(reader, m->shares[k].weight, y, &weight, err);
        if (!code && weight)
            code = factor_row(context, m->shares[k].footprint, y, &factor, err);
        if (code)
            return code;
        if (weight && single)
            mixture_add(sum, weights, weight, factor, width);
        else if (weight)
            mixture_add_colors(sum, weights, weight, p->set->parts[m->shares[k].weight].image.channels, factor, width);
    }
    if (single)
        mixture_divide(sum, weights, width);
    else
        mixture_divide_colors(sum, weights, width);
    return RETEX_OK;
}
