/* Files that windows send: models, textures. Each is written under a name that begins with a dot, and gets its own when
 * all of it has come. */
#ifndef RETEX_STUDIO_RECEIVED_H
#define RETEX_STUDIO_RECEIVED_H

#include <limits.h>
#include <stddef.h>
#include <stdint.h>

#include <retex/error.h>

#define RECEIVED_MOST ((uint64_t)16 << 30) /* bytes of a file */

typedef struct Received {
    int file;              /* + 1; 0: none is being received */
    uint64_t bytes;        /* so far */
    int top, parent;       /* open folders: that of all files, where it has its temporary name, and its own at last */
    char folder[PATH_MAX]; /* the path of its own */
    char name[NAME_MAX + 1];
    char temporary[64];
} Received;

/* Begin a file below an open folder, which is taken over, and whose path is `folder`. `name` is the window's: a file's,
 * or one with folders, which are made; what no file system should get is replaced. length: bytes that are announced, or
 * 0. RETEX_ELIMIT: it is too large; RETEX_EIO: it cannot be written, as on a disk that is full; RETEX_EACCESS: a link
 * is in its way. */
int received_begin(Received *received, int top, const char *folder, const char *name, uint64_t length, RetexError *err);
int received_bytes(Received *received, const void *data, size_t bytes, RetexError *err);
/* Give it its name, `path`. A file of that name with the same content is kept instead; one with another content stays,
 * and the new one gets a number: oak-2.jpg. */
int received_end(Received *received, char path[PATH_MAX], RetexError *err);
/* Remove what has come so far; after received_end, or before any other call, does nothing. */
void received_drop(Received *received);

/* Remove what servers that were killed have left in an open folder. */
void received_tidy(int top);

/* The name that a file gets below the folder: parts that lead upwards are left out, and characters replaced that some
 * system forbids. 0: nothing is left of it. */
int received_clean_name(const char *name, char *clean, size_t size);

#endif
