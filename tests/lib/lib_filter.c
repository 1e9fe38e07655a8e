/* From footprints in UV to those in texels, and layers. See lib_filter.h. */
#include "lib_filter.h"

#include <retex/host/texture_lookup.h>

#include "lib_filter_texels.h"
#include "texture/lay.h"
#include "texture/layer.h"

#define LEAST_ALPHA 1e-20f /* alpha below this has no colour that a float can hold */
/* A footprint of a thousand repeats gives the average, whatever its size; larger sizes only lose digits. */
#define MAX_FOOTPRINT 1000.0

/* The mean of a footprint in texture UV. 0 where it is not finite. */
static int texture_uv(const RetexTexture *texture, double u, double v, double uv[2])
{
    for (int i = 0; i < 2; i++)
        uv[i] = texture->matrix[i][0] * u + texture->matrix[i][1] * v + texture->offset[i];
    return isfinite(uv[0]) && isfinite(uv[1]);
}

/* The covariance in texels of the image, y down: M C M^T, scaled. Returns 0 where it is 0. */
static int texel_covariance(const RetexTexture *texture, const double c[3], TexelFootprint *f)
{
    const double(*m)[2] = texture->matrix;
    double width = texture->levels[0].width, height = texture->levels[0].height;
    double uu = c[0] > 0 ? c[0] : 0, vv = c[2] > 0 ? c[2] : 0, uv = c[1];
    if (!isfinite(uu) || !isfinite(vv) || !isfinite(uv))
        return 0;
    double largest = sqrt(uu * vv); /* a larger covariance is impossible; rounding may cause it */
    uv = uv > largest ? largest : uv < -largest ? -largest : uv;
    double xx = m[0][0] * m[0][0] * uu + 2 * m[0][0] * m[0][1] * uv + m[0][1] * m[0][1] * vv;
    double xy = m[0][0] * m[1][0] * uu + (m[0][0] * m[1][1] + m[0][1] * m[1][0]) * uv + m[0][1] * m[1][1] * vv;
    double yy = m[1][0] * m[1][0] * uu + 2 * m[1][0] * m[1][1] * uv + m[1][1] * m[1][1] * vv;
    double limit = MAX_FOOTPRINT * MAX_FOOTPRINT;
    if (!isfinite(xx + yy) || !isfinite(xy)) { /* a scale may be near the largest double */
        xx = yy = limit / 2;
        xy = 0;
    }
    double shrink = xx + yy > limit ? limit / (xx + yy) : 1;
    f->xx = xx * shrink * width * width;
    f->xy = -xy * shrink * width * height;
    f->yy = yy * shrink * height * height;
    return f->xx > 0 || f->yy > 0;
}

static void unassociate(float rgba[4])
{
    if (!(rgba[3] > LEAST_ALPHA)) {
        rgba[0] = rgba[1] = rgba[2] = rgba[3] = 0;
        return;
    }
    float inverse = 1 / rgba[3];
    for (int c = 0; c < 3; c++)
        rgba[c] *= inverse;
    if (rgba[3] > 1)
        rgba[3] = 1; /* sums of weights have rounding errors */
}

typedef void Filter(const RetexTexture *texture, const TexelFootprint *footprint, float rgba[4]);

/* The limits of the surface from (u, v), along those axes of the texture that are parallel to one of its own. */
static void set_limits(const RetexTexture *texture, const double at[2], TexelFootprint *f)
{
    const RetexTextureSpec *spec = &texture->spec;
    const double texels[2] = {texture->levels[0].width, -(double)texture->levels[0].height}; /* y goes down */
    for (int axis = 0; axis < 2; axis++) {
        const double *m = texture->matrix[axis];
        int along = m[0] == 0;
        f->low[axis] = -INFINITY, f->high[axis] = INFINITY;
        if (m[!along] != 0 || !(spec->uv_min[along] < spec->uv_max[along]))
            continue;
        double share = m[along] * texels[axis], a = (spec->uv_min[along] - at[along]) * share,
               b = (spec->uv_max[along] - at[along]) * share;
        f->low[axis] = a < b ? a : b;
        f->high[axis] = a < b ? b : a;
    }
}

/* Finds the footprint in the image; 0 where it is no area: then rgba is the colour. */
static int find_footprint(const RetexTexture *texture, double u, double v, const double covariance[3],
                          TexelFootprint *footprint, float rgba[4])
{
    double uv[2];
    if (texture->nlevels && texture_uv(texture, u, v, uv) && texel_covariance(texture, covariance, footprint)) {
        footprint->x = uv[0] * texture->levels[0].width;
        footprint->y = (1 - uv[1]) * texture->levels[0].height;
        set_limits(texture, (const double[2]){u, v}, footprint);
        return 1;
    }
    RetexTexture alone = *texture;
    alone.over = NULL;
    retex_texture_point(&alone, u, v, rgba);
    return 0;
}

static void filter_at(const RetexTexture *texture, double u, double v, const double covariance[3], Filter *filter,
                      float rgba[4])
{
    TexelFootprint footprint;
    if (find_footprint(texture, u, v, covariance, &footprint, rgba)) {
        filter(texture, &footprint, rgba);
        unassociate(rgba);
    }
    if (texture->over) {
        float over[4];
        filter_at(texture->over, u, v, covariance, filter, over);
        retex_lay_over(rgba, over);
    }
}

void filter_gaussian(const RetexTexture *texture, double u, double v, const double covariance[3], float rgba[4])
{
    filter_at(texture, u, v, covariance, filter_texels_gaussian, rgba);
}

void filter_disc(const RetexTexture *texture, double u, double v, const double covariance[3], float rgba[4])
{
    filter_at(texture, u, v, covariance, filter_texels_disc, rgba);
}

/* A footprint that is too large has been made smaller: its sides follow. */
static void limit_sides(const TexelFootprint *f, double sides[2][2])
{
    const double most = sqrt(12 * (f->xx + f->yy)) * (1 + 1e-9);
    for (int k = 0; k < 2; k++) {
        const double length = hypot(sides[k][0], sides[k][1]);
        for (int i = 0; i < 2 && length > most; i++)
            sides[k][i] = isfinite(length) ? sides[k][i] * (most / length) : 0;
    }
}

void filter_parallelogram(const RetexTexture *texture, double u, double v, const double axes[2][2],
                                 float rgba[4])
{
    const double texels[2] = {texture->levels[0].width, -(double)texture->levels[0].height}; /* y goes down */
    double covariance[3] = {0}, sides[2][2];
    TexelFootprint footprint;
    for (int k = 0; k < 2; k++) {
        covariance[0] += axes[k][0] * axes[k][0] / 12;
        covariance[1] += axes[k][0] * axes[k][1] / 12;
        covariance[2] += axes[k][1] * axes[k][1] / 12;
        for (int i = 0; i < 2; i++)
            sides[k][i] = (texture->matrix[i][0] * axes[k][0] + texture->matrix[i][1] * axes[k][1]) * texels[i];
    }
    if (find_footprint(texture, u, v, covariance, &footprint, rgba)) {
        limit_sides(&footprint, sides);
        filter_texels_parallelogram(texture, &footprint, sides, rgba);
        unassociate(rgba);
    }
    if (texture->over) {
        float over[4];
        filter_parallelogram(texture->over, u, v, axes, over);
        retex_lay_over(rgba, over);
    }
}
