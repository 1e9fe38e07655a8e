/* spiral1: arms that turn round the z axis, one more at each unit of length along it. */
#include "pattern/pattern.h"

static double value(const Pattern *pattern, const PatternPoint *point)
{
    const Vec3 p = point->p;
    double turn = p.x == 0 && p.y == 0 ? 0 : atan2(p.y, p.x) / (2 * PI) + 0.25;

    if (turn < 0)
        turn += 1;
    return p.z + hypot(p.x, p.y) + pattern->number * turn;
}

const PatternOps pattern_spiral1 = {
    .keyword = "spiral1", .arguments = ARGUMENTS_FLOAT, .wave = WAVE_TRIANGLE, .value = value};
