/* The format of a picture file, by its content: for safe access, where it chooses the decoder. */
#ifndef RETEX_PICTURE_IMAGE_FORMAT_H
#define RETEX_PICTURE_IMAGE_FORMAT_H

#include "io/input.h"

#define RETEX_IMAGE_FORMATS "PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR"

/* OpenImageIO's name of the format, or NULL where the content is none of these formats. The name of the input matters
 * for TGA only. */
const char *retex_image_format(const RetexInput *input);

/* The number of pixels of a GIF or BMP by its header, because OpenImageIO allocates them all before it tells the size.
 * 0 for other formats. */
uint64_t retex_image_header_pixels(const RetexInput *input, const char *format /* or NULL */);

/* Whether a JPEG has more scans than so many: each may take as long as the whole picture. */
int retex_image_has_more_scans(const RetexInput *input, int most);

#endif
