/* One kernel of batch.h, for LANES footprints at a time. Included by batch_kernel.c alone, once for each number of
 * lanes; NAME(x) is that kernel's own x.
 *
 * The steps for a footprint: find its mean in the image, choose the level of the pyramid, compute the ellipse over that
 * level's texels and the blocks of 4 x 4 texels that it meets (place). Footprints with about the same number of blocks
 * then take the lanes of one vector: their weights are computed together (weigh_*), and each sums its texels
 * (sum_texels). Lines are rows of texels, or columns where the ellipse is flat; a strip is four lines. Where an ellipse
 * is oblique, the blocks of its strips follow it. */

#define Lanes NAME(Lanes)
#define Mask NAME(Mask)
#define Places NAME(Places)
#define Footprints NAME(Footprints)
#define Spread NAME(Spread)
#define Sides NAME(Sides)
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
#define MAX_STRIPS 36
#define MAX_BLOCKS 4 /* blocks across in a strip */
#define MAX_COLUMNS (4 * MAX_BLOCKS + 2)
#define NKEYS (8 * MAX_STRIPS * MAX_BLOCKS)
#define NODES 2 /* chords between two lines; of parallelograms, in each of the pieces between corners */
#define PIECES 3
#define BATCH_BOX_VARIANCE (1.0f / 12)
#define BATCH_TENT_VARIANCE (1.0f / 6)
/* The smaller variance, in texels of the level, that remains for a disc: for round ones, and for very long ones. */
#define ROUND_LEAST 0.75f
#define LONG_LEAST 0.3f
/* The longer deviation, in texels of the level, that a disc has at most: its window has that many strips to each side.
 */
#define LONGEST_DEVIATION (MAX_STRIPS - 1.0f)
/* The same for parallelograms, whose sides show where texels are coarse. */
#define STRAIGHT_LEAST 1.5f
#define STRAIGHT_LONG_LEAST 0.75f
#define STRAIGHT_BOX_FROM 1.5f
#define BOX_FROM 0.36f     /* the smaller variance from which level 0's texels need no interpolation */
#define LEAST_KEPT 1e-3f   /* share of a cut Gaussian that must remain; with less it is left, and not cut */
#define LEAST_RADIUS 0.02f /* texels */
#define SHARP_VARIANCE 0.7f
/* A Gaussian ends at 2.5 standard deviations, lowered so that it is 0 there, which leaves .7383 of its variance. */
#define GAUSSIAN_REACH 2.5f
#define GAUSSIAN_EDGE 0.043975f
#define GAUSSIAN_VARIANCE 0.737975f
/* With a smaller variance two discs that have the Gaussian's second and fourth moments replace it. */
#define INNER_DISC 0.54119610f
#define OUTER_DISC 1.30656296f

/* Gauss's quadrature rules on 0..1, at tips of ellipses Gauss-Jacobi's: inside, after an ellipse's tip, before one,
 * between both. */
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

/* Whether a lane is not 0. */
RETEX_CPU_INLINE int NAME(any)(Mask mask)
{
    int found = 0;
    for (int lane = 0; lane < LANES; lane++)
        found |= mask[lane];
    return found;
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
typedef struct Footprints {
    const RetexBatchTexture *texture;
    const Places *places;
    int count;        /* lanes with a footprint of their own; further lanes repeat the last one */
    int index[LANES]; /* index in the batch */
    int contiguous;   /* 1: consecutive in the batch */
    int turned, fine, strips, blocks, lines, columns;
    Lanes along, across, length, half, slope, lean, reach, first, line, texel; /* the last three are whole numbers */
    Lanes inner, side;                                                         /* of parallelograms */
    Mask level;
    int cut;               /* 1: the surface ends within the windows */
    Lanes low[2], high[2]; /* limits of the surface, in lines and texels from the mean */
    Lanes total, whole;    /* sum of weights within the limits, and of all weights */
    float sums[LANES][16]; /* sums of RGBA, one for each of four neighbouring texels */
} Footprints;

/* A strip: the first line, each footprint's first column, and the middle of its ellipse from there, all from the
 * mean. */
#define Strip NAME(Strip)
typedef struct Strip {
    int lines;
    Lanes begin, middle;
    Mask column;
    Lanes weights[4][4 * MAX_BLOCKS]; /* weights of texels, by line and column */
} Strip;

RETEX_CPU_INLINE void NAME(begin_strip)(const Footprints *f, int number, Strip *strip)
{
    strip->begin = f->first + (float)(4 * number) - f->along;
    strip->lines = f->lines - 4 * number < 4 ? f->lines - 4 * number : 4;
    strip->column = NAME(whole_below)(f->across + f->lean * (strip->begin + 1.5f) - f->reach) + 1;
    strip->middle = f->across - NAME(to_float)(strip->column);
    for (int j = 0; j < 4; j++) /* other weights are written before they are read */
        for (int c = j < strip->lines ? f->columns : 0; c < 4 * f->blocks; c++)
            strip->weights[j][c] = NAME(all)(0);
}

/* The ends of a chord, and its weight in the quadrature. */
#define Chord NAME(Chord)
typedef struct Chord {
    Lanes left, right, weight, share; /* share: fraction of the way from the line before to the next one, 0..1 */
} Chord;

/* Finds the chords between `low` and the next line. The size of the ellipse is an argument, because a Gaussian has
 * two. */
RETEX_CPU_INLINE void NAME(find_chords)(const Footprints *f, const Strip *strip, Lanes low, Lanes length, Lanes inverse,
                                        Lanes half, Chord *chords)
{
    Lanes high = low + 1, begin = MAX(low, -length), end = MIN(high, length);
    Lanes span = MAX(end - begin, NAME(all)(0));
    Mask rule = ((low < -length) & 1) + ((high > length) & 2);
    for (int k = 0; k < NODES; k++) {
        Lanes at = begin + span * LOOK_UP(batch_nodes[k], rule), u = at * inverse;
        Lanes middle = strip->middle + f->slope * at, h = half * SQRT(MAX(1 - u * u, NAME(all)(0)));
        chords[k].left = middle - h;
        chords[k].right = middle + h;
        chords[k].weight = span * LOOK_UP(batch_weights[k], rule);
        chords[k].share = at - low;
    }
}

/* The same of parallelograms, for the pieces between corners that some lane has; returns the
 * number of chords. */
RETEX_CPU_INLINE int NAME(find_straight_chords)(const Footprints *f, const Strip *strip, Lanes low, Chord *chords)
{
    const Lanes none = NAME(all)(0), inverse = 1 / MAX(f->length - f->inner, NAME(all)(LEAST_RADIUS));
    const Lanes corners[PIECES + 1] = {-f->length, -f->inner, f->inner, f->length};
    int count = 0;
    for (int piece = 0; piece < PIECES; piece++) {
        Lanes begin = MAX(low, corners[piece]), span = MAX(MIN(low + 1, corners[piece + 1]) - begin, none);
        if (!NAME(any)(span > none))
            continue;
        for (int k = 0; k < NODES; k++, count++) {
            Lanes at = begin + span * batch_nodes[k][0], middle = strip->middle + f->slope * at, h = f->half;
            if (piece != 1) {
                Lanes t = MIN((MAX(at, -at) - f->inner) * inverse, NAME(all)(1));
                middle += piece ? t * f->side : -(t * f->side);
                h *= 1 - t;
            }
            chords[count].left = middle - h;
            chords[count].right = middle + h;
            chords[count].weight = span * batch_weights[k][0];
            chords[count].share = at - low;
        }
    }
    return count;
}

/* Weights of interpolated texels: the double integral of their tents, differenced twice. Adds to the weights, or sets
 * them. */
RETEX_CPU_INLINE void NAME(weigh_fine)(Footprints *f, Strip *strip, Lanes length, Lanes half, Lanes scale, int is_added,
                                       int straight)
{
    Lanes lines[5][MAX_COLUMNS]; /* the last one is not used */
    Chord chords[PIECES * NODES];
    int count = NODES;
    Lanes inverse = 1 / length;
    for (int c = 0; c <= f->columns; c++)
        lines[4][c] = NAME(all)(0);
    for (int i = 0; i <= strip->lines; i++) {
        Lanes here[PIECES * NODES], next[PIECES * NODES], low = strip->begin + (float)(i - 1);
        if (straight)
            count = NAME(find_straight_chords)(f, strip, low, chords);
        else
            NAME(find_chords)(f, strip, low, length, inverse, half, chords);
        for (int k = 0; k < count; k++) {
            next[k] = chords[k].weight * chords[k].share * scale;
            here[k] = chords[k].weight * scale - next[k];
        }
        Lanes *before = lines[i > 0 ? i - 1 : 4], *after = lines[i < 4 ? i : 4];
        for (int c = 0; c <= f->columns; c++) { /* no chord goes beyond the neighbour of the last column */
            Lanes at = NAME(all)((float)(c - 1)), sum = {0}, more = {0};
            for (int k = 0; k < count; k++) {
                Lanes r = MAX(chords[k].right - at, NAME(all)(0)), l = MAX(chords[k].left - at, NAME(all)(0));
                Lanes area = (r - l) * (r + l);
                sum += here[k] * area;
                more += next[k] * area;
            }
            before[c] += sum;
            after[c] = more;
        }
        after[f->columns + 1] = NAME(all)(0);
    }
    for (int j = 0; j < strip->lines; j++)
        for (int c = 0; c < f->columns; c++) {
            Lanes w = (lines[j][c] - lines[j][c + 1]) - (lines[j][c + 1] - lines[j][c + 2]);
            w = MAX(w, NAME(all)(0));
            strip->weights[j][c] = is_added ? strip->weights[j][c] + w : w;
        }
}

/* Weights of texels that are averages over squares: the length of each chord in each texel. */
RETEX_CPU_INLINE void NAME(weigh_boxes)(Footprints *f, Strip *strip, int straight)
{
    Chord chords[PIECES * NODES];
    Lanes inverse = 1 / f->length;
    int count = NODES;
    for (int j = 0; j < strip->lines; j++) {
        const Lanes low = strip->begin + ((float)j - 0.5f);
        if (straight)
            count = NAME(find_straight_chords)(f, strip, low, chords);
        else
            NAME(find_chords)(f, strip, low, f->length, inverse, f->half, chords);
        for (int c = 0; c < f->columns; c++) {
            Lanes begin = NAME(all)((float)c - 0.5f), end = NAME(all)((float)c + 0.5f), w = {0};
            for (int k = 0; k < count; k++)
                w += chords[k].weight * MAX(MIN(chords[k].right, end) - MAX(chords[k].left, begin), NAME(all)(0));
            strip->weights[j][c] = w;
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

RETEX_CPU_INLINE void NAME(weigh_gaussian)(Footprints *f, Strip *strip, int nlines, int ncolumns)
{
    const float reach = GAUSSIAN_REACH * 0.70710678f; /* so that the squares are the exponents */
    Lanes down = reach / f->length, over = reach / f->half, columns[4 * MAX_BLOCKS];
    const Lanes most = NAME(all)(0.5f * GAUSSIAN_REACH * GAUSSIAN_REACH);
    for (int c = 0; c < ncolumns; c++)
        columns[c] = (float)c * over;
    for (int j = 0; j < nlines; j++) {
        Lanes y = strip->begin + (float)j, v = y * down, middle = (strip->middle + f->slope * y) * over;
        Lanes square = v * v;
        for (int c = 0; c < ncolumns; c++) {
            Lanes u = columns[c] - middle, q = MIN(u * u + square, most);
            strip->weights[j][c] = MAX(NAME(exp_minus)(q) - GAUSSIAN_EDGE, NAME(all)(0));
        }
    }
}

/* Cuts off weights beyond the limits of the surface. */
RETEX_CPU_INLINE void NAME(cut_strip)(Footprints *f, Strip *strip, int nlines, int ncolumns)
{
    Lanes across[4 * MAX_BLOCKS];
    for (int c = 0; c < ncolumns; c++)
        across[c] = NAME(share_within)((float)c - strip->middle, f->low[1], f->high[1]);
    for (int j = 0; j < nlines; j++) {
        Lanes along = NAME(share_within)(strip->begin + (float)j, f->low[0], f->high[0]);
        for (int c = 0; c < ncolumns; c++) {
            f->whole += strip->weights[j][c];
            strip->weights[j][c] *= along * across[c];
        }
    }
}

RETEX_CPU_INLINE void NAME(add_total)(Footprints *f, const Strip *strip, int nlines, int ncolumns)
{
    for (int j = 0; j < nlines; j++)
        for (int c = 0; c < ncolumns; c++)
            f->total += strip->weights[j][c];
}

RETEX_CPU_INLINE void NAME(weigh_strip)(Footprints *f, int number, Strip *strip)
{
    NAME(begin_strip)(f, number, strip);
    if (f->texture->gaussian && f->fine) {
        /* both discs have the same weight: each chord is divided by the area of its own ellipse */
        float in = INNER_DISC / OUTER_DISC;
        NAME(weigh_fine)(f, strip, f->length * in, f->half * in, NAME(all)(1 / (in * in)), 0, 0);
        NAME(weigh_fine)(f, strip, f->length, f->half, NAME(all)(1), 1, 0);
    } else if (f->texture->gaussian) {
        NAME(weigh_gaussian)(f, strip, strip->lines, f->columns);
    } else if (f->texture->straight && f->fine) {
        NAME(weigh_fine)(f, strip, f->length, f->half, NAME(all)(1), 0, 1);
    } else if (f->texture->straight) {
        NAME(weigh_boxes)(f, strip, 1);
    } else if (f->fine) {
        NAME(weigh_fine)(f, strip, f->length, f->half, NAME(all)(1), 0, 0);
    } else {
        NAME(weigh_boxes)(f, strip, 0);
    }
    if (f->cut)
        NAME(cut_strip)(f, strip, strip->lines, f->columns);
    NAME(add_total)(f, strip, strip->lines, f->columns);
}

#include "texture/batch_sum.h"

/* Loads the footprints of the lanes. */
RETEX_CPU_INLINE void NAME(load_footprints)(Footprints *f)
{
    const Places *p = f->places;
    const void *arrays[] = {p->along, p->across, p->length, p->half,   p->slope,  p->lean,    p->reach,  p->first,
                            p->line,  p->texel,  p->level,  p->low[0], p->low[1], p->high[0], p->high[1]};
    const int count = f->cut ? 15 : f->texture->straight ? 13 : 11;
    if (f->texture->straight) { /* which are never cut */
        arrays[11] = p->inner;
        arrays[12] = p->side;
    }
    Lanes values[15];
    Mask index;
    LOAD(index, f->index);
    for (int k = 0; k < count; k++)
        if (f->contiguous)
            LOAD(values[k], (const float *)arrays[k] + f->index[0]);
        else
            values[k] = PICK((const float *)arrays[k], index);
    f->along = values[0];
    f->across = values[1];
    f->length = values[2];
    f->half = values[3];
    f->slope = values[4];
    f->lean = values[5];
    f->reach = values[6];
    f->first = NAME(to_float)((Mask)values[7]);
    f->line = values[8];
    f->texel = values[9];
    f->level = (Mask)values[10];
    if (f->texture->straight) {
        f->inner = values[11];
        f->side = values[12];
    }
    for (int k = 0; k < 2 && f->cut; k++) {
        f->low[k] = values[11 + k];
        f->high[k] = values[13 + k];
    }
    f->total = f->whole = NAME(all)(0);
    memset(f->sums, 0, sizeof f->sums);
}

/* Writes the colours of the lanes. */
RETEX_CPU_INLINE void NAME(store_footprints)(const Footprints *f, RetexBatch *batch)
{
    Lanes inverse = 1 / (f->total * (f->texture->texture->narrow ? NARROW_ONE : 1));
    for (int lane = 0; lane < f->count; lane++) {
        const float *s = f->sums[lane];
        RetexFloat4 sum = ((load4(s) + load4(s + 4)) + (load4(s + 8) + load4(s + 12))) * inverse[lane];
        memcpy(batch->rgba[f->index[lane]], &sum, sizeof sum);
    }
    for (int lane = 0; lane < f->count && f->cut; lane++)
        if (!(f->total[lane] > LEAST_KEPT * f->whole[lane]))
            batch->left[batch->nleft++] = f->index[lane];
}

RETEX_CPU_INLINE void NAME(filter_footprints)(Footprints *f, RetexBatch *batch)
{
    Strip strip;
    NAME(load_footprints)(f);
    for (int b = 0; b < f->strips; b++) {
        NAME(weigh_strip)(f, b, &strip);
        NAME(sum_blocks)(f, b, &strip);
    }
    NAME(store_footprints)(f, batch);
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

/* Chooses footprints for one full vector, from `begin` of the order on: those of one key and, in the remaining lanes,
 * those of the next keys, if that saves a vector at a smaller cost than it adds to this one. */
RETEX_CPU_INLINE void NAME(choose_footprints)(Footprints *f, const int *order, const int *ends, int begin)
{
    const int key = f->places->key[order[begin]], kinds = MAX_STRIPS * MAX_BLOCKS;
    f->cut = key / (4 * kinds);
    f->turned = key / (2 * kinds) % 2;
    f->fine = key / kinds % 2;
    f->strips = key / MAX_BLOCKS % MAX_STRIPS + 1;
    f->blocks = key % MAX_BLOCKS + 1;
    f->count = ends[key] - begin < LANES ? ends[key] - begin : LANES;
    for (int next = key + 1; f->count < LANES && next % kinds; next++) {
        int strips = next / MAX_BLOCKS % MAX_STRIPS + 1, blocks = next % MAX_BLOCKS + 1, own = strips * blocks;
        int waiting = ends[next] - ends[next - 1], lanes_left = LANES - f->count,
            taken = waiting < lanes_left ? waiting : lanes_left;
        if (!waiting)
            continue;
        strips = strips > f->strips ? strips : f->strips;
        blocks = blocks > f->blocks ? blocks : f->blocks;
        if ((waiting - taken + LANES - 1) / LANES == (waiting + LANES - 1) / LANES ||
            strips * blocks >= f->strips * f->blocks + own)
            break;
        f->strips = strips;
        f->blocks = blocks;
        f->count += taken;
    }
    f->lines = f->columns = 1;
    for (int lane = 0; lane < LANES; lane++) {
        int i = order[begin + (lane < f->count ? lane : f->count - 1)];
        f->index[lane] = i;
        f->lines = f->places->lines[i] > f->lines ? f->places->lines[i] : f->lines;
        f->columns = f->places->columns[i] > f->columns ? f->places->columns[i] : f->columns;
    }
    /* 1 for one key, whose footprints are in the batch's order */
    f->contiguous = begin + LANES <= ends[key] && f->index[LANES - 1] == f->index[0] + LANES - 1;
}

/* Chooses the footprints from i on, if all their windows have at most 4 x 4 texels, as many broad footprints
 * have. */
RETEX_CPU_INLINE int NAME(choose_row)(Footprints *f, int count, int i)
{
    Mask key;
    LOAD(key, f->places->key + i);
    const Mask larger = (key != 0) & (key != 4 * MAX_STRIPS * MAX_BLOCKS);
    f->cut = f->texture->limited;
    f->turned = f->fine = 0;
    f->strips = f->blocks = f->contiguous = 1;
    f->count = count - i < LANES ? count - i : LANES;
    for (int lane = 0; lane < LANES; lane++)
        f->index[lane] = i + lane;
    return !NAME(any)(larger);
}

/* The weights and texels of such footprints. */
RETEX_CPU_INLINE void NAME(weigh_row)(Footprints *f, Blocks *blocks)
{
    Strip strip;
    f->lines = f->columns = 4;
    NAME(load_footprints)(f);
    NAME(begin_strip)(f, 0, &strip);
    NAME(weigh_gaussian)(f, &strip, 4, 4);
    if (f->cut)
        NAME(cut_strip)(f, &strip, 4, 4);
    NAME(add_total)(f, &strip, 4, 4);
    NAME(find_blocks)(f, 0, &strip, 0, blocks);
}

/* Computes the places of all footprints, and filters broad ones in rows, each while the texels of the next one are
 * loaded. Returns how many are pending. */
RETEX_CPU_INLINE int NAME(filter_rows)(const RetexBatchTexture *texture, RetexBatch *batch, Places *places,
                                       int *pending)
{
    Footprints rows[2] = {{.texture = texture, .places = places}, {.texture = texture, .places = places}};
    Blocks blocks[2];
    const int in_rows = texture->broad && !texture->black[0] && !texture->black[1], narrow = texture->texture->narrow;
    int npending = 0, waiting = 0, is_row = 0;
    for (int i = 0; i < batch->count || is_row; i += LANES) {
        const int next = !waiting, was_row = is_row;
        is_row = 0;
        if (i < batch->count) {
            NAME(place)(texture, batch, places, i);
            is_row = in_rows && NAME(choose_row)(&rows[next], batch->count, i);
            for (int k = i; k < i + LANES && k < batch->count && !is_row; k++)
                pending[npending++] = k;
        }
        if (is_row) {
            NAME(weigh_row)(&rows[next], &blocks[next]);
            NAME(prefetch)(&rows[next], &blocks[next], narrow);
        }
        if (was_row && narrow)
            NAME(sum_lanes)(&rows[waiting], &blocks[waiting], 0, 1);
        else if (was_row)
            NAME(sum_lanes)(&rows[waiting], &blocks[waiting], 0, 0);
        if (was_row)
            NAME(store_footprints)(&rows[waiting], batch);
        waiting = next;
    }
    return npending;
}

static void NAME(filter_batch)(const RetexBatchTexture *texture, RetexBatch *batch)
{
    Places places;
    Footprints footprints = {.texture = texture, .places = &places};
    int ends[NKEYS + 1], order[BATCH_SIZE], pending[BATCH_SIZE], begin = 0;
    for (int i = batch->count; i % LANES; i++) { /* unused footprints that complete a vector */
        batch->u[i] = batch->v[i] = 0;
        for (int k = 0; k < 4; k++)
            batch->spread[k][i] = 0;
    }
    batch->nleft = 0;
    memset(batch->sharp, 0, (size_t)batch->count);
    const int npending = NAME(filter_rows)(texture, batch, &places, pending);
    if (!npending)
        return;
    NAME(leave_borders)(texture, batch, &places);
    const int end = NAME(sort)(pending, npending, &places, order, ends);
    for (; begin < end; begin += footprints.count) {
        NAME(choose_footprints)(&footprints, order, ends, begin);
        NAME(filter_footprints)(&footprints, batch);
    }
    while (begin < npending)
        batch->left[batch->nleft++] = order[begin++];
}

#undef Lanes
#undef Mask
#undef Places
#undef Footprints
#undef Strip
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
#undef Sides
#undef Outline
#undef Ends
#undef Double
#undef DoubleMask
#undef Half
#undef HalfMask
