/* See denoise_kernel.h. Each loop is written once and compiled for several vector widths, and once without vectors. The
 * arithmetic is elementwise, so that all versions give the same bits. */
#include "denoise/denoise_kernel.h"

#include <string.h>

#include "denoise/falloff.h"

enum {
    TALL = DENOISE_TILE + 2 * DENOISE_PATCH, /* rows of differences */
    WIDE = DENOISE_WIDE,                     /* pixels of each: two more, so that they are whole vectors */
    BOX = 2 * DENOISE_PATCH + 1
};

enum { FAR = 2 * DENOISE_RADIUS_MAX * DENOISE_RADIUS_MAX };

/* The candidate filters. color: factor of the squared differences in colour; which features count; near: how fast the
 * weight falls with the squared distance in pixels; reach: up to which squared distance. The second is for places where
 * features change from pixel to pixel, the third for places where features say nothing, the fourth for even light. */
static const struct {
    float color, near;
    int reach;
    enum { STRICT, LOOSE, NONE } features;
} filters[DENOISE_CANDIDATES] = {{1, 0.05f, FAR, STRICT},
                                 {0.2f, 0.1f, DENOISE_NEAR, LOOSE},
                                 {1, 0.1f, DENOISE_NEAR, NONE},
                                 {0.05f, 0.1f, DENOISE_NEAR, STRICT}};

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
    const int is_near = dx * dx + dy * dy <= DENOISE_NEAR;
    for (int y = 0; y < DENOISE_TILE; y++) {
        size_t p = denoise_at(0, y), at = (size_t)y * DENOISE_TILE;
        float strict[DENOISE_TILE] = {0}, loose[DENOISE_TILE] = {0};
        const float *restrict valid = f->valid + p;
        for (int g = 0; g < f->count; g++)
            feature_distance(strict, loose, f, &f->of[g], p, o, per_pixel);
        for (int i = 0; i < DENOISE_TILE; i++)
            alike->strict[at + (size_t)i] = valid[i + o] * denoise_falloff(strict[i]);
        for (int i = 0; i < DENOISE_TILE && is_near; i++) {
            alike->valid[at + (size_t)i] = valid[i + o];
            alike->loose[at + (size_t)i] = valid[i + o] * denoise_falloff(loose[i]);
        }
    }
}

/* ---- colors ---- */

/* What turns squared differences in one colour into units of noise; both halves share it. */
RETEX_CPU_INLINE void scale_row(float *restrict to, const float *restrict variance, float epsilon, float strength,
                                ptrdiff_t o)
{
    for (int i = 0; i < WIDE; i++)
        to[i] = denoise_reciprocal(epsilon + strength * (variance[i] + variance[i + o]));
}

/* The squared difference of two pixels in one colour, beyond what their noise explains. */
RETEX_CPU_INLINE float difference(float here, float there, float v_here, float v_there)
{
    const float d = here - there, expected = v_here + (v_here < v_there ? v_here : v_there);
    return d * d - expected;
}

/* The sum over colours of the differences of one row; all colours in one loop, so that it becomes one of vectors. */
RETEX_CPU_INLINE void difference_row(float *restrict to, const float *restrict a, const float *restrict b,
                                     const float *restrict c, const float *restrict va, const float *restrict vb,
                                     const float *restrict vc, const float *restrict both,
                                     float scales[restrict 3][WIDE], ptrdiff_t o)
{
    for (int i = 0; i < WIDE; i++)
        to[i] = both[i] * (scales[0][i] * difference(a[i], a[i + o], va[i], va[i + o]) +
                           scales[1][i] * difference(b[i], b[i + o], vb[i], vb[i + o]) +
                           scales[2][i] * difference(c[i], c[i + o], vc[i], vc[i + o]));
}

/* Which pixels of one row count: 1 where both are of one kind. */
RETEX_CPU_INLINE void counts_row(float *restrict counts, const float *restrict kind, ptrdiff_t o)
{
    for (int i = 0; i < WIDE; i++) {
        float both = kind[i] * kind[i + o];
        counts[i] = both > 0 ? both : 0;
    }
}

/* Differences of one row, for both halves; 0 for pixels that do not count. */
RETEX_CPU_INLINE void difference_rows(const RetexDenoiseSignal *s, size_t p, ptrdiff_t o, float rows[3][WIDE])
{
    float scales[3][WIDE];
    counts_row(rows[2], s->kind + p, o);
    for (int c = 0; c < 3; c++)
        scale_row(scales[c], s->variance[c] + p, s->epsilon, s->strength, o);
    for (int h = 0; h < 2; h++)
        difference_row(rows[h], s->half[h][0] + p, s->half[h][1] + p, s->half[h][2] + p, s->variance[0] + p,
                       s->variance[1] + p, s->variance[2] + p, rows[2], scales, o);
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

/* Adds the weighted pixels of one row of one plane, beginning at q, for all displacements of the batch in one pass,
 * because the sums would otherwise be read and written once for each. */
RETEX_CPU_INLINE void add_plane(float *restrict sum, const float *restrict value, const size_t q[DENOISE_BATCH],
                                float w[restrict DENOISE_BATCH][DENOISE_TILE])
{
    const float *restrict v0 = value + q[0], *restrict v1 = value + q[1], *restrict v2 = value + q[2],
                          *restrict v3 = value + q[3];
    for (int i = 0; i < DENOISE_TILE; i++)
        sum[i] = sum[i] + w[0][i] * v0[i] + w[1][i] * v1[i] + w[2][i] * v2[i] + w[3][i] * v3[i];
}
_Static_assert(DENOISE_BATCH == 4, "as many as add_plane and multiply_rows name");

/* Weights times the modulation, and their sum over the batch added to the sum of weights. */
RETEX_CPU_INLINE void multiply_rows(float to[restrict DENOISE_BATCH][DENOISE_TILE], float *restrict norm,
                                    const float *restrict modulation, const size_t q[DENOISE_BATCH],
                                    float w[restrict DENOISE_BATCH][DENOISE_TILE])
{
    for (int n = 0; n < DENOISE_BATCH; n++) {
        const float *restrict m = modulation + q[n];
        for (int i = 0; i < DENOISE_TILE; i++)
            to[n][i] = w[n][i] * m[i];
    }
    for (int i = 0; i < DENOISE_TILE; i++)
        norm[i] = norm[i] + to[0][i] + to[1][i] + to[2][i] + to[3][i];
}

/* Adds the weighted pixels of one row to the sums of a half. */
RETEX_CPU_INLINE void add_half(const RetexDenoiseSignal *s, const RetexDenoiseSums *to, int half,
                               const size_t q[DENOISE_BATCH], size_t at, float w[restrict DENOISE_BATCH][DENOISE_TILE])
{
    Weights weighted;
    multiply_rows(weighted, to->norm[half] + at, s->modulation, q, w);
    for (int c = 0; c < 3; c++)
        add_plane(to->sum[half][c] + at, s->half[half][c], q, weighted);
}

RETEX_CPU_INLINE void mean_weights(float *restrict mean, const float *restrict first, const float *restrict second)
{
    for (int i = 0; i < DENOISE_TILE; i++)
        mean[i] = 0.5f * (first[i] + second[i]);
}

/* Keeps the weights that are wanted. */
RETEX_CPU_INLINE void keep_weights(const RetexDenoiseBatch *batch, size_t at, Weights w[restrict 2])
{
    for (int n = 0; n < batch->count; n++)
        if (batch->weights[n])
            mean_weights(batch->weights[n] + at, w[0][n], w[1][n]);
}

/* The patch distances of all pixels to the pixels at one displacement, for both halves. */
RETEX_CPU_INLINE void find_distances(const RetexDenoiseSignal *s, ptrdiff_t o, float *restrict distances)
{
    float *boxed[3] = {s->scratch, s->scratch + TALL * DENOISE_TILE, s->scratch + 2 * TALL * DENOISE_TILE};
    for (int y = 0; y < TALL; y++) {
        float row[3][WIDE];
        difference_rows(s, denoise_at(-DENOISE_PATCH, y - DENOISE_PATCH), o, row);
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

/* The squared distance of a displacement. */
RETEX_CPU_INLINE int squared(RetexDenoiseDisplacement o)
{
    return o.dx * o.dx + o.dy * o.dy;
}

/* Finds the patch distances of a batch, and for each candidate how much nearness counts. reached: by candidate, 1 where
 * it reaches any displacement. */
RETEX_CPU_INLINE void prepare_batch(const RetexDenoiseSignal *s, const RetexDenoiseBatch *batch, float *distances,
                                    float near[DENOISE_CANDIDATES][DENOISE_BATCH], int reached[DENOISE_CANDIDATES])
{
    for (int k = 0; k < DENOISE_CANDIDATES; k++)
        reached[k] = 0;
    for (int n = 0; n < batch->count; n++) {
        const RetexDenoiseDisplacement o = batch->of[n];
        for (int k = 0; k < DENOISE_CANDIDATES; k++) {
            const int is_reached = squared(o) <= filters[k].reach;
            near[k][n] = is_reached ? denoise_falloff(filters[k].near * (float)squared(o)) : 0;
            reached[k] |= is_reached;
        }
        find_distances(s, (ptrdiff_t)o.dy * DENOISE_PITCH + o.dx, distances + (size_t)n * 2 * DENOISE_PIXELS);
    }
}

RETEX_CPU_INLINE void signal_body(const RetexDenoiseSignal *s, const RetexDenoiseBatch *batch)
{
    float *distances = s->scratch + 3 * TALL * DENOISE_TILE;
    float near[DENOISE_CANDIDATES][DENOISE_BATCH];
    int reached[DENOISE_CANDIDATES];
    prepare_batch(s, batch, distances, near, reached);
    for (int y = 0; y < DENOISE_TILE; y++) {
        Weights w[2] = {{{0}}};
        size_t at = (size_t)y * DENOISE_TILE, q[DENOISE_BATCH];
        for (int n = 0; n < DENOISE_BATCH; n++)
            q[n] = n < batch->count ? denoise_at(batch->of[n].dx, y + batch->of[n].dy) : denoise_at(0, y);
        for (int k = 0; k < DENOISE_CANDIDATES; k++) {
            if (!reached[k])
                continue;
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
                keep_weights(batch, at, w);
        }
    }
}

/* ---- images ---- */

/* As add_plane, with the weights of whole tiles, of which this is row y. */
RETEX_CPU_INLINE void add_row(float *restrict sum, const float *restrict plane, const RetexDenoiseDisplacement *of,
                              const float *const *weights, int y)
{
    const size_t at = (size_t)y * DENOISE_TILE;
    const float *restrict v0 = plane + denoise_at(of[0].dx, y + of[0].dy), *restrict w0 = weights[0] + at;
    const float *restrict v1 = plane + denoise_at(of[1].dx, y + of[1].dy), *restrict w1 = weights[1] + at;
    const float *restrict v2 = plane + denoise_at(of[2].dx, y + of[2].dy), *restrict w2 = weights[2] + at;
    const float *restrict v3 = plane + denoise_at(of[3].dx, y + of[3].dy), *restrict w3 = weights[3] + at;
    for (int i = 0; i < DENOISE_TILE; i++)
        sum[i] = sum[i] + w0[i] * v0[i] + w1[i] * v1[i] + w2[i] * v2[i] + w3[i] * v3[i];
}

RETEX_CPU_INLINE void add_last_row(float *restrict sum, const float *restrict plane, RetexDenoiseDisplacement of,
                                   const float *restrict weights, int y)
{
    const float *restrict v = plane + denoise_at(of.dx, y + of.dy), *restrict w = weights + (size_t)y * DENOISE_TILE;
    for (int i = 0; i < DENOISE_TILE; i++)
        sum[i] = sum[i] + w[i] * v[i];
}

RETEX_CPU_INLINE void images_body(const RetexDenoiseImages *images, const RetexDenoiseDisplacement *of,
                                  const float *const *weights, int count)
{
    for (int k = 0; k < images->count; k++)
        for (int y = 0; y < DENOISE_TILE; y++) {
            float *sum = images->sums[k] + (size_t)y * DENOISE_TILE;
            int n = 0;
            for (; n + 4 <= count; n += 4)
                add_row(sum, images->planes[k], of + n, weights + n, y);
            for (; n < count; n++)
                add_last_row(sum, images->planes[k], of[n], weights[n], y);
        }
}

/* ---- variants ---- */

RETEX_CPU_KERNEL(features, (RetexDenoiseSimilarity * alike, const RetexDenoiseFeatures *f, int dx, int dy),
                 (alike, f, dx, dy))
RETEX_CPU_KERNEL(signal, (const RetexDenoiseSignal *s, const RetexDenoiseBatch *batch), (s, batch))
RETEX_CPU_KERNEL(images,
                 (const RetexDenoiseImages *images, const RetexDenoiseDisplacement *of, const float *const *weights,
                  int count),
                 (images, of, weights, count))

#define NO_VECTORS RETEX_CPU_OPTIONS("no-tree-vectorize,no-tree-slp-vectorize")

NO_VECTORS static void features_scalar(RetexDenoiseSimilarity *alike, const RetexDenoiseFeatures *f, int dx, int dy)
{
    features_body(alike, f, dx, dy);
}

NO_VECTORS static void signal_scalar(const RetexDenoiseSignal *s, const RetexDenoiseBatch *batch)
{
    signal_body(s, batch);
}

NO_VECTORS static void images_scalar(const RetexDenoiseImages *images, const RetexDenoiseDisplacement *of,
                                     const float *const *weights, int count)
{
    images_body(images, of, weights, count);
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

void retex_denoise_images_kernel(const RetexDenoiseImages *images, const RetexDenoiseDisplacement *displacements,
                                 const float *const *weights, int count, int scalar)
{
    (scalar ? images_scalar : images_by_level[retex_cpu_level()])(images, displacements, weights, count);
}
