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
typedef float Lanes __attribute__((vector_size(4 * LANES)));
typedef int Mask __attribute__((vector_size(4 * LANES)));

#ifndef TEXTURE_BATCH_CONSTANTS
#define TEXTURE_BATCH_CONSTANTS
#define MAX_BANDS 16
#define MAX_BLOCKS 4 /* across, in a band */
#define MAX_COLUMNS (4 * MAX_BLOCKS + 2)
#define NKEYS (2 * MAX_BANDS * MAX_BLOCKS)
#define BATCH_BOX_VARIANCE (1.0f / 12)
#define BATCH_TENT_VARIANCE (1.0f / 6)
/* The smaller variance that a level leaves a disc, in its texels: of round ones, and of very long ones. */
#define ROUND_LEAST 0.75f
#define LONG_LEAST 0.3f
#define BOX_FROM 0.6f      /* the smaller variance from which level 0's texels need no interpolation */
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

/* ---- vectors ---- */

#if LANES == 16
#define MIN(a, b) ((Lanes)_mm512_min_ps((__m512)(a), (__m512)(b)))
#define MAX(a, b) ((Lanes)_mm512_max_ps((__m512)(a), (__m512)(b)))
#define SQRT(a) ((Lanes)_mm512_sqrt_ps((__m512)(a)))
#define LOOK_UP(table, index)                                                                                          \
    ((Lanes)_mm512_permutexvar_ps((__m512i)(index), _mm512_broadcast_f32x4(_mm_loadu_ps(table))))
#define PICK(array, index) ((Lanes)_mm512_i32gather_ps((__m512i)(index), array, 4))
#elif LANES == 8
#define MIN(a, b) ((Lanes)_mm256_min_ps((__m256)(a), (__m256)(b)))
#define MAX(a, b) ((Lanes)_mm256_max_ps((__m256)(a), (__m256)(b)))
#define SQRT(a) ((Lanes)_mm256_sqrt_ps((__m256)(a)))
#define LOOK_UP(table, index)                                                                                          \
    ((Lanes)_mm256_permutevar8x32_ps(_mm256_broadcast_ps((const __m128 *)(const void *)(table)), (__m256i)(index)))
#define PICK(array, index) ((Lanes)_mm256_i32gather_ps(array, (__m256i)(index), 4))
#else
#define MIN(a, b) NAME(lesser)(a, b)
#define MAX(a, b) NAME(greater)(a, b)
#define SQRT(a) NAME(root)(a)
#define LOOK_UP(table, index) NAME(pick)(table, index)
#define PICK(array, index) NAME(pick)(array, index)
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
    double x[BATCH_SIZE], y[BATCH_SIZE];                     /* texels of the image */
    float xx[BATCH_SIZE], xy[BATCH_SIZE], yy[BATCH_SIZE];    /* texels squared: of the image, then of the level */
    int level[BATCH_SIZE], fine[BATCH_SIZE], far[BATCH_SIZE]; /* fine: texels are interpolated; far: not for us */
    int column[BATCH_SIZE], row[BATCH_SIZE];                 /* of the level: the whole part of the mean */
    float at_x[BATCH_SIZE], at_y[BATCH_SIZE];                /* and the rest of it */
    int turned[BATCH_SIZE];                                  /* lines are columns */
    float along[BATCH_SIZE], across[BATCH_SIZE];             /* at_x and at_y, as lines have them */
    float length[BATCH_SIZE], half[BATCH_SIZE], slope[BATCH_SIZE]; /* the ellipse, as in texture_disc_kernel.c */
    float lean[BATCH_SIZE], reach[BATCH_SIZE]; /* of the blocks: their slope, how far they go to each side */
    float first[BATCH_SIZE];                   /* line, from the whole part of the mean */
    int lines[BATCH_SIZE], columns[BATCH_SIZE], key[BATCH_SIZE];
} Places;

INLINE void NAME(place_means)(const BatchTexture *t, const Batch *batch, Places *p)
{
    const double whole = 6755399441055744.0; /* 1.5 * 2^52: adding it rounds */
    for (int axis = 0; axis < 2; axis++) {
        double a = t->matrix[axis][0], b = t->matrix[axis][1], c = t->offset[axis], period = t->period[axis];
        double inverse = period > 0 ? 1 / period : 0, size = t->size[axis], *out = axis ? p->y : p->x;
        for (int i = 0; i < batch->count; i++) {
            double at = a * (double)batch->u[i] + b * (double)batch->v[i] + c;
            at = at > -1e6 ? at : -2e6; /* NaN too */
            at = at < 1e6 ? at : 2e6;
            double turns = at * inverse, below = turns + whole - whole;
            below -= below > turns ? 1.0 : 0.0;
            out[i] = (at - period * below) * size;
        }
        for (int i = 0; i < batch->count; i++) {
            double at = a * (double)batch->u[i] + b * (double)batch->v[i] + c;
            int far = !(at > -1e6) | !(at < 1e6);
            p->far[i] = axis ? p->far[i] | far : far;
        }
    }
}

INLINE void NAME(find_covariances)(const BatchTexture *t, const Batch *batch, Places *p)
{
    const float(*m)[2] = t->to_texels;
    float a = m[0][0], b = m[0][1], c = m[1][0], d = m[1][1];
    for (int i = 0; i < batch->count; i++) {
        float su = batch->su[i], sv = batch->sv[i], r = batch->correlation[i];
        r = r < 1 ? r : 1;
        r = r > -1 ? r : -1;
        float uu = su * su, vv = sv * sv, uv = r * su * sv;
        p->xx[i] = a * a * uu + 2 * a * b * uv + b * b * vv;
        p->xy[i] = a * c * uu + (a * d + b * c) * uv + b * d * vv;
        p->yy[i] = c * c * uu + 2 * c * d * uv + d * d * vv;
    }
}

/* By the smaller variance: halving texels divides it by four. */
INLINE void NAME(choose_levels)(const BatchTexture *t, int count, Places *p)
{
    float limit = 1e12f;
    int last = t->levels - 1, gaussian = t->gaussian;
    for (int i = 0; i < count; i++) {
        float xx = p->xx[i], xy = p->xy[i], yy = p->yy[i], sum = xx + yy, difference = xx - yy;
        int far = !(sum < limit);
        sum = far ? 1 : sum;
        float root = sqrtf(difference * difference + 4 * xy * xy);
        root = root < sum ? root : sum;
        float smaller = 0.5f * (sum - root), larger = 0.5f * (sum + root);
        float ratio = sqrtf(smaller / (larger > 1e-12f ? larger : 1e-12f));
        float least = LONG_LEAST + (ROUND_LEAST - LONG_LEAST) * ratio;
        float texels = gaussian ? (smaller + 0.25f) / (GAUSSIAN_LEAST + 1.0f / 12)
                                : (smaller + 0.25f) / (least + BATCH_TENT_VARIANCE);
        int bits;
        memcpy(&bits, &texels, sizeof bits);
        int level = ((bits >> 23) - 127) >> 1;
        level = level > 0 ? level : 0;
        level = level < last ? level : last;
        int fine = level == 0 && smaller < (gaussian ? GAUSSIAN_LEAST - BATCH_TENT_VARIANCE : BOX_FROM);
        p->level[i] = level;
        p->fine[i] = fine;
        p->far[i] |= far;
    }
}

/* What is left of the covariance on the level. */
INLINE void NAME(reduce_covariances)(const BatchTexture *t, int count, Places *p)
{
    float ends = t->gaussian ? BATCH_TENT_VARIANCE : 0;
    for (int axis = 0; axis < 2; axis++) {
        const double *mean = axis ? p->y : p->x;
        float *variance = axis ? p->yy : p->xx;
        float inverse = (float)(1 / t->size[axis]), wraps = t->period[axis] > 0 ? 1 : 0;
        for (int i = 0; i < count; i++) {
            int level = p->level[i];
            float at = (float)mean[i] * inverse, damping = 1 + 10 * variance[i] * inverse * inverse;
            at = at < 0 ? 0 : at;
            at = at > 1 && wraps > 0 ? at - 1 : at > 1 ? 1 : at;
            float position = BATCH_TENT_VARIANCE + (at * (1 - at) - BATCH_TENT_VARIANCE) / (damping * damping);
            float blur = t->blur[axis][0][level] + t->blur[axis][1][level] * position;
            float texel = p->fine[i] ? 0 : ends > 0 ? 0 : BATCH_BOX_VARIANCE;
            float shared = p->fine[i] ? 0 : BATCH_TENT_VARIANCE;
            float rest = (variance[i] + shared - blur) * t->inverse_area[2 * axis][level] - texel;
            variance[i] = (rest > 0 ? rest : 0) * t->spread[axis][level];
        }
    }
    for (int i = 0; i < count; i++) {
        int level = p->level[i];
        p->xy[i] *= t->inverse_area[1][level] * t->spread[0][level] * t->spread[1][level];
    }
}

/* The mean in the level's texels, as a whole number and a rest. */
INLINE void NAME(split_means)(const BatchTexture *t, int count, Places *p)
{
    for (int axis = 0; axis < 2; axis++) {
        const double *mean = axis ? p->y : p->x;
        int *index = axis ? p->row : p->column;
        float *at = axis ? p->at_y : p->at_x;
        for (int i = 0; i < count; i++) {
            double x = mean[i] * t->inverse_scale[p->level[i]][axis] - 0.5;
            x = x > -1e9 ? x : -1e9;
            x = x < 1e9 ? x : 1e9;
            int below = (int)x;
            below -= (double)below > x ? 1 : 0;
            index[i] = below;
            at[i] = (float)(x - (double)below);
        }
    }
}

/* The ellipse in lines, and the blocks that it meets. */
INLINE void NAME(find_windows)(const BatchTexture *t, int count, Places *p)
{
    int gaussian = t->gaussian;
    float wider = GAUSSIAN_REACH / sqrtf(GAUSSIAN_VARIANCE);
    for (int i = 0; i < count; i++) {
        int turned = p->xx[i] > p->yy[i], fine = p->fine[i];
        float along = turned ? p->xx[i] : p->yy[i], across = turned ? p->yy[i] : p->xx[i];
        float mean = turned ? p->at_x[i] : p->at_y[i], beside = turned ? p->at_y[i] : p->at_x[i];
        float slope = along > 1e-12f ? p->xy[i] / along : 0, rest = across - slope * p->xy[i];
        float radius = gaussian ? fine ? 2 * OUTER_DISC : wider : 2;
        float length = radius * sqrtf(along), half = radius * sqrtf(rest > 0 ? rest : 0);
        float width = radius * sqrtf(across);
        length = length > LEAST_RADIUS ? length : LEAST_RADIUS;
        half = half > LEAST_RADIUS ? half : LEAST_RADIUS;
        width = width > half ? width : half;
        float edge = fine ? 1 : gaussian ? 0 : 0.5f, steep = slope < 0 ? -slope : slope;

        float begin = mean - length - edge, end = mean + length + edge;
        int far = !(length < 2 * MAX_BANDS) | !(width < 1e4f);
        begin = far ? 0 : begin;
        end = far ? 0 : end;
        int first = (int)begin, last = (int)end;
        first += (float)first > begin ? 0 : 1;
        last -= (float)last < end ? 0 : 1;
        int lines = last - first + 1;

        float upright = width + edge, leaning = half + steep * (1.5f + edge) + edge;
        upright = far ? 0 : upright;
        leaning = far ? 0 : leaning;
        begin = beside - upright;
        end = beside + upright;
        int left = (int)begin, right = (int)end, columns, narrow = (int)(2 * leaning) + 1;
        left += (float)left > begin ? 0 : 1;
        right -= (float)right < end ? 0 : 1;
        columns = right - left + 1;
        int leans = (narrow + 3) >> 2 < (columns + 3) >> 2;
        columns = leans ? narrow : columns;
        lines = lines > 1 ? lines : 1;
        columns = columns > 1 ? columns : 1;
        far |= (lines > 4 * MAX_BANDS) | (columns > 4 * MAX_BLOCKS) | p->far[i];

        p->turned[i] = turned;
        p->along[i] = mean;
        p->across[i] = beside;
        p->length[i] = length;
        p->half[i] = half;
        p->slope[i] = slope;
        p->lean[i] = leans ? slope : 0;
        p->reach[i] = leans ? leaning : upright;
        p->first[i] = (float)first;
        p->lines[i] = lines;
        p->columns[i] = columns;
        int key = ((fine * MAX_BANDS + ((lines - 1) >> 2)) * MAX_BLOCKS) + ((columns - 1) >> 2);
        p->key[i] = far ? NKEYS : key;
    }
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
    int fine, bands, blocks, lines, columns;
    Lanes along, across, length, half, slope, lean, reach, first;
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
    memset(band->weights, 0, sizeof band->weights);
}

/* A chord's ends, and its rule's weight. */
#define Chord NAME(Chord)
typedef struct Chord {
    Lanes left, right, weight, share; /* share: how far from the line before to the next one, 0..1 */
} Chord;

/* Chords between `low` and the next line's place; the ellipse's size is given apart, for a Gaussian has two. */
INLINE void NAME(find_chords)(const Group *g, const Band *band, Lanes low, Lanes length, Lanes half, int count,
                              const float nodes[][4], const float weights[][4], Chord *chords)
{
    Lanes high = low + 1, begin = MAX(low, -length), end = MIN(high, length);
    Lanes span = MAX(end - begin, NAME(all)(0)), inverse = 1 / length;
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
    Chord chords[3];
    memset(lines, 0, sizeof lines);
    for (int i = 0; i <= band->lines; i++) {
        Lanes here[3], next[3];
        NAME(find_chords)(g, band, band->begin + (float)(i - 1), length, half, 3, batch_nodes3, batch_weights3, chords);
        for (int k = 0; k < 3; k++) {
            next[k] = chords[k].weight * chords[k].share * scale;
            here[k] = chords[k].weight * scale - next[k];
        }
        Lanes *before = lines[i > 0 ? i - 1 : 4], *after = lines[i < 4 ? i : 4];
        for (int c = 0; c < g->columns + 2; c++) {
            Lanes at = NAME(all)((float)(c - 1)), sum = {0}, more = {0};
            for (int k = 0; k < 3; k++) {
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
    Chord chords[2];
    for (int j = 0; j < band->lines; j++) {
        NAME(find_chords)
        (g, band, band->begin + ((float)j - 0.5f), g->length, g->half, 2, batch_nodes2, batch_weights2, chords);
        for (int c = 0; c < g->columns; c++) {
            Lanes begin = NAME(all)((float)c - 0.5f), end = NAME(all)((float)c + 0.5f), w = {0};
            for (int k = 0; k < 2; k++)
                w += chords[k].weight *
                     MAX(MIN(chords[k].right, end) - MAX(chords[k].left, begin), NAME(all)(0));
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
        __m256 lanes[4] = {(__m256)_mm256_unpacklo_pd((__m256d)a, (__m256d)c),
                           (__m256)_mm256_unpackhi_pd((__m256d)a, (__m256d)c),
                           (__m256)_mm256_unpacklo_pd((__m256d)b, (__m256d)d),
                           (__m256)_mm256_unpackhi_pd((__m256d)b, (__m256d)d)};
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

/* Add 4 x 4 texels to four sums, one a column. Weights come by lines, which may be columns. */
INLINE void NAME(sum_block)(float sums[16], const float weights[16], int turned, const float *texels, size_t stride)
{
#if LANES == 16
    static const int rows[2][4][16] = {{{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3},
                                        {4, 4, 4, 4, 5, 5, 5, 5, 6, 6, 6, 6, 7, 7, 7, 7},
                                        {8, 8, 8, 8, 9, 9, 9, 9, 10, 10, 10, 10, 11, 11, 11, 11},
                                        {12, 12, 12, 12, 13, 13, 13, 13, 14, 14, 14, 14, 15, 15, 15, 15}},
                                       {{0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12},
                                        {1, 1, 1, 1, 5, 5, 5, 5, 9, 9, 9, 9, 13, 13, 13, 13},
                                        {2, 2, 2, 2, 6, 6, 6, 6, 10, 10, 10, 10, 14, 14, 14, 14},
                                        {3, 3, 3, 3, 7, 7, 7, 7, 11, 11, 11, 11, 15, 15, 15, 15}}};
    __m512 w = _mm512_loadu_ps(weights), sum = _mm512_loadu_ps(sums);
    for (int r = 0; r < 4; r++, texels += stride)
        sum = _mm512_add_ps(sum, _mm512_mul_ps(_mm512_loadu_ps(texels), _mm512_permutexvar_ps(_mm512_loadu_si512(rows[turned][r]), w)));
    _mm512_storeu_ps(sums, sum);
#else
    int row = turned ? 1 : 4, column = turned ? 4 : 1;
    Float4 sum[4];
    memcpy(sum, sums, sizeof sum);
    for (int r = 0; r < 4; r++, texels += stride)
        for (int c = 0; c < 4; c++)
            sum[c] += load4(texels + 4 * c) * weights[row * r + column * c];
    memcpy(sums, sum, sizeof sum);
#endif
}

INLINE void NAME(sum_blocks)(Group *g, int number, const Band *band)
{
    const Places *p = g->places;
    float weights[LANES][16], around[64];
    int columns[LANES];
    memcpy(columns, &band->column, sizeof columns);
    for (int block = 0; block < g->blocks; block++) {
        NAME(turn_weights)(band, block, weights);
        for (int lane = 0; lane < LANES; lane++) {
            int i = g->index[lane], turned = p->turned[i];
            const TextureLevel *level = &g->texture->texture->levels[p->level[i]];
            int line = (turned ? p->column[i] : p->row[i]) + (int)p->first[i] + 4 * number;
            int texel = (turned ? p->row[i] : p->column[i]) + columns[lane] + 4 * block;
            int x = turned ? line : texel, y = turned ? texel : line;
            if ((unsigned)x <= (unsigned)(level->width - 4) && (unsigned)y <= (unsigned)(level->height - 4) &&
                level->width >= 4 && level->height >= 4) {
                NAME(sum_block)
                (g->sums[lane], weights[lane], turned,
                 level->texels + ((size_t)y * (size_t)level->width + (size_t)x) * 4, (size_t)level->width * 4);
            } else {
                texture_gather_block(g->texture->texture, level, x, y, around);
                NAME(sum_block)(g->sums[lane], weights[lane], turned, around, 16);
            }
        }
    }
}

INLINE void NAME(filter_group)(Group *g, Batch *batch)
{
    Band band;
    const Places *p = g->places;
    Mask index;
    memcpy(&index, g->index, sizeof index);
    g->along = PICK(p->along, index);
    g->across = PICK(p->across, index);
    g->length = PICK(p->length, index);
    g->half = PICK(p->half, index);
    g->slope = PICK(p->slope, index);
    g->lean = PICK(p->lean, index);
    g->reach = PICK(p->reach, index);
    g->first = PICK(p->first, index);
    g->total = NAME(all)(0);
    memset(g->sums, 0, sizeof g->sums);
    for (int b = 0; b < g->bands; b++) {
        NAME(weigh_band)(g, b, &band);
        NAME(sum_blocks)(g, b, &band);
    }
    Lanes inverse = 1 / g->total;
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
    NAME(place_means)(texture, batch, &places);
    NAME(find_covariances)(texture, batch, &places);
    NAME(choose_levels)(texture, batch->count, &places);
    NAME(reduce_covariances)(texture, batch->count, &places);
    NAME(split_means)(texture, batch->count, &places);
    NAME(find_windows)(texture, batch->count, &places);
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
        group.fine = key / (MAX_BANDS * MAX_BLOCKS);
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
