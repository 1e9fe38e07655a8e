/* Indices of what a glTF file has not: they would mean what is added to it behind its own. */
#include "import/gltf/parts.h"

typedef struct Check {
    const json_t *json;
    char *why; /* "" until an index is found */
} Check;

/* An index, or all of an array or object of them, into an array of the file. */
static void check(const Check *c, const json_t *indices, const char *array)
{
    const size_t count = json_array_size(json_object_get(c->json, array));
    const char *key;
    json_t *inner;
    size_t i;
    if (json_is_integer(indices) && json_integer_value(indices) >= (json_int_t)count && !c->why[0])
        snprintf(c->why, GLTF_REFUSED_SIZE, "it refers to %s[%lld], but has %zu of them", array,
                 (long long)json_integer_value(indices), count);
    json_array_foreach(indices, i, inner) check(c, inner, array);
    json_object_foreach((json_t *)indices, key, inner) check(c, inner, array);
}

static void check_mesh(const Check *c, const json_t *mesh)
{
    const json_t *primitives = json_object_get(mesh, "primitives"), *primitive;
    size_t i;
    json_array_foreach(primitives, i, primitive)
    {
        check(c, json_object_get(primitive, "attributes"), "accessors");
        check(c, json_object_get(primitive, "targets"), "accessors");
        check(c, json_object_get(primitive, "indices"), "accessors");
    }
}

void gltf_check_indices(const json_t *json, char why[GLTF_REFUSED_SIZE])
{
    const Check c = {json, why};
    const json_t *accessors = json_object_get(json, "accessors"), *views = json_object_get(json, "bufferViews"),
                 *meshes = json_object_get(json, "meshes"), *nodes = json_object_get(json, "nodes"),
                 *scenes = json_object_get(json, "scenes"), *of;
    size_t i;
    json_array_foreach(accessors, i, of)
    {
        const json_t *sparse = json_object_get(of, "sparse");
        check(&c, json_object_get(of, "bufferView"), "bufferViews");
        check(&c, json_object_get(json_object_get(sparse, "indices"), "bufferView"), "bufferViews");
        check(&c, json_object_get(json_object_get(sparse, "values"), "bufferView"), "bufferViews");
    }
    json_array_foreach(views, i, of) check(&c, json_object_get(of, "buffer"), "buffers");
    json_array_foreach(meshes, i, of) check_mesh(&c, of);
    json_array_foreach(scenes, i, of) check(&c, json_object_get(of, "nodes"), "nodes");
    json_array_foreach(nodes, i, of)
    {
        check(&c, json_object_get(of, "children"), "nodes");
        check(&c, json_object_get(of, "mesh"), "meshes");
    }
}
