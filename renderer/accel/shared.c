/* Meshes that many primitives share. Each gets an Accel of its own, in object space, and its primitives are traced as
 * curved shapes are: Embree calls back for each, and the ray goes on in the mesh's Accel. So a further copy takes a few
 * hundred bytes, however large the mesh is. A mesh with few copies is traced faster as triangles of the scene. */
#include <stdlib.h>
#include <string.h>
#include "accel/embree.h"
#include "shape/shape.h"

#define SAVED_TRIANGLES 250000 /* fewer than these are not worth it: about 30 MB */
#define SMALLEST 16            /* faces; a smaller mesh is no larger than what stands for its copy */

typedef struct Use {
    const Mesh *mesh;
    int primitive;
} Use;

/* Copies with other textures have heads of their own, but the same faces. */
static int by_mesh(const void *a, const void *b)
{
    const Use *x = a, *y = b;
    const uintptr_t p = (uintptr_t)x->mesh->faces, q = (uintptr_t)y->mesh->faces;

    return p != q ? (p > q) - (p < q) : (x->primitive > y->primitive) - (x->primitive < y->primitive);
}

static int list_uses(const Scene *scene, Use *uses)
{
    int count = 0;

    for (int i = 0; i < scene->nprimitives; i++) {
        const Primitive *p = &scene->primitives[i];
        if (p->shape.ops == &shape_mesh && !p->csg && p->shape.mesh->nfaces >= SMALLEST)
            uses[count++] = (Use){p->shape.mesh, i};
    }
    qsort(uses, (size_t)count, sizeof *uses, by_mesh);
    return count;
}

/* A scene of the mesh alone, where it is in object space. */
static Scene *scene_of(const Scene *scene, int primitive)
{
    Scene *alone = calloc(1, sizeof *alone);
    Primitive *p = calloc(1, sizeof *p);

    if (!alone || !p) {
        free(alone);
        free(p);
        return NULL;
    }
    *p = scene->primitives[primitive];
    p->transform = transform_identity();
    p->no_image = p->no_shadow = p->no_reflection = p->inverse = 0;
    memcpy(alone->path, scene->path, sizeof alone->path);
    alone->primitives = p;
    alone->nprimitives = 1;
    alone->camera.location = p->shape.mesh->vertices[0];
    return alone;
}

static int share(Accel *accel, const Use *uses, int count, RetexError *err)
{
    SharedMesh *shared = calloc(1, sizeof *shared);

    if (shared)
        shared->scene = scene_of(accel->source, uses[0].primitive);
    if (!shared || !shared->scene) {
        free(shared);
        return retex_fail(err, RETEX_ENOMEM, "no memory for the scene's geometry");
    }
    shared->next = accel->shared_meshes;
    accel->shared_meshes = shared;
    for (int i = 0; i < count; i++)
        accel->shared[uses[i].primitive] = shared;
    return 0;
}

int accel_find_shared(Accel *accel, RetexError *err)
{
    const size_t n = (size_t)accel->source->nprimitives + 1;
    Use *uses = malloc(n * sizeof *uses);
    int count = uses ? list_uses(accel->source, uses) : 0, status = 0;

    if (!uses)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the scene's geometry");
    for (int i = 0, end; i < count && status == 0; i = end) {
        end = i + 1;
        while (end < count && uses[end].mesh->faces == uses[i].mesh->faces)
            end++;
        if ((double)(end - i - 1) * uses[i].mesh->nfaces < SAVED_TRIANGLES)
            continue;
        if (!accel->shared)
            accel->shared = calloc(n, sizeof(*accel->shared));
        status = accel->shared ? share(accel, &uses[i], end - i, err)
                               : retex_fail(err, RETEX_ENOMEM, "no memory for the scene's geometry");
    }
    free(uses);
    return status;
}

void accel_free_shared(Accel *accel)
{
    while (accel->shared_meshes) {
        SharedMesh *shared = accel->shared_meshes;
        accel->shared_meshes = shared->next;
        free(shared->scene->primitives);
        free(shared->scene);
        free(shared);
    }
    free(accel->shared);
    accel->shared = NULL;
}
