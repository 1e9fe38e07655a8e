/* Conversion between float and the 16-bit half of OpenEXR (IEEE 754 binary16). */
#ifndef RETEX_BASE_HALF_H
#define RETEX_BASE_HALF_H

#include <stddef.h>
#include <stdint.h>

/* Round to nearest, ties to even; subnormals are kept; infinities and NaN stay what they are; a finite value too large
 * becomes the largest half, 65504, of its sign, so that a bright pixel never turns into an infinite one. */
void retex_half_from_float(uint16_t *restrict dst, const float *restrict src, size_t count);
void retex_half_to_float(float *restrict dst, const uint16_t *restrict src, size_t count);

/* The same in plain C: what the two above run where the processor has no instruction for it, and what tests compare
 * them with. */
void retex_half_from_float_scalar(uint16_t *restrict dst, const float *restrict src, size_t count);
void retex_half_to_float_scalar(float *restrict dst, const uint16_t *restrict src, size_t count);

#endif
