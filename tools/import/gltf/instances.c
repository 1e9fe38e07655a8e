/* Nodes of glTF files that place a mesh many times, by EXT_mesh_gpu_instancing: they become nodes with a child for each
 * instance. */
#include <math.h>
#include <stdlib.h>

#include "import/gltf/buffers.h"
#include "import/gltf/floats.h"
#include "import/gltf/json.h"

enum { MOST_INSTANCES = 250000 }; /* of a file; each is an object of the scene */
#define LIMIT "250000"

static const char extension[] = "EXT_mesh_gpu_instancing";

/* What instances have of their own; arrays are NULL where they have it not. */
typedef struct Instances {
    float *translations, *rotations, *scales;
    size_t count;
} Instances;

static const char *read_attribute(GltfFloats *f, const json_t *attributes, const char *name, size_t width,
                                  Instances *instances, float **numbers)
{
    const json_t *index = json_object_get(attributes, name);
    size_t count;
    if (!index)
        return NULL;
    *numbers = gltf_floats_read(f, index, width, MOST_INSTANCES, &count);
    if (!*numbers)
        return "they are more than " LIMIT ", or their numbers do not lie within their buffer";
    if (instances->count && count != instances->count)
        return "their attributes are not equally many";
    instances->count = count;
    return NULL;
}

static int add_numbers(json_t *node, const char *key, const float *numbers, size_t width)
{
    json_t *array = json_array();
    for (size_t k = 0; k < width; k++)
        if (json_array_append_new(array, json_real((double)numbers[k])) != 0) { /* no number */
            json_decref(array);
            return 0;
        }
    return json_object_set_new(node, key, array) == 0;
}

/* Integers do not hold rotations of the length 1. */
static void normalize(float q[4])
{
    const float length = sqrtf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int k = 0; k < 4 && length > 0; k++)
        q[k] /= length;
}

static json_t *make_node(const json_t *node, const Instances *instances, size_t i)
{
    json_t *own = json_object(), *name = json_object_get(node, "name");
    json_object_set(own, "mesh", json_object_get(node, "mesh"));
    if (name)
        json_object_set(own, "name", name);
    if (instances->rotations)
        normalize(instances->rotations + 4 * i);
    if ((!instances->translations || add_numbers(own, "translation", instances->translations + 3 * i, 3)) &&
        (!instances->rotations || add_numbers(own, "rotation", instances->rotations + 4 * i, 4)) &&
        (!instances->scales || add_numbers(own, "scale", instances->scales + 3 * i, 3)))
        return own;
    json_decref(own);
    return NULL;
}

static const char *add_nodes(json_t *nodes, json_t *node, const Instances *instances)
{
    json_t *children = json_object_get(node, "children");
    if (!json_is_array(children)) {
        children = json_array();
        json_object_set_new(node, "children", children);
    }
    for (size_t i = 0; i < instances->count; i++) {
        json_t *own = make_node(node, instances, i);
        if (!own)
            return "their places are no numbers";
        json_array_append_new(children, json_integer((json_int_t)json_array_size(nodes)));
        if (json_array_append_new(nodes, own) != 0)
            return GLTF_NO_MEMORY;
    }
    json_object_del(node, "mesh");
    json_object_del(json_object_get(node, "extensions"), extension);
    return NULL;
}

/* Returns why the instances cannot be placed, or NULL. */
static const char *place(GltfFloats *f, json_t *nodes, json_t *node, size_t *total)
{
    const json_t *attributes = json_object_get(gltf_extension(node, extension), "attributes");
    Instances instances = {0};
    const char *why = read_attribute(f, attributes, "TRANSLATION", 3, &instances, &instances.translations);
    if (!why)
        why = read_attribute(f, attributes, "ROTATION", 4, &instances, &instances.rotations);
    if (!why)
        why = read_attribute(f, attributes, "SCALE", 3, &instances, &instances.scales);
    *total += instances.count;
    if (!why && *total > MOST_INSTANCES)
        why = "they are more than " LIMIT;
    if (!why && instances.count) /* without attributes that place them, they are all in one place */
        why = add_nodes(nodes, node, &instances);
    free(instances.translations);
    free(instances.rotations);
    free(instances.scales);
    return why;
}

int gltf_place_instances(GltfFloats *f)
{
    json_t *nodes = json_object_get(f->json, "nodes");
    const size_t count = json_array_size(nodes);
    size_t total = 0;
    int any = 0;
    for (size_t i = 0; i < count && !f->refused[0]; i++) {
        json_t *node = json_array_get(nodes, i);
        if (!gltf_extension(node, extension) || !json_object_get(node, "mesh"))
            continue;
        const char *why = place(f, nodes, node, &total);
        any = 1;
        if (why)
            snprintf(f->refused, sizeof f->refused, "the instances of nodes[%zu], by %s: %s", i, extension, why);
    }
    return any;
}
