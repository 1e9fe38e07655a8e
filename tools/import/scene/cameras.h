/* The camera of the scene. */
#ifndef RETEX_IMPORT_CAMERAS_H
#define RETEX_IMPORT_CAMERAS_H

#include "import/base/model.h"

int cameras_write(Import *import, FILE *out, RetexError *err);

#endif
