/* Which file a name stands for now: a file that is replaced or changed gets another identity. */
#ifndef RETEX_SERVE_FILE_ID_H
#define RETEX_SERVE_FILE_ID_H

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { FILE_ID_TEXT = 128 };

typedef struct FileId {
    unsigned long long device, inode, size;
    long long seconds, nanoseconds;               /* of the last modification */
    long long change_seconds, change_nanoseconds; /* of the last change of the file or its attributes */
} FileId;

static inline int file_id_of_status(FileId *id, const struct stat *info)
{
    if (!S_ISREG(info->st_mode))
        return -1;
    *id = (FileId){info->st_dev,          info->st_ino,         (unsigned long long)info->st_size, info->st_mtim.tv_sec,
                   info->st_mtim.tv_nsec, info->st_ctim.tv_sec, info->st_ctim.tv_nsec};
    return 0;
}

/* Return 0 and the identity of a regular file, else -1. */
static inline int file_id_of(FileId *id, const char *path)
{
    struct stat info;
    return stat(path, &info) != 0 ? -1 : file_id_of_status(id, &info);
}

static inline int file_id_of_descriptor(FileId *id, int descriptor)
{
    struct stat info;
    return fstat(descriptor, &info) != 0 ? -1 : file_id_of_status(id, &info);
}

static inline int file_id_is_same(const FileId *a, const FileId *b)
{
    return memcmp(a, b, sizeof *a) == 0; /* has no padding */
}

/* The identity as text, for keys of caches. */
static inline const char *file_id_text(const FileId *id, char text[FILE_ID_TEXT])
{
    snprintf(text, FILE_ID_TEXT, "%llx.%llx.%llx.%llx.%llx.%llx.%llx", id->device, id->inode, id->size,
             (unsigned long long)id->seconds, (unsigned long long)id->nanoseconds,
             (unsigned long long)id->change_seconds, (unsigned long long)id->change_nanoseconds);
    return text;
}

#endif
