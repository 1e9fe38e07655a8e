/* Patterns that are noise, or sums of it. */
#include "pattern/pattern.h"

static double value(const Pattern *pattern, const PatternPoint *point)
{
    return pattern_noise(pattern, point->p);
}

const PatternOps pattern_bozo = {.keyword = "bozo", .value = value};
const PatternOps pattern_bumps = {.keyword = "bumps", .value = value};
const PatternOps pattern_spotted = {.keyword = "spotted", .value = value};
