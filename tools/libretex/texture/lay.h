/* Laying: several repeats of a texture, with joints between them, become one image that repeats. Private to
 * libretex. */
#ifndef RETEX_TEXTURE_LAY_H
#define RETEX_TEXTURE_LAY_H

#include "texture/pyramid.h"

/* A repeat in the image. */
typedef struct RetexLaidBlock {
    int x, y;        /* its lower left corner, in texels from the image's lower left one, maybe outside of it */
    int stands;      /* 1: turned by 90 degrees */
    int column, row; /* which one it is */
} RetexLaidBlock;

/* The image: blocks of block[0] by block[1] texels with a joint of so many texels at their right and upper ends. */
typedef struct RetexLayout {
    int width, height;
    int block[2], joint[2];
    double grout[2];       /* the joint's true width in texels, at most `joint` */
    double period[2];      /* size of the image in widths and heights of a repeat without its joint */
    int is_hexagonal;      /* 1: blocks are hexagons with a corner above, and their corners x, y are their middles */
    int width_of_one, row; /* of these: how far they are apart, and their rows */
    int nblocks;
    RetexLaidBlock *blocks;
} RetexLayout;

/* RETEX_EINVAL: options of laying contradict each other. */
int retex_lay_check(const RetexTextureSpec *spec, RetexError *err);
/* 1: the texture's texels are more than the image's own. */
int retex_lay_is_needed(const RetexTextureSpec *spec);
/* 1: the texture is an image, also if it is a colour with joints. */
static inline int retex_lay_is_image(const RetexTextureSpec *spec)
{
    return !spec->constant || spec->grout > 0;
}
/* The number of tiles. */
int retex_lay_tiles(const RetexTextureSpec *spec);
/* Plan the image for repeats of that size. The layout is to be freed, in any case. */
int retex_layout_make(RetexLayout *layout, const RetexTextureSpec *spec, int width, int height, RetexError *err);
void retex_layout_free(RetexLayout *layout);
/* Paint the image, whose texels are allocated, from `ntiles` images of repeats. The same to the bit for every number of
 * threads. */
void retex_layout_paint(const RetexLayout *layout, const RetexTextureSpec *spec, const RetexTexels *tiles, int ntiles,
                        const RetexTexels *image, int nthreads);

#endif
