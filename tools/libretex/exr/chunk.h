/* What an EXR file stores of 16 lines of a part: samples as halves or floats, line by line, in each line plane by
 * plane, planes in alphabetical order; one chunk of EXR's ZIP. */
#ifndef RETEX_EXR_CHUNK_H
#define RETEX_EXR_CHUNK_H

#include <stdint.h>
#include <retex/set.h>

#include "exr/zip.h"

enum {
    RETEX_EXR_LETTERS_MAX = 7,  /* channels of a part that we write or read at once */
    RETEX_CHUNK_LINES = 16      /* what EXR's ZIP takes as one chunk */
};

typedef struct RetexChunkShape {
    const char *letters;        /* one for each channel, in the order of samples in memory */
    RetexPixelType type;
    int width, lines;
} RetexChunkShape;

/* What one thread needs for chunk after chunk. Begin with {0}. */
typedef struct RetexChunkScratch {
    RetexZip zip;
    unsigned char *raw; /* room for a chunk, after retex_chunk_reserve */
    uint16_t *halves;   /* one line, interleaved */
    size_t raw_bytes, halves_count;
} RetexChunkScratch;

/* Of one plane, and of all. */
size_t retex_chunk_plane(const RetexChunkShape *shape);
size_t retex_chunk_bytes(const RetexChunkShape *shape);

/* 0 where memory is short. */
int retex_chunk_reserve(RetexChunkScratch *scratch, const RetexChunkShape *shape);
void retex_chunk_free(RetexChunkScratch *scratch);

/* From floats, line by line and interleaved, to what is stored, before compression; crc gets the checksum of each plane
 * in the order of letters. */
void retex_chunk_encode(RetexChunkScratch *scratch, const RetexChunkShape *shape, const float *pixels,
                        unsigned char *raw, uint32_t *crc);
/* And back. */
void retex_chunk_decode(RetexChunkScratch *scratch, const RetexChunkShape *shape, const unsigned char *raw,
                        float *pixels);

/* Compress, into room for as many bytes as there are. How many it takes: all of them where nothing is gained. */
size_t retex_chunk_compress(RetexChunkScratch *scratch, const unsigned char *raw, size_t bytes, unsigned char *packed);
/* And back. 0 where it is damaged. */
int retex_chunk_decompress(RetexChunkScratch *scratch, const unsigned char *packed, size_t packed_bytes,
                           unsigned char *raw, size_t bytes);

#endif
