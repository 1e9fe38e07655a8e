/* An estimate of a picture's noise from its pixels alone. Private to libretex. */
#ifndef RETEX_COMPACT_IMAGE_NOISE_H
#define RETEX_COMPACT_IMAGE_NOISE_H

#include <retex/image.h>

/* Standard deviation of the noise of pixels above 0, in levels, `levels` of which are 1. Noise that is correlated over
 * several pixels is not seen. */
double retex_image_noise(const RetexImage *image, double levels);

/* Rough ratio of all noise that denoising leaves to what retex_image_noise sees of it. */
#define RETEX_DENOISED_NOISE 10

#endif
