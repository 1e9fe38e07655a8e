/* The chunks of a band store, as they are copied into EXR files. */
#ifndef RETEX_EXR_BAND_STORE_CHUNKS_H
#define RETEX_EXR_BAND_STORE_CHUNKS_H

#include <retex/host/band_store.h>

#include "exr/chunk.h"

typedef struct RetexBandStoreChunk {
    uint64_t offset;
    uint32_t bytes; /* 0: all samples are stored as 0 */
    uint32_t nonzero;   /* 1: a pixel was not 0 */
    int pxr24;          /* 1: compressed by PXR24, 0: by ZIP */
    uint32_t crc[RETEX_EXR_LETTERS_MAX]; /* checksum of each plane, where bytes is not 0 */
    uint32_t bytes_crc;                  /* checksum of the compressed bytes */
} RetexBandStoreChunk;

const RetexBandStoreChunk *retex_band_store_chunk(const RetexBandStore *store, int image, int band);
/* Read the bytes of a chunk, which retex_chunk_compress made; RETEX_EFORMAT where they have changed. */
int retex_band_store_read(const RetexBandStore *store, const RetexBandStoreChunk *chunk, unsigned char *packed,
                          RetexError *err);

/* 1 if a file begins like a checkpoint. */
int retex_band_store_probe(const void *begin, size_t bytes);

#endif
