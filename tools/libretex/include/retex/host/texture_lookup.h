/* Single look-ups of textures: for renderers that show a texture, and for references of what sets give. All are
 * thread-safe. */
#ifndef RETEX_HOST_TEXTURE_LOOKUP_H
#define RETEX_HOST_TEXTURE_LOOKUP_H

#include <retex/texture.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* One point, bilinear between texel centres, after the spec's UV transform and wraps: rgba, unassociated alpha.
 * `wrap=black` gives (0,0,0,0) outside [0,1]. --replace and a pigment's interpolated image_map use it. */
void retex_texture_point(const RetexTexture *texture, double u, double v, float rgba[4]);

/* The weights of the target's finishes at a point, bilinear too, where the texture has a map of them; they sum to 1,
 * and where it is transparent finish `shown` has the rest. Returns their number, 0 where it has no map. Of a normal map
 * they have either sign, and the fourth is of a finish that is black. */
int retex_texture_finishes(const RetexTexture *texture, double u, double v, int shown, float weights[4]);

/* Prefetch the memory of a point that will be looked up soon. */
void retex_texture_prefetch(const RetexTexture *texture, double u, double v);

/* One point without interpolation: the texel that (u, v) falls in, floor(u * width) from the left, floor((1 - v) *
 * height) from the top, after the same transform and wraps. A pigment's image_map without `interpolate` uses it. */
void retex_texture_nearest(const RetexTexture *texture, double u, double v, float rgba[4]);

/* Row y of the image itself, from the top, without transform or wraps: red, green and blue of each texel, multiplied by
 * alpha. The texture must have an image. */
void retex_texture_row(const RetexTexture *texture, int y, float *rgb);

/* Row y of the image scaled to that size: red, green and blue of each pixel, the texture's mean over its area, not
 * multiplied by alpha. */
void retex_texture_scaled_row(const RetexTexture *texture, int width, int height, int y, float *rgb);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
