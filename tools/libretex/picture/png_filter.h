/* PNG's five filters, tried line by line. */
#ifndef RETEX_PICTURE_PNG_FILTER_H
#define RETEX_PICTURE_PNG_FILTER_H

#include <stddef.h>

/* Write a line's filter and what is left of its bytes, 1 + bytes in all: of all filters the one whose rest is smallest,
 * summed without signs. above is the line before, NULL where it must not be looked at; pixel is the number of bytes
 * before the same sample of the next pixel; trial has room for bytes. */
void retex_png_filter(unsigned char *restrict out, unsigned char *restrict trial, const unsigned char *restrict line,
                      const unsigned char *restrict above, size_t bytes, size_t pixel);

#endif
