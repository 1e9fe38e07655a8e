/* Temporary files without a name, which vanish with the process: for data too large for memory. Private to libretex. */
#ifndef RETEX_IO_TEMPORARY_H
#define RETEX_IO_TEMPORARY_H

#include <limits.h>
#include <stdint.h>

/* The name of such a file in messages. */
typedef char RetexTemporaryName[PATH_MAX + 32];

/* Returns a descriptor for reading and writing, or -1 with errno set. The file lies in the folder of `near`, where that
 * is the path of a file to be written, else in $TMPDIR or /tmp. */
int retex_temporary_open(const char *near /* or NULL */, RetexTemporaryName shown);

#endif
