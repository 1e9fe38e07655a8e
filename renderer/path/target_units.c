/* See target_units.h. */
#include <math.h>
#include "path/projection.h"
#include "path/target_units.h"
#include "shape/shape.h"

#define SAME 0.01 /* lengths around that differ less are stretched to be the same */

static Vec3 in_world(const Instance *instance, Vec3 v)
{
    return instance ? transform_vector(&instance->transform, v) : v;
}

static int has_own_uv(const Primitive *primitive, const Pigment *pigment)
{
    return pigment->uv_mapping || pigment->kind == PIGMENT_IMAGE ||
           (primitive->shape.mesh && primitive->shape.mesh->nuvs);
}

/* 0 where the shape does not know it. */
static int extent_of(const Primitive *primitive, const Instance *instance, int face, ShapeExtent *extent)
{
    Vec3 axes[3];
    if (!primitive->shape.ops->extent)
        return 0;
    for (int i = 0; i < 3; i++)
        axes[i] = in_world(instance, shape_axis(&primitive->transform, i));
    *extent = (ShapeExtent){0};
    primitive->shape.ops->extent(primitive, face, axes, extent);
    if (extent->is_flat) {
        extent->u = in_world(instance, transform_vector(&primitive->transform, extent->u));
        extent->v = in_world(instance, transform_vector(&primitive->transform, extent->v));
        extent->lengths[0] = vec_length(extent->u), extent->lengths[1] = vec_length(extent->v);
    }
    return extent->lengths[0] > 0 && extent->lengths[1] > 0;
}

/* ---- the choice ---- */

/* What the parts of one target that take natural UV have in common. */
typedef struct Parts {
    int known;         /* how many know their lengths */
    int differ;        /* 1: not all of them close with the same lengths */
    double lengths[2]; /* of the first of them that closes */
} Parts;

static void add_part(Parts *parts, const Primitive *primitive)
{
    const unsigned properties = primitive->shape.ops->properties;
    const int closes[2] = {(properties & SHAPE_U_PERIODIC) != 0, (properties & SHAPE_V_PERIODIC) != 0};
    ShapeExtent extent;
    const int is_known = extent_of(primitive, NULL, 0, &extent);
    parts->known += is_known;
    parts->differ |= !is_known || !(closes[0] || closes[1]);
    if (!parts->differ && !(parts->lengths[0] > 0))
        parts->lengths[0] = extent.lengths[0], parts->lengths[1] = extent.lengths[1];
    for (int axis = 0; axis < 2 && !parts->differ; axis++)
        parts->differ = closes[axis] && fabs(extent.lengths[axis] - parts->lengths[axis]) > SAME * parts->lengths[axis];
}

static int is_on_instance(const Scene *scene, int target)
{
    for (int k = 0; k < scene->ninstances; k++)
        if (instance_target_texture(scene, &scene->instances[k], target, NULL))
            return 1;
    for (int k = 0; k < scene->nprimitives; k++)
        if (scene->primitives[k].prototype && primitive_target_texture(&scene->primitives[k], target))
            return 1;
    return 0;
}

/* A lone shape that does not know its lengths keeps its natural UV, which may close. */
static void choose(Scene *scene, int t)
{
    Target *target = &scene->targets[t];
    Parts parts = {.differ = is_on_instance(scene, t)};
    int natural = 0;
    for (int k = 0; k < scene->nprimitives; k++) {
        const Primitive *p = &scene->primitives[k];
        const Texture *texture = primitive_target_texture(p, t);
        if (!texture || has_own_uv(p, texture->pigment))
            continue;
        natural += p->shape.ops->uv && !p->shape.mesh;
        add_part(&parts, p);
    }
    if (natural == 0 || (natural == 1 && !parts.known))
        return;
    target->uv_folds = parts.differ;
    for (int axis = 0; axis < 2; axis++)
        target->uv_unit[axis] = parts.differ ? 1 : parts.lengths[axis];
}

void target_units_choose(Scene *scene)
{
    int any = 0;
    for (int t = 0; t < scene->ntargets; t++) {
        if (scene->targets[t].is_pointed_at && !projection_is_used(&scene->targets[t]))
            choose(scene, t);
        any |= scene->targets[t].uv_unit[0] > 0 || projection_is_used(&scene->targets[t]);
    }
    for (int k = 0; k < scene->nprimitives; k++)
        scene->primitives[k].unit_targets = any ? scene->targets : NULL;
}

/* ---- UV ---- */

/* The face's natural UV, in lengths, from where the scene's origin is. */
static Vec2 flat_uv(const Surface *surface, const ShapeExtent *extent, Vec2 natural)
{
    const Vec3 corner = vec_mad(vec_mad(surface->position, extent->u, -natural.u), extent->v, -natural.v);
    const double *l = extent->lengths;
    return (Vec2){natural.u * l[0] + vec_dot(corner, extent->u) / l[0],
                  natural.v * l[1] + vec_dot(corner, extent->v) / l[1]};
}

static double fold(double turn)
{
    return fmin(turn, 1 - turn);
}

int target_units_uv(const Surface *surface, const SurfaceUv *of, Vec2 *uv)
{
    const Target *target = surface->target >= 0 ? &surface->primitive->unit_targets[surface->target] : NULL;
    const unsigned properties = surface->primitive->shape.ops->properties;
    ShapeExtent extent;
    Vec2 natural = of->natural;
    if (target && projection_is_used(target)) {
        *uv = projection_uv(&target->projection, surface);
        return 1;
    }
    if (!target || !(target->uv_unit[0] > 0) || has_own_uv(surface->primitive, surface->texture->pigment))
        return 0;
    if (!of->has_natural || !extent_of(surface->primitive, surface->instance, surface->face, &extent)) {
        *uv = vec_project(surface->position, surface->geometric_normal);
        return 1;
    }
    const double scale[2] = {extent.lengths[0] / target->uv_unit[0], extent.lengths[1] / target->uv_unit[1]};
    if (extent.is_flat && target->uv_folds) {
        *uv = flat_uv(surface, &extent, natural);
    } else if (extent.is_flat) {
        *uv = (Vec2){natural.u * scale[0], natural.v * scale[1]};
    } else if (target->uv_folds) {
        if (properties & SHAPE_U_PERIODIC)
            natural.u = fold(natural.u);
        if (properties & SHAPE_V_PERIODIC)
            natural.v = fold(natural.v);
        *uv = (Vec2){natural.u * scale[0], natural.v * scale[1]};
    } else { /* what closes goes once round */
        *uv = (Vec2){properties & SHAPE_U_PERIODIC ? natural.u : natural.u * scale[0],
                     properties & SHAPE_V_PERIODIC ? natural.v : natural.v * scale[1]};
    }
    return 1;
}
