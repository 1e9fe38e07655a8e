/* What is seen at a pixel, and the selectors that take it, by scope (scene/selector.h). */
#ifndef RENDERER_FACES_SHOWN_H
#define RENDERER_FACES_SHOWN_H

#include "scene/selector.h"
#include "shape/surface.h"

typedef struct ShownSurface {
    ObjectPart part;
    const Primitive *primitive;
    int face; /* as in Hit */
} ShownSurface;

/* The text that selects it. Of its material, only where another object has it: else it is that of the object. Also of
 * what has no faces, which targets then tell. 0: there is none. flat: NULL, or of faces_flat: a face is then named by
 * the lowest one that is flat with it. */
int shown_selector(char text[SELECTOR_MAX], const ShownSurface *shown, SelectorScope scope, const Materials *materials,
                   const int *flat);

#endif
