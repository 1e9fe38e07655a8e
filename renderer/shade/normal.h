/* Bumps: what the `normal` of a texture does to the normals of a surface, as POV-Ray 3.7. */
#ifndef RENDERER_SHADE_NORMAL_H
#define RENDERER_SHADE_NORMAL_H

#include "scene/scene.h"
#include "shape/surface.h"

/* The normal of the surface, tilted. normal: that without bumps, of unit length, on the side that is seen; view: the
 * direction of the ray that sees it. The result has unit length and may face away from the viewer. */
Vec3 normal_tilted(const Normal *bumps, const Surface *surface, Vec3 normal, Vec3 view);
/* The direction of a ray, tilted like the normal of a surface at a point. */
Vec3 normal_tilted_ray(const Normal *bumps, Vec3 point, Vec3 direction);

/* ---- private to shade/normal*.c ---- */

/* Patterns that tilt normals by a field of vectors, not by the slope of their value. In pattern space: the point, the
 * normal, what is added to it. NULL: the pattern has none. */
typedef Vec3 NormalVectors(const Normal *bumps, Vec3 p, Vec3 normal);
NormalVectors *normal_vectors(const PatternOps *pattern);
/* The normal tilted by a picture at a point of pattern space. */
Vec3 bump_map_tilt(const Normal *bumps, Vec3 p, Vec3 normal);
/* The normal that a normal map says, of any length; normal: that of the surface, in the space of its texture. */
Vec3 tangent_normal(const Normal *bumps, const Surface *surface, Vec3 normal);
/* The same that heights say. */
Vec3 height_normal(const Normal *bumps, const Surface *surface, Vec3 normal);

#endif
