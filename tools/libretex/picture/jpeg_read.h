/* JPEG files without OpenImageIO. Private to libretex. */
#ifndef RETEX_PICTURE_JPEG_READ_H
#define RETEX_PICTURE_JPEG_READ_H

#include "picture/levels.h"

/* Decode a whole file: RETEX_LEVELS_…. retex_levels_end must follow. */
int retex_jpeg_read(RetexLevels *levels, const void *data, size_t bytes);
/* Whether libjpeg warns of damage in a whole file. It says nothing of files that it cannot decode. */
int retex_jpeg_is_damaged(const void *data, size_t bytes, RetexDamage damage);

#endif
