/* UV that a model lacks: those of a target's surfaces as they are seen from its sides, by their place in the world.
 *
 * - planar: along one plane, that of the mean normal. On walls v goes up; on floors and ceilings, within 15 degrees, u
 *   goes along the longer side of the smallest rectangle around the outline. It is seen from the side on which the
 *   camera is.
 * - box: from the axis next to the normal at each point, seen from the side that a ray meets, with v up, and away from
 *   the viewer on top. Sides are turned about the vertical as most upright faces of the target are.
 * - cylinder: around the vertical axis through the middle of the target's bounds, seen from the side that a ray meets.
 *   u goes along an arc of the bounds' mean radius, from the back on. Where a surface is nearer to level than to
 *   upright, it is as of a box.
 *
 * UV begin at the lower left of the target's bounds, or where the scene's origin is for what has no end. A unit is a
 * metre, if that of the scene is known, else a scene unit. */
#ifndef RENDERER_PATH_PROJECTION_H
#define RENDERER_PATH_PROJECTION_H

#include "shape/surface.h"

static inline int projection_is_used(const Target *target)
{
    return target->projection.kind > UV_MODEL;
}

/* Once targets and faces are marked. unit: metres of a scene unit. */
int projection_choose(Scene *scene, double unit, RetexError *err);
Vec2 projection_uv(const TargetProjection *projection, const Surface *surface);

#endif
