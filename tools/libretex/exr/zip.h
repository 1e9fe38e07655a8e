/* OpenEXR's ZIP compression of one chunk: bytes regrouped, differences taken, deflated. */
#ifndef RETEX_EXR_ZIP_H
#define RETEX_EXR_ZIP_H

#include <stddef.h>

/* What one thread needs to work on chunk after chunk. Begin with {0}. */
typedef struct RetexZip {
    unsigned char *scratch;
    size_t scratch_bytes;
    void *work;
} RetexZip;

/* Before chunks of up to so many bytes: all the memory that it takes. 0 where that is short. */
int retex_zip_need(RetexZip *zip, size_t bytes);

/* Compress bytes into packed, which has room for as many. Returns the packed size, or 0 where compression gains
 * nothing: then the chunk is to be stored as it is. */
size_t retex_zip_pack(RetexZip *zip, unsigned char *packed, const unsigned char *raw, size_t bytes);

/* Undo it. Returns 1, or 0 where packed is damaged or does not hold exactly bytes. */
int retex_zip_unpack(RetexZip *zip, unsigned char *raw, size_t bytes, const unsigned char *packed, size_t packed_bytes);

void retex_zip_free(RetexZip *zip);

#endif
