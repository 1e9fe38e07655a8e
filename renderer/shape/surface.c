/* The surface at a hit: from a ray and what the tracer said of it to a point exactly on the shape, with its normals,
 * its UVs and whose texture and target it is. */
#include "shape/shape.h"
#include <retex/host/assert.h>
#include "shape/surface.h"

/* The texture and target there. All else of the surface but the side it is seen from is set. */
static void set_material(Surface *surface)
{
    const Primitive *primitive = surface->primitive;
    const Shape *shape = &primitive->shape;
    int own = shape->textures ? shape->ops->texture(surface) : -1;

    RETEX_ASSERT(own < 0 || own < shape->textures->count);
    RETEX_ASSERT(!primitive->face_targets || shape->textures); /* by the shape's textures, not by its faces */
    surface->texture = own >= 0 ? shape->textures->list[own] : primitive->texture;
    surface->target = own >= 0 && primitive->face_targets ? primitive->face_targets[own] : primitive->target;
    if (primitive->faces)
        surface->target = first_target(surface->target, primitive->faces->of[surface->face]);
    surface->backside = 0;
    surface->instance = NULL;
}

/* An interpolated normal, on the side of the face's own. Normals that cancel out, or lie in the face, tell nothing: the
 * face's own stands in. */
static Vec3 smooth_normal(const Primitive *primitive, Vec3 interpolated, Vec3 of_face)
{
    Vec3 n = shape_world_normal(primitive, interpolated);
    double side = vec_dot(n, of_face);

    if (fabs(side) < 1e-6)
        return of_face;
    return side < 0 ? vec_neg(n) : n;
}

void surface_from_point(Surface *surface, const Primitive *primitive, int face, const ShapePoint *point)
{
    surface->primitive = primitive;
    surface->face = face;
    surface->position = transform_point(&primitive->transform, point->p);
    surface->geometric_normal = surface->shading_normal = shape_world_normal(primitive, point->normal);
    surface->b1 = point->b1, surface->b2 = point->b2;
    if (vec_dot(point->shading_normal, point->shading_normal) > 0)
        surface->shading_normal = smooth_normal(primitive, point->shading_normal, surface->geometric_normal);
    set_material(surface);
}

void surface_turn(Surface *surface, int backside)
{
    const Primitive *primitive = surface->primitive;
    const Instance *instance = surface->instance;
    const Texture *whole = instance && primitive->inherits ? instance->texture : primitive->texture;

    surface->backside = backside;
    if (!backside || !primitive->interior_texture || surface->texture != whole)
        return;
    surface->texture = primitive->interior_texture;
    surface->target = primitive->interior_target;
    if (primitive->faces)
        surface->target = first_target(surface->target, primitive->faces->of[surface->face]);
    if (instance)
        surface->target = first_target(surface->target, instance->target);
}

static void triangle_at(Surface *surface, const Primitive *primitive, const Ray *ray, const Hit *hit)
{
    surface->primitive = primitive;
    surface->face = hit->face;
    surface->position = vec_mad(ray->origin, ray->direction, hit->t);
    surface->geometric_normal = surface->shading_normal = hit->normal;
    surface->b1 = hit->b1, surface->b2 = hit->b2;
    set_material(surface);
    if (primitive->shape.mesh && mesh_face_has_normals(&primitive->shape.mesh->faces[hit->face]))
        surface->shading_normal = smooth_normal(
            primitive, mesh_shading_normal(primitive->shape.mesh, hit->face, hit->b1, hit->b2), hit->normal);
}

static void curved_at(Surface *surface, const Primitive *primitive, const Ray *ray, const Hit *hit)
{
    ShapePoint point = {.normal = {0, 1, 0}};
    Vec3 p = transform_inverse_point(&primitive->transform, vec_mad(ray->origin, ray->direction, hit->t));

    primitive->shape.ops->point(primitive, p, hit->face, &point);
    surface_from_point(surface, primitive, hit->face, &point);
}

/* In the prototype's space first, and from there to the world. */
static void instance_at(Surface *surface, const Primitive *primitive, const Ray *ray, const Hit *hit)
{
    const Instance *instance = hit->instance;
    const Transform *t = &instance->transform;
    const Ray within = {transform_inverse_point(t, ray->origin), transform_inverse_vector(t, ray->direction), ray->tmin,
                        ray->tmax};
    Hit there = *hit;

    if (primitive->shape.ops->triangles) {
        there.normal = vec_normalize(transform_inverse_normal(t, hit->normal));
        triangle_at(surface, primitive, &within, &there);
        surface->position = vec_mad(ray->origin, ray->direction, hit->t);
    } else {
        curved_at(surface, primitive, &within, &there);
        surface->position = transform_point(t, surface->position);
    }
    surface->geometric_normal = vec_normalize(transform_normal(t, surface->geometric_normal));
    surface->shading_normal = vec_normalize(transform_normal(t, surface->shading_normal));
    surface->instance = instance;
    if (primitive->inherits && surface->texture == primitive->texture) {
        surface->texture = instance->texture;
        surface->target = first_target(surface->target, instance->texture_target);
    }
    surface->target = first_target(surface->target, instance->target);
}

void surface_at(Surface *surface, const Scene *scene, const Ray *ray, const Hit *hit)
{
    RETEX_ASSERT(hit->primitive >= 0 && hit->primitive < scene->nprimitives);
    const Primitive *primitive = &scene->primitives[hit->primitive];

    RETEX_ASSERT(!hit->instance == !primitive->prototype); /* those of prototypes are where instances are */
    RETEX_ASSERT(!hit->instance || hit->instance->prototype == primitive->prototype);
    RETEX_ASSERT(!primitive->inherits || hit->instance->texture);
    surface->direction = ray->direction;
    if (hit->instance)
        instance_at(surface, primitive, ray, hit);
    else if (primitive->shape.ops->triangles)
        triangle_at(surface, primitive, ray, hit);
    else
        curved_at(surface, primitive, ray, hit);
    surface_turn(surface, vec_dot(ray->direction, surface->geometric_normal) > 0);
}

SurfaceUv surface_uv(const Surface *surface)
{
    const ShapeOps *ops = surface->primitive->shape.ops;
    ShapeUv of = {.has_natural = ops->uv != NULL};

    if (ops->uv)
        ops->uv(surface, &of);
    if (!of.has_uv)
        of.uv = (Vec2){surface->position.x, surface->position.y};
    return (SurfaceUv){of.uv, of.natural, of.has_natural};
}

Vec2 surface_uv_of_set(const Surface *surface, int second)
{
    const Mesh *mesh = surface->primitive->shape.mesh;
    Vec2 uv;

    if (second && mesh && mesh->second && mesh_uv(mesh->second, surface, &uv))
        return uv;
    return surface_uv(surface).uv;
}
