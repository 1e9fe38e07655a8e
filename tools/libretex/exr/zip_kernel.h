/* The filter of OpenEXR's ZIP before deflate, and its inverse. Private to libretex. */
#ifndef RETEX_EXR_ZIP_KERNEL_H
#define RETEX_EXR_ZIP_KERNEL_H

#include <stddef.h>

/* Regroup: bytes at even positions first, those at odd positions after them. */
void retex_exr_zip_regroup(unsigned char *restrict out, const unsigned char *restrict raw, size_t bytes);
void retex_exr_zip_interleave(unsigned char *restrict raw, const unsigned char *restrict in, size_t bytes);

/* Replace each byte by its difference from the one before, plus 128; accumulate: the inverse, in place. */
void retex_exr_zip_difference(unsigned char *restrict out, const unsigned char *restrict in, size_t bytes);
void retex_exr_zip_accumulate(unsigned char *data, size_t bytes);

/* PXR24 of one line of a channel: the upper 24 bits of each float as its difference from the one before, the highest
 * bytes of all first. */
void retex_exr_pxr24_difference(unsigned char *restrict out, const unsigned char *restrict raw, size_t width);
/* The reverse. */
void retex_exr_pxr24_accumulate(unsigned char *restrict raw, const unsigned char *restrict in, size_t width);

#endif
