/* Paths of output files whose folders may not exist yet. */
#ifndef RETEX_OUTPUT_FOLDER_H
#define RETEX_OUTPUT_FOLDER_H

#include <limits.h>

#include <retex/error.h>

/* Resolve path: absolute, with links resolved as far as the path exists. *missing: number of its folders that do not
 * exist. A dangling link in place of the file is accepted; the output replaces it. shown: the name in messages. */
int output_resolve(char real[PATH_MAX], int *missing, const char *path, const char *shown, RetexError *err);
/* Whether a resolved path is a resolved folder or below it. */
int output_is_below(const char *real, const char *folder);
/* Create the missing folders of path. */
int output_make_folders(const char *path, RetexError *err);
/* Remove a folder and all in it that is of its file system; no link is followed. */
void output_remove_folder(const char *path);

#endif
