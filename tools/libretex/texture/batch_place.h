/* The first part of batch_body.h: the level of the pyramid for a footprint, its ellipse there, and the blocks of texels
 * that the ellipse meets. */

/* Intermediate results for a batch's footprints. `along` is from line to line, `across` from texel to texel of a
 * line. */
typedef struct Places {
    int level[BATCH_SIZE];
    int column[BATCH_SIZE], row[BATCH_SIZE];     /* texel of the level: the whole part of the mean */
    float at_x[BATCH_SIZE], at_y[BATCH_SIZE];    /* the fraction of the mean */
    float xx[BATCH_SIZE], yy[BATCH_SIZE];        /* variances in the level's texels */
    int line[BATCH_SIZE], texel[BATCH_SIZE];     /* the ellipse's first line; the whole part of the mean across */
    float along[BATCH_SIZE], across[BATCH_SIZE]; /* at_x and at_y along and across lines */
    float length[BATCH_SIZE], half[BATCH_SIZE], slope[BATCH_SIZE]; /* the ellipse: half its length, the middle chord */
    float lean[BATCH_SIZE], reach[BATCH_SIZE]; /* slope of the blocks, and their extent to each side */
    int first[BATCH_SIZE];                     /* line, from the whole part of the mean */
    int lines[BATCH_SIZE], columns[BATCH_SIZE], key[BATCH_SIZE];
    float inner[BATCH_SIZE], side[BATCH_SIZE]; /* of parallelograms: where chords become shorter; the shift of their
                                                  middles to the corner */
    float low[2][BATCH_SIZE], high[2][BATCH_SIZE]; /* for batch_cut.h: limits of the surface, from the mean */
} Places;

/* Finds the mean in the image; u and v too far away become 0. */
RETEX_CPU_INLINE void NAME(find_mean)(const RetexBatchTexture *t, int axis, Lanes u, Lanes v, Double *mean)
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

/* Splits the mean, in texels of the level, into a whole number and a fraction. */
RETEX_CPU_INLINE void NAME(split_mean)(const Double *mean, Lanes texels, Mask *index, Lanes *rest)
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

/* A covariance in texels squared, one in each lane. */
typedef struct Spread {
    Lanes xx, xy, yy;
} Spread;

RETEX_CPU_INLINE Spread NAME(find_spread)(const RetexBatchTexture *t, Lanes su, Lanes sv, Lanes correlation)
{
    const float(*m)[2] = t->to_texels;
    float a = m[0][0], b = m[0][1], c = m[1][0], d = m[1][1];
    Lanes r = MAX(MIN(correlation, NAME(all)(1)), NAME(all)(-1)), uu = su * su, vv = sv * sv, uv = r * su * sv;
    return (Spread){a * a * uu + 2 * a * b * uv + b * b * vv, a * c * uu + (a * d + b * c) * uv + b * d * vv,
                    c * c * uu + 2 * c * d * uv + d * d * vv};
}

/* The sides of a parallelogram in texels: [side], x and y. */
typedef struct Sides {
    Lanes x[2], y[2];
} Sides;

RETEX_CPU_INLINE Sides NAME(find_sides)(const RetexBatchTexture *t, const RetexBatch *batch, int i)
{
    const float(*m)[2] = t->to_texels;
    Sides sides;
    for (int k = 0; k < 2; k++) {
        Lanes u, v;
        LOAD(u, batch->spread[2 * k] + i);
        LOAD(v, batch->spread[2 * k + 1] + i);
        sides.x[k] = m[0][0] * u + m[0][1] * v;
        sides.y[k] = m[1][0] * u + m[1][1] * v;
    }
    return sides;
}

RETEX_CPU_INLINE Spread NAME(spread_of_sides)(const Sides *s)
{
    const float even = 1.0f / 12;
    return (Spread){(s->x[0] * s->x[0] + s->x[1] * s->x[1]) * even, (s->x[0] * s->y[0] + s->x[1] * s->y[1]) * even,
                    (s->y[0] * s->y[0] + s->y[1] * s->y[1]) * even};
}

/* Scales sides to a level; those of lanes that are too far away become 0. */
RETEX_CPU_INLINE void NAME(scale_sides)(const RetexBatchTexture *t, Sides *s, Mask level, Mask far)
{
    const float width = (float)(1 / t->size[0]), height = (float)(1 / t->size[1]);
    const Lanes none = NAME(all)(0);
    const Lanes x = OF_LEVEL(t->texels[0], level) * OF_LEVEL(t->spread[0], level) * width;
    const Lanes y = OF_LEVEL(t->texels[1], level) * OF_LEVEL(t->spread[1], level) * height;
    for (int k = 0; k < 2; k++) {
        s->x[k] = SELECT(far, none, s->x[k] * x);
        s->y[k] = SELECT(far, none, s->y[k] * y);
    }
}

/* Widens a Gaussian that is too long for its width: the level chosen by its width would have far more texels in it than
 * others have. */
RETEX_CPU_INLINE void NAME(widen)(Spread *s, float narrowest)
{
    Lanes sum = s->xx + s->yy, difference = s->xx - s->yy;
    Lanes root = MIN(SQRT(difference * difference + 4 * s->xy * s->xy), sum);
    Lanes lacks = MAX(0.5f * (sum + root) * narrowest - 0.5f * (sum - root), NAME(all)(0));
    s->xx += lacks;
    s->yy += lacks;
}

/* Chooses the level by the smaller variance, of broad footprints by the larger one: each level divides it by four.
 * *fine: texels are interpolated. */
RETEX_CPU_INLINE Mask NAME(choose_level)(const RetexBatchTexture *t, const Spread *s, Mask *fine)
{
    Lanes sum = s->xx + s->yy, difference = s->xx - s->yy, needed;
    Lanes root = MIN(SQRT(difference * difference + 4 * s->xy * s->xy), sum);
    Lanes smaller = 0.5f * (sum - root), larger = MAX(0.5f * (sum + root), NAME(all)(1e-12f)), deciding = smaller;
    if (t->broad) {
        needed = NAME(all)((t->most + 1.0f / 12) / 4);
        deciding = larger;
        *fine = (Mask){0};
    } else if (t->gaussian) {
        needed = NAME(all)(t->least + 1.0f / 12);
        *fine = smaller < t->least - BATCH_TENT_VARIANCE;
    } else if (t->straight) {
        needed = STRAIGHT_LONG_LEAST + (STRAIGHT_LEAST - STRAIGHT_LONG_LEAST) * SQRT(smaller / larger);
        *fine = smaller < STRAIGHT_BOX_FROM;
    } else {
        needed = LONG_LEAST + BATCH_TENT_VARIANCE + (ROUND_LEAST - LONG_LEAST) * SQRT(smaller / larger);
        deciding = MAX(deciding, larger * needed * (4 / (LONGEST_DEVIATION * LONGEST_DEVIATION)));
        *fine = smaller < BOX_FROM;
    }
    Mask level = (((Mask)((deciding + 0.25f) / needed) >> 23) - 127) >> 1;
    level &= level > 0;
    Mask over = level > t->levels - 1;
    level = (over & (t->levels - 1)) | (~over & level);
    const Mask under = level < t->first;
    level = (under & t->first) | (~under & level);
    *fine &= level == 0;
    return level;
}

/* The variance that remains on a level. */
RETEX_CPU_INLINE Lanes NAME(reduce_variance)(const RetexBatchTexture *t, int axis, const Double *mean, Lanes variance,
                                             Mask level, Mask fine)
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
    /* A Gaussian is sampled at texels, so its window must contain some of them. */
    Lanes least = SELECT(fine, NAME(all)(0), NAME(all)(t->gaussian ? t->least : 0));
    return MAX(rest * OF_LEVEL(t->spread[axis], level), least);
}

/* The first texel of an open interval, and the number of texels. */
RETEX_CPU_INLINE Mask NAME(first_within)(Lanes begin, Lanes end, Mask *count)
{
    Mask first = NAME(whole_below)(begin) + 1, last = -NAME(whole_below)(-end) - 1;
    *count = last - first + 1;
    return first;
}

#include "texture/batch_cut.h"

/* An ellipse or parallelogram in lines; width: half its extent across. */
#define Outline NAME(Outline)
typedef struct Outline {
    Lanes length, half, slope, width, inner, side;
} Outline;

RETEX_CPU_INLINE Outline NAME(find_ellipse)(const RetexBatchTexture *t, const Spread *s, Mask turned, Mask fine)
{
    const Lanes least = NAME(all)(LEAST_RADIUS), none = NAME(all)(0);
    float wider = t->gaussian ? GAUSSIAN_REACH / sqrtf(GAUSSIAN_VARIANCE) : 2;
    Lanes along = SELECT(turned, s->xx, s->yy), across = SELECT(turned, s->yy, s->xx);
    Lanes slope = s->xy / MAX(along, NAME(all)(1e-12f));
    Lanes radius = SELECT(fine, NAME(all)(t->gaussian ? 2 * OUTER_DISC : 2), NAME(all)(wider));
    Lanes length = MAX(radius * SQRT(along), least), half = radius * SQRT(MAX(across - slope * s->xy, none));
    half = MAX(half, least);
    return (Outline){length, half, slope, MAX(radius * SQRT(across), half), none, none};
}

RETEX_CPU_INLINE Outline NAME(find_parallelogram)(const Sides *s, Mask turned)
{
    const Lanes least = NAME(all)(LEAST_RADIUS), none = NAME(all)(0);
    Lanes along[2], across[2];
    for (int k = 0; k < 2; k++) {
        Lanes a = SELECT(turned, s->x[k], s->y[k]), b = SELECT(turned, s->y[k], s->x[k]);
        along[k] = MAX(a, -a);
        across[k] = SELECT(a < none, -b, b); /* sides that go up the lines */
    }
    Mask second = along[1] > along[0];
    Lanes longer = MAX(MAX(along[0], along[1]), 2 * least), shorter = MIN(along[0], along[1]);
    Lanes slope = SELECT(second, across[1], across[0]) / longer;
    Lanes side = 0.5f * (SELECT(second, across[0], across[1]) - slope * shorter), half = MAX(MAX(side, -side), least);
    Lanes width = 0.5f * (MAX(across[0], -across[0]) + MAX(across[1], -across[1])) + least;
    return (Outline){0.5f * (longer + shorter), half, slope, width, 0.5f * (longer - shorter), side};
}

/* Computes the blocks that the outline meets. */
RETEX_CPU_INLINE void NAME(find_window)(const RetexBatchTexture *t, const Outline *outline, Mask turned, Lanes at_x,
                                        Lanes at_y, Mask column, Mask row, Mask fine, Mask far, const Ends *ends,
                                        Places *p, int i)
{
    const Lanes least = NAME(all)(LEAST_RADIUS), none = NAME(all)(0);
    Lanes mean = SELECT(turned, at_x, at_y), beside = SELECT(turned, at_y, at_x);
    Lanes length = outline->length, half = outline->half, slope = outline->slope, width = outline->width;
    /* Slightly more than the reach of texels, so that rounding does not depend on the windows of other lanes. */
    Lanes edge = SELECT(fine, NAME(all)(1), NAME(all)(t->gaussian ? 0 : 0.5f)) + 1e-4f;

    far |= ~(length < 2 * MAX_STRIPS) | ~(width < 8 * MAX_BLOCKS * MAX_STRIPS);
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
    far |= (lines > 4 * MAX_STRIPS) | (columns > 4 * MAX_BLOCKS);
    Mask key = (turned & (2 * MAX_STRIPS * MAX_BLOCKS)) + (fine & (MAX_STRIPS * MAX_BLOCKS)) +
               ((lines + 3) >> 2) * MAX_BLOCKS + ((columns + 3) >> 2);
    Mask cut = {0};
    if (t->limited)
        cut = NAME(place_ends)(ends, turned, length + edge, width + edge, p, i);
    key += cut & (4 * MAX_STRIPS * MAX_BLOCKS);
    key = ((key - MAX_BLOCKS - 1) & ~far) | (NKEYS & far);

    STORE(p->line + i, first + SELECT_INT(turned, column, row));
    STORE(p->texel + i, SELECT_INT(turned, row, column));
    STORE(p->along + i, mean);
    STORE(p->across + i, beside);
    STORE(p->length + i, length);
    STORE(p->half + i, half);
    STORE(p->slope + i, slope);
    if (t->straight) {
        STORE(p->inner + i, SELECT(far, none, outline->inner));
        STORE(p->side + i, SELECT(far, none, outline->side));
    }
    STORE(p->lean + i, SELECT(leans, slope, none));
    STORE(p->reach + i, SELECT(leans, leaning, upright));
    STORE(p->first + i, first);
    STORE(p->lines + i, lines);
    STORE(p->columns + i, columns);
    STORE(p->key + i, key);
}

/* All steps for the footprints from i on. */
RETEX_CPU_INLINE void NAME(place)(const RetexBatchTexture *t, const RetexBatch *batch, Places *p, int i)
{
    Lanes u, v, su, sv, correlation, at[2];
    Sides sides;
    LOAD(u, batch->u + i);
    LOAD(v, batch->v + i);
    LOAD(su, batch->spread[0] + i);
    LOAD(sv, batch->spread[1] + i);
    LOAD(correlation, batch->spread[2] + i);
    if (t->straight)
        sides = NAME(find_sides)(t, batch, i);
    Mask far = {0}, fine, index[2];
    for (int axis = 0; axis < 2; axis++) {
        Lanes x = (float)t->matrix[axis][0] * u + (float)t->matrix[axis][1] * v + (float)t->offset[axis];
        far |= ~(MAX(x, -x) < 1e6f);
    }
    Spread s = t->straight ? NAME(spread_of_sides)(&sides) : NAME(find_spread)(t, su, sv, correlation);
    far |= ~(s.xx + s.yy < 1e18f);
    const Lanes none = NAME(all)(0);
    u = SELECT(far, none, u);
    v = SELECT(far, none, v);
    s = (Spread){SELECT(far, none, s.xx), SELECT(far, none, s.xy), SELECT(far, none, s.yy)};

    if (t->gaussian)
        NAME(widen)(&s, t->narrowest);
    Double mean[2][2];
    Mask level = NAME(choose_level)(t, &s, &fine);
    for (int axis = 0; axis < 2; axis++) {
        NAME(find_mean)(t, axis, u, v, mean[axis]);
        NAME(split_mean)(mean[axis], OF_LEVEL(t->texels[axis], level), &index[axis], &at[axis]);
    }
    if (t->straight) { /* which do not shrink, so that those of neighbouring pixels adjoin */
        NAME(scale_sides)(t, &sides, level, far);
        s = NAME(spread_of_sides)(&sides);
    } else {
        s.xx = NAME(reduce_variance)(t, 0, mean[0], s.xx, level, fine);
        s.yy = NAME(reduce_variance)(t, 1, mean[1], s.yy, level, fine);
        s.xy *= OF_LEVEL(t->inverse_area[1], level) * OF_LEVEL(t->spread[0], level) * OF_LEVEL(t->spread[1], level);
    }
    if (t->broad) { /* the least variances may leave no covariance: it is at most that of the narrowest ellipse */
        const Lanes most = (1 - t->narrowest) / (1 + t->narrowest) * SQRT(s.xx * s.yy);
        s.xy = MAX(MIN(s.xy, most), -most);
    }
    STORE(p->level + i, level);
    STORE(p->column + i, index[0]);
    STORE(p->row + i, index[1]);
    STORE(p->xx + i, s.xx);
    STORE(p->yy + i, s.yy);
    STORE(p->at_x + i, at[0]);
    STORE(p->at_y + i, at[1]);
    Ends ends[2];
    for (int axis = 0; axis < 2 && t->limited; axis++)
        ends[axis] = NAME(find_ends)(t, axis, u, v, level);
    const Mask turned = t->broad ? (Mask){0} : s.xx > 1.1f * s.yy; /* round ellipses are never turned */
    const Outline outline =
        t->straight ? NAME(find_parallelogram)(&sides, turned) : NAME(find_ellipse)(t, &s, turned, fine);
    NAME(find_window)(t, &outline, turned, at[0], at[1], index[0], index[1], fine, far, ends, p, i);
}

/* Leaves footprints smaller than texels that a transparent border cuts: it is sharp there. For others the texels around
 * the image are transparent. */
RETEX_CPU_INLINE void NAME(leave_borders)(const RetexBatchTexture *t, RetexBatch *batch, Places *p)
{
    float wider = t->gaussian ? GAUSSIAN_REACH / sqrtf(GAUSSIAN_VARIANCE) : t->straight ? 2.5f : 2;
    if (!t->black[0] && !t->black[1])
        return;
    for (int axis = 0; axis < 2; axis++) {
        if (!t->black[axis])
            continue;
        const float *variance = axis ? p->yy : p->xx, *at = axis ? p->at_y : p->at_x;
        const int *index = axis ? p->row : p->column;
        for (int i = 0; i < batch->count; i++) {
            if (p->key[i] == NKEYS || !(p->key[i] / (MAX_STRIPS * MAX_BLOCKS) % 2) || variance[i] > SHARP_VARIANCE)
                continue;
            const RetexTextureLevel *level = &t->texture->levels[p->level[i]];
            float x = (float)index[i] + at[i], reach = wider * sqrtf(variance[i]) + 1.5f;
            if (x - reach < 0 || x + reach > (float)((axis ? level->height : level->width) - 1))
                batch->sharp[i] |= (unsigned char)(1 << axis);
        }
    }
    for (int i = 0; i < batch->count; i++)
        p->key[i] = batch->sharp[i] ? NKEYS : p->key[i];
}
