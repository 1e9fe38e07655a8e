/* What many copies share: meshes, and the prototypes of instances. Each gets an Accel of its own, in its own space, and
 * its copies are traced as curved shapes are: Embree calls back for each, and the ray goes on in that Accel. So a
 * further copy takes a few hundred bytes, however large it is. A mesh with few copies is traced faster as triangles of
 * the scene. */
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
        if (p->shape.ops == &shape_mesh && !p->csg && !p->prototype && p->shape.mesh->nfaces >= SMALLEST)
            uses[count++] = (Use){p->shape.mesh, i};
    }
    qsort(uses, (size_t)count, sizeof *uses, by_mesh);
    return count;
}

/* With an empty scene; NULL without memory. */
static Shared *shared_new(Accel *accel)
{
    Shared *shared = calloc(1, sizeof *shared);

    if (!shared)
        return NULL;
    shared->next = accel->all_shared;
    accel->all_shared = shared;
    shared->scene = calloc(1, sizeof *shared->scene);
    if (!shared->scene)
        return NULL;
    memcpy(shared->scene->path, accel->source->path, sizeof accel->source->path);
    return shared;
}

/* The mesh alone, where it is in object space. */
static int share(Accel *accel, const Use *uses, int count, RetexError *err)
{
    Shared *shared = shared_new(accel);
    Primitive *p = calloc(1, sizeof *p);

    if (!shared || !p) {
        free(p);
        return retex_fail(err, RETEX_ENOMEM, "no memory for the scene's geometry");
    }
    *p = accel->source->primitives[uses[0].primitive];
    p->transform = transform_identity();
    p->no_image = p->no_shadow = p->no_reflection = p->inverse = 0;
    shared->mesh = shared->scene->primitives = p;
    shared->scene->nprimitives = 1;
    for (int i = 0; i < count; i++)
        accel->shared[uses[i].primitive] = shared;
    return 0;
}

static int share_prototypes(Accel *accel, RetexError *err)
{
    const Scene *scene = accel->source;

    accel->prototypes = calloc((size_t)scene->nprototypes + 1, sizeof(*accel->prototypes));
    for (int i = 0; i < scene->nprototypes; i++) {
        const Prototype *prototype = scene->prototypes[i];
        Shared *shared = accel->prototypes ? shared_new(accel) : NULL;
        if (!shared)
            return retex_fail(err, RETEX_ENOMEM, "no memory for the scene's geometry");
        shared->scene->primitives = scene->primitives + prototype->first;
        shared->scene->nprimitives = prototype->count;
        shared->scene->csgs = prototype->csgs;
        shared->scene->ncsgs = prototype->ncsgs;
        accel->prototypes[i] = shared;
    }
    return 0;
}

int accel_find_shared(Accel *accel, RetexError *err)
{
    const size_t n = (size_t)accel->source->nprimitives + 1;
    Use *uses = malloc(n * sizeof *uses);
    int count = uses ? list_uses(accel->source, uses) : 0, code = 0;

    if (!uses)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the scene's geometry");
    for (int i = 0, end; i < count && code == 0; i = end) {
        end = i + 1;
        while (end < count && uses[end].mesh->faces == uses[i].mesh->faces)
            end++;
        if ((double)(end - i - 1) * uses[i].mesh->nfaces < SAVED_TRIANGLES)
            continue;
        if (!accel->shared)
            accel->shared = calloc(n, sizeof(*accel->shared));
        code = accel->shared ? share(accel, &uses[i], end - i, err)
                               : retex_fail(err, RETEX_ENOMEM, "no memory for the scene's geometry");
    }
    free(uses);
    if (code == 0 && accel->source->nprototypes > 0)
        code = share_prototypes(accel, err);
    return code;
}

void accel_free_shared(Accel *accel)
{
    while (accel->all_shared) {
        Shared *shared = accel->all_shared;
        accel->all_shared = shared->next;
        free(shared->mesh);
        free(shared->scene);
        free(shared);
    }
    free(accel->shared);
    free(accel->prototypes);
    accel->shared = accel->prototypes = NULL;
}
