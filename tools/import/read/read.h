/* A model as Assimp reads it. */
#ifndef RETEX_IMPORT_READ_H
#define RETEX_IMPORT_READ_H

#include <stdio.h>

#include "import/base/model.h"

/* Read the model, and see that there are surfaces in it. */
int assimp_read(Import *import, RetexError *err);
/* Whether that is a glTF file, by its name. */
int assimp_is_gltf(const char *path);
/* A file of materials without lines that Assimp refuses: another stream in place of it, or the same. */
FILE *mtl_prepare(FILE *in);
/* Shape keys, into Assimp's meshes */
int morphs_apply(Import *import, RetexError *err);
/* What 3DS files say of cameras, into Assimp's cameras */
void tds_read(Import *import);
/* Where cameras and lights are that Assimp has read: it tells their nodes by names, which may be the same. Those that
 * cannot be told apart are left out, and told. */
int places_find(Import *import, RetexError *err);

#endif
