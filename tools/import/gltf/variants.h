/* Variants of a glTF file, by KHR_materials_variants: see scene/variants.h. */
#ifndef RETEX_IMPORT_GLTF_VARIANTS_H
#define RETEX_IMPORT_GLTF_VARIANTS_H

#include <jansson.h>

#include "import/base/model.h"

/* The names, one after the other, for --list-variants. */
void gltf_variants_list(const Import *import, const json_t *json);
/* Put the materials of one variant in the place of the file's, or, with variant = NULL, give surfaces that variants
 * change a material of their own and note them; variants may be NULL. Returns 1 where the file has changed. refused:
 * why it cannot be done, or untouched. */
int gltf_variants_take(json_t *json, const char *variant, Variants *variants, char refused[GLTF_REFUSED_SIZE]);
void gltf_variants_free(Variants *variants);

#endif
