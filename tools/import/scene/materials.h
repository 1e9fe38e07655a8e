/* Materials: textures of the scene. */
#ifndef RETEX_IMPORT_MATERIALS_H
#define RETEX_IMPORT_MATERIALS_H

#include "import/base/model.h"

/* The finish of one of the model's materials on surfaces of another one, `to`: "finish { … }", to be freed. */
int materials_finish(Import *import, int index, ImportMaterial *to, char **text, RetexError *err);
int materials_write(Import *import, FILE *out, RetexError *err);
/* The names of the model's materials, for people; at the end of what is declared. */
int materials_write_names(Import *import, FILE *out, RetexError *err);

#endif
