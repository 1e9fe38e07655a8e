/* What a spool holds, for those who write it into a file. */
#ifndef RETEX_EXR_SPOOL_CHUNKS_H
#define RETEX_EXR_SPOOL_CHUNKS_H

#include <retex/spool.h>

#include "exr/chunk.h"

typedef struct RetexSpoolChunk {
    uint64_t offset;
    uint32_t bytes; /* 0: all samples are stored as 0 */
    uint32_t lit;   /* 1: a pixel was not 0 */
    uint32_t crc[RETEX_EXR_LETTERS_MAX]; /* of planes, where bytes is not 0 */
    uint32_t bytes_crc;                  /* of the bytes */
} RetexSpoolChunk;

const RetexSpoolChunk *retex_spool_chunk(const RetexSpool *spool, int image, int band);
/* Its bytes, as retex_chunk_pack left them; RETEX_EFORMAT where they are no longer. */
int retex_spool_read(const RetexSpool *spool, const RetexSpoolChunk *chunk, unsigned char *packed, RetexError *err);

/* 1 if a file begins like a journal. */
int retex_spool_probe(const void *begin, size_t bytes);

#endif
