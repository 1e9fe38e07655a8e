/* Textures averaged evenly over an outline, an ellipse or a parallelogram, one footprint at a time. See
 * lib_filter.h.
 *
 * As in lib_filter_gaussian.c the average is of the bilinear reconstruction of the image, and the variance of a level's
 * texels is compensated: the outline shrinks by it. On coarser levels, where an outline covers many texels, texels are
 * treated as averages over squares: a box replaces the tent.
 *
 * The outline is cut into chords across its longer image axis. Along a chord the integral of the reconstruction is
 * exact: a texel's weight is the difference of the tent's integral S at the chord's ends. Weights are accumulated as
 * differences: an end changes S at three neighbouring texels only, so a chord costs six additions a line of texels,
 * however long it is. From chord to chord the quadrature is Gauss's between two lines of texels, where the tent is
 * linear. At an ellipse's tips, where the chord's length is a square root, it is Gauss-Jacobi's; a parallelogram is cut
 * at its corners, between which the chord's length is linear. */
#include "lib_filter_texels.h"

/* The smaller eigenvalue that must remain on a level: below it the result depends visibly on the position of texels. */
#define LEAST_VARIANCE 0.2
/* The eigenvalue that should remain if the cost allows it, because the level's texels blur the ellipse's rim. */
#define GOOD_VARIANCE 3.4
#define MAX_TEXELS 350 /* with more texels a coarser level is used if LEAST_VARIANCE remains there */
/* With this variance a coarser level's texels need no interpolation, and without it the rim is sharper. */
#define BOX_LEAST 1.0
#define BOX_VARIANCE (1.0 / 12)
#define MAX_LENGTH 80 /* lines to each side; with more, lines are skipped */
#define MAX_ACROSS (2 * MAX_LENGTH + 8)
#define LEAST_HALF 0.002f /* half length of a chord; shorter ones lose digits */

/* The level as lines of texels: rows, or columns where the ellipse is flat. In this file index 0 of a pair is along,
 * from line to line, and index 1 across, from texel to texel of a line. */
typedef struct Lines {
    const RetexTexture *texture;
    const RetexTextureLevel *level;
    int turned;   /* 1: lines are columns */
    int box;      /* 1: texels are averages over squares; 0: they are interpolated */
    int count[2]; /* lines; texels of each */
    size_t step;  /* bytes from texel to texel of a line */
    RetexWrap wrap[2];
} Lines;

/* An ellipse or parallelogram over lines; `at` in indices of lines and texels. */
typedef struct Outline {
    double at[2];
    double length; /* half its extent along */
    double slope;  /* shift of the chords' middles from line to line */
    double half;   /* half the middle chord */
    /* Of a parallelogram, else 0: chords keep their length up to this distance from the middle one, then become shorter
     * up to the corner, to which their middles shift by `side`, which is half or -half. */
    int straight;
    double inner, side;
} Outline;

typedef float Float2 __attribute__((vector_size(8)));

/* Weights of a line and of the next one, as differences from texel to texel. low and high (one beyond the last) bound
 * those that chords have changed: [0] as the current line, [1] as the next one. */
typedef struct Strip {
    int low[2], high[2];
    Float2 change[MAX_ACROSS];
} Strip;

/* Gauss's quadrature rules on 0..1. Weights are divided by the factor that the chord's length contains: 1 inside,
 * sqrt(t) after the ellipse's tip, sqrt(1 - t) before the other, the product of both where the ellipse is between two
 * lines. */
typedef struct Rule {
    int count;
    struct {
        float at, weight;
    } nodes[5];
} Rule;
static const Rule rules[2][4] = {
    {{2, {{0.21132487f, 0.5f}, {0.78867513f, 0.5f}}},
     {2, {{0.2899492f, 0.5154537f}, {0.82116191f, 0.42939674f}}},
     {2, {{0.17883809f, 0.42939674f}, {0.7100508f, 0.5154537f}}},
     {5,
      {{0.066987298f, 0.13089969f},
       {0.25f, 0.22672492f},
       {0.5f, 0.26179939f},
       {0.75f, 0.22672492f},
       {0.9330127f, 0.13089969f}}}},
    {{3, {{0.11270167f, 0.27777778f}, {0.5f, 0.44444444f}, {0.88729833f, 0.27777778f}}},
     {3, {{0.16471029f, 0.30992775f}, {0.5498685f, 0.41482054f}, {0.90080583f, 0.24579041f}}},
     {3, {{0.099194171f, 0.24579041f}, {0.4501315f, 0.41482054f}, {0.83528971f, 0.30992775f}}},
     {5,
      {{0.066987298f, 0.13089969f},
       {0.25f, 0.22672492f},
       {0.5f, 0.26179939f},
       {0.75f, 0.22672492f},
       {0.9330127f, 0.13089969f}}}}};

/* The ellipse of a covariance, in lines; a flat axis, of one repeating texel, is across. */
static Outline find_ellipse(const LevelCovariance *c, const int flat[2], int *turned)
{
    double xx = c->xx > 0 ? c->xx : 0, yy = c->yy > 0 ? c->yy : 0;
    *turned = flat[1] || (xx > yy && !flat[0]);
    double along = *turned ? xx : yy, across = *turned ? yy : xx;
    Outline e = {.length = 2 * sqrt(along)};
    if (!flat[0] && !flat[1] && along > 0) {
        e.slope = c->xy / along;
        double rest = across - e.slope * c->xy;
        e.half = rest > 0 ? 2 * sqrt(rest) : 0;
    }
    return e;
}

static void find_flat(const RetexTexture *texture, const RetexTextureLevel *level, int flat[2])
{
    flat[0] = level->width == 1 && (texture->spec.wrap[0] <= RETEX_WRAP_MIRROR || is_flat(texture, 0));
    flat[1] = level->height == 1 && (texture->spec.wrap[1] <= RETEX_WRAP_MIRROR || is_flat(texture, 1));
}

/* The covariance of the ellipse on a level, without that of the level's reconstruction. */
static LevelCovariance ellipse_rest(const RetexTextureLevel *level, const TexelFootprint *f,
                                                const double position[2], int box)
{
    LevelCovariance rest = level_rest(level, f, position);
    rest.xx -= box ? BOX_VARIANCE : TENT_VARIANCE;
    rest.yy -= box ? BOX_VARIANCE : TENT_VARIANCE;
    return rest;
}

static int level_variance_left(const RetexTexture *texture, int level, const TexelFootprint *f,
                                      const double position[2], double least)
{
    LevelCovariance rest = ellipse_rest(&texture->levels[level], f, position, 0);
    double x = rest.xx - least, y = rest.yy - least;
    if (is_flat(texture, 0) || is_flat(texture, 1))
        return (is_flat(texture, 0) || x >= 0) && (is_flat(texture, 1) || y >= 0);
    return x >= 0 && y >= 0 && x * y >= rest.xy * rest.xy;
}

static int taps_of(const Outline *e)
{
    double length = e->length < 1e4 ? e->length : 1e4, half = e->half < 1e4 ? e->half : 1e4;
    return (int)((2 * length + 2) * (2 * half + 2 + fabs(e->slope)));
}

static int find_level(const RetexTexture *texture, const TexelFootprint *f, const double position[2],
                             int *box)
{
    double trace = f->xx + f->yy, smaller = trace > 0 ? (f->xx * f->yy - f->xy * f->xy) / trace : 0;
    int level = smaller > GOOD_VARIANCE ? ilogb(smaller / GOOD_VARIANCE) / 2 : 0, flat[2], turned;
    if (level > texture->nlevels - 1)
        level = texture->nlevels - 1;
    while (level > 0 && !level_variance_left(texture, level, f, position, GOOD_VARIANCE))
        level--;
    while (level + 1 < texture->nlevels && level_variance_left(texture, level + 1, f, position, GOOD_VARIANCE))
        level++;
    for (; level + 1 < texture->nlevels; level++) {
        find_flat(texture, &texture->levels[level], flat);
        LevelCovariance rest = ellipse_rest(&texture->levels[level], f, position, 0);
        Outline e = find_ellipse(&rest, flat, &turned);
        if (taps_of(&e) <= MAX_TEXELS || !level_variance_left(texture, level + 1, f, position, LEAST_VARIANCE))
            break;
    }
    *box = level > 0 && level_variance_left(texture, level, f, position, BOX_LEAST);
    return level;
}

/* The index of a line, or of a texel of a line, in the level. Transparent axes are cut where the image ends, so that
 * the border's texels continue. */
static int wrap_line(const Lines *lines, int axis, int i)
{
    int n = lines->count[axis];
    return lines->wrap[axis] == RETEX_WRAP_BLACK ? clamp_index(i, n) : wrap_index(i, n, lines->wrap[axis]);
}

static const char *find_texel(const Lines *lines, int line, int texel)
{
    const RetexTextureLevel *level = lines->level;
    const RetexTexture *texture = lines->texture;
    size_t size = texel_size(texture->narrow);
    int x = lines->turned ? line : texel, y = lines->turned ? texel : line; /* wrapped already */
    if ((unsigned)y < (unsigned)level->height) {
        if ((unsigned)x < (unsigned)level->width)
            return (const char *)level->texels + ((size_t)y * (size_t)level->width + (size_t)x) * size;
        return (const char *)level->sides[x > 0] + (size_t)y * size;
    }
    if ((unsigned)x < (unsigned)level->width)
        return (const char *)level->ends[y > 0] + (size_t)x * size;
    return texture->corners[2 * (y > 0) + (x > 0)];
}

/* The sum of weights times texels that are `step` bytes apart. */
static RetexFloat4 sum_texels(const char *p, const float *weights, int count, size_t step, int narrow)
{
    RetexFloat4 sum = {0, 0, 0, 0}, odd = {0, 0, 0, 0};
    int i = 0;
    for (; i + 1 < count; i += 2, p += 2 * step) {
        sum += raw_texel(p, narrow) * weights[i];
        odd += raw_texel(p + step, narrow) * weights[i + 1];
    }
    if (i < count)
        sum += raw_texel(p, narrow) * weights[i];
    return sum + odd;
}

static void begin_strip(Strip *strip, int used)
{
    strip->low[0] = strip->low[1] = MAX_ACROSS;
    strip->high[0] = strip->high[1] = 0;
    memset(strip->change, 0, (size_t)used * sizeof *strip->change);
}

/* The sum of a line's texels with its weights; then the strip moves to the next line. base: the texel of the strip's
 * first weight. */
static RetexFloat4 sum_line(const Lines *lines, int line, int base, Strip *restrict strip)
{
    RetexFloat4 sum = {0, 0, 0, 0};
    int low = strip->low[0] < strip->low[1] ? strip->low[0] : strip->low[1];
    int high = strip->high[0] > strip->high[1] ? strip->high[0] : strip->high[1];
    int at = wrap_line(lines, 0, line), i;
    float weight = 0, weights[MAX_ACROSS];
    for (i = low; i < high; i++) {
        Float2 change = strip->change[i];
        weight += change[0];
        /* Differences leave rounding errors of either sign; without negative weights colours stay between those of the
         * texels. */
        weights[i] = weight > 0 ? weight : 0;
        strip->change[i] = (Float2){change[1], 0};
    }
    if (low < high && (unsigned)at < (unsigned)lines->count[0] && base + low >= 0 && base + high <= lines->count[1]) {
        const char *p = find_texel(lines, at, base + low);
        sum = lines->texture->narrow ? sum_texels(p, weights + low, high - low, lines->step, 1)
                                     : sum_texels(p, weights + low, high - low, lines->step, 0);
    } else {
        for (i = low; i < high; i++)
            sum += raw_texel(find_texel(lines, at, wrap_line(lines, 1, base + i)), lines->texture->narrow) * weights[i];
    }
    strip->low[1] = strip->low[0];
    strip->high[1] = strip->high[0];
    strip->low[0] = MAX_ACROSS;
    strip->high[0] = 0;
    return sum;
}

/* The change that a chord's end at x makes to the weights of its line: `first` at texel (int)x, `last` at the next but
 * one, 1 minus both between. */
typedef struct End {
    float first, last;
    int texel;
} End;

static End find_end(float x, int box)
{
    int i = (int)x;
    float f = x - (float)i, g = 1 - f;
    return box ? (End){g, 0, i} : (End){0.5f * g * g, 0.5f * f * f, i};
}

static void add_end(Strip *restrict strip, End end, Float2 weight)
{
    Float2 *restrict change = strip->change + end.texel;
    change[0] += weight * end.first;
    change[1] += weight * (1 - end.first - end.last);
    change[2] += weight * end.last;
}

static void add_chord(Strip *restrict strip, End left, End right, Float2 weight)
{
    add_end(strip, left, weight);
    add_end(strip, right, -weight);
    strip->low[0] = left.texel < strip->low[0] ? left.texel : strip->low[0];
    strip->high[0] = right.texel + 3 > strip->high[0] ? right.texel + 3 : strip->high[0];
}

/* All chords of an ellipse, for vectorisation. Input: place along, and weight of the quadrature. */
#define MAX_CHORDS (6 * MAX_LENGTH + 32)
typedef struct Chords {
    float at[MAX_CHORDS], weight[MAX_CHORDS];
    float line[MAX_CHORDS];                   /* the line before the chord */
    float here[MAX_CHORDS], next[MAX_CHORDS]; /* weights of a texel in that line and the next one */
    End left[MAX_CHORDS], right[MAX_CHORDS];
} Chords;

/* An outline relative to a line and a texel. */
typedef struct Shape {
    float y, x, length, slope, half, cut[2];
    int straight;
    float inner, side;
} Shape;

/* The chord at a distance d from the middle one, relative to it: its length, and where its middle is. */
static float chord_length(const Shape *shape, float d, float *middle)
{
    *middle = shape->slope * d;
    if (shape->straight) {
        float outside = fabsf(d) - shape->inner, tip = shape->length - shape->inner;
        float t = outside > 0 ? outside < tip ? outside / tip : 1 : 0;
        *middle += copysignf(t, d) * shape->side;
        return 1 - t;
    }
    float u = shape->length > 0 ? d / shape->length : 0, s2 = 1 - u * u;
    return sqrtf(s2 > 0 ? s2 : 0);
}

static float limit(float x, const float range[2])
{
    x = x > range[0] ? x : range[0];
    return x < range[1] ? x : range[1];
}

static void find_chords(Chords *restrict chords, int count, const Shape *restrict shape, int box)
{
    float low = shape->cut[0], high = shape->cut[1];
    for (int i = 0; i < count; i++) {
        float shift, s = chord_length(shape, chords->at[i] - shape->y, &shift);
        float middle = shape->x + shift, h = shape->half * s, t = box ? 0 : chords->at[i] - chords->line[i];
        h = h > LEAST_HALF ? h : LEAST_HALF;
        float left = middle - h, right = middle + h;
        left = left > low ? left : low;
        left = left < high ? left : high;
        right = right > low ? right : low;
        right = right < high ? right : high;
        float weight = chords->weight[i] * s, density = right > left ? weight * 0.5f / h : 0;
        chords->weight[i] = weight;
        chords->here[i] = density * (1 - t);
        chords->next[i] = density * t;
        chords->left[i] = find_end(left, box);
        chords->right[i] = find_end(right, box);
    }
}

/* The limits at which an axis is cut off, relative to base. */
static void find_cut(const Lines *lines, int axis, double base, float cut[2])
{
    int black = lines->wrap[axis] == RETEX_WRAP_BLACK;
    cut[0] = black ? (float)(-0.5 - base) : -1e9f;
    cut[1] = black ? (float)(lines->count[axis] - 0.5 - base) : 1e9f;
}

/* The next place after `at` where the chords' length has another law. */
static float next_corner(const Shape *shape, float at, float end)
{
    const float corners[2] = {shape->y - shape->inner, shape->y + shape->inner};
    for (int k = 0; k < 2 && shape->straight; k++)
        if (corners[k] > at && corners[k] < end)
            return corners[k];
    return end;
}

/* The integral of the chords' lengths. */
static double whole_length(const Outline *e)
{
    return e->straight ? e->length + e->inner : M_PI_2 * e->length;
}

static Shape shape_of(const Outline *e)
{
    return (Shape){.length = (float)e->length,
                   .slope = (float)e->slope,
                   .half = (float)e->half,
                   .straight = e->straight,
                   .inner = (float)e->inner,
                   .side = (float)e->side};
}

/* The sum over all lines that the outline meets. */
static RetexFloat4 sum_dense(const Lines *lines, const Outline *e)
{
    Strip strip;
    Chords chords;
    double centre = lines->box ? 0.5 : 0; /* centre of a line or texel */
    double at[2] = {e->at[0] + centre, e->at[1] + centre};
    int line = whole_below(at[0]), texel = whole_below(at[1]);
    Shape shape = shape_of(e);
    int shift = (int)(shape.half + fabsf(shape.slope) * shape.length) + 2, base = texel - shift, used = 2 * shift + 6;
    used = used < MAX_ACROSS ? used : MAX_ACROSS;
    begin_strip(&strip, used);
    shape.y = (float)(at[0] - line);
    shape.x = (float)(at[1] - texel) + (float)shift;
    float rows[2];
    find_cut(lines, 0, line - centre, rows);
    find_cut(lines, 1, base - centre, shape.cut);
    shape.cut[0] = limit(shape.cut[0], (float[2]){0, (float)(used - 3)});
    shape.cut[1] = limit(shape.cut[1], (float[2]){0, (float)(used - 3)});
    float from = shape.y - shape.length, to = shape.y + shape.length;
    float begin = from > rows[0] ? from : rows[0], end = to < rows[1] ? to : rows[1], total = 0;
    RetexFloat4 sum = {0, 0, 0, 0};
    if (begin > end)
        return sum;
    int fine = shape.length < 2 || (shape.half < 3 && fabsf(shape.slope) > 0.6f), first = whole_below(begin), count = 0;
    for (int j = first; j == first || (float)j < end; j++) {
        float a = begin > (float)j ? begin : (float)j, b = end < (float)(j + 1) ? end : (float)(j + 1);
        for (float piece; a <= b; a = piece == b ? INFINITY : piece) {
            piece = next_corner(&shape, a, b);
            const Rule *rule = &rules[fine][shape.straight ? 0 : (a == from) + 2 * (piece == to)];
            for (int k = 0; k < rule->count; k++, count++) {
                chords.at[count] = a + (piece - a) * rule->nodes[k].at;
                chords.weight[count] = rule->nodes[k].weight * (piece > a ? piece - a : 1);
                chords.line[count] = (float)j;
            }
        }
    }
    if (lines->box)
        find_chords(&chords, count, &shape, 1);
    else
        find_chords(&chords, count, &shape, 0);
    int row = first;
    for (int i = 0; i < count; i++) {
        if ((int)chords.line[i] > row)
            sum += sum_line(lines, line + row++, base, &strip);
        total += chords.weight[i];
        add_chord(&strip, chords.left[i], chords.right[i], (Float2){chords.here[i], chords.next[i]});
    }
    sum += sum_line(lines, line + row, base, &strip);
    sum += sum_line(lines, line + row + 1, base, &strip);
    if (begin > from || end < to)
        total = shape.length > 0 ? (float)whole_length(e) : total;
    return sum / total;
}

/* The sum over some lines of a long outline, each of which stands for several. A step without a common factor with the
 * number of lines visits all lines of a repeating axis. */
static RetexFloat4 sum_sparse(const Lines *lines, const Outline *e)
{
    RetexFloat4 sum = {0, 0, 0, 0};
    const Shape shape = shape_of(e);
    Strip strip;
    begin_strip(&strip, MAX_ACROSS);
    int step = coprime_step(whole_above(e->length / MAX_LENGTH), lines->count[0], lines->wrap[0]);
    int first = whole_above(e->at[0] - e->length), last = whole_below(e->at[0] + e->length);
    float total = 0, rows[2], columns[2];
    find_cut(lines, 0, 0, rows);
    for (int line = first; line <= last; line += step) {
        float shift, s = chord_length(&shape, (float)(line - e->at[0]), &shift), h = shape.half * s;
        h = h > LEAST_HALF ? h : LEAST_HALF;
        total += s;
        if ((float)line < rows[0] || (float)line > rows[1])
            continue;
        double middle = e->at[1] + (double)shift;
        int texel = whole_below(middle), reach = (int)h + 2;
        float x = (float)(middle - texel) + (float)reach, left = x - h, right = x + h;
        find_cut(lines, 1, texel - reach, columns);
        left = left > columns[0] ? left : columns[0];
        right = right < columns[1] ? right : columns[1];
        if (left >= right)
            continue;
        add_chord(&strip, find_end(left, 0), find_end(right, 0), (Float2){s * 0.5f / h, 0});
        sum += sum_line(lines, line, texel - reach, &strip);
    }
    return sum / total;
}

/* On the coarsest level, for an axis that does not repeat: an outline much larger than the image covers mostly the
 * border, and is shrunk together with its distance. Returns the factor by which the image's share grows. */
static double shrink_outline(const Lines *lines, Outline *e)
{
    double filled = 1;
    if (e->length > MAX_LENGTH) {
        double k = MAX_LENGTH / e->length;
        e->at[0] *= k;
        e->length *= k;
        e->inner *= k;
        e->slope /= k;
        filled *= lines->wrap[0] == RETEX_WRAP_BLACK ? k : 1;
    }
    double reach = e->half + fabs(e->slope) * e->length;
    if (reach > MAX_LENGTH) {
        double k = MAX_LENGTH / reach;
        e->at[1] *= k;
        e->half *= k;
        e->side *= k;
        e->slope *= k;
        filled *= lines->wrap[1] == RETEX_WRAP_BLACK ? k : 1;
    }
    return filled;
}

/* The level for a footprint, and the covariance that remains there. */
typedef struct LevelPlace {
    int number, box, flat[2];
    const RetexTextureLevel *level;
    double at[2]; /* in the level's texels, x and y */
    LevelCovariance rest;
} LevelPlace;

static LevelPlace place_footprint(const RetexTexture *texture, const TexelFootprint *f)
{
    LevelPlace place;
    const RetexTextureLevel *image = &texture->levels[0];
    double x = first_period(f->x, image->width, texture->spec.wrap[0]);
    double y = first_period(f->y, image->height, texture->spec.wrap[1]);
    double position[2] = {mean_position(x, f->xx, image->width, texture->spec.wrap[0]),
                          mean_position(y, f->yy, image->height, texture->spec.wrap[1])};
    place.number = find_level(texture, f, position, &place.box);
    place.level = &texture->levels[place.number];
    place.rest = ellipse_rest(place.level, f, position, place.box);
    find_flat(texture, place.level, place.flat);
    place.at[0] = place.flat[0] ? 0 : x / place.level->scale[0] - 0.5;
    place.at[1] = place.flat[1] ? 0 : y / place.level->scale[1] - 0.5;
    return place;
}

/* The mean over an outline on its level, premultiplied. */
static void average_outline(const RetexTexture *texture, const LevelPlace *place, Outline *e, int turned,
                                   float rgba[4])
{
    const RetexTextureLevel *level = place->level;
    e->at[0] = place->at[!turned];
    e->at[1] = place->at[turned];
    Lines lines = {texture,
                   level,
                   turned,
                   place->box,
                   {turned ? level->width : level->height, turned ? level->height : level->width},
                   texel_size(texture->narrow) * (turned ? (size_t)level->width : 1),
                   {texture->spec.wrap[!turned], texture->spec.wrap[turned]}};
    double filled = place->number == texture->nlevels - 1 ? shrink_outline(&lines, e) : 1;
    RetexFloat4 sum = e->length > MAX_LENGTH ? sum_sparse(&lines, e) : sum_dense(&lines, e);
    sum *= (float)filled * texel_unit(texture->narrow);
    memcpy(rgba, &sum, sizeof sum);
}

void filter_texels_disc(const RetexTexture *texture, const TexelFootprint *footprint, float rgba[4])
{
    const LevelPlace place = place_footprint(texture, footprint);
    int turned;
    Outline e = find_ellipse(&place.rest, place.flat, &turned);
    average_outline(texture, &place, &e, turned, rgba);
}

/* ---- parallelograms ----
 *
 * The level is that of the ellipse with the same covariance, but the parallelogram does not shrink by the variance of
 * the level's texels: those of neighbouring pixels, and of the quarters of a pixel, adjoin. What blur takes from one it
 * gives to the next, while shrunk ones would leave gaps. */

#define LEAST_LENGTH 1e-3 /* texels, of the longer axis along */

/* The outline of axes over lines: [0] along, [1] across. */
static Outline find_outline(const double along[2], const double across[2])
{
    const int longer = fabs(along[1]) > fabs(along[0]);
    const double sign[2] = {along[0] < 0 ? -1 : 1, along[1] < 0 ? -1 : 1};
    double a = fabs(along[longer]), b = fabs(along[!longer]);
    a = a > LEAST_LENGTH ? a : LEAST_LENGTH;
    Outline e = {
        .straight = 1, .length = (a + b) / 2, .inner = (a - b) / 2, .slope = sign[longer] * across[longer] / a};
    e.side = (sign[!longer] * across[!longer] - e.slope * b) / 2;
    e.half = fabs(e.side);
    return e;
}

void filter_texels_parallelogram(const RetexTexture *texture, const TexelFootprint *footprint,
                                        const double sides[2][2], float rgba[4])
{
    const LevelPlace place = place_footprint(texture, footprint);
    double along[2], across[2];
    int turned;
    (void)find_ellipse(&place.rest, place.flat, &turned);
    for (int k = 0; k < 2; k++) {
        along[k] = sides[k][!turned] / place.level->scale[!turned];
        across[k] = sides[k][turned] / place.level->scale[turned];
    }
    Outline e = find_outline(along, across);
    if (place.flat[0] || place.flat[1]) /* all texels across are one */
        e.slope = e.side = e.half = 0;
    average_outline(texture, &place, &e, turned, rgba);
}
