/* Parts of pictures, and smaller sizes of them, of rows as retex_retexture gives them. Every pixel is the mean of the
 * part of the picture that it covers, scene-linear: what rendering at that size gives with a box filter, so that bright
 * lights have no rings. */
#ifndef RETEX_SHRINK_H
#define RETEX_SHRINK_H

#include <retex/combine.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* A rectangle of a picture, in pixels from the upper left, and the size at which it is wanted. */
typedef struct RetexCut {
    int x, y, width, height;
    int scaled_width, scaled_height; /* 1..width, 1..height */
} RetexCut;

/* The cut that a user asks for of a picture of picture_width x picture_height. crop: x, y, width and height, all 0: the
 * whole picture. width, height: the size wanted; where one is 0 it follows from the other by the aspect of the crop,
 * where both are, the crop keeps its size. Where both are given, the crop loses what does not fit, evenly on both
 * sides. RETEX_EINVAL where the crop is not within the picture, or a size is larger than it: nothing is enlarged. */
int retex_cut_fit(RetexCut *cut, int picture_width, int picture_height, const int crop[4], int width, int height,
                  RetexError *err);
/* 1: it is the whole picture at its size. */
int retex_cut_is_whole(const RetexCut *cut, int picture_width, int picture_height);

typedef struct RetexShrink RetexShrink;

/* Begin a cut of a picture of that width. Memory: 12 bytes for each of scaled_width x height pixels, and as much of the
 * result at the end. */
int retex_shrink_open(RetexShrink **shrink, const RetexCut *cut, int picture_width, RetexError *err);
/* A RetexRowSink, of which shrink is the context: rows of the picture, as wide as it, once each. Rows outside of the
 * cut are left out; they need not be given. */
int retex_shrink_rows(void *shrink, int y0, int y1, const float *rows, RetexError *err);
/* The result, RGB of the cut's size: image is unallocated before. Closes *shrink in every case. */
int retex_shrink_take(RetexShrink **shrink, RetexImage *image, int nthreads /* 0 = all cores */, RetexError *err);
void retex_shrink_close(RetexShrink **shrink); /* NULL and pointers to NULL are fine */

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
