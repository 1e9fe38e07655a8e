/* Deflate (RFC 1951) at ISA-L's fast level: several times as fast as zlib's fastest, a tenth longer. Private to
 * libretex. */
#ifndef LIBRETEX_DEFLATE_H
#define LIBRETEX_DEFLATE_H

#include <stddef.h>

/* Room that is always enough for so many bytes. */
size_t retex_deflate_room(size_t bytes);

/* Blocks of a raw stream that stand for bytes. The last ends the stream; otherwise what comes next begins at a whole
 * byte. Returns how many bytes they take, or 0 where they do not fit into room or memory is short. */
size_t retex_deflate(unsigned char *packed, size_t room, const unsigned char *bytes, size_t count, int is_last);

#endif
