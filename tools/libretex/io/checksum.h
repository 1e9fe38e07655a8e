/* CRC-32 (ZIP, PNG) and Adler-32 (zlib streams), by ISA-L: the same values as zlib's, several times as fast. Private to
 * libretex. */
#ifndef RETEX_IO_CHECKSUM_H
#define RETEX_IO_CHECKSUM_H

#include <stddef.h>
#include <stdint.h>

/* Checksums of no bytes, to begin with; `so_far` is the checksum of all bytes before. */
#define CRC32_OF_NONE 0
#define ADLER32_OF_NONE 1
uint32_t retex_crc32(uint32_t so_far, const void *bytes, size_t count);
/* The checksum of two sequences of bytes joined; the second has second_bytes bytes. */
uint32_t retex_crc32_join(uint32_t first, uint32_t second, size_t second_bytes);
uint32_t retex_adler32(uint32_t so_far, const void *bytes, size_t count);

#endif
