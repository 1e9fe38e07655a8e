/* Is a point inside an object? As POV-Ray has it: a plane and a disc have all that lies below them, open cones and
 * cylinders what they would have with their caps, meshes something only with inside_vector. */
#include "sdl/build/builder.h"

static int shape_holds(Sdl *sdl, const Object *object, Vec3 p)
{
    switch (object->shape) {
    case SHAPE_SPHERE:
        return vec_dot(p, p) < 1;
    case SHAPE_BOX:
        return p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1 && p.z >= 0 && p.z <= 1;
    case SHAPE_PLANE:
        return p.y < 0;
    case SHAPE_CONE:
        return p.z >= 0 && p.z <= 1 && hypot(p.x, p.y) <= object->r0 + (object->r1 - object->r0) * p.z;
    case SHAPE_TORUS:
        return hypot(hypot(p.x, p.z) - object->r0, p.y) <= fabs(object->r1);
    case SHAPE_DISC:
        return p.z < 0;
    case SHAPE_MESH:
        return object->mesh->closed_inside && mesh_contains(sdl, object->mesh, p);
    }
    return 0;
}

static int holds(Sdl *sdl, const Object *object, Vec3 p)
{
    int inside = 0;
    gaps_report(sdl, &object->gaps);
    sdl_step(sdl, 1);
    p = transform_inverse_point(&object->transform, p);
    if (object->kind == OBJECT_SHAPE)
        inside = shape_holds(sdl, object, p);
    else {
        if (object->kind == OBJECT_LIGHT) /* what it looks like */
            p = vec_sub(p, object->light->location);
        for (const ObjectList *list = object->children; list && !inside; list = list->next)
            inside = holds(sdl, list->object, p);
    }
    return inside ^ ((object->flags & OBJECT_INVERSE) != 0);
}

int object_inside(Sdl *sdl, const Value *value, Vec3 p)
{
    if (value->kind != VALUE_OBJECT && value->kind != VALUE_LIGHT)
        return -1;
    return isfinite(p.x + p.y + p.z) && holds(sdl, value->data, p);
}
