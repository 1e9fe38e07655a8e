/* Variants of a glTF file, by KHR_materials_variants: each names materials in the place of those that some of the
 * meshes have. The scene gets the materials of none, or those of --variant. In the former case, what variants change of
 * colours and finishes alone is offered as targets of one render, and a table has all such variants. */
#ifndef RETEX_IMPORT_VARIANTS_H
#define RETEX_IMPORT_VARIANTS_H

#include "import/base/model.h"

/* Declare the finishes that variants have, and write the table; after the materials. */
int variants_write(Import *import, FILE *out, RetexError *err);
/* Tell which variants are in the table, and how the others are made. */
void variants_tell(const Import *import);

#endif
