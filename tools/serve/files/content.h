/* What files hold: a digest of the bytes that are decoded, for entity tags. The digest of a file is remembered by the
 * file's identity, so that it is not read again. Any thread may call. */
#ifndef RETEX_SERVE_CONTENT_H
#define RETEX_SERVE_CONTENT_H

#include <retex/access.h>

#include "serve/files/file_id.h"

enum { CONTENT_DIGEST = 16 };

typedef struct Contents Contents;

typedef struct Content {
    FileId id;                            /* of the file that was read */
    unsigned char digest[CONTENT_DIGEST]; /* the beginning of the SHA-256 of its bytes */
    int is_settled; /* another content would have another identity: the file is older than the ticks of its times */
} Content;

int contents_open(Contents **contents, RetexError *err);
void contents_close(Contents *contents);
/* The content of a file as far as it is remembered: 1, or 0. Reads nothing. */
int contents_find(Contents *contents, const FileId *id, Content *content);

/* The digest as text. */
const char *content_text(const Content *content, char text[2 * CONTENT_DIGEST + 1]);

enum { CONTENT_FILES = 2 }; /* that are decoded for one thing, at most: an image and what lies on it */

/* Files that are being decoded, one after the other. Begin with {.contents = contents, .most = number of files}; their
 * access tells content_read which file is opened. content_end says whether they still hold what they did, RETEX_EIO if
 * not, and must be called once. `read` are the contents of `count` files, which are less than most where one file is
 * read twice. */
typedef struct ContentReading {
    Contents *contents;
    int most, count;
    Content read[CONTENT_FILES];
    int files[CONTENT_FILES];
} ContentReading;
int content_read(void *reading, int descriptor, RetexError *err);
int content_end(ContentReading *reading, RetexError *err);

#endif
