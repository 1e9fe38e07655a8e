/* Files of a folder by their names without ending. */
#ifndef RETEX_SERVE_NAMES_H
#define RETEX_SERVE_NAMES_H

#include <retex/error.h>

/* Whether it is a folder: RETEX_OK, or RETEX_EIO. */
int names_check_folder(const char *folder, RetexError *err);

/* Call for each different name, sorted, of the regular files with one of these endings ("exr"; the list ends with NULL)
 * that a URL can name; endings NULL: of the folders. Not 0: the folder cannot be read, or there is no memory.
 * with_ending: 1: tell the whole name. */
int names_list(const char *folder, const char *const *endings, int with_ending,
               void (*tell)(void *context, const char *name), void *context);

#endif
