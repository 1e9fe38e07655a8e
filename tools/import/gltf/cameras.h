/* Cameras of a glTF file. */
#ifndef RETEX_IMPORT_GLTF_CAMERAS_H
#define RETEX_IMPORT_GLTF_CAMERAS_H

#include <jansson.h>

#include "import/base/model.h"

/* Into import->gltf. Returns 0 without memory. */
int gltf_take_cameras(Import *import, const json_t *json);

#endif
