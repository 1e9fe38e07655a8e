/* Arguments of the patterns mandel, julia and magnet: Pattern.data. */
#ifndef RENDERER_PATTERN_FRACTAL_H
#define RENDERER_PATTERN_FRACTAL_H

#include "pattern/pattern.h"

enum { FRACTAL_EXPONENT_MAX = 33, FRACTAL_TYPE_MAX = 6 };

typedef struct Fractal {
    int magnet;   /* 0: powers; 1 or 2: the formula of a magnet */
    int is_julia; /* constant is given, the iteration begins at the point; else the point is the constant */
    double constant[2];
    double iterations;
    int exponent;                          /* of powers: 2 to FRACTAL_EXPONENT_MAX */
    int exterior, interior;                /* types of colouring, 0 to FRACTAL_TYPE_MAX */
    double exterior_factor, interior_factor;
} Fractal;

#endif
