/* Finding a set's terms; see polynomial.h. */
#include "polynomial.h"

#include <stdlib.h>

#include "enlarge.h"

/* An RGB image that a footprint stands for, of the footprint's own size; NULL where there is none. */
static const RetexImage *find_factor(const RetexSet *set, const RetexSamples *samples, int footprint)
{
    if (footprint < 0 || footprint >= set->nfootprints)
        return NULL;
    const int part = set->footprints[footprint].albedo;
    if (samples && samples->images[footprint].pixels)
        return &samples->images[footprint];
    const RetexImage *im = part >= 0 && part < set->nparts ? &set->parts[part].image : NULL;
    return im && im->pixels && im->channels == 3 && retex_set_scale(set, im) ? im : NULL;
}

/* An image of one channel or three, as RGB of the set's size: itself, or *made. */
static int at_full_size(const float **pixels, RetexImage *made, const RetexSet *set, const RetexImage *image,
                        RetexError *err)
{
    const int scale = retex_set_scale(set, image);
    if (scale == 1 && image->channels == 3) {
        *pixels = image->pixels;
        return RETEX_OK;
    }
    size_t count = (size_t)set->width * (size_t)set->height;
    int code = made->pixels ? RETEX_OK : retex_image_alloc(made, set->width, set->height, 3, err);
    *pixels = made->pixels;
    if (code)
        return code;
    retex_enlarge_rows(image, scale, set->width, 0, set->height, made->pixels);
    for (size_t i = image->channels == 1 ? count : 0; i-- > 0;) /* from the end: each goes to where it was or behind */
        for (int c = 2; c >= 0; c--)
            made->pixels[3 * i + (size_t)c] = made->pixels[i];
    return RETEX_OK;
}

static int is_left_out(const RetexTerm *term, int cross)
{
    return (term->kind == RETEX_TERM_CROSS2 && cross < 2) || (term->kind == RETEX_TERM_CROSS3 && cross < 3);
}

static void free_images(RetexImage **images, int count)
{
    for (int i = 0; *images && i < count; i++)
        retex_image_free(&(*images)[i]);
    free(*images);
    *images = NULL;
}

void polynomial_close(Polynomial *polynomial, const RetexSet *set)
{
    free(polynomial->monomials);
    free_images(&polynomial->footprints, set->nfootprints);
    free_images(&polynomial->mixtures, set->nmixtures);
    free_images(&polynomial->gains, set->nparts);
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

/* A mixture at the size of its footprints. */
static int mix(RetexImage *image, const RetexSet *set, const RetexSamples *samples, const RetexMixture *mixture,
               RetexError *err)
{
    RetexImage weights = {0};
    int code = RETEX_OK;
    for (int k = 0; k < mixture->nshares && !code; k++) {
        const RetexImage *factor = find_factor(set, samples, mixture->shares[k].footprint);
        const int part = mixture->shares[k].weight;
        const RetexImage *weight = part >= 0 && part < set->nparts ? &set->parts[part].image : NULL;
        if (!factor || !weight || !weight->pixels || weight->width != factor->width ||
            weight->height != factor->height || (weight->channels != 1 && weight->channels != 3)) {
            code = retex_fail(err, RETEX_EFORMAT, "a mixture of the set lacks a footprint or its weight");
            break;
        }
        if (k == 0) {
            code = retex_image_alloc(image, factor->width, factor->height, 3, err);
            if (!code)
                code = retex_image_alloc(&weights, factor->width, factor->height, 3, err);
        } else if (factor->width != image->width || factor->height != image->height) {
            code = retex_fail(err, RETEX_EFORMAT, "a mixture of the set has footprints of several sizes");
        }
        if (!code)
            add_share(image->pixels, weights.pixels, weight, factor->pixels,
                      (size_t)image->width * (size_t)image->height);
    }
    if (!code && image->pixels)
        divide(image->pixels, weights.pixels, (size_t)image->width * (size_t)image->height);
    retex_image_free(&weights);
    return code;
}

static int open_mixture(Polynomial *polynomial, const RetexSet *set, const RetexSamples *samples, int m,
                        RetexError *err)
{
    RetexImage small = {0};
    const float *pixels;
    int code = mix(&small, set, samples, &set->mixtures[m], err);
    if (code || !small.pixels || retex_set_scale(set, &small) == 1) {
        polynomial->mixtures[m] = small;
        return code;
    }
    code = at_full_size(&pixels, &polynomial->mixtures[m], set, &small, err);
    retex_image_free(&small);
    return code;
}

/* Pixels of a factor; *pixels NULL where they are missing. */
static int open_factor(const float **pixels, Polynomial *polynomial, const RetexSet *set, const RetexSamples *samples,
                       int factor, RetexError *err)
{
    *pixels = NULL;
    if (factor < 0) {
        *pixels = RETEX_MIXTURE(factor) < set->nmixtures ? polynomial->mixtures[RETEX_MIXTURE(factor)].pixels : NULL;
        return RETEX_OK;
    }
    const RetexImage *image = find_factor(set, samples, factor), *made = image ? &polynomial->footprints[factor] : NULL;
    if (!image)
        return RETEX_OK;
    if (made->pixels) {
        *pixels = made->pixels;
        return RETEX_OK;
    }
    return at_full_size(pixels, &polynomial->footprints[factor], set, image, err);
}

static int open_gain(const float **pixels, Polynomial *polynomial, const RetexSet *set, int part, RetexError *err)
{
    const RetexImage *image = part < set->nparts ? &set->parts[part].image : NULL;
    *pixels = NULL;
    if (!image || !image->pixels || !retex_set_scale(set, image) || (image->channels != 1 && image->channels != 3))
        return RETEX_OK;
    if (polynomial->gains[part].pixels) {
        *pixels = polynomial->gains[part].pixels;
        return RETEX_OK;
    }
    return at_full_size(pixels, &polynomial->gains[part], set, image, err);
}

/* One term with its images. */
static int open_monomial(Monomial *m, Polynomial *polynomial, const RetexSet *set, const RetexSamples *samples,
                         int number, RetexError *err)
{
    const RetexTerm *term = &set->terms[number];
    const RetexImage *radiance =
        term->radiance >= 0 && term->radiance < set->nparts ? &set->parts[term->radiance].image : NULL;
    int complete = radiance && radiance->channels == 3 && retex_set_scale(set, radiance) == 1 && term->nfactors >= 0 &&
                   term->nfactors <= RETEX_MAX_FACTORS;
    int code = RETEX_OK;
    m->radiance = complete ? radiance->pixels : NULL;
    complete = m->radiance != NULL;
    for (int k = 0; complete && !code && k < term->nfactors; k++) {
        code = open_factor(&m->factors[k], polynomial, set, samples, m->footprints[k] = term->factors[k], err);
        complete = m->factors[k] != NULL;
    }
    m->nfactors = m->nimages = term->nfactors;
    if (complete && !code && term->gain) {
        code = open_gain(&m->factors[m->nimages], polynomial, set, term->gain, err);
        complete = m->factors[m->nimages++] != NULL;
    }
    if (!code && !complete)
        code = retex_fail(err, RETEX_EFORMAT, "term %d of the set lacks its radiance or one of its footprints", number);
    return code;
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
    polynomial->footprints = calloc((size_t)set->nfootprints + 1, sizeof *polynomial->footprints);
    polynomial->mixtures = calloc((size_t)set->nmixtures + 1, sizeof *polynomial->mixtures);
    polynomial->gains = calloc((size_t)set->nparts + 1, sizeof *polynomial->gains);
    if (!polynomial->monomials || !polynomial->footprints || !polynomial->mixtures || !polynomial->gains)
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory for %d terms", set->nterms);
    for (int m = 0; m < set->nmixtures && !code; m++)
        code = open_mixture(polynomial, set, samples, m, err);
    for (int i = 0; i < set->nterms && !code; i++)
        if (!is_left_out(&set->terms[i], cross))
            code = open_monomial(&polynomial->monomials[polynomial->count++], polynomial, set, samples, i, err);
    if (code)
        polynomial_close(polynomial, set);
    return code;
}
