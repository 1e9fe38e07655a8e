/* The picture with the noise that a set's parts of noise tell. Private to libretex. */
#ifndef RETEX_SET_NOISE_H
#define RETEX_SET_NOISE_H

#include <retex/set.h>

/* Add the noise of the signals to rows y0 <= y < y1 of the picture, RGB interleaved. The noise of a target counts half,
 * as if its albedo were 1/2. A set without parts of noise adds nothing. */
int retex_set_add_noise(float *rows, const RetexSet *set, int y0, int y1, RetexError *err);

#endif
