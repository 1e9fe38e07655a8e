/* How noisy a picture is, by itself. Private to libretex. */
#ifndef RETEX_COMPACT_IMAGE_NOISE_H
#define RETEX_COMPACT_IMAGE_NOISE_H

#include <retex/image.h>

/* Standard deviation of noise, in levels, of which the image's values have so many to 1; of pixels above 0. What is no
 * finer than a few pixels it does not see. */
double retex_image_noise(const RetexImage *image, double levels);

/* So many times what it finds in denoised images is all that denoising leaves, roughly. */
#define RETEX_DENOISED_NOISE 10

#endif
