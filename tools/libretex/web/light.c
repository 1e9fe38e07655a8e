/* See light.h. */
#include "web/light.h"

#include <math.h>
#include <stdlib.h>

#include <retex/color.h>
#include <retex/parallel.h>

#include "pack/balance.h"
#include "pack/encode.h"
#include "picture/jpeg_read.h"
#include "set/set.h"

#define LEVEL_MOST 255.0
/* White is at least at this level, however bright the brightest pixel; 24 times white is clipped. */
static const double WHITE_LEVEL_LEAST = 160;
static const double GAMMA = 2.4;       /* of sRGB */
static const double LEVELS_LEAST = 16; /* of a tile in an atlas */
/* Times a mean is changed at most: beyond that few texels would have the light of all, and steps become finer. With
 * 1.1, as packs have, rooms with lamps took up to two thirds more bytes, and blocks were no better. */
static const double CHANGE_MOST = 8;
enum { TILE = 8 }; /* sides of JPEG's blocks */

static int no_memory(RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "no memory to encode light");
}

/* The curve that has room for the brightest pixel, and the step of its levels that the plan asks for; black: any. */
static RetexPackCurve choose_curve(const RetexImage *im, const RetexPackPart *packed, double *step)
{
    const double planned = packed->codec == RETEX_PACK_JPEG ? packed->curve.white[0] : 1;
    double most = 0;
    for (size_t i = 0; i < (size_t)im->width * (size_t)im->height * (size_t)im->channels; i++)
        most = fmax(most, (double)im->pixels[i]);
    const double white = fmin(planned, fmax(most, planned / LEVEL_MOST));
    RetexPackCurve curve = retex_pack_curve(white, LEVEL_MOST);
    if (most > white) {
        const RetexPackCurve unit = retex_pack_curve(white, 1);
        curve.levels = fmax(LEVEL_MOST / retex_pack_curve_level(&unit, 0, most), WHITE_LEVEL_LEAST);
    }
    *step = packed->codec == RETEX_PACK_ZERO ? INFINITY : 1;
    if (packed->codec == RETEX_PACK_JPEG)
        *step = packed->jpeg_step / packed->curve.levels * curve.levels * pow(planned / white, 1 / GAMMA);
    *step = fmax(*step, 1);
    return curve;
}

static float level_of(const RetexPackCurve *curve, float value)
{
    return (float)fmin(retex_pack_curve_level(curve, 0, fmax((double)value, 0)), LEVEL_MOST);
}

/* ---- what browsers decode ---- */

/* All codes of a file, 0 to 1, with a fourth channel that is 1. */
static int decode(RetexImage *codes, const RetexPackJpeg *jpeg, RetexError *err)
{
    RetexLevels levels = {.image = codes, .is_linear = 1};
    const int read = retex_jpeg_read(&levels, jpeg->data, jpeg->bytes);
    retex_levels_end(&levels, read == RETEX_LEVELS_READ);
    return read == RETEX_LEVELS_READ        ? RETEX_OK
           : read == RETEX_LEVELS_NO_MEMORY ? no_memory(err)
                                            : retex_fail(err, RETEX_EINTERNAL, "light that was encoded is damaged");
}

/* The values of an image of RGB whose first pixel is at x, y. */
static void take_values(RetexImage *values, const RetexImage *codes, int x, int y, const RetexPackCurve *curve)
{
    float of[3][(int)LEVEL_MOST + 1];
    for (int i = 0; i < 3 * ((int)LEVEL_MOST + 1); i++)
        of[i % 3][i / 3] = (float)retex_pack_curve_value(curve, i % 3, i / 3);
    for (int row = 0; row < values->height; row++) {
        const float *from = codes->pixels + retex_image_index(codes, x, y + row);
        float *to = values->pixels + retex_image_index(values, 0, row);
        for (int i = 0; i < 3 * values->width; i++)
            to[i] = of[i % 3][(int)lrint(LEVEL_MOST * (double)from[i / 3 * 4 + i % 3])];
    }
}

static int restore_mean(RetexPackCurve *curve, RetexImage *decoded, const RetexPackJpeg *jpeg, const RetexImage *im,
                        int filled, double *change, RetexError *err)
{
    RetexImage codes = {0};
    int code = decode(&codes, jpeg, err);
    retex_image_free(decoded);
    if (!code)
        code = retex_image_alloc(decoded, im->width, im->height, 3, err);
    if (!code) {
        take_values(decoded, &codes, 0, 0, curve);
        if (filled)
            retex_pack_keep_black(decoded, im);
        code = retex_pack_restore_mean(curve, decoded, im, NULL, NULL, change, err);
    }
    retex_image_free(&codes);
    return code;
}

/* ---- a part alone ---- */

int retex_web_light_encode(RetexPackJpeg *jpeg, RetexPackCurve *curve, RetexImage *decoded, const RetexPart *part,
                           const RetexPackPart *packed, int filled, RetexError *err)
{
    const RetexImage *im = &part->image;
    const size_t count = (size_t)im->width * (size_t)im->height * (size_t)im->channels;
    double step, change = 1;
    int code = RETEX_OK;
    float *levels = malloc(count * sizeof *levels);
    if (!levels)
        return no_memory(err);
    const RetexPackCurve planned = choose_curve(im, packed, &step);
    for (size_t i = 0; i < count; i++)
        levels[i] = level_of(&planned, im->pixels[i]);
    if (filled)
        retex_pack_fill_black(levels, im);
    for (int finer = 1; finer && !code; step /= 2) {
        *curve = planned;
        retex_pack_jpeg_free(jpeg);
        code = retex_pack_jpeg_encode(jpeg, levels, im->width, im->height, im->channels, step, err);
        if (!code && decoded && im->channels == 3)
            code = restore_mean(curve, decoded, jpeg, im, filled, &change, err);
        finer = change > CHANGE_MOST && step >= 2;
    }
    free(levels);
    return code;
}

/* ---- atlases ---- */

static int padded(int size)
{
    return (size + TILE - 1) / TILE * TILE;
}

/* Place tiles on shelves. Returns 0 if they do not fit. */
static int place(RetexWebTile *tiles, int count, int *width, int *height, const RetexSet *set)
{
    int x = 0, y = 0, shelf = 0;
    *width = 0;
    for (int i = 0; i < count; i++) {
        const RetexImage *im = &set->parts[tiles[i].part].image;
        if (x > 0 && x + padded(im->width) > RETEX_WEB_ATLAS_SIDE_MAX)
            x = 0, y += shelf, shelf = 0;
        tiles[i].x = x;
        tiles[i].y = y;
        x += padded(im->width);
        shelf = padded(im->height) > shelf ? padded(im->height) : shelf;
        *width = x > *width ? x : *width;
    }
    *height = y + shelf;
    return *width <= RETEX_WEB_ATLAS_SIDE_MAX && *height <= RETEX_WEB_ATLAS_SIDE_MAX;
}

/* The tile's levels, its last column and row repeated up to whole blocks. */
static void draw(float *levels, int width, const RetexWebTile *tile, const RetexImage *im)
{
    for (int y = 0; y < padded(im->height); y++)
        for (int x = 0; x < padded(im->width); x++) {
            const float *from = im->pixels + retex_image_index(im, x < im->width ? x : im->width - 1,
                                                               y < im->height ? y : im->height - 1);
            float *to = levels + 3 * ((size_t)(tile->y + y) * (size_t)width + (size_t)(tile->x + x));
            for (int c = 0; c < 3; c++)
                to[c] = level_of(&tile->curve, from[im->channels == 3 ? c : 0]);
        }
}

typedef struct Atlas {
    const RetexSet *set;
    RetexWebTile *tiles;
    const RetexImage *decoded; /* by part */
    const RetexImage *codes;
    double *own;    /* by tile: the step that it needs */
    double *change; /* by tile: of its mean */
    int *results;
} Atlas;

/* Give a gain's decoded light times the gain its mean. */
static void balance_tile(void *context, int index, int thread)
{
    const Atlas *atlas = context;
    RetexWebTile *tile = &atlas->tiles[index];
    const RetexImage *im = &atlas->set->parts[tile->part].image;
    const int light = retex_pack_light_of(atlas->set, tile->part);
    RetexImage made = {0};
    (void)thread;
    atlas->change[index] = 1;
    atlas->results[index] = RETEX_OK;
    if (light < 0 || im->channels != 3 || !atlas->decoded[light].pixels)
        return;
    int code = retex_image_alloc(&made, im->width, im->height, 3, NULL);
    if (!code) {
        take_values(&made, atlas->codes, tile->x, tile->y, &tile->curve);
        code = retex_pack_restore_mean(&tile->curve, &made, im, &atlas->set->parts[light].image, &atlas->decoded[light],
                                       &atlas->change[index], NULL);
    }
    retex_image_free(&made);
    atlas->results[index] = code;
}

/* Encode all tiles at the step of the one that needs the finest; where coarser steps do, they have fewer levels. */
static int encode_tiles(RetexPackJpeg *jpeg, const Atlas *atlas, int count, int width, int height,
                        const RetexPackPart *packed, RetexError *err)
{
    double step = INFINITY, ignored;
    float *levels = calloc((size_t)width * (size_t)height * 3, sizeof *levels);
    if (!levels)
        return no_memory(err);
    for (int i = 0; i < count; i++)
        step = fmin(step, atlas->own[i]);
    for (int i = 0; i < count; i++) {
        RetexWebTile *tile = &atlas->tiles[i];
        const RetexImage *im = &atlas->set->parts[tile->part].image;
        tile->curve = choose_curve(im, &packed[tile->part], &ignored);
        atlas->own[i] = fmin(atlas->own[i], tile->curve.levels * step / LEVELS_LEAST);
        tile->curve.levels = tile->curve.levels * step / atlas->own[i];
        draw(levels, width, tile, im);
    }
    retex_pack_jpeg_free(jpeg);
    int code = retex_pack_jpeg_encode(jpeg, levels, width, height, 3, step, err);
    free(levels);
    return code;
}

/* Give gains their means. *finer: 1 if some need finer steps, which they have now. */
static int balance_tiles(Atlas *atlas, const RetexPackJpeg *jpeg, int count, int *finer, int nthreads, RetexError *err)
{
    RetexImage codes = {0};
    int code = decode(&codes, jpeg, err);
    *finer = 0;
    if (code)
        return code;
    atlas->codes = &codes;
    retex_parallel(nthreads, count, balance_tile, atlas);
    for (int i = 0; i < count; i++) {
        code = atlas->results[i] ? no_memory(err) : code;
        if (atlas->change[i] > CHANGE_MOST && atlas->own[i] >= 2)
            atlas->own[i] /= 2, *finer = 1;
    }
    retex_image_free(&codes);
    return code;
}

int retex_web_atlas_encode(RetexPackJpeg *jpeg, RetexWebTile *tiles, int count, int *width, int *height,
                           const RetexSet *set, const RetexPackPart *packed, const RetexImage *decoded, int nthreads,
                           RetexError *err)
{
    if (!place(tiles, count, width, height, set))
        return retex_fail(err, RETEX_EUNSUPPORTED, "the set's reduced images do not fit into a texture of %d texels",
                          RETEX_WEB_ATLAS_SIDE_MAX);
    if (!count)
        return 0;
    Atlas atlas = {.set = set, .tiles = tiles, .decoded = decoded};
    atlas.own = calloc((size_t)count, sizeof *atlas.own);
    atlas.change = calloc((size_t)count, sizeof *atlas.change);
    atlas.results = calloc((size_t)count, sizeof *atlas.results);
    int code = atlas.own && atlas.change && atlas.results ? RETEX_OK : no_memory(err);
    for (int i = 0; i < count && !code; i++)
        choose_curve(&set->parts[tiles[i].part].image, &packed[tiles[i].part], &atlas.own[i]);
    for (int finer = 1; finer && !code;) {
        code = encode_tiles(jpeg, &atlas, count, *width, *height, packed, err);
        if (!code)
            code = balance_tiles(&atlas, jpeg, count, &finer, nthreads, err);
    }
    free(atlas.own);
    free(atlas.change);
    free(atlas.results);
    return code;
}
