/* See precision.h. Footprints are rounded by the light that they multiply: an error of a footprint changes the picture
 * by at most so much. Errors of albedos are carried on from one number of a pixel to the next larger one, so that their
 * sum is rounded only once. precision_light.h has light. */
#include "precision/precision.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/denoise_data.h>
#include <retex/host/rounding.h>
#include <retex/host/uv_stats.h>

#include "base/jobs.h"
#include "set/strip.h"
#include "precision/edited.h"
#include "precision/precision_light.h"
#include "set/parts.h"
#include "set/samples.h"

enum { NEIGHBOURS = 2 }; /* pixels to each side over which noise is averaged */

/* A footprint, where it has all its parts and they are not reduced. */
typedef struct Footprint {
    int uv, spread, albedo; /* parts; uv -1: it is left as it is */
    int channels;           /* of its spread */
    int shared;             /* the first footprint with the same uv, or its own number */
    int signal;             /* of the light that it multiplies, or -1: all of them */
    int first;              /* the first footprint of the same target and kind */
    int broad;
    const RetexTarget *target;
} Footprint;

struct RetexPrecision {
    RetexSignals signals;
    RetexEdited *edited;
    double remaining;
    int has_noise, has_finishes;
    int nfootprints, nmixtures;
    Footprint *footprints;
    char whole[RETEX_MIXTURES_MAX]; /* 1: the shares of the mixture are not reduced */
};

/* Memory of one job. */
typedef struct Scratch {
    float *noise;       /* variances by signal, then of all light together: of a band's pixels */
    float *row;         /* sums over columns */
    double *deviations; /* of the pixel's noise, in the same order */
    double *light;      /* by footprint: light that it multiplies in the pixel */
    double *mixed;      /* by mixture */
    int *order;         /* of footprints */
    int *lit;           /* terms of light that are not black in the pixel */
    double *whites;     /* of a row, by parameter, then column: the largest channel of all light of the lamp */
    double *colors;     /* of a row */
} Scratch;

#define EVEN_DEVIATION 0.28867513 /* of an axis of 1: the root of 1/12 */
#define EXACT 64                  /* parts of a deviation that the mean of a parallelogram is known to */

static size_t band_pixels(const RetexSet *rows)
{
    return (size_t)rows->width * RETEX_PRECISION_LINES;
}

static float rounded(RetexPrecisionKind kind, double value, double scale, double relative)
{
    return (float)retex_round_to(value, retex_precision_step(kind, scale, relative)) + 0.0f; /* no -0 */
}

/* ---- the plan ---- */

static int signal_of(const RetexPrecision *p, const RetexFootprint *f)
{
    for (int s = 0; s < p->signals.count; s++)
        if (p->signals.of[s].target == f->target && p->signals.of[s].kind == f->kind && p->signals.of[s].lamp < 0)
            return s;
    return -1;
}

static int is_whole(const RetexSet *set, int part, int channels)
{
    return part >= 0 && set->parts[part].image.channels >= channels && set->parts[part].image.width == set->width &&
           set->parts[part].image.height == set->height;
}

static void plan_footprints(RetexPrecision *p, const RetexSet *set)
{
    for (int i = 0; i < set->nfootprints; i++) {
        const RetexFootprint *f = &set->footprints[i];
        int first = 0;
        while (set->footprints[first].target != f->target || set->footprints[first].kind != f->kind)
            first++;
        const int whole = is_whole(set, f->uv, 3) && is_whole(set, f->spread, 2) && is_whole(set, f->albedo, 3);
        int shared = 0;
        while (set->footprints[shared].uv != f->uv)
            shared++;
        p->footprints[i] =
            (Footprint){.uv = whole && shared == i ? f->uv : -1,
                        .spread = f->spread,
                        .albedo = f->albedo,
                        .channels = whole ? set->parts[f->spread].image.channels : 0,
                        .shared = whole ? shared : i,
                        .signal = f->kind == RETEX_FOOTPRINT_INTERREFLECTION ? -1 : signal_of(p, f),
                        .first = first,
                        .broad = f->kind == RETEX_FOOTPRINT_BROAD || f->kind == RETEX_FOOTPRINT_INTERREFLECTION,
                        .target = &set->targets[f->target]};
    }
}

static void plan_mixtures(RetexPrecision *p, const RetexSet *set)
{
    for (int m = 0; m < set->nmixtures; m++) {
        p->whole[m] = 1;
        for (int k = 0; k < set->mixtures[m].nshares; k++)
            p->whole[m] = p->whole[m] && is_whole(set, set->mixtures[m].shares[k].weight, 1);
    }
}

/* The members of a signal with the smallest weights first, because errors are carried on to the next ones; where all
 * weigh the same, as of white targets, those with the most hits. */
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
    if (p)
        p->footprints = calloc((size_t)set->nfootprints + 1, sizeof *p->footprints);
    if (!p || !p->footprints) {
        retex_precision_close(result);
        return retex_fail(err, RETEX_ENOMEM, "no memory to round a set");
    }
    p->remaining = remaining, p->nfootprints = set->nfootprints, p->nmixtures = set->nmixtures;
    int code = retex_signals_sort(&p->signals, set, err);
    if (!code)
        code = retex_edited_open(&p->edited, set, err);
    if (code) {
        retex_precision_close(result);
        return code;
    }
    p->has_noise = 1;
    /* compact sets divide by all light, which is worth its bytes once it is denoised */
    p->has_finishes = remaining >= 1 && retex_set_has_finishes(set);
    for (int s = 0; s < p->signals.count; s++) {
        RetexSignal *signal = &p->signals.of[s];
        qsort(signal->members, (size_t)signal->nmembers, sizeof *signal->members, compare_members);
        p->has_noise = p->has_noise && signal->noise >= 0 && is_whole(set, signal->noise, 3);
    }
    plan_footprints(p, set);
    plan_mixtures(p, set);
    return RETEX_OK;
}

void retex_precision_close(RetexPrecision **result)
{
    RetexPrecision *p = *result;
    if (!p)
        return;
    retex_signals_close(&p->signals);
    retex_edited_close(&p->edited);
    free(p->footprints);
    free(p);
    *result = NULL;
}

/* ---- noise ---- */

/* The square of a deviation from the mean root of its size, for normally distributed numbers. */
static double square_of_root(double root)
{
    static const double ROOT = 0.82217895866; /* the mean root of the size of standard normal numbers */
    const double ratio = root / ROOT;
    return ratio * ratio * ratio * ratio;
}

/* The variance of one signal's noise, from roots averaged over the neighbourhood within the band: few bright pixels do
 * not count for those around them. 0 where the pixel itself has no noise. */
static void average_noise(float *out, float *sums, const RetexSet *rows, int part, int y0, int lines, double scale)
{
    const int width = rows->width;
    const float *noise = rows->parts[part].image.pixels + retex_image_index(&rows->parts[part].image, 0, y0);
    for (int y = 0; y < lines; y++, out += width) {
        const int top = y > NEIGHBOURS ? y - NEIGHBOURS : 0;
        const int end = y + NEIGHBOURS + 1 < lines ? y + NEIGHBOURS + 1 : lines;
        memset(sums, 0, sizeof *sums * (size_t)width);
        for (int row = top; row < end; row++)
            for (int x = 0; x < width; x++) {
                const float *n = noise + 3 * ((size_t)row * (size_t)width + (size_t)x);
                sums[x] += sqrtf(fabsf(n[0])) + sqrtf(fabsf(n[1])) + sqrtf(fabsf(n[2]));
            }
        for (int x = 0; x < width; x++) {
            const int left = x > NEIGHBOURS ? x - NEIGHBOURS : 0;
            const int right = x + NEIGHBOURS + 1 < width ? x + NEIGHBOURS + 1 : width;
            const float *own = noise + 3 * ((size_t)y * (size_t)width + (size_t)x);
            double sum = 0;
            for (int k = left; k < right; k++)
                sum += (double)sums[k];
            out[x] = own[0] == 0 && own[1] == 0 && own[2] == 0
                         ? 0
                         : (float)(scale * scale * square_of_root(sum / (3.0 * (right - left) * (end - top))));
        }
    }
}

static void find_noise(const RetexPrecision *p, Scratch *s, const RetexSet *rows, int y0, int lines)
{
    const size_t pixels = band_pixels(rows);
    float *all = s->noise + (size_t)p->signals.count * pixels;
    memset(all, 0, sizeof *all * pixels);
    for (int k = 0; k < p->signals.count && p->has_noise; k++) {
        float *one = s->noise + (size_t)k * pixels;
        average_noise(one, s->row, rows, p->signals.of[k].noise, y0, lines, p->remaining);
        for (size_t i = 0; i < (size_t)rows->width * (size_t)lines && p->signals.of[k].lamp < 0; i++)
            all[i] += one[i];
    }
}

/* The noise of a pixel of the band. */
static void take_noise(const RetexPrecision *p, Scratch *s, const RetexSet *rows, size_t pixel)
{
    for (int k = 0; k <= p->signals.count; k++)
        s->deviations[k] = p->has_noise ? sqrt((double)s->noise[(size_t)k * band_pixels(rows) + pixel]) : 0;
}

/* The noise of a signal, or of all (-1), in the pixel. */
static double noise_of(const RetexPrecision *p, const Scratch *s, int signal)
{
    return s->deviations[signal < 0 ? p->signals.count : signal];
}

/* ---- lamps ---- */

static void add_row(double *restrict sums, const float *restrict row, int count)
{
    for (int i = 0; i < count; i++)
        sums[i] += (double)row[i];
}

/* How bright each lamp with white targets is in the pixels of row y. */
static void find_whites(const RetexPrecision *p, Scratch *s, const RetexSet *rows, int y)
{
    const int width = rows->width;
    for (int first = 0, next; first < p->signals.count; first = next) { /* those of one lamp follow each other */
        const int lamp = p->signals.of[first].lamp;
        memset(s->colors, 0, sizeof *s->colors * 3 * (size_t)width);
        for (next = first; next < p->signals.count && p->signals.of[next].lamp == lamp; next++)
            for (int m = 0; m < p->signals.of[next].nmembers && lamp >= 0; m++)
                add_row(s->colors, retex_pixel_at(rows, p->signals.of[next].members[m].part, (size_t)y * (size_t)width),
                        3 * width);
        for (int x = 0; x < width && lamp >= 0; x++) {
            const double *c = s->colors + 3 * x;
            s->whites[(size_t)lamp * (size_t)width + (size_t)x] = (double)(float)fmax(c[0], fmax(c[1], c[2]));
        }
    }
}

/* ---- one pixel ---- */

/* How much light every footprint and every mixture multiplies, further hits weighing as in the noise of it. Light of
 * lamps is the same light again. */
static void gather_light(const RetexPrecision *p, Scratch *s, const RetexSet *rows, size_t at)
{
    memset(s->light, 0, sizeof *s->light * (size_t)(p->nfootprints + 1));
    memset(s->mixed, 0, sizeof *s->mixed * (size_t)(p->nmixtures + 1));
    for (int k = 0; k < p->signals.count; k++)
        for (int m = 0; m < p->signals.of[k].nmembers && p->signals.of[k].lamp < 0; m++) {
            const RetexSignalMember *member = &p->signals.of[k].members[m];
            const RetexTerm *term = &rows->terms[member->term];
            const double light = retex_mean_size(retex_pixel_at(rows, member->part, at)) * (double)member->weight;
            for (int f = 0; f < term->nfactors && light > 0; f++)
                if (retex_factor_is_hit(term->factors[f]))
                    (term->factors[f].kind == RETEX_FACTOR_MIXTURE ? s->mixed : s->light)[term->factors[f].index] +=
                        light;
        }
    for (int m = 0; m < p->nmixtures; m++) {
        const RetexMixture *mixture = &rows->mixtures[m];
        double sum = 0;
        for (int k = 0; k < mixture->nshares && s->mixed[m] > 0 && p->whole[m]; k++)
            sum += (double)*retex_pixel_at(rows, mixture->shares[k].weight, at);
        for (int k = 0; k < mixture->nshares && sum > 0; k++)
            s->light[mixture->shares[k].footprint] +=
                s->mixed[m] * (double)*retex_pixel_at(rows, mixture->shares[k].weight, at) / sum;
    }
    for (int i = 0; i < p->nfootprints; i++)
        if (p->footprints[i].shared != i)
            s->light[p->footprints[i].shared] += s->light[i];
}

static double relative_noise(double noise, double light)
{
    return noise > 0 ? noise / light : 0; /* a footprint without light: infinite */
}

/* The variance of UV along an axis over all clusters of the kind that a pixel has. */
static double kind_variance(const RetexPrecision *p, const RetexSet *rows, int first, size_t at, int axis)
{
    const int periodic = p->footprints[first].target->periodic[axis];
    double weight = 0, mean = 0, square = 0, origin = 0;
    for (int i = first; i < p->nfootprints; i++) {
        const Footprint *f = &p->footprints[i];
        if (f->first != first || f->uv < 0)
            continue;
        const float *uv = retex_pixel_at(rows, f->uv, at), *spread = retex_pixel_at(rows, f->spread, at);
        if (!(uv[2] > 0))
            continue;
        origin = weight > 0 ? origin : (double)uv[axis];
        const double d = retex_uv_stats_difference((double)uv[axis], origin, periodic);
        weight += (double)uv[2];
        mean += (double)uv[2] * d;
        square += (double)uv[2] * (d * d + (double)(spread[axis] * spread[axis]));
    }
    return weight > 0 ? fmax(square / weight - mean / weight * (mean / weight), 0) : 0;
}

/* The standard deviation that a step follows. Few samples do not tell that of a broad cluster. One sample is credited
 * with half of the variance of all clusters of its kind together; that counts less, in the geometric mean, the more
 * samples there are. */
static double credible_deviation(const RetexPrecision *p, const RetexSet *rows, const Footprint *f, size_t at, int axis,
                                 double samples)
{
    const float *spread = retex_pixel_at(rows, f->spread, at);
    const double deviation = f->channels == RETEX_AXES
                                 ? hypot((double)spread[axis], (double)spread[2 + axis]) * EVEN_DEVIATION
                                 : (double)spread[axis];
    if (!f->broad || !p->has_noise)
        return deviation;
    const double own = fmax(deviation * deviation, 1e-20), all = kind_variance(p, rows, f->first, at, axis) / 2;
    return all > own ? sqrt(own * pow(all / own, 1 / (1 + 0.2 * fmax(samples - 1, 0)))) : deviation;
}

/* Both axes by their size along u and along v. */
static void round_axes(float *axes, double relative)
{
    for (int k = 0; k < 2; k++) {
        const double size = hypot((double)axes[k], (double)axes[2 + k]);
        for (int i = k; i < RETEX_AXES; i += 2)
            axes[i] = rounded(RETEX_PRECISION_SPREAD, (double)axes[i], size, relative);
    }
}

static void round_spread(const Footprint *f, float *spread, double relative)
{
    if (f->channels == RETEX_AXES) {
        round_axes(spread, relative);
        return;
    }
    for (int k = 0; k < 2; k++)
        spread[k] = rounded(f->broad ? RETEX_PRECISION_BROAD_SPREAD : RETEX_PRECISION_SPREAD, (double)spread[k],
                            (double)spread[k], relative);
    if (f->channels < 3)
        return;
    const double size = fmin(fabs((double)spread[2]), 1);
    if (f->broad)
        spread[2] = rounded(RETEX_PRECISION_BROAD_CORRELATION, (double)spread[2], 1, relative);
    else
        spread[2] = copysignf(1 - rounded(RETEX_PRECISION_CORRELATION, 1 - size, 1 - size, relative), spread[2]);
}

/* A mean of UV as a multiple of `unit` that is not outside of the target where the mean is not. */
static double rounded_mean(const RetexTarget *target, int axis, double mean, double unit)
{
    const double low = target->uv_min[axis], high = target->uv_max[axis], nearest = retex_round_by(mean, unit);
    if (target->periodic[axis] || mean < low || mean > high)
        return nearest;
    const double inside = nearest > high ? nearest - unit : nearest < low ? nearest + unit : nearest;
    return inside < low || inside > high ? mean : inside;
}

/* Mean, spread and coverage. The steps of means are those before any of a kind is rounded. Steps may be large against
 * the spread of broad footprints of few paths, which gains the variance of rounding: a texture with lines where the
 * multiples of steps are is then averaged there, and not hit too often. */
static void round_place(const RetexPrecision *p, const RetexSet *rows, const Footprint *f, size_t at,
                        const double deviation[2], double relative)
{
    static const double FINEST = 1.0 / (1 << 18); /* a 64th of a texel of a 4K texture */
    float *uv = retex_pixel_at(rows, f->uv, at), *spread = retex_pixel_at(rows, f->spread, at);
    for (int k = 0; k < 2; k++) {
        const double size = fabs((double)uv[k]), kept = retex_round_unit(size) / 32768, /* 16 significant bits */
            wanted = retex_precision_step(f->broad ? RETEX_PRECISION_BROAD_MEAN : RETEX_PRECISION_MEAN, deviation[k],
                                          relative);
        /* more bits only where they are finer than half a deviation, which PXR24 cannot store; parallelograms are
         * exact */
        const double needed = deviation[k] / (f->channels == RETEX_AXES ? EXACT : 2);
        const int enough = !p->has_noise ? 0 : kept <= needed || (double)uv[2] * rows->spp < 8;
        const double unit = retex_round_unit(fmax(fmax(wanted, FINEST), enough ? kept : 0));
        uv[k] = (float)rounded_mean(f->target, k, (double)uv[k], unit) + 0.0f;
        if (f->broad)
            spread[k] = (float)sqrt((double)(spread[k] * spread[k]) + unit * unit / 12);
    }
    round_spread(f, spread, relative);
    uv[2] = rounded(RETEX_PRECISION_COVERAGE, (double)uv[2], (double)uv[2], relative);
}

static void round_places(const RetexPrecision *p, const Scratch *s, const RetexSet *rows, size_t at)
{
    double deviation[RETEX_SET_FOOTPRINTS_MAX][2];
    for (int i = 0; i < p->nfootprints; i++) {
        const Footprint *f = &p->footprints[i];
        const double coverage = f->uv < 0 ? 0 : (double)retex_pixel_at(rows, f->uv, at)[2];
        for (int k = 0; k < 2 && coverage > 0; k++)
            deviation[i][k] = credible_deviation(p, rows, f, at, k, coverage * rows->spp);
    }
    for (int i = 0; i < p->nfootprints; i++) {
        const Footprint *f = &p->footprints[i];
        if (f->uv >= 0 && retex_pixel_at(rows, f->uv, at)[2] > 0)
            round_place(p, rows, f, at, deviation[i], relative_noise(noise_of(p, s, f->signal), s->light[i]));
    }
}

/* The footprints of one kind that have light in the pixel, those with little first. */
static int sort_footprints(const RetexPrecision *p, Scratch *s, int first)
{
    int count = 0;
    for (int i = first; i < p->nfootprints; i++) {
        int k = count;
        if (p->footprints[i].first != first || p->footprints[i].uv < 0 || !(s->light[i] > 0))
            continue;
        for (; k > 0 && s->light[s->order[k - 1]] > s->light[i]; k--)
            s->order[k] = s->order[k - 1];
        s->order[k] = i;
        count++;
    }
    return count;
}

static void round_albedos(const RetexPrecision *p, Scratch *s, const RetexSet *rows, int first, size_t at)
{
    const double noise = noise_of(p, s, p->footprints[first].signal);
    const int count = sort_footprints(p, s, first);
    double carried[3] = {0, 0, 0};
    for (int k = 0; k < count; k++) {
        const double light = s->light[s->order[k]], unit = retex_round_unit(retex_precision_step(
                                                        RETEX_PRECISION_ALBEDO, 1, relative_noise(noise, light)));
        float *albedo = retex_pixel_at(rows, p->footprints[s->order[k]].albedo, at);
        for (int c = 0; c < 3; c++) {
            const double value = fmax((double)albedo[c] + carried[c] / light, 0), kept = retex_round_by(value, unit);
            carried[c] += ((double)albedo[c] - kept) * light;
            albedo[c] = (float)kept;
        }
    }
}

static void round_weights(const RetexPrecision *p, const Scratch *s, const RetexSet *rows, size_t at)
{
    for (int m = 0; m < p->nmixtures; m++) {
        const RetexMixture *mixture = &rows->mixtures[m];
        const double relative = relative_noise(noise_of(p, s, -1), s->mixed[m]);
        for (int k = 0; k < mixture->nshares && p->whole[m]; k++) {
            const RetexImage *im = &rows->parts[mixture->shares[k].weight].image;
            float *weight = retex_pixel_at(rows, mixture->shares[k].weight, at);
            if (im->channels == 1 && *weight > 0)
                *weight = fmaxf(rounded(RETEX_PRECISION_WEIGHT, (double)*weight, 1, relative), RETEX_LEAST_SHARE);
        }
    }
}

static void round_pixel(const RetexPrecision *p, Scratch *s, const RetexSet *rows, size_t at, size_t pixel)
{
    RetexPixelLight light = {.signals = &p->signals,
                             .edited = p->edited,
                             .rows = rows,
                             .at = at,
                             .has_noise = p->has_noise,
                             .has_finishes = p->has_finishes,
                             .whites = s->whites + at % (size_t)rows->width,
                             .noise = s->deviations,
                             .lit = s->lit};
    take_noise(p, s, rows, pixel);
    retex_pixel_light_keep(&light);
    gather_light(p, s, rows, at);
    round_places(p, s, rows, at);
    for (int i = 0; i < p->nfootprints; i++)
        if (p->footprints[i].first == i)
            round_albedos(p, s, rows, i, at);
    round_weights(p, s, rows, at);
    retex_pixel_light_round(&light);
}

/* ---- bands ---- */

static void close_scratch(Scratch *s)
{
    free(s->noise);
    free(s->row);
    free(s->deviations);
    free(s->light);
    free(s->mixed);
    free(s->order);
    free(s->lit);
    free(s->whites);
    free(s->colors);
}

static int open_scratch(Scratch *s, const RetexPrecision *p, const RetexSet *rows, RetexError *err)
{
    *s = (Scratch){.noise = malloc(sizeof *s->noise * band_pixels(rows) * (size_t)(p->signals.count + 1)),
                   .row = malloc(sizeof *s->row * (size_t)rows->width),
                   .deviations = malloc(sizeof *s->deviations * (size_t)(p->signals.count + 1)),
                   .light = malloc(sizeof *s->light * (size_t)(p->nfootprints + 1)),
                   .mixed = malloc(sizeof *s->mixed * (size_t)(p->nmixtures + 1)),
                   .order = malloc(sizeof *s->order * (size_t)(p->nfootprints + 1)),
                   .lit = malloc(sizeof *s->lit * (size_t)(retex_edited_light_count(p->edited) + 1)),
                   .whites = malloc(sizeof *s->whites * (size_t)rows->width * (size_t)(rows->nparameters + 1)),
                   .colors = malloc(sizeof *s->colors * 3 * (size_t)rows->width)};
    if (s->noise && s->row && s->deviations && s->light && s->mixed && s->order && s->lit && s->whites && s->colors)
        return RETEX_OK;
    close_scratch(s);
    return retex_fail(err, RETEX_ENOMEM, "no memory to round a set");
}

typedef struct Rounding {
    const RetexPrecision *precision;
    RetexSet *rows;
    RetexRoi roi;
} Rounding;

/* The kind of a part's numbers, if they are rounded one by one; -1: another part. */
static int lone_kind(const RetexPrecision *p, const RetexSet *set, int part)
{
    const char *name = set->parts[part].name;
    if (part == 0)
        return RETEX_PRECISION_PICTURE;
    for (int s = 0; s < p->signals.count && p->has_finishes; s++)
        if (p->signals.of[s].noise == part && p->signals.of[s].lamp >= 0)
            return RETEX_PRECISION_CHOICE_NOISE;
    for (int t = 0; t < set->nterms && p->has_finishes; t++)
        if (set->terms[t].radiance == part && set->terms[t].role == RETEX_ROLE_LAMP_PICTURE)
            return RETEX_PRECISION_CHOICE_PICTURE;
    if (retex_name_is_noise(name))
        return RETEX_PRECISION_NOISE;
    if (!retex_name_is_feature(name))
        return -1;
    return set->parts[part].type == RETEX_FLOAT ? RETEX_PRECISION_POSITION : RETEX_PRECISION_GUIDE;
}

static void round_lone_numbers(const Rounding *r, int y0, int y1)
{
    for (int k = 0; k < r->rows->nparts; k++) {
        const int kind = lone_kind(r->precision, r->rows, k);
        const RetexImage *im = &r->rows->parts[k].image;
        if (kind < 0 || !im->pixels || !is_whole(r->rows, k, 1))
            continue;
        for (int y = y0; y < y1; y++) {
            float *v = im->pixels + retex_image_index(im, r->roi.x0, y), *end = v + retex_image_index(im, r->roi.x1, 0);
            for (end -= retex_image_index(im, r->roi.x0, 0); v < end; v++)
                *v = rounded((RetexPrecisionKind)kind, (double)*v, kind == RETEX_PRECISION_GUIDE ? 1 : fabs((double)*v),
                             0);
        }
    }
}

static int round_band(void *context, int band, int thread, RetexError *err)
{
    const Rounding *r = context;
    const int top = band * RETEX_PRECISION_LINES, left = r->rows->height - top;
    const int lines = left < RETEX_PRECISION_LINES ? left : RETEX_PRECISION_LINES;
    const int y0 = top > r->roi.y0 ? top : r->roi.y0, y1 = top + lines < r->roi.y1 ? top + lines : r->roi.y1;
    Scratch s;
    (void)thread;
    if (y0 >= y1)
        return RETEX_OK;
    const int code = open_scratch(&s, r->precision, r->rows, err);
    if (code)
        return code;
    find_noise(r->precision, &s, r->rows, top, lines);
    for (int y = y0; y < y1; y++) {
        find_whites(r->precision, &s, r->rows, y);
        for (int x = r->roi.x0; x < r->roi.x1; x++) {
            const size_t at = (size_t)y * (size_t)r->rows->width + (size_t)x;
            const size_t pixel = at - (size_t)top * (size_t)r->rows->width;
            round_pixel(r->precision, &s, r->rows, at, pixel);
        }
    }
    round_lone_numbers(r, y0, y1);
    close_scratch(&s);
    return RETEX_OK;
}

int retex_precision_round(const RetexPrecision *p, RetexSet *rows, const RetexRoi *roi, int nthreads, RetexError *err)
{
    Rounding rounding = {p, rows, {0, 0, rows->width, rows->height, 0, 3}};
    if (roi)
        rounding.roi = *roi;
    const int bands = (rows->height + RETEX_PRECISION_LINES - 1) / RETEX_PRECISION_LINES;
    return retex_jobs_run(nthreads, bands, round_band, &rounding, err);
}
