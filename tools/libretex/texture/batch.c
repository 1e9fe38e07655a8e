/* Filters rows of footprints. Footprints with coverage are collected and given to the fastest kernel that the processor
 * can run; those that the kernel does not filter are given to it once more, one by one, in other forms. */
#include "texture/batch.h"
#include "texture/layer.h"

#include <math.h>
#include <string.h>

#include <retex/host/texture_lookup.h>

#include "texture/texture_kernel.h"

/* Gaussians: the least ratio of the smaller variance to the larger, and the least variance, in texels of the level that
 * is chosen, with interpolation; and the largest one, of broad footprints: few paths hardly determine their shape. */
static const struct {
    float narrowest, least, most;
} gaussians[] = {[RETEX_TEXTURE_GAUSSIAN] = {1.0f / 64, 0.35f, 0}, [RETEX_TEXTURE_BROAD] = {1.0f / 4, 0.35f, 1.9f}};

#define OVER_PIXELS 256 /* of a layer, filtered in one call */
#define LEAST_ALPHA 1e-20f /* alpha below this has no colour that a float can hold */

/* The number of usable levels: only a level whose texels have about the same size along both axes stands for the
 * smaller variance along both. */
static int count_levels(const RetexTexture *texture)
{
    int count = 1;
    for (; count < texture->nlevels && count < BATCH_LEVELS; count++) {
        const double *scale = texture->levels[count].scale;
        if (scale[0] > 1.5 * scale[1] || scale[1] > 1.5 * scale[0])
            break;
    }
    return count;
}

/* The limit of Gaussians, which are cut off where the surface ends; discs are not: see RetexTextureSpec. An axis of the
 * image has such a limit if the texture is not turned against the surface. */
static RetexBatchLimit find_limit(const RetexTexture *texture, const RetexBatchTexture *t, int axis)
{
    const RetexTextureSpec *spec = &texture->spec;
    const int along = t->matrix[axis][0] == 0;
    if (!t->gaussian || t->matrix[axis][!along] != 0 || !(spec->uv_min[along] < spec->uv_max[along]))
        return (RetexBatchLimit){.along = -1};
    return (RetexBatchLimit){along, (float)spec->uv_min[along], (float)spec->uv_max[along],
                             (float)t->matrix[axis][along]};
}

static void set_levels(RetexBatchTexture *t)
{
    const int nlevels = t->texture->nlevels;
    t->levels = count_levels(t->texture);
    t->last = (nlevels < BATCH_LEVELS ? nlevels : BATCH_LEVELS) - 1;
    for (int axis = 0; axis < 2; axis++)
        for (int i = 0; i <= t->last; i++) {
            const RetexTextureLevel *level = &t->texture->levels[i];
            const int size = axis ? level->height : level->width;
            t->texels[axis][i] = (float)size;
            t->inverse_area[2 * axis][i] = (float)(1 / (level->scale[axis] * level->scale[axis]));
            t->inverse_area[1][i] = (float)(1 / (level->scale[0] * level->scale[1]));
            t->spread[axis][i] = size == 1 && (t->period[axis] > 0 || is_flat(t->texture, axis)) ? 0 : 1;
            for (int k = 0; k < 2; k++)
                t->blur[axis][k][i] = (float)level->blur[axis][k];
            t->padding[i] = (float)level->padding;
        }
}

static void prepare(RetexBatchTexture *t, const RetexTexture *texture, RetexTextureFilter shape)
{
    const RetexTextureLevel *image = &texture->levels[0];
    *t = (RetexBatchTexture){.texture = texture,
                             .gaussian = shape == RETEX_TEXTURE_GAUSSIAN || shape == RETEX_TEXTURE_BROAD,
                             .broad = shape == RETEX_TEXTURE_BROAD,
                             .straight = shape >= RETEX_TEXTURE_PARALLELOGRAM};
    if (t->gaussian) {
        t->narrowest = gaussians[shape].narrowest;
        t->least = gaussians[shape].least;
        t->most = gaussians[shape].most;
    }
    t->size[0] = image->width;
    t->size[1] = image->height;
    for (int axis = 0; axis < 2; axis++) {
        RetexWrap wrap = texture->spec.wrap[axis];
        double sign = axis ? -1 : 1;
        t->period[axis] = wrap == RETEX_WRAP_REPEAT ? 1 : wrap == RETEX_WRAP_MIRROR ? 2 : 0;
        t->black[axis] = wrap == RETEX_WRAP_BLACK;
        t->offset[axis] = axis ? 1 - texture->offset[1] : texture->offset[0];
        for (int i = 0; i < 2; i++) {
            t->matrix[axis][i] = sign * texture->matrix[axis][i];
            t->to_texels[axis][i] = (float)(t->matrix[axis][i] * t->size[axis]);
        }
        t->limits[axis] = find_limit(texture, t, axis);
        t->limited |= t->limits[axis].along >= 0;
    }
    set_levels(t);
}

static void add_ellipse(RetexBatch *batch, const float *uv, const float *spread, int spreads)
{
    const int k = batch->count++;
    batch->u[k] = uv[0];
    batch->v[k] = uv[1];
    batch->spread[0][k] = spread[0];
    batch->spread[1][k] = spread[1];
    batch->spread[2][k] = spreads == 3 ? spread[2] : 0;
    batch->spread[3][k] = 0;
}

static void add_parallelogram(RetexBatch *batch, RetexTextureFilter shape, const float *uv, const float *axes)
{
    const RetexParallelogram p = retex_parallelogram(shape, uv, axes);
    const int k = batch->count++;
    batch->u[k] = p.uv[0];
    batch->v[k] = p.uv[1];
    for (int i = 0; i < 4; i++)
        batch->spread[i][k] = p.sides[i];
}

/* Divides by alpha; without alpha out stays 0. */
static inline void unassociate(const float in[4], float *out, int channels)
{
    const float alpha = in[3];
    if (!(alpha > LEAST_ALPHA))
        return;
    RetexFloat4 color = load4(in) * (1 / alpha);
    color[3] = alpha < 1 ? alpha : 1;
    if (channels == 4)
        memcpy(out, &color, sizeof color);
    else
        memcpy(out, &color, 3 * sizeof *out);
}

/* ---- what a kernel leaves ---- */

/* A footprint of a thousand repeats gives the average, whatever its size; larger sizes only lose digits. */
#define MOST_REPEATS 1000.0
#define FAR 1e4 /* images: farther away from one that does not repeat nothing changes */

/* A footprint in images, y down. */
typedef struct Left {
    double at[2];
    double spread[4]; /* xx, xy and yy; or the sides of a parallelogram */
} Left;

/* Limits the size to which nothing is lost; what is no size is a point. */
static void limit_size(Left *left, int straight)
{
    double *s = left->spread, size = straight ? 0 : s[0] + s[2];
    for (int i = 0; i < 4 && straight; i++)
        size += s[i] * s[i] / 12;
    const double most = MOST_REPEATS * MOST_REPEATS, shrink = size > most ? most / size : 1;
    for (int i = 0; i < 4; i++)
        s[i] = isfinite(size) ? s[i] * (straight ? sqrt(shrink) : shrink) : 0;
}

/* Of footprint k; 0 where its place is no number. */
static int find_left(Left *left, const RetexBatchTexture *t, const RetexBatch *batch, int k)
{
    const double u = (double)batch->u[k], v = (double)batch->v[k];
    double s[4];
    for (int i = 0; i < 4; i++)
        s[i] = (double)batch->spread[i][k];
    for (int axis = 0; axis < 2; axis++)
        left->at[axis] = t->matrix[axis][0] * u + t->matrix[axis][1] * v + t->offset[axis];
    const double *x = t->matrix[0], *y = t->matrix[1], uu = s[0] * s[0], vv = s[1] * s[1],
                 uv = fmax(fmin(s[2], 1), -1) * s[0] * s[1];
    const double ellipse[4] = {x[0] * x[0] * uu + 2 * x[0] * x[1] * uv + x[1] * x[1] * vv,
                               x[0] * y[0] * uu + (x[0] * y[1] + x[1] * y[0]) * uv + x[1] * y[1] * vv,
                               y[0] * y[0] * uu + 2 * y[0] * y[1] * uv + y[1] * y[1] * vv};
    const double sides[4] = {x[0] * s[0] + x[1] * s[1], y[0] * s[0] + y[1] * s[1], x[0] * s[2] + x[1] * s[3],
                             y[0] * s[2] + y[1] * s[3]};
    memcpy(left->spread, t->straight ? sides : ellipse, sizeof left->spread);
    limit_size(left, t->straight);
    return isfinite(left->at[0]) && isfinite(left->at[1]);
}

/* The share of a footprint that is at most so far from its mean along an axis. */
static double share_below(double distance, const RetexBatchTexture *t, const Left *left, int axis)
{
    const double *s = left->spread, deviation = sqrt(fmax(s[2 * axis], 0)) + 1e-12;
    if (t->gaussian)
        return 0.5 * (1 + erf(distance / (deviation * M_SQRT2)));
    if (!t->straight) { /* chords of an ellipse */
        const double at = fmax(fmin(distance / (2 * deviation), 1), -1);
        return 0.5 + (at * sqrt(1 - at * at) + asin(at)) / M_PI;
    }
    const double a = fabs(s[axis]) + 1e-9, b = fabs(s[2 + axis]) + 1e-9, ends[4] = {a + b, a - b, b - a, -a - b};
    double sum = 0; /* of a parallelogram: the sum of two evenly distributed numbers */
    for (int i = 0; i < 4; i++) {
        const double beyond = fmax(distance + ends[i] / 2, 0);
        sum += (i % 3 ? -0.5 : 0.5) * beyond * beyond;
    }
    return fmax(fmin(sum / (a * b), 1), 0);
}

/* The texture as it lies in the image's own UV, y down, around a footprint, which is moved into the first period. */
static void place_left(RetexBatchTexture *t, Left *left, const RetexBatch *batch, int k)
{
    for (int axis = 0; axis < 2; axis++) {
        RetexBatchLimit *limit = &t->limits[axis];
        const double period = t->period[axis], at = left->at[axis],
                     first = period > 0 ? at - period * floor(at / period) : fmax(fmin(at, FAR), -FAR);
        left->at[axis] = first >= 0 || !(period > 0) ? first : 0;
        const double place = limit->along > 0 ? (double)batch->v[k] : (double)batch->u[k];
        if (limit->along >= 0)
            *limit = (RetexBatchLimit){
                axis, (float)(left->at[axis] + ((double)limit->low - place) * (double)limit->scale),
                (float)(left->at[axis] + ((double)limit->high - place) * (double)limit->scale), 1};
        t->offset[axis] = 0;
        for (int i = 0; i < 2; i++) {
            t->matrix[axis][i] = axis == i;
            t->to_texels[axis][i] = axis == i ? (float)t->size[axis] : 0;
        }
    }
}

static void put_left(RetexBatch *one, const Left *left, int straight)
{
    const double *s = left->spread, x = sqrt(s[0] > 0 ? s[0] : 0), y = sqrt(s[2] > 0 ? s[2] : 0);
    const double ellipse[4] = {x, y, x * y > 0 ? s[1] / (x * y) : 0, 0};
    one->count = 1;
    one->u[0] = (float)left->at[0], one->v[0] = (float)left->at[1];
    for (int i = 0; i < 4; i++)
        one->spread[i][0] = (float)(straight ? s[i] : ellipse[i]);
}

/* At sharp borders, bits of axes, the image's texels go on outside, and the share of the footprint inside counts. */
static double open_border(RetexBatchTexture *t, RetexTexture *edge, const Left *left, int sharp)
{
    double share = 1;
    *edge = *t->texture;
    edge->levels[0].padded = NULL;
    edge->levels[0].padding = 0;
    t->texture = edge;
    t->padding[0] = 0;
    for (int axis = 0; axis < 2; axis++) {
        if (!(sharp & 1 << axis))
            continue;
        t->black[axis] = 0;
        edge->spec.wrap[axis] = EDGE_TEXELS;
        share *= share_below(1 - left->at[axis], t, left, axis) - share_below(-left->at[axis], t, left, axis);
    }
    return share;
}

/* How many texels of a level it has along an axis, at least. */
static double texels_along(const Left *left, const RetexBatchTexture *t, int axis, int level)
{
    const double *s = left->spread;
    return (double)t->texels[axis][level] * (double)t->spread[axis][level] *
           (t->straight ? fabs(s[axis]) + fabs(s[2 + axis]) : 4 * sqrt(fmax(s[2 * axis], 0)));
}

/* Halves the extent along the axis where it has most texels on the coarsest level. Returns the share that is left of it
 * in an image with transparent outside, which is much smaller. */
static double shorten(Left *left, const RetexBatchTexture *t)
{
    double *s = left->spread;
    const int axis = texels_along(left, t, 1, t->last) > texels_along(left, t, 0, t->last);
    if (t->straight)
        s[axis] /= 2, s[2 + axis] /= 2;
    else
        s[2 * axis] /= 4, s[1] /= 2;
    return t->black[axis] ? 0.5 : 1;
}

/* A Gaussian of which limits would leave nothing is not cut. A footprint that is too long is filtered on coarser
 * levels, and at last made shorter. */
static void filter_left(RetexTextureBatchKernel *kernel, const RetexBatchTexture *prepared, const RetexBatch *batch,
                        int k, float rgba[4])
{
    enum { STEPS = BATCH_LEVELS + 24 };
    RetexBatchTexture t = *prepared;
    RetexTexture edge;
    RetexBatch one;
    Left left;
    double share = 1;
    one.nleft = 1;
    memset(rgba, 0, 4 * sizeof *rgba);
    if (!find_left(&left, prepared, batch, k))
        return;
    place_left(&t, &left, batch, k);
    int step = 0; /* windows have up to 144 texels */
    while (step < t.last && fmax(texels_along(&left, &t, 0, step), texels_along(&left, &t, 1, step)) > 150)
        step++;
    for (; step < STEPS && one.nleft; step++) {
        const int limited = t.limited;
        t.first = step < t.last ? step : t.last;
        share *= step > t.last ? shorten(&left, &t) : 1;
        put_left(&one, &left, t.straight);
        kernel(&t, &one);
        if (one.nleft && one.sharp[0]) {
            share *= open_border(&t, &edge, &left, one.sharp[0]);
            kernel(&t, &one);
        }
        t.limited = 0;
        if (one.nleft && limited)
            kernel(&t, &one);
        t.limited = limited;
    }
    for (int c = 0; c < 4 && !one.nleft; c++)
        rgba[c] = one.rgba[0][c] * (float)share;
}

size_t retex_texture_filter_batches(RetexTextureBatchKernel *kernel, const RetexTexture *texture,
                                    RetexTextureFilter shape, const float *uv, const float *spread, int spreads,
                                    size_t n, float *colors, int channels)
{
    RetexBatchTexture prepared;
    RetexBatch batch;
    size_t from[BATCH_SIZE + 1], left = 0;
    prepare(&prepared, texture, shape);
    memset(colors, 0, n * (size_t)channels * sizeof *colors);
    for (size_t i = 0; i < n;) {
        batch.count = 0;
        for (; i < n && batch.count < BATCH_SIZE; i++) {
            const float *at = uv + 3 * i, *s = spread + (size_t)spreads * i;
            if (!(at[2] > 0))
                continue;
            from[batch.count] = i;
            if (prepared.straight)
                add_parallelogram(&batch, shape, at, s);
            else
                add_ellipse(&batch, at, s, spreads);
        }
        if (!batch.count)
            break;
        kernel(&prepared, &batch);
        for (int k = 0; k < batch.count; k++)
            unassociate(batch.rgba[k], colors + (size_t)channels * from[k], channels);
        left += (size_t)batch.nleft;
        for (int k = 0; k < batch.nleft; k++) {
            float *color = colors + (size_t)channels * from[batch.left[k]], rgba[4];
            filter_left(kernel, &prepared, &batch, batch.left[k], rgba);
            memset(color, 0, (size_t)channels * sizeof *color);
            unassociate(rgba, color, channels);
        }
    }
    return left;
}

/* A texture without what lies on it. */
static void filter_alone(const RetexTexture *texture, RetexTextureFilter shape, const float *uv, const float *spread,
                         int spreads, size_t n, float *colors, int channels)
{
    if (texture->nlevels) {
        (void)retex_texture_filter_batches(retex_texture_batch_kernels[retex_cpu_level()], texture, shape, uv, spread,
                                           spreads, n, colors, channels);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        const float color[4] = {texture->spec.color[0], texture->spec.color[1], texture->spec.color[2], 1};
        if (uv[3 * i + 2] > 0)
            memcpy(colors + (size_t)channels * i, color, (size_t)channels * sizeof *colors);
        else
            memset(colors + (size_t)channels * i, 0, (size_t)channels * sizeof *colors);
    }
}

/* Filters a layer, and lays it over the colours below. */
static void filter_over(const RetexTexture *over, RetexTextureFilter shape, const float *uv, const float *spread,
                        int spreads, size_t n, float *colors, int channels)
{
    float rgba[4 * OVER_PIXELS];
    for (size_t from = 0; from < n; from += OVER_PIXELS) {
        const size_t count = n - from < OVER_PIXELS ? n - from : OVER_PIXELS;
        filter_alone(over, shape, uv + 3 * from, spread + (size_t)spreads * from, spreads, count, rgba, 4);
        for (size_t i = 0; i < count; i++) {
            float *below = colors + (size_t)channels * (from + i);
            float color[4] = {below[0], below[1], below[2], channels == 4 ? below[3] : 1};
            if (!(uv[3 * (from + i) + 2] > 0))
                continue;
            retex_lay_over(color, rgba + 4 * i);
            memcpy(below, color, (size_t)channels * sizeof *below);
        }
    }
}

void retex_texture_filter(const RetexTexture *texture, RetexTextureFilter shape, const float *uv, const float *spread,
                          int spreads, size_t n, float *colors, int channels)
{
    for (const RetexTexture *layer = texture; layer; layer = layer->over) {
        if (layer == texture)
            filter_alone(layer, shape, uv, spread, spreads, n, colors, channels);
        else
            filter_over(layer, shape, uv, spread, spreads, n, colors, channels);
    }
}

void retex_texture_scaled_row(const RetexTexture *texture, int width, int height, int y, float *rgb)
{
    enum { PIXELS = 64 };
    float uv[3 * PIXELS], axes[4 * PIXELS];
    for (int from = 0; from < width; from += PIXELS) {
        const int count = width - from < PIXELS ? width - from : PIXELS;
        for (int x = 0; x < count; x++) {
            const float at[3] = {(float)((from + x + 0.5) / width), (float)(1 - (y + 0.5) / height), 1},
                        sides[4] = {(float)(1.0 / width), 0, 0, (float)(1.0 / height)};
            memcpy(uv + 3 * x, at, sizeof at);
            memcpy(axes + 4 * x, sides, sizeof sides);
        }
        retex_texture_filter(texture, RETEX_TEXTURE_PARALLELOGRAM, uv, axes, 4, (size_t)count, rgb + 3 * from, 3);
    }
}
