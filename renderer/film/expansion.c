/* Polynomials of one path; see expansion.h. */
#include <string.h>
#include "film/expansion.h"

void expansion_copy(Expansion *to, const Expansion *from)
{
    to->size = from->size;
    for (int k = 0; k < from->size.nhits; k++) /* few: not worth a call */
        to->hits[k] = from->hits[k];
    for (int k = 0; k < from->size.nmonomials; k++)
        to->monomials[k] = from->monomials[k];
}

void expansion_push(Expansion *e, int target, Split factor, Vec2 uv, Rgb albedo, int sharp)
{
    int index = e->size.per_target[target], before = e->size.nmonomials, after = before;
    HitMask bit = hit_bit(target, index);
    int independent = !rgb_is_black(factor.i), dependent = !rgb_is_black(factor.d);
    e->hits[e->size.nhits] = (TargetHit){target, index, uv, albedo, sharp};
    for (int k = 0; k < before; k++) {
        Monomial *m = &e->monomials[k];
        if (dependent && independent)
            e->monomials[after++] = (Monomial){m->hits | bit, rgb_mul(m->coefficient, factor.d)};
        if (independent) {
            m->coefficient = rgb_mul(m->coefficient, factor.i);
        } else {
            m->hits |= bit;
            m->coefficient = rgb_mul(m->coefficient, factor.d);
        }
    }
    expansion_grow(&e->size, target, factor);
}
