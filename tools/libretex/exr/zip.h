/* OpenEXR's ZIP compression of one chunk: bytes are regrouped, differenced and deflated. And its PXR24 compression of
 * floats, which stores 24 bits of each: here only of floats whose other 8 bits are 0, so that nothing is lost. */
#ifndef RETEX_EXR_ZIP_H
#define RETEX_EXR_ZIP_H

#include <stddef.h>

#include "io/deflate.h"

/* Scratch memory of one thread for chunks. Begin with {0}. */
typedef struct RetexZip {
    unsigned char *scratch;
    size_t scratch_bytes;
    RetexZlib zlib;
} RetexZip;

/* Allocate all scratch memory for chunks of up to so many bytes. 0 where memory is short. */
int retex_zip_reserve(RetexZip *zip, size_t bytes);

/* Compress bytes into packed, which has the same capacity. Returns the compressed size, or 0 where compression gains
 * nothing and the chunk must be stored as it is. */
size_t retex_zip_pack(RetexZip *zip, unsigned char *packed, const unsigned char *raw, size_t bytes);

/* Decompress. Returns 1, or 0 where packed is damaged or does not hold exactly `bytes` bytes. */
int retex_zip_unpack(RetexZip *zip, unsigned char *raw, size_t bytes, const unsigned char *packed, size_t packed_bytes);

/* 1 if the 8 lowest bits of all floats are 0. */
int retex_pxr24_fits(const unsigned char *raw, size_t bytes);
/* The same for PXR24; width: the number of floats in a line of a channel. */
size_t retex_pxr24_pack(RetexZip *zip, unsigned char *packed, const unsigned char *raw, size_t bytes, size_t width);
int retex_pxr24_unpack(RetexZip *zip, unsigned char *raw, size_t bytes, const unsigned char *packed,
                       size_t packed_bytes, size_t width);

void retex_zip_free(RetexZip *zip);

#endif
