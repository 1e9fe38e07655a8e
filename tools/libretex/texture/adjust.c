/* Adjustments of a texture's colours: hue, saturation, gain and others, one after the other, before anything is
 * filtered. Those of single colours go through an image together; a blur, and the mean that `colorize` needs, take a
 * pass each. See adjust.h. */
#include "texture/adjust.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color.h>
#include <retex/metrics.h>
#include <retex/parallel.h>

#define MIDDLE_GREY 0.18f      /* stays what it is whatever the contrast */
#define LEAST_LUMINANCE 1e-6f  /* of a mean: less is black, which no factor can colour */
#define MOST_BLUR 0.25         /* of the image's width */
#define MOST_DIRECT_SIGMA 16.0 /* texels: a Gaussian is summed up to it, boxes stand for wider ones */
#define BOXES 4                /* in a row: their curve is within 2 % of the Gaussian's peak */
#define COLUMNS 8              /* filtered together, for whole cache lines */

int retex_adjust_check(const RetexTextureSpec *spec, RetexError *err)
{
    if (spec->nadjustments < 0 || spec->nadjustments > RETEX_ADJUSTS)
        return retex_fail(err, RETEX_EINVAL, "texture: %d adjustments; there are at most %d", spec->nadjustments,
                          RETEX_ADJUSTS);
    for (int i = 0; i < spec->nadjustments; i++) {
        const RetexAdjustment *a = &spec->adjustments[i];
        const int is_positive = a->kind == RETEX_ADJUST_GAMMA || a->kind == RETEX_ADJUST_CONTRAST;
        int is_right = (unsigned)a->kind < RETEX_ADJUSTS;
        for (int c = 0; c < 3; c++)
            is_right &= isfinite(a->value[c]) && (a->value[c] >= 0 || a->kind == RETEX_ADJUST_HUE);
        is_right &= !(is_positive && a->value[0] <= 0);
        is_right &= !(a->kind == RETEX_ADJUST_BLUR && a->value[0] > MOST_BLUR);
        if (!is_right)
            return retex_fail(err, RETEX_EINVAL, "texture: adjustment %d has a value that it cannot have", i + 1);
    }
    return RETEX_OK;
}

/* ---- one colour ---- */

static float clamped(float x)
{
    return x > 0 ? x < 1 ? x : 1 : 0; /* NaN becomes 0 */
}

/* Turns the hue in Oklab, where lightness and chroma stay: B. Ottosson, 'A perceptual color space for image
 * processing' (2020). */
static void turn_hue(float rgb[3], float degrees)
{
    static const float to_lms[3][3] = {{0.4122214708f, 0.5363325363f, 0.0514459929f},
                                       {0.2119034982f, 0.6806995451f, 0.1073969566f},
                                       {0.0883024619f, 0.2817188376f, 0.6299787005f}};
    static const float to_lab[3][3] = {{0.2104542553f, 0.7936177850f, -0.0040720468f},
                                       {1.9779984951f, -2.4285922050f, 0.4505937099f},
                                       {0.0259040371f, 0.7827717662f, -0.8086757660f}};
    static const float from_lab[3][3] = {
        {1, 0.3963377774f, 0.2158037573f}, {1, -0.1055613458f, -0.0638541728f}, {1, -0.0894841775f, -1.2914855480f}};
    static const float from_lms[3][3] = {{4.0767416621f, -3.3077115913f, 0.2309699292f},
                                         {-1.2684380046f, 2.6097574011f, -0.3413193965f},
                                         {-0.0041960863f, -0.7034186147f, 1.7076147010f}};
    const float turn = degrees * (float)(M_PI / 180), c = cosf(turn), s = sinf(turn);
    float roots[3], lab[3], lms[3];
    for (int i = 0; i < 3; i++)
        roots[i] = cbrtf(to_lms[i][0] * rgb[0] + to_lms[i][1] * rgb[1] + to_lms[i][2] * rgb[2]);
    for (int i = 0; i < 3; i++)
        lab[i] = to_lab[i][0] * roots[0] + to_lab[i][1] * roots[1] + to_lab[i][2] * roots[2];
    const float turned[3] = {lab[0], c * lab[1] - s * lab[2], s * lab[1] + c * lab[2]};
    for (int i = 0; i < 3; i++) {
        const float root = from_lab[i][0] * turned[0] + from_lab[i][1] * turned[1] + from_lab[i][2] * turned[2];
        lms[i] = root * root * root;
    }
    for (int i = 0; i < 3; i++)
        rgb[i] = from_lms[i][0] * lms[0] + from_lms[i][1] * lms[1] + from_lms[i][2] * lms[2];
}

static float luminance(const float rgb[3])
{
    return retex_luminancef(rgb[0], rgb[1], rgb[2]);
}

/* mean: the luminance of the whole, for `colorize`. */
static void adjust(const RetexAdjustment *by, float mean, float rgb[3])
{
    const float *value = by->value, grey = luminance(rgb);
    if (by->kind == RETEX_ADJUST_HUE)
        turn_hue(rgb, value[0]);
    for (int c = 0; c < 3; c++)
        switch (by->kind) {
        case RETEX_ADJUST_SATURATION:
            rgb[c] = grey + value[0] * (rgb[c] - grey);
            break;
        case RETEX_ADJUST_GAIN:
        case RETEX_ADJUST_TINT:
            rgb[c] *= value[c];
            break;
        case RETEX_ADJUST_GAMMA:
            rgb[c] = rgb[c] > 0 ? powf(rgb[c], 1 / value[0]) : 0;
            break;
        case RETEX_ADJUST_CONTRAST:
            rgb[c] = rgb[c] > 0 ? MIDDLE_GREY * powf(rgb[c] / MIDDLE_GREY, value[0]) : 0;
            break;
        case RETEX_ADJUST_INVERT:
            rgb[c] = retex_srgb_decodef(1 - retex_srgb_encodef(clamped(rgb[c])));
            break;
        case RETEX_ADJUST_COLORIZE:
            rgb[c] = value[c] * (mean > LEAST_LUMINANCE ? grey / mean : 1);
            break;
        case RETEX_ADJUST_HUE:
        case RETEX_ADJUST_BLUR:
        case RETEX_ADJUSTS:
            break;
        }
}

/* Colours of surfaces stay within 0 and 1, light has no upper limit. */
static void limit(const RetexTextureSpec *spec, float rgb[3])
{
    for (int c = 0; c < 3; c++)
        rgb[c] = spec->is_light ? fmaxf(rgb[c], 0) : clamped(rgb[c]);
}

void retex_adjust_color(const RetexTextureSpec *spec, float rgb[3])
{
    for (int i = 0; i < spec->nadjustments; i++)
        adjust(&spec->adjustments[i], luminance(rgb), rgb);
    if (spec->nadjustments)
        limit(spec, rgb);
}

/* ---- an image ---- */

typedef struct AdjustWork {
    const RetexTextureSpec *spec;
    const RetexTexels *texels;
    int first, end;    /* adjustments */
    float mean;        /* luminance before the first one */
    double (*sums)[4]; /* by row: colours times alpha, and alpha */
} AdjustWork;

static void adjust_job(void *context, int y, int thread)
{
    const AdjustWork *work = context;
    const size_t width = (size_t)work->texels->width, row = (size_t)y * width;
    (void)thread;
    for (size_t i = row; i < row + width; i++) {
        float p[4];
        retex_texture_read_texel(work->texels->texels, i, work->texels->narrow, p);
        if (!(p[3] > 0))
            continue;
        for (int c = 0; c < 3; c++)
            p[c] /= p[3];
        for (int k = work->first; k < work->end; k++)
            adjust(&work->spec->adjustments[k], work->mean, p);
        limit(work->spec, p);
        for (int c = 0; c < 3; c++)
            p[c] *= p[3];
        retex_texture_store_texel(work->texels, i, p);
    }
}

static void sum_job(void *context, int y, int thread)
{
    const AdjustWork *work = context;
    const size_t width = (size_t)work->texels->width, row = (size_t)y * width;
    double *sum = work->sums[y];
    (void)thread;
    for (size_t i = row; i < row + width; i++) {
        float p[4];
        retex_texture_read_texel(work->texels->texels, i, work->texels->narrow, p);
        for (int c = 0; c < 4; c++)
            sum[c] += (double)p[c];
    }
}

/* The mean colour of what is opaque. */
static int find_mean(AdjustWork *work, double rgb[3], int nthreads)
{
    const size_t rows = (size_t)work->texels->height;
    double sum[4] = {0};
    if (!(work->sums = calloc(rows, sizeof *work->sums)))
        return -1;
    retex_parallel(nthreads, work->texels->height, sum_job, work);
    for (size_t y = 0; y < rows; y++)
        for (int c = 0; c < 4; c++)
            sum[c] += work->sums[y][c];
    free(work->sums);
    for (int c = 0; c < 3; c++)
        rgb[c] = sum[3] > 0 ? sum[c] / sum[3] : 0;
    return 0;
}

/* ---- blur ---- */

/* A line of an image, with as many texels of what lies beyond it at each end as the filter reads. */
typedef struct BlurWork {
    const RetexTexels *texels;
    RetexWrap wrap;
    int axis;                  /* 0: along rows */
    int length, lines, radius; /* radius: texels at each end */
    double sigma;
    float *weights; /* 2 radius + 1; NULL: boxes */
    float *scratch; /* by thread: 2 lines of 4 channels, and their ends */
    size_t scratch_size;
} BlurWork;

/* The texel that lies at i; -1: nothing does. */
static int wrapped(int i, int size, RetexWrap wrap)
{
    if (i >= 0 && i < size)
        return i;
    if (wrap == RETEX_WRAP_BLACK)
        return -1;
    if (wrap == RETEX_WRAP_CLAMP)
        return i < 0 ? 0 : size - 1;
    const int period = wrap == RETEX_WRAP_MIRROR ? 2 * size : size, in = (i % period + period) % period;
    return in < size ? in : 2 * size - 1 - in;
}

/* A box of any width: whole texels have weight 1, the two at its ends a part. */
static void box(const float *from, float *to, int count, int whole, float part)
{
    double sum[4] = {0};
    const float inverse = 1 / (2 * ((float)whole + part) + 1);
    for (int i = 0; i < 2 * whole + 1; i++)
        for (int c = 0; c < 4; c++)
            sum[c] += (double)from[4 * (i + 1) + c];
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 4; c++) {
            const float *low = from + 4 * i + c, *high = low + 4 * (2 * whole + 2);
            to[4 * i + c] = ((float)sum[c] + part * (*low + *high)) * inverse;
            sum[c] += (double)*high - (double)low[4];
        }
}

/* Several boxes whose variances sum up to sigma squared. Each reads `whole` + 1 texels more at each end than it
 * makes. */
static const float *blur_by_boxes(const BlurWork *work, float *line, float *other)
{
    const double each = work->sigma * work->sigma / BOXES, exact = (sqrt(12 * each + 1) - 1) / 2;
    const int whole = (int)exact;
    /* the variance of whole texels and two parts: solved for the parts */
    const double n = whole, inside = n * (n + 1) * (2 * n + 1) / 3, edge = n + 1;
    const double part = (each * (2 * n + 1) - inside) / (2 * (edge * edge - each));
    int count = work->length + 2 * work->radius;
    float *from = line, *to = other;
    for (int k = 0; k < BOXES; k++) {
        count -= 2 * (whole + 1);
        box(from, to, count, whole, (float)part);
        float *last = from;
        from = to, to = last;
    }
    return from;
}

static const float *blur_directly(const BlurWork *work, const float *line, float *out)
{
    const int taps = 2 * work->radius + 1;
    for (int i = 0; i < work->length; i++) {
        float sum[4] = {0};
        const float *at = line + 4 * i;
        for (int k = 0; k < taps; k++)
            for (int c = 0; c < 4; c++)
                sum[c] += work->weights[k] * at[4 * k + c];
        memcpy(out + 4 * i, sum, sizeof sum);
    }
    return out;
}

static size_t texel_at(const BlurWork *work, int line, int i)
{
    const size_t width = (size_t)work->texels->width;
    return work->axis ? (size_t)i * width + (size_t)line : (size_t)line * width + (size_t)i;
}

static void blur_job(void *context, int job, int thread)
{
    const BlurWork *work = context;
    const int first = job * COLUMNS, end = first + COLUMNS < work->lines ? first + COLUMNS : work->lines;
    float *line = work->scratch + (size_t)thread * work->scratch_size, *other = line + work->scratch_size / 2;
    for (int n = first; n < end; n++) {
        for (int i = -work->radius; i < work->length + work->radius; i++) {
            const int at = wrapped(i, work->length, work->wrap);
            float *to = line + 4 * (i + work->radius);
            if (at < 0)
                memset(to, 0, 4 * sizeof *to);
            else
                retex_texture_read_texel(work->texels->texels, texel_at(work, n, at), work->texels->narrow, to);
        }
        const float *out = work->weights ? blur_directly(work, line, other) : blur_by_boxes(work, line, other);
        for (int i = 0; i < work->length; i++)
            retex_texture_store_texel(work->texels, texel_at(work, n, i), out + 4 * i);
    }
}

static float *gaussian(double sigma, int radius)
{
    double sum = 0;
    float *weights = malloc((size_t)(2 * radius + 1) * sizeof *weights);
    for (int i = -radius; i <= radius && weights; i++)
        sum += exp(-0.5 * i * i / (sigma * sigma));
    for (int i = -radius; i <= radius && weights; i++)
        weights[i + radius] = (float)(exp(-0.5 * i * i / (sigma * sigma)) / sum);
    return weights;
}

/* Along one axis; sigma in texels. Not 0: no memory. */
static int blur_axis(const RetexTextureSpec *spec, const RetexTexels *texels, int axis, double sigma, int nthreads)
{
    const int is_direct = sigma <= MOST_DIRECT_SIGMA, threads = retex_threads(nthreads);
    BlurWork work = {.texels = texels, .wrap = spec->wrap[axis], .axis = axis, .sigma = sigma};
    work.length = axis ? texels->height : texels->width;
    work.lines = axis ? texels->width : texels->height;
    work.radius =
        is_direct ? (int)ceil(5 * sigma) : BOXES * ((int)((sqrt(12 * sigma * sigma / BOXES + 1) - 1) / 2) + 1);
    work.scratch_size = 2 * 4 * ((size_t)work.length + 2 * (size_t)work.radius);
    work.weights = is_direct ? gaussian(sigma, work.radius) : NULL;
    work.scratch = malloc((size_t)threads * work.scratch_size * sizeof *work.scratch);
    const int failed = !work.scratch || (is_direct && !work.weights);
    if (!failed)
        retex_parallel(threads, (work.lines + COLUMNS - 1) / COLUMNS, blur_job, &work);
    free(work.weights);
    free(work.scratch);
    return failed;
}

static int blur(const RetexTextureSpec *spec, const RetexTexels *texels, double share, int nthreads)
{
    const double sigma = share * texels->width;
    int failed = 0;
    for (int axis = 0; axis < 2 && sigma > 0 && !failed; axis++)
        failed = blur_axis(spec, texels, axis, sigma, nthreads);
    return failed;
}

/* ---- all ---- */

/* From the adjustment `first` on, those that one pass does; returns the next one. */
static int adjust_some(AdjustWork *work, int first, int nthreads, int *failed)
{
    const RetexAdjustment *all = work->spec->adjustments;
    double mean[3] = {0};
    int end = first + 1;
    if (all[first].kind == RETEX_ADJUST_BLUR) {
        *failed = blur(work->spec, work->texels, (double)all[first].value[0], nthreads);
        return end;
    }
    if (all[first].kind == RETEX_ADJUST_COLORIZE)
        *failed = find_mean(work, mean, nthreads);
    while (end < work->spec->nadjustments && all[end].kind != RETEX_ADJUST_BLUR &&
           all[end].kind != RETEX_ADJUST_COLORIZE)
        end++;
    work->first = first, work->end = end;
    work->mean = (float)retex_luminance(mean[0], mean[1], mean[2]);
    if (!*failed)
        retex_parallel(nthreads, work->texels->height, adjust_job, work);
    return end;
}

/* How far the mean is from the colour that was asked for. */
static double miss_color(AdjustWork *work, const float color[3], int nthreads, int *failed)
{
    double mean[3], of_mean[3], of_color[3];
    if ((*failed = find_mean(work, mean, nthreads)))
        return 0;
    retex_lab(of_mean, mean);
    retex_lab(of_color, (const double[3]){(double)color[0], (double)color[1], (double)color[2]});
    return retex_delta_e(of_mean, of_color);
}

int retex_adjust_texels(const RetexTextureSpec *spec, RetexTexels *texels, double *delta_e, int nthreads,
                        RetexError *err)
{
    AdjustWork work = {.spec = spec, .texels = texels};
    int failed = 0;
    *delta_e = 0;
    for (int i = 0; i < spec->nadjustments && !failed;)
        i = adjust_some(&work, i, nthreads, &failed);
    for (int i = 0; i < spec->nadjustments && !failed; i++)
        if (spec->adjustments[i].kind == RETEX_ADJUST_COLORIZE)
            *delta_e = miss_color(&work, spec->adjustments[i].value, nthreads, &failed);
    return failed
               ? retex_fail_at(err, RETEX_ENOMEM, spec->image, 0, 0,
                               "not enough memory to adjust a texture of %d x %d texels", texels->width, texels->height)
               : RETEX_OK;
}
