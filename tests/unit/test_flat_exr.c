/* Flat OpenEXR files, read again by OpenEXRCore: names, types, texts and every pixel; what cannot be written. */
#include <math.h>
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lib_folder.h"
#include "lib_test.h"
#include <cmocka.h>

#include <retex/host/flat_exr.h>

enum { CHANNELS = 5, HEIGHT = 37 };
static const RetexFlatChannel channels[CHANNELS] = {
    {"A", RETEX_HALF},
    {"a layer with a name of more than thirty-one letters.B", RETEX_FLOAT},
    {"a.G", RETEX_HALF},
    {"b.R", RETEX_FLOAT},
    {"c", RETEX_HALF}};
static const RetexFlatText texts[] = {{"owner", "nobody"}, {"empty", ""}, {"two lines", "one\ntwo"}};

typedef struct Rows {
    int width, asked, failing; /* asked: rows that `begin` announced; failing: from which of them on it fails, or -1 */
} Rows;

/* Whole numbers up to 2048 are exact in halves; some rows are noise, which cannot be compressed. */
static float value_at(int channel, int x, int y)
{
    uint32_t seed = (uint32_t)(channel + 17 * (x + 5003 * y)) + 1;
    const double noise = test_random(&seed);
    return channel == 1 && y >= 16 && y < 32 ? (float)noise : (float)((x * 7 + y * 13 + channel * 101) % 2049);
}

static int begin(void *context, int y, int lines, int thread)
{
    Rows *rows = context;
    (void)thread;
    assert_true(y % 16 == 0 && lines == (y + 16 <= HEIGHT ? 16 : HEIGHT - y));
    __atomic_add_fetch(&rows->asked, lines, __ATOMIC_RELAXED);
    return rows->failing >= 0 && y >= rows->failing ? RETEX_EFORMAT : 0;
}

static void row(void *context, int channel, int y, int thread, float *values)
{
    const Rows *rows = context;
    (void)thread;
    for (int x = 0; x < rows->width; x++)
        values[x] = value_at(channel, x, y);
}

static const RetexFlatText *give_texts(void *context, int *count)
{
    assert_int_equal(((Rows *)context)->asked, HEIGHT); /* all rows are there */
    *count = sizeof texts / sizeof *texts;
    return texts;
}

static const RetexFlatText *give_none(void *context, int *count)
{
    (void)context, (void)count;
    return NULL;
}

static void read_pixels(exr_context_t exr, int width, float *pixels[CHANNELS])
{
    for (int y = 0; y < HEIGHT; y += 16) {
        exr_chunk_info_t chunk;
        exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
        assert_int_equal(exr_read_scanline_chunk_info(exr, 0, y, &chunk), EXR_ERR_SUCCESS);
        assert_int_equal(chunk.start_y, y);
        assert_int_equal(exr_decoding_initialize(exr, 0, &chunk, &decode), EXR_ERR_SUCCESS);
        for (int c = 0; c < CHANNELS; c++) {
            decode.channels[c].decode_to_ptr = (uint8_t *)(pixels[c] + (size_t)y * (size_t)width);
            decode.channels[c].user_data_type = EXR_PIXEL_FLOAT;
            decode.channels[c].user_bytes_per_element = 4;
            decode.channels[c].user_pixel_stride = 4;
            decode.channels[c].user_line_stride = 4 * width;
        }
        assert_int_equal(exr_decoding_choose_default_routines(exr, 0, &decode), EXR_ERR_SUCCESS);
        assert_int_equal(exr_decoding_run(exr, 0, &decode), EXR_ERR_SUCCESS);
        exr_decoding_destroy(exr, &decode);
    }
}

static void there_and_back(void **state)
{
    static const int widths[] = {1, 255, 256, 257, 700};
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    (void)state;
    settings.flags = EXR_CONTEXT_FLAG_STRICT_HEADER;
    for (int k = 0; k < 5; k++) {
        const int width = widths[k];
        Rows at = {width, 0, -1};
        const RetexFlatRows rows = {&at, begin, row, k ? give_texts : NULL};
        RetexError err = {0};
        exr_context_t exr;
        const exr_attr_chlist_t *list;
        exr_attr_box2i_t window;
        exr_compression_t compression;
        float *pixels[CHANNELS], aspect;
        test_must(
            retex_flat_exr_write(test_in_folder("flat.exr"), width, HEIGHT, channels, CHANNELS, &rows, 1 + k, &err),
            &err);
        assert_int_equal(exr_start_read(&exr, test_in_folder("flat.exr"), &settings), EXR_ERR_SUCCESS);
        assert_int_equal(exr_get_channels(exr, 0, &list), EXR_ERR_SUCCESS);
        assert_int_equal(list->num_channels, CHANNELS);
        for (int c = 0; c < CHANNELS; c++) {
            const exr_attr_chlist_entry_t *entry = &list->entries[c];
            assert_string_equal(entry->name.str, channels[c].name);
            assert_int_equal(entry->pixel_type, channels[c].type == RETEX_HALF ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT);
            assert_true(entry->x_sampling == 1 && entry->y_sampling == 1 && entry->p_linear == 0);
            pixels[c] = calloc((size_t)width * HEIGHT, sizeof(float));
        }
        assert_int_equal(exr_get_compression(exr, 0, &compression), EXR_ERR_SUCCESS);
        assert_int_equal(compression, EXR_COMPRESSION_ZIP);
        for (int display = 0; display < 2; display++) {
            assert_int_equal((display ? exr_get_display_window : exr_get_data_window)(exr, 0, &window),
                             EXR_ERR_SUCCESS);
            assert_true(window.min.x == 0 && window.min.y == 0 && window.max.x == width - 1);
            assert_int_equal(window.max.y, HEIGHT - 1);
        }
        assert_int_equal(exr_get_pixel_aspect_ratio(exr, 0, &aspect), EXR_ERR_SUCCESS);
        assert_true(aspect == 1);
        for (size_t i = 0; i < sizeof texts / sizeof *texts && k; i++) {
            const char *value;
            int32_t length;
            assert_int_equal(exr_attr_get_string(exr, 0, texts[i].name, &length, &value), EXR_ERR_SUCCESS);
            assert_true(length == (int)strlen(texts[i].value) && memcmp(value, texts[i].value, (size_t)length) == 0);
        }
        read_pixels(exr, width, pixels);
        for (int c = 0; c < CHANNELS; c++)
            for (int i = 0; i < width * HEIGHT; i++)
                if (pixels[c][i] != value_at(c, i % width, i / width))
                    fail_msg("channel %d at %d, %d is %g", c, i % width, i / width, (double)pixels[c][i]);
        for (int c = 0; c < CHANNELS; c++)
            free(pixels[c]);
        exr_finish(&exr);
    }
}

/* Rows that cannot be made, attributes that cannot, chunks of more than 2 GB, and a folder that is not there: an error,
 * and no file. */
static void nothing_is_left_of_a_failure(void **state)
{
    Rows at = {9, 0, 16};
    RetexFlatRows rows = {&at, begin, row, NULL};
    RetexError err = {0};
    FILE *file;
    (void)state;
    assert_int_equal(retex_flat_exr_write(test_in_folder("none.exr"), 9, HEIGHT, channels, 5, &rows, 2, &err),
                     RETEX_EFORMAT);
    at.failing = -1, rows.texts = give_none;
    assert_int_equal(retex_flat_exr_write(test_in_folder("none.exr"), 9, HEIGHT, channels, 5, &rows, 2, &err),
                     RETEX_ENOMEM);
    rows.texts = NULL;
    assert_int_equal(retex_flat_exr_write(test_in_folder("none.exr"), 1 << 24, HEIGHT, channels, 5, &rows, 2, &err),
                     RETEX_ELIMIT);
    assert_int_equal(retex_flat_exr_write(test_in_folder("no/none.exr"), 9, HEIGHT, channels, 5, &rows, 2, &err),
                     RETEX_EIO);
    file = fopen(test_in_folder("none.exr"), "rb");
    assert_null(file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(there_and_back),
        cmocka_unit_test(nothing_is_left_of_a_failure),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
