/* The table of patterns, and what is done before and after each: warps, and the waves that shape its value. */
#include <string.h>
#include "pattern/pattern.h"
#include "pattern/warp.h"

#define COORDINATE_LIMIT 1e17 /* POV-Ray's */

static const PatternOps *const patterns[] = {
#define X(name) &pattern_##name,
    PATTERN_TABLE(X)
#undef X
#define X(word, after, count, title)                                                                                   \
    &(const PatternOps){.keyword = #word, .arguments = ARGUMENTS_##after, .colors = count, .name = title},
        UNSUPPORTED_PATTERNS(X)
#undef X
};

int pattern_count(void)
{
    return (int)(sizeof patterns / sizeof *patterns);
}

const PatternOps *pattern_at(int index)
{
    return patterns[index];
}

int pattern_find(const char *keyword)
{
    for (int i = 0; i < pattern_count(); i++)
        if (*patterns[i]->keyword == *keyword && strcmp(patterns[i]->keyword, keyword) == 0)
            return i;
    return -1;
}

/* ---- values ---- */

static double apply_wave(const Pattern *pattern, double value)
{
    if (pattern->frequency != 0)
        /* 1.00001 is POV-Ray's own, so that a value of exactly 1 stays 1. */
        value = fmod(value * pattern->frequency + pattern->phase, 1.00001);
    if (value < 0)
        value -= floor(value);
    switch (pattern->wave) {
    case WAVE_RAMP:
        break;
    case WAVE_TRIANGLE:
        return triangle_wave(value);
    case WAVE_SINE:
        return (1 + sin(2 * PI * value)) / 2;
    case WAVE_SCALLOP:
        return fabs(sin(PI * value));
    case WAVE_CUBIC:
        return value * value * (3 - 2 * value);
    case WAVE_POLY:
        return pow(value, pattern->wave_exponent);
    }
    return value;
}

static double within(double x)
{
    return fabs(x) <= COORDINATE_LIMIT ? x : x > 0 ? COORDINATE_LIMIT : x < 0 ? -COORDINATE_LIMIT : 0;
}

Vec3 pattern_warp(const Pattern *pattern, Vec3 p)
{
    for (const Warp *warp = pattern->warps; warp; warp = warp->next)
        p = warp_point(warp, p);
    if (!pattern->ops || !pattern->ops->has_turbulence)
        p = turbulence_point(&pattern->turbulence, p);
    return vec3(within(p.x), within(p.y), within(p.z));
}

double pattern_value(const Pattern *pattern, const PatternPoint *point)
{
    return pattern_value_at(pattern, &(PatternPoint){pattern_warp(pattern, point->p), point->normal, point->view});
}

double pattern_value_at(const Pattern *pattern, const PatternPoint *warped)
{
    const double value = pattern->ops->value(pattern, warped);

    return pattern->ops->colors ? value : apply_wave(pattern, value);
}
