/* The one way any output file is written: under a temporary name (or none at all yet), renamed when complete. */
#ifndef RETEX_IO_OUTPUT_H
#define RETEX_IO_OUTPUT_H

#include <stddef.h>
#include <stdint.h>
#include <retex/error.h>

typedef struct RetexOutput RetexOutput;

/* Begin writing path; "-" is standard output. Devices, pipes and whatever else is not a regular file are written
 * directly, a symbolic link is followed and its target replaced. Until retex_output_commit an older file of that name
 * stays whole, and a process that is killed leaves nothing behind where the file system can do without a name. */
int retex_output_open(RetexOutput **output, const char *path, RetexError *err);

/* Begin writing into memory. */
int retex_output_open_memory(RetexOutput **output, RetexError *err);
/* What has been written so, malloc'ed, the caller's to free. Nulls *output. */
int retex_output_take(RetexOutput **output, void **data, size_t *bytes, RetexError *err);

/* Whether path could be opened so, as far as one can tell without making anything: for before long work. */
int retex_output_check(const char *path, RetexError *err);

/* Append; buffered. */
int retex_output_write(RetexOutput *output, const void *data, size_t bytes, RetexError *err);

/* Whether path would be a regular file, of which parts may be written again. */
int retex_output_is_file(const char *path);
/* Write again, within what has been written already; of a regular file. */
int retex_output_patch(RetexOutput *output, uint64_t at, const void *data, size_t bytes, RetexError *err);

/* Flush, close, and put the file in its place. Nulls *output whatever happens; nothing partial is left on failure. */
int retex_output_commit(RetexOutput **output, RetexError *err);

/* Give up: close and remove what was written. NULL and pointers to NULL are fine. */
void retex_output_abandon(RetexOutput **output);

#endif
