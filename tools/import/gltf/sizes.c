/* What a glTF file of few bytes says may be much: nodes within nodes, each of which may hold the next one several
 * times, and elements that lie in no buffer. Assimp makes all of it, before anything else can count. */
#include <stdlib.h>

#include "import/gltf/buffers.h"
#include "import/gltf/parts.h"

/* Nodes as they are placed: a scene with more of them could not be rendered. Assimp reads a node within another one by
 * recursion. Of elements, shape keys may have some millions: they are sparse. */
enum { MOST_NODES = 1000000, MOST_DEPTH = 4000, MOST_ELEMENTS = 1 << 24 };

/* ---- nodes ---- */

typedef struct Open {
    size_t node;
    int depth;
} Open;

typedef struct Tree {
    const json_t *nodes;
    Open *open;
    size_t nopen, capacity, count; /* count: of all that are placed */
} Tree;

static const char *push(Tree *tree, const json_t *indices, int depth)
{
    const size_t more = json_array_size(indices);
    tree->count += more;
    if (depth > MOST_DEPTH && more)
        return "its nodes lie within one another more than 4000 deep, or within themselves";
    if (tree->count > MOST_NODES)
        return "it has more than 1000000 nodes, each counted as often as it is placed";
    if (tree->nopen + more > tree->capacity) {
        tree->capacity = 2 * (tree->nopen + more);
        Open *larger = realloc(tree->open, tree->capacity * sizeof *larger);
        if (!larger)
            return GLTF_NO_MEMORY;
        tree->open = larger;
    }
    for (size_t i = 0; i < more; i++) {
        const json_t *index = json_array_get(indices, i);
        if (json_is_integer(index) && json_integer_value(index) >= 0)
            tree->open[tree->nopen++] = (Open){(size_t)json_integer_value(index), depth};
    }
    return NULL;
}

static const char *check_nodes(const json_t *json)
{
    const json_t *shown = json_object_get(json, "scene");
    const size_t scene = json_is_integer(shown) ? (size_t)json_integer_value(shown) : 0;
    Tree tree = {.nodes = json_object_get(json, "nodes")};
    const char *why = push(&tree, json_object_get(json_array_get(json_object_get(json, "scenes"), scene), "nodes"), 1);
    while (!why && tree.nopen) {
        const Open at = tree.open[--tree.nopen];
        why = push(&tree, json_object_get(json_array_get(tree.nodes, at.node), "children"), at.depth + 1);
    }
    free(tree.open);
    return why;
}

/* ---- elements ---- */

/* Of an accessor, or all of an object or array of them: how many elements lie in no buffer. */
static double count_elements(const json_t *json, const json_t *indices)
{
    const char *key;
    json_t *inner;
    size_t i, count;
    double sum = 0;
    if (json_is_integer(indices)) {
        const json_t *accessor =
            json_array_get(json_object_get(json, "accessors"), (size_t)json_integer_value(indices));
        if (!json_object_get(accessor, "bufferView") && gltf_get_size(accessor, "count", 0, &count))
            sum = (double)count;
    }
    json_array_foreach(indices, i, inner) sum += count_elements(json, inner);
    json_object_foreach((json_t *)indices, key, inner) sum += count_elements(json, inner);
    return sum;
}

static const char *check_elements(const json_t *json)
{
    const json_t *meshes = json_object_get(json, "meshes");
    double sum = 0;
    for (size_t i = 0; i < json_array_size(meshes); i++) {
        const json_t *primitives = json_object_get(json_array_get(meshes, i), "primitives");
        for (size_t k = 0; k < json_array_size(primitives); k++) {
            const json_t *primitive = json_array_get(primitives, k);
            sum += count_elements(json, json_object_get(primitive, "attributes"));
            sum += count_elements(json, json_object_get(primitive, "targets"));
            sum += count_elements(json, json_object_get(primitive, "indices"));
        }
    }
    return sum > MOST_ELEMENTS ? "its meshes have more than 16777216 elements that lie in no buffer" : NULL;
}

void gltf_check_sizes(const json_t *json, char why[GLTF_REFUSED_SIZE])
{
    const char *found = why[0] ? NULL : check_nodes(json);
    if (!found && !why[0])
        found = check_elements(json);
    if (found)
        snprintf(why, GLTF_REFUSED_SIZE, "%s", found);
}
