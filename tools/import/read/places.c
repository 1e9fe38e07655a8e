/* Where cameras and lights are in formats other than glTF. Assimp has them in lists of their own and tells their nodes
 * by names. Names may be the same: then the lights of a name are its nodes that have no mesh, in the order of a walk
 * that has children before their parents, as Assimp's readers go. */
#include <stdlib.h>
#include <string.h>

#include "import/base/tell.h"
#include "import/read/read.h"

typedef struct NodePlace {
    const struct aiNode *node;
    Affine world;
} NodePlace;

typedef struct Nodes {
    NodePlace *places;
    size_t count, capacity;
} Nodes;

static int add_node(Nodes *nodes, const struct aiNode *node, const Affine *world)
{
    if (nodes->count == nodes->capacity) {
        const size_t capacity = 2 * nodes->capacity + 64;
        NodePlace *more = realloc(nodes->places, capacity * sizeof *more);
        if (!more)
            return 0;
        nodes->places = more;
        nodes->capacity = capacity;
    }
    nodes->places[nodes->count++] = (NodePlace){node, *world};
    return 1;
}

/* All nodes, parents before their children and the last child first: backwards, that is the order of Assimp's readers.
 * `open` are those to go to. */
static int walk(const Import *import, Nodes *all, Nodes *open)
{
    int goes_on = add_node(open, import->scene->mRootNode, &import->world);
    while (goes_on && open->count) {
        const NodePlace place = open->places[--open->count];
        const Affine own = affine_from(&place.node->mTransformation), world = affine_multiply(&place.world, &own);
        goes_on = add_node(all, place.node, &world);
        for (unsigned i = 0; goes_on && i < place.node->mNumChildren; i++)
            goes_on = add_node(open, place.node->mChildren[i], &world);
    }
    return goes_on;
}

static unsigned lights_named(const struct aiScene *scene, const char *name, unsigned before)
{
    unsigned count = 0;
    for (unsigned i = 0; i < before; i++)
        count += strcmp(scene->mLights[i]->mName.data, name) == 0;
    return count;
}

static unsigned cameras_named(const struct aiScene *scene, const char *name, unsigned before)
{
    unsigned count = 0;
    for (unsigned i = 0; i < before; i++)
        count += strcmp(scene->mCameras[i]->mName.data, name) == 0;
    return count;
}

/* In 3DS files they are relative to all of the scene. */
static ImportPlace whole_scene(const Import *import)
{
    const Affine root = affine_from(&import->scene->mRootNode->mTransformation);
    return (ImportPlace){affine_multiply(&import->world, &root), 1};
}

/* The node of a light or camera that is the number-th of `count` with its name; others: how many of the other kind
 * have it too. */
static ImportPlace find_place(Import *import, const Nodes *nodes, const char *name, unsigned number, unsigned count,
                              unsigned others)
{
    const NodePlace *only = NULL, *nth = NULL;
    unsigned any = 0, empty = 0;
    if (import->is_3ds)
        return whole_scene(import);
    for (size_t i = nodes->count; i-- > 0;) {
        const NodePlace *place = &nodes->places[i];
        if (strcmp(place->node->mName.data, name) != 0)
            continue;
        any++;
        only = place;
        if (!place->node->mNumMeshes && empty++ == number)
            nth = place;
    }
    if (any == 1) /* a node may have several */
        return (ImportPlace){only->world, 1};
    if (nth && empty == count && !others)
        return (ImportPlace){nth->world, 1};
    import_leave_out(import, LEFT_SAME_NAME);
    return (ImportPlace){affine_identity, 0};
}

static void find_all(Import *import, const Nodes *nodes)
{
    const struct aiScene *scene = import->scene;
    const unsigned nlights = scene->mNumLights, ncameras = scene->mNumCameras;
    for (unsigned i = 0; i < nlights; i++) {
        const char *name = scene->mLights[i]->mName.data;
        import->light_places[i] =
            find_place(import, nodes, name, lights_named(scene, name, i), lights_named(scene, name, nlights),
                       cameras_named(scene, name, ncameras));
    }
    for (unsigned i = 0; i < ncameras; i++) {
        const char *name = scene->mCameras[i]->mName.data;
        import->camera_places[i] =
            find_place(import, nodes, name, cameras_named(scene, name, i), cameras_named(scene, name, ncameras),
                       lights_named(scene, name, nlights));
    }
}

int places_find(Import *import, RetexError *err)
{
    Nodes all = {0}, open = {0};
    import->light_places = calloc(import->scene->mNumLights + 1, sizeof *import->light_places);
    import->camera_places = calloc(import->scene->mNumCameras + 1, sizeof *import->camera_places);
    const int done = import->light_places && import->camera_places && walk(import, &all, &open);
    if (done)
        find_all(import, &all);
    free(all.places);
    free(open.places);
    return done ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "out of memory");
}
