/* brick: bricks with mortar between, every second course and wall moved by half a brick. */
#include "pattern/pattern.h"

static double fraction(double x)
{
    return x - floor(x);
}

/* Mortar is along the low end of each cell; cells begin one mortar before the origin. */
static double value(const Pattern *pattern, const PatternPoint *point)
{
    const double mortar = pattern->number;
    const Vec3 size = pattern->vector, p = vec_add(point->p, vec3(mortar, mortar, mortar));
    const double x = p.x / size.x, y = p.y / size.y, z = p.z / size.z;
    const int second = fraction(y / 2) > 0.5;

    return fraction(y) > mortar / size.y && fraction(second ? x + 0.5 : x) > mortar / size.x &&
           fraction(second ? z : z + 0.5) > mortar / size.z;
}

const PatternOps pattern_brick = {.keyword = "brick", .arguments = ARGUMENTS_BRICK, .colors = 2, .value = value};
