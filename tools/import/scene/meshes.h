/* Meshes: a mesh2 for each of the model's, declared once and placed by the objects of the scene. */
#ifndef RETEX_IMPORT_MESHES_H
#define RETEX_IMPORT_MESHES_H

#include "import/base/model.h"

int meshes_write(Import *import, FILE *out, RetexError *err);

#endif
