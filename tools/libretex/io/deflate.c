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
    return zlib->compressor && zlib->decompressor;
}

void retex_zlib_close(RetexZlib *zlib)
{
    libdeflate_free_compressor(zlib->compressor);
    libdeflate_free_decompressor(zlib->decompressor);
    *zlib = (RetexZlib){.fast = zlib->fast};
}

/* Level 0 of ISA-L has one fixed table of Huffman codes; of the same bytes it always makes the same stream. */
static size_t compress_fast(unsigned char *packed, size_t capacity, const unsigned char *bytes, size_t count)
{
    struct isal_zstream *stream = malloc(sizeof *stream);
    size_t packed_bytes = 0;

    if (!stream || count > UINT32_MAX || capacity > UINT32_MAX)
        goto done;
    isal_deflate_stateless_init(stream);
    stream->hist_bits = 0; /* as below */
    stream->gzip_flag = IGZIP_ZLIB;
    stream->end_of_stream = 1, stream->flush = NO_FLUSH;
    stream->next_in = (uint8_t *)bytes, stream->avail_in = (uint32_t)count;
    stream->next_out = packed, stream->avail_out = (uint32_t)capacity;
    if (isal_deflate_stateless(stream) == COMP_OK && stream->avail_in == 0)
        packed_bytes = stream->total_out;
done:
    free(stream);
    return packed_bytes;
}

size_t retex_zlib_compress(RetexZlib *zlib, unsigned char *packed, size_t capacity, const unsigned char *bytes,
                           size_t count)
{
    return zlib->fast ? compress_fast(packed, capacity, bytes, count)
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
