/* A folder of a test program's own, for the files that it makes. */
#ifndef LIB_FOLDER_H
#define LIB_FOLDER_H

#include <stddef.h>

/* Where it is, from test_make_folder to test_remove_folder; and a file in it that needs no name of its own. */
extern char test_folder[32];
extern char test_own_file[48];

/* cmocka's setup and teardown of a group or a test; state is not used. Whatever lies in the folder goes with it. */
int test_make_folder(void **state);
int test_remove_folder(void **state);

/* The path of a file in the folder, until seven others were asked for. */
const char *test_in_folder(const char *name);

/* A file's bytes, for the caller to free; the test fails where it cannot be read. */
unsigned char *test_read_file(const char *path, size_t *bytes);

/* How many files are in it, hidden ones too. */
int test_files_left(void);

#endif
