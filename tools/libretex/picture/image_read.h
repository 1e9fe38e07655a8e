/* Reading of pictures for texture.c and for retex-decode. */
#ifndef RETEX_PICTURE_IMAGE_READ_H
#define RETEX_PICTURE_IMAGE_READ_H

#include "picture/decoder.h"

/* As retex_image_read, but 16-bit integers where the file has integers whose channels are decoded one by one. */
int retex_image_read_any(RetexDecoded *decoded, const char *path, const RetexReadParams *params, int nthreads,
                         RetexError *err);

/* Decode an open file in this process. params are complete; path is for messages, and the name for the bridge. */
int retex_image_decode(RetexDecoded *decoded, RetexDecode decode, RetexInput *input, const char *path,
                       const RetexReadParams *params, int nthreads, RetexError *err);

#endif
