/* One kernel of batch.h, for LANES footprints at a time. Included by batch_kernel.c alone, once for each number of
 * lanes; NAME(x) is that kernel's own x.
 *
 * The steps for a footprint: find its mean in the image, choose the level of the pyramid, compute the ellipse over that
 * level's texels and the blocks of 4 x 4 texels that it meets (place). Footprints with about the same number of blocks
 * are then grouped, their weights computed together (weigh_*), and each sums its texels (sum_texels). Lines are rows of
 * texels, or columns where the ellipse is flat; a band is four lines. Where an ellipse is oblique, the blocks of its
 * bands follow it. */

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
#define MAX_BANDS 36
#define MAX_BLOCKS 4 /* blocks across in a band */
#define MAX_COLUMNS (4 * MAX_BLOCKS + 2)
#define NKEYS (8 * MAX_BANDS * MAX_BLOCKS)
#define NODES 2 /* chords between two lines */
#define BATCH_BOX_VARIANCE (1.0f / 12)
#define BATCH_TENT_VARIANCE (1.0f / 6)
/* The smaller variance, in texels of the level, that remains for a disc: for round ones, and for very long ones. */
#define ROUND_LEAST 0.75f
#define LONG_LEAST 0.3f
#define BOX_FROM 0.36f     /* the smaller variance from which level 0's texels need no interpolation */
#define LEAST_KEPT 1e-3f   /* share of a cut Gaussian that must remain; with less the reference ignores the limit */
#define LEAST_RADIUS 0.02f /* texels */
/* A Gaussian ends at 2.5 standard deviations, lowered so that it is 0 there, which leaves .7383 of its variance. */
#define GAUSSIAN_REACH 2.5f
#define GAUSSIAN_EDGE 0.043975f
#define GAUSSIAN_VARIANCE 0.737975f
/* With a smaller variance two discs that have the Gaussian's second and fourth moments replace it. */
#define INNER_DISC 0.54119610f
#define OUTER_DISC 1.30656296f

/* Gauss's quadrature rules on 0..1, as in disc_kernel.c: inside, after an ellipse's tip, before one, between both. */
static const float batch_nodes[2][4] = {{0.21132487f, 0.2899492f, 0.17883809f, 0.25f},
                                        {0.78867513f, 0.82116191f, 0.7100508f, 0.75f}};
static const float batch_weights[2][4] = {{0.5f, 0.5154537f, 0.42939674f, 0.45344984f},
                                          {0.5f, 0.42939674f, 0.5154537f, 0.45344984f}};
#endif

#if LANES == 16 /* indices of the weights of a block's row of texels; turned: [1] */
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
RETEX_CPU_INLINE Lanes NAME(lesser)(Lanes a, Lanes b)
{
    Mask less = a < b;
    return (Lanes)((less & (Mask)a) | (~less & (Mask)b));
}
RETEX_CPU_INLINE Lanes NAME(greater)(Lanes a, Lanes b)
{
    Mask more = a > b;
    return (Lanes)((more & (Mask)a) | (~more & (Mask)b));
}
RETEX_CPU_INLINE Lanes NAME(root)(Lanes a)
{
    for (int i = 0; i < LANES; i++)
        a[i] = sqrtf(a[i]);
    return a;
}
RETEX_CPU_INLINE Lanes NAME(pick)(const float *array, Mask index)
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
RETEX_CPU_INLINE void NAME(store)(void *to, Mask value)
{
    memcpy(to, &value, sizeof value);
}

RETEX_CPU_INLINE Lanes NAME(all)(float value)
{
    return value - (Lanes){0};
}

RETEX_CPU_INLINE Lanes NAME(to_float)(Mask i)
{
    return __builtin_convertvector(i, Lanes);
}

RETEX_CPU_INLINE Mask NAME(whole_below)(Lanes x)
{
    Mask i = __builtin_convertvector(x, Mask);
    return i + (x < NAME(to_float)(i));
}

#include <retex/host/cpu.h>

#include "texture/batch_place.h"

/* ---- weights ---- */

/* Footprints that are computed together, one in each lane, with about the same number of blocks. */
typedef struct Group {
    const RetexBatchTexture *texture;
    const Places *places;
    int count;        /* lanes with a footprint of their own; further lanes repeat the last one */
    int index[LANES]; /* index in the batch */
    int contiguous;   /* 1: consecutive in the batch */
    int turned, fine, bands, blocks, lines, columns;
    Lanes along, across, length, half, slope, lean, reach, first, line, texel; /* the last three are whole numbers */
    Mask level;
    int cut;               /* 1: the surface ends within the windows */
    Lanes low[2], high[2]; /* limits of the surface, in lines and texels from the mean */
    Lanes total, whole;    /* sum of weights within the limits, and of all weights */
    float sums[LANES][16]; /* sums of RGBA, one for each of four neighbouring texels */
} Group;

/* A band: the first line, each footprint's first column, and the middle of its ellipse from there, all from the
 * mean. */
#define Band NAME(Band)
typedef struct Band {
    int lines;
    Lanes begin, middle;
    Mask column;
    Lanes weights[4][4 * MAX_BLOCKS]; /* weights of texels, by line and column */
} Band;

RETEX_CPU_INLINE void NAME(begin_band)(const Group *g, int number, Band *band)
{
    band->begin = g->first + (float)(4 * number) - g->along;
    band->lines = g->lines - 4 * number < 4 ? g->lines - 4 * number : 4;
    band->column = NAME(whole_below)(g->across + g->lean * (band->begin + 1.5f) - g->reach) + 1;
    band->middle = g->across - NAME(to_float)(band->column);
    for (int j = 0; j < 4; j++) /* other weights are written before they are read */
        for (int c = j < band->lines ? g->columns : 0; c < 4 * g->blocks; c++)
            band->weights[j][c] = NAME(all)(0);
}

/* The ends of a chord, and its weight in the quadrature. */
#define Chord NAME(Chord)
typedef struct Chord {
    Lanes left, right, weight, share; /* share: fraction of the way from the line before to the next one, 0..1 */
} Chord;

/* Finds the chords between `low` and the next line. The size of the ellipse is an argument, because a Gaussian has
 * two. */
RETEX_CPU_INLINE void NAME(find_chords)(const Group *g, const Band *band, Lanes low, Lanes length, Lanes inverse,
                                        Lanes half, Chord *chords)
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

/* Weights of interpolated texels: the double integral of their tents, differenced twice. Adds to the weights, or sets
 * them. */
RETEX_CPU_INLINE void NAME(weigh_fine)(Group *g, Band *band, Lanes length, Lanes half, Lanes scale, int is_added)
{
    Lanes lines[5][MAX_COLUMNS]; /* the last one is not used */
    Chord chords[NODES];
    Lanes inverse = 1 / length;
    for (int c = 0; c <= g->columns; c++)
        lines[4][c] = NAME(all)(0);
    for (int i = 0; i <= band->lines; i++) {
        Lanes here[NODES], next[NODES];
        NAME(find_chords)
        (g, band, band->begin + (float)(i - 1), length, inverse, half, chords);
        for (int k = 0; k < NODES; k++) {
            next[k] = chords[k].weight * chords[k].share * scale;
            here[k] = chords[k].weight * scale - next[k];
        }
        Lanes *before = lines[i > 0 ? i - 1 : 4], *after = lines[i < 4 ? i : 4];
        for (int c = 0; c <= g->columns; c++) { /* no chord goes beyond the neighbour of the last column */
            Lanes at = NAME(all)((float)(c - 1)), sum = {0}, more = {0};
            for (int k = 0; k < NODES; k++) {
                Lanes r = MAX(chords[k].right - at, NAME(all)(0)), l = MAX(chords[k].left - at, NAME(all)(0));
                Lanes area = (r - l) * (r + l);
                sum += here[k] * area;
                more += next[k] * area;
            }
            before[c] += sum;
            after[c] = more;
        }
        after[g->columns + 1] = NAME(all)(0);
    }
    for (int j = 0; j < band->lines; j++)
        for (int c = 0; c < g->columns; c++) {
            Lanes w = (lines[j][c] - lines[j][c + 1]) - (lines[j][c + 1] - lines[j][c + 2]);
            w = MAX(w, NAME(all)(0));
            band->weights[j][c] = is_added ? band->weights[j][c] + w : w;
        }
}

/* Weights of texels that are averages over squares: the length of each chord in each texel. */
RETEX_CPU_INLINE void NAME(weigh_boxes)(Group *g, Band *band)
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

/* exp(-x) with an error below 4e-5 for 0 <= x <= 3.125: the eighth power of a fitted polynomial; less than
 * GAUSSIAN_EDGE at the end. */
RETEX_CPU_INLINE Lanes NAME(exp_minus)(Lanes x)
{
    Lanes p = 0.99999528f + x * (-0.12493123f + x * (0.0076847804f + x * -0.00025969859f));
    p *= p;
    p *= p;
    return p * p;
}

RETEX_CPU_INLINE void NAME(weigh_gaussian)(Group *g, Band *band, int nlines, int ncolumns)
{
    const float reach = GAUSSIAN_REACH * 0.70710678f; /* so that the squares are the exponents */
    Lanes down = reach / g->length, over = reach / g->half, columns[4 * MAX_BLOCKS];
    const Lanes most = NAME(all)(0.5f * GAUSSIAN_REACH * GAUSSIAN_REACH);
    for (int c = 0; c < ncolumns; c++)
        columns[c] = (float)c * over;
    for (int j = 0; j < nlines; j++) {
        Lanes y = band->begin + (float)j, v = y * down, middle = (band->middle + g->slope * y) * over;
        Lanes square = v * v;
        for (int c = 0; c < ncolumns; c++) {
            Lanes u = columns[c] - middle, q = MIN(u * u + square, most);
            band->weights[j][c] = MAX(NAME(exp_minus)(q) - GAUSSIAN_EDGE, NAME(all)(0));
        }
    }
}

/* Cuts off weights beyond the limits of the surface. */
RETEX_CPU_INLINE void NAME(cut_band)(Group *g, Band *band, int nlines, int ncolumns)
{
    Lanes across[4 * MAX_BLOCKS];
    for (int c = 0; c < ncolumns; c++)
        across[c] = NAME(share_within)((float)c - band->middle, g->low[1], g->high[1]);
    for (int j = 0; j < nlines; j++) {
        Lanes along = NAME(share_within)(band->begin + (float)j, g->low[0], g->high[0]);
        for (int c = 0; c < ncolumns; c++) {
            g->whole += band->weights[j][c];
            band->weights[j][c] *= along * across[c];
        }
    }
}

RETEX_CPU_INLINE void NAME(add_total)(Group *g, const Band *band, int nlines, int ncolumns)
{
    for (int j = 0; j < nlines; j++)
        for (int c = 0; c < ncolumns; c++)
            g->total += band->weights[j][c];
}

RETEX_CPU_INLINE void NAME(weigh_band)(Group *g, int number, Band *band)
{
    NAME(begin_band)(g, number, band);
    if (g->texture->gaussian && g->fine) {
        /* both discs have the same weight: each chord is divided by the area of its own ellipse */
        float in = INNER_DISC / OUTER_DISC;
        NAME(weigh_fine)(g, band, g->length * in, g->half * in, NAME(all)(1 / (in * in)), 0);
        NAME(weigh_fine)(g, band, g->length, g->half, NAME(all)(1), 1);
    } else if (g->texture->gaussian) {
        NAME(weigh_gaussian)(g, band, band->lines, g->columns);
    } else if (g->fine) {
        NAME(weigh_fine)(g, band, g->length, g->half, NAME(all)(1), 0);
    } else {
        NAME(weigh_boxes)(g, band);
    }
    if (g->cut)
        NAME(cut_band)(g, band, band->lines, g->columns);
    NAME(add_total)(g, band, band->lines, g->columns);
}

#include "texture/batch_sum.h"

/* Loads the group's footprints. */
RETEX_CPU_INLINE void NAME(load_group)(Group *g)
{
    const Places *p = g->places;
    const void *arrays[] = {p->along, p->across, p->length, p->half,   p->slope,  p->lean,    p->reach,  p->first,
                            p->line,  p->texel,  p->level,  p->low[0], p->low[1], p->high[0], p->high[1]};
    const int count = g->cut ? 15 : 11;
    Lanes values[15];
    Mask index;
    LOAD(index, g->index);
    for (int k = 0; k < count; k++)
        if (g->contiguous)
            LOAD(values[k], (const float *)arrays[k] + g->index[0]);
        else
            values[k] = PICK((const float *)arrays[k], index);
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
    for (int k = 0; k < 2 && g->cut; k++) {
        g->low[k] = values[11 + k];
        g->high[k] = values[13 + k];
    }
    g->total = g->whole = NAME(all)(0);
    memset(g->sums, 0, sizeof g->sums);
}

/* Writes the group's colours. */
RETEX_CPU_INLINE void NAME(store_group)(const Group *g, RetexBatch *batch)
{
    Lanes inverse = 1 / (g->total * (g->texture->texture->narrow ? NARROW_ONE : 1));
    for (int lane = 0; lane < g->count; lane++) {
        const float *s = g->sums[lane];
        RetexFloat4 sum = ((load4(s) + load4(s + 4)) + (load4(s + 8) + load4(s + 12))) * inverse[lane];
        memcpy(batch->rgba[g->index[lane]], &sum, sizeof sum);
    }
    for (int lane = 0; lane < g->count && g->cut; lane++)
        if (!(g->total[lane] > LEAST_KEPT * g->whole[lane]))
            batch->left[batch->nleft++] = g->index[lane];
}

RETEX_CPU_INLINE void NAME(filter_group)(Group *g, RetexBatch *batch)
{
    Band band;
    NAME(load_group)(g);
    for (int b = 0; b < g->bands; b++) {
        NAME(weigh_band)(g, b, &band);
        NAME(sum_blocks)(g, b, &band);
    }
    NAME(store_group)(g, batch);
}

/* Sorts the pending footprints of a batch by key, by counting; returns how many have one. `order`: indices by key;
 * ends[k]: end of key k in it. */
RETEX_CPU_INLINE int NAME(sort)(const int *pending, int npending, const Places *places, int *order, int *ends)
{
    int sum = 0;
    memset(ends, 0, sizeof *ends * (NKEYS + 1));
    for (int i = 0; i < npending; i++)
        ends[places->key[pending[i]]]++;
    for (int k = 0; k <= NKEYS; k++) {
        int count = ends[k];
        ends[k] = sum;
        sum += count;
    }
    for (int i = 0; i < npending; i++)
        order[ends[places->key[pending[i]]]++] = pending[i];
    return ends[NKEYS - 1];
}

/* Forms a group, one full vector of footprints, from `begin` of the order on: those of one key and, in the remaining
 * lanes, those of the next keys, if that saves a group at a smaller cost than it adds to this one. */
RETEX_CPU_INLINE void NAME(form_group)(Group *g, const int *order, const int *ends, int begin)
{
    const int key = g->places->key[order[begin]], kinds = MAX_BANDS * MAX_BLOCKS;
    g->cut = key / (4 * kinds);
    g->turned = key / (2 * kinds) % 2;
    g->fine = key / kinds % 2;
    g->bands = key / MAX_BLOCKS % MAX_BANDS + 1;
    g->blocks = key % MAX_BLOCKS + 1;
    g->count = ends[key] - begin < LANES ? ends[key] - begin : LANES;
    for (int next = key + 1; g->count < LANES && next % kinds; next++) {
        int bands = next / MAX_BLOCKS % MAX_BANDS + 1, blocks = next % MAX_BLOCKS + 1, own = bands * blocks;
        int waiting = ends[next] - ends[next - 1], lanes_left = LANES - g->count,
            taken = waiting < lanes_left ? waiting : lanes_left;
        if (!waiting)
            continue;
        bands = bands > g->bands ? bands : g->bands;
        blocks = blocks > g->blocks ? blocks : g->blocks;
        if ((waiting - taken + LANES - 1) / LANES == (waiting + LANES - 1) / LANES ||
            bands * blocks >= g->bands * g->blocks + own)
            break;
        g->bands = bands;
        g->blocks = blocks;
        g->count += taken;
    }
    g->lines = g->columns = 1;
    for (int lane = 0; lane < LANES; lane++) {
        int i = order[begin + (lane < g->count ? lane : g->count - 1)];
        g->index[lane] = i;
        g->lines = g->places->lines[i] > g->lines ? g->places->lines[i] : g->lines;
        g->columns = g->places->columns[i] > g->columns ? g->places->columns[i] : g->columns;
    }
    /* 1 for one key, whose footprints are in the batch's order */
    g->contiguous = begin + LANES <= ends[key] && g->index[LANES - 1] == g->index[0] + LANES - 1;
}

/* Forms a group of the footprints from i on, if all their windows have at most 4 x 4 texels, as many broad footprints
 * have. */
RETEX_CPU_INLINE int NAME(form_row)(Group *g, int count, int i)
{
    Mask key;
    LOAD(key, g->places->key + i);
    const Mask larger = (key != 0) & (key != 4 * MAX_BANDS * MAX_BLOCKS);
    int others = 0;
    for (int lane = 0; lane < LANES; lane++)
        others |= larger[lane];
    g->cut = g->texture->limited;
    g->turned = g->fine = 0;
    g->bands = g->blocks = g->contiguous = 1;
    g->count = count - i < LANES ? count - i : LANES;
    for (int lane = 0; lane < LANES; lane++)
        g->index[lane] = i + lane;
    return !others;
}

/* The weights and texels of such a group. */
RETEX_CPU_INLINE void NAME(weigh_row)(Group *g, Blocks *blocks)
{
    Band band;
    g->lines = g->columns = 4;
    NAME(load_group)(g);
    NAME(begin_band)(g, 0, &band);
    NAME(weigh_gaussian)(g, &band, 4, 4);
    if (g->cut)
        NAME(cut_band)(g, &band, 4, 4);
    NAME(add_total)(g, &band, 4, 4);
    NAME(find_blocks)(g, 0, &band, 0, blocks);
}

/* Computes the places of all footprints, and filters broad ones in rows, each while the texels of the next one are
 * loaded. Returns how many are pending. */
RETEX_CPU_INLINE int NAME(filter_rows)(const RetexBatchTexture *texture, RetexBatch *batch, Places *places,
                                       int *pending)
{
    Group groups[2] = {{.texture = texture, .places = places}, {.texture = texture, .places = places}};
    Blocks blocks[2];
    const int in_rows = texture->broad && !texture->black[0] && !texture->black[1], narrow = texture->texture->narrow;
    int npending = 0, waiting = 0, is_row = 0;
    for (int i = 0; i < batch->count || is_row; i += LANES) {
        const int next = !waiting, was_row = is_row;
        is_row = 0;
        if (i < batch->count) {
            NAME(place)(texture, batch, places, i);
            is_row = in_rows && NAME(form_row)(&groups[next], batch->count, i);
            for (int k = i; k < i + LANES && k < batch->count && !is_row; k++)
                pending[npending++] = k;
        }
        if (is_row) {
            NAME(weigh_row)(&groups[next], &blocks[next]);
            NAME(prefetch)(&groups[next], &blocks[next], narrow);
        }
        if (was_row && narrow)
            NAME(sum_lanes)(&groups[waiting], &blocks[waiting], 0, 1);
        else if (was_row)
            NAME(sum_lanes)(&groups[waiting], &blocks[waiting], 0, 0);
        if (was_row)
            NAME(store_group)(&groups[waiting], batch);
        waiting = next;
    }
    return npending;
}

static void NAME(filter_batch)(const RetexBatchTexture *texture, RetexBatch *batch)
{
    Places places;
    Group group = {.texture = texture, .places = &places};
    int ends[NKEYS + 1], order[BATCH_SIZE], pending[BATCH_SIZE], begin = 0;
    for (int i = batch->count; i % LANES; i++) { /* unused footprints that complete a vector */
        batch->u[i] = batch->v[i] = batch->su[i] = batch->sv[i] = batch->correlation[i] = 0;
    }
    batch->nleft = 0;
    const int npending = NAME(filter_rows)(texture, batch, &places, pending);
    if (!npending)
        return;
    NAME(leave_borders)(texture, batch->count, &places);
    const int end = NAME(sort)(pending, npending, &places, order, ends);
    for (; begin < end; begin += group.count) {
        NAME(form_group)(&group, order, ends, begin);
        NAME(filter_group)(&group, batch);
    }
    while (begin < npending)
        batch->left[batch->nleft++] = order[begin++];
}

#undef Lanes
#undef Mask
#undef Places
#undef Group
#undef Band
#undef Chord
#undef Blocks
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
