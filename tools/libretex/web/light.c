/* See light.h. */
#include "web/light.h"

#include <math.h>
#include <stdlib.h>

#include <retex/color.h>

#include "pack/encode.h"
#include "set/set.h"

static const double LEVEL_MOST = 255;
/* White is at least at this level, however bright the brightest pixel; 24 times white is clipped. */
static const double WHITE_LEVEL_LEAST = 160;
static const double GAMMA = 2.4;       /* of sRGB */
static const double LEVELS_LEAST = 16; /* of a tile in an atlas */
enum { TILE = 8 };                     /* sides of JPEG's blocks */

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

int retex_web_light_encode(RetexPackJpeg *jpeg, RetexPackCurve *curve, const RetexPart *part,
                           const RetexPackPart *packed, int filled, RetexError *err)
{
    const RetexImage *im = &part->image;
    const size_t count = (size_t)im->width * (size_t)im->height * (size_t)im->channels;
    double step;
    float *levels = malloc(count * sizeof *levels);
    if (!levels)
        return no_memory(err);
    *curve = choose_curve(im, packed, &step);
    for (size_t i = 0; i < count; i++)
        levels[i] = level_of(curve, im->pixels[i]);
    if (filled)
        retex_pack_fill_black(levels, im);
    int code = retex_pack_jpeg_encode(jpeg, levels, im->width, im->height, im->channels, step, err);
    free(levels);
    return code;
}

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

/* All tiles have the step of the one that needs the finest; where coarser steps do, they have fewer levels. */
int retex_web_atlas_encode(RetexPackJpeg *jpeg, RetexWebTile *tiles, int count, int *width, int *height,
                           const RetexSet *set, const RetexPackPart *packed, RetexError *err)
{
    double step = INFINITY;
    if (!place(tiles, count, width, height, set))
        return retex_fail(err, RETEX_EUNSUPPORTED, "the set's reduced images do not fit into a texture of %d texels",
                          RETEX_WEB_ATLAS_SIDE_MAX);
    if (!count)
        return 0;
    double *own = calloc((size_t)count, sizeof *own);
    float *levels = calloc((size_t)*width * (size_t)*height * 3, sizeof *levels);
    if (!levels || !own) {
        free(levels);
        free(own);
        return no_memory(err);
    }
    for (int i = 0; i < count; i++) {
        tiles[i].curve = choose_curve(&set->parts[tiles[i].part].image, &packed[tiles[i].part], &own[i]);
        step = fmin(step, own[i]);
    }
    for (int i = 0; i < count; i++) {
        tiles[i].curve.levels = fmax(tiles[i].curve.levels * step / own[i], LEVELS_LEAST);
        draw(levels, *width, &tiles[i], &set->parts[tiles[i].part].image);
    }
    free(own);
    int code = retex_pack_jpeg_encode(jpeg, levels, *width, *height, 3, step, err);
    free(levels);
    return code;
}
