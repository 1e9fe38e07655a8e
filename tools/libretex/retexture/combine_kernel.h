/* The inner loops of recombination. Private to libretex. */
#ifndef RETEX_RETEXTURE_COMBINE_KERNEL_H
#define RETEX_RETEXTURE_COMBINE_KERNEL_H

#include <stddef.h>

/* sum[i] += radiance[i] * product of factors[k][i], for n values. Nothing may overlap sum. */
void retex_combine_term_kernel(float *restrict sum, const float *restrict radiance, const float *const *factors,
                               int nfactors, size_t n);

/* sum[i] += weight[i % 3] * radiance[i], for n pixels of three values. */
void retex_combine_add_weighted(float *restrict sum, const float *restrict radiance, const float weight[3], size_t n);

#endif
