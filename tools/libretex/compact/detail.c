/* See detail.h. Errors are those of pictures with textures of one colour, linear in light: an error of light counts by
 * the slope of the sRGB curve at the pixel. */
#include "compact/detail.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color.h>
#include <retex/host/uv_stats.h>
#include <retex/parallel.h>

#include "compact/gains.h"
#include "compact/image_noise.h"
#include "compact/strips.h"
#include "set/noise.h"
#include "set/strip.h"
#include "set/set.h"

#define STEPS RETEX_COMPACT_STEPS
#define ALBEDO                                                                                                         \
    0.3            /* of the textures that gains are looked at with: far from RETEX_COMPACT_GREY, where they are
                             exact */
#define DARK 0.05f /* and of the picture's, by turns: */
#define BRIGHT 0.95f
#define DARKEST 0.002f        /* light below which the curve is taken to be a line */
#define DARKEST_OF_LAMP 1e-5f /* of what will be looked at more brightly */
#define BRIGHTER_MOST 20      /* as often as rendered a lamp is looked at */
#define MIXED_HITS 3          /* of more hits orders.c mixes targets */
#define CURVE (1 / 2.4)       /* exponent of the sRGB curve */
#define LEVELS 255.0          /* of which noise is measured in parts */

typedef struct Pass {
    const RetexCompactLight *light; /* of the whole set */
    RetexCompactDetails *details;
    RetexImage colored; /* the whole picture, sRGB-encoded */
    double *brightness; /* by parameter: sum of the picture by that lamp; then of all light */
    int nthreads;
} Pass;

/* What a strip is processed with; images of its size. */
typedef struct Strip {
    Pass *pass;
    const RetexCompactLight *light;
    RetexImage *slopes;                 /* by parameter: of the picture by that lamp; then of the picture by all */
    RetexImage sum, own, errors[STEPS]; /* errors[0]: light whose further hits may be mixed */
    RetexImage further;                 /* luminance of light of more than one hit */
} Strip;

/* ---- pictures ---- */

static double power(double base, int exponent)
{
    double product = 1;
    while (exponent-- > 0)
        product *= base;
    return product;
}

static float encoded(float x)
{
    return !(x > 0) ? 0 : x >= 1 ? 1 : retex_srgb_encodef(x);
}

/* The slope of the sRGB curve. */
static float slope_at(float x, float darkest)
{
    const float at = fmaxf(x, darkest), step = 0.01f * at;
    return x >= 1 ? 0 : (retex_srgb_encodef(at + step) - retex_srgb_encodef(at)) / step;
}

/* Dark and bright by turns of targets, green the other way round. */
static float color_of(int target, int channel)
{
    return (target + (channel != 1)) % 2 ? DARK : BRIGHT;
}

/* The colours of a mixture's textures. */
static int mix_colors(RetexImage *colors, const RetexSet *set, const RetexMixture *mixture, RetexError *err)
{
    int code = retex_image_alloc(colors, set->width, set->height, 3, err);
    for (size_t i = 0; i < (size_t)set->width * (size_t)set->height && !code; i++) {
        float sum = 0, *color = colors->pixels + 3 * i;
        for (int k = 0; k < mixture->nshares; k++) {
            const float weight = *retex_pixel_at(set, mixture->shares[k].weight, i);
            for (int c = 0; c < 3; c++)
                color[c] += weight * color_of(set->footprints[mixture->shares[k].footprint].target, c);
            sum += weight;
        }
        for (int c = 0; c < 3 && sum > 0; c++)
            color[c] /= sum;
    }
    return code;
}

/* Add colours times `value` and, for each hit, ALBEDO. count: of numbers. */
static void add_colors(float *restrict to, const float *restrict colors, size_t count, int hits, const double value[3])
{
    float weight[3];
    for (int c = 0; c < 3; c++)
        weight[c] = (float)(power(ALBEDO, hits) * value[c]);
    for (size_t i = 0; i < count; i += 3)
        for (size_t c = 0; c < 3; c++)
            to[i + c] += weight[c] * colors[i + c];
}

/* Add the light of a term on textures of one grey. */
static void add_grey(RetexImage *picture, const RetexSet *set, const RetexTerm *term)
{
    double value[3] = {1, 1, 1};
    if (retex_term_is_light(term))
        retex_compact_rendered(set, term, value);
    add_colors(picture->pixels, set->parts[term->radiance].image.pixels, retex_image_index(picture, 0, picture->height),
               retex_term_hits(term), value);
}

/* The grey picture by one lamp with a value of 1, or by all light as rendered (-1); light of a lamp is no light of
 * all. */
static int make_grey(RetexImage *picture, const RetexSet *set, int lamp, RetexError *err)
{
    int code = retex_image_alloc(picture, set->width, set->height, 3, err);
    for (int t = 0; t < set->nterms && !code; t++) {
        const RetexTerm *term = &set->terms[t];
        if (lamp < 0 ? retex_term_is_light(term)
                     : term->role == RETEX_ROLE_LAMP && retex_set_term_lamp(set, term) == lamp)
            add_grey(picture, set, term);
    }
    return code;
}

/* Add the light of a term on textures of two colours, sRGB-encoded. */
static void add_colored(float *picture, const RetexImage *mixtures, float *product, const RetexSet *set,
                        const RetexTerm *term)
{
    const size_t count = 3 * (size_t)set->width * (size_t)set->height;
    const float *radiance = set->parts[term->radiance].image.pixels;
    double value[3];
    retex_compact_rendered(set, term, value);
    for (int k = 0; k < term->nfactors; k++)
        for (int c = 0; c < 3 && term->factors[k].kind == RETEX_FACTOR_FOOTPRINT; c++)
            value[c] *= (double)color_of(set->footprints[term->factors[k].index].target, c);
    for (size_t i = 0; i < count; i += 3)
        for (size_t c = 0; c < 3; c++)
            product[i + c] = (float)value[c] * radiance[i + c];
    for (int k = 0; k < term->nfactors; k++)
        for (size_t i = 0; i < count && term->factors[k].kind == RETEX_FACTOR_MIXTURE; i++)
            product[i] *= mixtures[term->factors[k].index].pixels[i];
    for (size_t i = 0; i < count; i++)
        picture[i] += product[i];
}

/* Make rows of a picture of two colours, in which a denoised set shows the noise that it has left. */
static int make_colored(float *rows, const RetexSet *set, RetexError *err)
{
    const size_t count = 3 * (size_t)set->width * (size_t)set->height;
    RetexImage *mixtures = calloc((size_t)set->nmixtures + 1, sizeof *mixtures);
    float *product = malloc(sizeof *product * (count + 1));
    int code = mixtures && product ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory for scales");
    for (int m = 0; m < set->nmixtures && !code; m++)
        code = mix_colors(&mixtures[m], set, &set->mixtures[m], err);
    for (int t = 0; t < set->nterms && !code; t++)
        if (retex_term_is_light(&set->terms[t]))
            add_colored(rows, mixtures, product, set, &set->terms[t]);
    for (size_t i = 0; i < count && !code; i++)
        rows[i] = encoded(rows[i]);
    for (int m = 0; m < set->nmixtures && mixtures; m++)
        retex_image_free(&mixtures[m]);
    free(mixtures);
    free(product);
    return code;
}

static double sum_of(const RetexImage *image)
{
    double sum = 0;
    for (size_t i = 0; i < retex_image_index(image, 0, image->height); i++)
        sum += fmax((double)image->pixels[i], 0);
    return sum;
}

static void take_slopes(RetexImage *picture, float darkest)
{
    for (size_t i = 0; i < retex_image_index(picture, 0, picture->height); i++)
        picture->pixels[i] = slope_at(picture->pixels[i], darkest);
}

/* The noise that the parts of noise of a set tell. */
static int add_noise(Pass *pass, const RetexSet *set, const RetexImage *picture, RetexError *err)
{
    RetexImage noisy = {0};
    int code = retex_image_copy(&noisy, picture, err);
    if (!code)
        code = retex_set_add_noise(noisy.pixels, set, 0, set->height, err);
    for (size_t i = 0; i < retex_image_index(picture, 0, picture->height) && !code; i++) {
        const double d = (double)encoded(noisy.pixels[i]) - (double)encoded(picture->pixels[i]);
        pass->details->noise += d * d;
    }
    retex_image_free(&noisy);
    return code;
}

/* The luminance of all light of several hits, on textures of ALBEDO. */
static int make_further(Strip *s, RetexError *err)
{
    const RetexSet *set = s->light->set;
    int code = retex_image_alloc(&s->further, set->width, set->height, 1, err);
    for (int t = 0; t < set->nterms && !code; t++) {
        const float *radiance = set->parts[set->terms[t].radiance].image.pixels;
        const int hits = retex_term_hits(&set->terms[t]);
        const float albedo = (float)power(ALBEDO, hits);
        if (!retex_term_is_light(&set->terms[t]) || hits < 2)
            continue;
        for (size_t i = 0; i < retex_image_index(&s->further, 0, set->height); i++)
            s->further.pixels[i] += albedo * retex_luminance(radiance[3 * i], radiance[3 * i + 1], radiance[3 * i + 2]);
    }
    return code;
}

static int make_pictures(Strip *s, int first, RetexError *err)
{
    const RetexSet *set = s->light->set;
    Pass *pass = s->pass;
    int code = make_further(s, err);
    if (!code)
        code = set->denoised
                   ? make_colored(pass->colored.pixels + retex_image_index(&pass->colored, 0, first), set, err)
                   : add_noise(pass, set, &set->parts[0].image, err);
    if (!code)
        code = make_grey(&s->slopes[set->nparameters], set, -1, err);
    for (int p = 0; p < set->nparameters && pass->details->lamps && !code; p++)
        code = make_grey(&s->slopes[p], set, p, err);
    for (int p = 0; p <= set->nparameters && !code; p++) {
        pass->brightness[p] += sum_of(&s->slopes[p]);
        take_slopes(&s->slopes[p], p < set->nparameters ? DARKEST_OF_LAMP : DARKEST);
    }
    return code;
}

/* ---- gains ---- */

typedef struct Blocks {
    RetexImage *errors;          /* to which are added those of... */
    const RetexImage *own, *sum; /* a share of light, if it is one number in each block of `scale` pixels, */
    int scale;
    float weight[3]; /* times this */
} Blocks;

static void add_block_errors(void *context, int row, int thread)
{
    const Blocks *b = context;
    const int y0 = row * b->scale, y1 = y0 + b->scale < b->own->height ? y0 + b->scale : b->own->height;
    (void)thread;
    for (int x0 = 0; x0 < b->own->width; x0 += b->scale) {
        const int x1 = x0 + b->scale < b->own->width ? x0 + b->scale : b->own->width;
        float own[3] = {0}, sum[3] = {0}, share[3];
        for (int y = y0; y < y1; y++)
            for (size_t i = retex_image_index(b->own, x0, y), end = retex_image_index(b->own, x1, y); i < end; i += 3)
                for (size_t c = 0; c < 3; c++)
                    own[c] += b->own->pixels[i + c], sum[c] += b->sum->pixels[i + c];
        for (int c = 0; c < 3; c++)
            share[c] = sum[c] > 0 ? own[c] / sum[c] : 0;
        for (int y = y0; y < y1; y++)
            for (size_t i = retex_image_index(b->own, x0, y), end = retex_image_index(b->own, x1, y); i < end; i += 3)
                for (size_t c = 0; c < 3; c++)
                    b->errors->pixels[i + c] +=
                        b->weight[c] * (share[c] * b->sum->pixels[i + c] - b->own->pixels[i + c]);
    }
}

/* Add the errors of a share of light at all scales. */
static void add_errors(Strip *s, int hits, const double value[3])
{
    const double albedo = power(ALBEDO, hits);
    for (int step = 1; step < STEPS; step++) {
        Blocks blocks = {&s->errors[step], &s->own, &s->sum, 1 << step, {0}};
        for (int c = 0; c < 3; c++)
            blocks.weight[c] = (float)(albedo * value[c]);
        retex_parallel(s->pass->nthreads, (s->own.height + blocks.scale - 1) / blocks.scale, add_block_errors, &blocks);
    }
}

/* Add the squares of errors to those of a detail. */
static void take_errors(RetexCompactDetail *detail, Strip *s, const RetexImage *slopes)
{
    for (int step = 0; step < STEPS; step++) {
        RetexImage *errors = &s->errors[step];
        for (size_t i = 0; i < retex_image_index(errors, 0, errors->height); i++) {
            const double d = (double)(slopes->pixels[i] * errors->pixels[i]);
            detail->squares[step] += d * d;
        }
        memset(errors->pixels, 0, sizeof *errors->pixels * retex_image_index(errors, 0, errors->height));
    }
}

static int make_sum(Strip *s, const RetexCompactKind *kind, int lamps, RetexError *err)
{
    retex_image_free(&s->sum);
    return retex_compact_sum_light(&s->sum, s->light, kind, lamps, s->pass->nthreads, err);
}

static int make_own(Strip *s, const RetexCompactKind *kind, int place, RetexError *err)
{
    retex_image_free(&s->own);
    return retex_compact_term_light(&s->own, s->light, kind, RETEX_COMPACT_APART, place, err);
}

/* The gains of one kind, of these lamps. Light that several lamps have in turn is even while all are on, so errors of
 * different lamps do not add up, but their squares. */
static int add_gains(Strip *s, int number, int lamps, RetexError *err)
{
    static const double one[3] = {1, 1, 1};
    const RetexCompactLight *light = s->light;
    const RetexCompactKind *kind = &light->kinds[number];
    const RetexCompactLamps *of = &light->lamps[lamps];
    const int sums = of->alone ? light->all : lamps, count = light->nlamps + kind->ngains[RETEX_COMPACT_APART];
    int code = RETEX_OK;
    if (!retex_compact_has_light(light, kind, sums) || (!of->alone && !retex_compact_has_further(light, kind, lamps)))
        return RETEX_OK;
    code = make_sum(s, kind, sums, err);
    for (int place = 0; place < count && !code; place++) {
        const int gain = place - light->nlamps;
        if (retex_compact_term_lamps(light, kind, RETEX_COMPACT_APART, place) != lamps ||
            (gain < 0 && !retex_compact_has_single(kind, lamps)))
            continue;
        code = make_own(s, kind, place, err);
        if (code)
            break;
        const int hits = gain < 0 ? 1 : retex_term_hits(&kind->gains[RETEX_COMPACT_APART][gain].term);
        add_errors(s, hits, of->alone ? one : of->value);
        if (hits > MIXED_HITS)
            add_colors(s->errors[0].pixels, s->own.pixels, retex_image_index(&s->own, 0, s->own.height), hits,
                       of->value);
        if (of->alone)
            take_errors(&s->pass->details->lamps[number * retex_compact_most_places(light) + place], s,
                        &s->slopes[of->factors[0].index]);
    }
    if (!code && !of->alone)
        take_errors(&s->pass->details->gains[number], s, &s->slopes[light->set->nparameters]);
    return code;
}

/* Shares of single lamps of light that meets no target. */
static int add_shares(Strip *s, RetexError *err)
{
    static const double one[3] = {1, 1, 1};
    const RetexSet *set = s->light->set;
    const int without = retex_compact_light_without_hits(set);
    int code = RETEX_OK;
    for (int t = 0; t < set->nterms && without >= 0 && s->pass->details->lamps && !code; t++) {
        const int lamp = retex_set_term_lamp(set, &set->terms[t]);
        if (!retex_compact_is_lamp_share(&set->terms[t]))
            continue;
        retex_image_free(&s->sum);
        retex_image_free(&s->own);
        code = retex_image_copy(&s->sum, &set->parts[set->terms[without].radiance].image, err);
        if (!code)
            code = retex_image_copy(&s->own, &set->parts[set->terms[t].radiance].image, err);
        if (code)
            break;
        add_errors(s, 0, one);
        take_errors(&s->pass->details->lamps[s->light->nkinds * retex_compact_most_places(s->light) + lamp], s,
                    &s->slopes[lamp]);
    }
    return code;
}

/* ---- clusters ---- */

/* A pixel's clusters as one. */
typedef struct Place {
    double light, mean[2], variance;
} Place;

/* The light of each of a kind's clusters. Further hits have a share of all light of several hits each. */
static void weigh(double own[RETEX_SHARES_MAX], const Strip *s, const RetexCompactKind *kind, size_t pixel)
{
    RetexCompactClusterLight of[RETEX_SHARES_MAX];
    if (kind->kind == RETEX_FOOTPRINT_INTERREFLECTION)
        for (int k = 0; k < kind->count; k++)
            own[k] = (double)s->further.pixels[pixel] *
                     (kind->share[k] < 0 ? 1 : (double)*retex_pixel_at(s->light->set, kind->share[k], pixel));
    else
        retex_compact_cluster_light(s->light, kind, RETEX_COMPACT_ALL_LAMPS, pixel, of);
    for (int k = 0; k < kind->count && kind->kind != RETEX_FOOTPRINT_INTERREFLECTION; k++)
        own[k] = retex_compact_luminance(of[k].single) + retex_compact_luminance(of[k].interreflected);
}

static Place merged_place(const Strip *strip, const RetexCompactKind *kind, size_t pixel)
{
    const RetexSet *set = strip->light->set;
    double light[RETEX_SHARES_MAX];
    const int *periodic = set->targets[kind->target].periodic;
    Place place = {0};
    double square = 0, origin[2] = {0}, mean[2] = {0};
    weigh(light, strip, kind, pixel);
    for (int k = 0; k < kind->count; k++) {
        float uv[3], spread[3];
        const double own = light[k];
        if (!(own > 0))
            continue;
        retex_footprint_ellipse(set, &set->footprints[kind->footprints[k]], pixel, uv, spread);
        if (!(uv[2] > 0))
            continue;
        for (int axis = 0; axis < 2; axis++) {
            origin[axis] = place.light > 0 ? origin[axis] : (double)uv[axis];
            const double d = retex_uv_stats_difference((double)uv[axis], origin[axis], periodic[axis]);
            mean[axis] += own * d;
            square += own * (d * d + (double)(spread[axis] * spread[axis]));
        }
        place.light += own;
    }
    for (int axis = 0; axis < 2 && place.light > 0; axis++) {
        mean[axis] /= place.light;
        place.mean[axis] = origin[axis] + mean[axis];
        place.variance -= mean[axis] * mean[axis];
    }
    place.variance = place.light > 0 ? fmax(place.variance + square / place.light, 0) : 0;
    return place;
}

typedef struct Clusters {
    const Strip *strip;
    const RetexCompactKind *kind;
    double (*squares)[STEPS]; /* by row of the largest blocks */
} Clusters;

enum { LARGEST = 1 << (STEPS - 1) };

/* Squares of errors of a block whose pixels have one place. */
static double block_square(const Clusters *work, const Place places[LARGEST][LARGEST], int x0, int y0, int scale,
                           const float slopes[LARGEST][LARGEST])
{
    const int *periodic = work->strip->light->set->targets[work->kind->target].periodic;
    double light = 0, mean[2] = {0}, sum = 0;
    const Place *origin = NULL;
    for (int i = 0; i < scale * scale; i++) {
        const Place *p = &places[y0 + i / scale][x0 + i % scale];
        if (!(p->light > 0))
            continue;
        origin = origin ? origin : p;
        for (int axis = 0; axis < 2; axis++)
            mean[axis] += p->light * retex_uv_stats_difference(p->mean[axis], origin->mean[axis], periodic[axis]);
        light += p->light;
    }
    for (int i = 0; i < scale * scale && light > 0; i++) {
        const Place *p = &places[y0 + i / scale][x0 + i % scale];
        double far = 0;
        for (int axis = 0; axis < 2; axis++) {
            const double d =
                retex_uv_stats_difference(p->mean[axis], origin->mean[axis] + mean[axis] / light, periodic[axis]);
            far += d * d;
        }
        const double error = p->light * (double)slopes[y0 + i / scale][x0 + i % scale];
        sum += p->light > 0 ? error * error * far / (far + p->variance + 1e-12) : 0;
    }
    return sum;
}

static void add_places(void *context, int row, int thread)
{
    const Clusters *work = context;
    const RetexSet *set = work->strip->light->set;
    const RetexImage *slopes = &work->strip->slopes[set->nparameters];
    (void)thread;
    for (int x0 = 0; x0 < set->width; x0 += LARGEST) {
        Place places[LARGEST][LARGEST] = {0};
        float at[LARGEST][LARGEST] = {{0}};
        for (int i = 0; i < LARGEST * LARGEST; i++) {
            const int x = x0 + i % LARGEST, y = row * LARGEST + i / LARGEST;
            if (x >= set->width || y >= set->height)
                continue;
            places[i / LARGEST][i % LARGEST] =
                merged_place(work->strip, work->kind, (size_t)y * (size_t)set->width + (size_t)x);
            at[i / LARGEST][i % LARGEST] = slopes->pixels[retex_image_index(slopes, x, y) + 1];
        }
        for (int step = 1; step < STEPS; step++)
            for (int k = 0; k < LARGEST * LARGEST >> (2 * step); k++) {
                const int count = LARGEST >> step;
                work->squares[row][step] +=
                    block_square(work, places, k % count << step, k / count << step, 1 << step, at);
            }
    }
}

static int add_clusters(Strip *s, int number, RetexError *err)
{
    const int rows = (s->light->set->height + LARGEST - 1) / LARGEST;
    Clusters work = {s, &s->light->kinds[number], calloc((size_t)rows + 1, sizeof *work.squares)};
    if (!work.squares)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for scales");
    retex_parallel(s->pass->nthreads, rows, add_places, &work);
    for (int row = 0; row < rows; row++)
        for (int step = 1; step < STEPS; step++)
            s->pass->details->clusters[number].squares[step] += 3 * work.squares[row][step];
    free(work.squares);
    return RETEX_OK;
}

/* ---- the pass ---- */

static void close_strip(Strip *s)
{
    for (int p = 0; p <= s->light->set->nparameters && s->slopes; p++)
        retex_image_free(&s->slopes[p]);
    for (int step = 0; step < STEPS; step++)
        retex_image_free(&s->errors[step]);
    retex_image_free(&s->sum);
    retex_image_free(&s->own);
    retex_image_free(&s->further);
    free(s->slopes);
}

static int process_strip(void *context, const RetexCompactLight *light, int first, RetexError *err)
{
    const RetexSet *set = light->set;
    Strip s = {.pass = context, .light = light, .slopes = calloc((size_t)set->nparameters + 1, sizeof *s.slopes)};
    int code = s.slopes ? make_pictures(&s, first, err) : retex_fail(err, RETEX_ENOMEM, "not enough memory for scales");
    for (int step = 0; step < STEPS && !code; step++)
        code = retex_image_alloc(&s.errors[step], set->width, set->height, 3, err);
    for (int i = 0; i < light->nkinds && !code; i++) {
        const RetexFootprintKind kind = light->kinds[i].kind;
        for (int lamps = 0; lamps < light->nlamps && kind != RETEX_FOOTPRINT_INTERREFLECTION && !code; lamps++)
            code = add_gains(&s, i, lamps, err);
        if (!code && kind != RETEX_FOOTPRINT_SHARP)
            code = add_clusters(&s, i, err);
    }
    if (!code)
        code = add_shares(&s, err);
    close_strip(&s);
    return code;
}

static void finish(RetexCompactDetail *detail, double scale)
{
    for (int step = 1; step < STEPS; step++)
        detail->squares[step] *= scale;
    detail->noise = fmax(2 * detail->squares[1] - detail->squares[2], 0) / (2 * 3 / 4.0 - 15 / 16.0);
}

/* A lamp is looked at as brightly as the whole. Errors grow with light as the curve does. */
static double lamp_scale(const Pass *pass, int lamp)
{
    const RetexSet *set = pass->light->set;
    const float *kept = set->parameters[lamp].kept;
    const double most = BRIGHTER_MOST * (double)retex_luminance(kept[0], kept[1], kept[2]);
    const double own = pass->brightness[lamp], all = pass->brightness[set->nparameters];
    return own > 0 ? pow(fmin(all / own, most > 0 ? most : BRIGHTER_MOST), 2 * CURVE) : 1;
}

static void finish_lamps(const Pass *pass, double scale)
{
    const RetexCompactLight *light = pass->light;
    const int places = retex_compact_most_places(light);
    for (int k = 0; k < light->nkinds * places; k++) {
        const RetexCompactKind *kind = &light->kinds[k / places];
        if (k % places >= light->nlamps + kind->ngains[RETEX_COMPACT_APART])
            continue;
        const RetexCompactLamps *lamps =
            &light->lamps[retex_compact_term_lamps(light, kind, RETEX_COMPACT_APART, k % places)];
        if (lamps->alone)
            finish(&pass->details->lamps[k], scale * lamp_scale(pass, lamps->factors[0].index));
    }
    for (int p = 0; p < light->set->nparameters; p++)
        finish(&pass->details->lamps[light->nkinds * places + p], scale * lamp_scale(pass, p));
}

int retex_compact_details_open(RetexCompactDetails *details, const RetexCompactLight *light, int nthreads,
                               RetexError *err)
{
    const RetexSet *set = light->set;
    const double scale = 1 / (3.0 * set->width * set->height);
    const size_t places = (size_t)(light->nkinds * retex_compact_most_places(light) + set->nparameters);
    Pass pass = {.light = light, .details = details, .nthreads = nthreads};
    *details = (RetexCompactDetails){0};
    pass.brightness = calloc((size_t)set->nparameters + 1, sizeof *pass.brightness);
    if (retex_set_has_role(set, RETEX_ROLE_LAMP))
        details->lamps = calloc(places + 1, sizeof *details->lamps);
    int code = pass.brightness && (details->lamps || !retex_set_has_role(set, RETEX_ROLE_LAMP))
                   ? retex_image_alloc(&pass.colored, set->width, set->height, 3, err)
                   : retex_fail(err, RETEX_ENOMEM, "not enough memory for scales");
    if (!code)
        code = retex_compact_strips(light, process_strip, &pass, nthreads, err);
    for (int i = 0; i < light->nkinds && !code; i++)
        finish(&details->gains[i], scale), finish(&details->clusters[i], scale);
    for (int i = 0; i < light->nkinds && !code; i++)
        details->mixed[i] = details->gains[i].squares[0] * scale, details->gains[i].squares[0] = 0;
    if (!code && details->lamps)
        finish_lamps(&pass, scale);
    if (!code)
        details->noise = set->denoised
                             ? pow(RETEX_DENOISED_NOISE * retex_image_noise(&pass.colored, LEVELS) / LEVELS, 2)
                             : scale * details->noise;
    retex_image_free(&pass.colored);
    free(pass.brightness);
    if (code)
        retex_compact_details_close(details);
    return code;
}

void retex_compact_details_close(RetexCompactDetails *details)
{
    free(details->lamps);
    details->lamps = NULL;
}
