/* PNG files without OpenImageIO. Private to libretex. */
#ifndef RETEX_PICTURE_PNG_READ_H
#define RETEX_PICTURE_PNG_READ_H

#include "picture/levels.h"

/* Decode a whole file: RETEX_LEVELS_…. retex_levels_end must follow. */
int retex_png_read(RetexLevels *levels, const void *data, size_t bytes);
/* Whether its chunks are complete and have the right checksums. */
int retex_png_is_whole(const void *data, size_t bytes);

#endif
