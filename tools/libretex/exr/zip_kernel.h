/* What OpenEXR's ZIP does to bytes before they are deflated, and back. Private to libretex. */
#ifndef RETEX_EXR_ZIP_KERNEL_H
#define RETEX_EXR_ZIP_KERNEL_H

#include <stddef.h>

/* Bytes at even places first, those at odd places after them. */
void retex_exr_zip_regroup(unsigned char *restrict out, const unsigned char *restrict raw, size_t bytes);
void retex_exr_zip_interleave(unsigned char *restrict raw, const unsigned char *restrict in, size_t bytes);

/* Each byte as its difference from the one before, plus 128; and the running sum of such, in place. */
void retex_exr_zip_difference(unsigned char *restrict out, const unsigned char *restrict in, size_t bytes);
void retex_exr_zip_accumulate(unsigned char *data, size_t bytes);

#endif
