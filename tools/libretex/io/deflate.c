/* See deflate.h. */
#include "io/deflate.h"

#include <stdint.h>
#include <stdlib.h>

#include <isa-l/igzip_lib.h>
#include <libdeflate.h>

#include "base/cpu.h"
#include "io/checksum.h"

/* Level 6 makes sets 1.5 % smaller in 1.4 times the time, level 7 another .2 % in twice the time, and those from 10 on
 * 5 % in ten times. */
enum { ZLIB_LEVEL = 3, ZLIB_LEVEL_MOST = 12 };

/* Level 0 has one fixed table of Huffman codes. Levels 1 and 2 are faster than 3, but their output depends on the
 * address of their memory: the same picture would not always make the same file. Blocks of level 3 are of
 * 16384 codes, so that the Huffman codes follow the data. */
enum { LEVEL = 3, LEVEL_BYTES = ISAL_DEF_LVL3_SMALL };

typedef struct RetexDeflater {
    struct isal_zstream stream;
    unsigned char level[LEVEL_BYTES];
} RetexDeflater;

/* By ISA-L at its level 0 or LEVEL. format: IGZIP_DEFLATE or IGZIP_ZLIB; flush: NO_FLUSH where the stream ends here, or
 * FULL_FLUSH. */
static size_t deflate_by_isal(RetexDeflater *deflater, unsigned char *packed, size_t capacity,
                              const unsigned char *bytes, size_t count, int level, int format, int flush)
{
    if (count > UINT32_MAX || capacity > UINT32_MAX)
        return 0;
    struct isal_zstream *stream = &deflater->stream;
    isal_deflate_stateless_init(stream);
    stream->hist_bits = 0; /* search the whole window of 32 KB; isal_deflate_stateless_init leaves the old value */
    stream->level = (uint32_t)level, stream->level_buf = deflater->level, stream->level_buf_size = LEVEL_BYTES;
    stream->gzip_flag = (uint16_t)format;
    stream->end_of_stream = flush == NO_FLUSH, stream->flush = (uint16_t)flush;
    stream->next_in = (uint8_t *)bytes, stream->avail_in = (uint32_t)count;
    stream->next_out = packed, stream->avail_out = (uint32_t)capacity;
    const int result = isal_deflate_stateless(stream);
    retex_cpu_clear_upper_halves();
    return result == COMP_OK && stream->avail_in == 0 ? stream->total_out : 0;
}

int retex_zlib_open(RetexZlib *zlib)
{
    if (!zlib->compressor)
        zlib->compressor = libdeflate_alloc_compressor(ZLIB_LEVEL);
    if (!zlib->decompressor)
        zlib->decompressor = libdeflate_alloc_decompressor();
    if (zlib->effort != RETEX_ZLIB_SMALL && !zlib->deflater)
        zlib->deflater = malloc(sizeof *zlib->deflater);
    return zlib->compressor && zlib->decompressor && (zlib->effort == RETEX_ZLIB_SMALL || zlib->deflater);
}

void retex_zlib_close(RetexZlib *zlib)
{
    libdeflate_free_compressor(zlib->compressor);
    libdeflate_free_decompressor(zlib->decompressor);
    free(zlib->deflater);
    *zlib = (RetexZlib){.effort = zlib->effort};
}

size_t retex_zlib_compress(RetexZlib *zlib, unsigned char *packed, size_t capacity, const unsigned char *bytes,
                           size_t count)
{
    return zlib->effort == RETEX_ZLIB_SMALL
               ? libdeflate_zlib_compress(zlib->compressor, bytes, count, packed, capacity)
               : deflate_by_isal(zlib->deflater, packed, capacity, bytes, count,
                                 zlib->effort == RETEX_ZLIB_FAST ? LEVEL : 0, IGZIP_ZLIB, NO_FLUSH);
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
    const int flush = is_last ? NO_FLUSH : FULL_FLUSH;
    const size_t piece =
        deflater ? deflate_by_isal(deflater, packed, capacity, bytes, count, LEVEL, IGZIP_DEFLATE, flush) : 0;
    free(deflater);
    return piece;
}
