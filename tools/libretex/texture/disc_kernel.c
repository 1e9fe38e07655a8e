/* The disc: a texture averaged evenly over an ellipse; see even_kernel.h. */
#include "texture/even_kernel.h"

void retex_texture_disc_kernel(const RetexTexture *texture, const RetexTexelFootprint *footprint, float rgba[4])
{
    const LevelPlace place = place_footprint(texture, footprint);
    int turned;
    Outline e = find_ellipse(&place.rest, place.flat, &turned);
    average_outline(texture, &place, &e, turned, rgba);
}
