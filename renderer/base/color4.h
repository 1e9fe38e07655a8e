/* Colours as four floats side by side, in what registers the machine has: for kernels. */
#ifndef RENDERER_BASE_COLOR4_H
#define RENDERER_BASE_COLOR4_H

#include <math.h>
#include <string.h>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "base/vec.h"

typedef float Float4 __attribute__((vector_size(16)));

static inline Float4 splat(float x) { return (Float4){x, x, x, x}; }
static inline Float4 load(const float *p)
{
    Float4 v;
    memcpy(&v, p, sizeof v);
    return v;
}
/* A colour, and 0. */
static inline Float4 color4(Rgb c) { return (Float4){c.r, c.g, c.b, 0}; }
static inline Rgb rgb_of4(Float4 c) { return rgb(c[0], c[1], c[2]); }
#ifdef __SSE2__
static inline int is_black4(Float4 c) { return !(_mm_movemask_ps(_mm_cmpneq_ps(c, _mm_setzero_ps())) & 7); }
#else
static inline int is_black4(Float4 c) { return c[0] == 0 && c[1] == 0 && c[2] == 0; }
#endif
static inline float luminance4(Float4 c) { return rgb_luminance(rgb_of4(c)); }
static inline Float4 root(Float4 v) { return (Float4){sqrtf(v[0]), sqrtf(v[1]), sqrtf(v[2]), sqrtf(v[3])}; }

#endif
