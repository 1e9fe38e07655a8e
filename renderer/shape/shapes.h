/* The shapes, each in its canonical space (see ShapeKind); private to renderer/shape.
 *
 * Natural parametrisation, where a target has no uv_mapping:
 *   sphere          POV-Ray's uv: u around y from +x towards +z (.75 at -z), v from the lower pole to the upper
 *   torus           POV-Ray's uv: u around y from -x towards +z, v around the tube from the inner equator (0) over the
 *                   bottom, the outer equator (.5) and the top (.75)
 *   box             each face 0..1, upright and unmirrored seen from outside, with y up; the top and the bottom as they
 *                   unfold from the -z face
 *   cone, cylinder  side: u the angle from x towards y, v the height from the base; caps: x and y, the unit square
 *                   round the cap's circle
 *   disc            x and y, the unit square round the outer circle
 *   mesh            its uv_vectors */
#ifndef RENDERER_SHAPE_SHAPES_H
#define RENDERER_SHAPE_SHAPES_H

#include "shape/surface.h"

/* A ray in canonical space; its direction keeps the length that makes t the world's. */
typedef struct ShapeRay {
    Vec3 origin, direction;
    double tmin, tmax;
    double slack; /* how far the origin may be from where it ought to be, by rounding */
} ShapeRay;

/* A point on the shape. */
typedef struct ShapePoint {
    Vec3 p, normal;  /* canonical space; normal outward, of any length */
} ShapePoint;

/* Its UVs. */
typedef struct ShapeUv {
    Vec2 uv, natural;
    int has_uv;      /* 0: uv_mapping falls back to the world's x and y */
    int has_natural;
} ShapeUv;

/* The nearest t in (tmin, tmax): 1 and *t, and *face where there is one; else 0, and both are left as they were. */
int sphere_hit(const ShapeRay *ray, double *t);
int plane_hit(const ShapeRay *ray, double *t);
int disc_hit(const Primitive *primitive, const ShapeRay *ray, double *t);
int cone_hit(const Primitive *primitive, const ShapeRay *ray, double *t, int *face);
int torus_hit(const Primitive *primitive, const ShapeRay *ray, double *t);

/* p is near the surface; it is put onto it. */
void sphere_point(Vec3 p, ShapePoint *out);
void plane_point(Vec3 p, ShapePoint *out);
void disc_point(Vec3 p, ShapePoint *out);
void cone_point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out);
void torus_point(const Primitive *primitive, Vec3 p, ShapePoint *out);
void box_point(Vec3 p, int face, ShapePoint *out);
/* Point and normal of a triangle of a mesh, and the interpolated normal, of any length; 0 where it has none. */
void mesh_point(const Mesh *mesh, int face, double b1, double b2, ShapePoint *out);
Vec3 mesh_shading_normal(const Mesh *mesh, int face, double b1, double b2);

/* UVs of a point that is on the surface. */
void sphere_uv(Vec3 p, ShapeUv *out);
void disc_uv(const Primitive *primitive, Vec3 p, ShapeUv *out);
void cone_uv(const Primitive *primitive, Vec3 p, int face, ShapeUv *out);
void torus_uv(const Primitive *primitive, Vec3 p, ShapeUv *out);
void box_uv(Vec3 p, int face, ShapeUv *out);
void mesh_uv(const Mesh *mesh, int face, double b1, double b2, ShapeUv *out);

/* World space from canonical space, and the face's texture and target. Leaves backside 0. */
void surface_from_point(Surface *surface, const Primitive *primitive, int face, const ShapePoint *point);

/* An angle's share of the turn, 0..1, of the direction (x, y) counted from x. */
double turn_of(double x, double y);

#endif
