/* What kind of picture a file is, by what is in it: for safe access, where that chooses the decoder. */
#ifndef RETEX_PICTURE_IMAGE_FORMAT_H
#define RETEX_PICTURE_IMAGE_FORMAT_H

#include "io/input.h"

#define RETEX_IMAGE_FORMATS "PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF or Radiance HDR"

/* OpenImageIO's name of the format, or NULL where it is none of these. The name of the input is looked at for TGA
 * alone. */
const char *retex_image_format(const RetexInput *input);

/* Pixels of a GIF or BMP, by its header: OpenImageIO makes room for all of them before it tells how many they are.
 * 0 of other formats. */
uint64_t retex_image_header_pixels(const RetexInput *input, const char *format /* or NULL */);

#endif
