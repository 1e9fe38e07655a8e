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
    for (int m = 0; m < polynomial->nmixtures; m++)
        retex_image_free(&polynomial->mixtures[m]);
    *polynomial = (Polynomial){0};
}

/* Add a share's weights, and its texture times them. */
static void add_share(float *restrict sum, float *restrict weights, const RetexImage *weight,
                      const float *restrict factor, size_t pixels)
{
    const float *w = weight->pixels;
    size_t step = weight->channels == 3;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++) {
            float share = w[step ? 3 * i + c : i];
            weights[3 * i + c] += share;
            sum[3 * i + c] += share * factor[3 * i + c];
        }
}

/* A colour that has no weight takes the mean of those that have. */
static void divide(float *restrict sum, const float *restrict weights, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++, sum += 3, weights += 3) {
        float all = weights[0] + weights[1] + weights[2], mean = all > 0 ? (sum[0] + sum[1] + sum[2]) / all : 0;
        for (int c = 0; c < 3; c++)
            sum[c] = weights[c] > 0 ? sum[c] / weights[c] : mean;
    }
}

static int open_mixture(RetexImage *image, const RetexSet *set, const RetexSamples *samples,
                        const RetexMixture *mixture, RetexError *err)
{
    size_t pixels = (size_t)set->width * (size_t)set->height;
    RetexImage weights = {0};
    int code = retex_image_alloc(image, set->width, set->height, 3, err);
    if (!code)
        code = retex_image_alloc(&weights, set->width, set->height, 3, err);
    for (int k = 0; k < mixture->nshares && !code; k++) {
        const float *factor = find_factor(set, samples, mixture->shares[k].footprint);
        const int part = mixture->shares[k].weight;
        const RetexImage *weight = part >= 0 && part < set->nparts ? &set->parts[part].image : NULL;
        if (factor && weight && weight->pixels && weight->width == set->width && weight->height == set->height &&
            (weight->channels == 1 || weight->channels == 3))
            add_share(image->pixels, weights.pixels, weight, factor, pixels);
        else
            code = retex_fail(err, RETEX_EFORMAT, "a mixture of the set lacks a footprint or its weight");
    }
    if (!code)
        divide(image->pixels, weights.pixels, pixels);
    retex_image_free(&weights);
    return code;
}

/* One term with its images; returns 0 where some are missing. */
static int find_monomial(Monomial *m, const Polynomial *polynomial, const RetexSet *set, const RetexSamples *samples,
                         const RetexTerm *term)
{
    m->radiance = find_pixels(set, term->radiance);
    m->nfactors = term->nfactors;
    int complete = m->radiance && term->nfactors >= 0 && term->nfactors <= RETEX_MAX_FACTORS;
    for (int k = 0; complete && k < term->nfactors; k++) {
        int factor = m->footprints[k] = term->factors[k], mixture = RETEX_MIXTURE(factor);
        if (factor < 0)
            m->factors[k] = mixture < polynomial->nmixtures ? polynomial->mixtures[mixture].pixels : NULL;
        else
            m->factors[k] = find_factor(set, samples, factor);
        complete = m->factors[k] != NULL;
    }
    return complete;
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
    for (int m = 0; m < set->nmixtures && m < RETEX_MIXTURES_MAX && !code; m++) {
        polynomial->nmixtures = m + 1;
        code = open_mixture(&polynomial->mixtures[m], set, samples, &set->mixtures[m], err);
    }
    for (int i = 0; i < set->nterms && !code; i++) {
        if (is_left_out(&set->terms[i], cross))
            continue;
        Monomial *m = &polynomial->monomials[polynomial->count++];
        if (!find_monomial(m, polynomial, set, samples, &set->terms[i]))
            code = retex_fail(err, RETEX_EFORMAT, "term %d of the set lacks its radiance or one of its footprints", i);
    }
    if (code)
        polynomial_close(polynomial);
    return code;
}
