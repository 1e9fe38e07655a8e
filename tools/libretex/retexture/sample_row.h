/* One row of a footprint's pixels, and a texture there. Private to libretex. */
#ifndef RETEX_RETEXTURE_SAMPLE_ROW_H
#define RETEX_RETEXTURE_SAMPLE_ROW_H

#include <retex/set.h>
#include <retex/texture.h>

#include "set/rows.h"

typedef struct RetexFootprintRow {
    const float *uv, *spread, *albedo; /* as the parts of RetexFootprint have them; albedo may be NULL where
                                          the texture is opaque */
    int spreads, width;                /* channels of spread; pixels */
    RetexRowSpan span;                      /* beside which there is no footprint */
} RetexFootprintRow;

/* How a footprint's distribution of UV is taken: what is seen sharply through a box pixel filter fills its ellipse
 * evenly, all else is a Gaussian. */
RetexTextureFilter retex_footprint_filter(const RetexSet *set, const RetexFootprint *footprint);

/* Row y of a footprint, of which uv is NULL where no pixel has it; with_albedo: 1 = that is wanted too. */
int retex_footprint_row_read(RetexFootprintRow *row, RetexRowReader *reader, const RetexSet *set,
                             const RetexFootprint *footprint, int y, int with_albedo, RetexError *err);

/* Some pixels of it. */
RetexFootprintRow retex_footprint_row_slice(const RetexFootprintRow *row, RetexRowSpan span);

/* The texture at each pixel's footprint, the original albedo showing through where it is transparent: rgb, interleaved;
 * black where there is no footprint. */
void retex_sample_row(const RetexTexture *texture, RetexTextureFilter filter, const RetexFootprintRow *row,
                      float *restrict rgb);

/* How far the texture's colours scatter within each footprint: E[a^2] - E[a]^2. */
void retex_variance_row(const RetexTexture *texture, const RetexTexture *square, RetexTextureFilter filter,
                        const RetexFootprintRow *row, float *restrict rgb);

#endif
