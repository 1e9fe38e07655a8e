/* glTF files beside Assimp: what it leaves out of them, and why it cannot read them. */
#ifndef RETEX_IMPORT_GLTF_H
#define RETEX_IMPORT_GLTF_H

#include "import/base/model.h"

/* What Assimp leaves out, into import->gltf. */
int gltf_read(Import *import, RetexError *err);
/* Tell the names of the file's variants. */
int gltf_list_variants(const Import *import, RetexError *err);
/* Fail where this tool, or the file itself, says better than Assimp why it cannot be read. */
int gltf_explain(const Import *import, RetexError *err);
void gltf_free(Gltf *gltf);

#endif
