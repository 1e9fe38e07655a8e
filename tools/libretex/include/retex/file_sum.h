/* Checksums of files, to see whether they have changed. Not against those who want to deceive. */
#ifndef RETEX_FILE_SUM_H
#define RETEX_FILE_SUM_H

#include <stddef.h>
#include <stdint.h>
#include <retex/access.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

typedef struct RetexFileSum {
    uint64_t bytes;
    uint32_t crc; /* CRC-32 as in ZIP and PNG, and as crc32(1) prints */
} RetexFileSum;

/* The checksum of a regular file, which is read once. access: NULL = any file. */
int retex_file_sum(RetexFileSum *sum, const char *path, const RetexAccess *access, RetexError *err);
/* The CRC-32 of bytes in memory. so_far: that of the bytes before, 0 = none. */
uint32_t retex_bytes_sum(uint32_t so_far, const void *bytes, size_t count);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
