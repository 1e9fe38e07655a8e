/* Weights by difference. Private to the kernels of denoising. */
#ifndef RETEX_DENOISE_FALLOFF_H
#define RETEX_DENOISE_FALLOFF_H

#include <retex/host/cpu.h>

/* Approximates exp(-x) for x >= 0; 0 from x = 8 on. */
RETEX_CPU_INLINE float denoise_falloff(float x)
{
    float y = 1 - x * 0.125f;
    y = y > 0 ? y : 0;
    y *= y, y *= y;
    return y * y;
}

#endif
