/* Patterns by the distance from a point, an axis or a plane, or by the angle about an axis. */
#include "pattern/pattern.h"

static double boxed(const Pattern *pattern, const PatternPoint *point)
{
    const Vec3 p = point->p;
    (void)pattern;
    return fmax(1 - fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))), 0);
}

static double cylindrical(const Pattern *pattern, const PatternPoint *point)
{
    (void)pattern;
    return fmax(1 - sqrt(point->p.x * point->p.x + point->p.z * point->p.z), 0);
}

static double planar(const Pattern *pattern, const PatternPoint *point)
{
    (void)pattern;
    return fmax(1 - fabs(point->p.y), 0);
}

static double spherical(const Pattern *pattern, const PatternPoint *point)
{
    (void)pattern;
    return fmax(1 - vec_length(point->p), 0);
}

static double onion(const Pattern *pattern, const PatternPoint *point)
{
    (void)pattern;
    return fmod(vec_length(point->p), 1);
}

static double leopard(const Pattern *pattern, const PatternPoint *point)
{
    const double sum = (sin(point->p.x) + sin(point->p.y) + sin(point->p.z)) / 3;
    (void)pattern;
    return sum * sum;
}

/* Up to 1.25: the frequency takes what is beyond 1 off. */
static double radial(const Pattern *pattern, const PatternPoint *point)
{
    const double x = point->p.x, z = point->p.z;
    (void)pattern;
    if (fabs(x) < 0.001 && fabs(z) < 0.001)
        return 0.25;
    return 0.25 + (atan2(x, z) + PI) / (2 * PI);
}

static const ColorMapEntry radial_colors[] = {{.value = 0, .color = {0, 1, 1, 0, 0}},
                                              {.value = 0.333, .color = {1, 1, 0, 0, 0}},
                                              {.value = 0.666, .color = {1, 0, 1, 0, 0}},
                                              {.value = 1, .color = {0, 1, 1, 0, 0}}};

const PatternOps pattern_boxed = {.keyword = "boxed", .value = boxed};
const PatternOps pattern_cylindrical = {.keyword = "cylindrical", .value = cylindrical};
const PatternOps pattern_leopard = {.keyword = "leopard", .value = leopard};
const PatternOps pattern_onion = {.keyword = "onion", .value = onion};
const PatternOps pattern_planar = {.keyword = "planar", .value = planar};
const PatternOps pattern_radial = {.keyword = "radial",
                                   .map = &(const ColorMap){.count = 4, .entries = (ColorMapEntry *)radial_colors},
                                   .value = radial};
const PatternOps pattern_spherical = {.keyword = "spherical", .value = spherical};
