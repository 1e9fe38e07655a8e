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

/* The texture averaged over a Gaussian of mean (u, v) and covariance {uu, uv, vv} in surface UV (before the spec's
 * transform, which is applied to both exactly). With zero covariance equals retex_texture_point. Colours are averaged
 * with alpha as their weight; rgba, unassociated. */
void retex_texture_gaussian(const RetexTexture *texture, double u, double v, const double covariance[3], float rgba[4]);

/* The same over a disc: the texture averaged evenly over the ellipse of that mean and covariance, whose half axes are
 * two standard deviations along its principal axes (a disc of radius R has the variance R^2 / 4 along each axis). A
 * footprint that a box pixel filter sees sharply is about that. Very long ellipses, of more than some forty times their
 * width, skip texels along their length. */
void retex_texture_disc(const RetexTexture *texture, double u, double v, const double covariance[3], float rgba[4]);

/* The same over the parallelogram with that middle and two sides, each a step in u and v: what a pixel sees of a
 * surface whose UV change evenly across it. */
void retex_texture_parallelogram(const RetexTexture *texture, double u, double v, const double sides[2][2],
                                 float rgba[4]);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
