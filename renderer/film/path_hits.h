/* What a light path met of the targets, and the light that came by it.
 *
 * A hit n of a target multiplies what comes by it by d a_n + i, a_n being the target's texture there. With D_n and I_n
 * for light that came by the hit and met no other target before it, on its way from where it shines to the camera, the
 * light that goes on from hit n is
 *   L_n = D_n a_n + I_n + sum over the hits m right behind n of (d_m a_n + i_m) L_m.
 * All else that is on the way, as far as the camera, is in D_n and I_n already. More than one hit is right behind
 * another where shadow rays pass targets; the path itself goes on from one. */
#ifndef RENDERER_FILM_PATH_HITS_H
#define RENDERER_FILM_PATH_HITS_H

#include "base/color4.h"
#include "film/expansion.h"

#define PATH_HITS_MAX 64  /* of one path, those of its shadow rays too */
#define WHITE_ALBEDO 0.8f /* of white paint, for what there would be with white targets */

/* There are many, so that they should not drive the scene out of the caches: one takes two lines of 64 bytes. */
typedef struct PathHit {
    Float4 dependent, independent; /* D, I */
    Float4 way_d, way_i;           /* d, i: what the hit before this one does to light that comes from here */
    TargetHit at;
    struct PathHit *before,
        *earlier;    /* the next hit towards the camera; the one that was met last before it. Or NULL */
    int number;      /* of the path's, as they were met */
    int connections; /* D and I are of so many */
} PathHit;

typedef struct PathHits {
    PathHit *last; /* that was met, or NULL */
    int count;
    Float4 free;          /* light that met no target */
    int free_connections; /* of so many */
} PathHits;

/* One more hit, in the room for it; way_d and way_i are of the hit before it. */
static inline PathHit *path_hits_add(PathHits *hits, PathHit *room, const TargetHit *at, PathHit *before, Float4 way_d,
                                     Float4 way_i)
{
    room->dependent = room->independent = splat(0);
    room->way_d = way_d, room->way_i = way_i;
    room->at = *at;
    room->before = before, room->earlier = hits->last;
    room->number = hits->count++, room->connections = 0;
    return hits->last = room;
}

/* Light that comes by a hit, which makes d a + i of it, and by no other hit before. */
static inline void path_hit_shine(PathHit *hit, Float4 d, Float4 i, Float4 light)
{
    hit->dependent += d * light;
    hit->independent += i * light;
    hit->connections++;
}

/* What d a + i is, or D a + I, where the target is white. */
static inline Float4 path_hit_white(Float4 d, Float4 i)
{
    return i + splat(WHITE_ALBEDO) * d;
}

/* Light that comes by a hit, D and I, or to the camera where there is none: what it would be with white targets. */
Float4 path_white(const PathHit *hit, Float4 dependent, Float4 independent);

#endif
