/* Fireflies: single paths so bright that one pixel's mean is far from those around it. Private to libretex. */
#ifndef RETEX_DENOISE_FIREFLIES_H
#define RETEX_DENOISE_FIREFLIES_H

#include "denoise/denoise_kernel.h"

/* Lower the fireflies of a tile and of the pixels around it. A half of a pixel is one if it is more than twice as
 * bright as the pixel's other half and as all but two halves of the pixels of its kind within 5 pixels. It becomes
 * twice the third largest of these, where that is more than the other half. Brightness is the sum over colours. stays:
 * by pixel, the share of each half that stays, 1 for most. unknown: where the other half is less than this share of the
 * firefly, rounding of the noise may have made it; if it is brighter than the limit it is lowered, too. */
void retex_denoise_lower_fireflies(float *half[2][3], float *stays[2], const float *kind, const float *valid,
                                   float unknown);

/* Of noise that is rounded to two bits, which makes a half of nothing up to a ninth of the other one. */
#define DENOISE_UNKNOWN_HALF 0.125f

#endif
