/* What a camera ray sees: the first surface, and, where that is glass or a mirror, what is seen through it and in it. A
 * ray divides where it meets both, so that the shares have no noise but that of where rays go through the pixel. */
#ifndef RENDERER_RENDER_SEEN_THROUGH_H
#define RENDERER_RENDER_SEEN_THROUGH_H

#include "render/first_hit.h"

/* By what the pixel shows first: a surface itself, also through holes and clear surfaces that do not refract; what is
 * behind glass; what is in a mirror. What follows behind that does not matter: a mirror behind a window is seen through
 * the window, and so is what is in it. */
typedef enum SeenHow { SEEN_DIRECTLY, SEEN_TRANSMITTED, SEEN_REFLECTED } SeenHow;

/* A leaf of a surface that is met. Shares are of the ray, 0..1. */
typedef struct SeenSurface {
    const SeenLeaf *leaf;
    const Hit *hit;
    SeenHow how;
    float covers; /* what arrives here, without what goes straight on. Of what is seen directly the sum is 1, but for
                     what meets nothing */
    float ends;   /* of this, what is neither mirrored nor refracted. Over all the sum is 1 in the same way */
    unsigned met; /* bits: targets in or behind which this is seen */
} SeenSurface;
typedef void SeenVisitor(void *context, const SeenSurface *seen);

/* hit: what the ray meets first. */
void seen_through(const FirstHitWindow *window, const Ray *ray, const Hit *hit, SeenVisitor *visit, void *context);

#endif
