/* What Assimp is given to read. */
#ifndef RETEX_IMPORT_GLTF_PREPARE_H
#define RETEX_IMPORT_GLTF_PREPARE_H

#include "import/base/model.h"

/* The file, or in its place one that says the same in words that Assimp reads well. NULL: it is refused (see
 * gltf_explain), or cannot be opened again. */
FILE *gltf_prepare(Import *import, FILE *in);

#endif
