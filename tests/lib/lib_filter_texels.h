/* What the filters of lib_filter.h share, in texels. */
#ifndef LIB_FILTER_TEXELS_H
#define LIB_FILTER_TEXELS_H

#include "texture/texture_kernel.h"

#define TENT_VARIANCE (1.0 / 6)

/* A footprint in texels of the image, y down. */
typedef struct TexelFootprint {
    double x, y;
    double xx, xy, yy;
    double low[2], high[2]; /* limits of the surface from (x, y) along x and y; -inf, inf: none */
} TexelFootprint;

/* Filters with premultiplied results; the covariance must be finite and positive semidefinite. */
void filter_texels_gaussian(const RetexTexture *texture, const TexelFootprint *footprint, float rgba[4]);
void filter_texels_disc(const RetexTexture *texture, const TexelFootprint *footprint, float rgba[4]);
/* sides: the two axes of a parallelogram in texels, each x and y, whose covariance the footprint has. */
void filter_texels_parallelogram(const RetexTexture *texture, const TexelFootprint *footprint,
                                 const double sides[2][2], float rgba[4]);

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
typedef struct LevelCovariance {
    double xx, xy, yy;
} LevelCovariance;

static inline LevelCovariance level_rest(const RetexTextureLevel *level, const TexelFootprint *f,
                                              const double position[2])
{
    double sx = level->scale[0], sy = level->scale[1];
    double blur_x = level->blur[0][0] + level->blur[0][1] * position[0];
    double blur_y = level->blur[1][0] + level->blur[1][1] * position[1];
    LevelCovariance rest = {(f->xx + TENT_VARIANCE - blur_x) / (sx * sx), f->xy / (sx * sy),
                 (f->yy + TENT_VARIANCE - blur_y) / (sy * sy)};
    return rest;
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
