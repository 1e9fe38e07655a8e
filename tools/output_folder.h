/* The folders that outputs go to, which need not be there yet. */
#ifndef RETEX_OUTPUT_FOLDER_H
#define RETEX_OUTPUT_FOLDER_H

#include <limits.h>

#include <retex/error.h>

/* What path leads to, absolute and without links, as far as it is there; *missing: how many of its folders are not.
 * A link in the place of the file that leads to nothing is what a file put there replaces. shown: its name in
 * messages. */
int output_resolve(char real[PATH_MAX], int *missing, const char *path, const char *shown, RetexError *err);
/* Whether a resolved path is in a resolved folder, or below it. */
int output_is_below(const char *real, const char *folder);
/* Make the folders of path that are missing. */
int output_make_folders(const char *path, RetexError *err);

#endif
