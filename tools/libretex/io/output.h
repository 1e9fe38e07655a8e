/* Output files: written under a temporary name, or without a name, and renamed when complete. All output files are
 * written through this. */
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
/* The bytes written into memory, which the caller frees with free(). Nulls *output. */
int retex_output_take(RetexOutput **output, void **data, size_t *bytes, RetexError *err);

/* Append; buffered. */
int retex_output_write(RetexOutput *output, const void *data, size_t bytes, RetexError *err);

/* 1 if path is, or will be, a regular file, which retex_output_patch needs. */
int retex_output_is_file(const char *path);
/* Overwrite bytes that have been written already; of a regular file, or in memory. */
int retex_output_patch(RetexOutput *output, uint64_t at, const void *data, size_t bytes, RetexError *err);

/* Flush, close, and put the file at its path. Nulls *output whatever happens; on failure nothing partial is left. */
int retex_output_commit(RetexOutput **output, RetexError *err);

/* Give up: close and remove what was written. NULL and pointers to NULL are fine. */
void retex_output_abandon(RetexOutput **output);

#endif
