/* The surface at a hit: position, normals, UV, texture. */
#ifndef RENDERER_SHAPE_SURFACE_H
#define RENDERER_SHAPE_SURFACE_H

#include "shape/shapes.h"

typedef struct Ray {
    Vec3 origin, direction; /* direction of unit length */
    double tmin, tmax;
} Ray;

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

/* The lamp that its emission is of. */
static inline int surface_lamp(const Surface *surface)
{
    const Instance *instance = surface->instance;
    return instance && instance->lamp >= 0 ? instance->lamp : surface->primitive->lamp;
}
void surface_at(Surface *surface, const Scene *scene, const Ray *ray, const Hit *hit);
/* Prefetch what surface_at reads of a mesh: its face, and once that is there, its corners. */
static inline void surface_prefetch_face(const Scene *scene, const Hit *hit)
{
    const Primitive *primitive = &scene->primitives[hit->primitive];
    if (primitive->shape.mesh)
        __builtin_prefetch(&primitive->shape.mesh->faces[hit->face]);
}
static inline void surface_prefetch_corners(const Scene *scene, const Hit *hit)
{
    const Primitive *primitive = &scene->primitives[hit->primitive];
    if (!primitive->shape.mesh)
        return;
    const MeshFace *face = &primitive->shape.mesh->faces[hit->face];
    for (int k = 0; k < 3 && mesh_face_has_normals(face); k++)
        __builtin_prefetch(&primitive->shape.mesh->normals[face->normal[k]]);
    for (int k = 0; k < 3 && mesh_face_has_uvs(face); k++)
        __builtin_prefetch(&primitive->shape.mesh->uvs[face->uv[k]]);
}
/* Where textures are evaluated: they are in the world, and those of an instance in its prototype's space. */
static inline Vec3 surface_texture_point(const Surface *surface)
{
    return surface->instance ? transform_inverse_point(&surface->instance->transform, surface->position)
                             : surface->position;
}
static inline Vec3 surface_texture_normal(const Surface *surface)
{
    if (!surface->instance)
        return surface->geometric_normal;
    return vec_normalize(transform_inverse_normal(&surface->instance->transform, surface->geometric_normal));
}
SurfaceUv surface_uv(const Surface *surface); /* not part of surface_at, for most surfaces have one colour */
/* Its `uv`, or that of a mesh's second set, if it has one. */
Vec2 surface_uv_of_set(const Surface *surface, int second);
/* Unit vectors perpendicular to a unit normal, in the space of the surface's texture: where u grows, and where v does.
 * 0 where UV do not span the surface. normal: on the outward side, in that space. second: as of surface_uv_of_set. */
int surface_tangents(const Surface *surface, int second, Vec3 normal, Vec3 *tangent, Vec3 *bitangent);
/* How u and v grow with a step in the world: their changes are the dot products. The gradients lie in the surface. 0
 * where there are no UV. */
int surface_uv_gradients(const Surface *surface, int second, Vec3 *of_u, Vec3 *of_v);
/* Sets the side that a surface from shape_sample is seen from, and the texture of that side. */
void surface_turn(Surface *surface, int backside);

/* ---- operations of shapes (shape.h), by their table ---- */

/* The nearest t in (tmin, tmax), in double. 1 if found, with face as in Hit; else 0, and *t and *face are left as they
 * were: they may be those of a nearer hit. */
int shape_intersect(const Primitive *primitive, const Ray *ray, double *t, int *face);
/* The rest of a hit on a shape that has triangles, from t and face: what the tracer says of them itself. */
void shape_complete_hit(const Primitive *primitive, const Ray *ray, Hit *hit);
/* World-space bounding box; planes and surfaces of polynomials have none (returns 0). */
int shape_bounds(const Primitive *primitive, Vec3 *low, Vec3 *high);

/* Emitters: sampling by area. Total world-space area; 0 where the shape cannot be sampled: planes,
 * and tori whose tube is wider than their ring. */
double shape_area(const Primitive *primitive);
/* A point uniform in area from u1, u2 in [0,1). Gives position, normals, face and UVs through a Surface (backside 0),
 * and the density per unit area at that point (not constant under non-uniform scaling of curved shapes). Shapes choose
 * among their faces themselves and take any face (-1), but for meshes, where the weights come from the caller's table:
 * there both densities are those within the face, to be multiplied by the caller's probability of it. */
void shape_sample(const Primitive *primitive, int face, double u1, double u2, Surface *surface, double *pdf_area);
double shape_pdf_area(const Primitive *primitive, const Surface *surface); /* of shape_sample, at that point */

/* ---- meshes ---- */

double mesh_face_area(const Primitive *primitive, int face);
/* UV of the surface's point by the mesh's set, which need not be its own one. 0 where the face has none. */
int mesh_uv(const Mesh *mesh, const Surface *surface, Vec2 *uv);
/* The interpolated normal, of any length; 0 where the face has none. */
Vec3 mesh_shading_normal(const Mesh *mesh, int face, double b1, double b2);
/* Makes the tree that goes with intersecting it in double, if it is not there: without it each face is tested. 0
 * without memory. */
int mesh_index(Arena *arena, Mesh *mesh);
/* Gives corners smooth tangents, if they have none yet. 0 without memory. */
int mesh_add_tangents(Arena *arena, Mesh *mesh);
/* Of a point on the face, in object space. */
void mesh_barycentrics(const Mesh *mesh, int face, Vec3 p, double *b1, double *b2);
/* 1: the mesh is closed and its winding makes normals that point inside. For Mesh.inward, once the mesh is complete. */
int mesh_winds_inward(const Mesh *mesh);

#endif
