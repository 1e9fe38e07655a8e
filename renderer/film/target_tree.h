/* The vertices of one light path that lie on targets, as a tree, and the light that came by them. In this room such a
 * vertex is called a hit for short.
 *
 * Hit n multiplies light by d a_n + i, where a_n is the target's texture there. With D_n and I_n for light that comes
 * to hit n without another hit between it and its emitter, the light that leaves hit n towards the camera is
 *   L_n = D_n a_n + I_n + sum over the hits m next to n, away from the camera, of (d_m a_n + i_m) L_m.
 * D_n and I_n contain all other factors of the path, from the emitter to the camera. So a layout looks at each hit
 * once, from the last to the first; with lists of contributions it would look at a path's first hits again and again. A
 * hit has more than one next hit where shadow rays pass through targets; the path itself goes on from one of them. */
#ifndef RENDERER_FILM_TARGET_TREE_H
#define RENDERER_FILM_TARGET_TREE_H

#include <retex/host/assert.h>
#include <retex/set.h>
#include "film/contribution.h"

#define TARGET_NODES_MAX 64  /* of one path, those of its shadow rays too */
#define MONOMIALS_MAX 256 /* of a path multiplied out: eight hits with both parts; of diffuse targets each has one */
#define WHITE_ALBEDO 0.8f /* of white paint, for what there would be with white targets */

/* A vertex on a target. */
typedef struct TargetVertex {
    Vec2 uv;
    Rgb albedo; /* the original's, there */
    unsigned char target, sharp; /* sharp: every bounce between the camera and it was specular, or nearly so */
    unsigned char index;         /* among the hits of the same target along the path, from 0; in expansions */
    unsigned char direct;        /* there was no bounce between the camera and it */
} TargetVertex;

/* How many such vertices a path has, and how many monomials its throughput would have multiplied out. */
typedef struct TargetCounts {
    int nhits, nmonomials;
    unsigned char per_target[RETEX_MAX_TARGETS]; /* hits of each target so far */
} TargetCounts;

#define TARGET_COUNTS_INIT ((TargetCounts){.nmonomials = 1})

/* May one more hit of a target be kept apart, with at most so many hits of each target and so many of all? */
static inline int target_counts_allow(const TargetCounts *counts, int target, int orders, int most_hits)
{
    return counts->nhits < most_hits && counts->per_target[target] < orders && 2 * counts->nmonomials <= MONOMIALS_MAX;
}

/* Count one more hit; both_parts: its d and its i are not black. */
static inline void target_counts_add(TargetCounts *counts, int target, int both_parts)
{
    RETEX_ASSERT(counts->nhits < TARGET_NODES_MAX);
    counts->nhits++;
    counts->per_target[target]++;
    if (both_parts)
        counts->nmonomials *= 2;
}

/* A hit in its path's tree. There are many, so that they should not drive the scene out of the caches: one takes two
 * lines of 64 bytes. */
typedef struct TargetNode {
    Float4 dependent, independent; /* D, I */
    Float4 before_d, before_i;     /* d, i: what the hit before this one does to light that comes from here */
    const FinishFactor *before_finishes; /* the same by finish of that hit's target; or NULL */
    TargetVertex at;
    struct TargetNode *before,
        *earlier;    /* the next hit towards the camera; the one that was added last before it. Or NULL */
    int number;      /* in the order in which they were added */
    int connections; /* number of contributions in D and I */
} TargetNode;

/* Where the camera's ray of a path met a target before anything else: seen directly. */
typedef struct SeenTarget {
    int target; /* -1: none, or samples of a pixel are not spread evenly over it */
    Vec2 uv;
    float place[2]; /* within the pixel, 0..1 from its upper left corner */
} SeenTarget;

/* Kept light (KeptLight): D and I at a hit, or without one. That of a combination is divided by their number, so that
 * the sum over all of them is their mean. */
typedef struct LampLight {
    Float4 dependent, independent;
    Float4 light;                    /* with all factors */
    const TargetNode *hit;           /* NULL: independent is light without a hit */
    const struct LampLight *earlier; /* or NULL */
    int kept;
} LampLight;

typedef struct TargetTree {
    TargetNode *last; /* that was added, or NULL */
    LampLight *lamp_light; /* the last that was added, of scenes with kept light; or NULL. D and I of nodes are their
                              sums */
    int count;
    int met; /* 1: some light met a target with several finishes */
    SeenTarget seen;
    Float4 without_hit; /* sum of contributions without a hit */
    int nwithout_hit;   /* their number */
    double folded, folded_white; /* luminance of light with folded hits, as it is and as with white targets */
} TargetTree;

/* Add a hit, in memory of the caller; before_d and before_i are of the hit before it. */
static inline TargetNode *target_tree_add(TargetTree *hits, TargetNode *hit, const TargetVertex *at, TargetNode *before,
                                     Float4 before_d, Float4 before_i)
{
    RETEX_ASSERT(!before || before->number < hits->count); /* hits come after those nearer to the camera */
    hit->before_finishes = NULL;
    hit->dependent = hit->independent = splat(0);
    hit->before_d = before_d, hit->before_i = before_i;
    hit->at = *at;
    hit->before = before, hit->earlier = hits->last;
    hit->number = hits->count++, hit->connections = 0;
    return hits->last = hit;
}

/* What the hit before does in a combination. */
static inline FinishFactor target_node_before(const TargetNode *hit, const Scene *scene, int combination)
{
    return hit->before_finishes ? hit->before_finishes[scene->finish_of[combination][hit->before->at.target]]
                                : (FinishFactor){hit->before_d, hit->before_i};
}

/* Add light that meets no other hit before this one, from the emitter on; d, i: what it is to D and I. */
static inline void target_node_add_light(TargetNode *hit, Float4 d, Float4 i)
{
    hit->dependent += d;
    hit->independent += i;
    hit->connections++;
}

/* d a + i, or D a + I, where the target is white. */
static inline Float4 target_factor_white(Float4 d, Float4 i)
{
    return i + splat(WHITE_ALBEDO) * d;
}

#endif
