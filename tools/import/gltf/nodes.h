/* Nodes of a glTF file. */
#ifndef RETEX_IMPORT_GLTF_NODES_H
#define RETEX_IMPORT_GLTF_NODES_H

#include <jansson.h>

#include "import/base/model.h"

/* A node of the scene that the file shows. */
typedef struct GltfNode {
    const json_t *json;
    Affine place; /* z not mirrored */
    int is_shown; /* neither it nor a node above it is hidden by KHR_node_visibility */
} GltfNode;
/* Returns 0 to stop. */
typedef int GltfVisit(Import *import, const json_t *json, const GltfNode *node, void *context);
/* Whether the node says that it and all below it are hidden. */
int gltf_is_hidden(const json_t *node);
/* Returns 0 without memory, or where a visit stopped. */
int gltf_visit_nodes(Import *import, const json_t *json, GltfVisit *visit, void *context);
/* Its name, else that of the camera or light that it has, else its number. */
void gltf_node_name(const json_t *json, const json_t *node, const json_t *has, char name[TEXT_SIZE]);

#endif
