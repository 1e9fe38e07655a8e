/* One row of a footprint's pixels, and a texture there. Private to libretex. */
#ifndef LIBRETEX_SAMPLE_ROW_H
#define LIBRETEX_SAMPLE_ROW_H

#include <retex/set.h>
#include <retex/texture.h>

typedef struct FootprintRow {
    const float *uv, *spread, *albedo; /* as the parts of RetexFootprint have them; interleaved */
    int spreads, width;                /* channels of spread; pixels */
} FootprintRow;

/* 1: the distribution of UV fills its ellipse evenly, as of what is seen sharply through a box pixel filter; 0: it is a
 * Gaussian. */
int footprint_is_even(const RetexSet *set, const RetexFootprint *footprint);

/* The texture at each pixel's footprint, the original albedo showing through where it is transparent: rgb, interleaved;
 * black where there is no footprint. */
void sample_row(const RetexTexture *texture, int even, const FootprintRow *row, float *restrict rgb);

/* How far the texture's colours scatter within each footprint: E[a^2] - E[a]^2. */
void variance_row(const RetexTexture *texture, const RetexTexture *square, int even, const FootprintRow *row,
                  float *restrict rgb);

#endif
