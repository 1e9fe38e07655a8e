/* What a height field is made of, as sdl/object/height_field.c leaves it in Shape.data. */
#ifndef RENDERER_SHAPE_HEIGHT_FIELD_H
#define RENDERER_SHAPE_HEIGHT_FIELD_H

#include <stdint.h>

enum { HEIGHT_UNITS = 65536, HEIGHT_LEVELS = 17 };

/* Of heights in a square of 2^level by 2^level cells. */
typedef struct HeightRange {
    uint16_t low, high;
} HeightRange;

typedef struct HeightLevel {
    int width, height;
    HeightRange *ranges;
} HeightLevel;

/* width times height points from x = 0 to 1 and from z = 0 to 1, row by row; heights are in HEIGHT_UNITS. */
typedef struct HeightField {
    int width, height; /* at least 2 */
    uint16_t *heights;
    double water; /* what lies lower is not there */
    int smooth;
    int nlevels;
    HeightLevel levels[HEIGHT_LEVELS]; /* of cells, of four of them, and so on to all */
} HeightField;

#endif
