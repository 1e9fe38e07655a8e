/* See sample_row.h. */
#include "sample_row.h"

#include <math.h>
#include <string.h>

typedef void Filter(const RetexTexture *texture, double u, double v, const double covariance[3], float rgba[4]);

int footprint_is_even(const RetexSet *set, const RetexFootprint *footprint)
{
    return footprint->kind == RETEX_FOOTPRINT_SHARP && strcmp(set->filter, "box") == 0;
}

static void footprint_covariance(const FootprintRow *row, int x, double covariance[3])
{
    const float *spread = row->spread + (size_t)row->spreads * (size_t)x;
    double correlation = row->spreads == 3 ? spread[2] : 0;
    covariance[0] = (double)spread[0] * spread[0];
    covariance[1] = correlation * spread[0] * spread[1];
    covariance[2] = (double)spread[1] * spread[1];
}

void sample_row(const RetexTexture *texture, int even, const FootprintRow *row, float *restrict rgb)
{
    Filter *filter = even ? retex_texture_disc : retex_texture_gaussian;
    for (int x = 0; x < row->width; x++, rgb += 3) {
        const float *uv = row->uv + 3 * (size_t)x, *albedo = row->albedo + 3 * (size_t)x;
        double covariance[3];
        float rgba[4];
        if (!(uv[2] > 0)) {
            rgb[0] = rgb[1] = rgb[2] = 0;
            continue;
        }
        footprint_covariance(row, x, covariance);
        filter(texture, uv[0], uv[1], covariance, rgba);
        for (int c = 0; c < 3; c++)
            rgb[c] = rgba[c] * rgba[3] + (1 - rgba[3]) * albedo[c];
    }
}

void variance_row(const RetexTexture *texture, const RetexTexture *square, int even, const FootprintRow *row,
                  float *restrict rgb)
{
    Filter *filter = even ? retex_texture_disc : retex_texture_gaussian;
    for (int x = 0; x < row->width; x++, rgb += 3) {
        const float *uv = row->uv + 3 * (size_t)x;
        double covariance[3];
        float mean[4], squares[4];
        rgb[0] = rgb[1] = rgb[2] = 0;
        if (!(uv[2] > 0))
            continue;
        footprint_covariance(row, x, covariance);
        filter(texture, uv[0], uv[1], covariance, mean);
        filter(square, uv[0], uv[1], covariance, squares);
        for (int c = 0; c < 3; c++)
            rgb[c] = fmaxf(squares[c] - mean[c] * mean[c], 0) * mean[3] * mean[3];
    }
}
