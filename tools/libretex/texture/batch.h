/* Many footprints of one texture at once. Private to libretex.
 *
 * What is summed is what disc_kernel.c and filter_kernel.c sum, on coarser levels of the pyramid:
 * texels times weights, the weights of 4 x 4 texels at a time, for as many footprints as the machine's vectors have
 * lanes. All kernels do the same arithmetic in the same order and give the same bits. */
#ifndef RETEX_TEXTURE_BATCH_H
#define RETEX_TEXTURE_BATCH_H

#include <retex/cpu.h>

#include "texture/pyramid.h"

#define BATCH_LEVELS 16
#define BATCH_SIZE 1024 /* footprints in one call of a kernel */

/* Where the surface, and with it every Gaussian, ends along an axis of the image. */
typedef struct RetexBatchLimit {
    int along;       /* the surface's own axis, 0 u or 1 v; -1: no end */
    float low, high; /* of the surface's UV */
    float scale;     /* images a unit of UV, y down */
} RetexBatchLimit;

/* A texture's placement and levels, as the kernels read them. */
typedef struct RetexBatchTexture {
    const RetexTexture *texture;
    int gaussian;
    double matrix[2][2], offset[2];      /* surface UV to the image's, in images, y down */
    double period[2];                    /* of the image along x and y; 0: it does not repeat */
    double size[2];                      /* texels of level 0 */
    int black[2];                        /* the image ends in nothing */
    float to_texels[2][2];               /* surface UV to texels of level 0, y down */
    int levels;                          /* that are halved along both axes alike */
    float texels[2][BATCH_LEVELS];       /* of a level */
    float inverse_area[3][BATCH_LEVELS]; /* what divides xx, xy and yy on a level */
    float blur[2][2][BATCH_LEVELS];      /* of axis and term: variance that a level has already */
    float spread[2][BATCH_LEVELS];       /* 0 along an axis of one texel that goes on for ever, else 1 */
    float padding[BATCH_LEVELS];         /* texels that RetexTextureLevel's origin has around a level */
    RetexBatchLimit limits[2];                /* of the image along x and y */
    int limited;                         /* 1: some of them is one */
} RetexBatchTexture;

/* In: live footprints. Out: premultiplied colours, and which of them the kernel left alone. */
typedef struct RetexBatch {
    int count;
    float u[BATCH_SIZE], v[BATCH_SIZE], su[BATCH_SIZE], sv[BATCH_SIZE], correlation[BATCH_SIZE];
    float rgba[BATCH_SIZE][4];
    int left[BATCH_SIZE], nleft;
} RetexBatch;

typedef void RetexTextureBatchKernel(const RetexBatchTexture *texture, RetexBatch *batch);

extern RetexTextureBatchKernel *const retex_texture_batch_kernels[RETEX_CPU_LEVELS];

/* retex_texture_filter, by one of them; not for constants. */
void retex_texture_filter_batches(RetexTextureBatchKernel *kernel, const RetexTexture *texture,
                                  RetexTextureFilter shape, const float *uv, const float *spread, int spreads, size_t n,
                                  float *colors, int channels);

/* The 4 x 4 texels from column x and row y on, as they are stored, where some lie beyond the level's borders. */
void retex_texture_copy_block(const RetexTexture *texture, const RetexTextureLevel *level, int x, int y, char *texels);

#endif
