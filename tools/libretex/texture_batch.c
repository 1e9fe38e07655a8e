/* Rows of footprints: those with coverage are collected, handed to the fastest kernel that this machine has, and what
 * that leaves alone is filtered one by one. */
#include "texture_batch.h"

#include <math.h>
#include <pthread.h>
#include <string.h>

#include "texture_kernel.h"

#define LEAST_ALPHA 1e-20f /* less has no colour that float could tell */
#define LITTLE 0.03f       /* of a footprint: it hardly matters where it goes */

void texture_gather_block(const RetexTexture *texture, const TextureLevel *level, int x, int y, char *texels)
{
    size_t size = texel_size(texture->narrow);
    for (int j = 0; j < 4; j++) {
        Row row = find_row(texture, level, y + j, 0);
        for (int i = 0; i < 4; i++, texels += size) {
            int at = wrap_index(x + i, level->width, texture->spec.wrap[0]);
            const char *p = NULL;
            if (row.texels)
                p = (unsigned)at < (unsigned)level->width ? row.texels + (size_t)at * size : row.beside[at > 0];
            if (p)
                memcpy(texels, p, size);
            else
                memset(texels, 0, size);
        }
    }
}

/* Only a level whose texels are about as large along both axes stands for a smaller variance of both. */
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

static void prepare(BatchTexture *t, const RetexTexture *texture, RetexTextureFilter shape)
{
    const TextureLevel *image = &texture->levels[0];
    *t = (BatchTexture){.texture = texture, .gaussian = shape == RETEX_TEXTURE_GAUSSIAN};
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
            const TextureLevel *level = &texture->levels[i];
            int alone = (axis ? level->height : level->width) == 1 && (t->period[axis] > 0 || is_flat(texture, axis));
            t->texels[axis][i] = (float)(axis ? level->height : level->width);
            t->inverse_area[2 * axis][i] = (float)(1 / (level->scale[axis] * level->scale[axis]));
            t->inverse_area[1][i] = (float)(1 / (level->scale[0] * level->scale[1]));
            t->spread[axis][i] = alone ? 0 : 1;
            for (int k = 0; k < 2; k++)
                t->blur[axis][k][i] = (float)level->blur[axis][k];
        }
    }
}

/* Gaussians are cut off where the surface ends, discs are not: see RetexTextureSpec. Along which of the surface's axes
 * there is such an end, as far as the texture is not turned against it. */
static int find_limits(const RetexTexture *texture, RetexTextureFilter shape, int limited[2])
{
    const RetexTextureSpec *spec = &texture->spec;
    limited[0] = limited[1] = 0;
    for (int axis = 0; axis < 2 && shape == RETEX_TEXTURE_GAUSSIAN; axis++) {
        int along = texture->matrix[axis][0] == 0;
        if (texture->matrix[axis][!along] == 0 && spec->uv_min[along] < spec->uv_max[along])
            limited[along] = 1;
    }
    return limited[0] || limited[1];
}

static int near_limit(const RetexTextureSpec *spec, const int limited[2], const float *uv, const float *spread)
{
    for (int axis = 0; axis < 2; axis++) {
        double reach = 3.5 * (double)spread[axis], at = (double)uv[axis];
        if (limited[axis] && (at - reach < spec->uv_min[axis] || at + reach > spec->uv_max[axis]))
            return 1;
    }
    return 0;
}

/* A normal distribution's part between low and high, both in standard deviations from its mean: its mean, and its
 * variance. Returns how much of it lies there. */
static float truncate_normal(float low, float high, float *mean, float *variance)
{
    const float root = 0.70710678f, density = 0.39894228f;
    float at_low = low > -8 ? density * expf(-0.5f * low * low) : 0;
    float at_high = high < 8 ? density * expf(-0.5f * high * high) : 0;
    float kept = 0.5f * (erff(high * root) - erff(low * root)), inverse = 1 / fmaxf(kept, 1e-6f);
    *mean = (at_low - at_high) * inverse;
    *variance = 1 + ((low > -8 ? low * at_low : 0) - (high < 8 ? high * at_high : 0)) * inverse - *mean * *mean;
    return kept;
}

/* A footprint of which little is cut off where the surface ends becomes the Gaussian that has the mean and the
 * covariance of what is left. Returns 0 for those that lose more: they need to be cut exactly. */
static int cut_footprint(const RetexTextureSpec *spec, const int limited[2], float uv[2], float spread[2],
                          float *correlation)
{
    for (int axis = 0; axis < 2; axis++) {
        float sd = spread[axis], mean, variance;
        if (!limited[axis] || !(sd > 1e-9f))
            continue;
        float low = ((float)spec->uv_min[axis] - uv[axis]) / sd, high = ((float)spec->uv_max[axis] - uv[axis]) / sd;
        if (low < -3.5f && high > 3.5f)
            continue;
        if (!(truncate_normal(low, high, &mean, &variance) > 1 - LITTLE))
            return 0;
        variance = fmaxf(variance, 0);
        /* The other axis follows as far as it is correlated. */
        float r = *correlation, other = 1 - r * r * (1 - variance);
        uv[axis] += sd * mean;
        uv[!axis] += spread[!axis] * r * mean;
        spread[axis] = sd * sqrtf(variance);
        spread[!axis] *= sqrtf(other);
        *correlation = other > 0 ? r * sqrtf(variance / other) : 0;
    }
    return 1;
}

static void filter_one(const RetexTexture *texture, RetexTextureFilter shape, const float *uv, const float *spread,
                       int spreads, float *rgba)
{
    double correlation = spreads == 3 ? (double)spread[2] : 0, u = (double)spread[0], v = (double)spread[1];
    double covariance[3] = {u * u, correlation * u * v, v * v};
    if (shape == RETEX_TEXTURE_GAUSSIAN)
        retex_texture_gaussian(texture, (double)uv[0], (double)uv[1], covariance, rgba);
    else
        retex_texture_disc(texture, (double)uv[0], (double)uv[1], covariance, rgba);
}

static TextureBatchKernel *best_kernel;

static void choose_kernel(void)
{
    TextureBatchKernel *kernels[3];
    texture_batch_kernels(kernels);
    best_kernel = kernels[0];
}

static void unassociate(const float in[4], float *out)
{
    float alpha = in[3];
    if (!(alpha > LEAST_ALPHA)) {
        memset(out, 0, 4 * sizeof *out);
        return;
    }
    float inverse = 1 / alpha;
    for (int c = 0; c < 3; c++)
        out[c] = in[c] * inverse;
    out[3] = alpha < 1 ? alpha : 1;
}

void texture_filter_batches(TextureBatchKernel *kernel, const RetexTexture *texture, RetexTextureFilter shape,
                            const float *uv, const float *spread, int spreads, size_t n, float *rgba)
{
    BatchTexture prepared;
    Batch batch;
    size_t from[BATCH_SIZE + 1];
    int limited[2], any_limit = find_limits(texture, shape, limited);
    prepare(&prepared, texture, shape);
    for (size_t i = 0; i < n;) {
        batch.count = 0;
        for (; i < n && batch.count < BATCH_SIZE; i++) {
            const float *at = uv + 3 * i, *s = spread + (size_t)spreads * i;
            if (!(at[2] > 0)) {
                memset(rgba + 4 * i, 0, 4 * sizeof *rgba);
                continue;
            }
            float mean[2] = {at[0], at[1]}, sds[2] = {s[0], s[1]}, correlation = spreads == 3 ? s[2] : 0;
            if (any_limit && near_limit(&texture->spec, limited, at, s) &&
                !cut_footprint(&texture->spec, limited, mean, sds, &correlation)) {
                filter_one(texture, shape, at, s, spreads, rgba + 4 * i);
                continue;
            }
            int k = batch.count++;
            from[k] = i;
            batch.u[k] = mean[0];
            batch.v[k] = mean[1];
            batch.su[k] = sds[0];
            batch.sv[k] = sds[1];
            batch.correlation[k] = correlation;
        }
        if (!batch.count)
            break;
        kernel(&prepared, &batch);
        for (int k = 0; k < batch.count; k++)
            unassociate(batch.rgba[k], rgba + 4 * from[k]);
        for (int k = 0; k < batch.nleft; k++) {
            size_t at = from[batch.left[k]];
            filter_one(texture, shape, uv + 3 * at, spread + (size_t)spreads * at, spreads, rgba + 4 * at);
        }
    }
}

void retex_texture_filter(const RetexTexture *texture, RetexTextureFilter shape, const float *uv, const float *spread,
                          int spreads, size_t n, float *rgba)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, choose_kernel);
    if (texture->nlevels) {
        texture_filter_batches(best_kernel, texture, shape, uv, spread, spreads, n, rgba);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        const float color[4] = {texture->spec.color[0], texture->spec.color[1], texture->spec.color[2], 1};
        if (uv[3 * i + 2] > 0)
            memcpy(rgba + 4 * i, color, sizeof color);
        else
            memset(rgba + 4 * i, 0, sizeof color);
    }
}
