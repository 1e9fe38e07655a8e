/* See planes_kernel.h. */
#include "denoise/planes_kernel.h"

#include <string.h>

#include <retex/host/cpu.h>

RETEX_CPU_INLINE void add_body(float *restrict plane, float *restrict total, const float *restrict values, float weight)
{
    for (int i = 0; i < DENOISE_PLANE; i++)
        plane[i] += values[i], total[i] += weight * values[i];
}

RETEX_CPU_INLINE float limit(float x, float least, float most)
{
    x = x < least ? least : x;
    return x > most ? most : x;
}

RETEX_CPU_INLINE void split_body(float *restrict first, float *restrict second, const float *restrict modulation,
                                 const float *restrict noise, const float *restrict weights, int limited)
{
    const float a = weights[0], b = weights[1];
    for (int i = 0; i < DENOISE_PLANE && limited; i++) {
        const float total = first[i] / modulation[i], light = total > 0 ? total : 0,
                    differs = limit(noise[i] / modulation[i], -light / a, light / b);
        first[i] = total + a * differs, second[i] = total - b * differs;
    }
    for (int i = 0; i < DENOISE_PLANE && !limited; i++) {
        const float total = first[i] / modulation[i], differs = noise[i] / modulation[i];
        first[i] = total + a * differs, second[i] = total - b * differs;
    }
}

/* Replaces a plane by its mean over 5x5 pixels. */
RETEX_CPU_INLINE void smooth(float *restrict plane, float *restrict spare)
{
    for (int i = 2; i < DENOISE_PLANE - 2; i++)
        spare[i] = 0.2f * (plane[i - 2] + plane[i - 1] + plane[i] + plane[i + 1] + plane[i + 2]);
    for (int i = 2 * DENOISE_PITCH + 2; i < DENOISE_PLANE - 2 * DENOISE_PITCH - 2; i++)
        plane[i] = 0.2f * (spare[i - 2 * DENOISE_PITCH] + spare[i - DENOISE_PITCH] + spare[i] +
                           spare[i + DENOISE_PITCH] + spare[i + 2 * DENOISE_PITCH]);
}

RETEX_CPU_INLINE void variance_body(float *restrict variance, const float *restrict first, const float *restrict second,
                                    float *restrict spare)
{
    for (int i = 0; i < DENOISE_PLANE; i++)
        variance[i] = 0.5f * (first[i] - second[i]) * (first[i] - second[i]);
    smooth(variance, spare);
}

RETEX_CPU_INLINE void gradient_body(float *restrict strict, float *restrict loose, const float *restrict f)
{
    for (int y = 1; y < DENOISE_ROWS - 1; y++)
        for (int i = y * DENOISE_PITCH + 1; i < (y + 1) * DENOISE_PITCH - 1; i++) {
            float l = f[i] - f[i - 1], r = f[i + 1] - f[i], u = f[i] - f[i - DENOISE_PITCH],
                  d = f[i + DENOISE_PITCH] - f[i];
            l *= l, r *= r, u *= u, d *= d;
            strict[i] += (l < r ? l : r) + (u < d ? u : d);
            loose[i] += (l > r ? l : r) + (u > d ? u : d);
        }
}

RETEX_CPU_INLINE void invert_body(float *restrict plane, float least, float factor)
{
    for (int i = 0; i < DENOISE_PLANE; i++)
        plane[i] = 1 / (factor * (plane[i] > least ? plane[i] : least));
}

RETEX_CPU_KERNEL(add, (float *plane, float *total, const float *values, float weight), (plane, total, values, weight))
RETEX_CPU_KERNEL(split,
                 (float *first, float *second, const float *modulation, const float *noise, const float *weights,
                  int limited),
                 (first, second, modulation, noise, weights, limited))
RETEX_CPU_KERNEL(variance, (float *variance, const float *first, const float *second, float *spare),
                 (variance, first, second, spare))
RETEX_CPU_KERNEL(gradient, (float *strict, float *loose, const float *plane), (strict, loose, plane))
RETEX_CPU_KERNEL(invert, (float *plane, float least, float factor), (plane, least, factor))

void retex_denoise_add_plane(float *plane, float *total, const float *values, float weight)
{
    add_by_level[retex_cpu_level()](plane, total, values, weight);
}

void retex_denoise_split_plane(float *first, float *second, const float *modulation, const float *noise,
                               const float weights[2], int limited)
{
    split_by_level[retex_cpu_level()](first, second, modulation, noise, weights, limited);
}

void retex_denoise_variance_plane(float *variance, const float *first, const float *second, float *spare)
{
    variance_by_level[retex_cpu_level()](variance, first, second, spare);
}

void retex_denoise_add_gradient(float *strict, float *loose, const float *plane)
{
    gradient_by_level[retex_cpu_level()](strict, loose, plane);
}

void retex_denoise_invert_plane(float *plane, float least, float factor)
{
    invert_by_level[retex_cpu_level()](plane, least, factor);
}

int retex_denoise_plane_is_zero(const float *plane)
{
    static const float zeros[DENOISE_PITCH];
    for (int y = 0; y < DENOISE_ROWS; y++)
        if (memcmp(plane + (size_t)y * DENOISE_PITCH, zeros, sizeof zeros) != 0)
            return 0;
    return 1;
}
