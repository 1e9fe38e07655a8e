/* Textures filtered over one footprint at a time: the reference of texture/batch_kernel.c, with other levels of the
 * pyramid and other sums. */
#ifndef LIB_FILTER_H
#define LIB_FILTER_H

#include <retex/texture.h>

/* The texture averaged over a Gaussian of mean (u, v) and covariance {uu, uv, vv} in surface UV (before the spec's
 * transform, which is applied to both exactly). With zero covariance equals retex_texture_point. Colours are averaged
 * with alpha as their weight; rgba, unassociated. */
void filter_gaussian(const RetexTexture *texture, double u, double v, const double covariance[3], float rgba[4]);

/* The same over a disc: the texture averaged evenly over the ellipse of that mean and covariance, whose half axes are
 * two standard deviations along its principal axes (a disc of radius R has the variance R^2 / 4 along each axis). A
 * footprint that a box pixel filter sees sharply is about that. Very long ellipses, of more than some forty times their
 * width, skip texels along their length. */
void filter_disc(const RetexTexture *texture, double u, double v, const double covariance[3], float rgba[4]);

/* The same over the parallelogram with that middle and two sides, each a step in u and v: what a pixel sees of a
 * surface whose UV change evenly across it. */
void filter_parallelogram(const RetexTexture *texture, double u, double v, const double sides[2][2],
                                 float rgba[4]);

#endif
