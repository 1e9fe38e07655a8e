/* See precision.h. Each kind of number has a fraction of the noise; footprints are rounded by the noise of the light
 * that they multiply, as an error of a footprint changes the picture by at most so much. */
#include "precision/precision.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/denoise_data.h>
#include <retex/host/rounding.h>

#include "base/jobs.h"
#include "set/parts.h"
#include "set/set.h"
#include "set/signals.h"
#include "set/strip.h"

/* The kinds of numbers. A number's step is a power of two, at most scale * clamp(fraction * relative noise, finest,
 * coarsest); relative noise is that of the light which the number multiplies. */
typedef enum Kind {
    LIGHT,        /* scale: the pixel's value with white targets */
    CHOICE_LIGHT, /* of sets with finishes to choose from, which have more of it; scale: the same */
    CORRECTION,   /* scale: the same */
    PICTURE,      /* scale: the value */
    MEAN,         /* of UV; scale: the standard deviation */
    BROAD_MEAN,   /* of what is not seen directly, in mirrors or through glass */
    SPREAD,       /* scale: the value */
    BROAD_SPREAD,
    CORRELATION,       /* scale: 1 - |correlation| */
    BROAD_CORRELATION, /* scale: 1 */
    COVERAGE,          /* scale: the value */
    ALBEDO,            /* scale: 1 */
    WEIGHT,            /* in mixtures; scale: 1 */
    NOISE,             /* scale: the value */
    CHOICE_NOISE,      /* of light of each choice of finishes; scale: the value */
    CHOICE_PICTURE,    /* of each choice; scale: the value */
    GUIDE,             /* scale: 1 */
    POSITION,          /* scale: the value */
    KINDS
} Kind;

/* Fractions are such that rounding adds little to the noise that a picture has anyway, finest steps such that nothing
 * is seen in pictures without noise. */
static const struct {
    double fraction, finest, coarsest;
} RULES[KINDS] = {
    [LIGHT] = {0.1, 1.0 / 8192, INFINITY},
    [CHOICE_LIGHT] = {0.2, 1.0 / 8192, INFINITY},
    [CORRECTION] = {0.04, 1.0 / 8192, 1.0 / 512},
    [PICTURE] = {0, 1.0 / 1024, 1.0 / 1024},
    [MEAN] = {0.5, 1.0 / 1024, 1.0 / 2},
    [BROAD_MEAN] = {2, 1.0 / 1024, 1},
    [SPREAD] = {0.25, 1.0 / 1024, 1.0 / 16},
    [BROAD_SPREAD] = {1.5, 1.0 / 1024, 1},
    [CORRELATION] = {0.25, 1.0 / 512, 1.0 / 8},
    [BROAD_CORRELATION] = {1, 1.0 / 512, 1},
    [COVERAGE] = {0.5, 1.0 / 128, 1.0 / 8},
    [ALBEDO] = {0.02, 1.0 / 4096, 1.0 / 64},
    [WEIGHT] = {0.25, 1.0 / 512, 1.0 / 32},
    [NOISE] = {0, 1.0 / 2, 1.0 / 2},
    [CHOICE_NOISE] = {0, 1, 1},
    [CHOICE_PICTURE] = {0, 1.0 / 256, 1.0 / 256},
    [GUIDE] = {0, 1.0 / 256, 1.0 / 256},
    [POSITION] = {0, 1.0 / 2048, 1.0 / 2048},
};

/* The variance of light by one sample, as a share of the light times the white pixel. */
static const double NOISE_OF_A_SAMPLE = 0.5;
/* The step of a signal's sum, as a share of what it is a part of. */
static const double SUM_STEP = 1.0 / 128;
/* Albedo that further hits count with where errors go to other terms. Errors show most with bright textures. */
static const double CARRIED = 0.8;
/* With finishes to choose from a picture is never of all light, which is the mean over all choices: its terms with
 * further hits only guide denoising and compact sets, and have steps that are larger by this. */
static const double MEAN_FURTHER = 8;
/* A broad footprint of n samples is credited with a deviation of this share of its target's range, divided by n: few
 * samples do not tell it. */
static const double CREDITED = 0.5;

enum { LINES = 16 }; /* rows of a job */

struct RetexPrecision {
    RetexSignals signals;
    double remaining;
    int has_noise;
    int has_finishes; /* 1: finishes to choose from, not denoised: light of role lamp is that of each choice */
    int signal_of[RETEX_SET_FOOTPRINTS_MAX]; /* whose light a footprint multiplies; -1: all light */
    int shared[RETEX_SET_FOOTPRINTS_MAX];    /* the first footprint with the same mean UV, or its own number */
    char is_own[RETEX_SET_FOOTPRINTS_MAX];   /* 1: that is itself, and has all its parts, which are not reduced */
    char is_whole[RETEX_MIXTURES_MAX];       /* 1: the shares of the mixture are not reduced */
};

/* What is known of one pixel. */
typedef struct Pixel {
    const RetexSet *rows;
    size_t at;     /* its number in them */
    double *noise; /* standard deviation by signal, then of all light together */
    double *light; /* by footprint: light that it multiplies */
    double *mixed; /* by mixture */
    double *white; /* the largest channel of all light, then of each lamp's, if targets are white */
} Pixel;

static double step_of(Kind kind, double scale, double relative)
{
    return scale * fmax(fmin(RULES[kind].fraction * relative, RULES[kind].coarsest), RULES[kind].finest);
}

static float rounded(Kind kind, double value, double scale, double relative)
{
    return (float)retex_round_to(value, step_of(kind, scale, relative)) + 0.0f; /* no -0 */
}

static float *part_of(const Pixel *p, int part)
{
    return retex_pixel_at(p->rows, part, p->at);
}

static double mean_size(const float color[3])
{
    return ((double)fabsf(color[0]) + (double)fabsf(color[1]) + (double)fabsf(color[2])) / 3;
}

static double largest_size(const float color[3])
{
    return (double)fmaxf(fabsf(color[0]), fmaxf(fabsf(color[1]), fabsf(color[2])));
}

/* ---- the plan ---- */

static int is_whole(const RetexSet *set, int part, int channels)
{
    return part >= 0 && set->parts[part].image.channels >= channels && set->parts[part].image.width == set->width &&
           set->parts[part].image.height == set->height;
}

static void plan_footprint(RetexPrecision *p, const RetexSet *set, int number)
{
    const RetexFootprint *f = &set->footprints[number];
    const int whole = is_whole(set, f->uv, 3) && is_whole(set, f->spread, 2) && is_whole(set, f->albedo, 3);
    int first = 0;
    while (set->footprints[first].uv != f->uv)
        first++;
    p->shared[number] = whole ? first : number;
    p->is_own[number] = (char)(whole && first == number);
    p->signal_of[number] = -1;
    for (int k = 0; k < p->signals.count && f->kind != RETEX_FOOTPRINT_INTERREFLECTION; k++)
        if (p->signals.of[k].target == f->target && p->signals.of[k].kind == f->kind && p->signals.of[k].lamp < 0)
            p->signal_of[number] = k;
}

/* Those with the smallest weights first, because errors are carried on to the next ones; where all weigh the same, as
 * of white targets, those with the most hits. */
static int compare_members(const void *a, const void *b)
{
    const RetexSignalMember *x = a, *y = b;
    return x->weight != y->weight ? (x->weight < y->weight ? -1 : 1)
           : x->hits != y->hits   ? y->hits - x->hits
                                  : x->term - y->term;
}

int retex_precision_open(RetexPrecision **result, const RetexSet *set, double remaining, RetexError *err)
{
    RetexPrecision *p = *result = calloc(1, sizeof *p);
    if (!p)
        return retex_fail(err, RETEX_ENOMEM, "no memory to round a set");
    const int code = retex_signals_sort(&p->signals, set, err);
    if (code) {
        retex_precision_close(result);
        return code;
    }
    p->remaining = remaining, p->has_noise = 1;
    p->has_finishes = remaining >= 1 && retex_set_has_finishes(set);
    for (int k = 0; k < p->signals.count; k++) {
        const RetexSignal *signal = &p->signals.of[k];
        qsort(signal->members, (size_t)signal->nmembers, sizeof *signal->members, compare_members);
        p->has_noise = p->has_noise && is_whole(set, signal->noise, 3);
    }
    for (int i = 0; i < set->nfootprints; i++)
        plan_footprint(p, set, i);
    for (int m = 0; m < set->nmixtures; m++) {
        p->is_whole[m] = 1;
        for (int k = 0; k < set->mixtures[m].nshares; k++)
            p->is_whole[m] = p->is_whole[m] && is_whole(set, set->mixtures[m].shares[k].weight, 1);
    }
    return RETEX_OK;
}

void retex_precision_close(RetexPrecision **precision)
{
    if (*precision)
        retex_signals_close(&(*precision)->signals);
    free(*precision);
    *precision = NULL;
}

/* ---- noise ---- */

static void find_whites(const RetexPrecision *plan, Pixel *p)
{
    double sum[3] = {0, 0, 0};
    for (int k = 0; k < plan->signals.count; k++) { /* those of one lamp follow each other */
        const RetexSignal *signal = &plan->signals.of[k];
        if (!k || signal->lamp != signal[-1].lamp)
            memset(sum, 0, sizeof sum);
        for (int m = 0; m < signal->nmembers; m++)
            for (int c = 0; c < 3 && !signal->members[m].corrects; c++)
                sum[c] += (double)part_of(p, signal->members[m].part)[c];
        p->white[signal->lamp + 1] = (double)(float)fmax(sum[0], fmax(sum[1], sum[2]));
    }
}

/* What the pixel alone tells of its noise is one difference, which is near 0 by chance. Its geometric mean with what
 * light of so many samples has is neither that uncertain nor blind. */
static void find_noise(const RetexPrecision *plan, Pixel *p)
{
    double all = 0;
    for (int k = 0; k < plan->signals.count; k++) {
        const RetexSignal *signal = &plan->signals.of[k];
        const double own = plan->has_noise ? mean_size(part_of(p, signal->noise)) : 0;
        double light = 0;
        for (int m = 0; m < signal->nmembers; m++)
            light += (double)signal->members[m].weight * mean_size(part_of(p, signal->members[m].part));
        const double usual = sqrt(NOISE_OF_A_SAMPLE * light * p->white[signal->lamp + 1] / fmax(p->rows->spp, 1));
        p->noise[k] = plan->remaining * sqrt(own * usual);
        all += signal->lamp < 0 ? p->noise[k] * p->noise[k] : 0;
    }
    p->noise[plan->signals.count] = sqrt(all);
}

/* How much light every footprint and every mixture multiplies, further hits weighing as in the noise of it. Light of
 * lamps is the same light again. */
static void gather_light(const RetexPrecision *plan, Pixel *p)
{
    const RetexSet *rows = p->rows;
    memset(p->light, 0, sizeof *p->light * (size_t)rows->nfootprints);
    memset(p->mixed, 0, sizeof *p->mixed * (size_t)rows->nmixtures);
    for (int k = 0; k < plan->signals.count && plan->signals.of[k].lamp < 0; k++)
        for (int m = 0; m < plan->signals.of[k].nmembers; m++) {
            const RetexSignalMember *member = &plan->signals.of[k].members[m];
            const RetexTerm *term = &rows->terms[member->term];
            const double light = mean_size(part_of(p, member->part)) * (double)member->weight;
            for (int f = 0; f < term->nfactors && light > 0; f++)
                if (retex_factor_is_hit(term->factors[f]))
                    (term->factors[f].kind == RETEX_FACTOR_MIXTURE ? p->mixed : p->light)[term->factors[f].index] +=
                        light;
        }
    for (int m = 0; m < rows->nmixtures; m++) {
        const RetexMixture *mixture = &rows->mixtures[m];
        double sum = 0;
        for (int k = 0; k < mixture->nshares && p->mixed[m] > 0 && plan->is_whole[m]; k++)
            sum += (double)*part_of(p, mixture->shares[k].weight);
        for (int k = 0; k < mixture->nshares && sum > 0; k++)
            p->light[mixture->shares[k].footprint] +=
                p->mixed[m] * (double)*part_of(p, mixture->shares[k].weight) / sum;
    }
    for (int i = 0; i < rows->nfootprints; i++)
        if (plan->shared[i] != i)
            p->light[plan->shared[i]] += p->light[i];
}

/* The noise of a signal, or of all (-1), relative to light of it. */
static double relative_noise(const RetexPrecision *plan, const Pixel *p, int signal, double light)
{
    const double noise = p->noise[signal < 0 ? plan->signals.count : signal];
    return noise > 0 ? noise / light : 0; /* of what has no light: infinite */
}

/* ---- footprints ---- */

#define EVEN_DEVIATION 0.28867513 /* of an axis of 1: the root of 1/12 */
#define EXACT 64                  /* parts of a deviation that the mean of a parallelogram is known to */

static int is_broad(const RetexFootprint *f)
{
    return f->kind == RETEX_FOOTPRINT_BROAD || f->kind == RETEX_FOOTPRINT_INTERREFLECTION;
}

/* Axes by their size along u and along v. */
static void round_spread(float *spread, int channels, int broad, double relative)
{
    if (channels == RETEX_AXES) {
        for (int i = 0; i < RETEX_AXES; i++)
            spread[i] = rounded(SPREAD, (double)spread[i], (double)hypotf(spread[i % 2], spread[2 + i % 2]), relative);
        return;
    }
    for (int k = 0; k < 2; k++)
        spread[k] = rounded(broad ? BROAD_SPREAD : SPREAD, (double)spread[k], (double)spread[k], relative);
    if (channels < 3)
        return;
    const double size = fmin(fabs((double)spread[2]), 1);
    spread[2] = broad ? rounded(BROAD_CORRELATION, (double)spread[2], 1, relative)
                      : copysignf(1 - rounded(CORRELATION, 1 - size, 1 - size, relative), spread[2]);
}

/* A mean of UV as a multiple of `unit`; within the target where it was. */
static float rounded_mean(const RetexTarget *target, int axis, double mean, double unit)
{
    const double low = target->uv_min[axis], high = target->uv_max[axis], nearest = retex_round_by(mean, unit);
    const int is_within = !target->periodic[axis] && mean >= low && mean <= high;
    return (float)(is_within ? fmin(fmax(nearest, low), high) : nearest) + 0.0f;
}

/* Mean, spread and coverage. Steps may be large against the spread of broad footprints of few paths, which gains the
 * variance of rounding: a texture with lines where the multiples of steps are is then averaged there, and not hit too
 * often. */
static void round_place(const RetexPrecision *plan, const Pixel *p, const RetexFootprint *f, double relative)
{
    static const double FINEST = 1.0 / (1 << 18); /* a 64th of a texel of a 4K texture */
    const RetexTarget *target = &p->rows->targets[f->target];
    const int channels = p->rows->parts[f->spread].image.channels, is_axes = channels == RETEX_AXES;
    float *uv = part_of(p, f->uv), *spread = part_of(p, f->spread);
    const double samples = fmax((double)uv[2] * p->rows->spp, 1);
    for (int k = 0; k < 2; k++) {
        const double own = is_axes ? EVEN_DEVIATION * (double)hypotf(spread[k], spread[2 + k]) : (double)spread[k];
        const double credited = CREDITED * (target->uv_max[k] - target->uv_min[k]) / samples;
        const double wanted = is_broad(f) ? step_of(BROAD_MEAN, plan->has_noise ? fmax(own, credited) : own, relative)
                                          : step_of(MEAN, own, relative);
        /* 16 significant bits, and more only where these are coarser than half a deviation, which PXR24 cannot store;
         * parallelograms are exact */
        const double kept = retex_round_unit(fabs((double)uv[k])) / 32768;
        const double enough = samples < 8 ? kept : fmin(kept, own / (is_axes ? EXACT : 2));
        const double unit = retex_round_unit(fmax(fmax(wanted, FINEST), plan->has_noise ? enough : 0));
        uv[k] = rounded_mean(target, k, (double)uv[k], unit);
        if (is_broad(f))
            spread[k] = (float)sqrt((double)(spread[k] * spread[k]) + unit * unit / 12);
    }
    round_spread(spread, channels, is_broad(f), relative);
    uv[2] = rounded(COVERAGE, (double)uv[2], (double)uv[2], relative);
}

static void round_footprints(const RetexPrecision *plan, const Pixel *p)
{
    for (int i = 0; i < p->rows->nfootprints; i++) {
        const RetexFootprint *f = &p->rows->footprints[i];
        if (!plan->is_own[i])
            continue;
        const double relative = relative_noise(plan, p, plan->signal_of[i], p->light[i]);
        if (part_of(p, f->uv)[2] > 0)
            round_place(plan, p, f, relative);
        float *albedo = part_of(p, f->albedo);
        for (int c = 0; c < 3 && p->light[i] > 0; c++)
            albedo[c] = rounded(ALBEDO, (double)albedo[c], 1, relative);
    }
}

static void round_weights(const RetexPrecision *plan, const Pixel *p)
{
    for (int m = 0; m < p->rows->nmixtures; m++) {
        const RetexMixture *mixture = &p->rows->mixtures[m];
        const double relative = relative_noise(plan, p, -1, p->mixed[m]);
        for (int k = 0; k < mixture->nshares && plan->is_whole[m]; k++) {
            float *weight = part_of(p, mixture->shares[k].weight);
            if (p->rows->parts[mixture->shares[k].weight].image.channels == 1 && *weight > 0)
                *weight = fmaxf(rounded(WEIGHT, (double)*weight, 1, relative), RETEX_LEAST_SHARE);
        }
    }
}

/* ---- light ---- */

/* carried: errors of the numbers before, as light of one factor. */
static void round_member(const Pixel *p, const RetexSignalMember *member, double unit, double carried[3])
{
    float *light = part_of(p, member->part);
    double weight = 1;
    for (int n = member->hits; n > 1; n--)
        weight *= CARRIED;
    for (int c = 0; c < 3; c++) {
        if (light[c] == 0)
            continue;
        const double wanted = (double)light[c] + carried[c] / weight;
        const double kept = (wanted < 0) == (light[c] < 0) ? retex_round_by(wanted, unit) : 0;
        carried[c] += ((double)light[c] - kept) * weight;
        light[c] = (float)kept + 0.0f;
    }
}

/* Light that no picture shows: its errors are not carried on to that which pictures do show. */
static int is_unseen(const RetexPrecision *plan, const RetexSignal *signal, const RetexSignalMember *member)
{
    return plan->has_finishes && signal->lamp < 0 && member->hits > 1;
}

/* Numbers are rounded by their noise, and their errors added to the brightest one, which is rounded by its light: so
 * the sum of a signal is as precise as a picture needs, whatever its noise. */
static void round_signal(const RetexPrecision *plan, const Pixel *p, int number)
{
    const RetexSignal *signal = &plan->signals.of[number];
    const RetexSignalMember *brightest = NULL;
    const double white = p->white[signal->lamp + 1];
    double carried[3] = {0, 0, 0}, ignored[3] = {0, 0, 0}, most = 0;
    if (!(white > 0) || (plan->has_noise ? !(p->noise[number] > 0) : signal->target < 0))
        return;
    for (int m = 0; m < signal->nmembers; m++) {
        const double light = (double)signal->members[m].weight * mean_size(part_of(p, signal->members[m].part));
        if (light > most && !is_unseen(plan, signal, &signal->members[m]))
            most = light, brightest = &signal->members[m];
    }
    const double step = step_of(plan->has_finishes ? CHOICE_LIGHT : LIGHT, white, p->noise[number] / white);
    const double finest = step_of(LIGHT, white, 0);
    for (int m = 0; m < signal->nmembers; m++)
        if (is_unseen(plan, signal, &signal->members[m]))
            round_member(p, &signal->members[m], retex_round_unit(MEAN_FURTHER * step), ignored);
    if (!brightest)
        return;
    const double whole = signal->target < 0 ? largest_size(part_of(p, brightest->part)) : white;
    for (int m = 0; m < signal->nmembers; m++)
        if (&signal->members[m] != brightest && !signal->members[m].corrects &&
            !is_unseen(plan, signal, &signal->members[m]))
            round_member(p, &signal->members[m], retex_round_unit(step), carried);
    round_member(p, brightest, retex_round_unit(fmin(step, fmax(SUM_STEP * whole, finest))), carried);
}

static void round_corrections(const RetexPrecision *plan, const Pixel *p)
{
    const double white = p->white[0];
    for (int t = 0; t < p->rows->nterms && white > 0; t++) {
        const RetexTerm *term = &p->rows->terms[t];
        for (int c = 0; c < 3 && term->role == RETEX_ROLE_CORRECTION; c++) {
            float *value = part_of(p, term->radiance) + c;
            *value = rounded(CORRECTION, (double)*value, white, relative_noise(plan, p, -1, white));
        }
    }
}

/* ---- all numbers ---- */

static void round_pixel(const RetexPrecision *plan, Pixel *p)
{
    find_whites(plan, p);
    find_noise(plan, p);
    gather_light(plan, p);
    round_footprints(plan, p);
    round_weights(plan, p);
    for (int k = 0; k < plan->signals.count; k++)
        round_signal(plan, p, k);
    round_corrections(plan, p);
}

/* The kind of a part's numbers, if they are rounded by themselves; -1: another part. */
static int lone_kind(const RetexPrecision *plan, const RetexSet *set, int part)
{
    const char *name = set->parts[part].name;
    if (part == 0)
        return PICTURE;
    for (int k = 0; k < plan->signals.count && plan->has_finishes; k++)
        if (plan->signals.of[k].noise == part && plan->signals.of[k].lamp >= 0)
            return CHOICE_NOISE;
    for (int t = 0; t < set->nterms && plan->has_finishes; t++)
        if (set->terms[t].radiance == part && set->terms[t].role == RETEX_ROLE_LAMP_PICTURE)
            return CHOICE_PICTURE;
    if (retex_name_is_noise(name))
        return NOISE;
    if (!retex_name_is_feature(name))
        return -1;
    return set->parts[part].type == RETEX_FLOAT ? POSITION : GUIDE;
}

typedef struct Rounding {
    const RetexPrecision *plan;
    const RetexSet *rows;
    RetexRoi roi;
} Rounding;

static void round_lone_numbers(const Rounding *r, int y0, int y1)
{
    for (int k = 0; k < r->rows->nparts; k++) {
        const int kind = lone_kind(r->plan, r->rows, k);
        const RetexImage *im = &r->rows->parts[k].image;
        for (int y = y0; y < y1 && kind >= 0 && im->pixels && is_whole(r->rows, k, 1); y++) {
            float *v = im->pixels + retex_image_index(im, r->roi.x0, y);
            const size_t count = (size_t)(r->roi.x1 - r->roi.x0) * (size_t)im->channels;
            for (size_t i = 0; i < count; i++)
                v[i] = rounded((Kind)kind, (double)v[i], kind == GUIDE ? 1 : fabs((double)v[i]), 0);
        }
    }
}

static int round_rows(void *context, int job, int thread, RetexError *err)
{
    const Rounding *r = context;
    const RetexSet *rows = r->rows;
    const int y0 = r->roi.y0 + job * LINES, y1 = y0 + LINES < r->roi.y1 ? y0 + LINES : r->roi.y1;
    const size_t signals = (size_t)r->plan->signals.count + 1, mixtures = (size_t)rows->nmixtures;
    const size_t footprints = (size_t)rows->nfootprints, lamps = (size_t)rows->nparameters + 1;
    double *memory = calloc(signals + footprints + mixtures + lamps, sizeof *memory);
    (void)thread;
    if (!memory)
        return retex_fail(err, RETEX_ENOMEM, "no memory to round a set");
    Pixel p = {.rows = rows, .noise = memory};
    p.light = p.noise + signals, p.mixed = p.light + footprints, p.white = p.mixed + mixtures;
    for (int y = y0; y < y1; y++)
        for (int x = r->roi.x0; x < r->roi.x1; x++) {
            p.at = (size_t)y * (size_t)rows->width + (size_t)x;
            round_pixel(r->plan, &p);
        }
    round_lone_numbers(r, y0, y1);
    free(memory);
    return RETEX_OK;
}

int retex_precision_round(const RetexPrecision *plan, RetexSet *rows, const RetexRoi *roi, int nthreads,
                          RetexError *err)
{
    Rounding rounding = {plan, rows, {0, 0, rows->width, rows->height, 0, 3}};
    if (roi)
        rounding.roi = *roi;
    const int lines = rounding.roi.y1 - rounding.roi.y0;
    return retex_jobs_run(nthreads, (lines + LINES - 1) / LINES, round_rows, &rounding, err);
}
