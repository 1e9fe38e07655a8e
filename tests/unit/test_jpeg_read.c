/* JPEG textures read without OpenImageIO, compared with those that the bridge reads, and files that are left to the
 * bridge. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include <retex/retex.h>

#include "picture/jpeg_read.h"
#include "lib_test.h"

#define FILE_NAME "jpeg_read.jpg"

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

static RetexNarrowImage read_direct(long max_pixels)
{
    RetexNarrowImage image = {0};
    RetexInput *input;
    RetexError err = {0};
    test_must(retex_input_open(&input, FILE_NAME, &err), &err);
    test_must(retex_jpeg_read_narrow(&image, input, max_pixels, &err), &err);
    retex_input_close(&input);
    return image;
}

/* Quality chooses the subsampling too. */
static void test_like_the_bridge(void **state)
{
    (void)state;
    static const struct {
        int width, height, channels, quality;
    } cases[] = {{64, 48, 3, 95}, {37, 23, 3, 80}, {1, 1, 3, 95}, {130, 17, 1, 90}, {16, 200, 1, 50}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        RetexNarrowImage bridged = {0};
        RetexError err = {0};
        write_jpeg(cases[i].width, cases[i].height, cases[i].channels, cases[i].quality);
        RetexNarrowImage direct = read_direct(0);
        assert_non_null(direct.pixels);
        assert_true(direct.width == cases[i].width && direct.height == cases[i].height);
        test_must(retex_bridge_read_narrow(&bridged,
                                           &(RetexBridgeFile){FILE_NAME, NULL, -1, NULL, 0, "", 1, NULL, NULL}, &err),
                  &err);
        assert_non_null(bridged.pixels);
        assert_memory_equal(direct.pixels, bridged.pixels,
                            sizeof *direct.pixels * 4 * (size_t)direct.width * (size_t)direct.height);
        free(direct.pixels);
        free(bridged.pixels);
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

static void expect_left(void)
{
    RetexNarrowImage image = read_direct(0);
    assert_null(image.pixels);
}

static void test_what_is_left(void **state)
{
    (void)state;
    write_jpeg(64, 48, 3, 95);
    RetexNarrowImage image = read_direct(64 * 48 - 1); /* too many pixels */
    assert_null(image.pixels);
    change(3000, NULL, NULL, 0); /* cut short */
    expect_left();
    change(40, NULL, NULL, 0); /* within the header */
    expect_left();
    /* turned: the one tag of the EXIF becomes orientation 6 */
    write_jpeg(64, 48, 3, 95);
    static const unsigned char turned[] = {0, 'I', 'I', '*', 0, 8, 0, 0, 0, 1, 0, 0x12, 1, 3,
                                           0, 1,   0,   0,   0, 6, 0, 0, 0, 0, 0, 0,    0};
    change(0, "Exif", turned, sizeof turned);
    expect_left();
    RetexNarrowImage bridged = {0};
    RetexError err = {0};
    test_must(
        retex_bridge_read_narrow(&bridged, &(RetexBridgeFile){FILE_NAME, NULL, -1, NULL, 0, "", 1, NULL, NULL}, &err),
        &err);
    assert_int_equal(bridged.width, 48);
    free(bridged.pixels);
    unlink(FILE_NAME);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_like_the_bridge),
        cmocka_unit_test(test_what_is_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
