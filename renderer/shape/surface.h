/* The surface at a hit: position, normals, UV, texture. */
#ifndef RENDERER_SHAPE_SURFACE_H
#define RENDERER_SHAPE_SURFACE_H

#include "shape/hit.h"

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
static inline Vec3 surface_texture_normal(const Surface *surface)
{
    if (!surface->instance)
        return surface->geometric_normal;
    return vec_normalize(transform_inverse_normal(&surface->instance->transform, surface->geometric_normal));
}
SurfaceUv surface_uv(const Surface *surface); /* not part of surface_at, for most surfaces have one colour */
/* Its `uv`, or that of a mesh's second set, if it has one. */
Vec2 surface_uv_of_set(const Surface *surface, int second);
/* Unit vectors perpendicular to a unit normal, in the space of the surface's texture: where u grows, and where v does,
 * for a frame with the normal that is reversed as a whole where the back is seen. So it is in glTF: a bump is a dent
 * from behind. Only a mesh with normals has a back; else both vectors are returned reversed there, and bumps rise to
 * either side. 0 where UV do not span the surface. normal: on the outward side, in that space. second: as of
 * surface_uv_of_set. */
int surface_tangents(const Surface *surface, int second, Vec3 normal, Vec3 *tangent, Vec3 *bitangent);
/* How u and v grow with a step in the world: their changes are the dot products. The gradients lie in the surface. 0
 * where there are no UV. */
int surface_uv_gradients(const Surface *surface, int second, Vec3 *of_u, Vec3 *of_v);
/* From one side to the other; UV that go round begin again somewhere. */
static inline double uv_difference(double after, double before)
{
    const double d = after - before;
    return fabs(d) > 0.5 && fabs(d) <= 1 ? d - copysign(1, d) : d;
}
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
