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

    *face = 0;
    switch (primitive->kind) {
    case SHAPE_SPHERE:
        return sphere_hit(&local, t);
    case SHAPE_PLANE:
        return plane_hit(&local, t);
    case SHAPE_CONE:
        return cone_hit(primitive, &local, t, face);
    case SHAPE_TORUS:
        return torus_hit(primitive, &local, t);
    case SHAPE_DISC:
        return disc_hit(primitive, &local, t);
    case SHAPE_BOX:
    case SHAPE_MESH:
        break;
    }
    return 0;
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

void surface_from_point(Surface *surface, const Primitive *primitive, int face, const ShapePoint *point)
{
    const Transform *t = &primitive->transform;
    double sign = primitive->inverse ? -1 : 1;
    int of_mesh =
        primitive->kind == SHAPE_MESH && primitive->mesh->ntextures > 0 ? primitive->mesh->faces[face].texture : -1;

    surface->primitive = primitive;
    surface->face = face;
    surface->texture = of_mesh >= 0 ? primitive->mesh->textures[of_mesh] : primitive->texture;
    surface->target = of_mesh >= 0 && primitive->face_targets ? primitive->face_targets[of_mesh] : primitive->target;
    surface->position = transform_point(t, point->p);
    surface->geometric_normal = vec_scale(vec_normalize(transform_normal(t, point->normal)), sign);
    surface->shading_normal = surface->geometric_normal;
    if (primitive->kind == SHAPE_MESH) {
        Vec3 shading = vec_scale(vec_normalize(transform_normal(t, point->shading)), sign);
        /* A shear may tip the interpolated normal over the face's. */
        if (vec_dot(shading, surface->geometric_normal) > 0)
            surface->shading_normal = shading;
    }
    surface->backside = 0;
    surface->uv = point->has_uv ? point->uv : (Vec2){surface->position.x, surface->position.y};
    surface->natural = point->has_natural ? point->natural : (Vec2){0, 0};
    surface->has_natural = point->has_natural;
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

void surface_at(Surface *surface, const Scene *scene, const Ray *ray, const Hit *hit)
{
    const Primitive *primitive = &scene->primitives[hit->primitive];
    Vec3 p = transform_inverse_point(&primitive->transform, vec_mad(ray->origin, ray->direction, hit->t));
    ShapePoint point;

    memset(&point, 0, sizeof(point));
    switch (primitive->kind) {
    case SHAPE_SPHERE:
        sphere_point(p, &point);
        break;
    case SHAPE_BOX:
        box_point(p, hit->face, &point);
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
        disc_point(primitive, p, &point);
        break;
    case SHAPE_MESH:
        mesh_point(primitive->mesh, hit->face, hit->b1, hit->b2, &point);
        break;
    }
    surface_from_point(surface, primitive, hit->face, &point);
    surface_turn(surface, vec_dot(ray->direction, surface->geometric_normal) > 0);
}
