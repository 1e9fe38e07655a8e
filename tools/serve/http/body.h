/* The body of an upload while it is received, in memory. */
#ifndef RETEX_SERVE_BODY_H
#define RETEX_SERVE_BODY_H

#include <nettle/sha2.h>

#include "serve/files/uploads.h"

/* Zero-initialized. */
typedef struct Body {
    Uploads *uploads;          /* NULL: none is being received */
    char *data;
    size_t bytes, size, taken; /* received; allocated; taken of the memory for uploads */
    size_t beyond;             /* bytes that came beyond the limit, and are not kept */
    int is_lost;               /* 1: there was no memory */
    struct sha256_ctx hash;
} Body;

/* Before an upload of so many bytes, as its header says, or NULL: an error, or NULL. */
Answer *body_begin(Body *body, Uploads *uploads, const char *content_length);
/* -1: it will not be an upload, and the connection is better closed. */
int body_add(Body *body, const void *data, size_t bytes);
/* All has come: what is wrong with it, or NULL, and its hash. */
Answer *body_complete(Body *body, char hash[UPLOAD_HASH_TEXT]);
void body_free(Body *body);

#endif
