/* See lanes.h. Loops over lanes without branches: the compiler makes vectors of them. */
#include "accel/lanes.h"
#include <float.h>
#include <retex/host/cpu.h>

void lanes_take(LaneRays *lanes, const Ray *rays, int count)
{
    for (int i = 0; i < count; i++) {
        const Ray *ray = &rays[i];
        lanes->origin[0][i] = ray->origin.x, lanes->origin[1][i] = ray->origin.y, lanes->origin[2][i] = ray->origin.z;
        lanes->direction[0][i] = ray->direction.x, lanes->direction[1][i] = ray->direction.y;
        lanes->direction[2][i] = ray->direction.z;
        lanes->tmin[i] = ray->tmin, lanes->tmax[i] = ray->tmax;
    }
    for (int i = count; i < ACCEL_PACKET; i++) {
        for (int k = 0; k < 3; k++)
            lanes->origin[k][i] = INFINITY, lanes->direction[k][i] = 0;
        lanes->tmin[i] = lanes->tmax[i] = 0;
    }
}

RETEX_CPU_INLINE void start_lane(LaneRays *lanes, double reach, struct RTCRay16 *to, int *valid, int i)
{
    const double x = lanes->origin[0][i], y = lanes->origin[1][i], z = lanes->origin[2][i];
    const double dx = lanes->direction[0][i], dy = lanes->direction[1][i], dz = lanes->direction[2][i];
    const double tmin = lanes->tmin[i], tmax = lanes->tmax[i], size = fabs(x) + fabs(y) + fabs(z);
    const double start = tmin > 0 ? tmin - FLOAT_ERROR_BOUND * (tmin + size) : 0;
    const double end = tmax + FLOAT_ERROR_BOUND * (tmax + size);
    const int is_traced = (size < LARGEST_COORDINATE) & (fabs(dx) + fabs(dy) + fabs(dz) < LARGEST_COORDINATE) &
                          (tmin == tmin) & (tmax == tmax);
    lanes->size[i] = size;
    lanes->rounding[i] = 28 * DBL_EPSILON * (reach + size);
    to->org_x[i] = is_traced ? (float)x : 1, to->org_y[i] = is_traced ? (float)y : 1;
    to->org_z[i] = is_traced ? (float)z : 1;
    to->dir_x[i] = is_traced ? (float)dx : 1, to->dir_y[i] = is_traced ? (float)dy : 1;
    to->dir_z[i] = is_traced ? (float)dz : 1;
    to->tnear[i] = is_traced & (start > 0) ? (float)start : 0;
    to->tfar[i] = is_traced ? (float)end : -1;
    to->time[i] = 0, to->mask[i] = 0xffffffffu, to->id[i] = (unsigned)i, to->flags[i] = 0;
    valid[i] = -is_traced;
}

RETEX_CPU_INLINE void refine_lane(const LaneRays *rays, LaneTriangles *triangles, int i)
{
    const Vec3 normal = {triangles->normal[0][i], triangles->normal[1][i], triangles->normal[2][i]};
    const Vec3 origin = {rays->origin[0][i], rays->origin[1][i], rays->origin[2][i]};
    const Vec3 direction = {rays->direction[0][i], rays->direction[1][i], rays->direction[2][i]};
    const double height = triangles->offset[i] - vec_dot(normal, origin), fall = vec_dot(normal, direction);
    const double t = height / fall, tolerance = FLOAT_ERROR_TYPICAL * (t + rays->size[i]);
    triangles->t[i] = t, triangles->tolerance[i] = tolerance;
    triangles->sure[i] = (fabs(height) > rays->rounding[i]) & (fall != 0) & (t > rays->tmin[i]) & (t < rays->tmax[i]) &
                         (fabs(t - (double)triangles->reported[i]) <= tolerance) & (t >= tolerance);
}

RETEX_CPU_INLINE void start_body(LaneRays *restrict lanes, double reach, struct RTCRay16 *restrict to,
                                 int *restrict valid)
{
    for (int i = 0; i < ACCEL_PACKET; i++)
        start_lane(lanes, reach, to, valid, i);
}

RETEX_CPU_INLINE void refine_body(const LaneRays *restrict rays, LaneTriangles *restrict triangles)
{
    for (int i = 0; i < ACCEL_PACKET; i++)
        refine_lane(rays, triangles, i);
}

RETEX_CPU_KERNEL(start, (LaneRays * lanes, double reach, struct RTCRay16 *to, int *valid), (lanes, reach, to, valid))
RETEX_CPU_KERNEL(refine, (const LaneRays *rays, LaneTriangles *triangles), (rays, triangles))

void lanes_start(LaneRays *lanes, double reach, struct RTCRay16 *to, int valid[ACCEL_PACKET])
{
    start_by_level[retex_cpu_level()](lanes, reach, to, valid);
}

void lanes_refine(const LaneRays *rays, LaneTriangles *triangles)
{
    refine_by_level[retex_cpu_level()](rays, triangles);
}
