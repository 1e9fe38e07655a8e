/* Adds one term of the polynomial over a span. All images are interleaved in the same way, so that colours need not be
 * told apart: a span of n pixels is 3 n values. Vectors of four, which every x86-64 and ARM processor has; the loops
 * are limited by memory, not by arithmetic. */
#include "retexture/combine_kernel.h"

#include <string.h>

#include "base/float4.h"

static inline void add4(float *p, RetexFloat4 v)
{
    v += load4(p);
    memcpy(p, &v, sizeof v);
}

void retex_combine_term_kernel(float *restrict sum, const float *restrict radiance, const float *const *factors,
                               int nfactors, size_t n)
{
    size_t i = 0;
    switch (nfactors) { /* the common cases without an inner loop */
    case 0:
        for (; i + 4 <= n; i += 4)
            add4(sum + i, load4(radiance + i));
        break;
    case 1:
        for (const float *a = factors[0]; i + 4 <= n; i += 4)
            add4(sum + i, load4(radiance + i) * load4(a + i));
        break;
    case 2:
        for (const float *a = factors[0], *b = factors[1]; i + 4 <= n; i += 4)
            add4(sum + i, load4(radiance + i) * load4(a + i) * load4(b + i));
        break;
    default:
        for (; i + 4 <= n; i += 4) {
            RetexFloat4 product = load4(radiance + i);
            for (int k = 0; k < nfactors; k++)
                product *= load4(factors[k] + i);
            add4(sum + i, product);
        }
    }
    for (; i < n; i++) {
        float product = radiance[i];
        for (int k = 0; k < nfactors; k++)
            product *= factors[k][i];
        sum[i] += product;
    }
}

void retex_combine_add_weighted(float *restrict sum, const float *restrict radiance, const float weight[3], size_t n)
{
    for (size_t i = 0; i < n; i++)
        for (size_t c = 0; c < 3; c++)
            sum[3 * i + c] += weight[c] * radiance[3 * i + c];
}
