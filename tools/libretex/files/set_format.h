/* The formats of files that hold a set, for all that reads them. Private to libretex. */
#ifndef RETEX_FILES_SET_FORMAT_H
#define RETEX_FILES_SET_FORMAT_H

#include <retex/set.h>

#include "io/input.h"

typedef struct RetexSetFormat {
    /* 1 if these first bytes of a file are of the format; NULL: whatever is of no other. */
    int (*probe)(const void *begin, size_t bytes);
    /* As retex_set_read_exr (set/read.h). */
    int (*open)(RetexInput **input, RetexSet **set, int open, int nthreads, RetexError *err);
    /* Compare all checksums, as retex_set_check. *input may be NULL afterwards. */
    int (*check)(RetexInput **input, int nthreads, RetexError *err);
} RetexSetFormat;

extern const RetexSetFormat retex_set_format_exr;

/* By a file's first bytes. */
const RetexSetFormat *retex_set_format_of(const RetexInput *input);

#endif
