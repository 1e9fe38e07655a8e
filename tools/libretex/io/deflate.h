/* Deflate (RFC 1951), several times as fast as zlib: small zlib streams by libdeflate; pieces of a stream, and streams
 * in less time, by ISA-L. Private to libretex. */
#ifndef RETEX_IO_DEFLATE_H
#define RETEX_IO_DEFLATE_H

#include <stddef.h>

/* How much time compression takes. Sizes and times are those of chunks of EXR, beside the first. */
typedef enum RetexZlibEffort {
    RETEX_ZLIB_SMALL, /* for sets, which are kept */
    RETEX_ZLIB_FAST,  /* for pictures: 0 to 8 % larger, a third of the time */
    RETEX_ZLIB_HURRY  /* for pipes: a quarter larger, a fifth of the time */
} RetexZlibEffort;

/* What one thread compresses and decompresses zlib streams with. Begin with zeros, or with another effort. */
typedef struct RetexZlib {
    RetexZlibEffort effort;
    struct libdeflate_compressor *compressor;
    struct libdeflate_decompressor *decompressor;
    struct RetexDeflater *deflater; /* of another effort than RETEX_ZLIB_SMALL */
} RetexZlib;

/* 0 where memory is short. Does nothing where all is there already. */
int retex_zlib_open(RetexZlib *zlib);
void retex_zlib_close(RetexZlib *zlib);

/* Compress bytes into a zlib stream (RFC 1950: header, raw stream, Adler-32). Returns its size, or 0 where it does not
 * fit into capacity. */
size_t retex_zlib_compress(RetexZlib *zlib, unsigned char *packed, size_t capacity, const unsigned char *bytes,
                           size_t count);

/* The same as small as possible, at ten times the time. A stream that the caller frees, or NULL where memory is
 * short. */
unsigned char *retex_zlib_compress_most(const unsigned char *bytes, size_t count, size_t *packed_bytes);

/* Decompress a zlib stream into exactly count bytes. Returns 1, or 0 where the stream is damaged, or has fewer or more
 * bytes. */
int retex_zlib_decompress(RetexZlib *zlib, unsigned char *bytes, size_t count, const unsigned char *packed,
                          size_t packed_bytes);

/* The largest size that a piece of `bytes` bytes may have. */
size_t retex_deflate_bound(size_t bytes);

/* Deflate bytes into a piece of a raw stream, at a fast level. The last piece ends the stream; any other ends at a
 * whole byte, where the next piece can begin. Returns the size of the piece, or 0 where it does not fit into capacity
 * or memory is short. */
size_t retex_deflate(unsigned char *packed, size_t capacity, const unsigned char *bytes, size_t count, int is_last);

#endif
