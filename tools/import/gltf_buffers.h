/* Buffers of glTF files: the binary chunk, text of the file itself, or files beside it. */
#ifndef RETEX_IMPORT_GLTF_BUFFERS_H
#define RETEX_IMPORT_GLTF_BUFFERS_H

#include "import/internal.h"

typedef struct Bytes {
    unsigned char *bytes;
    size_t size;
} Bytes;

typedef struct GltfBuffers {
    Import *import;
    const json_t *json;
    FILE *in; /* where a .glb has its binary chunk next */
    int is_binary, inside_is_read;
    Bytes inside; /* that chunk */
    Bytes *named; /* all buffers of the file, where they were needed */
    size_t count;
} GltfBuffers;

/* NULL where there is none that can be read. */
const Bytes *gltf_buffer(GltfBuffers *buffers, size_t index);
/* Read the binary chunk, if there is one and it is not read yet. */
void gltf_buffers_read_inside(GltfBuffers *buffers);
void gltf_buffers_free(GltfBuffers *buffers);
/* `before` and the bytes as text, for the caller to free. NULL without memory. */
char *gltf_encode_base64(const Bytes *data, const char *before);

#endif
