/* A tree of boxes, for everything that looks for items along a ray or at a point in double: operands of CSG, faces of
 * meshes. It lives in an arena. */
#ifndef RENDERER_BASE_BVH_H
#define RENDERER_BASE_BVH_H

#include "base/arena.h"
#include "base/vec.h"

/* Both ends belong to it; empty where low is above high. */
typedef struct Bounds {
    Vec3 low, high;
} Bounds;

Bounds bounds_empty(void);
Bounds bounds_everywhere(void);
void bounds_add(Bounds *bounds, Vec3 p);
Bounds bounds_join(Bounds a, Bounds b);
Bounds bounds_meet(Bounds a, Bounds b);
int bounds_is_empty(const Bounds *bounds);
int bounds_is_finite(const Bounds *bounds);
Bounds bounds_padded(Bounds bounds); /* a little larger, so that rounding loses nothing */
static inline int bounds_contain(const Bounds *b, Vec3 p)
{
    return p.x >= b->low.x && p.x <= b->high.x && p.y >= b->low.y && p.y <= b->high.y && p.z >= b->low.z &&
           p.z <= b->high.z;
}

typedef struct BvhNode {
    Bounds bounds;
    int first, count; /* of items in the order of the tree; count 0: children at first and first + 1 */
} BvhNode;

typedef struct Bvh {
    int nnodes, nitems;
    BvhNode *nodes;
    int *items;
    Bounds *bounds; /* of each item in the order of the tree */
} Bvh;

/* The bounds must be finite; they are copied. 0 without memory. */
int bvh_create(Bvh *bvh, Arena *arena, const Bounds *bounds, int count);
/* Calls visit for all items whose box the ray or the point meets, near ones first or nearly so, until it returns 1:
 * then that is the answer, else 0. visit may shorten the ray. */
typedef int BvhRayVisit(void *context, Ray *ray, int item);
typedef int BvhPointVisit(void *context, Vec3 p, int item);
int bvh_along_ray(const Bvh *bvh, Ray *ray, BvhRayVisit *visit, void *context);
int bvh_at_point(const Bvh *bvh, Vec3 p, BvhPointVisit *visit, void *context);

#endif
