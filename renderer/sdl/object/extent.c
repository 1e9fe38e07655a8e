/* The box around an object, for min_extent and max_extent: as tight as the shapes' own. Of an intersection it is what
 * the boxes of its operands have in common; operands that are inverse cut nothing off, but for half spaces. What
 * reaches to infinity in one direction is taken to do so in all. As in POV-Ray, clipped_by and bounded_by do not
 * count. */
#include "sdl/object/object.h"
#include "shape/shape.h"
#include "shape/surface.h"

#define EVERYWHERE 1e10 /* what a plane reaches; POV-Ray's figure */

static Bounds extent(Sdl *sdl, const Object *object, const Transform *outer, unsigned inverse);

static int is_unbounded(const Object *object)
{
    return object->kind == OBJECT_SHAPE && !object->shape.ops->bounds;
}

static Bounds shape_extent(const Object *object, const Transform *to_world)
{
    const Primitive p = {.shape = object->shape, .transform = *to_world};
    Bounds b;
    return shape_bounds(&p, &b.low, &b.high) ? b : bounds_everywhere();
}

/* What an operand without bounds leaves of an intersection. */
static Bounds solid_extent(const Object *object, const Transform *outer, unsigned inverse)
{
    const Primitive p = {.shape = object->shape,
                         .transform = transform_then(object->transform, *outer),
                         .inverse = (inverse ^ (object->flags & OBJECT_INVERSE)) != 0};
    Bounds b = bounds_everywhere();
    if (p.shape.ops->solid_bounds)
        p.shape.ops->solid_bounds(&p, &b.low, &b.high);
    return b;
}

static Bounds compound_extent(Sdl *sdl, const Object *compound, const Transform *to_world, unsigned inverse)
{
    const int meets = (compound->csg == CSG_INTERSECTION) != (inverse != 0);
    Bounds all = bounds_empty(), common = bounds_everywhere();
    for (const ObjectList *list = compound->children; list; list = list->next) {
        const Object *operand = list->object;
        const Bounds b = extent(sdl, operand, to_world, inverse);
        all = bounds_join(all, b);
        if (is_unbounded(operand))
            common = bounds_meet(common, solid_extent(operand, to_world, inverse));
        else if (!(inverse ^ (operand->flags & OBJECT_INVERSE)))
            common = bounds_meet(common, b);
    }
    if (!meets)
        return all;
    return bounds_is_finite(&common) || bounds_is_empty(&common) ? common : bounds_everywhere();
}

static Bounds extent(Sdl *sdl, const Object *object, const Transform *outer, unsigned inverse)
{
    const Transform to_world = transform_then(object->transform, *outer);
    inverse ^= object->flags & OBJECT_INVERSE;
    sdl_step(sdl, 1);
    if (object->kind == OBJECT_SHAPE)
        return shape_extent(object, &to_world);
    return object->kind == OBJECT_COMPOUND ? compound_extent(sdl, object, &to_world, inverse) : bounds_empty();
}

static double limited(double x)
{
    return fmin(EVERYWHERE, fmax(-EVERYWHERE, x));
}

int object_extent(Sdl *sdl, const Value *value, Vec3 *low, Vec3 *high)
{
    if (value->kind != VALUE_OBJECT && value->kind != VALUE_LIGHT)
        return 0;
    const Transform none = transform_identity();
    Bounds b = extent(sdl, value->data, &none, 0);
    if (bounds_is_empty(&b)) /* nothing there, or nothing that is supported */
        b.low = b.high = vec3(0, 0, 0);
    *low = vec3(limited(b.low.x), limited(b.low.y), limited(b.low.z));
    *high = vec3(limited(b.high.x), limited(b.high.y), limited(b.high.z));
    return 1;
}
