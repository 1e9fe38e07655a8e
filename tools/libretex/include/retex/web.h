/* A set as a folder that web browsers read: light as JPEG, footprints as zlib streams, and a manifest, room.json. See
 * retex-web(5). */
#ifndef RETEX_WEB_H
#define RETEX_WEB_H

#include <stddef.h>
#include <retex/set.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

#define RETEX_WEB_SMALLER 4

/* Begin with RETEX_WEB_INIT. */
typedef struct RetexWebParams {
    size_t size;
    int quality; /* 1..100, default 60: as of packs, but pictures are not measured */
    int lamps;   /* 1..RETEX_PARAMETERS_MAX, default 4: most lamps that visitors can change, `rest` not counted; the
                    light of the dimmest others is added to that of `rest` */
    RetexWarn *note; /* told, in the calling thread, which lamps there are, what their file takes, and which of them
                        joined `rest`; and what each smaller room takes; default NULL = nobody */
    void *note_context;
    int smaller[RETEX_WEB_SMALLER]; /* 2, 3, 4, 6 or 8, then 0: rooms beside it that are so many times smaller, as of
                                       retex_set_reduce, which browsers take for small screens; default none */
} RetexWebParams;
#define RETEX_WEB_INIT { sizeof(RetexWebParams), 60, 4, NULL, NULL, {0} }

/* What the files take, in bytes. */
typedef struct RetexWebBytes {
    size_t still; /* until the picture is shown: picture.jpg and the manifest */
    size_t first; /* until one target can be changed */
    size_t all;
} RetexWebBytes;

/* Write a set of layout footprints, compact or not, into a folder that exists. The manifest is written last. If it
 * fails, files that were written are removed. *bytes may be NULL. Sets without terms, or of another layout, are
 * refused. */
int retex_web_write(const RetexSet *set, const char *folder, const RetexWebParams *params /* NULL = defaults */,
                    RetexWebBytes *bytes, int nthreads /* 0 = all cores */, RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
