/* Conversion between float and the 16-bit half of OpenEXR (IEEE 754 binary16). */
#ifndef RETEX_HOST_HALF_H
#define RETEX_HOST_HALF_H

#include <stddef.h>
#include <stdint.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* src and dst do not overlap. Rounds to nearest, ties to even; subnormals are kept; infinities and NaN stay as they
 * are. A finite value too large for a half becomes the largest half, 65504, with its sign, so that a bright pixel never
 * becomes infinite. */
void retex_half_from_float(uint16_t *dst, const float *src, size_t count);
void retex_half_to_float(float *dst, const uint16_t *src, size_t count);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
