/* Deflate (RFC 1951) by ISA-L, which is several times as fast as zlib. Private to libretex. */
#ifndef RETEX_IO_DEFLATE_H
#define RETEX_IO_DEFLATE_H

#include <stddef.h>

/* Room that is always enough for so many bytes. */
size_t retex_deflate_bound(size_t bytes);

/* Bytes of memory that deflating or inflating works in; what they hold before and after tells nothing. The functions
 * below take such memory as scratch, or allocate it where scratch is NULL. */
size_t retex_deflate_scratch_bytes(void);

/* A piece of a raw stream that stands for bytes, at a level that takes little time: of noise a longer search finds no
 * more. The last piece ends the stream; otherwise what comes next begins at a whole byte. Returns how many bytes it
 * takes, or 0 where it does not fit into capacity or memory is short. */
size_t retex_deflate(void *scratch, unsigned char *packed, size_t capacity, const unsigned char *bytes, size_t count,
                     int is_last);

/* The same without looking for anything: a little larger than the bytes are. */
size_t retex_deflate_stored(unsigned char *packed, size_t capacity, const unsigned char *bytes, size_t count,
                            int is_last);

/* A zlib stream (RFC 1950: head, raw stream, Adler-32) back into exactly count bytes. Returns 1, or 0 where it is
 * damaged, stands for less or more, or memory is short. */
int retex_inflate(void *scratch, unsigned char *bytes, size_t count, const unsigned char *packed, size_t packed_bytes);

#endif
