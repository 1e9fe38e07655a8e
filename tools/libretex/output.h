/* The one way any output file is written: under a temporary name (or none at all yet), renamed when complete. */
#ifndef RETEX_LIBRETEX_OUTPUT_H
#define RETEX_LIBRETEX_OUTPUT_H

#include <stddef.h>
#include <stdint.h>
#include <retex/error.h>

typedef struct RetexOutput RetexOutput;

/* Begin writing path; "-" is standard output. Devices, pipes and whatever else is not a regular file are written
 * directly, a symbolic link is followed and its target replaced. Until retex_output_commit an older file of that name
 * stays whole, and a process that is killed leaves nothing behind where the file system can do without a name. */
int retex_output_open(RetexOutput **output, const char *path, RetexError *err);

/* The same for a writer that insists on opening the file itself: *temporary is an empty file in the same folder whose
 * name keeps path's ending, valid until commit or abandon. RETEX_EUNSUPPORTED where path is not a regular file. */
int retex_output_open_named(RetexOutput **output, const char *path, const char **temporary, RetexError *err);

/* Append; buffered. */
int retex_output_write(RetexOutput *output, const void *data, size_t bytes, RetexError *err);

/* Flush, close, and put the file in its place. Nulls *output whatever happens; nothing partial is left on failure. */
int retex_output_commit(RetexOutput **output, RetexError *err);

/* Give up: close and remove what was written. NULL and pointers to NULL are fine. */
void retex_output_abandon(RetexOutput **output);

#endif
