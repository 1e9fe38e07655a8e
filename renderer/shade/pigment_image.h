/* Images in pigments; private to pigment*.c. */
#ifndef RENDERER_SHADE_PIGMENT_IMAGE_H
#define RENDERER_SHADE_PIGMENT_IMAGE_H

#include "shade/pigment.h"

/* 1 where the point lies outside an image_map with `once`. */
int image_is_outside(const ImageMap *image, Vec2 uv);
/* The colour of the pigment's image at the image's own UV, with its alpha and `filter all` and `transmit all`. */
Rgbft image_lookup(const Pigment *pigment, Vec2 uv);
/* The pigment's colour at a point of its pattern space, scene-linear. */
Rgbft pigment_pattern(const Pigment *pigment, const PatternPoint *at, Vec2 uv);

#endif
