/* Parts of a glTF file, which gltf.c and prepare.c go through. */
#ifndef RETEX_IMPORT_GLTF_PARTS_H
#define RETEX_IMPORT_GLTF_PARTS_H

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

/* Into import->gltf. Returns 0 without memory. */
int gltf_take_cameras(Import *import, const json_t *json);

/* Tell of images that are lost. */
void gltf_note_images(Import *import, const json_t *json);
/* Materials that shine by an image in no format that is read, which would be all of one light, are lit instead. Returns
 * 1 if there were any. */
int gltf_put_out_lost(json_t *json);

/* Why the file cannot be read, which may not refer to more than it has; or nothing. */
void gltf_check_indices(const json_t *json, char why[GLTF_REFUSED_SIZE]);
/* The same, of a file that makes more of its bytes than a scene needs. */
void gltf_check_sizes(const json_t *json, char why[GLTF_REFUSED_SIZE]);

#endif
