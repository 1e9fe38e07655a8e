/* Control variates: combines a render with a set that was rendered along the same paths. See control_variate.h. */
#include <math.h>
#include <string.h>
#include "render/control_variate.h"

#include <retex/host/set_build.h>

enum { REPLACED = 0, ORIGINAL = 1, CONSTANT = 2 };
#define RIDGE 1e-3 /* regularization of the least-squares system, for two controls that are nearly collinear */

/* Mean of a control and the variance of that mean. The variance is empty if it is unknown. */
typedef struct Control {
    const RetexImage *mean, *variance;
} Control;

static const RetexImage *find_image(const RetexSet *set, const char *name)
{
    const RetexPart *part = retex_set_part(set, retex_set_find_part(set, name));
    return part && part->image.channels == 3 && retex_set_scale(set, &part->image) == 1 ? &part->image : NULL;
}

/* Number of the window's columns (rows) that are inside an image of this width (height). */
static int window_count(int at, int size)
{
    int low = at - CONTROL_RADIUS, high = at + CONTROL_RADIUS;
    return (high < size - 1 ? high : size - 1) - (low > 0 ? low : 0) + 1;
}

/* Sum over the pixels of the window that lie beside (x, y) in a direction, those within the image. */
static void sum_along(double sum[3], const RetexImage *image, int x, int y, int dx, int dy)
{
    sum[0] = sum[1] = sum[2] = 0;
    for (int k = -CONTROL_RADIUS; k <= CONTROL_RADIUS; k++) {
        const int u = x + k * dx, v = y + k * dy;
        if (u < 0 || v < 0 || u >= image->width || v >= image->height)
            continue;
        const float *pixel = image->pixels + retex_image_index(image, u, v);
        sum[0] += pixel[0], sum[1] += pixel[1], sum[2] += pixel[2];
    }
}

/* Sums over the window's row at each pixel. */
static void sum_rows(RetexImage *rows, const RetexImage *src)
{
    double sum[3];
    for (int y = 0; y < src->height; y++)
        for (int x = 0; x < src->width; x++) {
            sum_along(sum, src, x, y, 1, 0);
            for (size_t c = 0; c < 3; c++)
                rows->pixels[retex_image_index(rows, x, y) + c] = (float)sum[c];
        }
}

/* Mean over the window around each pixel, limited to the image. With others_only the pixel itself is left out. */
static int smooth(RetexImage *dst, const RetexImage *src, int others_only, RetexError *err)
{
    RetexImage rows = {0};
    double sum[3];
    int code = retex_image_alloc(&rows, src->width, src->height, 3, err);
    if (!code)
        code = retex_image_alloc(dst, src->width, src->height, 3, err);
    if (!code)
        sum_rows(&rows, src);
    for (int y = 0; y < src->height && !code; y++)
        for (int x = 0; x < src->width; x++) {
            const size_t at = retex_image_index(src, x, y);
            const int count = window_count(x, src->width) * window_count(y, src->height) - others_only;
            sum_along(sum, &rows, x, y, 0, 1);
            for (size_t c = 0; c < 3; c++) {
                const double own = others_only ? src->pixels[at + c] : 0;
                dst->pixels[at + c] = count > 0 ? (float)((sum[c] - own) / count) : 0;
            }
        }
    retex_image_free(&rows);
    return code;
}

/* The coefficient alpha that minimizes the variance of the corrected mean of `wanted` samples, from the moments of
 * `samples` samples. */
static int find_alpha(RetexImage *alpha, const ControlMoments *m, int samples, int wanted, const Control *control,
                      double control_share, int spp, int others_only, RetexError *err)
{
    RetexImage both = {0}, own = {0}, stored = {0};
    int code = smooth(&both, &m->covariance[control_pair(REPLACED, ORIGINAL)], others_only, err);
    if (!code)
        code = smooth(&own, &m->covariance[control_pair(ORIGINAL, ORIGINAL)], others_only, err);
    if (!code && control->variance)
        code = smooth(&stored, control->variance, others_only, err);
    if (!code)
        code = retex_image_alloc(alpha, own.width, own.height, 3, err);
    size_t count = (size_t)own.width * (size_t)own.height * 3;
    double scale = (double)samples / wanted;
    for (size_t i = 0; i < count && !code; i++) {
        double f0 = own.pixels[i] * scale,
               g = control->variance ? stored.pixels[i] * control_share : own.pixels[i] * (double)samples / spp;
        alpha->pixels[i] = f0 + g > 0 ? (float)(both.pixels[i] * scale / (f0 + g)) : 0;
    }
    retex_image_free(&both);
    retex_image_free(&own);
    retex_image_free(&stored);
    return code;
}

/* Add the estimate of one half of the samples to dst, with its weight. */
static void add_estimate(RetexImage *dst, const ControlMoments *m, const RetexImage *alpha, const RetexImage *control,
                         double weight)
{
    const float *f1 = m->mean[REPLACED].pixels, *f0 = m->mean[ORIGINAL].pixels;
    size_t count = (size_t)dst->width * (size_t)dst->height * 3;
    for (size_t i = 0; i < count; i++)
        dst->pixels[i] += (float)(weight * (f1[i] - alpha->pixels[i] * (f0[i] - control->pixels[i])));
}

static int from_all(RetexImage *dst, const ControlMoments *m, int samples, const RetexSet *set, int others_only,
                    RetexError *err)
{
    Control control = {&retex_set_part(set, 0)->image, find_image(set, "variance")};
    RetexImage alpha = {0};
    int code = find_alpha(&alpha, m, samples, samples, &control, 1, retex_set_info(set).spp, others_only, err);
    if (!code)
        add_estimate(dst, m, &alpha, control.mean, 1);
    retex_image_free(&alpha);
    return code;
}

static int from_halves(RetexImage *dst, ControlMoments *const *moments, const int *samples, const RetexSet *set,
                       RetexError *err)
{
    static const char *const names[2][2] = {{"beauty_a", "variance_a"}, {"beauty_b", "variance_b"}};
    Control controls[2];
    int halves = 1, total = samples[0] + samples[1], code = RETEX_OK;
    for (int h = 0; h < 2; h++) {
        controls[h] = (Control){find_image(set, names[h][0]), find_image(set, names[h][1])};
        halves &= controls[h].mean && controls[h].variance;
    }
    for (int h = 0; h < 2 && !halves; h++) /* no variance from the same samples: it correlates with the beauty image */
        controls[h] = (Control){&retex_set_part(set, 0)->image, NULL};
    for (int h = 0; h < 2 && !code; h++) {
        RetexImage alpha = {0};
        int other = 1 - h;
        code = find_alpha(&alpha, moments[other], samples[other], total, &controls[other], 0.5, retex_set_info(set).spp,
                          0, err);
        if (!code)
            add_estimate(dst, moments[h], &alpha, controls[h].mean, (double)samples[h] / total);
        retex_image_free(&alpha);
    }
    return code;
}

/* Estimate from both controls, with alphas from the pixels around. The noise of the set scales the variances and
 * covariances alike, because the set is made from the same paths. */
static int from_both(RetexImage *dst, const ControlMoments *m, int samples, const RetexSet *set,
                     const RetexImage *combined, RetexError *err)
{
    static const int pairs[5][2] = {
        {REPLACED, ORIGINAL}, {REPLACED, CONSTANT}, {ORIGINAL, ORIGINAL}, {ORIGINAL, CONSTANT}, {CONSTANT, CONSTANT}};
    RetexImage c[5] = {{0}};
    int code = RETEX_OK;
    for (int k = 0; k < 5 && !code; k++)
        code = smooth(&c[k], &m->covariance[control_pair(pairs[k][0], pairs[k][1])], 1, err);
    double share = 1 / (1 + (double)samples / retex_set_info(set).spp);
    const float *f1 = m->mean[REPLACED].pixels, *f0 = m->mean[ORIGINAL].pixels, *fc = m->mean[CONSTANT].pixels,
                *g0 = retex_set_part(set, 0)->image.pixels, *gc = combined->pixels;
    size_t count = (size_t)dst->width * (size_t)dst->height * 3;
    for (size_t i = 0; i < count && !code; i++) {
        double r0 = c[0].pixels[i], rc = c[1].pixels[i], v0 = c[2].pixels[i] * (1 + RIDGE), v0c = c[3].pixels[i],
               vc = c[4].pixels[i] * (1 + RIDGE), det = v0 * vc - v0c * v0c, a0 = 0, ac = 0;
        if (det > 0)
            a0 = (r0 * vc - rc * v0c) / det, ac = (rc * v0 - r0 * v0c) / det;
        else if (vc > 0)
            ac = rc / vc;
        else if (v0 > 0)
            a0 = r0 / v0;
        dst->pixels[i] = (float)(f1[i] - share * (a0 * (f0[i] - g0[i]) + ac * (fc[i] - gc[i])));
    }
    for (int k = 0; k < 5; k++)
        retex_image_free(&c[k]);
    return code;
}

int control_variate(RetexImage *dst, ControlMoments *const *moments, const int *samples, const RetexSet *set,
                    const RetexImage *combined, ControlMode mode, RetexError *err)
{
    const RetexSetInfo info = retex_set_info(set);
    int code = retex_image_alloc(dst, info.width, info.height, 3, err);
    if (!code)
        code = mode == CONTROL_HALVES ? from_halves(dst, moments, samples, set, err)
               : combined             ? from_both(dst, moments[0], samples[0], set, combined, err)
                                      : from_all(dst, moments[0], samples[0], set, mode == CONTROL_UNBIASED, err);
    if (code)
        retex_image_free(dst);
    return code;
}

double control_distance(ControlMoments *const *moments, const int *samples, int nhalves, const RetexSet *set)
{
    double difference = 0, variance = 0, total = nhalves > 1 ? samples[0] + samples[1] : samples[0];
    const RetexImage *g = &retex_set_part(set, 0)->image;
    const int spp = retex_set_info(set).spp;
    for (size_t i = 0; i < (size_t)g->width * (size_t)g->height * 3; i++) {
        double f0 = 0;
        for (int h = 0; h < nhalves; h++) {
            double share = samples[h] / total, own = moments[h]->covariance[control_pair(ORIGINAL, ORIGINAL)].pixels[i];
            f0 += share * moments[h]->mean[ORIGINAL].pixels[i];
            variance += share * share * own * (1 + total / spp);
        }
        difference += f0 - g->pixels[i];
    }
    return variance > 0 ? fabs(difference) / sqrt(3 * variance) : 0; /* 3: the channels are correlated */
}

static int add_image(RetexSet *set, const char *name, const RetexImage *image, RetexError *err)
{
    int part, code = retex_set_add_part(set, name, "RGB", RETEX_FLOAT, 0, 0, &part, err);
    if (!code)
        memcpy(retex_set_mutable_image(set, part)->pixels, image->pixels,
               (size_t)image->width * (size_t)image->height * 3 * sizeof(float));
    return code;
}

int control_data_add(RetexSet *set, ControlMoments *const *moments, const int *samples, int nhalves, RetexError *err)
{
    static const char *const names[2][2] = {{"beauty_a", "variance_a"}, {"beauty_b", "variance_b"}};
    double total = nhalves > 1 ? samples[0] + samples[1] : samples[0];
    int part, code = retex_set_add_part(set, "variance", "RGB", RETEX_FLOAT, 0, 0, &part, err);
    for (int h = 0; h < nhalves && !code; h++) {
        const float *own = moments[h]->covariance[0].pixels;
        const RetexImage *variance = retex_set_mutable_image(set, part);
        float *sum = variance->pixels, share = (float)(samples[h] / total);
        for (size_t i = 0; i < (size_t)variance->width * (size_t)variance->height * 3; i++)
            sum[i] += share * share * own[i];
        if (nhalves > 1 && !(code = add_image(set, names[h][0], &moments[h]->mean[0], err)))
            code = add_image(set, names[h][1], &moments[h]->covariance[0], err);
    }
    return code;
}
