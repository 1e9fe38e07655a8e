/* See deflate.h. */
#include "io/deflate.h"

#include <stdint.h>
#include <stdlib.h>

#include <isa-l/igzip_lib.h>
#include <libdeflate.h>

#include "io/checksum.h"

/* Level 6 makes sets 1.5 % smaller in 1.4 times the time, level 7 another .2 % in twice the time, and those from 10 on
 * 5 % in ten times. */
enum { ZLIB_LEVEL = 3, ZLIB_LEVEL_MOST = 12 };

/* Levels 1 and 2 are faster still, but their output depends on the address of their memory: the same picture would not
 * always make the same file. Blocks are of 16384 codes, so that the Huffman codes follow the data. */
enum { LEVEL = 3, LEVEL_BYTES = ISAL_DEF_LVL3_SMALL };

typedef struct RetexDeflater {
    struct isal_zstream stream;
    unsigned char level[LEVEL_BYTES];
} RetexDeflater;

static size_t deflate_piece(RetexDeflater *deflater, unsigned char *packed, size_t capacity, const unsigned char *bytes,
                            size_t count, int is_last)
{
    struct isal_zstream *stream = &deflater->stream;
    if (count > UINT32_MAX || capacity > UINT32_MAX)
        return 0;
    isal_deflate_stateless_init(stream);
    stream->hist_bits = 0; /* search the whole window of 32 KB; isal_deflate_stateless_init leaves the old value */
    stream->level = LEVEL, stream->level_buf = deflater->level, stream->level_buf_size = LEVEL_BYTES;
    stream->end_of_stream = is_last, stream->flush = is_last ? NO_FLUSH : FULL_FLUSH;
    stream->next_in = (uint8_t *)bytes, stream->avail_in = (uint32_t)count;
    stream->next_out = packed, stream->avail_out = (uint32_t)capacity;
    return isal_deflate_stateless(stream) == COMP_OK && stream->avail_in == 0 ? stream->total_out : 0;
}

int retex_zlib_open(RetexZlib *zlib)
{
    if (!zlib->compressor)
        zlib->compressor = libdeflate_alloc_compressor(ZLIB_LEVEL);
    if (!zlib->decompressor)
        zlib->decompressor = libdeflate_alloc_decompressor();
    if (zlib->fast && !zlib->deflater)
        zlib->deflater = malloc(sizeof *zlib->deflater);
    return zlib->compressor && zlib->decompressor && (zlib->deflater || !zlib->fast);
}

void retex_zlib_close(RetexZlib *zlib)
{
    libdeflate_free_compressor(zlib->compressor);
    libdeflate_free_decompressor(zlib->decompressor);
    free(zlib->deflater);
    *zlib = (RetexZlib){.fast = 0};
}

/* RFC 1950 around a raw stream. */
static size_t compress_fast(RetexDeflater *deflater, unsigned char *packed, size_t capacity, const unsigned char *bytes,
                            size_t count)
{
    enum { HEAD = 2, TAIL = 4 };
    if (capacity <= HEAD + TAIL)
        return 0;
    const size_t raw = deflate_piece(deflater, packed + HEAD, capacity - HEAD - TAIL, bytes, count, 1);
    if (!raw)
        return 0;
    const uint32_t sum = retex_adler32(ADLER32_OF_NONE, bytes, count);
    packed[0] = 0x78, packed[1] = 0x01; /* deflate, 32 KB, fastest */
    for (int k = 0; k < TAIL; k++)
        packed[HEAD + raw + (size_t)k] = (unsigned char)(sum >> (24 - 8 * k));
    return HEAD + raw + TAIL;
}

size_t retex_zlib_compress(RetexZlib *zlib, unsigned char *packed, size_t capacity, const unsigned char *bytes,
                           size_t count)
{
    return zlib->fast ? compress_fast(zlib->deflater, packed, capacity, bytes, count)
                      : libdeflate_zlib_compress(zlib->compressor, bytes, count, packed, capacity);
}

unsigned char *retex_zlib_compress_most(const unsigned char *bytes, size_t count, size_t *packed_bytes)
{
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(ZLIB_LEVEL_MOST);
    const size_t capacity = compressor ? libdeflate_zlib_compress_bound(compressor, count) : 0;
    unsigned char *packed = compressor ? malloc(capacity) : NULL;
    *packed_bytes = packed ? libdeflate_zlib_compress(compressor, bytes, count, packed, capacity) : 0;
    libdeflate_free_compressor(compressor);
    return packed;
}

int retex_zlib_decompress(RetexZlib *zlib, unsigned char *bytes, size_t count, const unsigned char *packed,
                          size_t packed_bytes)
{
    return libdeflate_zlib_decompress(zlib->decompressor, packed, packed_bytes, bytes, count, NULL) ==
           LIBDEFLATE_SUCCESS;
}

size_t retex_deflate_bound(size_t bytes)
{
    return bytes + bytes / 64 + 512; /* stored blocks of 65535 bytes take less */
}

size_t retex_deflate(unsigned char *packed, size_t capacity, const unsigned char *bytes, size_t count, int is_last)
{
    RetexDeflater *deflater = malloc(sizeof *deflater);
    const size_t packed_bytes = deflater ? deflate_piece(deflater, packed, capacity, bytes, count, is_last) : 0;
    free(deflater);
    return packed_bytes;
}
