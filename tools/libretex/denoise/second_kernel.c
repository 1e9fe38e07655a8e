/* See second_kernel.h. Each loop is written once and compiled for several vector widths, and once without vectors. The
 * arithmetic is elementwise, so that all versions give the same bits. */
#include "denoise/second_kernel.h"

#include "denoise/falloff.h"

/* Of the linear B-spline: the cubic one that Dammertz et al. take needs 25 taps for as wide a window. */
static const float spline[DENOISE_TAPS_SIDE] = {0.25f, 0.5f, 0.25f};

typedef float Row[DENOISE_PITCH];

RETEX_CPU_INLINE void add_difference(Row worst, const RetexDenoiseFeatures *f, const RetexDenoiseFeature *g, size_t p,
                                     ptrdiff_t o, float per_pixel, int n)
{
    Row distance;
    for (int i = 0; i < n; i++)
        distance[i] = 0;
    for (int k = 0; k < g->count; k++) {
        const float *restrict a = f->planes[g->first + k] + p;
        if (g->normal[0]) {
            const float *restrict normal = g->normal[k] + p;
            for (int i = 0; i < n; i++)
                distance[i] += normal[i] * (a[i + o] - a[i]);
        } else {
            for (int i = 0; i < n; i++)
                distance[i] += (a[i + o] - a[i]) * (a[i + o] - a[i]);
        }
    }
    const float *restrict scale = g->strict + p;
    const int is_along = g->normal[0] != NULL;
    for (int i = 0; i < n; i++) {
        float d = (is_along ? distance[i] * distance[i] * per_pixel : distance[i]) * scale[i];
        worst[i] = d > worst[i] ? d : worst[i];
    }
}

/* The part of a weight that all signals share: the spline's, by features. */
RETEX_CPU_INLINE void tap_row(Row to, const RetexDenoiseFeatures *f, size_t p, int dx, int dy, float weight, int n)
{
    const ptrdiff_t o = (ptrdiff_t)dy * DENOISE_PITCH + dx;
    const float per_pixel = 1 / (float)(dx * dx + dy * dy + !(dx | dy));
    const float *restrict valid = f->valid + p;
    Row worst;
    for (int i = 0; i < n; i++)
        worst[i] = 0;
    for (int g = 0; g < f->count; g++)
        add_difference(worst, f, &f->of[g], p, o, per_pixel, n);
    for (int i = 0; i < n; i++)
        to[i] = weight * valid[i + o] * denoise_falloff(worst[i]);
}

/* Sums of one row of a signal. */
typedef struct RowSums {
    Row half[2][3], norm[2], variance[2][3];
} RowSums;

RETEX_CPU_INLINE void clear_sums(RowSums *sums, int n)
{
    for (int h = 0; h < 2; h++)
        for (int i = 0; i < n; i++) {
            sums->norm[h][i] = 0;
            for (int c = 0; c < 3; c++)
                sums->half[h][c][i] = sums->variance[h][c][i] = 0;
        }
}

/* By what squared differences in one colour become units of noise; both halves share it. */
RETEX_CPU_INLINE void find_scale(float *restrict scale, const float *restrict v, ptrdiff_t o, int n)
{
    for (int i = 0; i < n; i++)
        scale[i] = (1.0f / 3) * denoise_reciprocal(v[i] + v[i + o]);
}

/* How much one half differs in one colour at a pixel and another, beyond its noise. */
RETEX_CPU_INLINE float difference(float here, float there, float v_here, float v_there)
{
    const float d = here - there, expected = v_here + (v_here < v_there ? v_here : v_there);
    return d * d - expected;
}

/* The mean over colours of the differences, in units of noise. */
RETEX_CPU_INLINE void find_distances(float *restrict to, const float *restrict a, const float *restrict b,
                                     const float *restrict c, const float *restrict va, const float *restrict vb,
                                     const float *restrict vc, Row scales[restrict 3], ptrdiff_t o, int n)
{
    for (int i = 0; i < n; i++)
        to[i] = scales[0][i] * difference(a[i], a[i + o], va[i], va[i + o]) +
                scales[1][i] * difference(b[i], b[i + o], vb[i], vb[i + o]) +
                scales[2][i] * difference(c[i], c[i + o], vc[i], vc[i + o]);
}

RETEX_CPU_INLINE void weigh(float *restrict weight, const float *restrict distance, const float *restrict kind,
                            const float *restrict tap, ptrdiff_t o, int n)
{
    for (int i = 0; i < n; i++) {
        float d = distance[i], same = kind[i] * kind[i + o]; /* 1, or -1 of different kinds */
        d = d > 0 ? d : 0, same = same > 0 ? same : 0;
        weight[i] = same * tap[i] * denoise_falloff(d);
    }
}

/* Weights of each half by how much the other one differs; 0 for pixels of another kind. */
RETEX_CPU_INLINE void weigh_row(Row weights[2], const RetexDenoiseLight *from, const float *kind, const Row tap,
                                size_t p, ptrdiff_t o, int n)
{
    const float *const *v = (const float *const *)from->variance;
    Row scales[3];
    for (int c = 0; c < 3; c++)
        find_scale(scales[c], v[c] + p, o, n);
    for (int h = 0; h < 2; h++) {
        const float *const *other = (const float *const *)from->half[!h];
        Row distance;
        find_distances(distance, other[0] + p, other[1] + p, other[2] + p, v[0] + p, v[1] + p, v[2] + p, scales, o, n);
        weigh(weights[h], distance, kind, tap, o, n);
    }
}

RETEX_CPU_INLINE void add_weighted(float *restrict sum, float *restrict variance, const float *restrict weight,
                                   const float *restrict a, const float *restrict v, int n)
{
    for (int i = 0; i < n; i++) {
        sum[i] += weight[i] * a[i];
        variance[i] += weight[i] * weight[i] * v[i];
    }
}

RETEX_CPU_INLINE void add_row(RowSums *sums, const RetexDenoiseLight *from, Row weights[2], size_t q, int n)
{
    for (int h = 0; h < 2; h++) {
        for (int c = 0; c < 3; c++)
            add_weighted(sums->half[h][c], sums->variance[h][c], weights[h], from->half[h][c] + q,
                         from->variance[c] + q, n);
        for (int i = 0; i < n; i++)
            sums->norm[h][i] += weights[h][i];
    }
}

/* A pixel outside of the picture has no neighbours and keeps what it has. */
RETEX_CPU_INLINE void store_row(const RetexDenoiseLight *to, const RetexDenoiseLight *from, const RowSums *sums,
                                float epsilon, size_t p, int n)
{
    for (int c = 0; c < 3; c++) {
        for (int h = 0; h < 2; h++) {
            float *restrict out = to->half[h][c] + p;
            const float *restrict in = from->half[h][c] + p;
            for (int i = 0; i < n; i++)
                out[i] = sums->norm[h][i] > 0 ? sums->half[h][c][i] / sums->norm[h][i] : in[i];
        }
        float *restrict out = to->variance[c] + p;
        const float *restrict in = from->variance[c] + p;
        for (int i = 0; i < n; i++) {
            float a = sums->norm[0][i] * sums->norm[0][i], b = sums->norm[1][i] * sums->norm[1][i];
            float v = 0.5f * (sums->variance[0][c][i] / a + sums->variance[1][c][i] / b) + epsilon;
            out[i] = a > 0 && b > 0 ? v : in[i];
        }
    }
}

/* n: pixels of a row, a constant and a multiple of all vectors' lengths, so that loops over them become vectors. What
 * is beyond the level's square is not stored. */
RETEX_CPU_INLINE void level_rows(const RetexDenoiseLevel *level, const int n)
{
    for (int y = -level->around; y < DENOISE_TILE + level->around; y++) {
        const size_t p = denoise_at(-level->around, y);
        Row taps[DENOISE_TAPS];
        for (int k = 0; k < DENOISE_TAPS; k++) {
            const int i = k % DENOISE_TAPS_SIDE, j = k / DENOISE_TAPS_SIDE;
            tap_row(taps[k], level->features, p, (i - 1) * level->step, (j - 1) * level->step, spline[i] * spline[j],
                    n);
        }
        for (int s = 0; s < level->nsignals; s++) {
            RowSums sums;
            if (level->empty && level->empty[s])
                continue;
            clear_sums(&sums, n);
            for (int k = 0; k < DENOISE_TAPS; k++) {
                const int dx = (k % DENOISE_TAPS_SIDE - 1) * level->step,
                          dy = (k / DENOISE_TAPS_SIDE - 1) * level->step;
                const ptrdiff_t o = (ptrdiff_t)dy * DENOISE_PITCH + dx;
                Row weights[2];
                weigh_row(weights, &level->from[s], level->kinds[s] + p, taps[k], p, o, n);
                add_row(&sums, &level->from[s], weights, (size_t)((ptrdiff_t)p + o), n);
            }
            store_row(&level->to[s], &level->from[s], &sums, level->epsilons[s], p, DENOISE_TILE + 2 * level->around);
        }
    }
}

RETEX_CPU_INLINE void level_body(const RetexDenoiseLevel *level)
{
    const int n = DENOISE_TILE + 2 * level->around;
    if (n <= DENOISE_TILE)
        level_rows(level, DENOISE_TILE);
    else if (n <= DENOISE_TILE + 16)
        level_rows(level, DENOISE_TILE + 16);
    else
        level_rows(level, DENOISE_PITCH);
}

RETEX_CPU_KERNEL(level, (const RetexDenoiseLevel *level), (level))

RETEX_CPU_OPTIONS("no-tree-vectorize,no-tree-slp-vectorize")
static void level_scalar(const RetexDenoiseLevel *level)
{
    level_body(level);
}

void retex_denoise_level_kernel(const RetexDenoiseLevel *level, int scalar)
{
    (scalar ? level_scalar : level_by_level[retex_cpu_level()])(level);
}
