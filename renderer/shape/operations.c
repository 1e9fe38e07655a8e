/* Operations of shapes, by their table. */
#include <float.h>
#include "shape/shape.h"
#include "shape/surface.h"

static ShapeRay to_shape(const Primitive *primitive, const Ray *ray)
{
    const Transform *t = &primitive->transform;
    Vec3 shift = vec3(t->inverse[0][3], t->inverse[1][3], t->inverse[2][3]);
    ShapeRay out = {transform_inverse_point(t, ray->origin), transform_inverse_vector(t, ray->direction), ray->tmin,
                    ray->tmax, 0};

    /* The terms of the transform may be much larger than their sum: the error is theirs. */
    out.slack = 8 * DBL_EPSILON * (vec_largest(out.origin) + vec_largest(shift));
    return out;
}

int shape_intersect(const Primitive *primitive, const Ray *ray, double *t, int *face)
{
    const ShapeRay local = to_shape(primitive, ray);
    int found = 0;

    if (!primitive->shape.ops->intersect(primitive, &local, t, &found))
        return 0;
    *face = found;
    return 1;
}

void shape_complete_hit(const Primitive *primitive, const Ray *ray, Hit *hit)
{
    const Mesh *mesh = primitive->shape.mesh;
    Vec3 corner[3] = {{0, 0, 0}};
    Vec3 p = transform_inverse_point(&primitive->transform, vec_mad(ray->origin, ray->direction, hit->t));

    if (!primitive->shape.ops->face_normal)
        return;
    for (int k = 0; mesh && k < 3; k++)
        corner[k] = transform_point(&primitive->transform, mesh->vertices[mesh->faces[hit->face].vertex[k]]);
    hit->normal = primitive->shape.ops->face_normal(primitive, hit->face, corner);
    if (mesh)
        mesh_barycentrics(mesh, hit->face, p, &hit->b1, &hit->b2);
}

int shape_bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    *low = vec3(INFINITY, INFINITY, INFINITY);
    *high = vec_neg(*low);
    if (!primitive->shape.ops->bounds)
        return 0;
    primitive->shape.ops->bounds(primitive, low, high);
    return 1;
}

double shape_area(const Primitive *primitive)
{
    return primitive->shape.ops->area ? primitive->shape.ops->area(primitive) : 0;
}

double shape_pdf_area(const Primitive *primitive, const Surface *surface)
{
    const ShapeOps *ops = primitive->shape.ops;

    return ops->density ? ops->density(primitive, shape_local_point(surface), surface->face) : 0;
}

void shape_sample(const Primitive *primitive, int face, double u1, double u2, Surface *surface, double *pdf_area)
{
    const ShapeOps *ops = primitive->shape.ops;
    ShapePoint point = {.p = {0, 0, 0}};

    *pdf_area = 0;
    if (ops->sample) {
        *pdf_area = ops->sample(primitive, u1, u2, &face, &point);
    } else {
        /* A point of the shape all the same. */
        face = 0;
        ops->point(primitive, vec3(0, 0, 0), face, &point);
    }
    surface_from_point(surface, primitive, face, &point);
}
