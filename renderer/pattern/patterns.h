/* The patterns there are. A new pattern is a line here, and a file NAME.c (or one for a family of them) with its row
 * pattern_NAME (pattern/pattern.h). */
#ifndef RENDERER_PATTERN_PATTERNS_H
#define RENDERER_PATTERN_PATTERNS_H

#include "scene/scene.h"

/* By keyword: pattern_NAME is the row. */
#define PATTERN_TABLE(X) \
    X(agate) \
    X(boxed) \
    X(bozo) \
    X(bumps) \
    X(cells) \
    X(checker) \
    X(crackle) \
    X(cubic) \
    X(cylindrical) \
    X(dents) \
    X(gradient) \
    X(granite) \
    X(leopard) \
    X(marble) \
    X(onion) \
    X(planar) \
    X(quilted) \
    X(radial) \
    X(ripples) \
    X(spherical) \
    X(spotted) \
    X(waves) \
    X(wood) \
    X(wrinkles)

/* POV-Ray's patterns that are read, with a warning, and replaced by their mean colour: keyword, PatternArguments,
 * length of the list of colours, name in the warning. */
#define UNSUPPORTED_PATTERNS(X) \
    X(aoi, NONE, 0, "aoi") \
    X(brick, NONE, 2, "brick") \
    X(density_file, FILE, 0, "density_file") \
    X(facets, NONE, 0, "facets") \
    X(function, BLOCK, 0, "function pattern") \
    X(hexagon, NONE, 3, "hexagon") \
    X(image_pattern, BLOCK, 0, "image_pattern") \
    X(julia, JULIA, 0, "julia") \
    X(magnet, MAGNET, 0, "magnet") \
    X(mandel, FLOAT, 0, "mandel") \
    X(object, OBJECT, 0, "object pattern") \
    X(pavement, NONE, 0, "pavement") \
    X(pigment_pattern, BLOCK, 0, "pigment_pattern") \
    X(projection, BLOCK, 0, "projection") \
    X(slope, SLOPE, 0, "slope") \
    X(spiral1, FLOAT, 0, "spiral") \
    X(spiral2, FLOAT, 0, "spiral") \
    X(square, NONE, 4, "square") \
    X(tiling, FLOAT, 0, "tiling") \
    X(triangular, NONE, 6, "triangular")

#define X(name) extern const PatternOps pattern_##name;
PATTERN_TABLE(X)
#undef X

#endif
