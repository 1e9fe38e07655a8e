/* Stored zips: what a pack is. Entries are laid down plainly, one after the other, without dates; a reader gets their
 * places and refuses whatever is not such a zip. Ordinary tools open them. */
#ifndef RETEX_PACK_ZIP_H
#define RETEX_PACK_ZIP_H

#include <stdint.h>

#include "io/input.h"
#include "io/output.h"

enum { PACK_NAME_MAX = 192 }; /* bytes of an entry's name, with the final NUL */

typedef struct ZipEntry {
    char name[PACK_NAME_MAX];
    uint64_t offset, bytes; /* of the data */
    uint32_t crc;
} ZipEntry;

typedef struct ZipList {
    int count, room;
    ZipEntry *entries;
} ZipList;

void zip_list_free(ZipList *list);
const ZipEntry *zip_list_find(const ZipList *list, const char *name); /* or NULL */

/* The entries of a zip, in the order of their data. They lie apart from each other, inside the input; compressed or
 * encrypted ones, names with a NUL and names that occur twice are refused. */
int zip_list_read(ZipList *list, const RetexInput *input, RetexError *err);

/* Append an entry; then, once, the directory. *written counts the bytes of all of it. */
int zip_entry_write(RetexOutput *output, ZipList *list, const char *name, const void *const *pieces,
                    const size_t *bytes, int count, uint64_t *written, RetexError *err);
int zip_directory_write(RetexOutput *output, const ZipList *list, uint64_t *written, RetexError *err);

#endif
