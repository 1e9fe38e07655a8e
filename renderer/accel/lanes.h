/* What is computed for a whole packet of rays before and after Embree traces it; private to renderer/accel. query.c
 * does the same for single rays, and has the reasons. */
#ifndef RENDERER_ACCEL_LANES_H
#define RENDERER_ACCEL_LANES_H

#include "accel/embree.h"

#define FLOAT_ERROR_BOUND 1e-3   /* bound of the relative error of a distance in float, for grazing triangles too */
#define FLOAT_ERROR_TYPICAL 1e-6 /* usual relative error of a distance in float */

typedef double LaneDoubles[ACCEL_PACKET];

typedef struct LaneRays {
    LaneDoubles origin[3], direction[3], tmin, tmax;
    LaneDoubles size, rounding; /* by lanes_start: as of a QueryRay */
} LaneRays;

/* Triangles that Embree reports, and its distances. */
typedef struct LaneTriangles {
    LaneDoubles normal[3], offset;
    float reported[ACCEL_PACKET];
    LaneDoubles t, tolerance; /* by lanes_refine: distances, and how far another hit must be from them */
    int sure[ACCEL_PACKET];   /* by lanes_refine: the triangle is hit, and no other one can be nearer */
} LaneTriangles;

/* Rays as structures of lanes. Those from `count` on have no origin. */
void lanes_take(LaneRays *lanes, const Ray *rays, int count);
/* Give rays to Embree; lanes that cannot be traced are disabled. reach: Accel's. */
void lanes_start(LaneRays *lanes, double reach, struct RTCRay16 *to, int valid[ACCEL_PACKET]);
void lanes_refine(const LaneRays *rays, LaneTriangles *triangles);

#endif
