/* Ray queries on the scene, through Embree (this is the only folder that knows it). What is unbounded, such as planes,
 * is tested beside it. */
#ifndef RENDERER_ACCEL_ACCEL_H
#define RENDERER_ACCEL_ACCEL_H

#include <retex/budget.h>
#include "shape/surface.h"

typedef struct Accel Accel;

/* Which rays see a primitive: no_image hides it from camera rays, no_shadow from shadow rays, no_reflection from the
 * rest. */
typedef enum RayKind { RAY_CAMERA = 1, RAY_SHADOW = 2, RAY_BOUNCE = 4 } RayKind;

int accel_create(Accel **accel, const Scene *scene, int nthreads, RetexError *err);
/* The same, its memory charged to a budget, which may stop it too; NULL = none. */
int accel_create_within(Accel **accel, const Scene *scene, int nthreads, RetexBudget *budget, RetexError *err);
void accel_close(Accel **accel);
/* Nearest hit in (tmin, tmax). Returns 1 and fills hit, else 0 and hit->primitive = -1. */
int accel_intersect(const Accel *accel, const Ray *ray, RayKind kind, Hit *hit);
/* Whether anything lies in (tmin, tmax). skip_transparent: 0 = any hit blocks; 1 = the caller follows the ray itself
 * through primitives that may let light through: those with a pigment (of either side, of any face) that is not opaque,
 * and those with a finish that transmits. */
int accel_occluded(const Accel *accel, const Ray *ray, RayKind kind, int skip_transparent);
/* What a shadow ray meets: nothing, something that blocks it, or only primitives that may let light through, which the
 * caller then follows itself. Light sources shine through refracting glass unbent; other lights do not. */
typedef enum Visibility { VISIBILITY_CLEAR, VISIBILITY_BLOCKED, VISIBILITY_TRANSPARENT } Visibility;
Visibility accel_visibility(const Accel *accel, const Ray *ray, int light_source);
/* The same of up to ACCEL_PACKET rays at once. side_by_side: they are, from one pixel or to one light. */
#define ACCEL_PACKET 16
void accel_intersect_packet(const Accel *accel, const Ray *rays, const RayKind *kinds, int count, int side_by_side,
                            Hit *hits);
void accel_visibility_packet(const Accel *accel, const Ray *rays, const int *light_sources, int count,
                             Visibility *visibilities);
/* 1 if the primitive that is hit could let shadow rays through. */
int accel_is_transparent(const Accel *accel, const Hit *hit);
/* World bounds of all bounded primitives and a point, such as where the camera is. */
void accel_bounds(const Accel *accel, Vec3 eye, Vec3 *low, Vec3 *high);
/* The origin of a ray that leaves a surface, far enough from it that the ray does not meet it again. To go on along the
 * same ray, set tmin to the t of the last hit instead. */
static inline double accel_margin(Vec3 position)
{
    /* A few roundings of a float, so that Embree seldom proposes the surface that is left. What decides is in double:
     * positions are good to about 1e-15 of the coordinates they were made from, which may be larger than those of the
     * point itself; hence the floor. */
    double x = fabs(position.x), y = fabs(position.y), z = fabs(position.z);
    double largest = x > y ? x : y;
    largest = z > largest ? z : largest;
    return largest > 2.5e-5 ? 4e-7 * largest : 1e-11;
}
static inline Vec3 accel_offset(Vec3 position, Vec3 geometric_normal, Vec3 direction)
{
    double margin = accel_margin(position);
    return vec_mad(position, geometric_normal, vec_dot(direction, geometric_normal) < 0 ? -margin : margin);
}

#endif
