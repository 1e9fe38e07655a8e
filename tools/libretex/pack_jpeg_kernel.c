/* The arithmetic of pack_jpeg.c: an 8 x 8 cosine transform in floating point, by even and odd halves, and the way from
 * luma and chroma over levels to values. */
#include "pack_jpeg_kernel.h"

#include <math.h>
#include <string.h>

/* cos(k pi / 16) / 2 */
#define C1 0.490392640201615f
#define C2 0.461939766255643f
#define C3 0.415734806151273f
#define C4 0.353553390593274f
#define C5 0.277785116509801f
#define C6 0.191341716182545f
#define C7 0.0975451610080642f

/* Eight interleaved transforms of eight: out[k][i] = sum over n of in[n][i] cos((2n + 1) k pi / 16) / 2, orthonormal.
 */
static void forward8(float out[restrict 8][8], float in[restrict 8][8])
{
    for (int i = 0; i < 8; i++) {
        const float s0 = in[0][i] + in[7][i], s1 = in[1][i] + in[6][i], s2 = in[2][i] + in[5][i],
                    s3 = in[3][i] + in[4][i], d0 = in[0][i] - in[7][i], d1 = in[1][i] - in[6][i],
                    d2 = in[2][i] - in[5][i], d3 = in[3][i] - in[4][i];
        const float e0 = s0 + s3, e1 = s1 + s2, f0 = s0 - s3, f1 = s1 - s2;
        out[0][i] = C4 * (e0 + e1);
        out[4][i] = C4 * (e0 - e1);
        out[2][i] = C2 * f0 + C6 * f1;
        out[6][i] = C6 * f0 - C2 * f1;
        out[1][i] = C1 * d0 + C3 * d1 + C5 * d2 + C7 * d3;
        out[3][i] = C3 * d0 - C7 * d1 - C1 * d2 - C5 * d3;
        out[5][i] = C5 * d0 - C1 * d1 + C7 * d2 + C3 * d3;
        out[7][i] = C7 * d0 - C5 * d1 + C3 * d2 - C1 * d3;
    }
}

static void inverse8(float out[restrict 8][8], float in[restrict 8][8])
{
    for (int i = 0; i < 8; i++) {
        const float a = C4 * (in[0][i] + in[4][i]), b = C4 * (in[0][i] - in[4][i]), c = C2 * in[2][i] + C6 * in[6][i],
                    d = C6 * in[2][i] - C2 * in[6][i];
        const float e0 = a + c, e3 = a - c, e1 = b + d, e2 = b - d;
        const float o0 = C1 * in[1][i] + C3 * in[3][i] + C5 * in[5][i] + C7 * in[7][i],
                    o1 = C3 * in[1][i] - C7 * in[3][i] - C1 * in[5][i] - C5 * in[7][i],
                    o2 = C5 * in[1][i] - C1 * in[3][i] + C7 * in[5][i] + C3 * in[7][i],
                    o3 = C7 * in[1][i] - C5 * in[3][i] + C3 * in[5][i] - C1 * in[7][i];
        out[0][i] = e0 + o0;
        out[7][i] = e0 - o0;
        out[1][i] = e1 + o1;
        out[6][i] = e1 - o1;
        out[2][i] = e2 + o2;
        out[5][i] = e2 - o2;
        out[3][i] = e3 + o3;
        out[4][i] = e3 - o3;
    }
}

static void transpose8(float out[restrict 8][8], float in[restrict 8][8])
{
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
            out[x][y] = in[y][x];
}

/* A coefficient below this share of a step above a whole number of steps is rounded down: what it costs in error it
 * saves in bits. */
static const float ROUNDING = 0.44f;

/* Both ways: to coefficients in natural order. */
static void forward(float a[restrict 8][8], const float *samples, int stride)
{
    float b[8][8];
    for (int y = 0; y < 8; y++)
        memcpy(a[y], samples + y * stride, sizeof a[y]);
    forward8(b, a);
    transpose8(a, b);
    forward8(b, a);
    transpose8(a, b);
}

void pack_block_largest(float *largest, const float *samples, int stride)
{
    float a[8][8];
    forward(a, samples, stride);
    for (int i = 0; i < 64; i++)
        largest[i] = fmaxf(largest[i], fabsf(a[i / 8][i % 8]));
}

void pack_block_forward(int16_t *coefficients, const float *samples, int stride, const float *inverse_steps)
{
    float a[8][8];
    forward(a, samples, stride);
    for (int i = 0; i < 64; i++) {
        const float c = a[i / 8][i % 8] * inverse_steps[i];
        const float size = floorf(fabsf(c) + (i ? ROUNDING : 0.5f));
        coefficients[i] = (int16_t)copysignf(fminf(size, 1023), c);
    }
}

void pack_blocks_inverse(float *samples, int stride, const int16_t *coefficients, int blocks, const float *steps)
{
    for (int block = 0; block < blocks; block++, coefficients += 64, samples += 8) {
        float a[8][8], b[8][8];
        for (int i = 0; i < 64; i++)
            a[i / 8][i % 8] = (float)coefficients[i] * steps[i];
        inverse8(b, a);
        transpose8(a, b);
        inverse8(b, a);
        transpose8(a, b);
        for (int y = 0; y < 8; y++)
            memcpy(samples + y * stride, a[y], sizeof a[y]);
    }
}

static inline float value_of(float level, const PackLevelTable *table)
{
    const float place = fmaxf(level * PACK_LEVEL_STEPS, 0);
    const int entry = place < PACK_LEVEL_ENTRIES ? (int)place : PACK_LEVEL_ENTRIES;
    const float low = table->value[entry];
    return low + (table->value[entry + 1] - low) * (place - (float)entry);
}

void pack_colours_from_planes(float *restrict values, const float *y, const float *cb, const float *cr, int count,
                              const PackLevelTable *table)
{
    for (int i = 0; i < count; i++) {
        const float level = y[i] + 128;
        values[3 * i] = value_of(level + 1.402f * cr[i], table);
        values[3 * i + 1] = value_of(level - 0.344136286f * cb[i] - 0.714136286f * cr[i], table);
        values[3 * i + 2] = value_of(level + 1.772f * cb[i], table);
    }
}

void pack_greys_from_plane(float *restrict values, const float *y, int count, const PackLevelTable *table)
{
    for (int i = 0; i < count; i++)
        values[i] = value_of(y[i] + 128, table);
}
