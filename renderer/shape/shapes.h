/* The shapes there are. A new shape is a line here, a file NAME.c with its row of operations (shape/shape.h), and its
 * parser parse_NAME in sdl/object. */
#ifndef RENDERER_SHAPE_SHAPES_H
#define RENDERER_SHAPE_SHAPES_H

#include "scene/scene.h"

/* By keyword: shape_NAME are the operations. */
#define SHAPE_TABLE(X) \
    X(blob)            \
    X(box)             \
    X(cone)            \
    X(disc)            \
    X(height_field)    \
    X(isosurface)      \
    X(julia_fractal)   \
    X(lathe)           \
    X(mesh)            \
    X(ovus)            \
    X(plane)           \
    X(poly)            \
    X(prism)           \
    X(sor)             \
    X(sphere)          \
    X(sphere_sweep)    \
    X(superellipsoid)  \
    X(text)            \
    X(torus)

#define X(name) extern const ShapeOps shape_##name;
SHAPE_TABLE(X)
#undef X

#endif
