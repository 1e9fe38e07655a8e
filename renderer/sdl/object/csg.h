/* Solids: objects of CSG, placed or not. */
#ifndef RENDERER_SDL_OBJECT_CSG_H
#define RENDERER_SDL_OBJECT_CSG_H

#include "sdl/object/object.h"

/* csg.c */
typedef struct SolidLeaf {
    Primitive primitive;
    const Object *object;
} SolidLeaf;

static inline const SolidLeaf *solid_leaf(const Primitive *primitive)
{
    return PARSED(SolidLeaf, primitive, primitive);
}

Csg *csg_of_object(Sdl *sdl, const Object *object); /* an object that is not placed, in its own space */
/* The object's own node, with its clips and bounds. outer: from around the object to the world. */
CsgNode *object_csg_node(Sdl *sdl, const Object *object, const Transform *outer, unsigned inverse, CsgNode *parent);
Csg *csg_complete(Sdl *sdl, CsgNode *root);
void index_mesh(Sdl *sdl, const Mesh *mesh); /* once: for what is intersected in double */

#endif
