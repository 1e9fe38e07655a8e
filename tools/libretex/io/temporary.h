/* Files without a name, gone with the process: for what is too large to be kept in memory. Private to libretex. */
#ifndef RETEX_IO_TEMPORARY_H
#define RETEX_IO_TEMPORARY_H

#include <limits.h>
#include <stdint.h>

/* What such a file is called in messages. */
typedef char RetexTemporaryName[PATH_MAX + 32];

/* A descriptor for reading and writing, or -1 with errno set. The file lies in the folder of `near`, where that is the
 * path of a file to be, else in $TMPDIR or /tmp. */
int retex_temporary_open(const char *near /* or NULL */, RetexTemporaryName shown);

#endif
