/* slope and aoi: the direction in which a surface faces. Both look at the surface's normal in the world, as POV-Ray
 * does: the pigment's transforms do not change it. */
#include "pattern/slope.h"

static double limited(double cosine)
{
    return fmin(1, fmax(-1, cosine));
}

/* From 0, where the surface faces against the direction, to 1; with a share of how far the point is along another
 * direction. */
static double slope(const Pattern *pattern, const PatternPoint *point)
{
    const Slope *s = pattern->data;
    const double facing = asin(limited(vec_dot(point->normal, pattern->vector))) / PI + 0.5;
    const double share = (facing - s->low) / (s->high - s->low);

    if (s->altitude_weight == 0)
        return share;
    const double along = (vec_dot(point->p, s->altitude) - s->altitude_low) / (s->altitude_high - s->altitude_low);
    return share * (1 - s->altitude_weight) + along * s->altitude_weight;
}

/* From 0, where the surface faces away from the viewer, to 1. */
static double aoi(const Pattern *pattern, const PatternPoint *point)
{
    (void)pattern;
    return acos(limited(vec_dot(point->normal, point->view))) / PI;
}

const PatternOps pattern_slope = {.keyword = "slope", .arguments = ARGUMENTS_SLOPE, .value = slope};
const PatternOps pattern_aoi = {.keyword = "aoi", .value = aoi};
