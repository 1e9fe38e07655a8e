/* One chunk of an EXR file with ZIP compression: 16 lines of a part. Samples are halves or floats, line by line, in
 * each line plane by plane, planes in alphabetical order. */
#ifndef RETEX_EXR_CHUNK_H
#define RETEX_EXR_CHUNK_H

#include <stdint.h>
#include <retex/set.h>

#include "exr/zip.h"

enum {
    RETEX_EXR_LETTERS_MAX = 7,  /* channels of a part that are written or read at once */
    RETEX_CHUNK_LINES = 16      /* lines that EXR's ZIP compresses together */
};

typedef struct RetexChunkShape {
    const char *letters;        /* a letter for each channel, in the order of samples in memory */
    RetexPixelType type;
    int width, lines;
} RetexChunkShape;

/* Scratch memory of one thread for chunks. Begin with {0}. */
typedef struct RetexChunkScratch {
    RetexZip zip;
    unsigned char *raw; /* memory for a chunk, after retex_chunk_reserve */
    uint16_t *halves;   /* one line, interleaved */
    size_t raw_bytes, halves_count;
} RetexChunkScratch;

/* Bytes of one plane, and of the whole chunk. */
size_t retex_chunk_plane(const RetexChunkShape *shape);
size_t retex_chunk_bytes(const RetexChunkShape *shape);

/* Allocate the scratch memory for a chunk; 0 where memory is short. */
int retex_chunk_reserve(RetexChunkScratch *scratch, const RetexChunkShape *shape);
void retex_chunk_free(RetexChunkScratch *scratch);

/* Convert floats, line by line and interleaved, to the chunk's samples, uncompressed. crc (or NULL) receives the
 * checksum of each plane in the order of letters. */
void retex_chunk_encode(RetexChunkScratch *scratch, const RetexChunkShape *shape, const float *pixels,
                        unsigned char *raw, uint32_t *crc);
/* Convert the samples of a chunk back to floats. */
void retex_chunk_decode(RetexChunkScratch *scratch, const RetexChunkShape *shape, const unsigned char *raw,
                        float *pixels);

/* 1 if PXR24 can store the samples of a chunk without loss, which then compresses them better than ZIP does. */
int retex_chunk_fits_pxr24(const RetexChunkShape *shape, const unsigned char *raw);

/* Compress a chunk, by ZIP or by PXR24, into packed, which has at least retex_chunk_bytes bytes. Returns the size: as
 * many where compression gains nothing and the chunk is stored as it is. */
size_t retex_chunk_compress(RetexChunkScratch *scratch, const RetexChunkShape *shape, int pxr24,
                            const unsigned char *raw, unsigned char *packed);
/* Decompress a chunk. Returns 0 where it is damaged. */
int retex_chunk_decompress(RetexChunkScratch *scratch, const RetexChunkShape *shape, int pxr24,
                           const unsigned char *packed, size_t packed_bytes, unsigned char *raw);

/* Have room for `want` elements of so many bytes; what was there is lost. 0: memory runs out. */
int retex_chunk_room(void **memory, size_t *have, size_t want, size_t unit);

#endif
