/* The data that Embree works on, and its callbacks; private to renderer/accel. Builds with Embree 3 and 4. */
#ifndef RENDERER_ACCEL_EMBREE_H
#define RENDERER_ACCEL_EMBREE_H

#if defined(RETEX_EMBREE4)
#include <embree4/rtcore.h>
typedef struct RTCRayQueryContext QueryContext;
#else
#include <embree3/rtcore.h>
typedef struct RTCIntersectContext QueryContext;
#endif
#include <stdatomic.h>
#include "accel/accel.h"

/* Flags beside the RayKinds that see the primitive: it may let light through, and may do so without bending it. */
#define TRANSPARENT 0x80u
#define STRAIGHT 0x40u
#define INHERITS 0x20u /* of a primitive of a prototype: both are as its instance says */
#define LARGEST_COORDINATE 1e18 /* Embree takes anything beyond about 1.8e18 as no geometry */

typedef struct Triangle {
    Vec3 normal;   /* of unit length, outward */
    double offset; /* normal . p on its plane */
    int32_t primitive, face;
} Triangle;

/* shared.c: what is in many places, alone in a scene in its own space: a mesh of many primitives, or a prototype. */
typedef struct Shared {
    Accel *accel;
    Scene *scene;
    Primitive *mesh; /* or NULL */
    struct Shared *next;
} Shared;

struct Accel {
    Accel *parent; /* of what is shared: that of the whole scene, whose device it uses */
    RTCDevice device;
    RTCScene scene;
    const Scene *source;
    Vec3 *vertices; /* of all triangles, world space, while building; then Embree has them, in float */
    uint32_t (*corners)[3];
    Triangle *triangles;
    size_t nvertices, ntriangles;
    /* Items: primitives, by index, CSGs: ~index, and instances: index + nprimitives. What is unbounded is tested beside
     * Embree: planes, polynomials, CSGs and instances of these. */
    int *curved, *unbounded;
    int ncurved, nunbounded;
    Shared **shared;     /* by primitive: its mesh, or NULL; NULL: there are none */
    Shared **prototypes; /* by number */
    Shared *all_shared;
    unsigned triangle_geometry, curved_geometry;
    unsigned char *flags; /* of each primitive and instance, as items */
    double reach;         /* the triangles' largest coordinate */
    Vec3 low, high;      /* bounds of all that has some */
    double eye;          /* the largest coordinate of where the camera was */
    RetexError error; /* Embree's first error */
    RetexBudget *budget;
    uint64_t charged;       /* to the budget, of what is not Embree's */
    atomic_int over_budget; /* Embree wanted more than the budget has */
};

/* shared.c: finds what is shared and makes its scenes; frees those. */
int accel_find_shared(Accel *accel, RetexError *err);
void accel_free_shared(Accel *accel);
/* query.c: what Embree calls back. */
void accel_filter_occluder(const struct RTCFilterFunctionNArguments *args);
void accel_intersect_curved(const struct RTCIntersectFunctionNArguments *args);
void accel_occlude_curved(const struct RTCOccludedFunctionNArguments *args);

#endif
