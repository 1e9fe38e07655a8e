/* Textures from JPEG files without OpenImageIO, which takes a sixth of a second to load. Private to libretex. */
#ifndef RETEX_PICTURE_JPEG_READ_H
#define RETEX_PICTURE_JPEG_READ_H

#include "picture/bridge_load.h"
#include "io/input.h"

/* Read what retex_bridge_read_narrow would for a file whose colours are sRGB. dst->pixels stays NULL where the file is
 * not a complete, upright JPEG with one or three colours, or has more than max_pixels pixels (0: no limit): then the
 * bridge must read it and report problems. Fails for lack of memory only. */
int retex_jpeg_read_narrow(RetexNarrowImage *dst, RetexInput *input, long max_pixels, RetexError *err);

#endif
