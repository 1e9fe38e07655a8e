/* Deflate (RFC 1951) by zlib, which is told to look for nothing but runs of equal bytes: of noise, filtered lines and
 * differences a search for other repetitions finds few. What is hardly shorter coded, as the low bytes of halves are
 * not, is stored as it is, in no time. Private to libretex. */
#ifndef LIBRETEX_DEFLATE_H
#define LIBRETEX_DEFLATE_H

#include <stddef.h>

/* Room that is always enough for so many bytes. */
size_t retex_deflate_room(size_t bytes);

/* Blocks of a raw stream that stand for bytes. give: by how much longer they may become, as a share of their length,
 * for being made in less time; 0..0.1. The last ends the stream; otherwise what comes next begins at a whole byte.
 * Returns how many bytes they take, or 0 where they do not fit into room or memory is short. */
size_t retex_deflate(unsigned char *packed, size_t room, const unsigned char *bytes, size_t count, double give,
                     int is_last);

#endif
