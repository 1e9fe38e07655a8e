/* The nodes of a glTF file, with their transforms. */
#include <math.h>
#include <stdlib.h>

#include "import/gltf/json.h"
#include "import/gltf/parts.h"

static double component(const json_t *array, size_t k, double otherwise)
{
    const json_t *value = json_array_get(array, k);
    return json_is_number(value) ? json_number_value(value) : otherwise;
}

/* Of 16 numbers by columns, or of a scale, then a rotation, then a translation. */
static Affine own_transform(const json_t *node)
{
    const json_t *matrix = json_object_get(node, "matrix"), *t = json_object_get(node, "translation"),
                 *r = json_object_get(node, "rotation"), *s = json_object_get(node, "scale");
    Affine a = affine_identity;
    if (json_array_size(matrix) == 16) {
        for (size_t i = 0; i < 12; i++)
            a.m[i % 3][i / 3] = component(matrix, i / 3 * 4 + i % 3, 0);
        return a;
    }
    const double x = component(r, 0, 0), y = component(r, 1, 0), z = component(r, 2, 0), w = component(r, 3, 1);
    const double turn[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                               {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                               {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    for (size_t i = 0; i < 3; i++) {
        for (size_t j = 0; j < 3; j++)
            a.m[i][j] = turn[i][j] * component(s, j, 1);
        a.m[i][3] = component(t, i, 0);
    }
    return a;
}

static json_t *referred(const json_t *array, const json_t *index)
{
    return json_is_integer(index) && json_integer_value(index) >= 0
               ? json_array_get(array, (size_t)json_integer_value(index))
               : NULL;
}

typedef struct NodePlace {
    const json_t *node;
    Affine above;
    int is_shown; /* no node above it is hidden */
} NodePlace;

typedef struct NodeStack {
    NodePlace *places;
    size_t count, capacity;
} NodeStack;

/* In their order from the top of the stack. */
static int push(NodeStack *stack, const json_t *nodes, const json_t *indices, const Affine *above, int is_shown)
{
    const size_t more = json_array_size(indices);
    if (stack->count + more > stack->capacity) {
        const size_t capacity = 2 * (stack->count + more);
        NodePlace *larger = realloc(stack->places, capacity * sizeof *larger);
        if (!larger)
            return 0;
        stack->places = larger;
        stack->capacity = capacity;
    }
    for (size_t i = more; i-- > 0;) {
        const json_t *node = referred(nodes, json_array_get(indices, i));
        if (node)
            stack->places[stack->count++] = (NodePlace){node, *above, is_shown};
    }
    return 1;
}

int gltf_is_hidden(const json_t *node)
{
    return json_is_false(json_object_get(gltf_extension(node, "KHR_node_visibility"), "visible"));
}

/* Without recursion, for files may nest deeply. There are no cycles: Assimp has refused them. */
int gltf_visit_nodes(Import *import, const json_t *json, GltfVisit *visit, void *context)
{
    const json_t *nodes = json_object_get(json, "nodes"), *shown = json_object_get(json, "scene");
    const json_t *scenes = json_object_get(json, "scenes");
    const json_t *scene = shown ? referred(scenes, shown) : json_array_get(scenes, 0);
    NodeStack stack = {0};
    int goes_on = push(&stack, nodes, json_object_get(scene, "nodes"), &import->world, 1);
    while (goes_on && stack.count) {
        const NodePlace place = stack.places[--stack.count];
        const Affine own = own_transform(place.node), world = affine_multiply(&place.above, &own);
        const int is_shown = place.is_shown && !gltf_is_hidden(place.node);
        goes_on = visit(import, json, &(GltfNode){place.node, world, is_shown}, context) &&
                  push(&stack, nodes, json_object_get(place.node, "children"), &world, is_shown);
    }
    free(stack.places);
    return goes_on;
}

void gltf_node_name(const json_t *json, const json_t *node, const json_t *has, char name[TEXT_SIZE])
{
    const json_t *nodes = json_object_get(json, "nodes");
    const char *own = json_string_value(json_object_get(node, "name")),
               *other = json_string_value(json_object_get(has, "name"));
    size_t number = 0;
    while (number < json_array_size(nodes) && json_array_get(nodes, number) != node)
        number++;
    if ((own && *own) || (other && *other))
        snprintf(name, TEXT_SIZE, "%.*s", (int)TEXT_SIZE - 1, own && *own ? own : other);
    else
        snprintf(name, TEXT_SIZE, "nodes_%zu", number);
}
