/* Copies of compounds. The first copies of one are placed as primitives of their own, which rays meet faster. Once many
 * parts are there, it becomes a prototype, in the space of its contents, and further copies are instances of it: a
 * transform, a texture for the parts that have none, and names. */
#include <string.h>
#include "sdl/place/place.h"

enum { SEPARATE_PARTS = 8192, PROTOTYPE_PARTS = 2000000, COMPOUND_BUCKETS = 1024 };

/* What the contents of a prototype depend on. */
typedef struct CompoundKey {
    const ObjectList *children;
    CsgKind csg;
    const ClipList *clips, *bounds;
    unsigned flags;
    const ParsedInterior *interior;
    const LightGroup *light_group;
} CompoundKey;

typedef struct CopiedCompound {
    CompoundKey key;
    double parts;         /* placed so far */
    int is_separate;      /* its copies cannot be instances */
    Prototype *prototype; /* or NULL */
    struct CopiedCompound *next;
} CopiedCompound;

struct CopiedCompounds {
    CopiedCompound *buckets[COMPOUND_BUCKETS];
};

static int same_key(const CompoundKey *a, const CompoundKey *b)
{
    return a->children == b->children && a->csg == b->csg && a->clips == b->clips && a->bounds == b->bounds &&
           a->flags == b->flags && a->interior == b->interior && a->light_group == b->light_group;
}

static CopiedCompound *compound_of(Sdl *sdl, const CompoundKey *key)
{
    PlaceState *places = places_of(sdl);
    if (!places->copied)
        places->copied = sdl_alloc(sdl, sizeof *places->copied);
    CopiedCompound **bucket =
        &places->copied->buckets[((uintptr_t)key->children >> 4) * 2654435761u % COMPOUND_BUCKETS];
    for (CopiedCompound *compound = *bucket; compound; compound = compound->next)
        if (same_key(&compound->key, key))
            return compound;
    CopiedCompound *compound = sdl_alloc(sdl, sizeof *compound);
    *compound = (CopiedCompound){.key = *key, .next = *bucket};
    return *bucket = compound;
}

/* ---- what can be an instance ---- */

static void find_emission(Sdl *sdl, const ParsedTexture *leaf, void *context)
{
    const Finish *finish = leaf->texture.finish;
    (void)sdl;
    if (!rgb_is_black(finish->emission) || rgb_max(finish->ambient) >= 1)
        *(int *)context = 1;
}

static int may_emit(Sdl *sdl, const ParsedTexture *texture)
{
    int found = 0;
    if (texture)
        texture_visit(sdl, texture, find_emission, NULL, &found);
    return found;
}

static int faces_may_emit(Sdl *sdl, const FaceTextures *textures)
{
    for (int i = 0; textures && i < textures->count; i++)
        if (may_emit(sdl, parsed_texture(textures->list[i])))
            return 1;
    return 0;
}

/* Lights are where their primitives are, a texture that comes with uv_mapping from within is no copy's, and with
 * cutaway_textures it matters whether there is a texture. */
static int can_be_copied(Sdl *sdl, const Object *object, int has_texture)
{
    sdl_step(sdl, 1);
    has_texture |= object->texture.texture != NULL;
    if (object->kind == OBJECT_LIGHT || (object->flags & OBJECT_CUTAWAY_TEXTURES) ||
        (object->uv_mapping && !has_texture) || interior_varies(object->interior) ||
        may_emit(sdl, object->texture.texture) || may_emit(sdl, object->interior_texture.texture) ||
        faces_may_emit(sdl, object->shape.textures))
        return 0;
    for (const ObjectList *list = object->children; list; list = list->next)
        if (!can_be_copied(sdl, list->object, has_texture))
            return 0;
    return 1;
}

static int children_can_be_copied(Sdl *sdl, const Object *object)
{
    for (const ObjectList *list = object->children; list; list = list->next)
        if (!can_be_copied(sdl, list->object, 0))
            return 0;
    return 1;
}

/* ---- prototypes ---- */

static Prototype *prototype_new(Sdl *sdl, const Object *object, const CompoundKey *key)
{
    TextureState *textures = textures_of(sdl);
    PlaceState *places = places_of(sdl);
    Scene *scene = sdl_scene(sdl);
    Prototype *prototype = sdl_alloc(sdl, sizeof *prototype);
    Object contents = *object;
    contents.transform = transform_identity();
    contents.texture = contents.interior_texture = (MovedTexture){.texture = NULL};
    contents.interior = NULL;
    contents.flags = 0;
    contents.uv_mapping = 0;
    contents.idents = NULL;
    contents.places = NULL;
    prototype->number = scene->nprototypes++;
    prototype->next = places->prototypes;
    places->prototypes = prototype;
    places->inherited_texture = texture_copy(sdl, textures->default_texture);
    const Inherited within = {.to_world = transform_identity(),
                              .texture = places->inherited_texture,
                              .interior = key->interior,
                              .flags = key->flags,
                              .light_group = key->light_group,
                              .prototype = prototype};
    place_object(sdl, &contents, &within);
    places->inherited_texture = NULL;
    return prototype;
}

/* ---- instances ---- */

static int equal_transforms(const Transform *a, const Transform *b)
{
    for (int i = 0; i < 12; i++)
        if (a->m[i / 4][i % 4] != b->m[i / 4][i % 4])
            return 0;
    return 1;
}

/* The texture of parts that have none, in the prototype's space: most often it was given before any transform, and is
 * as it was given. */
static const ParsedTexture *instance_texture(Sdl *sdl, const Object *object, const Inherited *around,
                                             const Transform *to_world)
{
    const MovedTexture *own = &object->texture;
    const ParsedTexture *texture = own->texture;
    int uv_mapping = object->uv_mapping;
    if (!texture) {
        const Transform back = transform_inverse(*to_world);
        texture = around->texture ? around->texture : textures_of(sdl)->default_texture;
        texture = texture_placed(sdl, texture, &back);
        uv_mapping |= around->uv_mapping;
    } else if (uv_mapping) {
        texture = own->is_moved ? texture_placed(sdl, texture, &own->transform) : texture;
    } else if (!(own->is_moved ? equal_transforms(&own->transform, &object->transform)
                               : transform_is_identity(&object->transform))) {
        const Transform back = transform_inverse(object->transform);
        const Transform by = own->is_moved ? transform_then(own->transform, back) : back;
        texture = texture_placed(sdl, texture, &by);
    }
    return uv_mapping ? texture_uv_mapped(sdl, texture) : texture;
}

static void add_instance(Sdl *sdl, const Object *object, const Inherited *around, const Prototype *prototype,
                         const ParsedTexture *texture, const Transform *to_world)
{
    Scene *scene = sdl_scene(sdl);
    scene->instances = sdl_grow(sdl, scene->instances, scene->ninstances, &places_of(sdl)->instance_capacity,
                                    sizeof *scene->instances);
    object_report(sdl, object);
    texture_report(sdl, texture);
    scene->instances[scene->ninstances++] = (Instance){.prototype = prototype,
                                                       .transform = *to_world,
                                                       .texture = texture ? &texture->texture : NULL,
                                                       .idents = sdl_ident_join(sdl, around->idents, object->idents),
                                                       .places = places_join(sdl, object->places, around->places),
                                                       .target = -1,
                                                       .texture_target = -1,
                                                       .lamp = -1,
                                                       .line = object->line};
}

int place_instance(Sdl *sdl, const Object *object, const Inherited *around)
{
    const CompoundKey key = {object->children,
                             object->csg,
                             object->clips,
                             object->bounds,
                             flags_within(object, around),
                             object->interior ? object->interior : around->interior,
                             around->light_group};
    if (object->kind != OBJECT_COMPOUND || around->csg || around->prototype || around->interior_texture ||
        object->interior_texture.texture || interior_varies(key.interior) || (key.flags & OBJECT_CUTAWAY_TEXTURES) ||
        object->parts > PROTOTYPE_PARTS)
        return 0;
    CopiedCompound *compound = compound_of(sdl, &key);
    compound->parts += object->parts;
    if (compound->is_separate || compound->parts <= SEPARATE_PARTS || compound->parts == object->parts)
        return 0;
    if (!compound->prototype && !children_can_be_copied(sdl, object)) {
        compound->is_separate = 1;
        return 0;
    }
    if (!compound->prototype)
        compound->prototype = prototype_new(sdl, object, &key);
    const Transform to_world = transform_then(object->transform, around->to_world);
    const ParsedTexture *texture = NULL;
    if (compound->prototype->inherits)
        texture = instance_texture(sdl, object, around, &to_world);
    /* Its finish would change the interior of parts. */
    if (may_emit(sdl, texture) || (texture && !key.interior && parsed_finish(texture->texture.finish)->ior > 0))
        return 0;
    add_instance(sdl, object, around, compound->prototype, texture, &to_world);
    return 1;
}

/* ---- when the scene is complete ---- */

void complete_prototypes(Sdl *sdl)
{
    Scene *scene = sdl_scene(sdl);
    scene->prototypes = sdl_alloc(sdl, (size_t)(scene->nprototypes + 1) * sizeof *scene->prototypes);
    for (const Prototype *p = places_of(sdl)->prototypes; p; p = p->next)
        scene->prototypes[p->number] = p;
    for (int i = 0; i < scene->nprimitives; i++) {
        Prototype *prototype = (Prototype *)scene->primitives[i].prototype;
        if (prototype && prototype->count++ == 0)
            prototype->first = i;
    }
}
