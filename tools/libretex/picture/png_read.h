/* PNG files without OpenImageIO. Private to libretex. */
#ifndef RETEX_PICTURE_PNG_READ_H
#define RETEX_PICTURE_PNG_READ_H

#include "picture/levels.h"

/* Decode a whole file: RETEX_LEVELS_…. retex_levels_end must follow. */
int retex_png_read(RetexLevels *levels, const void *data, size_t bytes);
/* Whether its chunks are complete and have the right checksums. */
int retex_png_is_whole(const void *data, size_t bytes);
/* Whether libpng finds damage in a whole file. Of a picture of more than max_pixels, unless that is 0, only what comes
 * before the pixels is read. */
int retex_png_is_damaged(const void *data, size_t bytes, long max_pixels, RetexDamage damage);

#endif
