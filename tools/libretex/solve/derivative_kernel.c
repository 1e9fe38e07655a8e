/* See derivative_kernel.h. */
#include "solve/derivative_kernel.h"

void retex_derivative_multiply(float *restrict derivative, const float *restrict value, const float *restrict factor,
                               const float *restrict slope, size_t n)
{
    for (size_t i = 0; i < n; i++)
        derivative[i] = derivative[i] * factor[i] + value[i] * slope[i];
}

void retex_row_multiply(float *restrict value, const float *restrict factor, size_t n)
{
    for (size_t i = 0; i < n; i++)
        value[i] *= factor[i];
}

void retex_row_slope(float *restrict slope, const float *restrict ahead, const float *restrict here, float scale,
                     size_t n)
{
    for (size_t i = 0; i < n; i++)
        slope[i] = (ahead[i] - (here ? here[i] : 0)) * scale;
}

void retex_row_add(float *restrict sum, const float *restrict value, const float weight[3], size_t n)
{
    const float red = weight[0], green = weight[1], blue = weight[2];
    for (size_t i = 0; i + 2 < n; i += 3) {
        sum[i] += red * value[i];
        sum[i + 1] += green * value[i + 1];
        sum[i + 2] += blue * value[i + 2];
    }
}
