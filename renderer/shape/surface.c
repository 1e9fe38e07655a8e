/* The surface at a hit: from a ray and what the tracer said of it to a point exactly on the shape, with its normals,
 * its UVs and whose texture and target it is. Also rays against single shapes, and bounds. */
#include <float.h>
#include <string.h>
#include "shape/shapes.h"

static double largest(Vec3 a)
{
    return fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z)));
}

static ShapeRay to_shape(const Primitive *primitive, const Ray *ray)
{
    const Transform *t = &primitive->transform;
    Vec3 shift = vec3(t->inverse[0][3], t->inverse[1][3], t->inverse[2][3]);
    ShapeRay out = {transform_inverse_point(t, ray->origin), transform_inverse_vector(t, ray->direction), ray->tmin,
                    ray->tmax, 0};

    /* The terms of the transform may be much larger than their sum: the error is theirs. */
    out.slack = 8 * DBL_EPSILON * (largest(out.origin) + largest(shift));
    return out;
}

int shape_intersect(const Primitive *primitive, const Ray *ray, double *t, int *face)
{
    ShapeRay local = to_shape(primitive, ray);
    int found = 0;

    switch (primitive->kind) {
    case SHAPE_SPHERE:
        found = sphere_hit(&local, t);
        break;
    case SHAPE_PLANE:
        found = plane_hit(&local, t);
        break;
    case SHAPE_CONE:
        return cone_hit(primitive, &local, t, face);
    case SHAPE_TORUS:
        found = torus_hit(primitive, &local, t);
        break;
    case SHAPE_DISC:
        found = disc_hit(primitive, &local, t);
        break;
    case SHAPE_BOX:
    case SHAPE_MESH:
        break;
    }
    if (found)
        *face = 0;
    return found;
}

/* ---- bounds ---- */

static void grow(Vec3 *low, Vec3 *high, Vec3 p)
{
    *low = vec3(fmin(low->x, p.x), fmin(low->y, p.y), fmin(low->z, p.z));
    *high = vec3(fmax(high->x, p.x), fmax(high->y, p.y), fmax(high->z, p.z));
}

/* Bounds of a ball of radius ball swept along an ellipse: the image of the circle of the given radius about centre
 * whose axes are canonical axes i and j. */
static void grow_circle(Vec3 *low, Vec3 *high, const Transform *t, Vec3 centre, int i, int j, double radius,
                        double ball)
{
    Vec3 p = transform_point(t, centre), half;
    double extent[3];

    for (int k = 0; k < 3; k++) {
        const double *row = t->m[k];
        extent[k] = radius * hypot(row[i], row[j]) + ball * sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
    }
    half = vec3(extent[0], extent[1], extent[2]);
    grow(low, high, vec_sub(p, half));
    grow(low, high, vec_add(p, half));
}

int shape_bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    const Transform *t = &primitive->transform;
    const Vec3 origin = {0, 0, 0};

    *low = vec3(INFINITY, INFINITY, INFINITY);
    *high = vec_neg(*low);
    switch (primitive->kind) {
    case SHAPE_PLANE:
        return 0;
    case SHAPE_SPHERE:
        grow_circle(low, high, t, origin, 0, 1, 0, 1);
        break;
    case SHAPE_CONE:
        grow_circle(low, high, t, origin, 0, 1, primitive->r0, 0);
        grow_circle(low, high, t, vec3(0, 0, 1), 0, 1, primitive->r1, 0);
        break;
    case SHAPE_TORUS:
        grow_circle(low, high, t, origin, 0, 2, primitive->r0, fabs(primitive->r1));
        break;
    case SHAPE_DISC:
        grow_circle(low, high, t, origin, 0, 1, primitive->r0, 0);
        break;
    case SHAPE_BOX:
        for (int i = 0; i < 8; i++)
            grow(low, high, transform_point(t, box_corner(i)));
        break;
    case SHAPE_MESH:
        for (int i = 0; i < primitive->mesh->nvertices; i++)
            grow(low, high, transform_point(t, primitive->mesh->vertices[i]));
        break;
    }
    return 1;
}

/* ---- the surface at a hit ---- */

/* The face's texture and target. */
static void set_material(Surface *surface, const Primitive *primitive, int face)
{
    int of_mesh =
        primitive->kind == SHAPE_MESH && primitive->mesh->ntextures > 0 ? primitive->mesh->faces[face].texture : -1;

    surface->primitive = primitive;
    surface->face = face;
    surface->texture = of_mesh >= 0 ? primitive->mesh->textures[of_mesh] : primitive->texture;
    surface->target = of_mesh >= 0 && primitive->face_targets ? primitive->face_targets[of_mesh] : primitive->target;
    surface->backside = 0;
}

static Vec3 world_normal(const Primitive *primitive, Vec3 normal)
{
    Vec3 n = vec_normalize(transform_normal(&primitive->transform, normal));

    return primitive->inverse ? vec_neg(n) : n;
}

void surface_from_point(Surface *surface, const Primitive *primitive, int face, const ShapePoint *point)
{
    set_material(surface, primitive, face);
    surface->position = transform_point(&primitive->transform, point->p);
    surface->geometric_normal = surface->shading_normal = world_normal(primitive, point->normal);
    surface->b1 = surface->b2 = 0;
}

void surface_turn(Surface *surface, int backside)
{
    const Primitive *primitive = surface->primitive;

    surface->backside = backside;
    if (!backside || !primitive->interior_texture || surface->texture != primitive->texture)
        return;
    surface->texture = primitive->interior_texture;
    surface->target = primitive->interior_target;
}

Vec3 box_normal(const Primitive *primitive, int side)
{
    ShapePoint point;

    box_point(vec3(0.5, 0.5, 0.5), side, &point);
    return world_normal(primitive, point.normal);
}

Vec3 face_normal(const Primitive *primitive, int face, const Vec3 corner[3])
{
    Vec3 n = vec_normalize(vec_cross(vec_sub(corner[1], corner[0]), vec_sub(corner[2], corner[0])));
    ShapePoint point;

    mesh_point(primitive->mesh, face, 0, 0, &point);
    return vec_dot(n, world_normal(primitive, point.normal)) < 0 ? vec_neg(n) : n;
}

/* A mesh's interpolated normal, on the side of the face's own. Normals that cancel out, or lie in the face, tell
 * nothing: the face's own stands in. */
static Vec3 smooth_normal(const Primitive *primitive, const Hit *hit)
{
    Vec3 n = world_normal(primitive, mesh_shading_normal(primitive->mesh, hit->face, hit->b1, hit->b2));
    double side = vec_dot(n, hit->normal);

    if (fabs(side) < 1e-6)
        return hit->normal;
    return side < 0 ? vec_neg(n) : n;
}

static void triangle_at(Surface *surface, const Primitive *primitive, const Ray *ray, const Hit *hit)
{
    set_material(surface, primitive, hit->face);
    surface->position = vec_mad(ray->origin, ray->direction, hit->t);
    surface->geometric_normal = surface->shading_normal = hit->normal;
    surface->b1 = hit->b1, surface->b2 = hit->b2;
    if (primitive->kind == SHAPE_MESH && mesh_face_has_normals(&primitive->mesh->faces[hit->face]))
        surface->shading_normal = smooth_normal(primitive, hit);
}

void surface_at(Surface *surface, const Scene *scene, const Ray *ray, const Hit *hit)
{
    const Primitive *primitive = &scene->primitives[hit->primitive];
    ShapePoint point = {.normal = {0, 1, 0}};
    Vec3 p;

    if (primitive->kind == SHAPE_MESH || primitive->kind == SHAPE_BOX) {
        triangle_at(surface, primitive, ray, hit);
        surface_turn(surface, vec_dot(ray->direction, surface->geometric_normal) > 0);
        return;
    }
    p = transform_inverse_point(&primitive->transform, vec_mad(ray->origin, ray->direction, hit->t));
    switch (primitive->kind) {
    case SHAPE_SPHERE:
        sphere_point(p, &point);
        break;
    case SHAPE_PLANE:
        plane_point(p, &point);
        break;
    case SHAPE_CONE:
        cone_point(primitive, p, hit->face, &point);
        break;
    case SHAPE_TORUS:
        torus_point(primitive, p, &point);
        break;
    case SHAPE_DISC:
        disc_point(p, &point);
        break;
    case SHAPE_BOX:
    case SHAPE_MESH:
        break;
    }
    surface_from_point(surface, primitive, hit->face, &point);
    surface_turn(surface, vec_dot(ray->direction, surface->geometric_normal) > 0);
}

SurfaceUv surface_uv(const Surface *surface)
{
    const Primitive *primitive = surface->primitive;
    ShapeUv of = {{0, 0}, {0, 0}, 0, 0};
    Vec3 p = {0, 0, 0};

    if (primitive->kind != SHAPE_MESH)
        p = transform_inverse_point(&primitive->transform, surface->position);
    switch (primitive->kind) {
    case SHAPE_SPHERE:
        sphere_uv(p, &of);
        break;
    case SHAPE_BOX:
        box_uv(p, surface->face, &of);
        break;
    case SHAPE_PLANE:
        break;
    case SHAPE_CONE:
        cone_uv(primitive, p, surface->face, &of);
        break;
    case SHAPE_TORUS:
        torus_uv(primitive, p, &of);
        break;
    case SHAPE_DISC:
        disc_uv(primitive, p, &of);
        break;
    case SHAPE_MESH:
        mesh_uv(primitive->mesh, surface->face, surface->b1, surface->b2, &of);
        break;
    }
    if (!of.has_uv)
        of.uv = (Vec2){surface->position.x, surface->position.y};
    return (SurfaceUv){of.uv, of.natural, of.has_natural};
}
