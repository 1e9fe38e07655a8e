/* The patterns there are. A new pattern is a line here, and a file NAME.c (or one for a family of them) with its row
 * pattern_NAME (pattern/pattern.h). */
#ifndef RENDERER_PATTERN_PATTERNS_H
#define RENDERER_PATTERN_PATTERNS_H

#include "scene/scene.h"

/* By keyword: pattern_NAME is the row. */
#define PATTERN_TABLE(X) \
    X(agate) \
    X(aoi) \
    X(boxed) \
    X(bozo) \
    X(brick) \
    X(bumps) \
    X(cells) \
    X(checker) \
    X(crackle) \
    X(cubic) \
    X(cylindrical) \
    X(density_file) \
    X(dents) \
    X(facets) \
    X(function) \
    X(gradient) \
    X(granite) \
    X(hexagon) \
    X(image_pattern) \
    X(julia) \
    X(leopard) \
    X(magnet) \
    X(mandel) \
    X(marble) \
    X(object) \
    X(onion) \
    X(pavement) \
    X(pigment_pattern) \
    X(planar) \
    X(quilted) \
    X(radial) \
    X(ripples) \
    X(slope) \
    X(spherical) \
    X(spiral1) \
    X(spiral2) \
    X(spotted) \
    X(square) \
    X(tiling) \
    X(triangular) \
    X(waves) \
    X(wood) \
    X(wrinkles)

/* POV-Ray's patterns that are read, with a warning, and replaced by their mean colour: keyword, PatternArguments,
 * length of the list of colours, name in the warning. */
#define UNSUPPORTED_PATTERNS(X) \
    X(projection, BLOCK, 0, "projection")

#define X(name) extern const PatternOps pattern_##name;
PATTERN_TABLE(X)
#undef X

#endif
