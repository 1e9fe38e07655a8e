/* Numbers by which parts of a glTF file name each other. */
#ifndef RETEX_IMPORT_GLTF_INDICES_H
#define RETEX_IMPORT_GLTF_INDICES_H

#include <jansson.h>

#include "import/base/model.h"

/* Why the file cannot be read, which may not refer to more than it has; or nothing. */
void gltf_check_indices(const json_t *json, char why[GLTF_REFUSED_SIZE]);

#endif
