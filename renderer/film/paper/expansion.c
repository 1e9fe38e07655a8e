/* Polynomials of one path; see expansion.h. */
#include <string.h>
#include "film/paper/expansion.h"

int expansion_most_hits(int ntargets)
{
    return ntargets <= 4 ? 8 : 12 - ntargets;
}

void expansion_mark(ExpansionMark *mark, const Expansion *e)
{
    mark->size = e->size;
    for (int k = 0; k < e->size.nmonomials; k++) /* few: not worth a call */
        mark->monomials[k] = e->monomials[k];
}

void expansion_return(Expansion *e, const ExpansionMark *mark)
{
    e->size = mark->size;
    for (int k = 0; k < mark->size.nmonomials; k++)
        e->monomials[k] = mark->monomials[k];
}

void expansion_push(Expansion *e, const TargetVertex *hit, Float4 d, Float4 i)
{
    int before = e->size.nmonomials, after = before;
    unsigned bit = 1u << e->size.nhits;
    int dependent = !is_black4(d), independent = !is_black4(i);
    TargetVertex *pushed = &e->hits[e->size.nhits];
    *pushed = *hit;
    pushed->index = e->size.per_target[hit->target];
    for (int k = 0; k < before; k++) {
        Monomial *m = &e->monomials[k];
        if (dependent && independent)
            e->monomials[after++] = (Monomial){m->coefficient * d, m->hits | bit};
        if (independent) {
            m->coefficient *= i;
        } else {
            m->hits |= bit;
            m->coefficient *= d;
        }
    }
    target_counts_add(&e->size, hit->target, dependent && independent);
}
