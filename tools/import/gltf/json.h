/* The JSON of glTF files. */
#ifndef RETEX_IMPORT_GLTF_JSON_H
#define RETEX_IMPORT_GLTF_JSON_H

#include <stdint.h>
#include <stdio.h>
#include <jansson.h>

#include "import/base/names.h"

enum { GLTF_MAGIC = 0x46546c67, GLTF_JSON_CHUNK = 0x4e4f534a, GLTF_BINARY_CHUNK = 0x004e4942 };
uint32_t gltf_little(const unsigned char *bytes);
/* How many bytes of a file are left. */
size_t gltf_rest_of(FILE *in);
typedef struct GltfText {
    json_t *json;               /* of a .gltf or .glb file; NULL: there is none */
    int is_binary, is_repaired; /* repaired: Assimp does not read it as it is */
    char why[160];              /* there is no JSON although there should be */
} GltfText;
/* In a .glb, the binary chunk is next. */
GltfText gltf_load(FILE *in);
double gltf_number(const json_t *object, const char *key, double otherwise);
/* Whether something is so: Blender writes 1 for true. */
int gltf_flag(const json_t *object, const char *key);
const json_t *gltf_extension(const json_t *of, const char *name);
/* A material's name, or its place in the file. */
const char *gltf_material_name(const json_t *json, size_t index, char plain[NAME_SIZE]);
/* What extras of a node say for this tool, or NULL. */
const json_t *gltf_extras(const json_t *node);
/* The place in the file of a material of that name, which gltf_prepare has marked; *name becomes its own. -1: Assimp
 * made it. */
int gltf_material_place(const char **name);

#endif
