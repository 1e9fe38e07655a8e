/* ZIP files with stored entries only: the container of packs. Entries are written one after the other, uncompressed and
 * without dates. The reader returns their offsets and refuses any other ZIP file. Ordinary tools open them. */
#ifndef RETEX_PACK_ZIP_H
#define RETEX_PACK_ZIP_H

#include <stdint.h>

#include "io/input.h"
#include "io/output.h"

enum { RETEX_PACK_NAME_MAX = 192 }; /* bytes of an entry's name, with the final NUL */

typedef struct RetexZipEntry {
    char name[RETEX_PACK_NAME_MAX];
    uint64_t offset, bytes; /* of the data */
    uint32_t crc;
} RetexZipEntry;

typedef struct RetexZipList {
    int count, capacity;
    RetexZipEntry *entries;
} RetexZipList;

void retex_zip_list_free(RetexZipList *list);
const RetexZipEntry *retex_zip_list_find(const RetexZipList *list, const char *name); /* or NULL */

/* Read the directory of a ZIP file. Entries are sorted by offset. Refused: entries that overlap, end outside the file,
 * are compressed or encrypted, have a NUL in their name, or share a name. */
int retex_zip_list_read(RetexZipList *list, const RetexInput *input, RetexError *err);

/* Append an entry, made of `count` slices. After the last entry, write the directory once. *written: bytes so far. */
int retex_zip_entry_write(RetexOutput *output, RetexZipList *list, const char *name, const void *const *slices,
                          const size_t *bytes, int count, uint64_t *written, RetexError *err);
int retex_zip_directory_write(RetexOutput *output, const RetexZipList *list, uint64_t *written, RetexError *err);

#endif
