/* A light path's throughput as a polynomial in the textures it met.
 *
 * Each hit j of a target multiplies the path by d_j a_j + i_j. Multiplied out, the path is a sum over the subsets S
 * of its hits of c_S * product over j in S of a_j (method: supplement 4.3, for any number of hits and targets). Only
 * subsets that are not zero are kept: a path over diffuse targets has one. */
#ifndef RENDERER_FILM_PAPER_EXPANSION_H
#define RENDERER_FILM_PAPER_EXPANSION_H

#include <stdint.h>
#include "film/target_tree.h"

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

typedef struct Expansion {
    TargetCounts size;
    TargetVertex hits[RETEX_MAX_HITS];
    Monomial monomials[MONOMIALS_MAX];
} Expansion;

static inline void expansion_reset(Expansion *e)
{
    e->size = TARGET_COUNTS_INIT;
    e->monomials[0] = (Monomial){color4(rgb_grey(1)), 0};
}

/* What an expansion is before more hits are pushed, to return to. */
typedef struct ExpansionMark {
    TargetCounts size;
    Monomial monomials[MONOMIALS_MAX];
} ExpansionMark;

void expansion_mark(ExpansionMark *mark, const Expansion *e);
void expansion_return(Expansion *e, const ExpansionMark *mark);

/* Most hits of all targets together that a path keeps apart. There is a term for each combination of them: with n hits
 * of T targets (T + n)! / (T! n!), so many targets get fewer hits, for a set holds about a thousand terms. */
int expansion_most_hits(int ntargets);

/* Multiply by d a + i of one more hit, which target_counts_allow must allow; its index is found here. */
void expansion_push(Expansion *e, const TargetVertex *hit, Float4 d, Float4 i);

#endif
