/* From the model's space to the scene's. */
#ifndef RETEX_IMPORT_WORLD_H
#define RETEX_IMPORT_WORLD_H

#include "import/base/model.h"

/* Called for every node with its transform, z not mirrored. Returns 0 without memory. */
typedef void ImportVisit(Import *import, const struct aiNode *node, const Affine *world, void *context);
int import_visit_nodes(Import *import, ImportVisit *visit, void *context);
/* Which axis is up, before nodes are placed. */
void import_set_world(Import *import, char up);
/* Multiply all lengths, before nodes are placed; cameras and lights of glTF are. */
void import_set_scale(Import *import, double scale);

#endif
