/* Meshes of glTF files that Draco compressed. Assimp reads them too, but refuses indices of 32 bits, and takes no
 * integers. They become primitives as any others. */
#include <stdlib.h>
#include <string.h>

#include "import/base/tell.h"
#include "import/gltf/buffers.h"
#include "import/gltf/decode.h"
#include "import/gltf/draco_mesh.h"

enum { FIRST_TYPE = 5120, UNSIGNED_INT = 5125, LAST_TYPE = 5126 };

static const char extension[] = "KHR_draco_mesh_compression";

/* One primitive, and what its data become. */
typedef struct Compressed {
    GltfDecode *decode;
    json_t *primitive;
    const json_t *json; /* of the extension */
    DracoMesh *mesh;
    size_t mesh_index, index; /* of the file's mesh, and of the primitive in it */
    json_t *attributes;       /* with the new accessors */
    json_int_t indices;
} Compressed;

static int refuse(const Compressed *c, const char *why)
{
    GltfDecode *d = c->decode;
    if (!d->refused[0])
        snprintf(d->refused, sizeof d->refused, "meshes[%zu].primitives[%zu], compressed by %s: %.100s", c->mesh_index,
                 c->index, extension, why);
    return 0;
}

static int open_mesh(Compressed *c)
{
    GltfDecode *d = c->decode;
    size_t view_index, buffer, at, size;
    char why[160] = "its data do not lie within their buffer";
    if (!gltf_get_size(c->json, "bufferView", SIZE_MAX, &view_index))
        return refuse(c, why);
    const json_t *view = json_array_get(json_object_get(d->json, "bufferViews"), view_index);
    if (!gltf_get_size(view, "buffer", SIZE_MAX, &buffer) || !gltf_get_size(view, "byteOffset", 0, &at) ||
        !gltf_get_size(view, "byteLength", 0, &size))
        return refuse(c, why);
    const unsigned char *bytes = gltf_bytes(d->buffers, buffer, at, size);
    c->mesh = bytes ? draco_mesh_open(bytes, size, why) : NULL;
    return c->mesh ? 1 : refuse(c, why);
}

/* Room in the new buffer, and an accessor for it; -1 without memory. */
static json_int_t add_accessor(Compressed *c, size_t size, json_t *accessor, unsigned char **to)
{
    GltfDecode *d = c->decode;
    size_t at;
    *to = gltf_extend(&d->buffers->decoded, size, &at);
    json_t *accessors = json_object_get(d->json, "accessors");
    const json_int_t view = *to ? gltf_add_view(d->json, d->buffers->decoded_index, at, size) : -1;
    const json_int_t index = (json_int_t)json_array_size(accessors);
    json_object_set_new(accessor, "bufferView", json_integer(view));
    return view >= 0 && json_array_append_new(accessors, accessor) == 0 ? index : (refuse(c, GLTF_NO_MEMORY), -1);
}

static size_t width_of(const char *type)
{
    static const struct {
        const char *type;
        size_t width;
    } widths[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
    for (size_t i = 0; type && i < sizeof widths / sizeof *widths; i++)
        if (strcmp(type, widths[i].type) == 0)
            return widths[i].width;
    return 0;
}

/* Numbers of the type that the file's accessor has, each vertex at a multiple of 4 bytes. */
static int take_attribute(Compressed *c, const char *name, const json_t *number)
{
    const json_t *of_file = json_object_get(json_object_get(c->primitive, "attributes"), name);
    const size_t place = json_is_integer(of_file) ? (size_t)json_integer_value(of_file) : SIZE_MAX;
    const json_t *accessor = json_array_get(json_object_get(c->decode->json, "accessors"), place);
    const size_t width = width_of(json_string_value(json_object_get(accessor, "type")));
    const size_t count = draco_mesh_vertices(c->mesh);
    size_t type;
    unsigned char *to;
    char why[128], plain[NAME_SIZE];
    if (!accessor) /* what the mesh does not use */
        return 1;
    snprintf(why, sizeof why, "it has no %s, or not as numbers of the type that its accessor says",
             import_plain(name, plain));
    if (!width || !json_is_integer(number) || json_integer_value(number) < 0 ||
        !gltf_get_size(accessor, "componentType", 0, &type) || type < FIRST_TYPE || type > LAST_TYPE)
        return refuse(c, why);
    const size_t one = type < FIRST_TYPE + 2 ? 1 : type < FIRST_TYPE + 4 ? 2 : 4, stride = (width * one + 3) / 4 * 4;
    json_t *own = json_pack("{s:I,s:I,s:O,s:b}", "componentType", (json_int_t)type, "count", (json_int_t)count, "type",
                            json_object_get(accessor, "type"), "normalized",
                            json_is_true(json_object_get(accessor, "normalized")));
    const json_int_t index = add_accessor(c, stride * count, own, &to);
    if (index < 0)
        return 0;
    memset(to, 0, stride * count);
    if (stride != width * one) {
        const json_t *views = json_object_get(c->decode->json, "bufferViews");
        json_object_set_new(json_array_get(views, json_array_size(views) - 1), "byteStride",
                            json_integer((json_int_t)stride));
    }
    json_object_set_new(c->attributes, name, json_integer(index));
    return draco_mesh_attribute(c->mesh, (size_t)json_integer_value(number), type, width, stride, to) || refuse(c, why);
}

static int take_indices(Compressed *c)
{
    const size_t count = 3 * draco_mesh_triangles(c->mesh);
    unsigned char *to;
    if (count == 0 || draco_mesh_vertices(c->mesh) == 0)
        return refuse(c, "it has no triangles");
    c->indices = add_accessor(
        c, 4 * count,
        json_pack("{s:i,s:I,s:s}", "componentType", UNSIGNED_INT, "count", (json_int_t)count, "type", "SCALAR"), &to);
    return c->indices >= 0 && (draco_mesh_indices(c->mesh, to) || refuse(c, "it has indices of no vertex"));
}

static int take_mesh(Compressed *c)
{
    json_t *attributes = json_object_get(c->primitive, "attributes"), *number;
    const char *name;
    c->attributes = json_is_object(attributes) ? json_copy(attributes) : json_object();
    int done = open_mesh(c) && take_indices(c);
    json_object_foreach(json_object_get(c->json, "attributes"), name, number) done =
        done && take_attribute(c, name, number);
    draco_mesh_close(c->mesh);
    return done;
}

/* Primitives that share their data are decoded once: `known` has what became of those that were. */
static void decode_primitive(GltfDecode *d, json_t *known, json_t *primitive, size_t mesh_index, size_t index)
{
    json_t *extensions = json_object_get(primitive, "extensions"), *json = json_object_get(extensions, extension);
    if (!json)
        return;
    Compressed c = {.decode = d, .primitive = primitive, .json = json, .mesh_index = mesh_index, .index = index};
    json_t *all = json_pack("[O,O*]", json, json_object_get(primitive, "attributes"));
    char *key = json_dumps(all, JSON_COMPACT | JSON_SORT_KEYS);
    json_t *result = key ? json_object_get(known, key) : NULL;
    if (!result && key && take_mesh(&c)) {
        result = json_pack("{s:O,s:I}", "attributes", c.attributes, "indices", c.indices);
        json_object_set_new(known, key, result);
    }
    if (result) {
        json_object_update(primitive, result);
        json_object_del(primitive, "mode"); /* Draco stores triangles, also where the file has strips */
        json_object_del(extensions, extension);
        d->any = 1;
    }
    json_decref(c.attributes);
    json_decref(all);
    free(key);
}

void gltf_decode_meshes(GltfDecode *d)
{
    const json_t *meshes = json_object_get(d->json, "meshes");
    json_t *known = json_object();
    for (size_t i = 0; i < json_array_size(meshes); i++) {
        const json_t *primitives = json_object_get(json_array_get(meshes, i), "primitives");
        for (size_t k = 0; k < json_array_size(primitives) && !d->refused[0]; k++)
            decode_primitive(d, known, json_array_get(primitives, k), i, k);
    }
    json_decref(known);
}
