/* The range of UV in which light met each target. The set tells it, so that footprints are cut off where a target
 * ends. */
#ifndef RENDERER_FILM_UV_RANGE_H
#define RENDERER_FILM_UV_RANGE_H

#include <math.h>
#include <retex/set.h>

typedef struct UvRange {
    double low[RETEX_MAX_TARGETS][2], high[RETEX_MAX_TARGETS][2]; /* inf, -inf: nowhere */
} UvRange;

static inline void uv_range_reset(UvRange *range)
{
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        for (int k = 0; k < 2; k++)
            range->low[t][k] = INFINITY, range->high[t][k] = -INFINITY;
}

static inline void uv_range_add(UvRange *range, int target, const double uv[2])
{
    for (int k = 0; k < 2; k++) {
        range->low[target][k] = uv[k] < range->low[target][k] ? uv[k] : range->low[target][k];
        range->high[target][k] = uv[k] > range->high[target][k] ? uv[k] : range->high[target][k];
    }
}

static inline void uv_range_merge(UvRange *into, const UvRange *from)
{
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        for (int k = 0; k < 2; k++) {
            into->low[t][k] = fmin(into->low[t][k], from->low[t][k]);
            into->high[t][k] = fmax(into->high[t][k], from->high[t][k]);
        }
}

#endif
