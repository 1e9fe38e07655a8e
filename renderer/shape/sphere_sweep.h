/* The data of the shape sphere_sweep. */
#ifndef RENDERER_SHAPE_SPHERE_SWEEP_H
#define RENDERER_SHAPE_SPHERE_SWEEP_H

#include "base/vec.h"

enum { SWEEP_DEGREE = 3 };

/* Centre and radius, as polynomials of u from 0 to 1. */
typedef struct SweepSegment {
    Vec3 c[SWEEP_DEGREE + 1];
    double r[SWEEP_DEGREE + 1];
    Vec3 low, high; /* bounds of the spheres */
} SweepSegment;

typedef struct SphereSweep {
    int degree, count;
    Vec3 low, high;
    SweepSegment segments[];
} SphereSweep;

void sphere_sweep_set_bounds(SphereSweep *sweep); /* of segments and all */

#endif
