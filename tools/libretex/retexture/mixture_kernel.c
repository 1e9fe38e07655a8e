/* See mixture_kernel.h. Loops work on four pixels, twelve values, at a time. */
#include "retexture/mixture_kernel.h"

#include <stddef.h>

#include "base/float4.h"

typedef int Int4 __attribute__((vector_size(16)));

static inline void store4(float *p, RetexFloat4 v)
{
    memcpy(p, &v, sizeof v);
}

/* Repeats the values of four pixels for each of their three colours. */
static inline void spread4(RetexFloat4 v, RetexFloat4 out[3])
{
    out[0] = (RetexFloat4){v[0], v[0], v[0], v[1]};
    out[1] = (RetexFloat4){v[1], v[1], v[2], v[2]};
    out[2] = (RetexFloat4){v[2], v[3], v[3], v[3]};
}

void retex_mixture_add(float *restrict sum, float *restrict weights, const float *restrict w,
                       const float *restrict factor, int width)
{
    int i = 0;
    for (; i + 4 <= width; i += 4) {
        const RetexFloat4 share = load4(w + i);
        RetexFloat4 shares[3];
        store4(weights + i, load4(weights + i) + share);
        spread4(share, shares);
        for (int k = 0; factor && k < 3; k++) {
            float *s = sum + 3 * i + 4 * k;
            store4(s, load4(s) + shares[k] * load4(factor + 3 * i + 4 * k));
        }
    }
    for (; i < width; i++) {
        weights[i] += w[i];
        for (int c = 0; factor && c < 3; c++)
            sum[3 * i + c] += w[i] * factor[3 * i + c];
    }
}

void retex_mixture_divide(float *restrict sum, const float *restrict weights, int width)
{
    int i = 0;
    for (; i + 4 <= width; i += 4) {
        RetexFloat4 all[3];
        spread4(load4(weights + i), all);
        for (int k = 0; k < 3; k++) {
            float *s = sum + 3 * i + 4 * k;
            store4(s, (RetexFloat4)((Int4)(load4(s) / all[k]) & (all[k] > 0)));
        }
    }
    for (; i < width; i++)
        for (int c = 0; c < 3; c++)
            sum[3 * i + c] = weights[i] > 0 ? sum[3 * i + c] / weights[i] : 0;
}

void retex_mixture_add_colors(float *restrict sum, float *restrict weights, const float *restrict w, int channels,
                              const float *restrict factor, int width)
{
    size_t step = channels == 3;
    for (size_t i = 0; i < (size_t)width && !factor; i++)
        for (size_t c = 0; c < 3; c++)
            weights[3 * i + c] += w[step ? 3 * i + c : i];
    if (!factor)
        return;
    for (size_t i = 0; i < (size_t)width; i++)
        for (size_t c = 0; c < 3; c++) {
            float share = w[step ? 3 * i + c : i];
            weights[3 * i + c] += share;
            sum[3 * i + c] += share * factor[3 * i + c];
        }
}

void retex_mixture_divide_colors(float *restrict sum, const float *restrict weights, int width)
{
    for (int i = 0; i < width; i++, sum += 3, weights += 3) {
        float all = weights[0] + weights[1] + weights[2], mean = all > 0 ? (sum[0] + sum[1] + sum[2]) / all : 0;
        for (int c = 0; c < 3; c++)
            sum[c] = weights[c] > 0 ? sum[c] / weights[c] : mean;
    }
}
