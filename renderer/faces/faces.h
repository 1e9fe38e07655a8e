/* Faces as a person sees them: which of a primitive are flat with each other, which of a scene are level.
 *
 * A face is a triangle of a mesh, a side of a box, or a plane or disc as a whole. Faces of other shapes are not known.
 *
 * - Flat with each other are faces of one primitive that are connected by shared edges over which the surface bends by
 *   less than FLAT_DEGREES. Triangles share an edge where its ends have the same coordinates, in whatever order, so
 *   that vertices that a file repeats count once.
 * - Level are faces whose outward normals differ by less than FLAT_DEGREES and whose corners lie in the plane of the
 *   face that was pointed at, within a tolerance: a hundredth of the diagonal of that object's bounds, but no more than
 *   a two-thousandth of that of the scene's: some millimetres, by which boards differ, and rugs do not. Surfaces that
 *   are not closed have no inside: both of their normals count.
 *   Of what has copies, faces count that are level in all of them. */
#ifndef RENDERER_FACES_FACES_H
#define RENDERER_FACES_FACES_H

#include "shape/surface.h"

#define FLAT_DEGREES 10.0

/* A face in the space of its primitive: the world, or that of a prototype. */
typedef struct Face {
    Vec3 normal; /* outward, of unit length */
    double area; /* INFINITY of a plane */
    int ncorners;
    Vec3 corners[4]; /* in order around it; of a plane or a disc one point of it */
} Face;

/* How many it has; 0: they are not known. */
int faces_count(const Primitive *primitive);
/* 0: it has no area. face from 0, as Hit counts them. */
int faces_at(const Primitive *primitive, int face, Face *out);
/* The same where an instance has it. */
int faces_placed(const Primitive *primitive, const Instance *instance, int face, Face *out);
/* Of each face the lowest one that is flat with it, or -1 where it has no area; to be freed. NULL: no memory. */
int *faces_flat(const Primitive *primitive);

/* What all faces of a primitive have in common. */
typedef struct FaceOwner {
    const Primitive *primitive;
    int first_copy; /* index of the first instance that has it; -1: it is no part of a prototype, or there is none */
    int is_open;    /* 1: a surface that is not closed, which has no inside: both of its sides count as outward */
    double tolerance; /* of levels of its faces */
} FaceOwner;

/* The diagonal of a scene's bounds, INFINITY where it has none. */
double faces_scene_size(const Scene *scene);
/* scene_size: that diagonal. */
FaceOwner faces_owner(const Scene *scene, const Primitive *primitive, double scene_size);

typedef struct FaceLevel {
    Vec3 point, normal;
    double tolerance;
    int is_open; /* 1: both sides count */
} FaceLevel;

/* RETEX_ENOTFOUND: there is no such face; RETEX_EUNSUPPORTED: the shape has none. */
int faces_check(const Scene *scene, const FaceSelection *of, RetexError *err);
/* The level of a face. Besides, RETEX_EUNSUPPORTED: copies of it are not level. */
int faces_level(FaceLevel *level, const Scene *scene, const FaceSelection *of, RetexError *err);
/* The same of an owner's face that there is; only the code. */
int faces_level_of(FaceLevel *level, const Scene *scene, const FaceOwner *owner, int face);
/* 1: the face is on it. is_open: as of its owner. */
int faces_is_on_level(const FaceLevel *level, const Face *face, int is_open);
/* 1: the owner's face is on it, in all copies. */
int faces_are_on_level(const FaceLevel *level, const Scene *scene, const FaceOwner *owner, int face);

/* Mark the faces that targets select, once targets are resolved. */
int faces_mark(Scene *scene, RetexError *err);

#endif
