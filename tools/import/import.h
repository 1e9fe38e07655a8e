/* retex-import: a model that Assimp reads becomes a scene in POV-Ray's language. All of it runs in a child process that
 * may crash; tools/retex-import.c starts and limits it. */
#ifndef RETEX_IMPORT_H
#define RETEX_IMPORT_H

#include <retex/error.h>

#include "import/base/options.h"

/* Write the scene's files. */
int import_model(const ImportOptions *options, RetexError *err);

#endif
