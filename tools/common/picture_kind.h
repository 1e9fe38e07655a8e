/* Kinds of picture files: how their names end, how they begin, and what they are on the web. */
#ifndef RETEX_PICTURE_KIND_H
#define RETEX_PICTURE_KIND_H

#include <stddef.h>

typedef struct PictureKind {
    const char *ending, *also; /* of names, without a dot, in lower case; the second may be NULL */
    const char *type;          /* media type */
    const char *mark;          /* bytes that stand `at` so many from the file's beginning; NULL: not known by them */
    size_t length, at;
} PictureKind;

/* By the ending of a name, whatever its case; NULL: it is none. */
const PictureKind *picture_kind_of_name(const char *name);
/* By a file's first bytes; NULL: it is none, or one that has no mark. */
const PictureKind *picture_kind_of_bytes(const void *bytes, size_t count);

/* The endings of what is read as a texture, also in safe access; the last one is NULL. */
extern const char *const picture_endings[];

#endif
