/* Weights by difference, and the reciprocals they take. Private to the kernels of denoising. */
#ifndef RETEX_DENOISE_FALLOFF_H
#define RETEX_DENOISE_FALLOFF_H

#include <stdint.h>

#include <retex/host/cpu.h>

/* Approximates exp(-x) for x >= 0; 0 from x = 8 on. */
RETEX_CPU_INLINE float denoise_falloff(float x)
{
    float y = 1 - x * 0.125f;
    y = y > 0 ? y : 0;
    y *= y, y *= y;
    return y * y;
}

/* Approximates 1 / x, by less than a thousandth of a percent, for x from 1e-37 to 1e37: a first guess by exponents, and
 * two steps of Newton's. Faster than a division, and the same to the bit in vectors of any width. */
RETEX_CPU_INLINE float denoise_reciprocal(float x)
{
    union {
        float value;
        uint32_t bits;
    } guess = {x};
    guess.bits = 0x7EF311C7u - guess.bits;
    const float y = guess.value * (2 - x * guess.value);
    return y * (2 - x * y);
}

#endif
