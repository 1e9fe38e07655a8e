/* Thumbnails of pictures, which are decoded as those of strangers: by a confined program, in few formats. They are kept
 * in memory, a bounded number of bytes. */
#ifndef RETEX_STUDIO_THUMBS_H
#define RETEX_STUDIO_THUMBS_H

#include <pthread.h>
#include <stddef.h>
#include <stdint.h>

#include <retex/access.h>
#include <retex/budget.h>

enum { THUMBS_KEPT = 1024, THUMBS_BYTES = 48 << 20, THUMBS_KEY = 64, THUMB_LEAST = 16, THUMB_MOST = 512 };

typedef struct Thumb {
    char key[THUMBS_KEY]; /* of the file as it is, and the size */
    void *data;
    size_t bytes;
    uint64_t used; /* when, as a count of uses */
} Thumb;

typedef struct Thumbs {
    pthread_mutex_t lock, decoding; /* decoding: one picture at a time */
    const RetexBudget *budget;
    Thumb kept[THUMBS_KEPT];
    size_t bytes;
    uint64_t uses;
} Thumbs;

void thumbs_open(Thumbs *thumbs, const RetexBudget *budget);
void thumbs_close(Thumbs *thumbs);
/* A JPEG of at most `size` pixels a side, which the caller frees; etag gets the key of its content. */
int thumbs_get(Thumbs *thumbs, const char *path, const RetexAccess *access, int size, void **data, size_t *bytes,
               char etag[THUMBS_KEY + 2], RetexError *err);

#endif
