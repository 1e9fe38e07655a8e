/* What a letter of text is made of, as sdl/object/text.c leaves it in Shape.data. */
#ifndef RENDERER_SHAPE_TEXT_H
#define RENDERER_SHAPE_TEXT_H

#include "base/vec.h"

/* A quadratic Bézier curve that is monotonic in x and in y; a line has its middle control point halfway. Neighbours
 * of a contour share their end points to the bit. */
typedef struct GlyphCurve {
    Vec2 p[3];
    double start, length; /* along the contour, of the chords */
} GlyphCurve;

/* The outline of a letter: closed contours. What they wind round, in either sense, is filled. */
typedef struct Glyph {
    int ncurves;
    const GlyphCurve *curves;
    Vec2 low, high; /* bounding box */
} Glyph;

#endif
