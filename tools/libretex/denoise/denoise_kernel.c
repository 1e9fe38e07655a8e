/* See denoise_kernel.h. Each loop is written once and compiled for several vector widths, and once without vectors. The
 * arithmetic is elementwise, so that all versions give the same bits. */
#include "denoise/denoise_kernel.h"

#include <string.h>

#include "denoise/falloff.h"

enum { WIDE = DENOISE_TILE + 2 * DENOISE_PATCH, BOX = 2 * DENOISE_PATCH + 1 };

/* The candidate filters. color: factor of the squared differences in colour; which features count; near: how fast the
 * weight falls with the squared distance in pixels. The second is for places where features change from pixel to pixel,
 * the third for places where features say nothing, the fourth for even light. */
static const struct {
    float color, near;
    enum { STRICT, LOOSE, NONE } features;
} filters[DENOISE_CANDIDATES] = {{1, 0.05f, STRICT}, {0.2f, 0.1f, LOOSE}, {1, 0.1f, NONE}, {0.05f, 0.1f, STRICT}};

/* ---- features ---- */

RETEX_CPU_INLINE void feature_distance(float *restrict strict, float *restrict loose, const RetexDenoiseFeatures *f,
                                       const RetexDenoiseFeature *g, size_t p, ptrdiff_t o, float per_pixel)
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
    const float *restrict scale = g->strict + p, *restrict looser = g->loose + p;
    for (int i = 0; i < DENOISE_TILE; i++) {
        float d = distance[i] * scale[i], e = distance[i] * looser[i];
        strict[i] = d > strict[i] ? d : strict[i];
        loose[i] = e > loose[i] ? e : loose[i];
    }
}

RETEX_CPU_INLINE void features_body(RetexDenoiseSimilarity *restrict alike, const RetexDenoiseFeatures *f, int dx,
                                    int dy)
{
    ptrdiff_t o = (ptrdiff_t)dy * DENOISE_PITCH + dx;
    float per_pixel = 1 / (float)(dx * dx + dy * dy + !(dx | dy));
    for (int y = 0; y < DENOISE_TILE; y++) {
        size_t p = denoise_at(0, y), at = (size_t)y * DENOISE_TILE;
        float strict[DENOISE_TILE] = {0}, loose[DENOISE_TILE] = {0};
        const float *restrict valid = f->valid + p;
        for (int g = 0; g < f->count; g++)
            feature_distance(strict, loose, f, &f->of[g], p, o, per_pixel);
        for (int i = 0; i < DENOISE_TILE; i++) {
            alike->valid[at + (size_t)i] = valid[i + o];
            alike->strict[at + (size_t)i] = valid[i + o] * denoise_falloff(strict[i]);
            alike->loose[at + (size_t)i] = valid[i + o] * denoise_falloff(loose[i]);
        }
    }
}

/* ---- colors ---- */

/* Squared differences of one row, for both halves, in units of their noise; 0 for pixels that do not count. */
RETEX_CPU_INLINE void difference_row(const RetexDenoiseSignal *s, size_t p, ptrdiff_t o, float *restrict first,
                                     float *restrict second, float *restrict counts)
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

RETEX_CPU_INLINE void box_row(float *restrict out, const float *restrict in)
{
    for (int i = 0; i < DENOISE_TILE; i++)
        out[i] = in[i] + in[i + 1] + in[i + 2] + in[i + 3] + in[i + 4] + in[i + 5] + in[i + 6];
}

RETEX_CPU_INLINE void box_column(float *restrict out, const float *restrict rows)
{
    for (int i = 0; i < DENOISE_TILE; i++) {
        float sum = rows[i];
        for (int k = 1; k < BOX; k++)
            sum += rows[i + k * DENOISE_TILE];
        out[i] = sum;
    }
}

/* Turns sums over patches into means; pixels of different kinds get the largest distance. */
RETEX_CPU_INLINE void distance_row(float *restrict distance, const float *restrict counts, const float *restrict kind,
                                   ptrdiff_t o)
{
    for (int i = 0; i < DENOISE_TILE; i++) {
        float n = counts[i] > 1 ? counts[i] : 1, d = distance[i] / (3 * n);
        d = d > 0 ? d : 0;
        distance[i] = kind[i] * kind[i + o] > 0 ? d : 1e9f;
    }
}

RETEX_CPU_INLINE void weight_row(float *restrict weight, const float *restrict distance, const float *restrict alike,
                                 float color, float near)
{
    for (int i = 0; i < DENOISE_TILE; i++) {
        float a = denoise_falloff(distance[i] * color), b = alike[i] * near;
        weight[i] = a < b ? a : b;
    }
}

/* One row of weights for each displacement of a batch; unused displacements have weight 0. */
typedef float Weights[DENOISE_BATCH][DENOISE_TILE];

/* Adds the weighted pixels of one row, beginning at q, to the sums of a half. All displacements of the batch are added
 * in one pass, because the sums would otherwise be read and written once for each. */
RETEX_CPU_INLINE void add_half(const RetexDenoiseSignal *s, const RetexDenoiseSums *to, int half,
                               const size_t q[DENOISE_BATCH], size_t at, float w[restrict DENOISE_BATCH][DENOISE_TILE])
{
    const float *restrict a = s->half[half][0], *restrict b = s->half[half][1], *restrict c = s->half[half][2],
                          *restrict m = s->modulation;
    float *restrict x = to->sum[half][0] + at, *restrict y = to->sum[half][1] + at, *restrict z = to->sum[half][2] + at,
                    *restrict norm = to->norm[half] + at;
    for (size_t i = 0; i < DENOISE_TILE; i++) {
        float xs = x[i], ys = y[i], zs = z[i], ns = norm[i];
        for (int n = 0; n < DENOISE_BATCH; n++) {
            float v = w[n][i] * m[q[n] + i];
            xs += v * a[q[n] + i], ys += v * b[q[n] + i], zs += v * c[q[n] + i], ns += v;
        }
        x[i] = xs, y[i] = ys, z[i] = zs, norm[i] = ns;
    }
}

RETEX_CPU_INLINE void add_planes(const RetexDenoiseSignal *s, const RetexDenoiseBatch *batch,
                                 const size_t q[DENOISE_BATCH], size_t at, Weights w[restrict 2])
{
    Weights mean;
    for (int n = 0; n < DENOISE_BATCH; n++)
        for (int i = 0; i < DENOISE_TILE; i++)
            mean[n][i] = 0.5f * (w[0][n][i] + w[1][n][i]);
    for (int k = 0; k < s->nplanes; k++) {
        const float *restrict value = s->planes[k];
        float *restrict sum = s->sums[k] + at;
        for (size_t i = 0; i < DENOISE_TILE; i++) {
            float all = sum[i];
            for (int n = 0; n < DENOISE_BATCH; n++)
                all += mean[n][i] * value[q[n] + i];
            sum[i] = all;
        }
    }
    for (int n = 0; n < DENOISE_BATCH; n++)
        if (batch->weights[n])
            memcpy(batch->weights[n] + at, mean[n], sizeof mean[n]);
}

/* The patch distances of all pixels to the pixels at one displacement, for both halves. */
RETEX_CPU_INLINE void find_distances(const RetexDenoiseSignal *s, ptrdiff_t o, float *restrict distances)
{
    float *boxed[3] = {s->scratch, s->scratch + WIDE * DENOISE_TILE, s->scratch + 2 * WIDE * DENOISE_TILE};
    for (int y = 0; y < WIDE; y++) {
        float row[3][WIDE];
        difference_row(s, denoise_at(-DENOISE_PATCH, y - DENOISE_PATCH), o, row[0], row[1], row[2]);
        for (int k = 0; k < 3; k++)
            box_row(boxed[k] + y * DENOISE_TILE, row[k]);
    }
    for (int y = 0; y < DENOISE_TILE; y++) {
        float counts[DENOISE_TILE];
        size_t at = (size_t)y * DENOISE_TILE;
        box_column(counts, boxed[2] + at);
        for (int h = 0; h < 2; h++) {
            float *distance = distances + (size_t)h * DENOISE_PIXELS + at;
            box_column(distance, boxed[h] + at);
            distance_row(distance, counts, s->kind + denoise_at(0, y), o);
        }
    }
}

RETEX_CPU_INLINE void signal_body(const RetexDenoiseSignal *s, const RetexDenoiseBatch *batch)
{
    float *distances = s->scratch + 3 * WIDE * DENOISE_TILE;
    float near[DENOISE_CANDIDATES][DENOISE_BATCH];
    for (int n = 0; n < batch->count; n++) {
        int dx = batch->dx + n;
        for (int k = 0; k < DENOISE_CANDIDATES; k++)
            near[k][n] = denoise_falloff(filters[k].near * (float)(dx * dx + batch->dy * batch->dy));
        find_distances(s, (ptrdiff_t)batch->dy * DENOISE_PITCH + dx, distances + (size_t)n * 2 * DENOISE_PIXELS);
    }
    for (int y = 0; y < DENOISE_TILE; y++) {
        Weights w[2] = {{{0}}};
        size_t at = (size_t)y * DENOISE_TILE, q[DENOISE_BATCH];
        for (int n = 0; n < DENOISE_BATCH; n++)
            q[n] = denoise_at(n < batch->count ? batch->dx + n : 0, n < batch->count ? y + batch->dy : y);
        for (int k = 0; k < DENOISE_CANDIDATES; k++) {
            for (int n = 0; n < batch->count; n++) {
                const RetexDenoiseSimilarity *alike = batch->alike[n];
                const float *features = filters[k].features == STRICT  ? alike->strict
                                        : filters[k].features == LOOSE ? alike->loose
                                                                       : alike->valid;
                for (int h = 0; h < 2; h++)
                    weight_row(w[h][n], distances + (size_t)(2 * n + h) * DENOISE_PIXELS + at, features + at,
                               filters[k].color, near[k][n]);
            }
            add_half(s, &s->candidates[k], 0, q, at, w[1]); /* each half with the weights of the other half */
            add_half(s, &s->candidates[k], 1, q, at, w[0]);
            if (k == 0)
                add_planes(s, batch, q, at, w);
        }
    }
}

/* ---- variants ---- */

RETEX_CPU_KERNEL(features, (RetexDenoiseSimilarity * alike, const RetexDenoiseFeatures *f, int dx, int dy),
                 (alike, f, dx, dy))
RETEX_CPU_KERNEL(signal, (const RetexDenoiseSignal *s, const RetexDenoiseBatch *batch), (s, batch))

#define NO_VECTORS RETEX_CPU_OPTIONS("no-tree-vectorize,no-tree-slp-vectorize")

NO_VECTORS static void features_scalar(RetexDenoiseSimilarity *alike, const RetexDenoiseFeatures *f, int dx, int dy)
{
    features_body(alike, f, dx, dy);
}

NO_VECTORS static void signal_scalar(const RetexDenoiseSignal *s, const RetexDenoiseBatch *batch)
{
    signal_body(s, batch);
}

void retex_denoise_features_kernel(RetexDenoiseSimilarity *alike, const RetexDenoiseFeatures *features, int dx, int dy,
                                   int scalar)
{
    (scalar ? features_scalar : features_by_level[retex_cpu_level()])(alike, features, dx, dy);
}

void retex_denoise_signal_kernel(const RetexDenoiseSignal *signal, const RetexDenoiseBatch *batch, int scalar)
{
    (scalar ? signal_scalar : signal_by_level[retex_cpu_level()])(signal, batch);
}
