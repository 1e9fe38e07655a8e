/* Part of a picture at a smaller size. Every pixel is the mean of the part of the picture that it covers, scene-linear:
 * what rendering at that size gives with a box filter, so that bright lights have no rings. */
#ifndef RETEX_SERVE_SHRINK_H
#define RETEX_SERVE_SHRINK_H

#include <retex/image.h>

/* Columns of RGB rows: out has `width` pixels, which cover x0 <= x < x1 of row. */
void shrink_row(float *out, int width, const float *row, int x0, int x1);

/* Rows of an image whose columns are done already: fill dst, which is allocated with src's width, from all rows of
 * src. */
void shrink_rows(RetexImage *dst, const RetexImage *src, int nthreads);

#endif
