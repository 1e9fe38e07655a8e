/* Variants of a glTF file, by KHR_materials_variants: each names materials in the place of those that some of the
 * meshes have. The scene gets the materials of none, or those of --variant. In the former case, what variants change of
 * colours and finishes alone is offered as targets of one render, and a table has all such variants. */
#ifndef RETEX_IMPORT_VARIANTS_H
#define RETEX_IMPORT_VARIANTS_H

#include "import/internal.h"

/* gltf_variants.c */

/* The names, one after the other, for --list-variants. */
void gltf_variants_list(const Import *import, const json_t *json);
/* Put the materials of one variant in the place of the file's, or, with variant = NULL, give surfaces that variants
 * change a material of their own and note them; variants may be NULL. Returns 1 where the file has changed. refused:
 * why it cannot be done, or untouched. */
int gltf_variants_take(json_t *json, const char *variant, Variants *variants, char refused[GLTF_REFUSED_SIZE]);
void gltf_variants_free(Variants *variants);

/* variants.c */

/* Declare the finishes that variants have, and write the table; after the materials. */
int variants_write(Import *import, FILE *out, RetexError *err);
/* Tell which variants are in the table, and how the others are made. */
void variants_tell(const Import *import);

#endif
