/* Input files: read by position, from several threads, also where the input is a pipe. All input files are read through
 * this. */
#ifndef RETEX_IO_INPUT_H
#define RETEX_IO_INPUT_H

#include <stddef.h>
#include <stdint.h>
#include <retex/access.h>
#include <retex/error.h>

typedef struct RetexInput RetexInput;

/* Open path; "-" is standard input. What cannot be read by position (pipes, terminals) is read whole, into
 * memory or, beyond 64 MiB, into a temporary file in $TMPDIR or /tmp. */
int retex_input_open(RetexInput **input, const char *path, RetexError *err);
/* The same, for files that access allows; "-" is standard input here too. */
int retex_input_open_allowed(RetexInput **input, const char *path, const RetexAccess *access, RetexError *err);
/* Use an open regular file, which stays the caller's, from its beginning. */
int retex_input_open_descriptor(RetexInput **input, int descriptor, const char *name, RetexError *err);
/* Use bytes in memory as an input; they stay the caller's. name: for messages. */
int retex_input_borrow(RetexInput **input, const void *data, size_t bytes, const char *name, RetexError *err);
/* Use some bytes of an input as one of its own. The whole input stays the caller's, open until the window is closed. */
int retex_input_window(RetexInput **window, const RetexInput *whole, uint64_t offset, uint64_t bytes, const char *name,
                       RetexError *err);
void retex_input_close(RetexInput **input); /* NULL and pointers to NULL are fine */

const char *retex_input_name(const RetexInput *input); /* for messages: the path, or "standard input" */
uint64_t retex_input_size(const RetexInput *input);    /* bytes */
int retex_input_descriptor(const RetexInput *input);   /* the input's own file descriptor; -1 where there is none */

/* Read up to `bytes` bytes at offset. Returns how many were read, fewer only at the end, or -1 with errno set.
 * Thread-safe. */
int64_t retex_input_read(const RetexInput *input, void *buffer, size_t bytes, uint64_t offset);

/* Correct the status of an operation on the content. RETEX_OK and RETEX_EFORMAT hold only if every read succeeded: if
 * one failed, the result is RETEX_EIO with a message about that. Any other status is returned unchanged. */
int retex_input_check(const RetexInput *input, int status, RetexError *err);

/* Load the whole input into memory, which the input owns. */
int retex_input_load(RetexInput *input, const void **data, size_t *bytes, RetexError *err);

#endif
