/* What a ray meets, as plain data: the tracer's answer, and what shading needs of it. */
#ifndef RENDERER_SHAPE_HIT_H
#define RENDERER_SHAPE_HIT_H

#include "shape/shapes.h"

/* The raw answer of the tracer. */
typedef struct Hit {
    double t;          /* distance; along a unit direction */
    int primitive;     /* index, or -1 for none */
    int face;          /* of a mesh; else a part of the shape, as the shape's file counts them */
    double b1, b2;     /* barycentrics of a triangle: weights of corners 1 and 2 */
    Vec3 normal;       /* of a triangle: unit length, outward, world space */
    const Instance *instance; /* whose the primitive is, or NULL */
} Hit;

/* What shading needs. Normals are of unit length, in world space. */
typedef struct Surface {
    const Primitive *primitive;
    int face;                /* as in Hit */
    const Texture *texture;  /* of this face; from the back the interior_texture where there is one */
    int target;              /* index or -1 */
    Vec3 position;
    Vec3 geometric_normal;   /* outward, as the shape has it (not turned to the ray) */
    Vec3 shading_normal;     /* outward, interpolated where the mesh has normals; same side as geometric_normal */
    Vec3 direction;          /* of the ray */
    int backside;            /* 1: the ray came from inside (dot(direction, geometric_normal) > 0) */
    double b1, b2;           /* as in Hit */
    const Instance *instance; /* as in Hit */
} Surface;

typedef struct SurfaceUv {
    Vec2 uv;                 /* of uv_mapping: the shape's own, or world x,y for shapes without */
    Vec2 natural;            /* natural parametrisation, which the shape's file describes */
    int has_natural;         /* 0: plane, mesh without UVs */
} SurfaceUv;

/* Where textures are evaluated: they are in the world, and those of an instance in its prototype's space. */
static inline Vec3 surface_texture_point(const Surface *surface)
{
    return surface->instance ? transform_inverse_point(&surface->instance->transform, surface->position)
                             : surface->position;
}

#endif
