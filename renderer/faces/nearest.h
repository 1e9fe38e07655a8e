/* What of a scene lies next to a point. */
#ifndef RENDERER_FACES_NEAREST_H
#define RENDERER_FACES_NEAREST_H

#include "faces/shown.h"

/* The face (faces/faces.h) next to a point of the scene, in whatever copy, and what has it; of equally near ones, as
 * at an edge, the largest. RETEX_ENOTFOUND: the scene has no faces. */
int faces_nearest(ShownSurface *nearest, const Scene *scene, Vec3 point, RetexError *err);

#endif
