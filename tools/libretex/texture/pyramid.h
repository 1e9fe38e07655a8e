/* A texture in memory: its MIP pyramid, and what the filters need to know of each level. Private to libretex. */
#ifndef RETEX_TEXTURE_PYRAMID_H
#define RETEX_TEXTURE_PYRAMID_H

#include <stdint.h>

#include <retex/set.h>

#include "texture/texel_defects.h"

#define TEXTURE_MAX_LEVELS 18 /* of 131072 texels a side, two repeats of 65536: 131072, 65536, ... 1 */
#define NARROW_ONE 65535.0f
#define TEXTURE_TAIL_STEPS 64 /* steps of the table below, per unit */
#define TEXTURE_TAIL_END 4

/* One level. Every texel is the exact average of the part of the image it covers; all texels of a level cover equal
 * parts, which need not be whole texels of the image. Colours are premultiplied by alpha, RGBA, rows from the top. */
typedef struct RetexTextureLevel {
    int width, height;
    void *texels; /* 4 floats each, or 4 uint16_t of a narrow texture */
    /* For a clamped axis: the image's border, filtered along the border only. Texels outside of a level are those of
     * the border, not the level's outermost texels, which are averages of the inside. NULL otherwise. */
    void *sides[2]; /* left and right of the image: height texels */
    void *ends[2];  /* above and below: width texels */
    /* For a small level: a copy with `padding` texels of the outside on every side, so that windows beyond the border
     * need no special case. NULL and 0 for all others. */
    void *padded;
    int padding;
    double scale[2]; /* image texels per texel of this level, u and v */
    /* Variance that averaging has added along each axis, in image texels squared, at the relative position p of the
     * axis: blur[0] + blur[1] p (1 - p). Halving an odd number of texels blurs more in the middle than at the ends. */
    double blur[2][2];
} RetexTextureLevel;

/* Which finish of its target a texture has where. The weights of all finishes, and of a fourth one that is black in
 * a normal map, sum to 1 at every texel. What is filtered are products with the colour, for the mean of products is
 * not the product of means. */
typedef struct RetexFinishMap {
    int is_normal;                            /* 1: of a normal map: weights of either sign */
    int count;                                /* finishes, 2..RETEX_FINISHES_MAX */
    RetexTexture *weights;                    /* red: of the second finish, green: of the third, blue: of the fourth */
    RetexTexture *colors[RETEX_FINISHES_MAX]; /* the colour times the weight of each */
} RetexFinishMap;

struct RetexTexture {
    RetexTextureSpec spec; /* with wrap = mirror for repeat = mirror */
    uint64_t charged;      /* bytes charged to the spec's budget */
    int shared;            /* 1: the texels are another texture's */
    int size[2];           /* texels of the file's image; 1, 1 for a constant */
    double repeats[2];     /* size of the image in repeats along u and v: 1, or more where several are laid into it */
    /* uv' = matrix uv + offset, from the surface's UV to that of the image with all its repeats: all of the spec. */
    double matrix[2][2];
    double offset[2];
    int nlevels; /* 0 = constant */
    int opaque;  /* 1: alpha is 1 wherever the texture is looked up */
    RetexTexelDefects defects; /* defects of the file's texels */
    char *color_warning;       /* what is odd about the file, in lines, such as colours not followed; or NULL */
    int narrow;  /* 1: texels are 16-bit integers, NARROW_ONE standing for 1; else floats */
    RetexTextureLevel levels[TEXTURE_MAX_LEVELS];
    char corners[4][16]; /* texels of the image: top left, top right, bottom left, bottom right */
    /* E max(z + N(0,1), 0) - max(z, 0) for z = 0 .. TEXTURE_TAIL_END: what a bilinear tent blurred by a Gaussian is
     * made of */
    float tail[TEXTURE_TAIL_STEPS * TEXTURE_TAIL_END + 2];
    RetexFinishMap *finishes; /* or NULL: one finish all over */
    RetexTexture *over;       /* the layer that lies on it, or NULL */
    int may_have_finishes;    /* 1: whether it has some, and which, depends on those of the target */
};

/* An image that becomes a texture: premultiplied, rows from the top; the texels are freed with free(). */
typedef struct RetexTexels {
    int width, height, narrow;
    void *texels;
} RetexTexels;

/* Report what is odd about the texture's colours to spec->warn; the texture was loaded by that spec or a copy of it. */
void retex_texture_report_colors(const RetexTexture *texture, const RetexTextureSpec *spec);

/* A texture of that placement, a constant or still without texels; NULL: the specification is wrong. */
RetexTexture *retex_texture_new(const RetexTextureSpec *spec, RetexError *err);
/* Make premultiplied texels those of the texture. They are used up. tiles: those of other images for repeats, at most
 * RETEX_TILES_MAX; or NULL. */
int retex_texture_set_texels(RetexTexture *texture, RetexTexels *texels, const RetexTexels *tiles, int ntiles,
                             int nthreads, RetexError *err);
/* The placement of the textures of a map, whose texels may have another aspect than the image of that size.
 * is_normal: of a normal map, which has repeats that are mirrored as texels. */
RetexTextureSpec retex_texture_finish_spec(const RetexTextureSpec *spec, int width, int height, int is_normal);
/* 1: some lengths of the texture itself are in metres, and some are not. */
int retex_texture_mixes_units(const RetexTextureSpec *spec);
/* Put the texture on another surface: its uv_scale, unit, uv_min and uv_max become those of this spec, all else stays.
 * RETEX_EINVAL where it has a width and uv_scale is unknown; it is then unchanged. */
int retex_texture_set_surface(RetexTexture *texture, const RetexTextureSpec *spec, RetexError *err);
/* A texture with the placement, surface included, of another spec. It shares the texels of `texture`, which must be
 * closed later. RETEX_EINVAL where spec needs other texels: another image or colour space, another wrap mode, another
 * kind of repeats. Both must have an image. */
int retex_texture_place(RetexTexture **placed, const RetexTexture *texture, const RetexTextureSpec *spec,
                        RetexError *err);
/* A texture of the same placement whose colours are the squares of the (unassociated) colours, with the same alpha:
 * E[a^2] - E[a]^2 is a texture's variance within a footprint. */
int retex_texture_square(RetexTexture **square, const RetexTexture *texture, int nthreads, RetexError *err);
/* The number of finishes that its map tells apart, or 0. */
static inline int retex_texture_has_finishes(const RetexTexture *texture)
{
    return texture->finishes ? texture->finishes->count : 0;
}
/* 1: nothing shows through it anywhere. */
int retex_texture_is_opaque(const RetexTexture *texture);

/* In bytes. */
static inline size_t texel_size(int narrow)
{
    return narrow ? 4 * sizeof(uint16_t) : 4 * sizeof(float);
}

int retex_texels_alloc(RetexTexels *texels); /* allocate texels by width, height and narrow; not 0: out of memory */
void retex_texture_read_texel(const void *texels, size_t index, int narrow, float rgba[4]);
/* Integers hold what is in 0..1. */
void retex_texture_store_texel(const RetexTexels *texels, size_t index, const float rgba[4]);
/* Make the texels level 0, and compute all other levels. Not 0: out of memory. */
int retex_texture_build_pyramid(RetexTexture *texture, RetexTexels *texels, int nthreads);

/* Look-ups with premultiplied results: bilinear, and the nearest texel. */
void retex_texture_point_kernel(const RetexTexture *texture, double x, double y, float rgba[4]);
void retex_texture_nearest_kernel(const RetexTexture *texture, double x, double y, float rgba[4]);

#endif
