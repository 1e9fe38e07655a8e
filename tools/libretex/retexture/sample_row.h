/* The footprints of one row of pixels, and a texture filtered at them. Private to libretex. */
#ifndef RETEX_RETEXTURE_SAMPLE_ROW_H
#define RETEX_RETEXTURE_SAMPLE_ROW_H

#include <retex/set.h>
#include <retex/texture.h>

#include "set/rows.h"
#include "texture/filter.h"

typedef struct RetexFootprintRow {
    const float *uv, *spread, *albedo; /* as the parts of RetexFootprint have them; albedo may be NULL where
                                          the texture is opaque */
    int spreads, width;                /* channels of spread; pixels */
    RetexRowSpan span;                      /* outside of which there is no footprint */
} RetexFootprintRow;

/* The filter for a footprint: a footprint that is seen sharply through a box pixel filter is averaged evenly over its
 * ellipse, any other over a Gaussian, which of light that was scattered before is not a thin one. */
RetexTextureFilter retex_footprint_filter(const RetexSet *set, const RetexFootprint *footprint);

/* Read row y of a footprint; uv is NULL where no pixel of the row has it. with_albedo: 1 = also read the original
 * albedo. */
int retex_footprint_row_read(RetexFootprintRow *row, RetexRowReader *reader, const RetexSet *set,
                             const RetexFootprint *footprint, int y, int with_albedo, RetexError *err);

/* A part of the row. */
RetexFootprintRow retex_footprint_row_cut(const RetexFootprintRow *row, RetexRowSpan span);

/* Filter the texture at each pixel's footprint; the original albedo shows where the texture is transparent. rgb is
 * interleaved; black where there is no footprint. */
void retex_sample_row(const RetexTexture *texture, RetexTextureFilter filter, const RetexFootprintRow *row,
                      float *restrict rgb);

/* Compute the variance of the texture within each footprint: E[a^2] - E[a]^2. */
void retex_variance_row(const RetexTexture *texture, const RetexTexture *square, RetexTextureFilter filter,
                        const RetexFootprintRow *row, float *restrict rgb);

#endif
