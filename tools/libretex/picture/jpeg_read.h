/* Textures from JPEG files without OpenImageIO, which takes a sixth of a second to load. Private to libretex. */
#ifndef RETEX_PICTURE_JPEG_READ_H
#define RETEX_PICTURE_JPEG_READ_H

#include "picture/bridge_load.h"
#include "io/input.h"

/* What retex_bridge_read_narrow would give for a file whose colours are sRGB. dst->pixels stays NULL where the file is
 * not a whole, upright JPEG of grey or three colours, or has more pixels than that (0: no limit): then the bridge has
 * to look at it, and to say what is wrong. Fails for want of memory only. */
int retex_jpeg_read_narrow(RetexNarrowImage *dst, RetexInput *input, long max_pixels, RetexError *err);

#endif
