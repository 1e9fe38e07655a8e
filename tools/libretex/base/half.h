/* See <retex/host/half.h>. */
#ifndef RETEX_BASE_HALF_H
#define RETEX_BASE_HALF_H

#include <retex/host/half.h>

/* Scalar versions: used where the processor has no instruction for the conversion, and as the tests' reference. */
void retex_half_from_float_scalar(uint16_t *restrict dst, const float *restrict src, size_t count);
void retex_half_to_float_scalar(float *restrict dst, const uint16_t *restrict src, size_t count);

#endif
