/* A matrix times the colours of a row: see develop.h. */
#include "retexture/develop.h"

#include <float.h>

/* NaN, of infinities of both signs, becomes the lowest. */
static inline float limited(float value)
{
    value = value > -FLT_MAX ? value : -FLT_MAX;
    return value < FLT_MAX ? value : FLT_MAX;
}

void retex_develop_kernel(const RetexDeveloper *developer, float *rgb, size_t pixels)
{
    const float (*m)[3] = developer->matrix;
    for (size_t i = 0; i < pixels; i++, rgb += 3) {
        const float r = rgb[0], g = rgb[1], b = rgb[2];
        for (int c = 0; c < 3; c++)
            rgb[c] = limited(m[c][0] * r + m[c][1] * g + m[c][2] * b);
    }
}
