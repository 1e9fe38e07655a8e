/* UV in scene units, of targets whose parts differ in size.
 *
 * A target that is pointed at may be a few boxes, cylinders and spheres of any size, none of which was made to carry a
 * texture. Their natural UV go from 0 to 1 on each face, so that a texture would be as large as the face. In place of
 * them:
 *
 * - Parts that all close and are equally long around keep their own u, so that a texture can go round them in whole
 *   repeats; v, and the caps of cylinders, are as long in proportion.
 * - Else a unit of UV is a scene unit. Flat faces, rotated or not, are seen from outside along their own axes, counted
 *   from the scene's origin, so that rows of bricks go on from box to box. What closes goes there and back, mirrored,
 *   so that it has no seam. All other shapes, planes among them, take the box projection, of the scene's axes.
 *
 * A surface with uv_mapping or an image_map, or with a mesh's own UV, keeps them. Where a target has a projection
 * (path/projection.h), that goes before all of this. */
#ifndef RENDERER_PATH_TARGET_UNITS_H
#define RENDERER_PATH_TARGET_UNITS_H

#include "shape/surface.h"

/* Once targets are resolved: which of them need it. */
void target_units_choose(Scene *scene);
/* of: what surface_uv gives. 0: the surface keeps the UV that target_uv gives it. */
int target_units_uv(const Surface *surface, const SurfaceUv *of, Vec2 *uv);

#endif
