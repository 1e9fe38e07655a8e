/* The atlas of a web folder: every image is where its tile says, whole, and apart from the others. */
#include <stdio.h> /* for the next one */
#include <stdlib.h>

#include <jpeglib.h>

#include "lib_test.h"
#include <cmocka.h>

#include <math.h>

#include "web/light.h"

enum { TILES = 10, BLACK = 9, NEAR = 3 };

/* Shelves of the atlas: two tiles and a third that does not fit beside them, then lower and narrower ones. The widest
 * shelf is neither the first nor the last. */
static const struct {
    int width, height, channels;
} sizes[TILES] = {{1500, 9, 3}, {1501, 20, 1}, {2000, 17, 3}, {2050, 3, 1}, {4000, 8, 3},
                  {100, 30, 1}, {7, 7, 3},     {2041, 16, 1}, {33, 12, 3}, {24, 14, 3}};

/* The steps that the plan asks for: the atlas has the finest; others have fewer levels, but at least 16. A black image
 * asks for none. */
static const double steps[TILES] = {1.5, 3, 12, 1.5, 2, 400, 6, 1.5, 5, INFINITY};

static float most_of(int tile)
{
    return tile == BLACK ? 0 : 0.08f * (float)(tile + 1);
}

static void fill(RetexImage *im, int tile)
{
    for (size_t i = 0; i < (size_t)im->width * (size_t)im->height * (size_t)im->channels; i++)
        im->pixels[i] = most_of(tile) * (im->channels == 3 && i % 3 == 1 ? 0.9f : 1);
}

/* The step of a tile whose white, at level 255, is its largest value. */
static double own_step(int tile)
{
    return fmax(1, steps[tile] * pow(1 / (double)most_of(tile), 1 / 2.4));
}

static void expect_levels(const RetexWebTile tiles[TILES])
{
    double least = INFINITY;
    for (int i = 0; i < TILES; i++)
        least = fmin(least, own_step(i));
    for (int i = 0; i < TILES; i++)
        assert_float_equal(tiles[i].curve.levels, fmax(16, 255 * least / own_step(i)), 0.01);
}

static unsigned char *decode(const RetexPackJpeg *jpeg, int width, int height)
{
    struct jpeg_decompress_struct in;
    struct jpeg_error_mgr errors;
    unsigned char *pixels = malloc((size_t)width * (size_t)height * 3);
    in.err = jpeg_std_error(&errors);
    jpeg_create_decompress(&in);
    jpeg_mem_src(&in, jpeg->data, (unsigned long)jpeg->bytes);
    assert_int_equal(jpeg_read_header(&in, TRUE), JPEG_HEADER_OK);
    in.out_color_space = JCS_RGB;
    jpeg_start_decompress(&in);
    assert_int_equal(in.output_width, width);
    assert_int_equal(in.output_height, height);
    while (in.output_scanline < in.output_height) {
        unsigned char *row = pixels + (size_t)in.output_scanline * (size_t)width * 3;
        jpeg_read_scanlines(&in, &row, 1);
    }
    jpeg_finish_decompress(&in);
    jpeg_destroy_decompress(&in);
    return pixels;
}

static void expect_tile(const unsigned char *atlas, int width, const RetexWebTile *tile, const RetexImage *im)
{
    for (int y = 0; y < im->height; y++)
        for (int x = 0; x < im->width; x++)
            for (int c = 0; c < 3; c++) {
                const float value = im->pixels[retex_image_index(im, x, y) + (size_t)(im->channels == 3 ? c : 0)];
                const double level = retex_pack_curve_level(&tile->curve, c, (double)value);
                const int is = atlas[3 * ((size_t)(tile->y + y) * (size_t)width + (size_t)(tile->x + x)) + (size_t)c];
                assert_true(abs(is - (int)(level + 0.5)) <= NEAR);
            }
}

static void tiles_are_where_they_say(void **state)
{
    RetexSet *set;
    RetexWebTile tiles[TILES];
    RetexPackPart packed[TILES + 1] = {{.width = 0}};
    const RetexImage decoded[TILES + 1] = {{0}}; /* of no light */
    RetexPackJpeg jpeg = {0};
    RetexError err = {0};
    int width, height;
    (void)state;
    test_must(retex_set_create(&set, 8, 8, &err), &err);
    for (int i = 0; i < TILES; i++) {
        char name[16];
        snprintf(name, sizeof name, "t%d", i);
        test_must(retex_set_add_part(set, name, sizes[i].channels == 3 ? "RGB" : "R", RETEX_HALF, sizes[i].width,
                                     sizes[i].height, &tiles[i].part, &err),
                  &err);
        packed[tiles[i].part] =
            i == BLACK
                ? (RetexPackPart){.codec = RETEX_PACK_ZERO}
                : (RetexPackPart){.codec = RETEX_PACK_JPEG, .curve = retex_pack_curve(1, 255), .jpeg_step = steps[i]};
    }
    for (int i = 0; i < TILES; i++)
        fill(&set->parts[tiles[i].part].image, i);
    test_must(retex_web_atlas_encode(&jpeg, tiles, TILES, &width, &height, set, packed, decoded, 2, &err), &err);
    expect_levels(tiles);
    assert_true(width <= RETEX_WEB_ATLAS_SIDE_MAX && height <= RETEX_WEB_ATLAS_SIDE_MAX);
    unsigned char *atlas = decode(&jpeg, width, height);
    for (int i = 0; i < TILES; i++) {
        const RetexImage *a = &set->parts[tiles[i].part].image;
        assert_true(tiles[i].x >= 0 && tiles[i].x + a->width <= width);
        assert_true(tiles[i].y >= 0 && tiles[i].y + a->height <= height);
        for (int j = 0; j < i; j++) {
            const RetexImage *b = &set->parts[tiles[j].part].image;
            assert_true(tiles[i].x >= tiles[j].x + b->width || tiles[j].x >= tiles[i].x + a->width ||
                        tiles[i].y >= tiles[j].y + b->height || tiles[j].y >= tiles[i].y + a->height);
        }
        expect_tile(atlas, width, &tiles[i], a);
    }
    free(atlas);
    retex_pack_jpeg_free(&jpeg);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_are_where_they_say),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
