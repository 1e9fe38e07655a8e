/* The temporary folder of a test program. */
#ifndef LIB_FOLDER_H
#define LIB_FOLDER_H

#include <stddef.h>

/* Its path, from test_make_folder to test_remove_folder, and a file in it for general use. */
extern char test_folder[32];
extern char test_own_file[48];

/* Setup and teardown for cmocka, of a group or a test; state is not used. The folder is removed with all below it. */
int test_make_folder(void **state);
int test_remove_folder(void **state);

/* The path of a file in the folder. It is valid until seven others were requested. */
const char *test_in_folder(const char *name);

/* The bytes of a file, which the caller frees. The test fails if the file cannot be read. */
unsigned char *test_read_file(const char *path, size_t *bytes);

/* The number of files in the folder, including hidden ones. */
int test_files_left(void);

#endif
