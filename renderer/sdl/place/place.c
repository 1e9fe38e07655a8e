/* Placing: an object statement at top level becomes primitives and lights of the Scene, in world space. Children
 * inherit what they lack from the compounds around them; an object without any texture has the default texture in
 * force where it is placed. */
#include <string.h>
#include "light/ies.h"
#include "light/source.h"
#include "sdl/object/csg.h"
#include "sdl/place/place.h"
#include "shape/shape.h"

/* ---- textures in world space ---- */

static size_t hash_placed(const ParsedTexture *texture, const Transform *by)
{
    const unsigned char *bytes = (const unsigned char *)by->m;
    size_t hash = (size_t)texture >> 4;
    for (size_t i = 0; i < sizeof by->m; i++)
        hash = hash * 31 + bytes[i];
    return (hash ^ hash >> 17) % PLACED_CACHE;
}

/* Moved, the same copy for the same move where it comes again soon: the children of a compound mostly share one. */
const ParsedTexture *texture_placed(Sdl *sdl, const ParsedTexture *texture, const Transform *by)
{
    if (!texture || transform_is_identity(by))
        return texture;
    PlacedTexture *last = &places_of(sdl)->placed[hash_placed(texture, by)];
    if (last->from != texture || memcmp(last->by.m, by->m, sizeof by->m) != 0) {
        last->to = texture_moved(sdl, texture, by);
        last->from = texture;
        last->by = *by;
    }
    return last->to;
}

static const ParsedTexture *texture_in_world(Sdl *sdl, const MovedTexture *moved, const Transform *outer,
                                             int uv_mapping)
{
    if (!moved->texture)
        return NULL;
    Transform by = moved->is_moved ? moved->transform : transform_identity();
    if (!uv_mapping)
        by = transform_then(by, *outer);
    return texture_placed(sdl, moved->texture, &by);
}

static void report_leaf(Sdl *sdl, const ParsedTexture *texture, void *context)
{
    (void)context;
    gaps_report(sdl, &texture->gaps);
    gaps_report(sdl, &parsed_pigment(texture->texture.pigment)->gaps);
    gaps_report(sdl, &parsed_finish(texture->texture.finish)->gaps);
    if (texture->texture.normal)
        gaps_report(sdl, &parsed_normal(texture->texture.normal)->gaps);
}

static void report_selector(Sdl *sdl, const ParsedTextureMap *map, void *context)
{
    (void)context;
    gaps_report(sdl, &map->selector->gaps);
}

void texture_report(Sdl *sdl, const ParsedTexture *texture)
{
    texture_visit(sdl, texture, report_leaf, report_selector, NULL);
}

/* The pointer is the same where nothing varies: it tells media apart. */
static const ParsedInterior *interior_placed(Sdl *sdl, const Object *object, const Transform *outer)
{
    if (!interior_varies(object->interior))
        return object->interior;
    const Transform by = transform_then(object->interior_transform, *outer);
    return interior_moved(sdl, object->interior, &by);
}

/* ---- shapes ---- */

/* A shape's own textures in world space. */
static const FaceTextures *placed_textures(Sdl *sdl, const Object *object, const Transform *to_world)
{
    PlaceState *places = places_of(sdl);
    const FaceTextures *from = object->shape.textures;
    const Transform by = object->uv_mapping ? transform_identity() : *to_world;
    if (!from || (places->placed_textures_from == from && !object->uv_mapping &&
                  memcmp(&places->placed_textures_by, &by, sizeof by) == 0))
        return from ? places->placed_textures : NULL;
    FaceTextures *textures = sdl_alloc(sdl, sizeof *textures);
    textures->count = from->count;
    textures->list = sdl_alloc(sdl, (size_t)from->count * sizeof *textures->list);
    for (int i = 0; i < from->count; i++) {
        const ParsedTexture *texture = texture_placed(sdl, parsed_texture(from->list[i]), &by);
        if (object->uv_mapping)
            texture = texture_uv_mapped(sdl, texture);
        texture_report(sdl, texture);
        textures->list[i] = &texture->texture;
    }
    if (!object->uv_mapping) {
        places->placed_textures_from = from;
        places->placed_textures_by = by;
        places->placed_textures = textures;
    }
    return textures;
}

/* Old scenes write the index of refraction in the finish. */
static const ParsedInterior *interior_of_finish(Sdl *sdl, const ParsedTexture *texture)
{
    const ParsedFinish *finish = parsed_finish(texture->texture.finish);
    if (finish->ior <= 0)
        return NULL;
    ParsedInterior *interior = sdl_alloc(sdl, sizeof *interior);
    interior->interior.ior = finish->ior;
    return interior;
}

static Primitive *primitive_new(Sdl *sdl)
{
    Scene *scene = sdl_scene(sdl);
    PlaceState *places = places_of(sdl);
    int capacity = places->primitive_capacity;
    places->single_triangle =
        sdl_grow(sdl, places->single_triangle, scene->nprimitives, &capacity, sizeof *places->single_triangle);
    scene->primitives = sdl_grow(sdl, scene->primitives, scene->nprimitives, &places->primitive_capacity,
                                     sizeof *scene->primitives);
    Primitive *primitive = &scene->primitives[scene->nprimitives++];
    memset(primitive, 0, sizeof *primitive);
    return primitive;
}

/* in->csg: its leaf, where it is an operand. */
static void place_shape(Sdl *sdl, const Object *object, const Inherited *in)
{
    const ParsedTexture *texture = in->texture ? in->texture : textures_of(sdl)->default_texture;
    const ParsedTexture *inside = in->interior_texture;
    const int inherits = in->prototype && in->texture == places_of(sdl)->inherited_texture;
    const ParsedInterior *interior = in->interior ? in->interior : inherits ? NULL : interior_of_finish(sdl, texture);
    if (in->uv_mapping && !inherits) {
        texture = texture_uv_mapped(sdl, texture);
        inside = texture_uv_mapped(sdl, inside);
    }
    if (!inherits)
        texture_report(sdl, texture);
    texture_report(sdl, inside);
    if (interior)
        gaps_report(sdl, &interior->gaps);
    if (in->csg && object->shape.mesh)
        index_mesh(sdl, object->shape.mesh);
    const FaceTextures *textures = placed_textures(sdl, object, &in->to_world);
    Primitive *p = primitive_new(sdl);
    places_of(sdl)->single_triangle[sdl_scene(sdl)->nprimitives - 1] =
        object->single_triangle == TRIANGLE_SINGLE && !in->csg;
    p->csg = in->csg;
    p->prototype = in->prototype;
    p->inherits = inherits;
    if (inherits)
        ((Prototype *)p->prototype)->inherits = 1;
    p->shape = object->shape;
    p->shape.textures = textures;
    p->transform = in->to_world;
    p->texture = &texture->texture;
    p->interior_texture = inside ? &inside->texture : NULL;
    p->interior = interior ? &interior->interior : NULL;
    p->no_shadow = (in->flags & OBJECT_NO_SHADOW) != 0;
    p->no_image = (in->flags & OBJECT_NO_IMAGE) != 0;
    p->no_reflection = (in->flags & OBJECT_NO_REFLECTION) != 0;
    p->inverse = (in->flags & OBJECT_INVERSE) != 0;
    p->hollow = (in->flags & OBJECT_HOLLOW) != 0;
    p->double_illuminate = (in->flags & OBJECT_DOUBLE_ILLUMINATE) != 0;
    p->light_group = in->light_group;
    if (in->flags & OBJECT_PHOTON_TARGET)
        p->caustics = (in->flags & OBJECT_PHOTONS_REFRACT ? CAUSTICS_REFRACT : 0) |
                      (in->flags & OBJECT_PHOTONS_REFLECT ? CAUSTICS_REFLECT : 0);
    p->idents = in->idents;
    p->places = in->places;
    p->line = object->line;
    p->target = p->interior_target = -1;
    cutaway_add(sdl, in, texture);
}

/* ---- lights ---- */

static const Csg *placed_projector(Sdl *sdl, const Object *projector, const Transform *to_world)
{
    Object *placed = object_new(sdl, OBJECT_EMPTY);
    *placed = *projector;
    object_move(placed, to_world);
    return csg_of_object(sdl, placed);
}

/* A luminaire that is not aimed hangs. Spotlights always are. */
static Vec3 ies_axis(const Light *light)
{
    return !light->is_aimed && light->ops == &light_point ? vec3(0, -1, 0) : light_axis(light);
}

static void place_light(Sdl *sdl, const Object *object, const Inherited *here)
{
    const Transform *to_world = &here->to_world;
    Scene *scene = sdl_scene(sdl);
    scene->lights =
        sdl_grow(sdl, scene->lights, scene->nlights, &places_of(sdl)->light_capacity, sizeof *scene->lights);
    Light *light = &scene->lights[scene->nlights++];
    *light = *object->light;
    if (light->ies)
        ies_place(light, ies_axis(light), to_world);
    light->location = transform_point(to_world, light->location);
    light->point_at = transform_point(to_world, light->point_at);
    light->axis1 = transform_vector(to_world, light->axis1);
    light->axis2 = transform_vector(to_world, light->axis2);
    if (light->fade_distance <= 0)
        light->fade_power = 0;
    if (light->ops->settle)
        light->ops->settle(light);
    light->light_group = here->light_group;
    light->idents = here->idents, light->places = here->places;
    if (object->projector)
        light->projected_through = placed_projector(sdl, object->projector, to_world);
}

/* ---- the walk ---- */

static void place_children(Sdl *sdl, const ObjectList *list, const Inherited *around)
{
    for (; list; list = list->next)
        place_object(sdl, list->object, around);
}

/* The object of looks_like is placed at its light, and casts no shadow. */
static void place_looks_like(Sdl *sdl, const Object *object, const Inherited *here)
{
    Inherited look = *here;
    look.to_world = transform_then(transform_translate(object->light->location), here->to_world);
    look.flags |= OBJECT_NO_SHADOW;
    look.csg = NULL;
    place_children(sdl, object->children, &look);
}

/* Where the other operands of an intersection or difference have no interior, cut faces most of all, it is that of the
 * first one, for that is what lies behind them. */
static void place_operands(Sdl *sdl, const Object *object, const Inherited *around)
{
    const Scene *scene = sdl_scene(sdl);
    Inherited here = *around;
    for (const ObjectList *list = object->children; list; list = list->next) {
        const int before = scene->nprimitives;
        place_object(sdl, list->object, &here);
        here.is_taken_off |= object->difference && list->object->kind != OBJECT_LIGHT;
        if (scene->nprimitives == before)
            continue;
        const Primitive *first = &scene->primitives[before];
        if (object->csg == CSG_INTERSECTION && !here.interior)
            here.interior = parsed_interior(first->interior);
    }
}

/* Whether an object that is no operand is a tree of CSG. A plain union is its children one by one. */
static int begins_csg(const Object *object, unsigned flags)
{
    switch (object->kind) {
    case OBJECT_SHAPE:
        return object->clips || (object->bounds && !object->shape.ops->bounds);
    case OBJECT_COMPOUND:
        return object->clips || object->csg != CSG_UNION ||
               ((flags & OBJECT_INVERSE) && object->children && object->children->next);
    default:
        return 0;
    }
}

static void add_root(Sdl *sdl, CsgNode *root, const Prototype *prototype, int line)
{
    PlaceState *places = places_of(sdl);
    places->csg_roots =
        sdl_grow(sdl, places->csg_roots, places->ncsg_roots, &places->csg_capacity, sizeof *places->csg_roots);
    places->csg_roots[places->ncsg_roots++] = (CsgRoot){root, prototype, line};
}

/* What there is of the object itself and in it; here.csg is its own node. */
static void place_contents(Sdl *sdl, const Object *object, const Inherited *here)
{
    switch (object->kind) {
    case OBJECT_SHAPE:
        place_shape(sdl, object, here);
        break;
    case OBJECT_COMPOUND:
        if (object->csg == CSG_UNION)
            place_children(sdl, object->children, here);
        else
            place_operands(sdl, object, here);
        break;
    case OBJECT_LIGHT:
        place_light(sdl, object, here);
        place_looks_like(sdl, object, here);
        break;
    case OBJECT_EMPTY:
        break;
    }
}

unsigned flags_within(const Object *object, const Inherited *around)
{
    return (around->flags | (object->flags & ~OBJECT_INVERSE)) ^ (object->flags & OBJECT_INVERSE);
}

void place_object(Sdl *sdl, const Object *object, const Inherited *around)
{
    Inherited here = *around;
    sdl_step(sdl, 1);
    object_report(sdl, object);
    if ((object->kind == OBJECT_EMPTY && !around->csg) || place_instance(sdl, object, around))
        return;
    here.to_world = transform_then(object->transform, around->to_world);
    here.uv_mapping = object->uv_mapping;
    const ParsedTexture *texture = texture_in_world(sdl, &object->texture, &around->to_world, object->uv_mapping);
    const ParsedTexture *inside =
        texture_in_world(sdl, &object->interior_texture, &around->to_world, object->uv_mapping);
    if (texture)
        here.texture = texture;
    else
        here.uv_mapping |= around->uv_mapping; /* comes along with the texture */
    if (inside)
        here.interior_texture = inside;
    if (object->interior)
        here.interior = interior_placed(sdl, object, &around->to_world);
    here.flags = flags_within(object, around);
    here.idents = sdl_ident_join(sdl, around->idents, object->idents);
    here.places = places_join(sdl, object->places, around->places);
    if (object->flags & OBJECT_LIGHT_GROUP) {
        LightGroup *light_group = sdl_alloc(sdl, sizeof *light_group);
        light_group->global_lights = around->light_group ? around->light_group->global_lights /* as POV-Ray has it */
                                                         : (object->flags & OBJECT_GLOBAL_LIGHTS) != 0;
        here.light_group = light_group;
    }
    if (object->kind != OBJECT_LIGHT && (around->csg || begins_csg(object, here.flags)))
        here.csg = object_csg_node(sdl, object, &around->to_world, here.flags & OBJECT_INVERSE, around->csg);
    Cutaway cutaway = {.nbare = 0};
    if ((here.flags & OBJECT_CUTAWAY_TEXTURES) && here.csg && !here.cutaway)
        here.cutaway = &cutaway, here.is_taken_off = 0;
    place_contents(sdl, object, &here);
    cutaway_complete(sdl, &cutaway);
    if (here.csg && !around->csg)
        add_root(sdl, here.csg, here.prototype, object->line);
}

/* Primitives stay where they are from now on. */
void complete_csgs(Sdl *sdl)
{
    Scene *scene = sdl_scene(sdl);
    const PlaceState *places = places_of(sdl);
    for (int i = 0; i < scene->nprimitives; i++)
        if (scene->primitives[i].csg) {
            CsgNode *leaf = (CsgNode *)scene->primitives[i].csg;
            leaf->primitive = &scene->primitives[i];
            leaf->index = scene->primitives[i].prototype ? i - scene->primitives[i].prototype->first : i;
        }
    /* Roots of one prototype are neighbours. */
    struct Csg **all = sdl_alloc(sdl, (size_t)(places->ncsg_roots + 1) * sizeof *all);
    scene->csgs = sdl_alloc(sdl, (size_t)(places->ncsg_roots + 1) * sizeof *scene->csgs);
    for (int i = 0; i < places->ncsg_roots; i++) {
        const CsgRoot *root = &places->csg_roots[i];
        Prototype *prototype = (Prototype *)root->prototype;
        all[i] = csg_complete(sdl, root->root);
        all[i]->line = root->line;
        if (!prototype)
            scene->csgs[scene->ncsgs++] = all[i];
        else if (prototype->ncsgs++ == 0)
            prototype->csgs = &all[i];
    }
}

void place_begin(Sdl *sdl)
{
    builder_of(sdl)->place = sdl_alloc(sdl, sizeof *builder_of(sdl)->place);
}
