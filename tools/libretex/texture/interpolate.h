/* Bilinear look-ups in images that are to become textures. Private to libretex. */
#ifndef RETEX_TEXTURE_INTERPOLATE_H
#define RETEX_TEXTURE_INTERPOLATE_H

#include <math.h>
#include <string.h>

#include "texture/pyramid.h"

/* A position between texels: the two of an axis, and the share of the second. */
typedef struct RetexBetween {
    size_t first, second;
    float share;
} RetexBetween;

/* at: 0..texels, from the image's left or upper edge. */
static inline RetexBetween retex_between(double at, int texels, RetexWrap wrap)
{
    const double from_middle = at - 0.5, low = floor(from_middle);
    int first = (int)low, second = first + 1;
    const int repeats = wrap == RETEX_WRAP_REPEAT;
    first = first < 0 ? (repeats ? texels - 1 : 0) : first;
    second = second >= texels ? (repeats ? 0 : texels - 1) : second;
    return (RetexBetween){(size_t)first, (size_t)second, (float)(from_middle - low)};
}

static inline void retex_interpolate(const RetexTexels *from, RetexBetween x, RetexBetween y, float rgba[4])
{
    const size_t width = (size_t)from->width, rows[2] = {y.first, y.second}, columns[2] = {x.first, x.second};
    const float down[2] = {1 - y.share, y.share}, across[2] = {1 - x.share, x.share};
    float texel[4];
    memset(rgba, 0, 4 * sizeof *rgba);
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            const float weight = down[j] * across[i];
            if (weight == 0)
                continue;
            retex_texture_read_texel(from->texels, rows[j] * width + columns[i], from->narrow, texel);
            for (int c = 0; c < 4; c++)
                rgba[c] += weight * texel[c];
        }
}

#endif
