/* gradient: how far a point lies along a direction. */
#include "pattern/pattern.h"

static double value(const Pattern *pattern, const PatternPoint *point)
{
    const double along = vec_dot(pattern->vector, point->p);

    return along > 1 ? fmod(along, 1) : along;
}

const PatternOps pattern_gradient = {.keyword = "gradient", .arguments = ARGUMENTS_VECTOR, .value = value};
