/* Checksums of zip, EXR's zlib streams and PNG, by ISA-L: those of zlib, several times as fast. Private to libretex. */
#ifndef RETEX_IO_CHECKSUM_H
#define RETEX_IO_CHECKSUM_H

#include <stddef.h>
#include <stdint.h>

/* Of all bytes so far; of none they are: */
#define CRC32_OF_NONE 0
#define ADLER32_OF_NONE 1
uint32_t retex_crc32(uint32_t so_far, const void *bytes, size_t count);
/* Of the bytes of both, of which the second are so many. */
uint32_t retex_crc32_join(uint32_t first, uint32_t second, size_t second_bytes);
uint32_t retex_adler32(uint32_t so_far, const void *bytes, size_t count);

#endif
