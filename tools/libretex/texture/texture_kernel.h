/* Shared by the two filters: reading texels beyond the borders of a level, and the covariance that remains on a level.
 * Included by the kernels of this room alone. */
#ifndef RETEX_TEXTURE_TEXTURE_KERNEL_H
#define RETEX_TEXTURE_TEXTURE_KERNEL_H

#include "base/float4.h"
#include "texture/pyramid.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#define TENT_VARIANCE (1.0 / 6)

/* A texel as it is stored, and its size in bytes. */
static inline RetexFloat4 raw_texel(const void *p, int narrow)
{
    if (!narrow)
        return load4(p);
    uint16_t t[4];
    memcpy(t, p, sizeof t);
    return (RetexFloat4){t[0], t[1], t[2], t[3]};
}

static inline size_t texel_size(int narrow)
{
    return narrow ? 4 * sizeof(uint16_t) : 4 * sizeof(float);
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

/* Wraps i into 0..n-1; -1 or n where it is outside of an axis that neither repeats nor mirrors. */
static inline int wrap_index(int i, int n, RetexWrap wrap)
{
    if ((unsigned)i < (unsigned)n)
        return i;
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

static inline int clamp_index(int i, int n)
{
    return i < 0 ? 0 : i >= n ? n - 1 : i;
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

/* p (1 - p) of blur, averaged over a footprint of that standard deviation (of the axis as 1): on a repeating axis it
 * tends to its mean, 1/6, about as exp(-2 pi^2 sd^2). */
static inline double mean_position(double x, double variance, double size, RetexWrap wrap)
{
    double p = x / size, damping = 1 + 10 * variance / (size * size);
    if (wrap == RETEX_WRAP_CLAMP || wrap == RETEX_WRAP_BLACK)
        p = p < 0 ? 0 : p > 1 ? 1 : p;
    else
        p -= floor(p); /* a mirrored image has the same blur at p and 1 - p */
    return 1.0 / 6 + (p * (1 - p) - 1.0 / 6) / (damping * damping);
}

/* The covariance that the sum over a level's texels must have, in that level's texels. */
typedef struct RetexLevelCovariance {
    double xx, xy, yy;
} RetexLevelCovariance;

static inline RetexLevelCovariance level_rest(const RetexTextureLevel *level, const RetexTexelFootprint *f,
                                              const double position[2])
{
    double sx = level->scale[0], sy = level->scale[1];
    double blur_x = level->blur[0][0] + level->blur[0][1] * position[0];
    double blur_y = level->blur[1][0] + level->blur[1][1] * position[1];
    RetexLevelCovariance rest = {(f->xx + TENT_VARIANCE - blur_x) / (sx * sx), f->xy / (sx * sy),
                 (f->yy + TENT_VARIANCE - blur_y) / (sy * sy)};
    return rest;
}

/* 1 if the image cannot change along an axis: it has one texel, and nothing else beside it. */
static inline int is_flat(const RetexTexture *texture, int axis)
{
    const RetexTextureLevel *image = &texture->levels[0];
    return (axis ? image->height : image->width) == 1 && texture->spec.wrap[axis] != RETEX_WRAP_BLACK;
}

/* A step without a common factor with the period, which visits all texels of a repeating axis. */
static inline int coprime_step(int step, int texels, RetexWrap wrap)
{
    int period = wrap == RETEX_WRAP_MIRROR ? 2 * texels : texels;
    if (wrap == RETEX_WRAP_CLAMP || wrap == RETEX_WRAP_BLACK || period < 2)
        return step;
    for (int tries = 0; tries < 16; tries++, step++) {
        int a = step, b = period;
        while (b) {
            int rest = a % b;
            a = b;
            b = rest;
        }
        if (a == 1)
            return step;
    }
    return step;
}

#endif
