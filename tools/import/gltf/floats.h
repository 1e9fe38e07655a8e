#ifndef RETEX_IMPORT_GLTF_FLOATS_H
#define RETEX_IMPORT_GLTF_FLOATS_H

#include "import/gltf/buffers.h"

typedef struct GltfFloats {
    json_t *json;
    GltfBuffers buffers;
    Bytes floats;                    /* of a new buffer, the last one */
    int any;                         /* accessors were changed */
    char refused[GLTF_REFUSED_SIZE]; /* why the model is not what the file means, or "" */
} GltfFloats;

/* Make floats of the accessors of meshes that have integers. */
void gltf_floats_convert(GltfFloats *floats);

/* The elements of the accessor with that index, which are vectors of that width, as numbers of this machine; for the
 * caller to free. NULL where there are none, or more than `most`. */
float *gltf_floats_read(GltfFloats *floats, const json_t *index, size_t width, size_t most, size_t *count);
/* Nodes by EXT_mesh_gpu_instancing become nodes for each instance. Returns 1 if there are any. */
int gltf_place_instances(GltfFloats *floats);

#endif
