/* The scene as a whole: which textures its primitives have, and closing it. */
#include "scene/scene.h"

const Texture *primitive_texture(const Primitive *p, int k, int *target)
{
    const int interior = p->interior_texture != NULL, part = k - 1 - interior;
    if (k == 0) {
        *target = p->target;
        return p->texture;
    }
    if (k == 1 && interior) {
        *target = p->interior_target;
        return p->interior_texture;
    }
    const int parts = p->shape.textures ? p->shape.textures->count : 0;
    if (part >= parts && p->faces && part - parts < p->faces->count) {
        *target = p->faces->textures[part - parts].target;
        return p->faces->textures[part - parts].texture;
    }
    if (part >= parts)
        return NULL;
    *target = p->face_targets ? p->face_targets[part] : p->target;
    return p->shape.textures->list[part];
}

const Texture *primitive_target_texture(const Primitive *p, int target)
{
    const Texture *texture;
    int whole;
    for (int k = 0; (texture = primitive_texture(p, k, &whole)); k++)
        for (int j = 0; j < texture_leaf_count(texture); j++)
            if ((texture->tree ? first_target(texture_leaf(texture, j)->target, whole) : whole) == target)
                return texture_leaf(texture, j);
    return NULL;
}

const Texture *instance_target_texture(const Scene *scene, const Instance *instance, int target, const Primitive **of)
{
    const Primitive *p = scene->primitives + instance->prototype->first, *end = p + instance->prototype->count;
    const Texture *texture = instance->texture;
    if (instance->target == target && p < end) {
        if (of)
            *of = p;
        return texture_leaf(p->inherits ? texture : p->texture, 0);
    }
    while (p < end && !p->inherits)
        p++;
    for (int j = 0; p < end && j < texture_leaf_count(texture); j++) {
        const Texture *leaf = texture_leaf(texture, j);
        const int whole = instance->texture_target;
        if ((texture->tree ? first_target(leaf->target, whole) : whole) != target)
            continue;
        if (of)
            *of = p;
        return leaf;
    }
    return NULL;
}

/* ---- emitters ---- */

static int texture_emits(const Texture *texture)
{
    for (int k = 0; k < texture_leaf_count(texture); k++)
        if (!rgb_is_black(texture_leaf(texture, k)->finish->emission))
            return 1;
    return 0;
}

int primitive_emits(const Primitive *p)
{
    const Texture *texture;
    int target, emits = 0;
    for (int k = 0; !emits && (texture = primitive_texture(p, k, &target)); k++)
        emits = texture_emits(texture);
    return emits;
}

int scene_has_emitters(const Scene *scene)
{
    for (int k = 0; k < scene->nprimitives; k++)
        if (primitive_emits(&scene->primitives[k]))
            return 1;
    for (int i = 0; i < scene->ninstances; i++)
        if (instance_emits(scene, &scene->instances[i]))
            return 1;
    return 0;
}

int instance_emits(const Scene *scene, const Instance *instance)
{
    int emits = instance->texture && texture_emits(instance->texture);
    for (int k = 0; k < instance->prototype->count && !emits; k++)
        emits = primitive_emits(&scene->primitives[instance->prototype->first + k]);
    return emits;
}

/* ---- closing ---- */

int scene_caustic_sources(const Scene *scene)
{
    int count = 0;
    for (int k = 0; k < scene->nlights; k++)
        count += scene->lights[k].caustics != 0;
    return count;
}

void scene_close(Scene **scene)
{
    if (!scene || !*scene)
        return;
    Scene *s = *scene;
    /* Image maps of one file share its texture. */
    for (int i = 0; i < s->nimages; i++) {
        RetexTexture *texture = s->images[i]->texture;
        for (int j = i; texture && j < s->nimages; j++)
            if (s->images[j]->texture == texture)
                s->images[j]->texture = NULL;
        retex_texture_close(&texture);
    }
    Arena *arena = s->arena; /* the scene itself lives in it */
    arena_close(&arena);
    *scene = NULL;
}
