/* A texture in memory: its MIP pyramid, and what the filter has to know about each level. Private to libretex. */
#ifndef RETEX_TEXTURE_PYRAMID_H
#define RETEX_TEXTURE_PYRAMID_H

#include <stdint.h>

#include "texture/texel_defects.h"

#define TEXTURE_MAX_LEVELS 18 /* of 131072 texels a side, two repeats of 65536: 131072, 65536, ... 1 */
#define NARROW_ONE 65535.0f
#define TEXTURE_TAIL_STEPS 64 /* of the table below, per unit */
#define TEXTURE_TAIL_END 4

/* One level. Every texel is the exact average of the part of the image it covers; all texels of a level cover equal
 * parts, which need not be whole texels of the image. Colours are premultiplied by alpha, RGBA, rows from the top. */
typedef struct RetexTextureLevel {
    int width, height;
    void *texels; /* 4 floats each, or 4 uint16_t of a narrow texture */
    /* Of a clamped axis: the image's border goes on outside it, filtered along the border only. Outside texels of a
     * level are the border's, not the level's own, which hold averages of what lies inside. NULL otherwise. */
    void *sides[2]; /* left and right of the image: height texels */
    void *ends[2];  /* above and below: width texels */
    /* Of a small level: the same once more with `padding` texels of what lies outside on every side, so that windows
     * beyond its border are as any other. NULL and 0 of all others. */
    void *padded;
    int padding;
    double scale[2]; /* image texels per texel of this level, u and v */
    /* Variance that averaging has added along each axis, in image texels squared, at the relative position p of the
     * axis: blur[0] + blur[1] p (1 - p). Halving an odd number of texels blurs more in the middle than at the ends. */
    double blur[2][2];
} RetexTextureLevel;

struct RetexTexture {
    RetexTextureSpec spec; /* with wrap = mirror for repeat = mirror */
    uint64_t charged;      /* bytes of the spec's budget */
    int repeats[2];        /* that the image holds along u and v: 2 where every second one is shifted */
    /* uv' = matrix uv + offset, from the surface's UV to that of the image with all its repeats: all of the spec. */
    double matrix[2][2];
    double offset[2];
    int nlevels; /* 0 = constant */
    int opaque;  /* 1: alpha is 1 wherever the texture is looked up */
    RetexTexelDefects defects; /* what was odd about the file's */
    int narrow;  /* 1: texels are 16-bit integers, NARROW_ONE standing for 1; else floats */
    RetexTextureLevel levels[TEXTURE_MAX_LEVELS];
    char corners[4][16]; /* texels of the image: top left, top right, bottom left, bottom right */
    /* E max(z + N(0,1), 0) - max(z, 0) for z = 0 .. TEXTURE_TAIL_END: what a bilinear tent blurred by a Gaussian is
     * made of */
    float tail[TEXTURE_TAIL_STEPS * TEXTURE_TAIL_END + 2];
};

/* An image on its way into a texture: premultiplied, rows from the top; the texels are freed with free(). */
typedef struct RetexTexels {
    int width, height, narrow;
    void *texels;
} RetexTexels;

/* Tell spec->warn what there is to be said of the texture, which was loaded by that spec or a copy of it. */
void retex_texture_report_defects(const RetexTexture *texture, const RetexTextureSpec *spec);

size_t retex_texture_texel_size(int narrow);           /* bytes */
int retex_texels_alloc(RetexTexels *texels); /* by its other members; not 0: out of memory */
void retex_texture_read_texel(const void *texels, size_t index, int narrow, float rgba[4]);
/* The texels become level 0, and all other levels are made of it. Not 0: out of memory. */
int retex_texture_build_pyramid(RetexTexture *texture, RetexTexels *texels, int nthreads);

/* A footprint in texels of the image, y down. */
typedef struct RetexTexelFootprint {
    double x, y;
    double xx, xy, yy;
    double low[2], high[2]; /* how far the surface reaches from there along x and y; -inf, inf: as far as you like */
} RetexTexelFootprint;

/* Premultiplied results. The first is the bilinear look-up, the second the texel that the place lies in; the others
 * need a covariance that is finite and positive semidefinite. */
void retex_texture_point_kernel(const RetexTexture *texture, double x, double y, float rgba[4]);
void retex_texture_nearest_kernel(const RetexTexture *texture, double x, double y, float rgba[4]);
void retex_texture_row_kernel(const RetexTexture *texture, int y, float *rgb);
void retex_texture_gaussian_kernel(const RetexTexture *texture, const RetexTexelFootprint *footprint, float rgba[4]);
void retex_texture_disc_kernel(const RetexTexture *texture, const RetexTexelFootprint *footprint, float rgba[4]);

#endif
