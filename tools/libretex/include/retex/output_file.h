/* Output files in general: one is complete or not there at all, however the process ends. */
#ifndef RETEX_OUTPUT_FILE_H
#define RETEX_OUTPUT_FILE_H

#include <stddef.h>
#include <retex/error.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Write a file of any kind as all outputs of the library are written: under a temporary name, renamed when complete; or
 * to "-", standard output. */
int retex_file_write(const char *path, const void *data, size_t bytes, RetexError *err);
/* Check whether a file of any kind, a set for example, could be written so, as far as that is known without creating
 * anything: to be called before the work that makes it. */
int retex_output_check(const char *path, RetexError *err);

/* Remove all pending files: outputs under temporary names that are not complete. For a process that ends in the middle
 * of its work, from any thread; no output can be completed afterwards. */
void retex_pending_files_remove(void);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
