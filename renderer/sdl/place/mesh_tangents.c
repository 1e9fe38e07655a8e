/* Smooth tangents for the meshes that have normal maps. */
#include "sdl/place/place.h"
#include "shape/surface.h"

static int has_normal_map(const Normal *normal)
{
    if (!normal)
        return 0;
    int any = normal->kind == NORMAL_TANGENT;
    for (int i = 0; i < normal->nentries && !any; i++)
        any = has_normal_map(normal->entries[i].normal);
    return any;
}

static void add_for(Sdl *sdl, const Mesh *mesh, const Texture *texture)
{
    int any = 0;
    if (!mesh || mesh->tangents || !texture)
        return;
    for (int k = 0; k < texture_leaf_count(texture) && !any; k++) {
        const Texture *leaf = texture_leaf(texture, k);
        any = has_normal_map(leaf->normal) || (leaf->finish && leaf->finish->retex.clearcoat_normal);
    }
    Mesh *own = (Mesh *)mesh, *second = (Mesh *)mesh->second; /* they are this scene's own */
    Arena *arena = sdl_arena(sdl);
    if (any && (!mesh_add_tangents(arena, own) || (second && !mesh_add_tangents(arena, second))))
        sdl_error(sdl, "out of memory: tangents of a mesh");
}

void add_tangents(Sdl *sdl)
{
    const Scene *scene = sdl_scene(sdl);
    for (int i = 0; i < scene->nprimitives; i++) {
        const Primitive *p = &scene->primitives[i];
        add_for(sdl, p->shape.mesh, p->texture);
        add_for(sdl, p->shape.mesh, p->interior_texture);
        for (int j = 0; p->shape.mesh && p->shape.textures && j < p->shape.textures->count; j++)
            add_for(sdl, p->shape.mesh, p->shape.textures->list[j]);
    }
    for (int i = 0; i < scene->ninstances; i++) {
        const Instance *instance = &scene->instances[i];
        for (int j = 0; instance->texture && j < instance->prototype->count; j++)
            add_for(sdl, scene->primitives[instance->prototype->first + j].shape.mesh, instance->texture);
    }
}
