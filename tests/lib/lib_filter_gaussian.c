/* The exact Gaussian footprint. See lib_filter.h.
 *
 * The average is of the bilinear reconstruction of the image, so that a footprint that shrinks to a point becomes the
 * point look-up. Its kernel over the image's texels has the footprint's covariance plus 1/6 texel^2 (the tent's
 * variance) on each axis. A level of the pyramid has already applied a box; the sum over the level's texels applies a
 * Gaussian with the remaining covariance. Since variances add, the total has the right covariance on any level: the
 * choice of level is one of cost, and levels need no blending.
 *
 * The sum goes by rows. Along y the Gaussian is the marginal one; within a row it is the conditional one, whose centre
 * moves by slope = xy / yy per row and whose variance is xx - xy^2 / yy. This is exact for any orientation, and where
 * the smaller eigenvalue is large enough for sampling at texels, so are both variances. */
#include "lib_filter_texels.h"

typedef int Int4 __attribute__((vector_size(16)));

/* A Gaussian sampled at texels with this variance keeps its own variance within 2.8% at any phase. */
#define LEAST_VARIANCE 0.35
/* Below this the tent is used rather than a Gaussian: a window of few texels that is cut off does not have the
 * Gaussian's variance. */
#define TENT_LIMIT 0.70f
/* Windows end at 3.25 standard deviations, lowered so that they end at zero; that takes 4.7% of the variance. */
#define WINDOW_REACH 3.25f
#define WINDOW_EDGE 0.00508606923f /* exp(-3.25^2 / 2) */
#define WINDOW_VARIANCE 0.952889f  /* of the lowered window, relative to the Gaussian it was made of */
#define MAX_TEXELS 1150            /* texels of a look-up; longer footprints skip texels along their length */
#define MAX_TAPS 512               /* along one axis */

/* For a footprint smaller than a texel on an axis with transparent outside: the border is sharp there, as in the point
 * look-up. The border's texels continue outside, and the result is weighted by the share of the footprint inside. */
typedef struct Edges {
    int sharp[2];
} Edges;

/* The sum of weight[i] * texel(first + i * step) of one row, texels as they are stored. */
static inline RetexFloat4 sum_row(const RetexLevelRow *row, int width, RetexWrap wrap, int narrow,
                                  const float *restrict weight, int count, int first, int step)
{
    RetexFloat4 sum = {0, 0, 0, 0}, odd = {0, 0, 0, 0};
    size_t size = texel_size(narrow);
    if (!row->texels)
        return sum;
    if (first >= 0 && first + (count - 1) * step < width) {
        const char *p = row->texels + (size_t)first * size;
        size_t pace = size * (size_t)step;
        int i = 0;
        for (; i + 1 < count; i += 2, p += 2 * pace) { /* two independent sums, for parallel execution */
            sum += raw_texel(p, narrow) * weight[i];
            odd += raw_texel(p + pace, narrow) * weight[i + 1];
        }
        return i < count ? sum + odd + raw_texel(p, narrow) * weight[i] : sum + odd;
    }
    for (int i = 0; i < count; i++) {
        int outside = first + i * step;
        int at = wrap == EDGE_TEXELS ? clamp_index(outside, width) : wrap_index(outside, width, wrap);
        const char *p = (unsigned)at < (unsigned)width ? row->texels + (size_t)at * size : row->beside[at > 0];
        if (p)
            sum += raw_texel(p, narrow) * weight[i];
    }
    return sum;
}

static inline float tail(const float *restrict table, float z)
{
    float at = fabsf(z) * TEXTURE_TAIL_STEPS;
    if (at >= TEXTURE_TAIL_STEPS * TEXTURE_TAIL_END)
        return 0;
    int i = (int)at;
    float t = at - (float)i;
    return table[i] + t * (table[i + 1] - table[i]);
}

/* Weights of one axis at texels first, first + step, ... for a kernel at centre (texel i lies at i). */
typedef struct Window {
    int first, count;
    float total;
    float weight[MAX_TAPS];
} Window;

/* The tent blurred by a Gaussian of that standard deviation; 0 gives the two taps of linear interpolation. */
static inline void tent_window(Window *restrict window, const float *restrict table, float centre, float sd)
{
    float reach = 1 + WINDOW_REACH * sd;
    int first = whole_above(centre - reach);
    int count = whole_below(centre + reach) - first + 1;
    float inverse = sd > 1e-4f ? 1 / sd : 1e4f, total = 0;
    float d = (float)first - centre;
    float before = tail(table, (d - 1) * inverse), here = tail(table, d * inverse);
    for (int i = 0; i < count; i++, d += 1) {
        float after = tail(table, (d + 1) * inverse);
        float tent = 1 - fabsf(d);
        float w = (tent > 0 ? tent : 0) + sd * (before - 2 * here + after);
        window->weight[i] = w;
        total += w;
        before = here;
        here = after;
    }
    window->first = first;
    window->count = count;
    window->total = total;
}

/* Cuts off weights beyond low and high; a texel that is cut keeps its share. */
static inline void cut_window(Window *restrict window, int step, float low, float high)
{
    float total = 0;
    for (int i = 0; i < window->count; i++) {
        float at = (float)(window->first + i * step), begin = at - 0.5f * (float)step, end = begin + (float)step;
        float inside = (end < high ? end : high) - (begin > low ? begin : low);
        if (!(inside >= (float)step))
            window->weight[i] *= inside > 0 ? inside / (float)step : 0;
        total += window->weight[i];
    }
    window->total = total;
}

/* The parameters of a window, apart from its centre. */
typedef struct Shape {
    int tent; /* 1: a tent blurred by sd; 0: a Gaussian of variance 1 / inverse, up to reach */
    int step; /* texels from tap to tap */
    float sd, inverse, reach;
    float curve; /* exp(-step^2 / variance): how much the ratio of neighbouring taps falls from tap to tap */
} Shape;

/* exp(-d^2 / 2) at equal steps by two multiplications each, the exponent being quadratic; four taps at a time. The
 * recurrence restarts every 32 taps, so that rounding errors do not accumulate. */
static inline void gaussian_window(Window *restrict window, const Shape *shape, float centre)
{
    int first = whole_above(centre - shape->reach), step = shape->step;
    int count = (whole_below(centre + shape->reach) - first) / step + 1;
    count = count > MAX_TAPS ? MAX_TAPS : count;
    float s = (float)step, curve = shape->curve, curve2 = curve * curve, curve4 = curve2 * curve2;
    float curve8 = curve4 * curve4, curve16 = curve8 * curve8;
    RetexFloat4 total = {0, 0, 0, 0};
    for (int begin = 0; begin < count; begin += 32) {
        float d = (float)first + (float)begin * s - centre;
        float w0 = expf(-0.5f * d * d * shape->inverse), ratio = expf(-(d + 0.5f * s) * s * shape->inverse);
        float w1 = w0 * ratio, w2 = w1 * ratio * curve, w3 = w2 * ratio * curve2;
        float ratio2 = ratio * ratio, over4 = ratio2 * ratio2 * curve4 * curve2;
        RetexFloat4 w = {w0, w1, w2, w3};
        RetexFloat4 ratios = {over4, over4 * curve4, over4 * curve8, over4 * curve8 * curve4};
        int end = begin + 32 < count ? begin + 32 : count;
        for (int i = begin; i < end; i += 4) {
            RetexFloat4 lowered = w - WINDOW_EDGE;
            lowered = (RetexFloat4)((Int4)lowered & (lowered > 0));
            memcpy(window->weight + i, &lowered, sizeof lowered);
            total += lowered;
            w *= ratios;
            ratios *= curve16;
        }
    }
    window->first = first;
    window->count = count;
    window->total = (total[0] + total[1]) + (total[2] + total[3]);
}

static inline Shape find_shape(double variance)
{
    Shape shape = {.step = 1};
    if (variance < TENT_LIMIT) {
        shape.tent = 1;
        shape.sd = variance > TENT_VARIANCE ? sqrtf((float)(variance - TENT_VARIANCE)) : 0;
        shape.reach = 1 + WINDOW_REACH * shape.sd;
    } else {
        float wider = (float)variance / WINDOW_VARIANCE;
        shape.inverse = 1 / wider;
        shape.reach = WINDOW_REACH * sqrtf(wider);
    }
    return shape;
}

static inline void finish_shape(Shape *shape)
{
    float s = (float)shape->step;
    if (!shape->tent)
        shape->curve = expf(-s * s * shape->inverse);
}

static inline void make_window(Window *restrict window, const float *restrict table, const Shape *shape, float centre)
{
    if (shape->tent)
        tent_window(window, table, centre, shape->sd);
    else
        gaussian_window(window, shape, centre);
}

/* Limits the look-up to MAX_TEXELS by skipping texels along the longer axis. */
static inline void limit_taps(Shape *x, Shape *y, const RetexTextureLevel *level, const RetexTexture *texture)
{
    float taps = (2 * x->reach + 1) * (2 * y->reach + 1);
    if (taps <= MAX_TEXELS)
        return;
    int step = whole_above(taps / MAX_TEXELS);
    if (x->reach > y->reach)
        x->step = coprime_step(step, level->width, texture->spec.wrap[0]);
    else
        y->step = coprime_step(step, level->height, texture->spec.wrap[1]);
}

/* 1 if both eigenvalues of the covariance that remains on a level are at least LEAST_VARIANCE. */
static inline int level_fits(const RetexTexture *texture, int level, const TexelFootprint *f,
                             const double position[2])
{
    LevelCovariance rest = level_rest(&texture->levels[level], f, position);
    double x = rest.xx - LEAST_VARIANCE, y = rest.yy - LEAST_VARIANCE;
    if (is_flat(texture, 0))
        return y >= 0;
    if (is_flat(texture, 1))
        return x >= 0;
    return x >= 0 && y >= 0 && x * y >= rest.xy * rest.xy;
}

/* The coarsest level that fits; the image itself always does. */
static inline int find_level(const RetexTexture *texture, const TexelFootprint *f, const double position[2])
{
    double trace = f->xx + f->yy;
    /* det / trace lies between half the smaller eigenvalue and itself, and a level of s texels wants about 0.43 s^2: a
     * good guess to begin with. */
    double smaller = trace > 0 ? (f->xx * f->yy - f->xy * f->xy) / trace : 0;
    int level = smaller > 2 ? ilogb(smaller) / 2 : 0;
    if (level > texture->nlevels - 1)
        level = texture->nlevels - 1;
    while (level > 0 && !level_fits(texture, level, f, position))
        level--;
    while (level + 1 < texture->nlevels && level_fits(texture, level + 1, f, position))
        level++;
    return level;
}

/* The variance that a window has at its centre: a tent's varies between 0 and 1/4 as its centre moves from texel to
 * texel. */
static inline float spread(const Window *window, float centre)
{
    float sum = 0;
    for (int i = 0; i < window->count; i++) {
        float d = (float)(window->first + i) - centre;
        sum += window->weight[i] * d * d;
    }
    return sum / window->total;
}

/* The limits of a footprint, in the level's texels from its centre. */
typedef struct Limits {
    float low[2], high[2];
} Limits;
static const Limits no_limits = {{-INFINITY, -INFINITY}, {INFINITY, INFINITY}};

/* The sum over a level's texels of a Gaussian with mean (x, y), in texel indices, and covariance rest. *kept: the share
 * of it within the limits. */
static inline RetexFloat4 sum_level(const RetexTexture *texture, const RetexTextureLevel *level, float x, float y,
                                    LevelCovariance rest, const Limits *limits, const Edges *edges, float *kept)
{
    /* Along an axis of one repeating texel only the marginal matters. */
    int flat_x = level->width == 1 && (texture->spec.wrap[0] <= RETEX_WRAP_MIRROR || is_flat(texture, 0));
    int flat_y = level->height == 1 && (texture->spec.wrap[1] <= RETEX_WRAP_MIRROR || is_flat(texture, 1));
    double slope = flat_x || flat_y ? 0 : rest.xy / rest.yy;
    Shape shape_x = find_shape(flat_x ? 0 : rest.xx - slope * rest.xy), shape_y = find_shape(flat_y ? 0 : rest.yy);
    if (flat_x)
        x = 0;
    if (flat_y)
        y = 0;
    limit_taps(&shape_x, &shape_y, level, texture);
    finish_shape(&shape_x);
    finish_shape(&shape_y);

    Window rows, columns;
    make_window(&rows, texture->tail, &shape_y, y);
    float total = 0, whole = rows.total;
    if (shape_y.tent && slope != 0) {           /* the covariance is the slope times the actual variance of the rows */
        double least = rest.yy - TENT_VARIANCE; /* variance of the footprint alone, the lower bound */
        slope = rest.xy / fmax(spread(&rows, y), least > 1e-9 ? least : 1e-9);
        int step = shape_x.step;
        shape_x = find_shape(rest.xx - slope * rest.xy);
        shape_x.step = step;
        finish_shape(&shape_x);
    }
    if (limits->low[1] > -shape_y.reach || limits->high[1] < shape_y.reach)
        cut_window(&rows, shape_y.step, y + limits->low[1], y + limits->high[1]);
    int upright = fabs(slope) * rows.count * shape_y.step < 1e-3;
    float reach = shape_x.reach + (float)fabs(slope) * (shape_y.reach + 1);
    int cut = limits->low[0] > -reach || limits->high[0] < reach;
    if (upright) {
        make_window(&columns, texture->tail, &shape_x, x);
        whole *= columns.total;
        if (cut)
            cut_window(&columns, shape_x.step, x + limits->low[0], x + limits->high[0]);
    }
    RetexFloat4 sum = {0, 0, 0, 0};
    for (int j = 0; j < rows.count; j++) {
        int at = rows.first + j * shape_y.step;
        if (!upright) {
            make_window(&columns, texture->tail, &shape_x, x + (float)slope * ((float)at - y));
            whole *= j == 0 ? columns.total : 1; /* all rows have the same total */
            if (cut)
                cut_window(&columns, shape_x.step, x + limits->low[0], x + limits->high[0]);
        }
        RetexLevelRow row = find_row(texture, level, at, edges->sharp[1]);
        RetexWrap wrap = edges->sharp[0] ? EDGE_TEXELS : texture->spec.wrap[0];
        sum += rows.weight[j] *
               (texture->narrow
                    ? sum_row(&row, level->width, wrap, 1, columns.weight, columns.count, columns.first, shape_x.step)
                    : sum_row(&row, level->width, wrap, 0, columns.weight, columns.count, columns.first, shape_x.step));
        total += rows.weight[j] * columns.total;
    }
    *kept = total / whole;
    return sum * texel_unit(texture->narrow) / total;
}

/* The share of a Gaussian at x within 0..size. */
static float coverage(double x, double variance, double size)
{
    double inverse = variance > 1e-12 ? sqrt(0.5 / variance) : 1e6;
    return (float)(0.5 * (erf((size - x) * inverse) + erf(x * inverse)));
}

void filter_texels_gaussian(const RetexTexture *texture, const TexelFootprint *footprint, float rgba[4])
{
    const RetexTextureLevel *image = &texture->levels[0];
    double x = first_period(footprint->x, image->width, texture->spec.wrap[0]);
    double y = first_period(footprint->y, image->height, texture->spec.wrap[1]);
    double position[2] = {mean_position(x, footprint->xx, image->width, texture->spec.wrap[0]),
                          mean_position(y, footprint->yy, image->height, texture->spec.wrap[1])};
    const RetexTextureLevel *level = &texture->levels[find_level(texture, footprint, position)];
    LevelCovariance rest = level_rest(level, footprint, position);
    Edges edges = {{texture->spec.wrap[0] == RETEX_WRAP_BLACK && rest.xx < TENT_LIMIT,
                    texture->spec.wrap[1] == RETEX_WRAP_BLACK && rest.yy < TENT_LIMIT}};
    Limits limits;
    for (int axis = 0; axis < 2; axis++) {
        limits.low[axis] = (float)(footprint->low[axis] / level->scale[axis]);
        limits.high[axis] = (float)(footprint->high[axis] / level->scale[axis]);
    }
    float column = (float)(x / level->scale[0] - 0.5), row = (float)(y / level->scale[1] - 0.5), kept;
    RetexFloat4 sum = sum_level(texture, level, column, row, rest, &limits, &edges, &kept);
    if (!(kept > 1e-3f)) /* a footprint that would lose nearly all is not cut */
        sum = sum_level(texture, level, column, row, rest, &no_limits, &edges, &kept);
    if (edges.sharp[0])
        sum *= coverage(x, footprint->xx, image->width);
    if (edges.sharp[1])
        sum *= coverage(y, footprint->yy, image->height);
    memcpy(rgba, &sum, sizeof sum);
}
