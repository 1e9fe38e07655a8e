/* The arithmetic of jpeg.c, on rows of 8 x 8 blocks. */
#ifndef RETEX_PACK_JPEG_KERNEL_H
#define RETEX_PACK_JPEG_KERNEL_H

#include <stdint.h>

#include <retex/host/cpu.h>

enum { RETEX_PACK_LEVEL_ENTRIES = 8192 };

/* Which values levels stand for: entries, between which one interpolates; beyond the last one the line goes on. */
typedef struct RetexPackLevels {
    float scale;        /* entries a level */
    float white[3];     /* by channel, times the entry is the value */
    const float *share; /* of white: [RETEX_PACK_LEVEL_ENTRIES + 2] */
} RetexPackLevels;

/* 64 samples of a block, rows `stride` floats apart, to coefficients in natural order, quantised. */
void retex_pack_block_forward(int16_t *coefficients, const float *samples, int stride, const float *inverse_steps);

/* largest[64] gets the sizes of a block's coefficients where they are larger. */
void retex_pack_block_largest(float *largest, const float *samples, int stride);

/* The way back, which most of the time goes to. All of them give the same bits. */
typedef struct RetexPackJpegKernels {
    /* A row of blocks: 8 rows of samples, `stride` floats apart. */
    void (*inverse)(float *samples, int stride, const int16_t *coefficients, int blocks, const float *steps);
    /* Planes of Y, Cb and Cr (centred on 0) to interleaved values, and of one channel. */
    void (*colors)(float *values, const float *y, const float *cb, const float *cr, int count,
                   const RetexPackLevels *levels);
    void (*greys)(float *values, const float *y, int count, const RetexPackLevels *levels);
} RetexPackJpegKernels;

extern const RetexPackJpegKernels retex_pack_jpeg_kernels[RETEX_CPU_LEVELS];

#endif
