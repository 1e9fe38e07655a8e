/* The colour of a surface with a plain texture, and where a replacement of it is looked up. */
#ifndef RENDERER_PATH_SURFACE_COLOR_H
#define RENDERER_PATH_SURFACE_COLOR_H

#include "pattern/pattern.h"
#include "shape/surface.h"

/* Where an image is looked up on a surface: a point of its pattern space, if it is known already. */
typedef struct ImagePlace {
    int is_known;
    Vec3 point;
} ImagePlace;

/* What patterns may ask of a surface; the point is in the world. */
PatternPoint surface_pattern_point(const Surface *surface);
/* The original's colour; and, of a target, the UV at which a replacement is looked up. place: what shading_prefetch
 * found, or NULL. */
Rgbft surface_color(const Surface *surface, const ImagePlace *place, Vec2 *target);
/* That UV, were the surface a target. */
Vec2 surface_target_uv(const Surface *surface);
/* Unit vectors perpendicular to a unit normal, in the world: where u of that UV grows, and where v does, as far as
 * it is perpendicular to the first. 0 where UV do not span the surface. */
int surface_target_frame(const Surface *surface, Vec3 normal, Vec3 *of_u, Vec3 *of_v);
/* Prefetch what surface_color will read. */
ImagePlace shading_prefetch(const Surface *surface);

#endif
