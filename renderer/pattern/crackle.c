/* crackle: by the distances to the nearest of points, of which each unit cube has one at random. */
#include <stdlib.h>
#include "pattern/pattern.h"

#define CUBE_EPSILON 1e-10

enum { NEAREST = 3 };
typedef struct Nearest {
    double distance[NEAREST]; /* the least first; of metric 2 squared */
    Vec3 point;               /* the nearest one */
} Nearest;

static double distance_of(const struct Crackle *crackle, Vec3 by)
{
    const double metric = crackle->metric, offset = crackle->offset;
    if (metric == 2)
        return vec_dot(by, by) + offset * offset;
    if (metric == 1)
        return fabs(by.x) + fabs(by.y) + fabs(by.z) + offset;
    return pow(fabs(by.x), metric) + pow(fabs(by.y), metric) + pow(fabs(by.z), metric) + pow(offset, metric);
}

static double length_of(const struct Crackle *crackle, double distance)
{
    const double metric = crackle->metric;
    return metric == 2 ? sqrt(distance) : metric == 1 ? distance : pow(distance, 1 / metric);
}

/* How far a coordinate of a cube's middle part lies from the cube that many cubes away. */
static double gap(double at, int away)
{
    return away > 0 ? away - at : away < 0 ? at - away - 1 : 0;
}

static void consider(const struct Crackle *crackle, Vec3 p, Vec3 cube, Nearest *found)
{
    const Vec3 point = vec_add(cube, noise_cell(cube));
    const double distance = distance_of(crackle, vec_sub(point, p));
    double *d = found->distance;
    if (distance < d[0]) {
        d[2] = d[1], d[1] = d[0], d[0] = distance;
        found->point = point;
    } else if (distance < d[1])
        d[2] = d[1], d[1] = distance;
    else if (distance < d[2])
        d[2] = distance;
}

/* In the cubes about the point's own, and those beyond its six sides, as POV-Ray does: 81 of them, near ones first. */
static void find_nearest(const struct Crackle *crackle, Vec3 p, Nearest *found)
{
    const Vec3 own = vec3(floor(p.x + CUBE_EPSILON), floor(p.y + CUBE_EPSILON), floor(p.z + CUBE_EPSILON));
    const Vec3 at = vec_sub(p, own);
    for (int reach = 0; reach <= 2; reach++)
        for (int x = -reach; x <= reach; x++)
            for (int y = -reach; y <= reach; y++)
                for (int z = -reach; z <= reach; z++) {
                    const int most = abs(x) > abs(y) ? abs(x) : abs(y);
                    if ((most > abs(z) ? most : abs(z)) != reach || (abs(x) == 2) + (abs(y) == 2) + (abs(z) == 2) > 1)
                        continue;
                    if (distance_of(crackle, vec3(gap(at.x, x), gap(at.y, y), gap(at.z, z))) <= found->distance[2])
                        consider(crackle, p, vec_add(own, vec3(x, y, z)), found);
                }
}

static double value(const Pattern *pattern, const PatternPoint *point)
{
    const struct Crackle *crackle = &pattern->crackle;
    Nearest found = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, point->p};
    find_nearest(crackle, point->p, &found);
    if (crackle->is_solid)
        return pattern_noise(pattern, found.point);
    const double sum = crackle->form.x * length_of(crackle, found.distance[0]) +
                       crackle->form.y * length_of(crackle, found.distance[1]) +
                       crackle->form.z * length_of(crackle, found.distance[2]);
    return fmin(fmax(sum, 0), 1);
}

const PatternOps pattern_crackle = {.keyword = "crackle", .value = value};
