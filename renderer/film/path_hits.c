/* Hits of a light path; see path_hits.h. */
#include "film/path_hits.h"

Float4 path_white(const PathHit *hit, Float4 dependent, Float4 independent)
{
    Float4 light = independent + splat(WHITE_ALBEDO) * dependent;
    for (; hit && hit->before; hit = hit->before)
        light *= hit->way_i + splat(WHITE_ALBEDO) * hit->way_d;
    return light;
}
