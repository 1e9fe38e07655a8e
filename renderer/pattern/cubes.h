/* What patterns by cubes share with normals of the same name. */
#ifndef RENDERER_PATTERN_CUBES_H
#define RENDERER_PATTERN_CUBES_H

#include "pattern/pattern.h"

/* quilted: a Bezier curve of the distance from the centre of the cube, from 0 to 1 by way of the two control values.
 * The factor is POV-Ray's for 2 over the root of 3. */
static inline double quilted_curve(const Pattern *pattern, double t)
{
    const double s = 1 - t;
    return 1.154700538 * (3 * s * s * t * pattern->control[0] + 3 * s * t * t * pattern->control[1] + t * t * t);
}

#endif
