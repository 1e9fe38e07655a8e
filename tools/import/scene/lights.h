/* Light sources of the scene. */
#ifndef RETEX_IMPORT_LIGHTS_H
#define RETEX_IMPORT_LIGHTS_H

#include "import/base/model.h"

int lights_write(Import *import, FILE *out, RetexError *err);

#endif
