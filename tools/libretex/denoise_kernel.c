/* See denoise_kernel.h. Each loop is written once and compiled for AVX2, for what every machine of the kind has, and
 * without any vector unit: elementwise arithmetic, so that all give the same bits. */
#include "denoise_kernel.h"

#include <string.h>

enum { WIDE = DENOISE_TILE + 2 * DENOISE_PATCH, BOX = 2 * DENOISE_PATCH + 1 };

#define INLINE static inline __attribute__((always_inline))

/* Near exp(-x) for x >= 0, and 0 from 8 on. */
INLINE float falloff(float x)
{
    float y = 1 - x * 0.125f;
    y = y > 0 ? y : 0;
    y *= y, y *= y;
    return y * y;
}

INLINE void group_distance(float *restrict worst, const DenoiseFeatures *f, const DenoiseGroup *g, size_t p, ptrdiff_t o,
                           float per_pixel)
{
    float distance[DENOISE_TILE] = {0};
    if (g->normal[0]) {
        const float *restrict x = f->planes[g->first] + p, *restrict y = f->planes[g->first + 1] + p,
                              *restrict z = f->planes[g->first + 2] + p;
        const float *restrict nx = g->normal[0] + p, *restrict ny = g->normal[1] + p, *restrict nz = g->normal[2] + p;
        for (int i = 0; i < DENOISE_TILE; i++) {
            float along = nx[i] * (x[i + o] - x[i]) + ny[i] * (y[i + o] - y[i]) + nz[i] * (z[i + o] - z[i]);
            distance[i] = along * along * per_pixel;
        }
    } else {
        for (int k = 0; k < g->count; k++) {
            const float *restrict a = f->planes[g->first + k] + p;
            for (int i = 0; i < DENOISE_TILE; i++) {
                float d = a[i + o] - a[i];
                distance[i] += d * d;
            }
        }
    }
    const float *restrict scale = g->scale + p;
    for (int i = 0; i < DENOISE_TILE; i++) {
        float d = distance[i] * scale[i];
        worst[i] = d > worst[i] ? d : worst[i];
    }
}

INLINE void features_body(float *restrict weight, const DenoiseFeatures *f, int dx, int dy)
{
    ptrdiff_t o = (ptrdiff_t)dy * DENOISE_PITCH + dx;
    float per_pixel = 1 / (float)(dx * dx + dy * dy + !(dx | dy));
    for (int y = 0; y < DENOISE_TILE; y++) {
        size_t p = denoise_at(0, y);
        float worst[DENOISE_TILE] = {0};
        const float *restrict valid = f->valid + p;
        float *restrict out = weight + (size_t)y * DENOISE_TILE;
        for (int g = 0; g < f->ngroups; g++)
            group_distance(worst, f, &f->groups[g], p, o, per_pixel);
        for (int i = 0; i < DENOISE_TILE; i++)
            out[i] = valid[i + o] * falloff(worst[i]);
    }
}

/* Differences of one row of both halves, in units of their noise, and which count. */
INLINE void difference_row(const DenoiseSignal *s, size_t p, ptrdiff_t o, float *restrict first, float *restrict second,
                           float *restrict counts)
{
    const float *restrict kind = s->kind + p;
    for (int i = 0; i < WIDE; i++)
        first[i] = second[i] = 0;
    for (int c = 0; c < 3; c++) {
        const float *restrict a = s->half[0][c] + p, *restrict b = s->half[1][c] + p, *restrict v = s->variance[c] + p;
        for (int i = 0; i < WIDE; i++) {
            float vp = v[i], vq = v[i + o], least = vp < vq ? vp : vq;
            float scale = 1 / (s->epsilon + s->strength * (vp + vq)), expected = vp + least;
            float da = a[i] - a[i + o], db = b[i] - b[i + o];
            first[i] += (da * da - expected) * scale;
            second[i] += (db * db - expected) * scale;
        }
    }
    for (int i = 0; i < WIDE; i++) {
        float both = kind[i] * kind[i + o];
        both = both > 0 ? both : 0;
        first[i] *= both, second[i] *= both;
        counts[i] = both;
    }
}

INLINE void box_row(float *restrict out, const float *restrict in)
{
    for (int i = 0; i < DENOISE_TILE; i++)
        out[i] = in[i] + in[i + 1] + in[i + 2] + in[i + 3] + in[i + 4] + in[i + 5] + in[i + 6];
}

INLINE void box_column(float *restrict out, const float *restrict rows)
{
    for (int i = 0; i < DENOISE_TILE; i++) {
        float sum = rows[i];
        for (int k = 1; k < BOX; k++)
            sum += rows[i + k * DENOISE_TILE];
        out[i] = sum;
    }
}

/* Add one row of what pixels at offset o give, with the weights of both halves. */
INLINE void accumulate_row(const DenoiseSignal *s, size_t p, ptrdiff_t o, size_t at, const float *restrict first,
                           const float *restrict second)
{
    float mean[DENOISE_TILE];
    for (int i = 0; i < DENOISE_TILE; i++)
        mean[i] = 0.5f * (first[i] + second[i]);
    for (int c = 0; c < 3; c++) {
        const float *restrict a = s->half[0][c] + p + o, *restrict b = s->half[1][c] + p + o,
                              *restrict m = s->modulation[c] + p + o;
        float *restrict sum_a = s->sum[0][c] + at, *restrict sum_b = s->sum[1][c] + at;
        float *restrict norm_a = s->norm[0][c] + at, *restrict norm_b = s->norm[1][c] + at;
        for (int i = 0; i < DENOISE_TILE; i++) {
            float wa = second[i] * m[i], wb = first[i] * m[i]; /* each half by the other's weights */
            sum_a[i] += wa * a[i], norm_a[i] += wa;
            sum_b[i] += wb * b[i], norm_b[i] += wb;
        }
    }
    for (int k = 0; k < s->nplanes; k++) {
        const float *restrict value = s->planes[k] + p + o;
        float *restrict sum = s->sums[k] + at;
        for (int i = 0; i < DENOISE_TILE; i++)
            sum[i] += mean[i] * value[i];
    }
    if (s->weight)
        memcpy(s->weight + at, mean, sizeof mean);
}

INLINE void signal_body(const DenoiseSignal *s, const float *restrict features, int dx, int dy)
{
    ptrdiff_t o = (ptrdiff_t)dy * DENOISE_PITCH + dx;
    float *boxed[3] = {s->scratch, s->scratch + WIDE * DENOISE_TILE, s->scratch + 2 * WIDE * DENOISE_TILE};
    for (int y = 0; y < WIDE; y++) {
        float row[3][WIDE];
        difference_row(s, denoise_at(-DENOISE_PATCH, y - DENOISE_PATCH), o, row[0], row[1], row[2]);
        for (int k = 0; k < 3; k++)
            box_row(boxed[k] + y * DENOISE_TILE, row[k]);
    }
    for (int y = 0; y < DENOISE_TILE; y++) {
        float first[DENOISE_TILE], second[DENOISE_TILE], counts[DENOISE_TILE];
        size_t p = denoise_at(0, y), at = (size_t)y * DENOISE_TILE;
        const float *restrict kind = s->kind + p, *restrict alike = features + at;
        box_column(first, boxed[0] + at);
        box_column(second, boxed[1] + at);
        box_column(counts, boxed[2] + at);
        for (int i = 0; i < DENOISE_TILE; i++) {
            float both = kind[i] * kind[i + o], n = counts[i] > 1 ? counts[i] : 1, scale = 1 / (3 * n);
            float a = first[i] * scale, b = second[i] * scale, most = both > 0 ? alike[i] : 0;
            a = falloff(a > 0 ? a : 0), b = falloff(b > 0 ? b : 0);
            first[i] = a < most ? a : most;
            second[i] = b < most ? b : most;
        }
        accumulate_row(s, p, o, at, first, second);
    }
}

#define VARIANTS(attributes, suffix)                                                                                  \
    attributes static void features_##suffix(float *restrict weight, const DenoiseFeatures *f, int dx, int dy)         \
    {                                                                                                                 \
        features_body(weight, f, dx, dy);                                                                             \
    }                                                                                                                 \
    attributes static void signal_##suffix(const DenoiseSignal *s, const float *restrict features, int dx, int dy)     \
    {                                                                                                                 \
        signal_body(s, features, dx, dy);                                                                             \
    }

VARIANTS(, baseline)
VARIANTS(__attribute__((optimize("no-tree-vectorize,no-tree-slp-vectorize"))), scalar)
#if defined(__x86_64__) && defined(__GNUC__)
VARIANTS(__attribute__((target("avx2"))), avx2)
static int has_avx2(void)
{
    return __builtin_cpu_supports("avx2");
}
#else
#define features_avx2 features_baseline
#define signal_avx2 signal_baseline
static int has_avx2(void)
{
    return 0;
}
#endif

void denoise_features_kernel(float *restrict weight, const DenoiseFeatures *features, int dx, int dy, int scalar)
{
    (scalar ? features_scalar : has_avx2() ? features_avx2 : features_baseline)(weight, features, dx, dy);
}

void denoise_signal_kernel(const DenoiseSignal *signal, const float *restrict features, int dx, int dy, int scalar)
{
    (scalar ? signal_scalar : has_avx2() ? signal_avx2 : signal_baseline)(signal, features, dx, dy);
}
