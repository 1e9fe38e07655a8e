/* Finding a set's terms; see polynomial.h. */
#include "polynomial.h"

#include <stdlib.h>

/* Pixels of an RGB part of the set's size; NULL where there is none. */
static const float *find_pixels(const RetexSet *set, int part)
{
    if (part < 0 || part >= set->nparts)
        return NULL;
    const RetexImage *im = &set->parts[part].image;
    return im->width == set->width && im->height == set->height && im->channels == 3 ? im->pixels : NULL;
}

static const float *find_factor(const RetexSet *set, const RetexSamples *samples, int footprint)
{
    if (footprint < 0 || footprint >= set->nfootprints)
        return NULL;
    if (samples && samples->images[footprint].pixels)
        return samples->images[footprint].pixels;
    return find_pixels(set, set->footprints[footprint].albedo);
}

static int is_left_out(const RetexTerm *term, int cross)
{
    return (term->kind == RETEX_TERM_CROSS2 && cross < 2) || (term->kind == RETEX_TERM_CROSS3 && cross < 3);
}

void polynomial_close(Polynomial *polynomial)
{
    free(polynomial->monomials);
    *polynomial = (Polynomial){0};
}

int polynomial_open(Polynomial *polynomial, const RetexSet *set, const RetexSamples *samples,
                    const RetexCombineParams *params, RetexError *err)
{
    static const RetexCombineParams defaults = RETEX_COMBINE_INIT;
    const int cross = params ? params->cross : defaults.cross;
    *polynomial = (Polynomial){0};
    if (cross != 0 && cross != 2 && cross != 3)
        return retex_fail(err, RETEX_EINVAL, "cross terms go up to 0, 2 or 3 hits, not %d", cross);
    int code = samples ? retex_samples_check(samples, set, err) : RETEX_OK;
    if (code)
        return code;
    polynomial->monomials = calloc((size_t)set->nterms + 1, sizeof *polynomial->monomials);
    if (!polynomial->monomials)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", set->nterms);
    for (int i = 0; i < set->nterms; i++) {
        const RetexTerm *term = &set->terms[i];
        if (is_left_out(term, cross))
            continue;
        Monomial *m = &polynomial->monomials[polynomial->count++];
        m->radiance = find_pixels(set, term->radiance);
        m->nfactors = term->nfactors;
        int complete = m->radiance && term->nfactors >= 0 && term->nfactors <= RETEX_MAX_FACTORS;
        for (int k = 0; complete && k < term->nfactors; k++) {
            m->footprints[k] = term->factors[k];
            m->factors[k] = find_factor(set, samples, term->factors[k]);
            complete = m->factors[k] != NULL;
        }
        if (!complete) {
            polynomial_close(polynomial);
            return retex_fail(err, RETEX_EFORMAT, "term %d of the set lacks its radiance or one of its footprints", i);
        }
    }
    return RETEX_OK;
}
