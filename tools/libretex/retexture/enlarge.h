/* Images of a set that are smaller than its picture, enlarged: bilinear between the centres of their pixels, constant
 * beyond the outermost. Private to libretex. */
#ifndef RETEX_RETEXTURE_ENLARGE_H
#define RETEX_RETEXTURE_ENLARGE_H

#include <retex/image.h>

/* Rows y0 <= y < y1 of an image enlarged scale (1, 2, 4 or 8) times and cut to width, all its channels. */
void retex_enlarge_rows(const RetexImage *image, int scale, int width, int y0, int y1, float *restrict out);

#endif
