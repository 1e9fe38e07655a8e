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
    retex_image_free(&polynomial->mixture);
    *polynomial = (Polynomial){0};
}

/* The mean of the mixture's factors, weighted by their shares. */
static int open_mixture(RetexImage *mixture, const RetexSet *set, const RetexSamples *samples, RetexError *err)
{
    int code = retex_image_alloc(mixture, set->width, set->height, 3, err);
    for (int k = 0; k < set->nmixture && !code; k++) {
        const float *factor = find_factor(set, samples, set->mixture[k].footprint);
        const int part = set->mixture[k].weight;
        const RetexImage *weight = part >= 0 && part < set->nparts ? &set->parts[part].image : NULL;
        if (!factor || !weight || !weight->pixels || weight->channels != 1 || weight->width != set->width ||
            weight->height != set->height)
            return retex_fail(err, RETEX_EFORMAT, "the set's mixture lacks a footprint or its weight");
        for (size_t i = 0; i < (size_t)set->width * (size_t)set->height; i++)
            for (size_t c = 0; c < 3; c++)
                mixture->pixels[3 * i + c] += weight->pixels[i] * factor[3 * i + c];
    }
    return code;
}

/* One term with its images; returns 0 where some are missing. */
static int find_monomial(Monomial *m, const RetexSet *set, const RetexSamples *samples, const RetexTerm *term,
                         const RetexImage *mixture)
{
    m->radiance = find_pixels(set, term->radiance);
    int complete = m->radiance && term->nfactors >= 0 && term->nmixed >= 0 && term->nfactors <= RETEX_MAX_FACTORS &&
                   term->nmixed <= RETEX_MAX_FACTORS - term->nfactors && (!term->nmixed || mixture->pixels);
    for (int k = 0; complete && k < term->nfactors; k++) {
        m->footprints[k] = term->factors[k];
        m->factors[k] = find_factor(set, samples, term->factors[k]);
        complete = m->factors[k] != NULL;
    }
    if (!complete)
        return 0;
    m->nfactors = term->nfactors + term->nmixed;
    for (int k = term->nfactors; k < m->nfactors; k++)
        m->footprints[k] = -1, m->factors[k] = mixture->pixels;
    return 1;
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
    if (set->nmixture > 0)
        code = open_mixture(&polynomial->mixture, set, samples, err);
    for (int i = 0; i < set->nterms && !code; i++) {
        if (is_left_out(&set->terms[i], cross))
            continue;
        Monomial *m = &polynomial->monomials[polynomial->count++];
        if (!find_monomial(m, set, samples, &set->terms[i], &polynomial->mixture))
            code = retex_fail(err, RETEX_EFORMAT, "term %d of the set lacks its radiance or one of its footprints", i);
    }
    if (code)
        polynomial_close(polynomial);
    return code;
}
