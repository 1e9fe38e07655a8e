/* Conversion between float and the 16-bit half of OpenEXR (IEEE 754 binary16). */
#ifndef RETEX_BASE_HALF_H
#define RETEX_BASE_HALF_H

#include <stddef.h>
#include <stdint.h>

/* Rounds to nearest, ties to even; subnormals are kept; infinities and NaN stay as they are. A finite value too large
 * for a half becomes the largest half, 65504, with its sign, so that a bright pixel never becomes infinite. */
void retex_half_from_float(uint16_t *restrict dst, const float *restrict src, size_t count);
void retex_half_to_float(float *restrict dst, const uint16_t *restrict src, size_t count);

/* Scalar versions: used where the processor has no instruction for the conversion, and as the tests' reference. */
void retex_half_from_float_scalar(uint16_t *restrict dst, const float *restrict src, size_t count);
void retex_half_to_float_scalar(float *restrict dst, const uint16_t *restrict src, size_t count);

#endif
