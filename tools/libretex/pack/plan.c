/* Chooses codecs and quantizers by a part's use in the set, its range of values and its noise. See plan.h. */
#include "pack/plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "compact/light.h"
#include "compact/image_noise.h"
#include "set/references.h"
#include "set/set.h"
#include "set/steps.h"

#define FINE_NOISE 3     /* the step of radiance is at most this many times its noise, */
#define FINER_MOST 4     /* but at least the quality's step divided by this; */
#define COARSE_NOISE 0.5 /* it is at least this many times its noise, */
#define COARSER_MOST 3   /* but at most this many times the quality's step */
#define BRIGHTER_MOST 4  /* most white of a part of radiance, as a multiple of the set's white */
#define GAIN_STEP 2.5    /* most step of gains, in steps of their radiance: errors of many gains average out. */
#define GAIN_FINER 1.5   /* With little noise the step is smaller, but at least this many steps of radiance */
#define LAMP_STEP 2.5    /* least step of a lamp's gain, in those of others; */
#define LAMP_COARSER 32  /* it is at most so many times coarser, where little of the lamp's light has the gain, */
#define LAMP_SHARE 0.3   /* less than this share; */
#define LAMP_POWER 0.7   /* of 1, all gains would add the same error to the picture by the lamp */
#define STEP_SHARE 16    /* for the sizes of axes, which are 3.5 deviations, and whose errors add up in steps */
#define GAIN_NOISE 0.8   /* and this many times the noise: quantization adds a twentieth to its variance */

double retex_pack_quality_psnr(double quality)
{
    return 20 + 0.4 * quality;
}

RetexPackQuantizer retex_pack_quantizer(double psnr)
{
    const double error = 255 * pow(10, -psnr / 20);                         /* RMS, in levels */
    const int fine = psnr >= 50, times = psnr > 58 ? 4 : psnr > 56 ? 2 : 1; /* finer than by default */
    return (RetexPackQuantizer){.jpeg_step = 1.8 * error,
                                .original_step = 3.6 * error,
                                .picture_step = fmax(14 * error, 5),
                                .sharp = {4 * times, fine ? 8 : 4, fine ? 32 : 16},
                                .broad = {2 * times, times > 1 ? 8 : 2, times > 1 ? 32 : 4},
                                .weight_steps = times > 2 ? 255 : 64 * times,
                                .coarser_most = times > 1 ? 1 : COARSER_MOST,
                                .gain_noise = times > 2 ? 0 : GAIN_NOISE};
}

/* How a part may be coded: what is of one coding has the same codec and kind of quantizer. */
typedef enum Coding {
    CODING_NONE,
    CODING_EXACT,
    CODING_LIGHT,
    CODING_ALBEDO,
    CODING_ORIGINAL,
    CODING_GAIN,
    CODING_MEAN,
    CODING_SPREAD,
    CODING_WEIGHT
} Coding;

/* The range of a channel's samples. */
typedef struct Range {
    int all_zero, positive; /* positive: all are finite and not negative */
    float most, most_size;  /* the largest sample and the largest magnitude */
    double sum;             /* of finite samples */
} Range;

typedef struct Planning {
    double white;   /* the set's white: the least value at level 255 of any radiance */
    double *whites; /* by part of radiance: its value at level 255, with parameters as rendered */
    RetexPackPart *packed;
    const RetexSet *set;
    const RetexPackQuantizer *quantizer;
    Coding *codings;
    int *means; /* by part of standard deviations: the part of their means */
    Range (*ranges)[RETEX_PACK_CHANNELS_MAX];
    double *noise;       /* by part of radiance, in levels; -1 if memory ran out */
    double *lamp_shares; /* by gain of a lamp: how much of the light of the lamp has it, about; else 0 */
} Planning;

/* --- what is coded alike --- */

/* A part that is used in two different ways is stored without loss, but light that is a weight, too. */
static void give_coding(Planning *plan, int part, Coding coding)
{
    if (part < 0 || (plan->codings[part] == CODING_LIGHT && coding == CODING_WEIGHT))
        return;
    const int is_free = plan->codings[part] == CODING_NONE || plan->codings[part] == coding;
    plan->codings[part] = is_free ? coding : CODING_EXACT;
}

static void give_footprint_codings(Planning *plan, const RetexFootprint *f)
{
    const RetexSet *set = plan->set;
    give_coding(plan, f->albedo, CODING_ALBEDO);
    if (f->uv < 0 || f->spread < 0) {
        give_coding(plan, f->uv, CODING_EXACT);
        give_coding(plan, f->spread, CODING_EXACT);
        return;
    }
    const RetexPart *uv = &set->parts[f->uv], *spread = &set->parts[f->spread];
    const int apart = plan->codings[f->spread] != CODING_NONE && plan->means[f->spread] != f->uv;
    const int fit = uv->image.channels == 3 && spread->image.channels >= 2 && spread->image.channels <= RETEX_AXES &&
                    uv->image.width == spread->image.width && uv->image.height == spread->image.height && !apart &&
                    (plan->codings[f->uv] == CODING_NONE || plan->means[f->spread] == f->uv);
    give_coding(plan, f->uv, fit ? CODING_MEAN : CODING_EXACT);
    give_coding(plan, f->spread, fit ? CODING_SPREAD : CODING_EXACT);
    plan->means[f->spread] = f->uv;
}

static void give_part_coding(void *context, RetexPartUse use, int user, int *part)
{
    static const Coding of_use[] = {[RETEX_PART_RADIANCE] = CODING_LIGHT,
                                    [RETEX_PART_IMAGE] = CODING_GAIN,
                                    [RETEX_PART_ORIGINAL] = CODING_ORIGINAL,
                                    [RETEX_PART_WEIGHT] = CODING_WEIGHT};
    (void)user;
    if (use != RETEX_PART_UV && use != RETEX_PART_SPREAD && use != RETEX_PART_ALBEDO)
        give_coding(context, *part, of_use[use]);
}

static void give_codings(Planning *plan)
{
    const RetexSet *set = plan->set;
    retex_set_visit_const_parts(set, give_part_coding, plan);
    for (int i = 0; i < set->nfootprints; i++)
        give_footprint_codings(plan, &set->footprints[i]);
    give_coding(plan, 0, CODING_LIGHT);
}

/* --- ranges and noise --- */

static void find_ranges(void *context, int part, int thread)
{
    Planning *plan = context;
    const RetexImage *im = &plan->set->parts[part].image;
    (void)thread;
    for (int c = 0; c < im->channels && c < RETEX_PACK_CHANNELS_MAX; c++) {
        Range range = {1, 1, 0, 0, 0};
        for (size_t i = 0; i < (size_t)im->width * (size_t)im->height; i++) {
            const float v = im->pixels[i * (size_t)im->channels + (size_t)c];
            range.all_zero = range.all_zero && v == 0 && !signbit(v);
            range.positive = range.positive && v >= 0 && isfinite(v);
            range.most = fmaxf(range.most, v);
            range.sum += isfinite(v) ? (double)v : 0;
            range.most_size = isfinite(v) ? fmaxf(range.most_size, fabsf(v)) : INFINITY;
        }
        plan->ranges[part][c] = range;
    }
}

static double mean_of(const Planning *plan, int part)
{
    const RetexImage *im = &plan->set->parts[part].image;
    double sum = 0;
    for (int c = 0; c < im->channels && c < RETEX_PACK_CHANNELS_MAX; c++)
        sum += plan->ranges[part][c].sum;
    return sum / ((double)im->width * im->height * im->channels);
}

/* Finds how much of a lamp's light has each of its gains, by the means of images, with textures of
 * RETEX_COMPACT_GREY. */
static int find_lamp_shares(Planning *plan, RetexError *err)
{
    const RetexSet *set = plan->set;
    double sums[RETEX_PARAMETERS_MAX] = {0};
    int *lamps = calloc((size_t)set->nparts + 1, sizeof *lamps);
    if (!lamps)
        return retex_fail(err, RETEX_ENOMEM, "no memory to pack a set");
    for (int t = 0; t < set->nterms; t++) {
        const RetexTerm *term = &set->terms[t];
        const int lamp = term->role == RETEX_ROLE_LAMP ? retex_set_term_lamp(set, term) : -1;
        for (int k = 0; k < term->nfactors && lamp >= 0; k++) {
            const int part = term->factors[k].index;
            if (term->factors[k].kind != RETEX_FACTOR_IMAGE)
                continue;
            lamps[part] = lamp;
            plan->lamp_shares[part] =
                fmax(plan->lamp_shares[part], mean_of(plan, term->radiance) * mean_of(plan, part) *
                                                  pow((double)RETEX_COMPACT_GREY, retex_term_hits(term)));
        }
    }
    for (int part = 0; part < set->nparts; part++)
        sums[lamps[part]] += plan->lamp_shares[part];
    for (int part = 0; part < set->nparts; part++)
        if (sums[lamps[part]] > 0)
            plan->lamp_shares[part] /= sums[lamps[part]];
    free(lamps);
    return RETEX_OK;
}

/* Whether radiance is of one lamp, which may be dim, and is made brighter. */
static int is_of_lamp(const RetexSet *set, int part)
{
    int of_lamp = 0, of_all = 0;
    for (int i = 0; i < set->nterms; i++)
        if (set->terms[i].radiance == part)
            *(set->terms[i].role == RETEX_ROLE_LAMP ? &of_lamp : &of_all) = 1;
    return of_lamp && !of_all;
}

/* What radiance is multiplied by, with parameters as rendered: the brightest colour. Gains of single lamps, which may
 * share it, say how much of it is theirs. */
static double rendered_value(const RetexSet *set, int part)
{
    const int of_lamp = is_of_lamp(set, part);
    double most = 0, value[3];
    for (int i = 0; i < set->nterms; i++) {
        if (set->terms[i].radiance != part || (set->terms[i].role == RETEX_ROLE_LAMP && !of_lamp))
            continue;
        retex_compact_rendered(set, &set->terms[i], value);
        most = fmax(most, fmax(value[0], fmax(value[1], value[2])));
    }
    return most > 0 ? most : 1;
}

/* A value that few samples exceed: the mean of those above 0 plus two standard deviations. */
static double usual_most(const RetexImage *im)
{
    double count = 0, sum = 0, squares = 0;
    for (size_t i = 0; i < (size_t)im->width * (size_t)im->height * (size_t)im->channels; i++) {
        const double v = (double)im->pixels[i];
        if (!(v > 0) || !isfinite(v))
            continue;
        count++, sum += v, squares += v * v;
    }
    const double mean = count > 0 ? sum / count : 0;
    return mean + (count > 0 ? 2 * sqrt(fmax(squares / count - mean * mean, 0)) : 0);
}

/* Choose the value at level 255 for a part of radiance. Radiance that textures multiply may exceed 1 and still give a
 * picture that is not clipped. Steps above white are coarser, so white is a value that few samples exceed. That of
 * a lamp's light may be below the picture's. */
static double white_of(const Planning *plan, int part)
{
    const RetexSet *set = plan->set;
    const RetexImage *im = &set->parts[part].image;
    const double value = rendered_value(set, part);
    int darkened = part > 0;
    const int of_lamp = is_of_lamp(set, part);
    for (int i = 0; i < set->nterms; i++)
        darkened = darkened && (set->terms[i].radiance != part || of_lamp || retex_term_hits(&set->terms[i]) > 0);
    const double own = darkened ? fmin(value * usual_most(im), BRIGHTER_MOST * plan->white) : 0;
    return of_lamp && own > 0 ? own : fmax(own, plan->white);
}

static void find_noise(void *context, int part, int thread)
{
    Planning *plan = context;
    const RetexImage *im = &plan->set->parts[part].image;
    const size_t count = (size_t)im->width * (size_t)im->height * (size_t)im->channels;
    RetexImage levels = {0};
    (void)thread;
    plan->whites[part] = plan->white;
    if (plan->codings[part] != CODING_LIGHT || part == 0)
        return;
    plan->whites[part] = white_of(plan, part);
    plan->noise[part] = -1;
    const RetexPackCurve curve = retex_pack_curve(plan->whites[part] / rendered_value(plan->set, part), 255);
    if (retex_image_alloc(&levels, im->width, im->height, im->channels, NULL))
        return;
    for (size_t i = 0; i < count; i++)
        levels.pixels[i] = (float)retex_pack_curve_level(&curve, 0, (double)im->pixels[i]);
    plan->noise[part] = retex_image_noise(&levels, 1);
    retex_image_free(&levels);
}

static int all_positive(const Planning *plan, int part)
{
    int positive = 1;
    for (int c = 0; c < plan->set->parts[part].image.channels; c++)
        positive = positive && plan->ranges[part][c].positive;
    return positive;
}

/* --- codecs --- */

/* A logarithmic map whose highest code is the largest value. */
static void map_log(RetexPackMap *map, const Range *range, int per_octave)
{
    map->kind = RETEX_PACK_MAP_LOG;
    map->per_octave = per_octave;
    map->first = range->most > 0 ? (double)range->most * exp2(-(double)(RETEX_PACK_CODES - 2) / per_octave) : 1;
    retex_pack_map_fill(map);
}

/* Choose JPEG, if size and values allow. `white` is the value at level 255, `step` the quantizer step in such
 * levels. */
static void plan_light(Planning *plan, int part, double white, double step)
{
    RetexPackPart *p = &plan->packed[part];
    const int fits = (p->channels == 1 || p->channels == 3) && p->width <= RETEX_PACK_JPEG_SIDE_MAX &&
                     p->height <= RETEX_PACK_JPEG_SIDE_MAX;
    if (!fits || !all_positive(plan, part))
        return;
    p->codec = RETEX_PACK_JPEG;
    /* JPEG has no steps below 1: use more levels instead; viewers clip those above 255 */
    p->curve = retex_pack_curve(white, rint(fmin(fmax(255 / step, 255), RETEX_PACK_LEVELS_MOST)));
    p->jpeg_step = fmax(step, 1);
}

/* The set's white: 1, unless the picture is far too dark or too bright. */
static double choose_white(const RetexImage *picture)
{
    const size_t count = (size_t)picture->width * (size_t)picture->height * (size_t)picture->channels;
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += isfinite(picture->pixels[i]) ? fmax((double)picture->pixels[i], 0) : 0;
    const double mean = sum / (double)count;
    return !(mean > 0) || (mean >= 0.02 && mean <= 1) ? 1 : mean > 1 ? mean : 50 * mean;
}

static void plan_weight(Planning *plan, int part)
{
    RetexPackPart *p = &plan->packed[part];
    if (!all_positive(plan, part))
        return;
    for (int c = 0; c < p->channels; c++) {
        const float most = plan->ranges[part][c].most;
        p->maps[c].kind = RETEX_PACK_MAP_LINEAR;
        p->maps[c].first = most > 0 ? (double)most / plan->quantizer->weight_steps : 1;
        retex_pack_map_fill(&p->maps[c]);
    }
}

/* The quantizer step of radiance, by quality. It is finer where there is almost no noise, because that costs few bytes
 * then, and coarser where noise hides quantization errors. */
static double light_step(const Planning *plan, int part)
{
    const double step =
        plan->quantizer->jpeg_step / pow(plan->whites[part] / plan->white, 1 / 2.4); /* sRGB's exponent */
    const double noise = plan->noise[part];
    if (FINE_NOISE * noise < step)
        return fmax(FINE_NOISE * noise, step / FINER_MOST);
    return fmax(step, fmin(COARSE_NOISE * noise, plan->quantizer->coarser_most * step));
}

static double gain_step(const Planning *plan, int radiance)
{
    const double step = light_step(plan, radiance);
    const double noise = plan->noise[radiance] * (plan->set->denoised ? RETEX_DENOISED_NOISE : 1);
    return fmin(GAIN_STEP * step, fmax(GAIN_FINER * step, plan->quantizer->gain_noise * noise));
}

static int has_image(const RetexTerm *term, int part)
{
    for (int k = 0; k < term->nfactors; k++)
        if (term->factors[k].kind == RETEX_FACTOR_IMAGE && term->factors[k].index == part)
            return 1;
    return 0;
}

/* Steps of a lamp's gain, in those of others: errors in what adds little to the picture by the lamp do little. */
static double lamp_step(const Planning *plan, int part)
{
    const double share = plan->lamp_shares[part];
    return LAMP_STEP * (share < LAMP_SHARE ? fmin(LAMP_COARSER, pow(LAMP_SHARE / share, LAMP_POWER)) : 1);
}

/* Compact sets scale gains such that a gain is a share of the radiance if all interreflections have the albedo
 * RETEX_COMPACT_GREY. White is a share of 1; of a lamp, which may be dim, what few of its gains exceed. */
static void plan_gain(Planning *plan, int part)
{
    const RetexSet *set = plan->set;
    int most = 1, radiance = 0, of_lamp = 1;
    for (int i = 0; i < set->nterms; i++) {
        const RetexTerm *term = &set->terms[i];
        if (!has_image(term, part))
            continue;
        of_lamp &= term->role == RETEX_ROLE_LAMP;
        radiance = retex_term_hits(term) >= most || !radiance ? term->radiance : radiance;
        most = retex_term_hits(term) > most ? retex_term_hits(term) : most;
    }
    const double own = usual_most(&set->parts[part].image), share = pow((double)RETEX_COMPACT_GREY, 1 - most);
    plan_light(plan, part, of_lamp && own > 0 ? own : share,
               (of_lamp ? lamp_step(plan, part) : 1) * gain_step(plan, radiance));
}

/* Whether spreads can be quantized: standard deviations that are positive, or axes that are the steps of means. */
static int spread_fits(const Planning *plan, const RetexFootprint *f)
{
    const RetexImage *uv = &plan->set->parts[f->uv].image, *spread = &plan->set->parts[f->spread].image;
    const Range *range = plan->ranges[f->spread];
    const int is_axes = spread->channels == RETEX_AXES;
    int fits = 1;
    for (int c = 0; c < spread->channels; c++)
        fits = fits && (c < 2 && !is_axes ? range[c].positive : !isinf(range[c].most_size));
    for (int i = 0; i < uv->width * uv->height && is_axes && fits; i++) {
        double steps[RETEX_AXES];
        if (!(uv->pixels[3 * i + 2] > 0))
            continue;
        retex_steps_at(steps, uv, i % uv->width, i / uv->width, plan->set->targets[f->target].periodic);
        fits = retex_steps_fit(steps, spread->pixels + (size_t)RETEX_AXES * (size_t)i, RETEX_STEPS_TOLERANCE_STORED);
    }
    return fits;
}

/* Of standard deviations, or of the sizes of axes: the same map along u and v, because sigma_first is shared. */
static void plan_spread(Planning *plan, int part, const RetexPackFootprintSteps *quantizer)
{
    RetexPackPart *s = &plan->packed[part];
    const Range *of = plan->ranges[part];
    const int is_axes = s->channels == RETEX_AXES;
    const int count = is_axes ? RETEX_AXES : 2;
    Range both = {.most = 0};
    for (int c = 0; c < count; c++)
        both.most = fmaxf(both.most, (is_axes ? (float)M_SQRT2 : 1) * of[c].most_size);
    for (int c = 0; c < count; c++) {
        map_log(&s->maps[c], &both, quantizer->per_octave);
        s->maps[c].kind = is_axes ? RETEX_PACK_MAP_STEP : RETEX_PACK_MAP_LOG;
    }
    if (s->channels == 3) {
        s->maps[2].kind = RETEX_PACK_MAP_ANGLE;
        s->maps[2].per_octave = quantizer->angle_steps;
        retex_pack_map_fill(&s->maps[2]);
    }
}

/* Quantize means to lattices, standard deviations and coverage logarithmically. Pixels of coverage 0 are not stored. */
static void plan_footprint(Planning *plan, const RetexFootprint *f, const RetexPackFootprintSteps *quantizer)
{
    RetexPackPart *p = &plan->packed[f->uv], *s = &plan->packed[f->spread];
    const Range *of_uv = plan->ranges[f->uv];
    const float farthest = 1 << (30 - RETEX_PACK_LATTICE_BITS);
    if (plan->codings[f->uv] != CODING_MEAN || plan->codings[f->spread] != CODING_SPREAD ||
        of_uv[0].most_size >= farthest || of_uv[1].most_size >= farthest || !of_uv[2].positive || !spread_fits(plan, f))
        return;
    p->present = s->present = f->uv;
    p->sigma = f->spread;
    map_log(&p->maps[2], &of_uv[2], 2);
    p->maps[0].kind = p->maps[1].kind = RETEX_PACK_MAP_LATTICE;
    plan_spread(plan, f->spread, quantizer);
    const double share = s->channels == RETEX_AXES ? STEP_SHARE * quantizer->sigma_share : quantizer->sigma_share;
    p->sigma_first = (int)floor((log2(s->maps[0].first / share) + RETEX_PACK_LATTICE_BITS) * quantizer->per_octave);
}

static int is_zero(const Planning *plan, int part)
{
    int zero = 1;
    for (int c = 0; c < plan->packed[part].channels; c++)
        zero = zero && plan->ranges[part][c].all_zero;
    return zero;
}

/* Chooses codec and quantizer of a part by its use. Without losses all are planes, as are those of footprints, which
 * are planned together. */
static void plan_part(Planning *plan, int part)
{
    const RetexPackQuantizer *quantizer = plan->quantizer;
    plan->packed[part].codec = is_zero(plan, part) ? RETEX_PACK_ZERO : RETEX_PACK_PLANES;
    if (plan->packed[part].codec == RETEX_PACK_ZERO || !quantizer)
        return;
    if (part == 0) { /* white is 1, because viewers decode the picture as sRGB */
        plan_light(plan, part, 1, quantizer->picture_step);
        return;
    }
    switch (plan->codings[part]) {
    case CODING_LIGHT:
        plan_light(plan, part, plan->whites[part] / rendered_value(plan->set, part), light_step(plan, part));
        break;
    case CODING_ALBEDO:
        plan_light(plan, part, plan->white, quantizer->jpeg_step);
        break;
    case CODING_ORIGINAL:
        plan_light(plan, part, 1, quantizer->original_step);
        break;
    case CODING_GAIN:
        plan_gain(plan, part);
        break;
    case CODING_WEIGHT:
        plan_weight(plan, part);
        break;
    case CODING_NONE:
    case CODING_EXACT:
    case CODING_MEAN:
    case CODING_SPREAD:
        break;
    }
}

static int is_in_planes(const Planning *plan, int part)
{
    return part >= 0 && plan->packed[part].codec == RETEX_PACK_PLANES;
}

static void plan_footprints(Planning *plan)
{
    for (int f = 0; f < plan->set->nfootprints; f++) {
        const RetexFootprint *footprint = &plan->set->footprints[f];
        const int is_broad =
            footprint->kind == RETEX_FOOTPRINT_BROAD || footprint->kind == RETEX_FOOTPRINT_INTERREFLECTION;
        if (is_in_planes(plan, footprint->uv) && is_in_planes(plan, footprint->spread))
            plan_footprint(plan, footprint, is_broad ? &plan->quantizer->broad : &plan->quantizer->sharp);
    }
}

static void plan_parts(Planning *plan)
{
    for (int i = 0; i < plan->set->nparts; i++)
        plan_part(plan, i);
    if (plan->quantizer)
        plan_footprints(plan);
}

/* What keeps its bits and has few different values, such as a texture of 8 bits, has a palette. */
static void find_palettes(void *context, int part, int thread)
{
    const Planning *plan = context;
    const RetexImage *im = &plan->set->parts[part].image;
    RetexPackPart *p = &plan->packed[part];
    (void)thread;
    for (int c = 0; c < p->channels && p->codec == RETEX_PACK_PLANES; c++)
        if (p->maps[c].kind == RETEX_PACK_MAP_BITS)
            retex_pack_map_find_palette(&p->maps[c], im->pixels + c, (size_t)im->channels,
                                        (size_t)im->width * (size_t)im->height, p->type);
}

int retex_pack_plan(RetexPackPart *packed, const RetexSet *set, const RetexPackQuantizer *quantizer, int nthreads,
                    RetexError *err)
{
    const size_t count = (size_t)set->nparts;
    Planning plan = {choose_white(&set->parts[0].image),
                     calloc(count + 1, sizeof *plan.whites),
                     packed,
                     set,
                     quantizer,
                     calloc(count + 1, sizeof *plan.codings),
                     calloc(count + 1, sizeof *plan.means),
                     calloc(count + 1, sizeof *plan.ranges),
                     calloc(count + 1, sizeof *plan.noise),
                     calloc(count + 1, sizeof *plan.lamp_shares)};
    int code = plan.codings && plan.means && plan.ranges && plan.noise && plan.whites && plan.lamp_shares
                   ? 0
                   : retex_fail(err, RETEX_ENOMEM, "no memory to pack a set");
    for (int i = 0; !code && i < set->nparts; i++) {
        retex_pack_part_begin(&packed[i], &set->parts[i]);
        if (packed[i].channels > RETEX_PACK_CHANNELS_MAX)
            code =
                retex_fail(err, RETEX_EUNSUPPORTED, "part '%s' has too many channels to be packed", set->parts[i].name);
    }
    if (!code) {
        give_codings(&plan);
        retex_parallel(nthreads, set->nparts, find_ranges, &plan);
        if (plan.quantizer)
            retex_parallel(nthreads, set->nparts, find_noise, &plan);
        for (int i = 0; i < set->nparts && !code; i++)
            if (plan.noise[i] < 0)
                code = retex_fail(err, RETEX_ENOMEM, "no memory to pack a set");
        code = code ? code : find_lamp_shares(&plan, err);
    }
    if (!code) {
        plan_parts(&plan);
        retex_parallel(nthreads, set->nparts, find_palettes, &plan);
    }
    free(plan.codings);
    free(plan.means);
    free(plan.ranges);
    free(plan.noise);
    free(plan.whites);
    free(plan.lamp_shares);
    return code;
}
