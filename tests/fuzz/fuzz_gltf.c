/* glTF files as retex-import gives them to Assimp. The first line of an input is 'text' or 'binary'. What is written in
 * place of a file must be such a file again, in which no attribute of a mesh is of integers, unless a reason is given,
 * and every accessor that was made of one is not sparse and lies within the new buffer. */
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "import/internal.h"
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

static void put(unsigned char *to, size_t word)
{
    for (int i = 0; i < 4; i++)
        to[i] = (unsigned char)(word >> 8 * i);
}

static void begin(void)
{
    enum { BINARY = 44 };
    char text[4096] = "text\n";
    unsigned char file[4096 + 128] = "binary\n", *at = file + 7;
    snprintf(
        text + 5, sizeof text - 5, model,
        ",\"uri\":\"data:application/octet-stream;base64,AAAAAAAAAAD/fwAAAAAAAAAA/38AAAAAAAB/AAAAfwAAAH8AAAABAgMEBQ"
        "==\"");
    fuzz_seed(text, strlen(text));
    fuzz_words(text, strlen(text));
    size_t length = (size_t)snprintf((char *)at + 20, 4096, model, "");
    for (; length % 4; length++)
        at[20 + length] = ' ';
    const size_t words[] = {0x46546c67, 2, 28 + length + BINARY, length, 0x4e4f534a};
    for (int i = 0; i < 5; i++)
        put(at + (size_t)4 * (size_t)i, words[i]);
    put(at + 20 + length, BINARY), put(at + 24 + length, 0x004e4942);
    memset(at + 28 + length, 0, BINARY);
    fuzz_seed(file, 7 + 28 + length + BINARY);
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
    const json_int_t all = json_array_size(json_object_get(json, "buffers"));
    if (json_integer_value(json_object_get(view, "buffer")) != all - 1 || json_object_get(view, "byteStride"))
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
    const json_t *meshes = json_object_get(json, "meshes"), *mesh, *primitive, *index;
    size_t i, k;
    const char *name;
    json_array_foreach(meshes, i, mesh)
    {
        const json_t *primitives = json_object_get(mesh, "primitives");
        json_array_foreach(primitives, k, primitive)
        {
            json_t *attributes = json_object_get(primitive, "attributes");
            if (!gltf_extension(primitive, "KHR_draco_mesh_compression"))
                json_object_foreach(attributes, name, index)
                    check_accessor(json, name, numbered(json, "accessors", index));
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
    if (!file)
        return 0;
    const GltfText text = gltf_load(file);
    fuzz_must(!changed || text.json, "what is written in place of a file can be read");
    fuzz_must(!changed || !text.is_repaired, "it is valid UTF-8");
    if (text.json && !import.gltf_refused[0])
        check(text.json);
    json_decref(text.json);
    fclose(file);
    if (changed)
        fclose(import.gltf_prepared);
    return changed;
}

int main(int argc, char **argv)
{
    return fuzz_main(&(FuzzDriver){"gltf", 1, begin, run}, argc, argv);
}
