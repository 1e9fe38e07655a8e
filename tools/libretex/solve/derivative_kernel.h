/* Products of rows and their derivatives. n: numbers of the rows. Private to libretex. */
#ifndef RETEX_SOLVE_DERIVATIVE_KERNEL_H
#define RETEX_SOLVE_DERIVATIVE_KERNEL_H

#include <stddef.h>

/* derivative = derivative * factor + value * slope, the derivative of value * factor. */
void retex_derivative_multiply(float *restrict derivative, const float *restrict value, const float *restrict factor,
                               const float *restrict slope, size_t n);
/* value *= factor. */
void retex_row_multiply(float *restrict value, const float *restrict factor, size_t n);
/* slope = (ahead - here) * scale; here NULL: 0. */
void retex_row_slope(float *restrict slope, const float *restrict ahead, const float *restrict here, float scale,
                     size_t n);
/* sum += weight * value, weight by channel. */
void retex_row_add(float *restrict sum, const float *restrict value, const float weight[3], size_t n);

#endif
