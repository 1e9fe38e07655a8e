/* JPEG and PNG files read without OpenImageIO, compared with what the bridge reads of them, and files that are left to
 * the bridge. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>
#include <png.h>

#include <retex/retex.h>

#include "picture/bridge_load.h"
#include "picture/jpeg_read.h"
#include "picture/png_read.h"
#include "lib_test.h"

#define FILE_NAME "levels.jpg"
#define PNG_NAME "levels.png"

enum { FILE_MOST = 1 << 20 };

static void write_jpeg(int width, int height, int channels, int quality)
{
    RetexImage image = {0};
    RetexWriteParams params = RETEX_WRITE_INIT;
    RetexError err = {0};
    params.quality = quality;
    test_random_image(&image, width, height, channels, (uint32_t)(width * 7 + channels), 0, 1);
    test_must(retex_image_write(&image, FILE_NAME, &params, 1, &err), &err);
    retex_image_free(&image);
}

/* One picture of a file, as floats or as integers. */
typedef struct Picture {
    RetexImage wide;
    RetexNarrowImage narrow;
} Picture;

static Picture read_direct(const char *path, int narrow, int is_linear, long max_pixels)
{
    Picture picture = {0};
    RetexLevels levels = {.is_linear = is_linear, .max_pixels = max_pixels};
    unsigned char *data = malloc(FILE_MOST);
    FILE *file = fopen(path, "rb");
    const size_t size = fread(data, 1, FILE_MOST, file);
    fclose(file);
    if (narrow)
        levels.narrow = &picture.narrow;
    else
        levels.image = &picture.wide;
    const int done =
        strcmp(path, PNG_NAME) == 0 ? retex_png_read(&levels, data, size) : retex_jpeg_read(&levels, data, size);
    assert_int_not_equal(done, RETEX_LEVELS_NO_MEMORY);
    retex_levels_end(&levels, done == RETEX_LEVELS_READ);
    free(data);
    return picture;
}

static Picture read_bridged(const char *path, int narrow, const char *colorspace)
{
    const RetexBridgeFile file = {path, NULL, -1, colorspace, 0, "", 1, NULL, NULL, 0};
    Picture picture = {0};
    RetexError err = {0};
    test_must(narrow ? retex_bridge_read_narrow(&picture.narrow, &file, &err)
                     : retex_bridge_read(&picture.wide, &file, &err),
              &err);
    return picture;
}

static void expect_like_the_bridge(const char *path, int width, int height)
{
    static const char *const spaces[] = {NULL, "sRGB", "linear"};
    for (int space = 0; space < 3; space++)
        for (int narrow = 0; narrow < (space == 2 ? 1 : 2); narrow++) { /* the bridge has no integers of linear files */
            Picture direct = read_direct(path, narrow, space == 2, (long)width * height),
                    bridged = read_bridged(path, narrow, spaces[space]);
            const size_t values = 4 * (size_t)width * (size_t)height;
            if (narrow) {
                assert_true(direct.narrow.pixels && bridged.narrow.pixels);
                assert_true(direct.narrow.width == width && direct.narrow.height == height);
                assert_memory_equal(direct.narrow.pixels, bridged.narrow.pixels, values * sizeof(uint16_t));
            } else {
                assert_true(direct.wide.pixels && direct.wide.width == width && direct.wide.height == height);
                assert_memory_equal(direct.wide.pixels, bridged.wide.pixels, values * sizeof(float));
            }
            free(direct.narrow.pixels), free(bridged.narrow.pixels);
            retex_image_free(&direct.wide), retex_image_free(&bridged.wide);
        }
}

static void expect_left_of(const char *path, long max_pixels)
{
    for (int narrow = 0; narrow < 2; narrow++) {
        Picture picture = read_direct(path, narrow, 0, max_pixels);
        assert_true(!picture.narrow.pixels && !picture.wide.pixels);
    }
}

/* Quality chooses the subsampling too. */
static void test_jpeg(void **state)
{
    (void)state;
    static const struct {
        int width, height, channels, quality;
    } cases[] = {{64, 48, 3, 95}, {37, 23, 3, 80}, {1, 1, 3, 95}, {130, 17, 1, 90}, {16, 200, 1, 50}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        write_jpeg(cases[i].width, cases[i].height, cases[i].channels, cases[i].quality);
        expect_like_the_bridge(FILE_NAME, cases[i].width, cases[i].height);
    }
    unlink(FILE_NAME);
}

/* Give the file back with some of its bytes changed, or fewer. */
static void change(size_t keep, const char *find, const void *replace, size_t bytes)
{
    char data[1 << 16];
    FILE *file = fopen(FILE_NAME, "rb");
    size_t size = fread(data, 1, sizeof data, file);
    fclose(file);
    for (size_t i = 0; find && i + 64 < size; i++)
        if (memcmp(data + i, find, strlen(find)) == 0) {
            memcpy(data + i + strlen(find) + 1, replace, bytes);
            break;
        }
    file = fopen(FILE_NAME, "wb");
    assert_int_equal(fwrite(data, 1, keep && keep < size ? keep : size, file), keep && keep < size ? keep : size);
    fclose(file);
}

static void test_left_jpeg(void **state)
{
    (void)state;
    write_jpeg(64, 48, 3, 95);
    expect_left_of(FILE_NAME, 64 * 48 - 1); /* too many pixels */
    change(3000, NULL, NULL, 0);            /* cut short */
    expect_left_of(FILE_NAME, 0);
    change(40, NULL, NULL, 0); /* within the header */
    expect_left_of(FILE_NAME, 0);
    /* turned: the one tag of the EXIF becomes orientation 6 */
    write_jpeg(64, 48, 3, 95);
    static const unsigned char turned[] = {0, 'I', 'I', '*', 0, 8, 0, 0, 0, 1, 0, 0x12, 1, 3,
                                           0, 1,   0,   0,   0, 6, 0, 0, 0, 0, 0, 0,    0};
    change(0, "Exif", turned, sizeof turned);
    expect_left_of(FILE_NAME, 0);
    Picture bridged = read_bridged(FILE_NAME, 1, NULL);
    assert_int_equal(bridged.narrow.width, 48);
    free(bridged.narrow.pixels);
    unlink(FILE_NAME);
}

/* ---- PNG ---- */

enum {
    WITH_TRANSPARENT = 1,
    WITH_PLAIN_CHUNKS = 2,
    WITH_SRGB = 4,
    WITH_GAMMA = 8,
    WITH_EXIF = 16,
    WITH_XMP = 32,
    WITH_LATE_XMP = 64,
    INTERLACED = 128,
    WITH_UNKNOWN = 256
};

static png_byte random_byte(uint32_t *random)
{
    return (png_byte)(256 * test_random(random));
}

static void add_text(png_structp png, png_infop info, const char *keyword)
{
    char key[80], text[] = "what it says";
    snprintf(key, sizeof key, "%s", keyword);
    png_text one = {.compression = PNG_TEXT_COMPRESSION_NONE, .key = key, .text = text, .text_length = strlen(text)};
    png_set_text(png, info, &one, 1);
}

static void add_palette(png_structp png, png_infop info, int bits, int transparent, uint32_t *random)
{
    png_color colors[256];
    png_byte alphas[256];
    for (int i = 0; i < 256; i++) {
        colors[i] = (png_color){random_byte(random), random_byte(random), random_byte(random)};
        alphas[i] = random_byte(random);
    }
    png_set_PLTE(png, info, colors, 1 << bits);
    if (transparent)
        png_set_tRNS(png, info, alphas, 1 << (bits - 1), NULL);
}

static void add_chunks(png_structp png, png_infop info, int with)
{
    if (with & WITH_PLAIN_CHUNKS) {
        png_set_pHYs(png, info, 3000, 3000, PNG_RESOLUTION_METER);
        png_set_oFFs(png, info, 5, 7, PNG_OFFSET_PIXEL);
        png_set_bKGD(png, info, &(png_color_16){.red = 1, .green = 2, .blue = 3, .gray = 1});
        add_text(png, info, "Software");
        png_set_tIME(png, info, &(png_time){2020, 1, 2, 3, 4, 5});
    }
    if (with & WITH_SRGB)
        png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (with & WITH_GAMMA)
        png_set_gAMA_fixed(png, info, 100000);
    if (with & WITH_EXIF)
        png_set_eXIf_1(png, info, 8, (png_byte[]){'I', 'I', '*', 0, 8, 0, 0, 0});
    if (with & WITH_XMP)
        add_text(png, info, "XML:com.adobe.xmp");
    if (with & WITH_UNKNOWN) {
        png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_ALWAYS, (const png_byte *)"cICP", 1);
        png_set_unknown_chunks(png, info, &(png_unknown_chunk){"cICP", (png_byte[]){9, 16, 0, 1}, 4, PNG_HAVE_IHDR}, 1);
    }
}

static void write_png(int width, int height, int type, int bits, int with)
{
    uint32_t random = (uint32_t)(width * 31 + type * 7 + bits);
    FILE *file = fopen(PNG_NAME, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png), end = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, bits, type,
                 with & INTERLACED ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, 0, 0);
    if (type == PNG_COLOR_TYPE_PALETTE)
        add_palette(png, info, bits, with & WITH_TRANSPARENT, &random);
    else if (with & WITH_TRANSPARENT)
        png_set_tRNS(png, info, NULL, 0, &(png_color_16){.red = 3, .green = 3, .blue = 3, .gray = 1});
    add_chunks(png, info, with);
    png_write_info(png, info);
    const size_t row = png_get_rowbytes(png, info);
    unsigned char *rows = malloc(row * (size_t)height);
    png_bytep *of = malloc(sizeof *of * (size_t)height);
    for (size_t i = 0; i < row * (size_t)height; i++) /* few values, among them the transparent colour, or any */
        rows[i] = (unsigned char)(random_byte(&random) & (with & WITH_TRANSPARENT && bits > 4 ? 3 : 255));
    for (int y = 0; y < height; y++)
        of[y] = rows + row * (size_t)y;
    png_write_image(png, of);
    if (with & WITH_LATE_XMP)
        add_text(png, end, "XML:com.adobe.xmp");
    png_write_end(png, end);
    png_destroy_info_struct(png, &end);
    png_destroy_write_struct(&png, &info);
    free(rows), free(of);
    fclose(file);
}

static int is_whole(void)
{
    unsigned char data[FILE_MOST];
    FILE *file = fopen(PNG_NAME, "rb");
    const size_t size = fread(data, 1, sizeof data, file);
    fclose(file);
    return retex_png_is_whole(data, size);
}

static void test_png(void **state)
{
    (void)state;
    static const struct {
        int width, height, type, bits, with;
    } cases[] = {
        {64, 48, PNG_COLOR_TYPE_RGB, 8, 0},
        {37, 23, PNG_COLOR_TYPE_RGB, 16, WITH_PLAIN_CHUNKS},
        {130, 500, PNG_COLOR_TYPE_RGB, 16, WITH_SRGB}, /* most levels of 16 bits */
        {64, 48, PNG_COLOR_TYPE_RGB, 8, WITH_TRANSPARENT},
        {64, 48, PNG_COLOR_TYPE_RGB_ALPHA, 8, WITH_SRGB | WITH_PLAIN_CHUNKS},
        {65, 49, PNG_COLOR_TYPE_RGB_ALPHA, 16, 0},
        {1, 1, PNG_COLOR_TYPE_GRAY, 8, 0},
        {33, 9, PNG_COLOR_TYPE_GRAY, 1, 0},
        {33, 9, PNG_COLOR_TYPE_GRAY, 2, WITH_TRANSPARENT},
        {33, 9, PNG_COLOR_TYPE_GRAY, 4, WITH_PLAIN_CHUNKS},
        {33, 9, PNG_COLOR_TYPE_GRAY, 16, 0},
        {33, 9, PNG_COLOR_TYPE_GRAY_ALPHA, 8, 0},
        {33, 9, PNG_COLOR_TYPE_GRAY_ALPHA, 16, 0},
        {33, 9, PNG_COLOR_TYPE_PALETTE, 1, 0},
        {33, 9, PNG_COLOR_TYPE_PALETTE, 4, WITH_TRANSPARENT},
        {33, 90, PNG_COLOR_TYPE_PALETTE, 8, WITH_TRANSPARENT | WITH_PLAIN_CHUNKS},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        write_png(cases[i].width, cases[i].height, cases[i].type, cases[i].bits, cases[i].with);
        assert_true(is_whole());
        expect_like_the_bridge(PNG_NAME, cases[i].width, cases[i].height);
    }
    unlink(PNG_NAME);
}

static void test_left_png(void **state)
{
    (void)state;
    static const int withs[] = {WITH_GAMMA, WITH_EXIF, WITH_XMP, WITH_LATE_XMP, WITH_UNKNOWN, INTERLACED};
    for (size_t i = 0; i < sizeof withs / sizeof *withs; i++) {
        write_png(64, 48, PNG_COLOR_TYPE_RGB, 8, withs[i]);
        expect_left_of(PNG_NAME, 0);
    }
    write_png(64, 48, PNG_COLOR_TYPE_RGB, 8, WITH_PLAIN_CHUNKS);
    expect_left_of(PNG_NAME, 64 * 48 - 1); /* too many pixels */
    unsigned char data[1 << 16];
    FILE *file = fopen(PNG_NAME, "rb");
    const size_t size = fread(data, 1, sizeof data, file);
    fclose(file);
    for (size_t kept = size - 1; kept > 8; kept -= kept / 7 + 1) { /* cut short */
        assert_int_equal(truncate(PNG_NAME, (off_t)kept), 0);
        assert_false(is_whole());
        expect_left_of(PNG_NAME, 0);
    }
    for (size_t at = 8; at < size; at += 1 + size / 100) { /* a bit is wrong: everything has a checksum */
        data[at] ^= 4;
        file = fopen(PNG_NAME, "wb");
        assert_int_equal(fwrite(data, 1, size, file), size);
        fclose(file);
        expect_left_of(PNG_NAME, 0);
        assert_false(is_whole());
        data[at] ^= 4;
    }
    unlink(PNG_NAME);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_jpeg),
        cmocka_unit_test(test_left_jpeg),
        cmocka_unit_test(test_png),
        cmocka_unit_test(test_left_png),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
