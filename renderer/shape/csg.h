/* Constructive solid geometry: trees over primitives.
 *
 * POV-Ray's rule, which holds for operands without an inside too: a crossing of a ray with an operand is on the result
 * if, at each node above the operand, the operand's siblings let it be there. An intersection wants it inside all of
 * them, a merge inside none, a union does not ask. clipped_by wants it inside the clipping objects. A difference is the
 * intersection of its first operand with the others turned inside out, and a node that is turned inside out is the
 * other kind of node over operands turned inside out: so only leaves can be inverse (Primitive.inverse).
 *
 * Each leaf is a primitive, with its own transform, texture, interior and target: a hit is one of that primitive. */
#ifndef RENDERER_SHAPE_CSG_H
#define RENDERER_SHAPE_CSG_H

#include "base/bvh.h"
#include "shape/hit.h"

typedef enum CsgKind { CSG_LEAF, CSG_UNION, CSG_INTERSECTION, CSG_MERGE } CsgKind;

typedef struct CsgNode {
    CsgKind kind;
    struct CsgNode *parent;            /* NULL: a root */
    struct CsgNode *children, *last, *next; /* list in the order of the scene; next: of the parent's list */
    struct CsgNode *clips;             /* list of clipping objects, each a root */
    const struct Csg *bounds;          /* list: rays that miss one of them, and do not begin in it, miss the node */
    const Primitive *primitive;        /* of a leaf */
    int index;                         /* of a leaf: the caller's number of it, which hits have */
    /* What follows is made by csg_create. Outside of solid, whether a point is inside does not change: it is what
     * outside says. Nothing of the surface is outside of surface. Both may be infinite. */
    Bounds solid, surface;
    int outside;
    struct CsgNode **wide, **local;    /* children that are to be asked about any point, and those of the tree */
    int nwide;
    Bvh tree;
} CsgNode;

typedef struct Csg {
    CsgNode *root;
    Bounds surface;    /* of the root; empty where nothing is there */
    int line;          /* of the scene file, for messages; the caller's */
    const struct Csg *next; /* of a list of bounds */
    CsgNode **leaves;  /* whose surface can be on the result; first those without bounds, then those of the tree */
    int nunbounded;
    Bvh tree;
} Csg;

/* A node without children, as the last child of the parent where that is not NULL. NULL without memory. */
CsgNode *csg_node(Arena *arena, CsgKind kind, CsgNode *parent);
/* Makes a complete tree ready for queries. NULL without memory. */
Csg *csg_create(Arena *arena, CsgNode *root);

/* A search for the nearest crossing in (ray.tmin, ray.tmax) that is on the result, or for any. accept is asked of each
 * leaf that has one before the nearest so far: 0 leaves that leaf out. */
typedef struct CsgQuery {
    Ray ray;
    int (*accept)(void *context, int index); /* or NULL: all */
    void *context;
    int any;
    const CsgNode *leaf; /* NULL: none is found */
    double t;
    int face;
} CsgQuery;
int csg_intersect(const Csg *csg, CsgQuery *query);
/* Inside, as POV-Ray's inside(). */
int csg_inside(const CsgNode *node, Vec3 p);
/* Whether a point of the leaf's surface is on the result. */
int csg_on_surface(const CsgNode *leaf, Vec3 p);

#endif
