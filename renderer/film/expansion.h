/* A light path's throughput as a polynomial in the textures it met.
 *
 * Each hit j of a target multiplies the path by d_j a_j + i_j. Multiplied out, the path is a sum over the subsets S
 * of its hits of c_S * product over j in S of a_j (method: supplement 4.3, for any number of hits and targets). Only
 * subsets that are not zero are kept: a path over diffuse targets has one. */
#ifndef RENDERER_FILM_EXPANSION_H
#define RENDERER_FILM_EXPANSION_H

#include <stdint.h>
#include <retex/set.h>
#include "base/color4.h"
#include "shade/bsdf.h"

/* A hit of a target. */
typedef struct TargetHit {
    Vec2 uv;
    Rgb albedo; /* the original's, there */
    unsigned char target, sharp; /* sharp: every bounce between the camera and it was specular, or nearly so */
    unsigned char index;         /* among the hits of the same target along the path, from 0; in expansions */
} TargetHit;

/* A set of hits, by target: bit target * RETEX_MAX_ORDERS + index. */
typedef uint64_t HitMask;

static inline HitMask hit_bit(int target, int index)
{
    return (HitMask)1 << (target * RETEX_MAX_ORDERS + index);
}

typedef struct Monomial {
    Float4 coefficient; /* c_S, a colour */
    unsigned hits;      /* S, in the order of the path: bit j is hits[j] of the expansion */
} Monomial;

#define EXPANSION_MONOMIALS_MAX 256 /* eight hits with both parts; of diffuse targets each has one */

typedef struct ExpansionSize {
    int nhits, nmonomials;
    unsigned char per_target[RETEX_MAX_TARGETS]; /* hits of each target so far */
} ExpansionSize;

typedef struct Expansion {
    ExpansionSize size;
    TargetHit hits[RETEX_MAX_FACTORS];
    Monomial monomials[EXPANSION_MONOMIALS_MAX];
} Expansion;

static inline void expansion_reset(Expansion *e)
{
    e->size = (ExpansionSize){.nmonomials = 1};
    e->monomials[0] = (Monomial){colour4(rgb_grey(1)), 0};
}

/* What an expansion is before more hits are pushed, to return to. */
typedef struct ExpansionMark {
    ExpansionSize size;
    Monomial monomials[EXPANSION_MONOMIALS_MAX];
} ExpansionMark;

void expansion_mark(ExpansionMark *mark, const Expansion *e);
void expansion_return(Expansion *e, const ExpansionMark *mark);

/* Most hits of all targets together that a path keeps apart. Layout paper has a term for each combination of them:
 * with n hits of T targets there are (T + n)! / (T! n!), so many targets get fewer hits, for a set has room for about
 * a thousand. */
static inline int expansion_most_hits(int ntargets, int paper)
{
    if (!paper)
        return RETEX_MAX_FACTORS;
    return ntargets <= 4 ? 8 : 12 - ntargets;
}

/* Is there room for one more hit of a target, with so many orders for each and so many hits of all? */
static inline int expansion_has_room(const ExpansionSize *size, int target, int orders, int most_hits)
{
    return size->nhits < most_hits && size->per_target[target] < orders &&
           2 * size->nmonomials <= EXPANSION_MONOMIALS_MAX;
}

/* What it has grown to after another hit, of d and i or of one of them. */
static inline void expansion_grow(ExpansionSize *size, int target, int both_parts)
{
    size->nhits++;
    size->per_target[target]++;
    if (both_parts)
        size->nmonomials *= 2;
}

/* Multiply by d a + i of one more hit, which must have room; its index is found here. */
void expansion_push(Expansion *e, const TargetHit *hit, Float4 d, Float4 i);

#endif
