/* Deflate (RFC 1951) by runs of equal bytes and by how often bytes are, looking for no other repetitions: of noise,
 * filtered lines and differences it makes nearly as little as the search for them does, many times as fast. Private to
 * libretex. */
#ifndef LIBRETEX_DEFLATE_H
#define LIBRETEX_DEFLATE_H

#include <stddef.h>

/* Room that is always enough for so many bytes. */
size_t retex_deflate_room(size_t bytes);

/* Blocks of a raw stream that stand for bytes. The last ends the stream; otherwise an empty block brings what comes
 * next to a whole byte. Returns how many bytes they take, or 0 where they do not fit into room. */
size_t retex_deflate(unsigned char *packed, size_t room, const unsigned char *bytes, size_t count, int is_last);

#endif
