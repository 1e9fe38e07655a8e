/* Images of a glTF file. */
#ifndef RETEX_IMPORT_GLTF_IMAGES_H
#define RETEX_IMPORT_GLTF_IMAGES_H

#include <jansson.h>

#include "import/base/model.h"

/* Tell of images that are lost. */
void gltf_note_images(Import *import, const json_t *json);

#endif
