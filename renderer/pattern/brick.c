/* brick: bricks with mortar between, every second course and wall moved by half a brick. */
#include "pattern/pattern.h"

/* POV-Ray's: keeps a wall that goes through the edge of mortar from speckling. */
#define BRICK_EPSILON 1e-10

static double fraction(double x)
{
    return x - floor(x);
}

/* Mortar is along the low end of each cell; cells begin one mortar before the origin. */
static double value(const Pattern *pattern, const PatternPoint *point)
{
    const double mortar = pattern->number, moved = mortar + BRICK_EPSILON;
    const Vec3 size = pattern->vector, p = vec_add(point->p, vec3(moved, moved, moved));
    const double x = p.x / size.x, y = p.y / size.y, z = p.z / size.z;
    const int second = fraction(y / 2) > 0.5;

    return fraction(y) > mortar / size.y && fraction(second ? x + 0.5 : x) > mortar / size.x &&
           fraction(second ? z : z + 0.5) > mortar / size.z;
}

static const ColorMap colors = {.entries = (ColorMapEntry[]){{.value = 0, .color = {0.5f, 0.5f, 0.5f, 0, 0}},
                                                             {.value = 1, .color = {0.6f, 0.15f, 0.15f, 0, 0}}},
                                .count = 2};

const PatternOps pattern_brick = {
    .keyword = "brick", .arguments = ARGUMENTS_BRICK, .colors = 2, .map = &colors, .value = value};
