/* Parts of glTF files that are compressed: they become bytes of a new buffer, and the file says nothing of the
 * compression any more. */
#ifndef RETEX_IMPORT_GLTF_DECODE_H
#define RETEX_IMPORT_GLTF_DECODE_H

#include "import/gltf/buffers.h"

typedef struct GltfDecode {
    json_t *json;
    GltfBuffers *buffers;            /* the bytes go to `decoded` of them */
    int any;                         /* something was compressed */
    char refused[GLTF_REFUSED_SIZE]; /* why the model cannot be read, or "" */
} GltfDecode;

/* meshopt.c: views of buffers, by EXT_meshopt_compression. */
void gltf_decode_views(GltfDecode *decode);
/* draco.c: primitives of meshes, by KHR_draco_mesh_compression. */
void gltf_decode_meshes(GltfDecode *decode);

#endif
