/* See planes_kernel.h. Four pixels at a time for two and three channels, which nearly all parts of a set have. */
#include "exr/planes_kernel.h"

#include <string.h>

#include "base/float4.h"

static inline void store4(float *p, RetexFloat4 v)
{
    memcpy(p, &v, sizeof v);
}

static inline RetexFloat4 load_plane(const unsigned char *plane, size_t i)
{
    RetexFloat4 v;
    memcpy(&v, plane + i * sizeof(float), sizeof v);
    return v;
}

/* The pixels from i on, one by one. */
static void interleave_from(float *restrict out, const void *const *planes, int channels, size_t i, size_t count)
{
    for (int c = 0; c < channels; c++) {
        const unsigned char *plane = planes[c];
        for (size_t x = i; plane && x < count; x++)
            memcpy(out + x * (size_t)channels + (size_t)c, plane + x * sizeof(float), sizeof *out);
    }
}

#define SHUFFLE(a, b, i, j, k, l) __builtin_shufflevector(a, b, i, j, k, l)

static void interleave_two(float *restrict out, const void *const *planes, size_t count)
{
    size_t i = 0;
    for (; i + 4 <= count; i += 4, out += 8) {
        const RetexFloat4 a = load_plane(planes[0], i), b = load_plane(planes[1], i);
        store4(out, SHUFFLE(a, b, 0, 4, 1, 5));
        store4(out + 4, SHUFFLE(a, b, 2, 6, 3, 7));
    }
    interleave_from(out - 2 * i, planes, 2, i, count);
}

static void interleave_three(float *restrict out, const void *const *planes, size_t count)
{
    size_t i = 0;
    for (; i + 4 <= count; i += 4, out += 12) {
        const RetexFloat4 r = load_plane(planes[0], i), g = load_plane(planes[1], i), b = load_plane(planes[2], i);
        const RetexFloat4 rg = SHUFFLE(r, g, 0, 4, 2, 6), gb = SHUFFLE(g, b, 1, 5, 3, 7),
                          br = SHUFFLE(b, r, 0, 5, 2, 7);
        store4(out, SHUFFLE(rg, br, 0, 1, 4, 5));
        store4(out + 4, SHUFFLE(gb, rg, 0, 1, 6, 7));
        store4(out + 8, SHUFFLE(br, gb, 2, 3, 6, 7));
    }
    interleave_from(out - 3 * i, planes, 3, i, count);
}

void retex_planes_interleave(float *restrict out, const void *const *planes, int channels, size_t count)
{
    if (channels == 1 && planes[0])
        memcpy(out, planes[0], count * sizeof *out);
    else if (channels == 2 && planes[0] && planes[1])
        interleave_two(out, planes, count);
    else if (channels == 3 && planes[0] && planes[1] && planes[2])
        interleave_three(out, planes, count);
    else
        interleave_from(out, planes, channels, 0, count);
}
