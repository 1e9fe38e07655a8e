/* PNG's five filters, tried line by line. */
#ifndef RETEX_PICTURE_PNG_FILTER_H
#define RETEX_PICTURE_PNG_FILTER_H

#include <stddef.h>

/* Write the number of a line's filter and the filtered bytes, 1 + bytes in all: the filter with the smallest sum of
 * absolute values. above is the line before, NULL where it must not be used; pixel is the number of bytes of a pixel;
 * trial is scratch of `bytes` bytes. */
void retex_png_filter(unsigned char *restrict out, unsigned char *restrict trial, const unsigned char *restrict line,
                      const unsigned char *restrict above, size_t bytes, size_t pixel);

#endif
