/* Lights of a glTF file. */
#ifndef RETEX_IMPORT_GLTF_LIGHTS_H
#define RETEX_IMPORT_GLTF_LIGHTS_H

#include <jansson.h>

#include "import/base/model.h"

/* Into import->gltf. Returns 0 without memory. */
int gltf_take_lights(Import *import, const json_t *json);
/* Returns 1 if there are any. */
int gltf_lights_write(Import *import, double user, FILE *out);

#endif
