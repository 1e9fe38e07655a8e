/* The box around an object, for min_extent and max_extent. */
#include <string.h>
#include "sdl/build/builder.h"
#include "shape/surface.h"

#define EVERYWHERE 1e10 /* what a plane reaches; POV-Ray's figure */

static void widen(Vec3 *low, Vec3 *high, Vec3 p)
{
    *low = vec3(fmin(low->x, p.x), fmin(low->y, p.y), fmin(low->z, p.z));
    *high = vec3(fmax(high->x, p.x), fmax(high->y, p.y), fmax(high->z, p.z));
}

static void extent(Sdl *sdl, const Object *object, const Transform *outer, Vec3 *low, Vec3 *high)
{
    Transform to_world = transform_then(object->transform, *outer);
    sdl_step(sdl, 1);
    if (object->kind == OBJECT_SHAPE) {
        Primitive p = {.shape = object->shape, .transform = to_world};
        Vec3 a = vec3(-EVERYWHERE, -EVERYWHERE, -EVERYWHERE), b = vec_neg(a);
        shape_bounds(&p, &a, &b);
        widen(low, high, a);
        widen(low, high, b);
    } else if (object->kind == OBJECT_GROUP)
        for (const ObjectList *list = object->children; list; list = list->next)
            extent(sdl, list->object, &to_world, low, high);
}

int object_extent(Sdl *sdl, const Value *value, Vec3 *low, Vec3 *high)
{
    if (value->kind != VALUE_OBJECT && value->kind != VALUE_LIGHT)
        return 0;
    const Transform none = transform_identity();
    *low = vec3(INFINITY, INFINITY, INFINITY);
    *high = vec3(-INFINITY, -INFINITY, -INFINITY);
    extent(sdl, value->data, &none, low, high);
    if (!(low->x <= high->x))
        *low = *high = vec3(0, 0, 0); /* nothing there, or nothing that is supported */
    return 1;
}
