/* See materials.h. */
#include <stdlib.h>
#include <string.h>
#include "scene/materials.h"

ObjectPart object_part(const Scene *scene, const Primitive *p, int part)
{
    const FaceTextures *parts = p->shape.textures;
    const Texture *texture = part && parts && part <= parts->count ? parts->list[part - 1]
                             : part || p->inherits                 ? NULL
                                                                   : p->texture;
    return (ObjectPart){p->idents, p->places, texture, (int)(p - scene->primitives) + 1, part};
}

static int has_name(const IdentList *idents, const char *name)
{
    while (idents && strcmp(idents->name, name) != 0)
        idents = idents->next;
    return idents != NULL;
}

/* A name that all leaves came through, as textures. */
static int names_texture(const Texture *texture, const char *name)
{
    for (int k = 0; k < texture_leaf_count(texture); k++) {
        const Texture *leaf = texture_leaf(texture, k);
        if (!has_name(leaf->idents, name) || has_name(leaf->pigment->idents, name))
            return 0;
    }
    return 1;
}

/* ---- the list of uses ---- */

/* Counts them where there is no list yet. */
static void add_use(Materials *m, const void *key, int number, int part)
{
    if (m->uses)
        m->uses[m->count] = (struct MaterialUse){key, number, part};
    m->count++;
}

static void add_texture(Materials *m, const Texture *texture, int number, int part)
{
    add_use(m, texture, number, part);
    for (const IdentList *at = texture_leaf(texture, 0)->idents; at; at = at->next)
        if (names_texture(texture, at->name))
            add_use(m, at->name, number, part);
}

/* 0: all parts have textures of their own, and nothing shows the primitive's. */
static int shows_own(const Primitive *p)
{
    const Mesh *mesh = p->shape.mesh;
    int face = 0;
    if (!mesh || !p->shape.textures)
        return 1;
    while (face < mesh->nfaces && mesh->faces[face].texture >= 0)
        face++;
    return face < mesh->nfaces;
}

static void add_all(Materials *m)
{
    m->count = 0;
    for (int i = 0; i < m->scene->nprimitives; i++) {
        const Primitive *p = &m->scene->primitives[i];
        const FaceTextures *parts = p->shape.textures;
        if (!p->inherits && shows_own(p))
            add_texture(m, p->texture, i + 1, 0);
        for (int k = 0; parts && k < parts->count; k++)
            add_texture(m, parts->list[k], i + 1, k + 1);
    }
}

static int compare_keys(const void *a, const void *b)
{
    const uintptr_t x = (uintptr_t)a, y = (uintptr_t)b;
    return (x > y) - (x < y);
}

static int compare_uses(const void *a, const void *b)
{
    const struct MaterialUse *x = a, *y = b;
    const int keys = compare_keys(x->key, y->key);
    return keys ? keys : x->number != y->number ? (x->number > y->number) - (x->number < y->number) : x->part - y->part;
}

int materials_open(Materials *m, const Scene *scene)
{
    *m = (Materials){.scene = scene};
    add_all(m);
    m->uses = malloc(((size_t)m->count + 1) * sizeof *m->uses);
    if (!m->uses)
        return 0;
    add_all(m);
    qsort(m->uses, (size_t)m->count, sizeof *m->uses, compare_uses);
    return 1;
}

void materials_close(Materials *m)
{
    free(m->uses);
    m->uses = NULL;
}

/* The index of the first use whose key is not below this one; or, after: is above it. */
static int find(const Materials *m, const void *key, int after)
{
    int low = 0, high = m->count;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (compare_keys(m->uses[middle].key, key) < after)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* ---- what is asked ---- */

const char *materials_name(const Materials *m, const Texture *texture)
{
    const char *best = NULL;
    int least = 0, latest = 0;
    for (const IdentList *at = texture_leaf(texture, 0)->idents; at; at = at->next) {
        const int count = find(m, at->name, 1) - find(m, at->name, 0);
        if (!names_texture(texture, at->name))
            continue;
        if (!best || count < least || (count == least && at->line > latest))
            best = at->name, least = count, latest = at->line;
    }
    return best;
}

/* What tells a material: its name, or the texture itself. */
static const void *key_of(const Materials *m, const Texture *texture)
{
    const char *name = materials_name(m, texture);
    return name ? (const void *)name : texture;
}

int materials_first(const Materials *m, const ObjectPart *object, ObjectPart *first)
{
    const void *key = object->texture ? key_of(m, object->texture) : NULL;
    const int begin = key ? find(m, key, 0) : 0, end = key ? find(m, key, 1) : 0;
    if (end - begin < 2)
        return 0;
    for (int k = begin; k < end; k++) { /* others may have this name, but also one that fewer have */
        *first = object_part(m->scene, &m->scene->primitives[m->uses[k].number - 1], m->uses[k].part);
        if (key_of(m, first->texture) == key)
            return 1;
    }
    return 0;
}
