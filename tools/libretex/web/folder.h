/* The files of a folder for browsers. Private to libretex. */
#ifndef RETEX_WEB_FOLDER_H
#define RETEX_WEB_FOLDER_H

#include <stdint.h>

#include <retex/set.h>

/* A name has the checksum of the content: new files never replace those of an older manifest, and caches may keep
 * them. */
typedef struct RetexWebFile {
    char name[RETEX_NAME_MAX + 16];
    unsigned char *data;
    size_t bytes;
    uint32_t crc;
    int is_old; /* a file of this name was there before */
} RetexWebFile;

/* Name a file by what it has: STEM-CHECKSUM.ENDING. */
void retex_web_file_name(RetexWebFile *file, const char *stem, const char *ending);

/* Write files, then room.json. Until that replaces an older one, the older and its files stay whole; then files that it
 * named are removed, and those of the smaller rooms that it named. If it fails, files that were written are removed. */
int retex_web_folder_write(const char *folder, RetexWebFile *const *files, int count, RetexWebFile *manifest,
                           RetexError *err);

#endif
