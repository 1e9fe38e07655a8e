/* blob: components, each with a transform and perhaps a texture of its own. */
#include "sdl/object/shape.h"
#include "shape/blob.h"
#include "shape/shape.h"
#include "shape/surface.h"

/* A blob that is being read. */
typedef struct BlobParts {
    BlobComponent *components;
    int count, capacity, texture_capacity;
    FaceTextures *textures;
} BlobParts;

static double length_after_comma(Sdl *sdl)
{
    sdl_optional_comma(sdl);
    return sdl_float(sdl);
}

static double strength_of(Sdl *sdl)
{
    sdl_optional_comma(sdl);
    sdl_accept(sdl, "strength");
    return sdl_float(sdl);
}

/* Modifiers up to the closing brace, as an object has them. */
static void finish_component(Sdl *sdl, BlobParts *parts, BlobComponent *component, const Transform *base)
{
    Object *modified = object_new(sdl, OBJECT_SHAPE);
    parse_object_modifiers(sdl, modified);
    component->transform = transform_then(*base, modified->transform);
    component->texture = -1;
    gaps_report(sdl, &modified->gaps);
    if (modified->texture.texture) {
        const ParsedTexture *texture = modified->texture.texture;
        if (modified->texture.is_moved)
            texture = texture_moved(sdl, texture, &modified->texture.transform);
        FaceTextures *all = parts->textures;
        all->list = sdl_grow(sdl, all->list, all->count, &parts->texture_capacity, sizeof *all->list);
        all->list[all->count] = &texture->texture;
        component->texture = all->count++;
    }
}

static void add_component(Sdl *sdl, BlobParts *parts, BlobComponent component)
{
    parts->components = sdl_grow(sdl, parts->components, parts->count, &parts->capacity, sizeof *parts->components);
    parts->components[parts->count++] = component;
}

static Transform ball(Sdl *sdl, Vec3 centre, double radius)
{
    Transform out;
    if (!transform_from_axes(vec3(radius, 0, 0), vec3(0, radius, 0), vec3(0, 0, radius), centre, &out))
        sdl_error(sdl, "a blob's component of radius %g", radius);
    return out;
}

static void sphere(Sdl *sdl, BlobParts *parts)
{
    BlobComponent component = {.length = 0};
    sdl_expect(sdl, "{");
    const Vec3 centre = sdl_vector(sdl);
    const double radius = length_after_comma(sdl);
    component.strength = strength_of(sdl);
    const Transform base = ball(sdl, centre, radius);
    finish_component(sdl, parts, &component, &base);
    add_component(sdl, parts, component);
}

static void cylinder(Sdl *sdl, BlobParts *parts)
{
    BlobComponent component = {.length = 0};
    Vec3 s, t;
    Transform base;
    sdl_expect(sdl, "{");
    const Vec3 from = sdl_vector(sdl);
    sdl_optional_comma(sdl);
    const Vec3 axis = vec_sub(sdl_vector(sdl), from), along = vec_normalize(axis);
    const double radius = length_after_comma(sdl);
    component.strength = strength_of(sdl);
    component.length = vec_length(axis) / fabs(radius);
    vec_frame(along, &s, &t);
    if (component.length == 0)
        base = ball(sdl, from, radius);
    else if (!transform_from_axes(vec_scale(s, radius), vec_scale(t, radius), vec_scale(along, fabs(radius)), from,
                                  &base))
        sdl_error(sdl, "a blob's component of radius %g", radius);
    finish_component(sdl, parts, &component, &base);
    add_component(sdl, parts, component);
}

/* The old form, without a block: strength, radius, centre. */
static void component(Sdl *sdl, BlobParts *parts)
{
    BlobComponent component = {.texture = -1};
    component.strength = sdl_float(sdl);
    const double radius = length_after_comma(sdl);
    sdl_optional_comma(sdl);
    component.transform = ball(sdl, sdl_vector(sdl), radius);
    add_component(sdl, parts, component);
}

void parse_blob(Sdl *sdl, Object *object)
{
    BlobParts parts = {.textures = sdl_alloc(sdl, sizeof *parts.textures)};
    Blob *blob = sdl_alloc(sdl, sizeof *blob);
    blob->threshold = 1;
    for (;;) {
        if (sdl_accept(sdl, "threshold"))
            blob->threshold = sdl_float(sdl);
        else if (sdl_accept(sdl, "sphere"))
            sphere(sdl, &parts);
        else if (sdl_accept(sdl, "cylinder"))
            cylinder(sdl, &parts);
        else if (sdl_accept(sdl, "component"))
            component(sdl, &parts);
        else
            break;
        sdl_optional_comma(sdl);
    }
    blob->components = parts.components;
    blob->ncomponents = parts.count;
    object->shape.ops = &shape_blob;
    object->shape.data = blob;
    object->shape.textures = parts.textures->count > 0 ? parts.textures : NULL;
    if (parts.count == 0 || !(blob->threshold > 0)) {
        sdl_warn(sdl, parts.count == 0 ? "a blob without components: it is left out"
                                       : "a blob whose threshold is not above 0: it is left out");
        object->kind = OBJECT_EMPTY;
        return;
    }
    const Primitive itself = {.shape = object->shape, .transform = transform_identity()};
    shape_bounds(&itself, &blob->low, &blob->high);
}
