/* Hits of a light path; see path_hits.h. */
#include "film/path_hits.h"

Float4 path_white(const PathHit *hit, Float4 dependent, Float4 independent)
{
    Float4 light = path_hit_white(dependent, independent);
    for (; hit && hit->before; hit = hit->before)
        light *= path_hit_white(hit->before_d, hit->before_i);
    return light;
}
