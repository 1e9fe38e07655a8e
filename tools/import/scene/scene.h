/* What is written into the scene. */
#ifndef RETEX_IMPORT_SCENE_H
#define RETEX_IMPORT_SCENE_H

#include "import/base/model.h"

/* The finish of one of the model's materials on surfaces of another one, `to`: "finish { … }", to be freed. */
int materials_finish(Import *import, int index, ImportMaterial *to, char **text, RetexError *err);
int materials_write(Import *import, FILE *out, RetexError *err);
/* The names of the model's materials, for people; at the end of what is declared. */
int materials_write_names(Import *import, FILE *out, RetexError *err);

/* Declare the finishes that variants have, and write the table; after the materials. */
int variants_write(Import *import, FILE *out, RetexError *err);
/* Tell which variants are in the table, and how the others are made. */
void variants_tell(const Import *import);

int meshes_write(Import *import, FILE *out, RetexError *err);

int lights_write(Import *import, FILE *out, RetexError *err);

/* Whether the model is a room that no sky can light. */
int ceiling_is_needed(const Import *import, int *is_needed, RetexError *err);
/* A lamp below the ceiling of a room, if there is a place for it; of strength 0, it is off. */
int ceiling_write(Import *import, FILE *out, double strength, int *is_written, RetexError *err);

int cameras_write(Import *import, FILE *out, RetexError *err);

#endif
