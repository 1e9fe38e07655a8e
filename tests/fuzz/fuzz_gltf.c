/* glTF files as retex-import gives them to Assimp. The first line of an input is 'text' or 'binary'. What is written in
 * place of a file must be such a file again, in which no attribute of a mesh is of integers, unless a reason is given,
 * and every accessor that was made of one is not sparse and lies within the new buffer. Nothing in it is compressed. */
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <meshoptimizer.h>

#include "import/gltf/gltf.h"
#include "import/gltf/json.h"
#include "lib_fuzz.h"

/* A mesh of positions of 16 bits, normals and UV of 8, which are sparse in part; UV of floats, all of them sparse. */
static const char model[] =
    "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,"
    "\"TEXCOORD_0\":2,\"TEXCOORD_1\":3},\"targets\":[{\"POSITION\":0}]}]}],\"textures\":[{\"extensions\":{"
    "\"EXT_texture_webp\":{\"source\":0}}}],\"images\":[{\"uri\":\"a.webp\"}],\"accessors\":[{\"bufferView\":0,"
    "\"componentType\":5122,\"count\":3,\"type\":\"VEC3\",\"normalized\":true},{\"bufferView\":1,\"componentType\":"
    "5120,"
    "\"count\":3,\"type\":\"VEC3\",\"normalized\":true},{\"bufferView\":1,\"byteOffset\":1,\"componentType\":5121,"
    "\"count\":3,\"type\":\"VEC2\",\"sparse\":{\"count\":2,\"indices\":{\"bufferView\":2,\"componentType\":5121},"
    "\"values\":{\"bufferView\":3}}},{\"componentType\":5126,\"count\":3,\"type\":\"VEC2\",\"sparse\":{\"count\":1,"
    "\"indices\":{\"bufferView\":2,\"componentType\":5123},\"values\":{\"bufferView\":0,\"byteOffset\":2}}}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":24,\"byteStride\":8},{\"buffer\":0,\"byteOffset\":24,\"byteLength\":"
    "12,\"byteStride\":4},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":2},{\"buffer\":0,\"byteOffset\":38,"
    "\"byteLength\":4}],\"buffers\":[{\"byteLength\":42%s}]}";

/* Variants, of surfaces that share a material and that have none. */
static const char varied[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
    "\"materials\":[{\"name\":\"a\"},{\"name\":\"b\"},{}],\"extensions\":{\"KHR_materials_variants\":{"
    "\"variants\":[{\"name\":\"A\"},{"
    "\"name\":\"B\"}]}},\"meshes\":[{\"primitives\":[{\"attributes\":{},\"material\":0,\"extensions\":{"
    "\"KHR_materials_variants\":{\"mappings\":[{\"material\":1,\"variants\":[0]},{\"material\":2,"
    "\"variants\":[1,0]}]}}},{"
    "\"attributes\":{},\"material\":0},{\"attributes\":{},\"extensions\":{\"KHR_materials_variants\":{\"mappings\":[{"
    "\"material\":1,\"variants\":[1]}]}}}]}]}";

/* A mesh by Draco, one by meshoptimizer, whose nodes are instances of it, and a node that is hidden. The numbers are
 * the places and sizes of what begin() makes: Draco's data, and streams of positions, indices and rotations. */
static const char compressed[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0,1,2]}],\"nodes\":[{\"mesh\":0},{\"mesh\":1,"
    "\"extensions\":{"
    "\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":5,\"ROTATION\":6}}}},{\"mesh\":1,\"children\":[0],"
    "\"extensions\":{\"KHR_node_visibility\":{\"visible\":false}}}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
    "\"POSITION\":0,\"TEXCOORD_0\":1,\"NORMAL\":2},\"indices\":3,\"extensions\":{\"KHR_draco_mesh_compression\":{"
    "\"bufferView\":0,\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1,\"NORMAL\":2}}}}]},{\"primitives\":[{"
    "\"attributes\":{"
    "\"POSITION\":4},\"indices\":3}]}],\"accessors\":[{\"componentType\":5122,\"count\":4,\"type\":\"VEC3\","
    "\"normalized\":"
    "true},{\"componentType\":5121,\"count\":4,\"type\":\"VEC2\",\"normalized\":true},{\"componentType\":5120,"
    "\"count\":4,"
    "\"type\":\"VEC3\",\"normalized\":true},{\"bufferView\":2,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},{"
    "\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},{\"componentType\":5126,\"count\":4,"
    "\"type\":"
    "\"VEC3\"},{\"bufferView\":3,\"componentType\":5122,\"count\":4,\"type\":\"VEC4\",\"normalized\":true}],"
    "\"bufferViews\":["
    "{\"buffer\":0,\"byteOffset\":0,\"byteLength\":%zu},{\"buffer\":1,\"byteLength\":48,\"extensions\":{"
    "\"EXT_meshopt_compression\":{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"byteStride\":12,\"count\":4,"
    "\"mode\":"
    "\"ATTRIBUTES\",\"filter\":\"EXPONENTIAL\"}}},{\"buffer\":1,\"byteOffset\":48,\"byteLength\":12,\"extensions\":{"
    "\"EXT_meshopt_compression\":{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"byteStride\":2,\"count\":6,"
    "\"mode\":"
    "\"TRIANGLES\"}}},{\"buffer\":1,\"byteOffset\":60,\"byteLength\":32,\"extensions\":{\"EXT_meshopt_compression\":{"
    "\"buffer\":"
    "0,\"byteOffset\":%zu,\"byteLength\":%zu,\"byteStride\":8,\"count\":4,\"mode\":\"ATTRIBUTES\",\"filter\":"
    "\"QUATERNION\"}}}],"
    "\"buffers\":[{\"byteLength\":%zu},{\"byteLength\":92,\"extensions\":{\"EXT_meshopt_compression\":{\"fallback\":"
    "true}}}]}";

/* A card by Draco's encoder: positions of 16 bits, UV and normals of 8. */
static const unsigned char draco[] = {
    68,  82, 65,  67,  79,  2, 2, 1, 1, 0, 0, 0,  4, 2,  2, 2,  0, 0,  1,   31,  255, 1,   17,  255, 1, 17,
    255, 1,  17,  3,   255, 0, 0, 0, 0, 0, 1, 0,  0, 1,  0, 3,  3, 0,  0,   1,   1,   3,   2,   2,   0, 1,
    1,   1,  1,   1,   3,   0, 2, 1, 1, 1, 1, 0,  3, 3,  1, 48, 1, 16, 3,   0,   40,  130, 152, 0,   0, 0,
    0,   0,  255, 127, 0,   0, 1, 1, 1, 0, 3, 3,  1, 32, 1, 32, 3, 0,  240, 131, 166, 0,   0,   0,   0, 0,
    255, 0,  0,   0,   0,   1, 1, 0, 2, 3, 1, 64, 1, 0,  4, 0,  0, 0,  0,   0,   127, 0,   0,   0};

static void put(unsigned char *to, size_t word)
{
    for (int i = 0; i < 4; i++)
        to[i] = (unsigned char)(word >> 8 * i);
}

enum { TEXT = 4096, BINARY = 1024 };

/* A .glb of a text and bytes. */
static void seed_binary(const char *text, const unsigned char *bytes, size_t size)
{
    unsigned char file[TEXT + BINARY + 64] = "binary\n", *at = file + 7;
    size_t length = strlen(text);
    memcpy(at + 20, text, length);
    for (; length % 4; length++)
        at[20 + length] = ' ';
    const size_t words[] = {GLTF_MAGIC, 2, 28 + length + size, length, GLTF_JSON_CHUNK};
    for (int i = 0; i < 5; i++)
        put(at + (size_t)4 * (size_t)i, words[i]);
    put(at + 20 + length, size), put(at + 24 + length, GLTF_BINARY_CHUNK);
    memcpy(at + 28 + length, bytes, size);
    fuzz_seed(file, 7 + 28 + length + size);
}

static void seed_compressed(void)
{
    static const float positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0},
                       turns[] = {0, 0, 0, 1, 0, 0.6f, 0, 0.8f, 1, 0, 0, 0, 0, 0, 1, 0};
    static const unsigned indices[] = {0, 1, 2, 0, 2, 3};
    unsigned char bytes[BINARY] = {0}, filtered[48];
    char text[TEXT];
    size_t at[5] = {0, (sizeof draco + 3) / 4 * 4}, sizes[4] = {sizeof draco};
    memcpy(bytes, draco, sizeof draco);
    meshopt_encodeVertexVersion(0);
    for (int i = 1; i < 4; i++) {
        unsigned char *to = bytes + at[i];
        const size_t room = sizeof bytes - at[i];
        if (i == 1)
            meshopt_encodeFilterExp(filtered, 4, 12, 15, positions);
        else if (i == 3)
            meshopt_encodeFilterQuat(filtered, 4, 8, 12, turns);
        sizes[i] = i == 2 ? meshopt_encodeIndexBuffer(to, room, indices, 6)
                          : meshopt_encodeVertexBuffer(to, room, filtered, 4, i == 1 ? 12 : 8);
        at[i + 1] = (at[i] + sizes[i] + 3) / 4 * 4;
    }
    snprintf(text, sizeof text, compressed, sizes[0], at[1], sizes[1], at[2], sizes[2], at[3], sizes[3], at[4]);
    seed_binary(text, bytes, at[4]);
    fuzz_words(text, strlen(text));
}

static void begin(void)
{
    static const unsigned char zeros[44];
    char text[TEXT] = "text\n";
    snprintf(
        text + 5, sizeof text - 5, model,
        ",\"uri\":\"data:application/octet-stream;base64,AAAAAAAAAAD/fwAAAAAAAAAA/38AAAAAAAB/AAAAfwAAAH8AAAABAgMEBQ"
        "==\"");
    fuzz_seed(text, strlen(text));
    fuzz_words(text, strlen(text));
    snprintf(text, sizeof text, model, "");
    seed_binary(text, zeros, sizeof zeros);
    seed_compressed();
    seed_binary(varied, zeros, sizeof zeros);
    fuzz_words(varied, strlen(varied));
}

static FILE *file_of(const unsigned char *bytes, size_t size)
{
    const int descriptor = memfd_create("gltf", 0);
    FILE *file = fdopen(descriptor, "w+b");
    if (!file)
        abort();
    fwrite(bytes, 1, size, file);
    rewind(file);
    return file;
}

static const json_t *numbered(const json_t *of, const char *array, const json_t *index)
{
    return json_is_integer(index) && json_integer_value(index) >= 0
               ? json_array_get(json_object_get(of, array), (size_t)json_integer_value(index))
               : NULL;
}

static void check_accessor(const json_t *json, const char *name, const json_t *accessor)
{
    static const char *const floats[] = {"POSITION", "NORMAL", "TEXCOORD_"};
    const json_t *view = numbered(json, "bufferViews", json_object_get(accessor, "bufferView"));
    const json_t *buffer = numbered(json, "buffers", json_object_get(view, "buffer"));
    size_t i = 0;
    while (i < 3 && strncmp(name, floats[i], strlen(floats[i])) != 0)
        i++;
    if (i == 3 || !accessor)
        return;
    const json_int_t type = json_integer_value(json_object_get(accessor, "componentType"));
    fuzz_must(type < 5120 || type > 5125, "no attribute is of integers");
    const char *of = json_string_value(json_object_get(buffer, "name"));
    if (!of || strcmp(of, "floats") != 0)
        return; /* an accessor that stayed as it was */
    fuzz_must(!json_object_get(accessor, "sparse"), "it is not sparse");
    const char *kind = json_string_value(json_object_get(accessor, "type"));
    const json_int_t size = json_integer_value(json_object_get(accessor, "count")) * 4 * (kind[3] - '0');
    fuzz_must(size <= json_integer_value(json_object_get(view, "byteLength")) &&
                  json_integer_value(json_object_get(view, "byteOffset")) + size <=
                      json_integer_value(json_object_get(buffer, "byteLength")),
              "it lies within the new buffer");
}

static void check(const json_t *json)
{
    const json_t *meshes = json_object_get(json, "meshes"), *views = json_object_get(json, "bufferViews"), *mesh,
                 *primitive, *index, *view;
    size_t i, k;
    const char *name;
    json_array_foreach(views, i, view)
        fuzz_must(!gltf_extension(view, "EXT_meshopt_compression"), "no view is compressed");
    json_array_foreach(meshes, i, mesh)
    {
        const json_t *primitives = json_object_get(mesh, "primitives");
        json_array_foreach(primitives, k, primitive)
        {
            json_t *attributes = json_object_get(primitive, "attributes");
            fuzz_must(!gltf_extension(primitive, "KHR_draco_mesh_compression"), "no mesh is compressed");
            json_object_foreach(attributes, name, index) check_accessor(json, name, numbered(json, "accessors", index));
        }
    }
}

static int run(const unsigned char *bytes, size_t size)
{
    ImportOptions options = {.model = "model.gltf"};
    Import import = {.options = &options};
    const unsigned char *line = memchr(bytes, '\n', size < 8 ? size : 8);
    const size_t head = line ? (size_t)(line - bytes) + 1 : 0;
    import.access = (RetexAccess)RETEX_ACCESS_INIT;
    import.access.safe = 1;
    FILE *file = gltf_prepare(&import, file_of(bytes + head, size - head));
    const int changed = import.gltf_prepared != NULL;
    fuzz_must(file || import.gltf_refused[0], "the file can be opened again, or a reason is given");
    if (!file) {
        gltf_variants_free(&import.variants);
        return 0;
    }
    const GltfText text = gltf_load(file);
    fuzz_must(!changed || text.json, "what is written in place of a file can be read");
    fuzz_must(!changed || !text.is_repaired, "it is valid UTF-8");
    if (text.json && !import.gltf_refused[0])
        check(text.json);
    json_decref(text.json);
    fclose(file);
    if (changed)
        fclose(import.gltf_prepared);
    gltf_variants_free(&import.variants);
    return changed;
}

int main(int argc, char **argv)
{
    return fuzz_main(&(FuzzDriver){"gltf", 1, begin, run}, argc, argv);
}
