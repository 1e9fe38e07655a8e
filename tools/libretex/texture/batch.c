/* Filters rows of footprints. Footprints with coverage are collected and given to the fastest kernel that the processor
 * can run; those that the kernel does not filter are filtered one by one. */
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
    t->levels = count_levels(texture);
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
        for (int i = 0; i < t->levels; i++) {
            const RetexTextureLevel *level = &texture->levels[i];
            int alone = (axis ? level->height : level->width) == 1 && (t->period[axis] > 0 || is_flat(texture, axis));
            t->texels[axis][i] = (float)(axis ? level->height : level->width);
            t->inverse_area[2 * axis][i] = (float)(1 / (level->scale[axis] * level->scale[axis]));
            t->inverse_area[1][i] = (float)(1 / (level->scale[0] * level->scale[1]));
            t->spread[axis][i] = alone ? 0 : 1;
            for (int k = 0; k < 2; k++)
                t->blur[axis][k][i] = (float)level->blur[axis][k];
            t->padding[i] = (float)level->padding;
        }
        t->limits[axis] = find_limit(texture, t, axis);
        t->limited |= t->limits[axis].along >= 0;
    }
}

static void filter_parallelogram(const RetexTexture *texture, RetexTextureFilter shape, const float *uv,
                                 const float *axes, float *rgba)
{
    const RetexParallelogram p = retex_parallelogram(shape, uv, axes);
    const double sides[2][2] = {{(double)p.sides[0], (double)p.sides[1]}, {(double)p.sides[2], (double)p.sides[3]}};
    retex_texture_parallelogram(texture, (double)p.uv[0], (double)p.uv[1], sides, rgba);
}

static void filter_one(const RetexTexture *texture, RetexTextureFilter shape, const float *uv, const float *spread,
                       int spreads, float *rgba)
{
    if (shape >= RETEX_TEXTURE_PARALLELOGRAM) {
        filter_parallelogram(texture, shape, uv, spread, rgba);
        return;
    }
    double correlation = spreads == 3 ? (double)spread[2] : 0, u = (double)spread[0], v = (double)spread[1];
    double covariance[3] = {u * u, correlation * u * v, v * v};
    if (shape == RETEX_TEXTURE_DISC)
        retex_texture_disc(texture, (double)uv[0], (double)uv[1], covariance, rgba);
    else
        retex_texture_gaussian(texture, (double)uv[0], (double)uv[1], covariance, rgba);
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
            size_t at = from[batch.left[k]];
            float rgba[4];
            filter_one(texture, shape, uv + 3 * at, spread + (size_t)spreads * at, spreads, rgba);
            memcpy(colors + (size_t)channels * at, rgba, (size_t)channels * sizeof *colors);
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
    if (!texture->over) {
        filter_alone(texture, shape, uv, spread, spreads, n, colors, channels);
        return;
    }
    for (const RetexTexture *layer = texture; layer; layer = layer->over) {
        RetexTexture alone = *layer; /* some footprints are filtered one by one, with what lies on the texture */
        alone.over = NULL;
        if (layer == texture)
            filter_alone(&alone, shape, uv, spread, spreads, n, colors, channels);
        else
            filter_over(&alone, shape, uv, spread, spreads, n, colors, channels);
    }
}
