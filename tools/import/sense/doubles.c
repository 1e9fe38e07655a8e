/* Faces that lie on one another: programs write both sides of a face as two, and copy objects onto themselves. Which
 * of them a ray meets is chance, so one of each is kept. Surfaces that light goes through stay as they are: there, two
 * faces are a thin pane. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/base/mesh.h"
#include "import/base/tell.h"
#include "import/base/world.h"
#include "import/sense/sense.h"

typedef struct MeshPlace {
    Affine world;
    unsigned count; /* how often it is placed */
} MeshPlace;

/* The corners of a face in an order that does not depend on how it was written. */
typedef struct Key {
    float corners[3][3];
    unsigned space; /* 0: the scene's; else that of a mesh which is placed several times, by its number from 1 */
} Key;

typedef struct Face {
    unsigned mesh, face;
} Face;

typedef struct Table {
    Face *faces;
    uint32_t *slots; /* index of a face from 1; 0: free */
    size_t size, count;
} Table;

static void note_place(Import *import, const struct aiNode *node, const Affine *world, void *context)
{
    MeshPlace *places = context;
    for (unsigned i = 0; i < node->mNumMeshes; i++)
        if (node->mMeshes[i] < import->scene->mNumMeshes) {
            places[node->mMeshes[i]].world = *world;
            places[node->mMeshes[i]].count++;
        }
}

static Key key_of(const Import *import, const MeshPlace *places, Face f)
{
    const struct aiMesh *mesh = import->scene->mMeshes[f.mesh];
    const int is_once = places[f.mesh].count == 1;
    Key key = {.space = is_once ? 0 : f.mesh + 1};
    for (int k = 0; k < 3; k++) {
        const struct aiVector3D *v = &mesh->mVertices[mesh->mFaces[f.face].mIndices[k]];
        double p[3] = {(double)v->x, (double)v->y, (double)v->z}, q[3];
        affine_point(is_once ? &places[f.mesh].world : &affine_identity, p, q);
        for (int j = 0; j < 3; j++)
            key.corners[k][j] = (float)q[j] + 0.0f; /* no -0 */
    }
    for (int k = 0; k < 3; k++) { /* of three, this sorts all */
        const int a = k == 1 ? 1 : 0, b = k == 1 ? 2 : 1;
        float swap[3];
        int order = 0;
        for (int j = 0; j < 3 && !order; j++)
            order = (key.corners[a][j] > key.corners[b][j]) - (key.corners[a][j] < key.corners[b][j]);
        if (order <= 0)
            continue;
        memcpy(swap, key.corners[a], sizeof swap);
        memcpy(key.corners[a], key.corners[b], sizeof swap);
        memcpy(key.corners[b], swap, sizeof swap);
    }
    return key;
}

static size_t hash_of(const Key *key)
{
    const unsigned char *bytes = (const unsigned char *)key;
    uint64_t h = 1469598103934665603u;
    for (size_t i = 0; i < sizeof *key; i++)
        h = (h ^ bytes[i]) * 1099511628211u;
    return (size_t)(h ^ h >> 29);
}

/* Whether one of two may go. Of two opaque materials, an image shows more than a colour. */
static int may_drop(const ImportMaterial *first, const ImportMaterial *second, int *is_first)
{
    *is_first = first->is_opaque && second->is_opaque && !first->has_image && second->has_image;
    return !first->is_solid && !second->is_solid && (first == second || (first->is_opaque && second->is_opaque));
}

static void drop(const Import *import, Face f)
{
    import->scene->mMeshes[f.mesh]->mFaces[f.face].mNumIndices = 0;
}

/* Returns 1 if a face was dropped. */
static int add_face(const Import *import, const MeshPlace *places, Table *table, Face f)
{
    const struct aiScene *scene = import->scene;
    const Key key = key_of(import, places, f);
    size_t slot = hash_of(&key) & (table->size - 1);
    for (; table->slots[slot]; slot = (slot + 1) & (table->size - 1)) {
        Face *other = &table->faces[table->slots[slot] - 1];
        const Key of_other = key_of(import, places, *other);
        int is_first;
        if (memcmp(&key, &of_other, sizeof key) != 0)
            continue;
        if (!may_drop(&import->materials[scene->mMeshes[other->mesh]->mMaterialIndex],
                      &import->materials[scene->mMeshes[f.mesh]->mMaterialIndex], &is_first))
            return 0;
        const Face gone = is_first ? *other : f;
        *other = is_first ? f : *other;
        drop(import, gone);
        return 1;
    }
    table->faces[table->count++] = f;
    table->slots[slot] = (uint32_t)table->count;
    return 0;
}

static int make_table(const struct aiScene *scene, Table *table)
{
    size_t faces = 0;
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
        faces += scene->mMeshes[i]->mNumFaces;
    if (faces > UINT32_MAX / 4)
        return 0;
    for (table->size = 64; table->size < 2 * faces;)
        table->size *= 2;
    table->faces = malloc((faces + 1) * sizeof *table->faces);
    table->slots = calloc(table->size, sizeof *table->slots);
    return table->faces && table->slots;
}

int doubles_drop(Import *import, RetexError *err)
{
    const struct aiScene *scene = import->scene;
    Table table = {0};
    MeshPlace *places = calloc((size_t)scene->mNumMeshes + 1, sizeof *places);
    long dropped = 0;
    const int done = places && import_visit_nodes(import, note_place, places) && make_table(scene, &table);
    for (unsigned i = 0; done && i < scene->mNumMeshes; i++) {
        const struct aiMesh *mesh = scene->mMeshes[i];
        if (mesh->mMaterialIndex >= scene->mNumMaterials || !places[i].count)
            continue;
        for (unsigned k = 0; k < mesh->mNumFaces; k++)
            if (mesh_is_surface(mesh, &mesh->mFaces[k]))
                dropped += add_face(import, places, &table, (Face){i, k});
    }
    free(places);
    free(table.faces);
    free(table.slots);
    if (dropped)
        import_tell(import, IMPORT_INFO, "%ld face%s on others of the same corners: one of each is kept", dropped,
                    dropped == 1 ? " lies" : "s lie");
    return done ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "out of memory");
}

/* ---- objects ---- */

typedef struct Object {
    Affine placed;
    unsigned mesh, number; /* in the order of a walk */
} Object;

typedef struct Objects {
    Object *list;
    size_t count, capacity;
} Objects;

static void note_object(Import *import, const struct aiNode *node, const Affine *world, void *context)
{
    Objects *objects = context;
    (void)import;
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        if (objects->list && objects->count < objects->capacity) {
            Object *o = &objects->list[objects->count];
            memset(o, 0, sizeof *o);
            o->placed = *world, o->mesh = node->mMeshes[i], o->number = (unsigned)objects->count;
        }
        objects->count++;
    }
}

static int compare_objects(const void *a, const void *b)
{
    const Object *x = a, *y = b;
    const int order = x->mesh != y->mesh ? (x->mesh > y->mesh) - (x->mesh < y->mesh)
                                         : memcmp(&x->placed, &y->placed, sizeof x->placed);
    return order ? order : (x->number > y->number) - (x->number < y->number);
}

int doubles_find_objects(Import *import, RetexError *err)
{
    Objects objects = {0};
    long dropped = 0;
    int done = import_visit_nodes(import, note_object, &objects);
    objects.capacity = objects.count;
    objects.count = 0;
    objects.list = malloc((objects.capacity + 1) * sizeof *objects.list);
    import->is_dropped = calloc(objects.capacity + 1, 1);
    done = done && objects.list && import->is_dropped && import_visit_nodes(import, note_object, &objects);
    if (done)
        qsort(objects.list, objects.count, sizeof *objects.list, compare_objects);
    for (size_t i = 1; done && i < objects.count; i++) {
        const Object *a = &objects.list[i - 1], *b = &objects.list[i];
        if (a->mesh != b->mesh || memcmp(&a->placed, &b->placed, sizeof a->placed) != 0)
            continue;
        import->is_dropped[b->number] = 1;
        dropped++;
    }
    free(objects.list);
    if (dropped)
        import_tell(import, IMPORT_INFO, "%ld object%s where the same one is: one of each is kept", dropped,
                    dropped == 1 ? " is" : "s are");
    return done ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "out of memory");
}
