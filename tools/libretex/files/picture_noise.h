/* The noise of a picture of which there is one render only. Private to libretex. */
#ifndef RETEX_FILES_PICTURE_NOISE_H
#define RETEX_FILES_PICTURE_NOISE_H

#include <retex/image.h>

/* Estimate the variance of each pixel and channel from the pixels around: from second differences along the direction,
 * of four, in which they are smallest, where normals and albedo agree. So that of straight edges and of even slopes is
 * not noise, but that of small detail that no guide shows is. normal and albedo may be NULL; the picture is divided by
 * the albedo before. All images have the picture's size and three channels. */
int retex_picture_estimate_variance(RetexImage *variance, const RetexImage *picture, const RetexImage *normal,
                                    const RetexImage *albedo, int nthreads, RetexError *err);

/* Replace variances by numbers drawn at random that have them, the same for all channels of a pixel but for their size.
 *
 * A pixel x with noise of variance V, and a number n drawn with variance V, make two halves x + n and x - n. Their mean
 * is x, and they are independent if the noise is Gaussian, since cov(x + n, x - n) = V - V. Each has the variance 2V,
 * as the mean of half of the samples has. So each can judge what is made of the other, as with two renders.
 * (Recorrupted-to-Recorrupted, Pang et al. 2021; coupled bootstrap, Oliveira et al. 2021.) */
void retex_picture_draw_noise(RetexImage *variance, uint32_t seed, int nthreads);

#endif
