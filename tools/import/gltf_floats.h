#ifndef RETEX_IMPORT_GLTF_FLOATS_H
#define RETEX_IMPORT_GLTF_FLOATS_H

#include "import/gltf_buffers.h"

typedef struct GltfFloats {
    json_t *json;
    GltfBuffers buffers;
    Bytes floats;      /* of a new buffer, the last one */
    int any;           /* accessors were changed */
    char refused[GLTF_REFUSED_SIZE]; /* why the model is not what the file means, or "" */
} GltfFloats;

/* Make floats of the accessors of meshes that have integers. */
void gltf_floats_convert(GltfFloats *floats);

#endif
