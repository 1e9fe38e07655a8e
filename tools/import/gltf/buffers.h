/* Buffers of glTF files: the binary chunk, text of the file itself, or files beside it. */
#ifndef RETEX_IMPORT_GLTF_BUFFERS_H
#define RETEX_IMPORT_GLTF_BUFFERS_H

#include <jansson.h>

#include "import/base/model.h"

#define GLTF_NO_MEMORY "out of memory: reading it takes more than --max-memory"

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
    Bytes decoded; /* what compressed views and meshes become: a buffer behind those of the file */
    size_t decoded_index;
} GltfBuffers;

/* Room for `size` more bytes behind those that there are, from a multiple of 4 on; `at` is where it begins. NULL
 * without memory. */
unsigned char *gltf_extend(Bytes *data, size_t size, size_t *at);
/* A view of these bytes of a buffer, behind those of the file. Returns its index, or -1. */
json_int_t gltf_add_view(json_t *json, size_t buffer, size_t at, size_t size);
/* A property that is a whole number and not negative, or `otherwise` where it is not there. Returns 0 where it is no
 * such number. */
int gltf_get_size(const json_t *object, const char *key, size_t otherwise, size_t *size);
/* NULL where there is none that can be read. */
const Bytes *gltf_buffer(GltfBuffers *buffers, size_t index);
/* `size` bytes of a buffer from `at` on; NULL where they do not lie within it. */
const unsigned char *gltf_bytes(GltfBuffers *buffers, size_t index, size_t at, size_t size);
/* Read the binary chunk, if there is one and it is not read yet. */
void gltf_buffers_read_inside(GltfBuffers *buffers);
void gltf_buffers_free(GltfBuffers *buffers);
/* `before` and the bytes as text, for the caller to free. NULL without memory. */
char *gltf_encode_base64(const Bytes *data, const char *before);

#endif
