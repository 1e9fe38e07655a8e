/* Patterns by unit cubes: cells, quilted; and by the side of a cube. */
#include "pattern/cubes.h"

#define CUBE_EPSILON 1e-10 /* POV-Ray's: a hair below a boundary counts as beyond it */

static double cells(const Pattern *pattern, const PatternPoint *point)
{
    const Vec3 p = point->p;
    (void)pattern;
    return noise_cell(vec3(floor(p.x + CUBE_EPSILON), floor(p.y + CUBE_EPSILON), floor(p.z + CUBE_EPSILON))).x;
}

static double quilted(const Pattern *pattern, const PatternPoint *point)
{
    const Vec3 p = point->p;
    const Vec3 from = vec3(p.x - floor(p.x) - 0.5, p.y - floor(p.y) - 0.5, p.z - floor(p.z) - 0.5);
    return quilted_curve(pattern, vec_length(from)) * (fabs(from.x) + fabs(from.y) + fabs(from.z)) / 3;
}

/* Which of the sides +x, +y, +z, -x, -y, -z is seen from the middle. */
static double cubic(const Pattern *pattern, const PatternPoint *point)
{
    const Vec3 p = point->p;
    const double x = fabs(p.x), y = fabs(p.y), z = fabs(p.z);
    (void)pattern;
    if (p.x >= 0 && x >= y && x >= z)
        return 0;
    if (p.y >= 0 && y >= x && y >= z)
        return 1;
    if (p.z >= 0 && z >= x && z >= y)
        return 2;
    return x >= y && x >= z ? 3 : y >= z ? 4 : 5;
}

const PatternOps pattern_cells = {.keyword = "cells", .value = cells};
const PatternOps pattern_cubic = {.keyword = "cubic", .colors = 6, .value = cubic};
const PatternOps pattern_facets = {.keyword = "facets", .name = "facets of a pigment"}; /* of normals only */
const PatternOps pattern_quilted = {.keyword = "quilted", .value = quilted};
