/* What throws caustics, and where it is in the world. */
#ifndef RENDERER_SHADE_CASTERS_H
#define RENDERER_SHADE_CASTERS_H

#include "scene/scene.h"

typedef enum CasterKind {
    CASTERS_OF_SOURCES,  /* by which light sources have caustics: Primitive.caustics */
    CASTERS_OF_EMITTERS, /* what may refract light without blur, or mirror much of it */
    CASTERS_OF_BOTH
} CasterKind;

/* A primitive, or an instance's copy of it. */
typedef struct Caster {
    int primitive;
    const Instance *instance; /* or NULL */
    int is_bounded;           /* else its box is not known */
    Vec3 low, high;           /* in the world */
} Caster;

/* Not 0 ends the visit. */
typedef int CasterVisitor(void *context, const Caster *caster);

/* Visits all of them, primitives first. Returns what the last visit returned. */
int casters_visit(const Scene *scene, CasterKind kind, CasterVisitor *visit, void *context);

#endif
