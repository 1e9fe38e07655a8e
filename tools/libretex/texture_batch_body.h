/* One kernel of texture_batch.h, for LANES footprints at a time. Included by texture_batch_kernel.c alone, once for each
 * number of lanes; NAME(x) is that kernel's own x.
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
#ifndef FINE_NODES
#define FINE_NODES 2
#define FINE_RULE batch_nodes2, batch_weights2
#endif
#ifndef BOX_NODES
#define BOX_NODES 1
#define BOX_RULE batch_nodes1, batch_weights1
#endif
#define BATCH_BOX_VARIANCE (1.0f / 12)
#define BATCH_TENT_VARIANCE (1.0f / 6)
/* The smaller variance that a level leaves a disc, in its texels: of round ones, and of very long ones. */
#define ROUND_LEAST 0.75f
#define LONG_LEAST 0.3f
#ifndef BOX_FROM
#define BOX_FROM 0.36f
#endif
//     /* the smaller variance from which level 0's texels need no interpolation */
#define LEAST_RADIUS 0.02f /* texels */
/* A Gaussian ends at 3.25 standard deviations, lowered so that it is 0 there, which leaves it .9267 of its variance. */
#define GAUSSIAN_REACH 3.25f
#define GAUSSIAN_EDGE 0.00508606923f
#define GAUSSIAN_VARIANCE 0.926732f
#define GAUSSIAN_LEAST 0.35f /* the smaller variance, interpolation included, of one sampled at texels */
/* Below, two discs that have a Gaussian's second and fourth moments take its place. */
#define INNER_DISC 0.54119610f
#define OUTER_DISC 1.30656296f

/* Rules of Gauss on 0..1, as in texture_disc_kernel.c: inside, after an ellipse's tip, before one, between both. */
static const float batch_nodes1[1][4] = {{0.5f, 0.6f, 0.4f, 0.5f}};
static const float batch_weights1[1][4] = {{1, 0.860663f, 0.860663f, 0.785398f}};
static const float batch_nodes2[2][4] = {{0.21132487f, 0.2899492f, 0.17883809f, 0.25f},
                                         {0.78867513f, 0.82116191f, 0.7100508f, 0.75f}};
static const float batch_weights2[2][4] = {{0.5f, 0.5154537f, 0.42939674f, 0.45344984f},
                                           {0.5f, 0.42939674f, 0.5154537f, 0.45344984f}};
static const float batch_nodes3[3][4] = {{0.11270167f, 0.16471029f, 0.099194171f, 0.14644661f},
                                         {0.5f, 0.5498685f, 0.4501315f, 0.5f},
                                         {0.88729833f, 0.90080583f, 0.83528971f, 0.85355339f}};
static const float batch_weights3[3][4] = {{0.27777778f, 0.30992775f, 0.24579041f, 0.27768018f},
                                           {0.44444444f, 0.41482054f, 0.41482054f, 0.39269908f},
                                           {0.27777778f, 0.24579041f, 0.30992775f, 0.27768018f}};
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

/* ---- where footprints lie ---- */

/* A batch's footprints on their way. Along is from line to line, across from texel to texel of a line. */
typedef struct Places {
    int level[BATCH_SIZE];
    int column[BATCH_SIZE], row[BATCH_SIZE];     /* of the level: the whole part of the mean */
    float at_x[BATCH_SIZE], at_y[BATCH_SIZE];    /* and the rest of it */
    float xx[BATCH_SIZE], yy[BATCH_SIZE];        /* variances in the level's texels */
    int line[BATCH_SIZE], texel[BATCH_SIZE];     /* the ellipse's first line; the whole part of the mean across */
    float along[BATCH_SIZE], across[BATCH_SIZE]; /* at_x and at_y, as lines have them */
    float length[BATCH_SIZE], half[BATCH_SIZE], slope[BATCH_SIZE]; /* the ellipse, as in texture_disc_kernel.c */
    float lean[BATCH_SIZE], reach[BATCH_SIZE]; /* of the blocks: their slope, how far they go to each side */
    int first[BATCH_SIZE];                     /* line, from the whole part of the mean */
    int lines[BATCH_SIZE], columns[BATCH_SIZE], key[BATCH_SIZE];
} Places;

/* u and v where they are far away become 0. */
INLINE void NAME(find_mean)(const BatchTexture *t, int axis, Lanes u, Lanes v, Double *mean)
{
    const Double whole = 6755399441055744.0 - (Double){0}; /* 1.5 * 2^52: adding it rounds */
    const Double period = t->period[axis] - (Double){0}, one = 1 - (Double){0};
    double inverse = t->period[axis] > 0 ? 1 / t->period[axis] : 0;
    Half halves[2][2];
    memcpy(halves[0], &u, sizeof u);
    memcpy(halves[1], &v, sizeof v);
    for (int h = 0; h < 2; h++) {
        Double at = t->matrix[axis][0] * __builtin_convertvector(halves[0][h], Double) +
                    t->matrix[axis][1] * __builtin_convertvector(halves[1][h], Double) + t->offset[axis];
        Double turns = at * inverse, below = turns + whole - whole;
        below -= (Double)((below > turns) & (DoubleMask)one);
        mean[h] = at - period * below;
    }
}

/* The mean in texels of the level, as a whole number and a rest. */
INLINE void NAME(split_mean)(const Double *mean, Lanes texels, Mask *index, Lanes *rest)
{
    const Double whole = 6755399441055744.0 - (Double){0}, one = 1 - (Double){0};
    Half sizes[2], rests[2];
    HalfMask indices[2];
    memcpy(sizes, &texels, sizeof texels);
    for (int h = 0; h < 2; h++) {
        Double x = mean[h] * __builtin_convertvector(sizes[h], Double) - 0.5, below = x + whole - whole;
        below -= (Double)((below > x) & (DoubleMask)one);
        indices[h] = __builtin_convertvector(below, HalfMask);
        rests[h] = __builtin_convertvector(x - below, Half);
    }
    memcpy(index, indices, sizeof indices);
    memcpy(rest, rests, sizeof rests);
}

/* A covariance: of one footprint each, in texels squared. */
typedef struct Spread {
    Lanes xx, xy, yy;
} Spread;

INLINE Spread NAME(find_spread)(const BatchTexture *t, Lanes su, Lanes sv, Lanes correlation)
{
    const float(*m)[2] = t->to_texels;
    float a = m[0][0], b = m[0][1], c = m[1][0], d = m[1][1];
    Lanes r = MAX(MIN(correlation, NAME(all)(1)), NAME(all)(-1)), uu = su * su, vv = sv * sv, uv = r * su * sv;
    return (Spread){a * a * uu + 2 * a * b * uv + b * b * vv, a * c * uu + (a * d + b * c) * uv + b * d * vv,
                    c * c * uu + 2 * c * d * uv + d * d * vv};
}

/* By the smaller variance: halving texels divides it by four. *fine: texels are interpolated. */
INLINE Mask NAME(choose_level)(const BatchTexture *t, const Spread *s, Mask *fine)
{
    Lanes sum = s->xx + s->yy, difference = s->xx - s->yy, needed;
    Lanes root = MIN(SQRT(difference * difference + 4 * s->xy * s->xy), sum);
    Lanes smaller = 0.5f * (sum - root), larger = MAX(0.5f * (sum + root), NAME(all)(1e-12f));
    if (t->gaussian) {
        needed = NAME(all)(GAUSSIAN_LEAST + 1.0f / 12);
        *fine = smaller < GAUSSIAN_LEAST - BATCH_TENT_VARIANCE;
    } else {
        needed = LONG_LEAST + BATCH_TENT_VARIANCE + (ROUND_LEAST - LONG_LEAST) * SQRT(smaller / larger);
        *fine = smaller < BOX_FROM;
    }
    Mask level = (((Mask)((smaller + 0.25f) / needed) >> 23) - 127) >> 1;
    level &= level > 0;
    Mask over = level > t->levels - 1;
    level = (over & (t->levels - 1)) | (~over & level);
    *fine &= level == 0;
    return level;
}

/* What a level leaves of a variance. */
INLINE Lanes NAME(reduce_variance)(const BatchTexture *t, int axis, const Double *mean, Lanes variance, Mask level,
                                   Mask fine)
{
    Half halves[2] = {__builtin_convertvector(mean[0], Half), __builtin_convertvector(mean[1], Half)};
    Lanes at;
    memcpy(&at, halves, sizeof at);
    float size = (float)t->size[axis];
    Lanes damping = 1 + variance * (10 / (size * size));
    if (t->period[axis] > 0)
        at -= SELECT(at > 1, NAME(all)(1), NAME(all)(0));
    at = MAX(MIN(at, NAME(all)(1)), NAME(all)(0));
    Lanes position = BATCH_TENT_VARIANCE + (at * (1 - at) - BATCH_TENT_VARIANCE) / (damping * damping);
    Lanes blur = OF_LEVEL(t->blur[axis][0], level) + OF_LEVEL(t->blur[axis][1], level) * position;
    Lanes tent = SELECT(fine, NAME(all)(0), NAME(all)(BATCH_TENT_VARIANCE));
    Lanes box = SELECT(fine, NAME(all)(0), NAME(all)(t->gaussian ? 0 : BATCH_BOX_VARIANCE));
    Lanes rest = (variance + tent - blur) * OF_LEVEL(t->inverse_area[2 * axis], level) - box;
    return MAX(rest, NAME(all)(0)) * OF_LEVEL(t->spread[axis], level);
}

/* The texels of an open interval: the first, and how many. */
INLINE Mask NAME(first_within)(Lanes begin, Lanes end, Mask *count)
{
    Mask first = NAME(whole_below)(begin) + 1, last = -NAME(whole_below)(-end) - 1;
    *count = last - first + 1;
    return first;
}

/* The ellipse in lines, and the blocks that it meets. */
INLINE void NAME(find_window)(const BatchTexture *t, const Spread *s, Lanes at_x, Lanes at_y, Mask column, Mask row,
                              Mask fine, Mask far, Places *p, int i)
{
    const Lanes least = NAME(all)(LEAST_RADIUS), none = NAME(all)(0);
    float wider = t->gaussian ? GAUSSIAN_REACH / sqrtf(GAUSSIAN_VARIANCE) : 2;
    Mask turned = s->xx > 1.1f * s->yy; /* round ones all alike */
    Lanes along = SELECT(turned, s->xx, s->yy), across = SELECT(turned, s->yy, s->xx);
    Lanes mean = SELECT(turned, at_x, at_y), beside = SELECT(turned, at_y, at_x);
    Lanes slope = s->xy / MAX(along, NAME(all)(1e-12f));
    Lanes radius = SELECT(fine, NAME(all)(t->gaussian ? 2 * OUTER_DISC : 2), NAME(all)(wider));
    Lanes length = MAX(radius * SQRT(along), least), half = radius * SQRT(MAX(across - slope * s->xy, none));
    half = MAX(half, least);
    Lanes width = MAX(radius * SQRT(across), half);
    Lanes edge = SELECT(fine, NAME(all)(1), NAME(all)(t->gaussian ? 0 : 0.5f));

    far |= ~(length < 2 * MAX_BANDS) | ~(width < 8 * MAX_BLOCKS * MAX_BANDS);
    length = SELECT(far, least, length);
    half = SELECT(far, least, half);
    width = SELECT(far, least, width);
    slope = SELECT(far, none, slope);
    Mask lines, columns;
    Mask first = NAME(first_within)(mean - length - edge, mean + length + edge, &lines);
    Lanes upright = width + edge, leaning = half + MAX(slope, -slope) * (1.5f + edge) + edge;
    (void)NAME(first_within)(beside - upright, beside + upright, &columns);
    Mask narrow = __builtin_convertvector(2 * leaning, Mask) + 1;
    Mask leans = ((narrow + 3) >> 2) < ((columns + 3) >> 2);
    columns = (leans & narrow) | (~leans & columns);
    far |= (lines > 4 * MAX_BANDS) | (columns > 4 * MAX_BLOCKS);
    Mask key = (turned & (2 * MAX_BANDS * MAX_BLOCKS)) + (fine & (MAX_BANDS * MAX_BLOCKS)) +
               ((lines + 3) >> 2) * MAX_BLOCKS + ((columns + 3) >> 2);
    key = ((key - MAX_BLOCKS - 1) & ~far) | (NKEYS & far);

    STORE(p->line + i, first + SELECT_INT(turned, column, row));
    STORE(p->texel + i, SELECT_INT(turned, row, column));
    STORE(p->along + i, mean);
    STORE(p->across + i, beside);
    STORE(p->length + i, length);
    STORE(p->half + i, half);
    STORE(p->slope + i, slope);
    STORE(p->lean + i, SELECT(leans, slope, none));
    STORE(p->reach + i, SELECT(leans, leaning, upright));
    STORE(p->first + i, first);
    STORE(p->lines + i, lines);
    STORE(p->columns + i, columns);
    STORE(p->key + i, key);
}

/* All of it, for the footprints from i on. */
INLINE void NAME(place)(const BatchTexture *t, const Batch *batch, Places *p, int i)
{
    Lanes u, v, su, sv, correlation, at[2];
    LOAD(u, batch->u + i);
    LOAD(v, batch->v + i);
    LOAD(su, batch->su + i);
    LOAD(sv, batch->sv + i);
    LOAD(correlation, batch->correlation + i);
    Mask far = {0}, fine, index[2];
    for (int axis = 0; axis < 2; axis++) {
        Lanes x = (float)t->matrix[axis][0] * u + (float)t->matrix[axis][1] * v + (float)t->offset[axis];
        far |= ~(MAX(x, -x) < 1e6f);
    }
    Spread s = NAME(find_spread)(t, su, sv, correlation);
    far |= ~(s.xx + s.yy < 1e12f);
    const Lanes none = NAME(all)(0);
    u = SELECT(far, none, u);
    v = SELECT(far, none, v);
    s = (Spread){SELECT(far, none, s.xx), SELECT(far, none, s.xy), SELECT(far, none, s.yy)};

    Double mean[2][2];
    Mask level = NAME(choose_level)(t, &s, &fine);
    for (int axis = 0; axis < 2; axis++) {
        NAME(find_mean)(t, axis, u, v, mean[axis]);
        NAME(split_mean)(mean[axis], OF_LEVEL(t->texels[axis], level), &index[axis], &at[axis]);
    }
    s.xx = NAME(reduce_variance)(t, 0, mean[0], s.xx, level, fine);
    s.yy = NAME(reduce_variance)(t, 1, mean[1], s.yy, level, fine);
    s.xy *= OF_LEVEL(t->inverse_area[1], level) * OF_LEVEL(t->spread[0], level) * OF_LEVEL(t->spread[1], level);
    STORE(p->level + i, level);
    STORE(p->column + i, index[0]);
    STORE(p->row + i, index[1]);
    STORE(p->xx + i, s.xx);
    STORE(p->yy + i, s.yy);
    STORE(p->at_x + i, at[0]);
    STORE(p->at_y + i, at[1]);
    NAME(find_window)(t, &s, at[0], at[1], index[0], index[1], fine, far, p, i);
}

/* What a black border cuts is not for us. */
INLINE void NAME(leave_borders)(const BatchTexture *t, int count, Places *p)
{
    float wider = t->gaussian ? GAUSSIAN_REACH / sqrtf(GAUSSIAN_VARIANCE) : 2;
    for (int axis = 0; axis < 2; axis++) {
        if (!t->black[axis])
            continue;
        const float *variance = axis ? p->yy : p->xx, *at = axis ? p->at_y : p->at_x;
        const int *index = axis ? p->row : p->column;
        for (int i = 0; i < count; i++) {
            const TextureLevel *level = &t->texture->levels[p->level[i]];
            float x = (float)index[i] + at[i], reach = wider * sqrtf(variance[i]) + 1.5f;
            if (x - reach < 0 || x + reach > (float)((axis ? level->height : level->width) - 1))
                p->key[i] = NKEYS;
        }
    }
}

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
    Lanes total;
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
                              int count, const float nodes[][4], const float weights[][4], Chord *chords)
{
    Lanes high = low + 1, begin = MAX(low, -length), end = MIN(high, length);
    Lanes span = MAX(end - begin, NAME(all)(0));
    Mask rule = ((low < -length) & 1) + ((high > length) & 2);
    for (int k = 0; k < count; k++) {
        Lanes at = begin + span * LOOK_UP(nodes[k], rule), u = at * inverse;
        Lanes middle = band->middle + g->slope * at, h = half * SQRT(MAX(1 - u * u, NAME(all)(0)));
        chords[k].left = middle - h;
        chords[k].right = middle + h;
        chords[k].weight = span * LOOK_UP(weights[k], rule);
        chords[k].share = at - low;
    }
}

/* Texels are interpolated: their tents' double integral, differenced twice. */
INLINE void NAME(weigh_fine)(Group *g, Band *band, Lanes length, Lanes half, Lanes scale)
{
    Lanes lines[5][MAX_COLUMNS];
    Chord chords[FINE_NODES];
    Lanes inverse = 1 / length;
    for (int j = 0; j < 5; j++)
        for (int c = 0; c < g->columns + 2; c++)
            lines[j][c] = NAME(all)(0);
    for (int i = 0; i <= band->lines; i++) {
        Lanes here[FINE_NODES], next[FINE_NODES];
        NAME(find_chords)
        (g, band, band->begin + (float)(i - 1), length, inverse, half, FINE_NODES, FINE_RULE, chords);
        for (int k = 0; k < FINE_NODES; k++) {
            next[k] = chords[k].weight * chords[k].share * scale;
            here[k] = chords[k].weight * scale - next[k];
        }
        Lanes *before = lines[i > 0 ? i - 1 : 4], *after = lines[i < 4 ? i : 4];
        for (int c = 0; c <= g->columns; c++) { /* no chord reaches beyond the last column's neighbour */
            Lanes at = NAME(all)((float)(c - 1)), sum = {0}, more = {0};
            for (int k = 0; k < FINE_NODES; k++) {
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
    Chord chords[BOX_NODES];
    Lanes inverse = 1 / g->length;
    for (int j = 0; j < band->lines; j++) {
        NAME(find_chords)
        (g, band, band->begin + ((float)j - 0.5f), g->length, inverse, g->half, BOX_NODES, BOX_RULE, chords);
        for (int c = 0; c < g->columns; c++) {
            Lanes begin = NAME(all)((float)c - 0.5f), end = NAME(all)((float)c + 0.5f), w = {0};
            for (int k = 0; k < BOX_NODES; k++)
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
    for (int j = 0; j < band->lines; j++)
        for (int c = 0; c < g->columns; c++)
            g->total += band->weights[j][c];
}

/* ---- sums ---- */

/* A block's weights, footprint by footprint. */
INLINE void NAME(turn_weights)(const Band *band, int block, float out[LANES][16])
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
        _mm512_storeu_ps(out[k], _mm512_shuffle_f32x4(p, r, 0x88));
        _mm512_storeu_ps(out[k + 8], _mm512_shuffle_f32x4(p, r, 0xdd));
        _mm512_storeu_ps(out[k + 4], _mm512_shuffle_f32x4(q, s, 0x88));
        _mm512_storeu_ps(out[k + 12], _mm512_shuffle_f32x4(q, s, 0xdd));
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
            _mm_storeu_ps(out[k] + 4 * j, _mm256_castps256_ps128(lanes[k]));
            _mm_storeu_ps(out[k + 4] + 4 * j, _mm256_extractf128_ps(lanes[k], 1));
        }
    }
#else
    for (int lane = 0; lane < LANES; lane++)
        for (int j = 0; j < 4; j++)
            for (int c = 0; c < 4; c++)
                out[lane][4 * j + c] = w[j][c][lane];
#endif
}

/* Add a band's texels to four sums, one for every fourth column. Weights come by lines, which may be columns. The blocks
 * lie `step` texels apart. */
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

/* Where a band's blocks lie in their levels: texels from the level's first one; -1 where some lie outside. */
INLINE Mask NAME(find_blocks)(const Group *g, int number, const Band *band, Mask *x, Mask *y)
{
    const BatchTexture *t = g->texture;
    Mask lines = (Mask)g->line + 4 * number, texels = (Mask)g->texel + band->column;
    *x = g->turned ? lines : texels;
    *y = g->turned ? texels : lines;
    Mask width = __builtin_convertvector(OF_LEVEL(t->texels[0], g->level), Mask);
    Mask height = __builtin_convertvector(OF_LEVEL(t->texels[1], g->level), Mask);
    int across = 4 * g->blocks;
    Mask inside =
        (*x >= 0) & (*y >= 0) & (*x <= width - (g->turned ? 4 : across)) & (*y <= height - (g->turned ? across : 4));
    return ((*y * width + *x) & inside) | ~inside;
}

INLINE void NAME(sum_band)(Group *g, int number, const Band *band, int turned, int narrow)
{
    float weights[MAX_BLOCKS][LANES][16], own[MAX_BLOCKS][16];
    int first[LANES], columns[LANES], rows[LANES], levels[LANES];
    Mask x, y, begin = NAME(find_blocks)(g, number, band, &x, &y);
    STORE(first, begin);
    STORE(columns, x);
    STORE(rows, y);
    STORE(levels, g->level);
    for (int k = 0; k < g->blocks; k++)
        NAME(turn_weights)(band, k, weights[k]);
    for (int lane = 0; lane < LANES; lane++) {
        const TextureLevel *level = &g->texture->texture->levels[levels[lane]];
        size_t stride = (size_t)level->width;
        for (int k = 0; k < g->blocks; k++)
            memcpy(own[k], weights[k][lane], sizeof own[k]);
        if (first[lane] >= 0) {
            const char *texels = (const char *)level->texels + (size_t)first[lane] * (narrow ? 8 : 16);
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
    g->total = NAME(all)(0);
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
    batch->nleft = batch->count - begin;
    for (int i = 0; i < batch->nleft; i++)
        batch->left[i] = order[begin + i];
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
#undef Double
#undef DoubleMask
#undef Half
#undef HalfMask
