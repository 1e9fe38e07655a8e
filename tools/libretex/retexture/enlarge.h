/* Bilinear enlargement of images that are smaller than the picture: their values lie at pixel centres, and are constant
 * beyond the outermost centres. Private to libretex. */
#ifndef RETEX_RETEXTURE_ENLARGE_H
#define RETEX_RETEXTURE_ENLARGE_H

#include <retex/image.h>

/* Compute rows y0 <= y < y1 of an image enlarged scale (1, 2, 4 or 8) times and cut to width, all channels. */
void retex_enlarge_rows(const RetexImage *image, int scale, int width, int y0, int y1, float *restrict out);

#endif
