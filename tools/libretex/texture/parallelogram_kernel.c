/* A texture averaged evenly over a parallelogram; see even_kernel.h.
 *
 * The level is that of the ellipse with the same covariance, but the parallelogram does not shrink by the variance of
 * the level's texels: those of neighbouring pixels, and of the quarters of a pixel, adjoin. What blur takes from one it
 * gives to the next, while shrunk ones would leave gaps. */
#include "texture/even_kernel.h"

#define LEAST_LENGTH 1e-3 /* texels, of the longer axis along */

/* The outline of axes over lines: [0] along, [1] across. */
static Outline find_outline(const double along[2], const double across[2])
{
    const int longer = fabs(along[1]) > fabs(along[0]);
    const double sign[2] = {along[0] < 0 ? -1 : 1, along[1] < 0 ? -1 : 1};
    double a = fabs(along[longer]), b = fabs(along[!longer]);
    a = a > LEAST_LENGTH ? a : LEAST_LENGTH;
    Outline e = {
        .straight = 1, .length = (a + b) / 2, .inner = (a - b) / 2, .slope = sign[longer] * across[longer] / a};
    e.side = (sign[!longer] * across[!longer] - e.slope * b) / 2;
    e.half = fabs(e.side);
    return e;
}

void retex_texture_parallelogram_kernel(const RetexTexture *texture, const RetexTexelFootprint *footprint,
                                        const double sides[2][2], float rgba[4])
{
    const LevelPlace place = place_footprint(texture, footprint);
    double along[2], across[2];
    int turned;
    (void)find_ellipse(&place.rest, place.flat, &turned);
    for (int k = 0; k < 2; k++) {
        along[k] = sides[k][!turned] / place.level->scale[!turned];
        across[k] = sides[k][turned] / place.level->scale[turned];
    }
    Outline e = find_outline(along, across);
    if (place.flat[0] || place.flat[1]) /* all texels across are one */
        e.slope = e.side = e.half = 0;
    average_outline(texture, &place, &e, turned, rgba);
}
