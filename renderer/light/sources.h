/* The kinds of light source there are. A new kind is a line here and a row of operations (light/source.h) in a file of
 * its own; the row's name is the keyword by which the scene language asks for it. */
#ifndef RENDERER_LIGHT_SOURCES_H
#define RENDERER_LIGHT_SOURCES_H

#include "scene/scene.h"

/* light_NAME are the operations. `point` is what a light_source is that names no kind. */
#define LIGHT_TABLE(X) \
    X(point)           \
    X(spotlight)       \
    X(cylinder)        \
    X(parallel)

#define X(name) extern const LightOps light_##name;
LIGHT_TABLE(X)
#undef X

#endif
