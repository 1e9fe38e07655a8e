/* Signed URLs, as imgproxy has them with an empty salt: /SIGNATURE/v1/room/800x.jpg, where SIGNATURE is the HMAC-SHA256
 * of what follows it, from its slash on, path and query as they are sent, in base64url without padding. Of an image of
 * IIIF, /iiif/3/ID, it is that of this part alone, and holds for all that a viewer asks for below it. */
#ifndef RETEX_SERVE_KEYS_H
#define RETEX_SERVE_KEYS_H

#include <stddef.h>

#include <retex/error.h>

enum {
    KEYS_MAX = 8,
    KEY_BYTES_MIN = 16,
    KEY_BYTES_MAX = 64, /* more would be hashed to fewer */
    SIGNATURE_LENGTH = 43
};

/* Zero-initialized: none, and URLs are not signed. */
typedef struct Keys {
    int count;
    struct {
        unsigned char bytes[KEY_BYTES_MAX];
        size_t count;
    } keys[KEYS_MAX]; /* the first one signs, each of them may have signed */
} Keys;

/* Read a file of keys: one a line, in hexadecimal digits; lines that begin with # are comments. It must be none that
 * everybody may read. */
int keys_read(Keys *keys, const char *file, RetexError *err);

/* The signature of a path and query by the first key. Returns text. */
const char *keys_sign(const Keys *keys, const char *path, char text[SIGNATURE_LENGTH + 1]);

/* What follows the signature of a URL's path and query, from its slash on; all of it where there are no keys; NULL
 * where it is not signed by one of them. The time it takes does not depend on how much of a signature is right. */
const char *keys_check(const Keys *keys, const char *url);

/* What a log may have of a URL that keys_check refuses, which is changed: from where its path seems to begin, without
 * what may be a signature, or part of one. */
const char *keys_hide(char *url);

#endif
