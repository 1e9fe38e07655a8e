/* See lay.h. A layout is a list of blocks: where each repeat lies. Blocks are painted one by one; each texel of the
 * image belongs to one block. */
#include "texture/lay.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "texture/interpolate.h"

#define MOST_TEXELS (1L << 26)        /* of several copies of a bond, and of blocks that turn */
#define MOST_TEXELS_AT_ALL (1L << 28) /* of what cannot be smaller */
#define MOST_SIDE 65536               /* of the image */
#define MOST_BLOCKS 256               /* that differ from each other */
#define MOST_COPIES 16                /* along each axis */
#define LEAST_JOINT 4                 /* texels of a joint between colours, which have no texels of their own */
#define LEAST_COLOR_SIDE 1024         /* texels of the longer side of a colour's repeat, for joints with sharp edges */
#define MOST_COLOR_SIDE 2048          /* of the same, for joints that are narrow */
#define MOST_COLOR_TEXELS (1L << 23)  /* of colours that turn */
#define MOST_RATIO 256                /* of the sides of blocks that turn */
#define MOST_DENOMINATOR 4            /* of that ratio in a herringbone */
#define RATIO_ERROR 0.005             /* is not seen: then the smaller denominator is taken */
#define SQUARE_ERROR 1e-3             /* of a block's sides: then it may be turned by 90 degrees */
#define HEXAGON 0.86602540378443865   /* its width by its height, and how far its rows are apart by its width */

int retex_lay_is_needed(const RetexTextureSpec *spec)
{
    return spec->repeat == RETEX_REPEAT_BRICK || spec->repeat == RETEX_REPEAT_HALF_DROP ||
           spec->repeat >= RETEX_REPEAT_HERRINGBONE || spec->grout > 0 || spec->vary || spec->tiles[0][0];
}

int retex_lay_tiles(const RetexTextureSpec *spec)
{
    int count = 0;
    while (count < RETEX_TILES_MAX && spec->tiles[count][0])
        count++;
    return count;
}

static int turns_blocks(const RetexTextureSpec *spec)
{
    return spec->repeat >= RETEX_REPEAT_HERRINGBONE;
}

int retex_lay_check(const RetexTextureSpec *spec, RetexError *err)
{
    if (!isfinite(spec->grout) || spec->grout < 0)
        return retex_fail(err, RETEX_EINVAL, "texture: grout must be finite and 0 or more");
    for (int c = 0; c < 3; c++)
        if (!isfinite(spec->grout_color[c]) || spec->grout_color[c] < 0)
            return retex_fail(err, RETEX_EINVAL, "texture: the colour of grout must be finite and 0 or more");
    if (!retex_lay_is_needed(spec))
        return RETEX_OK;
    if (spec->repeat == RETEX_REPEAT_MIRROR || spec->wrap[0] != RETEX_WRAP_REPEAT || spec->wrap[1] != RETEX_WRAP_REPEAT)
        return retex_fail(err, RETEX_EINVAL, "texture: laid repeats need wrap = repeat on both axes, and no mirroring");
    if ((spec->grout > 0 || turns_blocks(spec)) && !(spec->width[0] > 0))
        return retex_fail(err, RETEX_EINVAL, "texture: %s needs a width",
                          spec->grout > 0 ? "grout" : "this way to lay repeats");
    return RETEX_OK;
}

/* ---- layouts ---- */

/* Memory for so many blocks. */
static int reserve(RetexLayout *layout, int count, RetexError *err)
{
    free(layout->blocks);
    layout->nblocks = 0;
    layout->blocks = calloc((size_t)count, sizeof *layout->blocks);
    return layout->blocks ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory to lay a texture");
}

static void add_block(RetexLayout *layout, int x, int y, int stands)
{
    RetexLaidBlock *block = &layout->blocks[layout->nblocks];
    *block = (RetexLaidBlock){x, y, stands, layout->nblocks++, 0};
}

/* The physical size of a repeat without its joint. */
static void sizes(const RetexTextureSpec *spec, int width, int height, double size[2])
{
    size[0] = spec->width[0];
    size[1] = spec->width[1] > 0 ? spec->width[1] : size[0] * height / width;
}

/* Texels of a repeat of a colour: as many as make its joints sharp, of which a joint has a whole number. */
static void size_color(const RetexTextureSpec *spec, int texels[2])
{
    double size[2];
    sizes(spec, 1, 1, size);
    const double longer = fmax(size[0], size[1]);
    const double joint = ceil(fmax(LEAST_JOINT, spec->grout * LEAST_COLOR_SIDE / longer));
    const double texel = fmax(spec->grout / joint, longer / MOST_COLOR_SIDE);
    for (int axis = 0; axis < 2; axis++)
        texels[axis] = (int)fmax(1, rint(size[axis] / texel));
}

static int joint_texels(double grout, double texel)
{
    return grout > 0 ? (int)fmax(1, ceil(grout / texel - 1e-6)) : 0;
}

/* Bonds whose blocks all lie alike. */
static int plan_rows(RetexLayout *l, const RetexTextureSpec *spec, const double size[2], RetexError *err)
{
    const int rows = spec->repeat == RETEX_REPEAT_BRICK ? 2 : 1,
              columns = spec->repeat == RETEX_REPEAT_HALF_DROP ? 2 : 1;
    int pitch[2];
    for (int axis = 0; axis < 2; axis++) {
        const int count = axis ? rows : columns;
        l->joint[axis] = joint_texels(spec->grout, size[axis] / l->block[axis]);
        pitch[axis] = l->block[axis] + l->joint[axis];
        l->period[axis] = count * (1 + spec->grout / size[axis]);
        l->grout[axis] = pitch[axis] * spec->grout / (size[axis] + spec->grout);
    }
    l->width = columns * pitch[0];
    l->height = rows * pitch[1];
    if (reserve(l, rows * columns, err))
        return RETEX_ENOMEM;
    for (int k = 0; k < rows * columns; k++)
        add_block(l, columns == 2 ? k * pitch[0] : k * (pitch[0] / 2),
                  columns == 2 ? -k * (pitch[1] / 2) : k * pitch[1], 0);
    return RETEX_OK;
}

/* The nearest ratio of small whole numbers to long / short; both pitches become multiples of its unit. */
static void fit_ratio(int *longer, int *shorter, int most_denominator)
{
    const double ratio = (double)*longer / *shorter;
    int q = 1;
    while (q < most_denominator && fabs(rint(ratio * q) / q - ratio) > RATIO_ERROR * ratio)
        q++;
    const int p = (int)fmax(q, rint(ratio * q)), unit = (int)fmax(1, rint((double)*shorter / q));
    *longer = p * unit;
    *shorter = q * unit;
}

static int divisor(int a, int b)
{
    return b ? divisor(b, a % b) : a;
}

/* Blocks that lie begin at (a + b) steps along the diagonal and b along the other side; at the right of each stands
 * one. */
static int plan_herringbone(RetexLayout *l, int m, int n, RetexError *err)
{
    const int side = 2 * m / divisor(m, n) * n, diagonal = side / n, others = side / (2 * m);
    l->width = l->height = side;
    if (reserve(l, 2 * others * diagonal, err))
        return RETEX_ENOMEM;
    for (int b = 0; b < others; b++)
        for (int a = 0; a < diagonal; a++) {
            const int x = a * n + b * (m + n), y = a * n + b * (n - m);
            add_block(l, x % side, y % side, 0);
            add_block(l, (x + m) % side, (y + n - m) % side, 1);
        }
    return RETEX_OK;
}

/* Squares of blocks that lie and that stand, by turns. */
static int plan_basket(RetexLayout *l, int m, int n, RetexError *err)
{
    l->width = l->height = 2 * m;
    if (reserve(l, 4 * (m / n), err))
        return RETEX_ENOMEM;
    for (int square = 0; square < 4; square++)
        for (int k = 0; k < m / n; k++) {
            const int x = square % 2 * m, y = square / 2 * m, stands = square == 1 || square == 2;
            add_block(l, stands ? x + k * n : x, stands ? y : y + k * n, stands);
        }
    return RETEX_OK;
}

/* Bonds in which blocks lie and stand: texels are as high as they are wide. */
static int plan_turned(RetexLayout *l, const RetexTextureSpec *spec, const double size[2], RetexError *err)
{
    const int is_tall = size[1] > size[0];
    const double longer = fmax(size[0], size[1]), shorter = fmin(size[0], size[1]);
    int joint = joint_texels(spec->grout, shorter / l->block[!is_tall]);
    int n = l->block[!is_tall] + joint;
    double texel = (shorter + spec->grout) / n;
    int m = (int)rint((longer + spec->grout) / texel);
    fit_ratio(&m, &n, spec->repeat == RETEX_REPEAT_HERRINGBONE ? MOST_DENOMINATOR : 1);
    texel = (shorter + spec->grout) / n;
    joint = joint_texels(spec->grout, texel);
    l->joint[0] = l->joint[1] = joint;
    l->grout[0] = l->grout[1] = spec->grout / texel;
    l->block[is_tall] = m - joint;
    l->block[!is_tall] = n - joint;
    const int code =
        spec->repeat == RETEX_REPEAT_HERRINGBONE ? plan_herringbone(l, m, n, err) : plan_basket(l, m, n, err);
    for (int k = 0; k < l->nblocks; k++)
        l->blocks[k].stands ^= is_tall;
    l->period[0] = l->width * texel / size[0];
    l->period[1] = l->height * texel / size[1];
    return code;
}

/* Rows of hexagons with a corner above; of an image its middle is seen. */
static int plan_hexagons(RetexLayout *l, const RetexTextureSpec *spec, const double size[2], RetexError *err)
{
    const int texels = (int)fmax(1, fmin(l->block[0], l->block[1] * HEXAGON));
    const int joint = joint_texels(spec->grout, size[0] / texels), pitch = texels + joint + (texels + joint) % 2;
    const double texel = (size[0] + spec->grout) / pitch;
    l->is_hexagonal = 1;
    l->joint[0] = l->joint[1] = joint;
    l->grout[0] = l->grout[1] = spec->grout / texel;
    l->block[0] = pitch - joint;
    l->width = l->width_of_one = pitch;
    l->height = 2 * (int)rint(pitch * HEXAGON);
    l->row = l->height / 2;
    l->period[0] = 1 + spec->grout / size[0];
    l->period[1] = (size[0] + spec->grout) * 2 * HEXAGON / size[1];
    if (reserve(l, 2, err))
        return RETEX_ENOMEM;
    for (int k = 0; k < 2; k++)
        add_block(l, k * pitch / 2, k * l->row, 0);
    return RETEX_OK;
}

/* Several copies of a bond side by side, so that more blocks differ. */
static int copy_blocks(RetexLayout *l, RetexError *err)
{
    const int base = l->nblocks;
    int across = 1, up = 1;
    for (int grown = 1; grown;) { /* the shorter side first */
        const int wider = (double)across * l->width <= (double)up * l->height;
        grown = 0;
        for (int k = 0; k < 2 && !grown; k++) {
            const int is_wider = k ? !wider : wider, a = across + is_wider, u = up + !is_wider;
            grown = a <= MOST_COPIES && u <= MOST_COPIES && a * u * base <= MOST_BLOCKS &&
                    (double)a * l->width * u * l->height <= MOST_TEXELS;
            across = grown ? a : across;
            up = grown ? u : up;
        }
    }
    RetexLaidBlock *blocks = calloc((size_t)(across * up * base), sizeof *blocks);
    if (!blocks)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to lay a texture");
    for (int i = 0; i < across * up * base; i++) {
        const int copy = i / base, column = copy % across, row = copy / across;
        blocks[i] = l->blocks[i % base];
        blocks[i].x += column * l->width;
        blocks[i].y += row * l->height;
        blocks[i].column += column * base;
        blocks[i].row = row;
    }
    free(l->blocks);
    l->blocks = blocks;
    l->nblocks = across * up * base;
    l->width *= across, l->height *= up;
    l->period[0] *= across, l->period[1] *= up;
    return RETEX_OK;
}

static int plan(RetexLayout *l, const RetexTextureSpec *spec, const double size[2], RetexError *err)
{
    return spec->repeat == RETEX_REPEAT_HEXAGON ? plan_hexagons(l, spec, size, err)
           : turns_blocks(spec)                 ? plan_turned(l, spec, size, err)
                                                : plan_rows(l, spec, size, err);
}

static int too_large(const RetexLayout *l)
{
    return l->width > MOST_SIDE || l->height > MOST_SIDE || (long)l->width * l->height > MOST_TEXELS_AT_ALL;
}

int retex_layout_make(RetexLayout *l, const RetexTextureSpec *spec, int width, int height, RetexError *err)
{
    double size[2] = {1, 1};
    *l = (RetexLayout){.block = {width, height}};
    if (spec->width[0] > 0)
        sizes(spec, width, height, size);
    const double shorter = fmin(size[0], size[1]);
    if (turns_blocks(spec) && fmax(size[0], size[1]) > MOST_RATIO * shorter)
        return retex_fail(err, RETEX_EINVAL, "texture: this repeat is more than %d times as long as wide", MOST_RATIO);
    if (spec->grout > shorter)
        return retex_fail(err, RETEX_EINVAL, "texture: grout is wider than a repeat");
    const int is_color = width == 1 && height == 1;
    if (is_color && spec->grout > 0)
        size_color(spec, l->block);
    const int block[2] = {l->block[0], l->block[1]};
    int code = plan(l, spec, size, err);
    const double share =
        sqrt((double)(is_color ? MOST_COLOR_TEXELS : MOST_TEXELS) / ((double)l->width * l->height));
    if (!code && turns_blocks(spec) && share < 1) { /* coarser, for many blocks are one image */
        l->block[0] = (int)fmax(1, block[0] * share), l->block[1] = (int)fmax(1, block[1] * share);
        code = plan(l, spec, size, err);
    }
    if (!code && ((spec->vary && !is_color) || spec->tiles[0][0])) /* repeats of one colour do not differ */
        code = copy_blocks(l, err);
    if (!code && (l->block[0] < 1 || l->block[1] < 1 || too_large(l)))
        code = retex_fail(err, RETEX_ELIMIT, "%s: laid so it would have %d x %d texels, which is too much", spec->image,
                          l->width, l->height);
    return code;
}

void retex_layout_free(RetexLayout *layout)
{
    free(layout->blocks);
    *layout = (RetexLayout){0};
}

/* ---- painting ---- */

typedef struct PaintWork {
    const RetexLayout *layout;
    const RetexTextureSpec *spec;
    const RetexTexels *tiles, *image;
    int ntiles;
} PaintWork;

/* What differs from block to block. */
typedef struct BlockLook {
    const RetexTexels *tile;
    int quarters, flip[2];
    double shift[2]; /* in widths and heights of the tile */
} BlockLook;

/* Steele, Lea and Flood's SplitMix64. */
static uint64_t next_random(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static BlockLook look_of(const PaintWork *work, const RetexLaidBlock *block)
{
    const RetexTextureSpec *spec = work->spec;
    const int *size = work->layout->block;
    uint64_t state = spec->vary_seed;
    state = next_random(&state) ^ (uint64_t)block->column << 32 ^ (uint64_t)block->row;
    const uint64_t random = next_random(&state), x = next_random(&state), y = next_random(&state);
    const int is_square = !(spec->width[0] > 0)
                              ? 0
                              : fabs(spec->width[1] > 0 ? spec->width[1] / spec->width[0] - 1
                                                        : (double)size[1] / size[0] - 1) < SQUARE_ERROR;
    BlockLook look = {.tile = &work->tiles[random % (uint64_t)work->ntiles]};
    if (spec->vary & RETEX_VARY_TURN)
        look.quarters = (int)(random >> 32 & (is_square ? 3 : 2));
    for (int axis = 0; axis < 2; axis++) {
        look.flip[axis] = spec->vary & RETEX_VARY_FLIP && random >> (40 + axis) & 1;
        look.shift[axis] = spec->vary & RETEX_VARY_SHIFT ? ldexp((double)((axis ? y : x) >> 11), -53) : 0;
    }
    return look;
}

/* The colour of a tile at a place in the block that lies, from 0, 0 at its lower left corner to 1, 1. */
static void read_tile(const BlockLook *look, double u, double v, float rgba[4])
{
    const RetexTexels *tile = look->tile;
    double at[2] = {u, v};
    for (int quarter = 0; quarter < look->quarters; quarter++) {
        const double right = at[0];
        at[0] = 1 - at[1], at[1] = right;
    }
    for (int axis = 0; axis < 2; axis++) {
        at[axis] = look->flip[axis] ? 1 - at[axis] : at[axis];
        at[axis] += look->shift[axis];
        at[axis] = look->shift[axis] > 0 ? at[axis] - floor(at[axis]) : fmin(fmax(at[axis], 0), 1);
    }
    const RetexWrap wrap[2] = {look->shift[0] > 0 ? RETEX_WRAP_REPEAT : RETEX_WRAP_CLAMP,
                               look->shift[1] > 0 ? RETEX_WRAP_REPEAT : RETEX_WRAP_CLAMP};
    retex_interpolate(tile, retex_between(at[0] * tile->width, tile->width, wrap[0]),
                      retex_between((1 - at[1]) * tile->height, tile->height, wrap[1]), rgba);
}

/* The part that grout has of a texel whose middle is at `at`; the joint's middle is at `middle`. */
static double joint_share(double at, double middle, double grout)
{
    return fmax(0, fmin(at + 0.5, middle + grout / 2) - fmax(at - 0.5, middle - grout / 2));
}

static void paint_texel(const PaintWork *work, const RetexLaidBlock *block, int x, int y, double share,
                        const float tile[4])
{
    const RetexTexels *image = work->image;
    const int column = ((block->x + x) % image->width + image->width) % image->width,
              row = ((block->y + y) % image->height + image->height) % image->height;
    float rgba[4];
    for (int c = 0; c < 4; c++)
        rgba[c] = (float)((1 - share) * (double)tile[c] + share * (c < 3 ? (double)work->spec->grout_color[c] : 1));
    retex_texture_store_texel(image, (size_t)(image->height - 1 - row) * (size_t)image->width + (size_t)column, rgba);
}

/* Where a place in a block or its joint is in the block, in 0..1: in the joint the last texel goes on. */
static double place_in_block(int at, int block)
{
    return (at < block ? at + 0.5 : block - 0.5) / block;
}

static void paint_rectangle(const PaintWork *work, const RetexLaidBlock *block, const BlockLook *look)
{
    const RetexLayout *l = work->layout;
    const int stands = block->stands, size[2] = {l->block[stands], l->block[!stands]};
    float rgba[4];
    for (int y = 0; y < size[1] + l->joint[1]; y++)
        for (int x = 0; x < size[0] + l->joint[0]; x++) {
            /* grout lies at the joint's outer end, where another joint may begin */
            const double across = joint_share(x + 0.5, size[0] + l->joint[0] - l->grout[0] / 2, l->grout[0]),
                         up = joint_share(y + 0.5, size[1] + l->joint[1] - l->grout[1] / 2, l->grout[1]);
            const double u = place_in_block(x, size[0]), v = place_in_block(y, size[1]);
            read_tile(look, stands ? v : u, stands ? 1 - u : v, rgba); /* turned counter-clockwise */
            paint_texel(work, block, x, y, 1 - (1 - across) * (1 - up), rgba);
        }
}

/* Whether the texel is the hexagon's, whose middle is its lower left corner; twice its place is odd. Exact, so that
 * hexagons side by side have no texel twice. */
static int is_in_hexagon(const RetexLayout *l, int twice_x, int twice_y)
{
    const long across = 2L * l->row * twice_x, up = 3L * l->width_of_one * twice_y,
               limit = 4L * l->width_of_one * l->row;
    return across + up > -limit && across + up <= limit && up - across > -limit && up - across <= limit;
}

static void paint_hexagon(const PaintWork *work, const RetexLaidBlock *block, const BlockLook *look)
{
    const RetexLayout *l = work->layout;
    const RetexTexels *tile = look->tile;
    const int pitch = l->width_of_one, reach = 2 * l->row / 3 + 1;
    const double seen = fmin(tile->width, tile->height * HEXAGON), stretch = pitch * HEXAGON / l->row;
    float rgba[4];
    for (int y = -reach; y < reach; y++)
        for (int x = -pitch / 2; x < pitch / 2; x++) {
            const double right = x + 0.5, up = (y + 0.5) * stretch;
            const double from_middle = fmax(fabs(right), 0.5 * fabs(right) + HEXAGON * fabs(up));
            if (!is_in_hexagon(l, 2 * x + 1, 2 * y + 1))
                continue;
            read_tile(look, 0.5 + right / l->block[0] * seen / tile->width,
                      0.5 + up / l->block[0] * seen / tile->height, rgba);
            paint_texel(work, block, x, y, joint_share(from_middle, pitch / 2.0, l->grout[0]), rgba);
        }
}

static void paint_job(void *context, int index, int thread)
{
    const PaintWork *work = context;
    const RetexLaidBlock *block = &work->layout->blocks[index];
    const BlockLook look = look_of(work, block);
    (void)thread;
    if (work->layout->is_hexagonal)
        paint_hexagon(work, block, &look);
    else
        paint_rectangle(work, block, &look);
}

void retex_layout_paint(const RetexLayout *layout, const RetexTextureSpec *spec, const RetexTexels *tiles, int ntiles,
                        const RetexTexels *image, int nthreads)
{
    PaintWork work = {layout, spec, tiles, image, ntiles};
    retex_parallel(nthreads, layout->nblocks, paint_job, &work);
}
