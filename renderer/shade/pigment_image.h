/* Images in pigments. */
#ifndef RENDERER_SHADE_PIGMENT_IMAGE_H
#define RENDERER_SHADE_PIGMENT_IMAGE_H

#include "pattern/pattern.h"

/* UV of an image_map's projection at a point of pattern space: planar, spherical, cylindrical or toroidal. */
Vec2 pigment_image_uv(const ImageMap *image, Vec3 pattern_point);
/* 1 where the point lies outside an image_map with `once`. */
int image_is_outside(const ImageMap *image, Vec2 uv);
/* Of texel i of n in a row or a column: images repeat, those with `once` go on with their edges. */
static inline int image_texel(const ImageMap *image, int i, int n)
{
    if (image->once)
        return i < 0 ? 0 : i < n ? i : n - 1;
    return (i %= n) < 0 ? i + n : i;
}
/* The colour of the pigment's image at the image's own UV, with its alpha and `filter all` and `transmit all`. */
Rgbft image_lookup(const Pigment *pigment, Vec2 uv);

#endif
