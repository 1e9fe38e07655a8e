/* One kernel of texture_batch.h, for LANES footprints at a time. Included by texture_batch_kernel.c alone, once for
 * each number of lanes; NAME(x) is that kernel's own x.
 *
 * The road of a footprint: where its mean lies in the image (place_means), which level of the pyramid it is summed on
 * (choose_levels), the ellipse over that level's texels and the blocks of 4 x 4 texels that it meets (find_windows).
 * Footprints of equally many blocks are then weighed together (weigh_*) and each sums its texels (sum_block).
 *
 * Lines are rows of texels, or columns where the ellipse lies flat; a band is four lines. Where an ellipse leans, its
 * bands' blocks go along with it. */

#define Lanes NAME(Lanes)
#define Mask NAME(Mask)
#define Places NAME(Places)
#define Group NAME(Group)
#define Spread NAME(Spread)
#define Ends NAME(Ends)
#define Double NAME(Double)
#define DoubleMask NAME(DoubleMask)
#define Half NAME(Half)
#define HalfMask NAME(HalfMask)
typedef float Lanes __attribute__((vector_size(4 * LANES)));
typedef int Mask __attribute__((vector_size(4 * LANES)));
/* Half of the lanes, as doubles. */
typedef double Double __attribute__((vector_size(4 * LANES)));
typedef int64_t DoubleMask __attribute__((vector_size(4 * LANES)));
typedef float Half __attribute__((vector_size(2 * LANES)));
typedef int HalfMask __attribute__((vector_size(2 * LANES)));

#ifndef TEXTURE_BATCH_CONSTANTS
#define TEXTURE_BATCH_CONSTANTS
#define MAX_BANDS 16
#define MAX_BLOCKS 4 /* across, in a band */
#define MAX_COLUMNS (4 * MAX_BLOCKS + 2)
#define NKEYS (4 * MAX_BANDS * MAX_BLOCKS)
#define NODES 2 /* chords from line to line */
#define BATCH_BOX_VARIANCE (1.0f / 12)
#define BATCH_TENT_VARIANCE (1.0f / 6)
/* The smaller variance that a level leaves a disc, in its texels: of round ones, and of very long ones. */
#define ROUND_LEAST 0.75f
#define LONG_LEAST 0.3f
#define BOX_FROM 0.36f     /* the smaller variance from which level 0's texels need no interpolation */
#define LEAST_KEPT 1e-3f   /* of a cut Gaussian; with less the reference goes on as if there were no end */
#define LEAST_RADIUS 0.02f /* texels */
/* A Gaussian ends at 3.25 standard deviations, lowered so that it is 0 there, which leaves it .9267 of its variance. */
#define GAUSSIAN_REACH 3.25f
#define GAUSSIAN_EDGE 0.0050865f
#define GAUSSIAN_VARIANCE 0.926732f
#define GAUSSIAN_LEAST 0.35f /* the smaller variance, interpolation included, of one sampled at texels */
/* Below, two discs that have a Gaussian's second and fourth moments take its place. */
#define INNER_DISC 0.54119610f
#define OUTER_DISC 1.30656296f

/* Rules of Gauss on 0..1, as in texture_disc_kernel.c: inside, after an ellipse's tip, before one, between both. */
static const float batch_nodes[2][4] = {{0.21132487f, 0.2899492f, 0.17883809f, 0.25f},
                                        {0.78867513f, 0.82116191f, 0.7100508f, 0.75f}};
static const float batch_weights[2][4] = {{0.5f, 0.5154537f, 0.42939674f, 0.45344984f},
                                          {0.5f, 0.42939674f, 0.5154537f, 0.45344984f}};
#endif

#if LANES == 16 /* which weights the texels of a block's row have; turned: [1] */
static const int batch_rows[2][4][16] = {{{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3},
                                          {4, 4, 4, 4, 5, 5, 5, 5, 6, 6, 6, 6, 7, 7, 7, 7},
                                          {8, 8, 8, 8, 9, 9, 9, 9, 10, 10, 10, 10, 11, 11, 11, 11},
                                          {12, 12, 12, 12, 13, 13, 13, 13, 14, 14, 14, 14, 15, 15, 15, 15}},
                                         {{0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12},
                                          {1, 1, 1, 1, 5, 5, 5, 5, 9, 9, 9, 9, 13, 13, 13, 13},
                                          {2, 2, 2, 2, 6, 6, 6, 6, 10, 10, 10, 10, 14, 14, 14, 14},
                                          {3, 3, 3, 3, 7, 7, 7, 7, 11, 11, 11, 11, 15, 15, 15, 15}}};
#endif

/* ---- vectors ---- */

#if LANES == 16
#define MIN(a, b) ((Lanes)_mm512_min_ps((__m512)(a), (__m512)(b)))
#define MAX(a, b) ((Lanes)_mm512_max_ps((__m512)(a), (__m512)(b)))
#define SQRT(a) ((Lanes)_mm512_sqrt_ps((__m512)(a)))
#define LOOK_UP(table, index)                                                                                          \
    ((Lanes)_mm512_permutexvar_ps((__m512i)(index), _mm512_broadcast_f32x4(_mm_loadu_ps(table))))
#define PICK(array, index) ((Lanes)_mm512_i32gather_ps((__m512i)(index), array, 4))
#define OF_LEVEL(table, level) ((Lanes)_mm512_permutexvar_ps((__m512i)(level), _mm512_loadu_ps(table)))
#elif LANES == 8
#define MIN(a, b) ((Lanes)_mm256_min_ps((__m256)(a), (__m256)(b)))
#define MAX(a, b) ((Lanes)_mm256_max_ps((__m256)(a), (__m256)(b)))
#define SQRT(a) ((Lanes)_mm256_sqrt_ps((__m256)(a)))
#define LOOK_UP(table, index)                                                                                          \
    ((Lanes)_mm256_permutevar8x32_ps(_mm256_broadcast_ps((const __m128 *)(const void *)(table)), (__m256i)(index)))
#define PICK(array, index) ((Lanes)_mm256_i32gather_ps(array, (__m256i)(index), 4))
#define OF_LEVEL(table, level)                                                                                         \
    SELECT((level) > 7, (Lanes)_mm256_permutevar8x32_ps(_mm256_loadu_ps((table) + 8), (__m256i)(level)),               \
           (Lanes)_mm256_permutevar8x32_ps(_mm256_loadu_ps(table), (__m256i)(level)))
#else
#define MIN(a, b) NAME(lesser)(a, b)
#define MAX(a, b) NAME(greater)(a, b)
#define SQRT(a) NAME(root)(a)
#define LOOK_UP(table, index) NAME(pick)(table, index)
#define PICK(array, index) NAME(pick)(array, index)
#define OF_LEVEL(table, level) NAME(pick)(table, level)
INLINE Lanes NAME(lesser)(Lanes a, Lanes b)
{
    Mask less = a < b;
    return (Lanes)((less & (Mask)a) | (~less & (Mask)b));
}
INLINE Lanes NAME(greater)(Lanes a, Lanes b)
{
    Mask more = a > b;
    return (Lanes)((more & (Mask)a) | (~more & (Mask)b));
}
INLINE Lanes NAME(root)(Lanes a)
{
    for (int i = 0; i < LANES; i++)
        a[i] = sqrtf(a[i]);
    return a;
}
INLINE Lanes NAME(pick)(const float *array, Mask index)
{
    Lanes out;
    for (int i = 0; i < LANES; i++)
        out[i] = array[index[i]];
    return out;
}
#endif

#define SELECT(mask, a, b) ((Lanes)(((mask) & (Mask)(a)) | (~(mask) & (Mask)(b))))
#define SELECT_INT(mask, a, b) (((mask) & (a)) | (~(mask) & (b)))
#define LOAD(value, from) memcpy(&(value), from, sizeof(value))
#define STORE(to, value) NAME(store)(to, (Mask)(value))
INLINE void NAME(store)(void *to, Mask value)
{
    memcpy(to, &value, sizeof value);
}

INLINE Lanes NAME(all)(float value)
{
    return value - (Lanes){0};
}

INLINE Lanes NAME(to_float)(Mask i)
{
    return __builtin_convertvector(i, Lanes);
}

INLINE Mask NAME(whole_below)(Lanes x)
{
    Mask i = __builtin_convertvector(x, Mask);
    return i + (x < NAME(to_float)(i));
}

#include "texture_batch_place.h"

/* ---- weights ---- */

/* Footprints side by side, of equally many blocks. */
typedef struct Group {
    const BatchTexture *texture;
    const Places *places;
    int index[LANES]; /* in the batch */
    int contiguous;   /* 1: one after the other */
    int turned, fine, bands, blocks, lines, columns;
    Lanes along, across, length, half, slope, lean, reach, first, line, texel; /* the last three: whole numbers */
    Mask level;
    int cut;               /* 1: the surface ends within some of the windows */
    Lanes low[2], high[2]; /* its ends, by lines and texels, from the mean */
    Lanes total, whole;    /* weights: what is left of them, and all */
    float sums[LANES][16]; /* four neighbouring texels' RGBA */
} Group;

/* A band: the first line from the mean, each footprint's first column, where its ellipse's middle lies from there. */
#define Band NAME(Band)
typedef struct Band {
    int lines;
    Lanes begin, middle;
    Mask column;
    Lanes weights[4][4 * MAX_BLOCKS]; /* of texels, by line and column */
} Band;

INLINE void NAME(begin_band)(const Group *g, int number, Band *band)
{
    band->begin = g->first + (float)(4 * number) - g->along;
    band->lines = g->lines - 4 * number < 4 ? g->lines - 4 * number : 4;
    band->column = NAME(whole_below)(g->across + g->lean * (band->begin + 1.5f) - g->reach) + 1;
    band->middle = g->across - NAME(to_float)(band->column);
    for (int j = 0; j < 4; j++)
        for (int c = 0; c < 4 * g->blocks; c++)
            band->weights[j][c] = NAME(all)(0);
}

/* A chord's ends, and its rule's weight. */
#define Chord NAME(Chord)
typedef struct Chord {
    Lanes left, right, weight, share; /* share: how far from the line before to the next one, 0..1 */
} Chord;

/* Chords between `low` and the next line's place; the ellipse's size is given apart, for a Gaussian has two. */
INLINE void NAME(find_chords)(const Group *g, const Band *band, Lanes low, Lanes length, Lanes inverse, Lanes half,
                              Chord *chords)
{
    Lanes high = low + 1, begin = MAX(low, -length), end = MIN(high, length);
    Lanes span = MAX(end - begin, NAME(all)(0));
    Mask rule = ((low < -length) & 1) + ((high > length) & 2);
    for (int k = 0; k < NODES; k++) {
        Lanes at = begin + span * LOOK_UP(batch_nodes[k], rule), u = at * inverse;
        Lanes middle = band->middle + g->slope * at, h = half * SQRT(MAX(1 - u * u, NAME(all)(0)));
        chords[k].left = middle - h;
        chords[k].right = middle + h;
        chords[k].weight = span * LOOK_UP(batch_weights[k], rule);
        chords[k].share = at - low;
    }
}

/* Texels are interpolated: their tents' double integral, differenced twice. */
INLINE void NAME(weigh_fine)(Group *g, Band *band, Lanes length, Lanes half, Lanes scale)
{
    Lanes lines[5][MAX_COLUMNS];
    Chord chords[NODES];
    Lanes inverse = 1 / length;
    for (int j = 0; j < 5; j++)
        for (int c = 0; c < g->columns + 2; c++)
            lines[j][c] = NAME(all)(0);
    for (int i = 0; i <= band->lines; i++) {
        Lanes here[NODES], next[NODES];
        NAME(find_chords)
        (g, band, band->begin + (float)(i - 1), length, inverse, half, chords);
        for (int k = 0; k < NODES; k++) {
            next[k] = chords[k].weight * chords[k].share * scale;
            here[k] = chords[k].weight * scale - next[k];
        }
        Lanes *before = lines[i > 0 ? i - 1 : 4], *after = lines[i < 4 ? i : 4];
        for (int c = 0; c <= g->columns; c++) { /* no chord reaches beyond the last column's neighbour */
            Lanes at = NAME(all)((float)(c - 1)), sum = {0}, more = {0};
            for (int k = 0; k < NODES; k++) {
                Lanes r = MAX(chords[k].right - at, NAME(all)(0)), l = MAX(chords[k].left - at, NAME(all)(0));
                Lanes area = (r - l) * (r + l);
                sum += here[k] * area;
                more += next[k] * area;
            }
            before[c] += sum;
            after[c] += more;
        }
    }
    for (int j = 0; j < band->lines; j++)
        for (int c = 0; c < g->columns; c++) {
            Lanes w = (lines[j][c] - lines[j][c + 1]) - (lines[j][c + 1] - lines[j][c + 2]);
            band->weights[j][c] += MAX(w, NAME(all)(0));
        }
}

/* Texels are averages over squares: how much of a chord each covers. */
INLINE void NAME(weigh_boxes)(Group *g, Band *band)
{
    Chord chords[NODES];
    Lanes inverse = 1 / g->length;
    for (int j = 0; j < band->lines; j++) {
        NAME(find_chords)
        (g, band, band->begin + ((float)j - 0.5f), g->length, inverse, g->half, chords);
        for (int c = 0; c < g->columns; c++) {
            Lanes begin = NAME(all)((float)c - 0.5f), end = NAME(all)((float)c + 0.5f), w = {0};
            for (int k = 0; k < NODES; k++)
                w += chords[k].weight * MAX(MIN(chords[k].right, end) - MAX(chords[k].left, begin), NAME(all)(0));
            band->weights[j][c] = w;
        }
    }
}

/* exp(-x) for 0 <= x <= 5.3, as the eighth power of a polynomial. */
INLINE Lanes NAME(exp_minus)(Lanes x)
{
    Lanes y = x * -0.125f;
    Lanes p = 1 + y * (1 + y * (0.5f + y * (0.16666667f + y * (0.041666667f + y * 0.0083333333f))));
    p *= p;
    p *= p;
    return p * p;
}

INLINE void NAME(weigh_gaussian)(Group *g, Band *band)
{
    Lanes down = GAUSSIAN_REACH / g->length, over = GAUSSIAN_REACH / g->half;
    const Lanes most = NAME(all)(0.5f * GAUSSIAN_REACH * GAUSSIAN_REACH);
    for (int j = 0; j < band->lines; j++) {
        Lanes y = band->begin + (float)j, v = y * down, middle = (band->middle + g->slope * y) * over;
        Lanes square = v * v;
        for (int c = 0; c < g->columns; c++) {
            Lanes u = (float)c * over - middle, q = MIN((u * u + square) * 0.5f, most);
            band->weights[j][c] = MAX(NAME(exp_minus)(q) - GAUSSIAN_EDGE, NAME(all)(0));
        }
    }
}

/* Take off what lies beyond the surface's ends. */
INLINE void NAME(cut_band)(Group *g, Band *band)
{
    Lanes across[4 * MAX_BLOCKS];
    for (int c = 0; c < g->columns; c++)
        across[c] = NAME(share_within)((float)c - band->middle, g->low[1], g->high[1]);
    for (int j = 0; j < band->lines; j++) {
        Lanes along = NAME(share_within)(band->begin + (float)j, g->low[0], g->high[0]);
        for (int c = 0; c < g->columns; c++) {
            g->whole += band->weights[j][c];
            band->weights[j][c] *= along * across[c];
        }
    }
}

INLINE void NAME(weigh_band)(Group *g, int number, Band *band)
{
    NAME(begin_band)(g, number, band);
    if (g->texture->gaussian && g->fine) {
        /* both discs weigh the same: each chord counts by its own ellipse's area */
        float in = INNER_DISC / OUTER_DISC;
        NAME(weigh_fine)(g, band, g->length * in, g->half * in, NAME(all)(1 / (in * in)));
        NAME(weigh_fine)(g, band, g->length, g->half, NAME(all)(1));
    } else if (g->texture->gaussian) {
        NAME(weigh_gaussian)(g, band);
    } else if (g->fine) {
        NAME(weigh_fine)(g, band, g->length, g->half, NAME(all)(1));
    } else {
        NAME(weigh_boxes)(g, band);
    }
    if (g->cut)
        NAME(cut_band)(g, band);
    for (int j = 0; j < band->lines; j++)
        for (int c = 0; c < g->columns; c++)
            g->total += band->weights[j][c];
}

/* ---- sums ---- */

/* A block's weights, footprint by footprint. */
INLINE void NAME(turn_weights)(const Band *band, int block, float out[LANES][MAX_BLOCKS][16])
{
    const Lanes *w[4];
    for (int j = 0; j < 4; j++)
        w[j] = &band->weights[j][4 * block];
#if LANES == 16
    __m512 a[16], b[16];
    for (int i = 0; i < 16; i += 4) {
        const __m512 *r = (const __m512 *)w[i / 4];
        a[i] = _mm512_unpacklo_ps(r[0], r[1]);
        a[i + 1] = _mm512_unpackhi_ps(r[0], r[1]);
        a[i + 2] = _mm512_unpacklo_ps(r[2], r[3]);
        a[i + 3] = _mm512_unpackhi_ps(r[2], r[3]);
    }
    for (int i = 0; i < 16; i += 4) { /* b[i + k]: columns of line i / 4, of lanes k, k + 4, k + 8, k + 12 */
        b[i] = (__m512)_mm512_unpacklo_pd((__m512d)a[i], (__m512d)a[i + 2]);
        b[i + 1] = (__m512)_mm512_unpackhi_pd((__m512d)a[i], (__m512d)a[i + 2]);
        b[i + 2] = (__m512)_mm512_unpacklo_pd((__m512d)a[i + 1], (__m512d)a[i + 3]);
        b[i + 3] = (__m512)_mm512_unpackhi_pd((__m512d)a[i + 1], (__m512d)a[i + 3]);
    }
    for (int k = 0; k < 4; k++) {
        __m512 p = _mm512_shuffle_f32x4(b[k], b[k + 4], 0x88), q = _mm512_shuffle_f32x4(b[k], b[k + 4], 0xdd);
        __m512 r = _mm512_shuffle_f32x4(b[k + 8], b[k + 12], 0x88), s = _mm512_shuffle_f32x4(b[k + 8], b[k + 12], 0xdd);
        _mm512_storeu_ps(out[k][block], _mm512_shuffle_f32x4(p, r, 0x88));
        _mm512_storeu_ps(out[k + 8][block], _mm512_shuffle_f32x4(p, r, 0xdd));
        _mm512_storeu_ps(out[k + 4][block], _mm512_shuffle_f32x4(q, s, 0x88));
        _mm512_storeu_ps(out[k + 12][block], _mm512_shuffle_f32x4(q, s, 0xdd));
    }
#elif LANES == 8
    for (int j = 0; j < 4; j++) {
        const __m256 *r = (const __m256 *)w[j];
        __m256 a = _mm256_unpacklo_ps(r[0], r[1]), b = _mm256_unpackhi_ps(r[0], r[1]);
        __m256 c = _mm256_unpacklo_ps(r[2], r[3]), d = _mm256_unpackhi_ps(r[2], r[3]);
        __m256 lanes[4] = {
            (__m256)_mm256_unpacklo_pd((__m256d)a, (__m256d)c), (__m256)_mm256_unpackhi_pd((__m256d)a, (__m256d)c),
            (__m256)_mm256_unpacklo_pd((__m256d)b, (__m256d)d), (__m256)_mm256_unpackhi_pd((__m256d)b, (__m256d)d)};
        for (int k = 0; k < 4; k++) {
            _mm_storeu_ps(out[k][block] + 4 * j, _mm256_castps256_ps128(lanes[k]));
            _mm_storeu_ps(out[k + 4][block] + 4 * j, _mm256_extractf128_ps(lanes[k], 1));
        }
    }
#else
    for (int lane = 0; lane < LANES; lane++)
        for (int j = 0; j < 4; j++)
            for (int c = 0; c < 4; c++)
                out[lane][block][4 * j + c] = w[j][c][lane];
#endif
}

/* Add a band's texels to four sums, one for every fourth column. Weights come by lines, which may be columns. The
 * blocks lie `step` texels apart. */
INLINE void NAME(sum_texels)(float sums[16], const float weights[][16], int blocks, int turned, int narrow,
                             const char *texels, size_t stride, size_t step)
{
    size_t size = narrow ? 4 * sizeof(uint16_t) : 4 * sizeof(float);
#if LANES == 16
    const __m512i *rows = (const __m512i *)batch_rows[turned];
    __m512 sum = _mm512_loadu_ps(sums);
    for (int k = 0; k < blocks; k++) {
        __m512 w = _mm512_loadu_ps(weights[k]);
        const char *from = texels + (size_t)k * step * size;
        for (int r = 0; r < 4; r++, from += stride * size) {
            __m512 t = narrow ? _mm512_cvtepi32_ps(_mm512_cvtepu16_epi32(_mm256_loadu_si256((const __m256i *)from)))
                              : _mm512_loadu_ps((const float *)(const void *)from);
            sum = _mm512_add_ps(sum, _mm512_mul_ps(t, _mm512_permutexvar_ps(_mm512_loadu_si512(rows + r), w)));
        }
    }
    _mm512_storeu_ps(sums, sum);
#elif LANES == 8
    int row = turned ? 1 : 4, column = turned ? 4 : 1;
    __m256 low = _mm256_loadu_ps(sums), high = _mm256_loadu_ps(sums + 8);
    for (int k = 0; k < blocks; k++) {
        const char *from = texels + (size_t)k * step * size;
        const float *w = weights[k];
        for (int r = 0; r < 4; r++, from += stride * size, w += row) {
            __m256 a, b;
            if (narrow) {
                __m128i c = _mm_loadu_si128((const __m128i *)from), d = _mm_loadu_si128((const __m128i *)from + 1);
                a = _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(c));
                b = _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(d));
            } else {
                a = _mm256_loadu_ps((const float *)(const void *)from);
                b = _mm256_loadu_ps((const float *)(const void *)from + 8);
            }
            __m256 first = _mm256_insertf128_ps(_mm256_broadcast_ss(w), _mm_broadcast_ss(w + column), 1);
            __m256 second =
                _mm256_insertf128_ps(_mm256_broadcast_ss(w + 2 * column), _mm_broadcast_ss(w + 3 * column), 1);
            low = _mm256_add_ps(low, _mm256_mul_ps(a, first));
            high = _mm256_add_ps(high, _mm256_mul_ps(b, second));
        }
    }
    _mm256_storeu_ps(sums, low);
    _mm256_storeu_ps(sums + 8, high);
#else
    int row = turned ? 1 : 4, column = turned ? 4 : 1;
    Float4 sum[4];
    memcpy(sum, sums, sizeof sum);
    for (int k = 0; k < blocks; k++) {
        const char *from = texels + (size_t)k * step * size;
        for (int r = 0; r < 4; r++, from += stride * size)
            for (int c = 0; c < 4; c++)
                sum[c] += raw_texel(from + (size_t)c * size, narrow) * weights[k][row * r + column * c];
    }
    memcpy(sums, sum, sizeof sum);
#endif
}

/* Where a band's blocks lie in their levels, or the padded copies of these: texels from the first one; -1 where some
 * lie outside. */
INLINE Mask NAME(find_blocks)(const Group *g, int number, const Band *band, Mask *x, Mask *y)
{
    const BatchTexture *t = g->texture;
    Mask lines = (Mask)g->line + 4 * number, texels = (Mask)g->texel + band->column;
    *x = g->turned ? lines : texels;
    *y = g->turned ? texels : lines;
    Mask padding = __builtin_convertvector(OF_LEVEL(t->padding, g->level), Mask);
    Mask width = __builtin_convertvector(OF_LEVEL(t->texels[0], g->level), Mask) + 2 * padding;
    Mask height = __builtin_convertvector(OF_LEVEL(t->texels[1], g->level), Mask) + 2 * padding;
    int across = 4 * g->blocks;
    Mask column = *x + padding, row = *y + padding;
    Mask inside = (column >= 0) & (row >= 0) & (column <= width - (g->turned ? 4 : across)) &
                  (row <= height - (g->turned ? across : 4));
    return ((row * width + column) & inside) | ~inside;
}

INLINE void NAME(sum_band)(Group *g, int number, const Band *band, int turned, int narrow)
{
    float weights[LANES][MAX_BLOCKS][16];
    int first[LANES], columns[LANES], rows[LANES], levels[LANES];
    Mask x, y, begin = NAME(find_blocks)(g, number, band, &x, &y);
    STORE(first, begin);
    STORE(columns, x);
    STORE(rows, y);
    STORE(levels, g->level);
    for (int k = 0; k < g->blocks; k++)
        NAME(turn_weights)(band, k, weights);
    for (int lane = 0; lane < LANES; lane++) {
        const TextureLevel *level = &g->texture->texture->levels[levels[lane]];
        size_t stride = (size_t)(level->width + 2 * level->padding);
        const float(*own)[16] = (const float(*)[16])weights[lane];
        if (first[lane] >= 0) {
            const char *texels =
                (const char *)(level->padded ? level->padded : level->texels) + (size_t)first[lane] * (narrow ? 8 : 16);
            NAME(sum_texels)(g->sums[lane], own, g->blocks, turned, narrow, texels, stride, turned ? 4 * stride : 4);
        } else {
            for (int k = 0; k < g->blocks; k++) {
                char around[16 * 4 * sizeof(float)];
                texture_gather_block(g->texture->texture, level, columns[lane] + (turned ? 0 : 4 * k),
                                     rows[lane] + (turned ? 4 * k : 0), around);
                NAME(sum_texels)(g->sums[lane], own + k, 1, turned, narrow, around, 4, 0);
            }
        }
    }
}

INLINE void NAME(sum_blocks)(Group *g, int number, const Band *band)
{
    int narrow = g->texture->texture->narrow;
    if (g->turned && narrow)
        NAME(sum_band)(g, number, band, 1, 1);
    else if (g->turned)
        NAME(sum_band)(g, number, band, 1, 0);
    else if (narrow)
        NAME(sum_band)(g, number, band, 0, 1);
    else
        NAME(sum_band)(g, number, band, 0, 0);
}

/* The surface's ends, if there are any within the windows. */
INLINE int NAME(load_ends)(Group *g)
{
    const Places *p = g->places;
    int cut = 0;
    for (int lane = 0; lane < LANES && g->texture->limited; lane++)
        cut |= p->cut[g->index[lane]];
    for (int k = 0; k < 2 && cut; k++)
        for (int lane = 0; lane < LANES; lane++) {
            g->low[k][lane] = p->low[k][g->index[lane]];
            g->high[k][lane] = p->high[k][g->index[lane]];
        }
    return cut;
}

INLINE void NAME(filter_group)(Group *g, Batch *batch)
{
    Band band;
    const Places *p = g->places;
    const void *arrays[] = {p->along, p->across, p->length, p->half,  p->slope, p->lean,
                            p->reach, p->first,  p->line,   p->texel, p->level};
    Lanes values[11];
    if (g->contiguous) {
        for (int k = 0; k < 11; k++)
            LOAD(values[k], (const float *)arrays[k] + g->index[0]);
    } else {
        Mask index;
        LOAD(index, g->index);
        for (int k = 0; k < 11; k++)
            values[k] = PICK((const float *)arrays[k], index);
    }
    g->along = values[0];
    g->across = values[1];
    g->length = values[2];
    g->half = values[3];
    g->slope = values[4];
    g->lean = values[5];
    g->reach = values[6];
    g->first = NAME(to_float)((Mask)values[7]);
    g->line = values[8];
    g->texel = values[9];
    g->level = (Mask)values[10];
    g->cut = NAME(load_ends)(g);
    g->total = g->whole = NAME(all)(0);
    memset(g->sums, 0, sizeof g->sums);
    for (int b = 0; b < g->bands; b++) {
        NAME(weigh_band)(g, b, &band);
        NAME(sum_blocks)(g, b, &band);
    }
    Lanes inverse = 1 / (g->total * (g->texture->texture->narrow ? NARROW_ONE : 1));
    for (int lane = 0; lane < LANES; lane++) {
        const float *s = g->sums[lane];
        Float4 sum = ((load4(s) + load4(s + 4)) + (load4(s + 8) + load4(s + 12))) * inverse[lane];
        memcpy(batch->rgba[g->index[lane]], &sum, sizeof sum);
    }
    for (int lane = 0; lane < LANES && g->cut; lane++)
        if (!(g->total[lane] > LEAST_KEPT * g->whole[lane]) && (lane == 0 || g->index[lane] != g->index[lane - 1]))
            batch->left[batch->nleft++] = g->index[lane];
}

/* Side by side go those of equal keys, for which counting is sorting. */
static void NAME(filter_batch)(const BatchTexture *texture, Batch *batch)
{
    Places places;
    Group group = {.texture = texture, .places = &places};
    int ends[NKEYS + 1], order[BATCH_SIZE], begin = 0;
    for (int i = batch->count; i % LANES; i++) { /* footprints of no meaning, for whole vectors */
        batch->u[i] = batch->v[i] = batch->su[i] = batch->sv[i] = batch->correlation[i] = 0;
    }
    for (int i = 0; i < batch->count; i += LANES)
        NAME(place)(texture, batch, &places, i);
    NAME(leave_borders)(texture, batch->count, &places);

    memset(ends, 0, sizeof ends);
    for (int i = 0; i < batch->count; i++)
        ends[places.key[i]]++;
    for (int k = 0, sum = 0; k <= NKEYS; k++) {
        int count = ends[k];
        ends[k] = sum;
        sum += count;
    }
    for (int i = 0; i < batch->count; i++)
        order[ends[places.key[i]]++] = i;

    batch->nleft = 0;
    for (int key = 0; key < NKEYS; key++) {
        group.turned = key / (2 * MAX_BANDS * MAX_BLOCKS);
        group.fine = key / (MAX_BANDS * MAX_BLOCKS) % 2;
        group.bands = key / MAX_BLOCKS % MAX_BANDS + 1;
        group.blocks = key % MAX_BLOCKS + 1;
        for (; begin < ends[key]; begin += LANES) {
            group.lines = group.columns = 1;
            for (int lane = 0; lane < LANES; lane++) { /* what is missing at the end does the last one again */
                int i = order[begin + lane < ends[key] ? begin + lane : ends[key] - 1];
                group.index[lane] = i;
                group.lines = places.lines[i] > group.lines ? places.lines[i] : group.lines;
                group.columns = places.columns[i] > group.columns ? places.columns[i] : group.columns;
            }
            group.contiguous = begin + LANES <= ends[key] && group.index[LANES - 1] == group.index[0] + LANES - 1;
            NAME(filter_group)(&group, batch);
        }
        begin = ends[key];
    }
    while (begin < batch->count)
        batch->left[batch->nleft++] = order[begin++];
}

#undef Lanes
#undef Mask
#undef Places
#undef Group
#undef Band
#undef Chord
#undef MIN
#undef MAX
#undef SQRT
#undef LOOK_UP
#undef PICK
#undef OF_LEVEL
#undef SELECT
#undef SELECT_INT
#undef LOAD
#undef STORE
#undef Spread
#undef Ends
#undef Double
#undef DoubleMask
#undef Half
#undef HalfMask
