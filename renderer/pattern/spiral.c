/* spiral1: arms that turn round the z axis, one more at each unit of length along it. spiral2: rings over them. */
#include "pattern/pattern.h"

static double spiral1(const Pattern *pattern, const PatternPoint *point)
{
    const Vec3 p = point->p;
    double turn = p.x == 0 && p.y == 0 ? 0 : atan2(p.y, p.x) / (2 * PI) + 0.25;

    if (turn < 0)
        turn += 1;
    return p.z + hypot(p.x, p.y) + pattern->number * turn;
}

static double spiral2(const Pattern *pattern, const PatternPoint *point)
{
    return triangle_wave(spiral1(pattern, point)) + triangle_wave(hypot(point->p.x, point->p.y));
}

const PatternOps pattern_spiral1 = {
    .keyword = "spiral1", .arguments = ARGUMENTS_FLOAT, .wave = WAVE_TRIANGLE, .value = spiral1};
const PatternOps pattern_spiral2 = {
    .keyword = "spiral2", .arguments = ARGUMENTS_FLOAT, .wave = WAVE_TRIANGLE, .value = spiral2};
