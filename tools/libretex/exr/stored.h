/* Parts of an open file whose chunks can be copied into another file as they are. Private to libretex. */
#ifndef RETEX_EXR_STORED_H
#define RETEX_EXR_STORED_H

#include "exr/decode.h"

/* A part whose chunks are as write.c makes them: 16 lines of the same channels, compressed by ZIP or PXR24. What they
 * decompress to has not been looked at: whoever reads the copy compares it with these checksums. */
typedef struct RetexExrStored {
    RetexExr *exr;
    int part, top, width, height;
    size_t pixel_bytes;
    int pxr24;             /* 1: compressed by PXR24, 0: by ZIP */
    uint32_t crc;          /* of the part, and */
    const uint32_t *bands; /* of its bands: as the file's manifest states them */
} RetexExrStored;

/* The chunks of a plan, whose request has all checksums. Returns 0 where they are otherwise and must be decoded. */
int retex_exr_stored_find(RetexExrStored *stored, RetexExr *exr, const RetexExrPlan *plan, RetexPixelType type);

/* Where the chunk of line y is in the file; 0: the file is damaged there. Thread-safe, as is reading. */
int retex_exr_stored_chunk(const RetexExrStored *stored, int y, uint64_t *offset, size_t *bytes);
int retex_exr_stored_read(const RetexExrStored *stored, uint64_t offset, size_t bytes, unsigned char *to,
                          RetexError *err);

/* The error of a part where the file is damaged. */
int retex_exr_stored_fail(const RetexExrStored *stored, RetexError *err);

#endif
