/* The patterns there are. A new pattern is a line here, and a file NAME.c (or one for a family of them) with its row
 * pattern_NAME (pattern/pattern.h). */
#ifndef RENDERER_PATTERN_PATTERNS_H
#define RENDERER_PATTERN_PATTERNS_H

#include "scene/scene.h"

/* By keyword: pattern_NAME is the row. */
#define PATTERN_TABLE(X) \
    X(bozo) \
    X(bumps) \
    X(checker) \
    X(gradient) \
    X(spotted)

/* POV-Ray's patterns that are read, with a warning, and replaced by their mean colour: keyword, PatternArguments,
 * length of the list of colours, name in the warning. */
#define UNSUPPORTED_PATTERNS(X) \
    X(agate, NONE, 0, "agate") \
    X(aoi, NONE, 0, "aoi") \
    X(boxed, NONE, 0, "boxed") \
    X(brick, NONE, 2, "brick") \
    X(cells, NONE, 0, "cells") \
    X(crackle, NONE, 0, "crackle") \
    X(cubic, NONE, 6, "cubic pattern") \
    X(cylindrical, NONE, 0, "cylindrical") \
    X(density_file, FILE, 0, "density_file") \
    X(dents, NONE, 0, "dents") \
    X(facets, NONE, 0, "facets") \
    X(function, BLOCK, 0, "function pattern") \
    X(granite, NONE, 0, "granite") \
    X(hexagon, NONE, 3, "hexagon") \
    X(image_pattern, BLOCK, 0, "image_pattern") \
    X(julia, JULIA, 0, "julia") \
    X(leopard, NONE, 0, "leopard") \
    X(magnet, MAGNET, 0, "magnet") \
    X(mandel, FLOAT, 0, "mandel") \
    X(marble, NONE, 0, "marble") \
    X(object, OBJECT, 0, "object pattern") \
    X(onion, NONE, 0, "onion") \
    X(pavement, NONE, 0, "pavement") \
    X(pigment_pattern, BLOCK, 0, "pigment_pattern") \
    X(planar, NONE, 0, "planar") \
    X(projection, BLOCK, 0, "projection") \
    X(quilted, NONE, 0, "quilted") \
    X(radial, NONE, 0, "radial") \
    X(ripples, NONE, 0, "ripples") \
    X(slope, SLOPE, 0, "slope") \
    X(spherical, NONE, 0, "spherical") \
    X(spiral1, FLOAT, 0, "spiral") \
    X(spiral2, FLOAT, 0, "spiral") \
    X(square, NONE, 4, "square") \
    X(tiling, FLOAT, 0, "tiling") \
    X(triangular, NONE, 6, "triangular") \
    X(waves, NONE, 0, "waves") \
    X(wood, NONE, 0, "wood") \
    X(wrinkles, NONE, 0, "wrinkles")

#define X(name) extern const PatternOps pattern_##name;
PATTERN_TABLE(X)
#undef X

#endif
