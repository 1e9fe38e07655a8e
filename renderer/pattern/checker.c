/* checker: the colour changes from each unit cube to the next. */
#include "pattern/pattern.h"

/* POV-Ray's: keeps a checker whose plane goes through a cell boundary from speckling. */
#define CHECKER_EPSILON 1e-10

static double value(const Pattern *pattern, const PatternPoint *point)
{
    const Vec3 p = point->p;
    const double cell = floor(p.x + CHECKER_EPSILON) + floor(p.y + CHECKER_EPSILON) + floor(p.z + CHECKER_EPSILON);

    (void)pattern;
    return fmod(cell, 2) != 0;
}

const PatternOps pattern_checker = {.keyword = "checker", .colors = 2, .map = &pattern_blue_green_red, .value = value};
