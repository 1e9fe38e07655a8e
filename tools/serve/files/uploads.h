/* Images that clients send, to be used as textures: files of a folder, named by the hash of their content. Each was
 * decoded once before it is there, within limits and in safe access, as textures are. They are deleted when they are
 * old. Any thread may call. */
#ifndef RETEX_SERVE_UPLOADS_H
#define RETEX_SERVE_UPLOADS_H

#include <retex/budget.h>

#include "serve/answer/answer.h"

/* SHA-256 in hexadecimal digits, and the end: nobody can make two images with one name. */
enum { UPLOAD_HASH_TEXT = 65 };

typedef struct Uploads Uploads;

typedef struct UploadsParams {
    const char *folder;   /* as realpath(3) gives it; no other server may write to it */
    size_t most_bytes;    /* of one image */
    uint64_t total_bytes; /* of all */
    int most;             /* number of all */
    double seconds;       /* that an image is kept; 0 = for ever */
    RetexBudget *budget;  /* memory of decoding, and pixels of an image */
    double decoding;      /* seconds that decoding an image may take */
} UploadsParams;

/* Removes what an earlier process did not complete. */
int uploads_open(Uploads **uploads, const UploadsParams *params, RetexError *err);
void uploads_close(Uploads *uploads); /* NULL is fine */

size_t uploads_most_bytes(const Uploads *uploads);

/* Begin to receive an image: 0 where too many are being received. */
int uploads_enter(Uploads *uploads);
/* Take so much more memory for it: 0 where those that are being received have too much. */
int uploads_take_memory(Uploads *uploads, size_t bytes);
/* It is received, or will not be: give back all that was taken for it. */
void uploads_leave(Uploads *uploads, size_t bytes);

/* Keep an image of this hash: 201 with its name as JSON, 200 if it was there already, whose time begins anew, or an
 * error: 413 for too many pixels, or what takes too much to decode, 415 for what is no image, 503 after the deadline, a
 * time of retex_clock_seconds, 507 where there is no place. */
Answer *uploads_keep(Uploads *uploads, const char *hash, const void *data, size_t bytes, double deadline);

/* Delete what is too old. To be called often; looks every few seconds. */
void uploads_sweep(Uploads *uploads);

typedef struct UploadsCount {
    int count;
    uint64_t bytes;
} UploadsCount;
UploadsCount uploads_count(Uploads *uploads);

#endif
