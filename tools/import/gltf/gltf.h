/* glTF files: what Assimp is given to read of them, what it leaves out, and why it cannot read them. */
#ifndef RETEX_IMPORT_GLTF_H
#define RETEX_IMPORT_GLTF_H

#include <jansson.h>

#include "import/base/model.h"

/* The file, or in its place one that says the same in words that Assimp reads well. NULL: it is refused (see
 * gltf_explain), or cannot be opened again. */
FILE *gltf_prepare(Import *import, FILE *in);

/* What Assimp leaves out, into import->gltf. */
int gltf_read(Import *import, RetexError *err);
/* Tell the names of the file's variants. */
int gltf_list_variants(const Import *import, RetexError *err);
/* Fail where this tool, or the file itself, says better than Assimp why it cannot be read. */
int gltf_explain(const Import *import, RetexError *err);
void gltf_free(Gltf *gltf);

/* Into import->gltf. Returns 0 without memory. */
int gltf_take_lights(Import *import, const json_t *json);
/* Returns 1 if there are any. */
int gltf_lights_write(Import *import, double user, FILE *out);

/* The names, one after the other, for --list-variants. */
void gltf_variants_list(const Import *import, const json_t *json);
/* Put the materials of one variant in the place of the file's, or, with variant = NULL, give surfaces that variants
 * change a material of their own and note them; variants may be NULL. Returns 1 where the file has changed. refused:
 * why it cannot be done, or untouched. */
int gltf_variants_take(json_t *json, const char *variant, Variants *variants, char refused[GLTF_REFUSED_SIZE]);
void gltf_variants_free(Variants *variants);

#endif
