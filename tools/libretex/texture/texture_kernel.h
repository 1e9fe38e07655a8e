/* Reading texels, also beyond the borders of a level. Included by the kernels of this room alone. */
#ifndef RETEX_TEXTURE_TEXTURE_KERNEL_H
#define RETEX_TEXTURE_TEXTURE_KERNEL_H

#include "base/float4.h"
#include "texture/pyramid.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* A texel as it is stored. */
static inline RetexFloat4 raw_texel(const void *p, int narrow)
{
    if (!narrow)
        return load4(p);
    uint16_t t[4];
    memcpy(t, p, sizeof t);
    return (RetexFloat4){t[0], t[1], t[2], t[3]};
}

/* The factor of sums of raw texels. */
static inline float texel_unit(int narrow)
{
    return narrow ? 1 / NARROW_ONE : 1;
}

/* The next whole number below or above, within int's range; baseline x86-64 has a function call for floorf. */
static inline int whole_below(double x)
{
    int i = (int)x;
    return i - (x < i);
}

static inline int whole_above(double x)
{
    int i = (int)x;
    return i + (x > i);
}

static inline int clamp_index(int i, int n)
{
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

/* A wrap mode of kernels alone: the texels of the level's border go on outside. */
#define EDGE_TEXELS ((RetexWrap)(RETEX_WRAP_BLACK + 1))

/* Wraps i into 0..n-1; -1 or n where it is outside of an axis that neither repeats nor mirrors. */
static inline int wrap_index(int i, int n, RetexWrap wrap)
{
    if ((unsigned)i < (unsigned)n)
        return i;
    if (wrap == EDGE_TEXELS)
        return clamp_index(i, n);
    switch (wrap) {
    case RETEX_WRAP_REPEAT:
        i %= n;
        return i < 0 ? i + n : i;
    case RETEX_WRAP_MIRROR:
        i %= 2 * n;
        i = i < 0 ? i + 2 * n : i;
        return i < n ? i : 2 * n - 1 - i;
    case RETEX_WRAP_CLAMP:
    case RETEX_WRAP_BLACK:
        break;
    }
    return i < 0 ? -1 : n;
}

/* One row of a level: texels inside, and those to the left and right; NULL = transparent. */
typedef struct RetexLevelRow {
    const char *texels;
    const char *beside[2];
} RetexLevelRow;

static inline RetexLevelRow find_row(const RetexTexture *texture, const RetexTextureLevel *level, int y, int sharp)
{
    RetexLevelRow row = {NULL, {NULL, NULL}};
    int at = sharp ? clamp_index(y, level->height) : wrap_index(y, level->height, texture->spec.wrap[1]);
    if ((unsigned)at < (unsigned)level->height) {
        size_t size = texel_size(texture->narrow);
        row.texels = (const char *)level->texels + (size_t)at * (size_t)level->width * size;
        for (int side = 0; side < 2; side++)
            if (level->sides[side])
                row.beside[side] = (const char *)level->sides[side] + (size_t)at * size;
    } else if (texture->spec.wrap[1] == RETEX_WRAP_CLAMP) {
        int below = at > 0;
        row.texels = level->ends[below];
        if (texture->spec.wrap[0] == RETEX_WRAP_CLAMP)
            for (int side = 0; side < 2; side++)
                row.beside[side] = texture->corners[2 * below + side];
    }
    return row;
}

/* Copy `count` texels of row y from x on; those beyond the edges are as the wrap modes say. */
static inline void copy_texels(const RetexTexture *texture, const RetexTextureLevel *level, int x, int y, int count,
                               char *to)
{
    const size_t size = texel_size(texture->narrow);
    const RetexLevelRow row = find_row(texture, level, y, 0);
    for (const int end = x + count; x < end; x++, to += size) {
        const int at = wrap_index(x, level->width, texture->spec.wrap[0]);
        const char *texel = NULL;
        if (row.texels)
            texel = (unsigned)at < (unsigned)level->width ? row.texels + (size_t)at * size : row.beside[at > 0];
        if (texel)
            memcpy(to, texel, size);
        else
            memset(to, 0, size);
    }
}

/* Wraps a coordinate of a repeating axis into its first period, for the precision of floats. */
static inline double first_period(double x, int texels, RetexWrap wrap)
{
    double period = wrap == RETEX_WRAP_MIRROR ? 2.0 * texels : texels;
    if (wrap == RETEX_WRAP_REPEAT || wrap == RETEX_WRAP_MIRROR) {
        double folded = x - period * floor(x / period);
        return folded >= 0 && folded <= period ? folded : 0; /* beyond the precision of doubles */
    }
    /* Far outside nothing changes any more, and the coordinate must fit an int. */
    double far = 1e6;
    return x < -far ? -far : x > far ? far : x;
}

/* 1 if the image cannot change along an axis: it has one texel, and nothing else beside it. */
static inline int is_flat(const RetexTexture *texture, int axis)
{
    const RetexTextureLevel *image = &texture->levels[0];
    return (axis ? image->height : image->width) == 1 && texture->spec.wrap[axis] != RETEX_WRAP_BLACK;
}

#endif
