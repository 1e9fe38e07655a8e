/* Deflate (RFC 1951) by ISA-L, several times as fast as zlib. Private to libretex. */
#ifndef RETEX_IO_DEFLATE_H
#define RETEX_IO_DEFLATE_H

#include <stddef.h>

/* The largest size that `bytes` bytes may have when deflated. */
size_t retex_deflate_bound(size_t bytes);

/* The size of the scratch memory that deflating or inflating needs; its contents before and after do not matter. The
 * functions below use such memory as scratch, or allocate it where scratch is NULL. */
size_t retex_deflate_scratch_bytes(void);

/* Deflate bytes into a piece of a raw stream, at a fast level: in noise a longer search finds no more. The last piece
 * ends the stream; any other ends at a whole byte, where the next piece can begin. Returns the size of the piece, or 0
 * where it does not fit into capacity or memory is short. */
size_t retex_deflate(void *scratch, unsigned char *packed, size_t capacity, const unsigned char *bytes, size_t count,
                     int is_last);

/* The same with stored blocks, without compression: a little larger than the bytes are. */
size_t retex_deflate_stored(unsigned char *packed, size_t capacity, const unsigned char *bytes, size_t count,
                            int is_last);

/* Inflate a zlib stream (RFC 1950: header, raw stream, Adler-32) into exactly count bytes. Returns 1, or 0 where the
 * stream is damaged, has fewer or more bytes, or memory is short. */
int retex_inflate(void *scratch, unsigned char *bytes, size_t count, const unsigned char *packed, size_t packed_bytes);

#endif
