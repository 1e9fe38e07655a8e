/* Arguments of the pattern slope, beside its direction, Pattern.vector: Pattern.data. */
#ifndef RENDERER_PATTERN_SLOPE_H
#define RENDERER_PATTERN_SLOPE_H

#include "pattern/pattern.h"

typedef struct Slope {
    double low, high;       /* which values become 0 and 1 */
    Vec3 altitude;          /* unit length */
    double altitude_weight; /* from 0 to 1: the share of the altitude, by the lengths of both directions */
    double altitude_low, altitude_high;
} Slope;

#endif
