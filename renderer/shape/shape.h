/* A shape: a row of operations on its canonical form. Included by the files that define shapes, and by those that call
 * operations one by one. Each shape's file describes its canonical form, its faces and its natural parametrisation:
 * the UV of targets without uv_mapping. */
#ifndef RENDERER_SHAPE_SHAPE_H
#define RENDERER_SHAPE_SHAPE_H

#include "shape/hit.h"

/* A ray in canonical space; its direction keeps the length that makes t the world's. */
typedef struct ShapeRay {
    Vec3 origin, direction;
    double tmin, tmax;
    double slack; /* how far the origin may be from where it ought to be, by rounding */
} ShapeRay;

/* A point on the shape. */
typedef struct ShapePoint {
    Vec3 p, normal; /* canonical space; normal outward, of any length */
    double b1, b2;  /* as in Hit */
    Vec3 shading_normal; /* where it is another one; else 0 */
} ShapePoint;

/* Its UVs. */
typedef struct ShapeUv {
    Vec2 uv, natural;
    int has_uv; /* 0: uv_mapping falls back to the world's x and y */
    int has_natural;
} ShapeUv;

/* A shape as triangles, in canonical space. */
typedef struct ShapeTriangles {
    int nvertices, ntriangles;
    const Vec3 *vertices;
    const int *corners; /* the first triangle's three vertices; the next triangle's are stride further on */
    size_t stride;
    int per_face;       /* so many triangles, one after the other, are one face as Hit counts them */
} ShapeTriangles;

/* A face that is flat is spanned by vectors of a unit of its natural u and v, in canonical space. Of curved ones only
 * the lengths of these units are known, in the world, as means over the face. */
typedef struct ShapeExtent {
    int is_flat;
    Vec3 u, v;
    double lengths[2];
} ShapeExtent;

typedef enum ShapeProperty {
    SHAPE_U_PERIODIC = 1, /* the natural u goes once round from 0 to 1 */
    SHAPE_V_PERIODIC = 2,
    SHAPE_UV_NATURAL = 4, /* uv_mapping takes the natural parametrisation too */
    SHAPE_FLAT = 8        /* one normal everywhere */
} ShapeProperty;

/* Operations that a shape does without are NULL. */
struct ShapeOps {
    const char *name;
    unsigned properties; /* bits of ShapeProperty */
    /* Bounding box in the world. NULL: there is none, and every ray is tested against the shape. */
    void (*bounds)(const Primitive *primitive, Vec3 *low, Vec3 *high);
    /* The box beyond which nothing is inside, `inverse` applied; infinite where there is no end. NULL: as bounds; then
     * what is beyond is outside, or inside where the primitive is inverse. */
    void (*solid_bounds)(const Primitive *primitive, Vec3 *low, Vec3 *high);
    /* The nearest t in (tmin, tmax), and the face there where there is more than one: returns 1; else 0, and t is left
     * as it was. */
    int (*intersect)(const Primitive *primitive, const ShapeRay *ray, double *t, int *face);
    /* The point of the face next to p, which is near the surface, in canonical space. */
    void (*point)(const Primitive *primitive, Vec3 p, int face, ShapePoint *out);
    void (*uv)(const Surface *surface, ShapeUv *out); /* out->has_uv is 0 before, has_natural 1 */
    /* How long the face's natural UV are, on a primitive whose canonical axes are these in the world. */
    void (*extent)(const Primitive *primitive, int face, const Vec3 axes[3], ShapeExtent *out);
    /* Which of the shape's textures the surface has where it is; -1: the primitive's own. Asked where there are any.
     * Where textures are blended, each has a share of the points there, at random: see shape_share. */
    int (*texture)(const Surface *surface);
    /* 1 for points inside, in canonical space; as POV-Ray's inside(). */
    int (*inside)(const Shape *shape, Vec3 p);
    /* Emitters; NULL where they cannot be sampled. area: of the surface in the world, 0 where it cannot be sampled.
     * sample: a point uniform in area, on *face where that is not -1, else on a face of its choice; returns the density
     * in the world, per unit area. density: of sample, at a point of canonical space. */
    double (*area)(const Primitive *primitive);
    double (*sample)(const Primitive *primitive, double u1, double u2, int *face, ShapePoint *out);
    double (*density)(const Primitive *primitive, Vec3 p, int face);
    /* Of shapes that are traced as triangles, and the unit normal in the world of a face with these corners. */
    void (*triangles)(const Shape *shape, ShapeTriangles *out);
    Vec3 (*face_normal)(const Primitive *primitive, int face, const Vec3 corner[3]);
};

/* What the rows of most shapes have, for files whose functions are called as the operations are; and of emitters. */
#define SHAPE_BOUNDED .bounds = bounds, .intersect = intersect, .point = point, .uv = uv, .inside = inside
#define SHAPE_SAMPLED .area = area, .sample = sample, .density = density

/* World space from canonical space, and the face's texture and target. Leaves backside 0. */
void surface_from_point(Surface *surface, const Primitive *primitive, int face, const ShapePoint *point);

/* ---- for the files of shapes ---- */

/* The surface's point in canonical space. */
static inline Vec3 shape_local_point(const Surface *surface)
{
    return transform_inverse_point(&surface->primitive->transform, surface_texture_point(surface));
}

/* It is the hit, if it is in range. */
static inline int shape_accept(const ShapeRay *ray, double candidate, double *t)
{
    if (!(candidate > ray->tmin && candidate < ray->tmax))
        return 0;
    *t = candidate;
    return 1;
}

/* A ray by length, counted from the point next to a centre: equations keep their digits there, however far away the ray
 * begins and however long its direction is. */
typedef struct ShapeLine {
    Vec3 origin, direction; /* of unit length */
    double shift, length;   /* t = (s + shift) / length */
} ShapeLine;

ShapeLine shape_line(const ShapeRay *ray, Vec3 centre);
static inline double shape_line_t(const ShapeLine *line, double s)
{
    return (s + line->shift) / line->length;
}
/* The interval of s in which crossings are looked for: from the ray's origin on, and the same for every tmin from 0, so
 * that the same crossing has the same t in every call. */
static inline double shape_line_start(const ShapeLine *line, const ShapeRay *ray)
{
    return ray->tmin < 0 ? -INFINITY : -line->shift;
}
/* Narrows low..high to the part of the line in a box; 0 where there is none. */
int shape_line_clip(const ShapeLine *line, Vec3 box_low, Vec3 box_high, double *low, double *high);
/* The first of ascending crossings that is in range, as its index, with its t; -1 where there is none. Two with
 * the same t are none. */
int shape_first_crossing(const ShapeRay *ray, const ShapeLine *line, const double *s, int count, double *t);

/* For solid_bounds: the half space below the plane in canonical space that the axis (0 x, 1 y, 2 z) stands on at its
 * origin. */
void shape_bound_half_space(const Primitive *primitive, int axis, Vec3 *low, Vec3 *high);

/* The first crossings in range of those that a shape finds in any order, and the one next to the ray's origin: that is
 * no crossing where the ray begins on the surface. */
typedef struct ShapeCrossings {
    const ShapeRay *ray;
    double first, second, near;
    int first_face, second_face, near_face;
} ShapeCrossings;

static inline ShapeCrossings shape_crossings(const ShapeRay *ray)
{
    return (ShapeCrossings){ray, INFINITY, INFINITY, INFINITY, 0, 0, 0};
}
static inline void shape_add_crossing(ShapeCrossings *c, double t, int face)
{
    if (fabs(t) < fabs(c->near))
        c->near = t, c->near_face = face;
    if (!(t > c->ray->tmin && t < c->second))
        return;
    if (t < c->first) {
        c->second = c->first, c->second_face = c->first_face;
        c->first = t, c->first_face = face;
    } else {
        c->second = t, c->second_face = face;
    }
}
/* What intersect returns. size: about that of the shape, in canonical space. */
int shape_crossings_end(const ShapeCrossings *crossings, const Primitive *primitive, double size, double *t, int *face);

/* A function that is convex, negative inside and positive outside, grows with distance by its gradient. */
typedef double ShapeConvex(const Shape *shape, Vec3 p, Vec3 *gradient);
/* Add where the line enters and leaves; low and high lie outside. 0 where it misses. */
int shape_add_convex(ShapeCrossings *crossings, const Shape *shape, ShapeConvex *f, const ShapeLine *line, double low,
                     double high);

/* A number in 0..1 that a position always has, and that tells nothing of those of others. */
double shape_share(Vec3 position);

/* An angle's share of the turn, 0..1, of the direction (x, y) counted from x. */
double shape_turn(double x, double y);
/* The natural parametrisation of a round body about the origin: u about y from x, v from below, by the angles of p. */
Vec2 shape_angles(Vec3 p);

/* A ring in the plane z = height, and the natural parametrisation of a circle about z. */
int shape_intersect_ring(const ShapeRay *ray, double height, double outer, double inner, double *t);
Vec2 shape_circle_uv(Vec3 p, double radius);

/* Widen low..high. A ball of radius ball is swept along an ellipse: the image of the circle of the given radius about
 * centre whose axes are canonical axes i and j. */
void shape_bound_point(Vec3 *low, Vec3 *high, Vec3 p);
void shape_bound_box(Vec3 *low, Vec3 *high, const Transform *t, Vec3 from, Vec3 to);
void shape_bound_circle(Vec3 *low, Vec3 *high, const Transform *t, Vec3 centre, int i, int j, double radius,
                        double ball);

static inline double shape_inverse(double area)
{
    return area > 0 ? 1 / area : 0;
}
/* The density of a shape that is sampled uniformly in the world: an operation. */
double shape_even_density(const Primitive *primitive, Vec3 p, int face);
/* Area in the world of a unit square in canonical space with edges e and f. */
double shape_stretch(const Transform *t, Vec3 e, Vec3 f);
Vec3 shape_axis(const Transform *t, int i); /* the image of a canonical axis */
double shape_circumference(double radius, Vec3 e, Vec3 f); /* of an ellipse with these axes: nearly */
double shape_similarity(const Transform *t); /* the scale, if the transform keeps shapes, else 0 */
Vec3 shape_world_normal(const Primitive *primitive, Vec3 normal); /* of unit length, outward */

#endif
