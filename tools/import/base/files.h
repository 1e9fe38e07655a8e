/* Files that a model names: those in its folder and in the folders of -I, and no others. */
#ifndef RETEX_IMPORT_FILES_H
#define RETEX_IMPORT_FILES_H

#include "import/base/model.h"

int files_begin(Import *import, RetexError *err);
/* Find a file that the model names, in its folder and those of -I. RETEX_EACCESS: it is outside of them. found = 0: it
 * is nowhere. */
int files_find(Import *import, const char *name, char path[PATH_MAX], int *found, RetexError *err);

#endif
