/* Is a point inside an object? As POV-Ray has it: a plane and a disc have all that lies below them, open cones and
 * cylinders what they would have with their caps, meshes something only with inside_vector. */
#include "sdl/build/builder.h"
#include "shape/shape.h"

static int shape_contains(Sdl *sdl, const Shape *shape, Vec3 p)
{
    if (shape->mesh)
        return shape->mesh->closed_inside && mesh_contains(sdl, shape->mesh, p);
    return shape->ops->inside && shape->ops->inside(shape, p);
}

static int object_contains(Sdl *sdl, const Object *object, Vec3 p)
{
    int inside = 0;
    object_report(sdl, object);
    sdl_step(sdl, 1);
    p = transform_inverse_point(&object->transform, p);
    if (object->kind == OBJECT_SHAPE)
        inside = shape_contains(sdl, &object->shape, p);
    else {
        if (object->kind == OBJECT_LIGHT) /* what it looks like */
            p = vec_sub(p, object->light->location);
        for (const ObjectList *list = object->children; list && !inside; list = list->next)
            inside = object_contains(sdl, list->object, p);
    }
    return inside ^ ((object->flags & OBJECT_INVERSE) != 0);
}

int object_inside(Sdl *sdl, const Value *value, Vec3 p)
{
    if (value->kind != VALUE_OBJECT && value->kind != VALUE_LIGHT)
        return -1;
    return isfinite(p.x + p.y + p.z) && object_contains(sdl, value->data, p);
}
