/* Images and regions. A RetexImage is a plain block of float samples, interleaved by pixel, rows from the top, no
 * padding. Scene-linear unless said otherwise. */
#ifndef RETEX_IMAGE_H
#define RETEX_IMAGE_H

#include <stddef.h>
#include <retex/access.h>
#include <retex/budget.h>
#include <retex/error.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

#define RETEX_MAX_SIZE 65536     /* largest width or height of any image */
#define RETEX_MAX_CHANNELS 64

/* Half-open: pixels x0 <= x < x1, y0 <= y < y1, channels c0 <= c < c1. */
typedef struct RetexRoi {
    int x0, y0, x1, y1, c0, c1;
} RetexRoi;

typedef struct RetexImage {
    int width, height, channels; /* 0, 0, 0 while unallocated */
    float *pixels;               /* width * height * channels; owned by the image */
} RetexImage;

/* How samples are stored. In memory they are always float. */
typedef enum RetexPixelType { RETEX_HALF, RETEX_FLOAT } RetexPixelType;

static inline size_t retex_image_index(const RetexImage *im, int x, int y)
{
    return ((size_t)y * (size_t)im->width + (size_t)x) * (size_t)im->channels;
}

/* Allocate zeroed pixels; im must be unallocated ({0}). */
int retex_image_alloc(RetexImage *im, int width, int height, int channels, RetexError *err);
void retex_image_free(RetexImage *im); /* NULL and unallocated are fine; leaves {0} */
int retex_image_copy(RetexImage *dst, const RetexImage *src, RetexError *err); /* dst unallocated */

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
