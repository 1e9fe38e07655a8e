/* Many footprints of one texture at once. Private to libretex.
 *
 * Sums of texels times weights, for 4 x 4 texels at a time, for as many footprints as the processor's vectors have
 * lanes. All kernels do the same arithmetic in the same order and give the same bits. */
#ifndef RETEX_TEXTURE_BATCH_H
#define RETEX_TEXTURE_BATCH_H

#include <retex/host/cpu.h>

#include "texture/pyramid.h"
#include "texture/filter.h"

#define BATCH_LEVELS 16
#define BATCH_SIZE 1024 /* footprints in one call of a kernel */

/* The limit of the surface, where Gaussians are cut off, along an axis of the image. */
typedef struct RetexBatchLimit {
    int along;       /* axis of the surface: 0 u, 1 v; -1: no limit */
    float low, high; /* limits in the surface's UV */
    float scale;     /* images per unit of UV, y down */
} RetexBatchLimit;

/* Placement and levels of a texture, in the form that kernels read. */
typedef struct RetexBatchTexture {
    const RetexTexture *texture;
    int gaussian;
    int straight;                        /* 1: parallelograms */
    int broad;                           /* 1: the level is chosen by `most', and never interpolated */
    float narrowest, least, most;        /* see batch.c */
    double matrix[2][2], offset[2];      /* from surface UV to image UV, in images, y down */
    double period[2];                    /* period of the image along x and y; 0: it does not repeat */
    double size[2];                      /* texels of level 0 */
    int black[2];                        /* 1: outside of the image all is transparent */
    float to_texels[2][2];               /* surface UV to texels of level 0, y down */
    int levels;                          /* number of levels that are halved along both axes */
    float texels[2][BATCH_LEVELS];       /* size of each level */
    float inverse_area[3][BATCH_LEVELS]; /* factors of the covariance xx, xy and yy on each level */
    float blur[2][2][BATCH_LEVELS];      /* by axis and term: the variance that a level already has */
    float spread[2][BATCH_LEVELS];       /* 0 along an axis of one repeating texel, else 1 */
    float padding[BATCH_LEVELS];         /* padding of each level */
    RetexBatchLimit limits[2];           /* limits of the image along x and y */
    int limited;                         /* 1: there is at least one limit */
    int first, last;                     /* the finest level that may be chosen; and the coarsest one of all, some of
                                            which have texels that are longer along one axis */
} RetexBatchTexture;

/* Input: footprints with coverage. Output: premultiplied colours, and the indices of footprints that the kernel did not
 * filter. */
typedef struct RetexBatch {
    int count;
    float u[BATCH_SIZE], v[BATCH_SIZE];
    float spread[4][BATCH_SIZE]; /* deviations along u and v, correlation; or the sides of a parallelogram */
    float rgba[BATCH_SIZE][4];
    int left[BATCH_SIZE], nleft;
    unsigned char sharp[BATCH_SIZE]; /* of those that are left: bits of axes where they are smaller than texels and a
                                        transparent border cuts them */
} RetexBatch;

typedef void RetexTextureBatchKernel(const RetexBatchTexture *texture, RetexBatch *batch);

extern RetexTextureBatchKernel *const retex_texture_batch_kernels[RETEX_CPU_LEVELS];

/* Like retex_texture_filter, with one of these kernels; not for constants. Returns how many footprints the kernel did
 * not filter. */
size_t retex_texture_filter_batches(RetexTextureBatchKernel *kernel, const RetexTexture *texture,
                                    RetexTextureFilter shape, const float *uv, const float *spread, int spreads,
                                    size_t n, float *colors, int channels);

/* Copy the 4 x 4 texels from column x and row y on, as they are stored, where some are beyond the level's borders. */
void retex_texture_copy_block(const RetexTexture *texture, const RetexTextureLevel *level, int x, int y, char *texels);

#endif
