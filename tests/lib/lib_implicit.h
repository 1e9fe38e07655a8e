/* Checks of a shape's operations against a function that is negative inside the shape and positive outside. */
#ifndef LIB_IMPLICIT_H
#define LIB_IMPLICIT_H

#include "lib_test.h"
#include <cmocka.h>
#include "shape/shape.h"

/* Negative inside, positive outside; p in canonical space. */
typedef double TestImplicit(const Primitive *primitive, Vec3 p);

typedef struct TestShape {
    Primitive primitive;
    TestImplicit *f;
    Vec3 centre; /* canonical: rays aim at points about it, */
    double size; /* no farther from it than this */
    double step; /* canonical: two crossings closer than that may be passed over by marching */
    int open;    /* 1: the surface has a rim, so that crossings need not change sides */
} TestShape;

/* A transform with axes of about this size: even, or not. */
Transform test_shape_transform(uint32_t *state, double size, double shift, int even);

/* Rays from near and far, from inside and outside. All their crossings, one after the other: each one once, where the
 * function changes its sign; points, normals, bounds and inside(). Returns the number of crossings. */
int test_shape_crossings(const TestShape *shape, int rays, uint32_t *state);

/* Rays that begin on the surface, also along it: the first crossing is another one. */
void test_shape_departures(const TestShape *shape, int rays, uint32_t *state);

/* Both, for sizes from 1e-4 to 1e5, near the origin and far from it. */
void test_shape_at_all_sizes(TestShape shape, int rays, uint32_t *state);

#endif
