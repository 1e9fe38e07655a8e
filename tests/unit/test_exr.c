/* EXR: half conversion of all values, round trips of parts, every compression, and damaged files. */
#include "lib_folder.h"
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <openexr.h>
#include <zlib.h>

#include "exr/io.h"
#include "exr/stored.h"
#include "base/half.h"

static const char *const path = test_own_file;

/* A half's value by its definition. */
static double half_value(unsigned half)
{
    const double sign = half & 0x8000 ? -1 : 1;
    const int exponent = half >> 10 & 31, mantissa = half & 1023;
    return sign * (exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24));
}

static void test_every_half(void **state)
{
    (void)state;
    static uint16_t all[65536], again[65536], scalar_again[65536];
    static float values[65536], scalar[65536];
    for (unsigned i = 0; i < 65536; i++)
        all[i] = (uint16_t)i;
    retex_half_to_float(values, all, 65536);
    retex_half_to_float_scalar(scalar, all, 65536);
    assert_memory_equal(values, scalar, sizeof values);
    retex_half_from_float(again, values, 65536);
    retex_half_from_float_scalar(scalar_again, values, 65536);
    assert_memory_equal(again, scalar_again, sizeof again);
    for (unsigned i = 0; i < 65536; i++) {
        const int special = (i & 0x7c00) == 0x7c00, nan = special && (i & 0x3ff);
        if (!special)
            assert_true((double)values[i] == half_value(i));
        else if (!nan)
            assert_true(isinf(values[i]) && (values[i] < 0) == (i >= 0x8000));
        else
            assert_true(isnan(values[i]));
        assert_int_equal(again[i], nan ? (i | 0x200) : i);
    }
}

/* Between each two neighbours: the midpoint goes to the even one, what lies beside it to the nearer. */
static void test_rounding_to_half(void **state)
{
    (void)state;
    for (unsigned i = 0; i < 0x7bff; i++) {
        const float middle = (float)((half_value(i) + half_value(i + 1)) / 2); /* exact in float */
        const float in[6] = {nextafterf(middle, 0),  middle,  nextafterf(middle, 1e9f),
                             -nextafterf(middle, 0), -middle, -nextafterf(middle, 1e9f)};
        const unsigned even = i & 1 ? i + 1 : i;
        const unsigned want[6] = {i, even, i + 1, i | 0x8000, even | 0x8000, (i + 1) | 0x8000};
        uint16_t out[6];
        retex_half_from_float_scalar(out, in, 6);
        for (int k = 0; k < 6; k++)
            assert_int_equal(out[k], want[k]);
    }
    static const float large[8] = {65504, 65519, 65520, 1e30f, -1e30f, INFINITY, -INFINITY, -65505};
    static const uint16_t clamped[8] = {0x7bff, 0x7bff, 0x7bff, 0x7bff, 0xfbff, 0x7c00, 0xfc00, 0xfbff};
    uint16_t out[8];
    retex_half_from_float(out, large, 8);
    assert_memory_equal(out, clamped, sizeof out);
    retex_half_from_float_scalar(out, large, 8);
    assert_memory_equal(out, clamped, sizeof out);
}

static void test_vector_equals_scalar(void **state)
{
    (void)state;
    enum { COUNT = 100003 };
    float *values = malloc(COUNT * sizeof *values);
    uint16_t *fast = malloc(COUNT * 2), *slow = malloc(COUNT * 2);
    uint32_t bits = 1;
    for (int round = 0; round < 20; round++) {
        for (int i = 0; i < COUNT; i++) {
            bits = bits * 1664525 + 1013904223;
            memcpy(&values[i], &bits, 4);
        }
        retex_half_from_float(fast, values, COUNT);
        retex_half_from_float_scalar(slow, values, COUNT);
        assert_memory_equal(fast, slow, COUNT * 2);
    }
    free(values);
    free(fast);
    free(slow);
}

enum { PARTS = 4 };

/* Parts of different sizes, types and letters; some black, so that runs occur. */
static void make_parts(RetexExrPart parts[PARTS], RetexImage images[PARTS])
{
    static const struct {
        const char *name, *letters;
        RetexPixelType type;
        int width, height;
    } shape[PARTS] = {
        {"beauty", "RGB", RETEX_HALF, 75, 50},
        {"uv_floor_1", "RGA", RETEX_FLOAT, 75, 50},
        {"a_long_name_that_needs_the_long_name_flag_of_the_format", "RG", RETEX_HALF, 75, 50},
        {"original", "RGBA", RETEX_FLOAT, 130, 17},
    };
    memset(images, 0, PARTS * sizeof *images);
    for (int i = 0; i < PARTS; i++) {
        const int channels = (int)strlen(shape[i].letters);
        test_random_image(&images[i], shape[i].width, shape[i].height, channels, (uint32_t)i + 1, -2, 9);
        memset(images[i].pixels, 0, sizeof(float) * (size_t)(shape[i].width * channels) * 5);
        memset(&parts[i], 0, sizeof parts[i]);
        strcpy(parts[i].name, shape[i].name);
        strcpy(parts[i].letters, shape[i].letters);
        parts[i].type = shape[i].type;
        parts[i].image = &images[i];
    }
}

static void write_to(const char *name, RetexExrPart *parts, int count, int compress, int threads)
{
    RetexExrEncoding *encoding;
    RetexError err = {0};
    test_must(retex_exr_encode(&encoding, parts, count, compress, threads, &err), &err);
    test_must(retex_exr_write(encoding, 75, 50, "note", "a text", name, &err), &err);
    retex_exr_encoding_free(&encoding);
}

static void write_parts(RetexExrPart *parts, int count, int compress, int threads)
{
    write_to(path, parts, count, compress, threads);
}

/* By the definition in set.h, of some rows. */
static uint32_t expected_crc(const RetexExrPart *part, int y0, int y1)
{
    const RetexImage *im = part->image;
    uint32_t crc = 0;
    for (int c = 0; c < im->channels; c++)
        for (int i = im->width * y0; i < im->width * y1; i++) {
            const float value = im->pixels[i * im->channels + c];
            uint16_t half;
            retex_half_from_float_scalar(&half, &value, 1);
            crc = (uint32_t)(part->type == RETEX_HALF ? crc32(crc, (const unsigned char *)&half, 2)
                                                      : crc32(crc, (const unsigned char *)&value, 4));
        }
    return crc;
}

static void check_part(RetexExr *exr, const RetexExrPart *part, int index, int threads)
{
    RetexImage image = {0};
    RetexError err = {0};
    RetexExrRequest request = {.part = retex_exr_find_part(exr, part->name), .image = &image, .with_crc = 1};
    int width, height;
    assert_int_equal(request.part, index);
    retex_exr_part_size(exr, index, &width, &height);
    assert_true(width == part->image->width && height == part->image->height);
    test_must(retex_image_alloc(&image, width, height, part->image->channels, &err), &err);
    for (int c = 0; part->letters[c]; c++)
        snprintf(request.channels[c], RETEX_EXR_NAME_MAX, "%.180s%s%c", index ? part->name : "", index ? "." : "",
                 part->letters[c]);
    test_must(retex_exr_read(exr, &request, 1, threads, &err), &err);
    for (int i = 0; i < width * height * image.channels; i++) {
        float want = part->image->pixels[i];
        if (part->type == RETEX_HALF) {
            uint16_t half;
            retex_half_from_float(&half, &want, 1);
            retex_half_to_float(&want, &half, 1);
        }
        assert_true(want == image.pixels[i]);
    }
    assert_int_equal(request.crc, part->crc);
    retex_image_free(&image);
}

static void test_parts_there_and_back(void **state)
{
    (void)state;
    RetexExrPart parts[PARTS];
    RetexImage images[PARTS];
    make_parts(parts, images);
    for (int variant = 0; variant < 8; variant++) {
        const int compress = variant & 1, threads = variant & 2 ? 7 : 1, count = variant & 4 ? 1 : PARTS;
        RetexInput *input;
        RetexExr *exr;
        RetexError err = {0};
        write_parts(parts, count, compress, threads);
        test_must(retex_input_open(&input, path, &err), &err);
        test_must(retex_exr_open(&exr, input, &err), &err);
        assert_int_equal(retex_exr_part_count(exr), count);
        assert_string_equal(retex_exr_attribute(exr, 0, "note"), "a text");
        assert_null(retex_exr_attribute(exr, 0, "channels"));
        assert_int_equal(retex_exr_find_part(exr, "none"), -1);
        for (int i = 0; i < count; i++) {
            assert_int_equal(parts[i].crc, expected_crc(&parts[i], 0, images[i].height));
            check_part(exr, &parts[i], i, threads);
        }
        retex_exr_close(&exr);
        retex_input_close(&input);
    }
    for (int i = 0; i < PARTS; i++)
        retex_image_free(&images[i]);
}

/* Bands of 16 rows have checksums of their own, the last one too, which has the rows that are left. */
/* As OpenEXR's library reads the header: other programs show the display window, at 0,0 and of the picture's size; the
 * data window of a part is the part's own. */
static void test_windows(void **state)
{
    (void)state;
    RetexExrPart parts[PARTS];
    RetexImage images[PARTS];
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t file = NULL;
    make_parts(parts, images);
    write_parts(parts, PARTS, 1, 1);
    assert_int_equal(exr_start_read(&file, path, &settings), 0);
    for (int i = 0; i < PARTS; i++) {
        exr_attr_box2i_t display, data;
        assert_int_equal(exr_get_display_window(file, i, &display), 0);
        assert_int_equal(exr_get_data_window(file, i, &data), 0);
        assert_true(display.min.x == 0 && display.min.y == 0 && display.max.x == 74 && display.max.y == 49);
        assert_true(data.min.x == 0 && data.min.y == 0 && data.max.x == images[i].width - 1 &&
                    data.max.y == images[i].height - 1);
        retex_image_free(&images[i]);
    }
    exr_finish(&file);
}

static void test_checksums_of_bands(void **state)
{
    (void)state;
    RetexExrPart parts[PARTS];
    RetexImage images[PARTS];
    RetexExrEncoding *encoding;
    RetexError err = {0};
    make_parts(parts, images);
    test_must(retex_exr_encode(&encoding, parts, PARTS, 1, 2, &err), &err);
    for (int i = 0; i < PARTS; i++) {
        uint32_t *crcs = retex_exr_band_crcs(encoding, i);
        assert_non_null(crcs);
        for (int y = 0; y < images[i].height; y += 16)
            assert_int_equal(crcs[y / 16],
                             expected_crc(&parts[i], y, y + 16 < images[i].height ? y + 16 : images[i].height));
        free(crcs);
        retex_image_free(&images[i]);
    }
    retex_exr_encoding_free(&encoding);
}

/* A part whose chunks are those of an open file's only part. */
typedef struct Copied {
    RetexExrPart part;
    RetexImage shape;
    RetexExrPlan plan;
    RetexExrStored stored;
} Copied;

static void open_copied(Copied *copied, RetexExr *exr, const RetexExrPart *part)
{
    static const uint32_t bands[3];
    RetexExrRequest request = {.channels = {"R", "G", "B"}, .bands = bands};
    RetexError err = {0};
    *copied = (Copied){.part = *part, .shape = *part->image};
    copied->shape.pixels = NULL;
    copied->part.image = &copied->shape, copied->part.stored = &copied->stored, copied->part.store = NULL;
    test_must(retex_exr_plan_open(exr, &copied->plan, &request, &err), &err);
    assert_int_equal(retex_exr_stored_find(&copied->stored, exr, &copied->plan, part->type), 1);
}

/* Chunks are copied into another file as they are. */
static void check_copy(RetexExr *exr, const RetexExrPart *part)
{
    char name[1100];
    Copied copied;
    RetexInput *input = NULL;
    RetexExr *copy = NULL;
    RetexError err = {0};
    snprintf(name, sizeof name, "%s-copy.exr", path);
    open_copied(&copied, exr, part);
    write_to(name, &copied.part, 1, 1, 2);
    test_must(retex_input_open(&input, name, &err), &err);
    test_must(retex_exr_open(&copy, input, &err), &err);
    check_part(copy, part, 0, 2);
    retex_exr_close(&copy);
    retex_input_close(&input);
    retex_exr_plan_close(&copied.plan);
    unlink(name);
}

/* Where the file lost its last chunks since it was opened, there is an error, and no copy. */
static void check_copy_of_less(RetexExr *exr, const RetexExrPart *part)
{
    char name[1100];
    Copied copied;
    RetexExrEncoding *encoding;
    RetexError err = {0};
    struct stat of;
    snprintf(name, sizeof name, "%s-copy.exr", path);
    open_copied(&copied, exr, part);
    test_must(retex_exr_encode(&encoding, &copied.part, 1, 1, 2, &err), &err);
    assert_int_equal(stat(path, &of), 0);
    assert_int_equal(truncate(path, of.st_size - 8), 0);
    assert_int_not_equal(retex_exr_write(encoding, 75, 50, "note", "a text", name, &err), RETEX_OK);
    assert_non_null(strstr(err.message, "is damaged or truncated"));
    assert_int_not_equal(access(name, F_OK), 0);
    retex_exr_encoding_free(&encoding);
    retex_exr_plan_close(&copied.plan);
}

/* Parts of floats of 24 bits are compressed by PXR24, which other readers know, and read without loss here and by
 * OpenEXRCore. One number of more bits makes the part ZIP. Both, from memory, from a band store, and from a file. */
static void test_floats_of_24_bits(void **state)
{
    (void)state;
    RetexExrPart parts[PARTS];
    RetexImage images[PARTS];
    uint32_t seed = 3;
    make_parts(parts, images);
    for (int variant = 0; variant < 4; variant++) {
        RetexBandStore *store = NULL;
        RetexInput *input;
        RetexExr *exr;
        RetexError err = {0};
        RetexExrPart part = parts[0];
        RetexImage image = {0}, shape;
        exr_context_t context = NULL;
        exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
        exr_compression_t compression;
        const int wide = variant & 1;
        int number;
        part.type = RETEX_FLOAT, part.image = &image;
        test_must(retex_image_alloc(&image, 61, 40, (int)strlen(part.letters), &err), &err);
        for (size_t i = 0; i < retex_image_index(&image, 0, 40); i++)
            image.pixels[i] = (float)(rint((test_random(&seed) - 0.5) * 65536) / 1024 + 16.0 * (i % 97 == 0));
        image.pixels[retex_image_index(&image, 60, 39)] = wide ? 20 + 0x1p-18f : 20;
        shape = image;
        if (variant & 2) {
            test_must(retex_band_store_create(&store, 61, 40, 0, NULL, &err), &err);
            test_must(retex_band_store_add(store, "a", part.letters, RETEX_FLOAT, &number, &err), &err);
            for (int y = 0; y < 40; y += RETEX_BAND_ROWS)
                test_must(retex_band_store_put(store, number, y / RETEX_BAND_ROWS,
                                               image.pixels + retex_image_index(&image, 0, y), &err),
                          &err);
            shape.pixels = NULL, part.store = store, part.store_image = number, part.image = &shape;
        }
        write_parts(&part, 1, 1, 2);
        part.image = &image;
        assert_int_equal(exr_start_read(&context, path, &settings), EXR_ERR_SUCCESS);
        assert_int_equal(exr_get_compression(context, 0, &compression), EXR_ERR_SUCCESS);
        assert_int_equal(compression, wide ? EXR_COMPRESSION_ZIP : EXR_COMPRESSION_PXR24);
        exr_finish(&context);
        test_must(retex_input_open(&input, path, &err), &err);
        test_must(retex_exr_open(&exr, input, &err), &err);
        check_part(exr, &part, 0, 2);
        check_copy(exr, &part);
        check_copy_of_less(exr, &part);
        retex_exr_close(&exr);
        retex_input_close(&input);
        retex_band_store_close(&store);
        retex_image_free(&image);
    }
    for (int i = 0; i < PARTS; i++)
        retex_image_free(&images[i]);
}

/* Compressed parts take less room than they hold, and less than without; what does not shrink is kept as it is. */
static void test_files_are_smaller_when_compressed(void **state)
{
    (void)state;
    RetexExrPart parts[PARTS];
    RetexImage images[PARTS];
    size_t bytes[3], pixels = 0;
    make_parts(parts, images);
    for (int i = 0; i < PARTS; i++) {
        RetexImage *im = &images[i];
        for (size_t k = 0; k < retex_image_index(im, 0, im->height); k++)
            im->pixels[k] = (float)(k / (size_t)im->channels % 8);
        pixels += retex_image_index(im, 0, im->height) * (parts[i].type == RETEX_HALF ? 2 : 4);
    }
    for (int compress = 0; compress < 3; compress++) {
        write_parts(parts, PARTS, compress, 2);
        free(test_read_file(path, &bytes[compress]));
    }
    assert_true(bytes[0] > pixels && bytes[0] < pixels + 8192);
    assert_true(bytes[RETEX_EXR_SMALL] < pixels / 8 + 4096);
    assert_true(bytes[RETEX_EXR_QUICKLY] > bytes[RETEX_EXR_SMALL] && bytes[RETEX_EXR_QUICKLY] < pixels);
    for (int i = 0; i < PARTS; i++)
        retex_image_free(&images[i]);
}

static void test_files_are_equal_for_every_thread_count(void **state)
{
    (void)state;
    RetexExrPart parts[PARTS];
    RetexImage images[PARTS];
    size_t bytes, again;
    make_parts(parts, images);
    write_parts(parts, PARTS, 1, 1);
    unsigned char *reference = test_read_file(path, &bytes);
    for (int threads = 2; threads < 8; threads += 5) {
        write_parts(parts, PARTS, 1, threads);
        unsigned char *data = test_read_file(path, &again);
        assert_int_equal(again, bytes);
        assert_memory_equal(data, reference, bytes);
        free(data);
    }
    free(reference);
    for (int i = 0; i < PARTS; i++)
        retex_image_free(&images[i]);
}

static void store(const unsigned char *data, size_t bytes)
{
    unlink(path); /* file systems flush a file that is truncated and written again */
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, bytes, file), bytes);
    assert_int_equal(fclose(file), 0);
}

/* Read whatever path holds, all parts, all channels; the status. */
static int read_anything(void)
{
    RetexInput *input = NULL;
    RetexExr *exr = NULL;
    RetexError err = {0};
    int status = retex_input_open(&input, path, &err);
    if (!status)
        status = retex_exr_open(&exr, input, &err);
    for (int part = 0; !status && part < retex_exr_part_count(exr); part++) {
        static const char *const channels[] = {"R", "G", "B"};
        RetexExrRequest request = {.part = part};
        RetexImage image = {0};
        const char *reason;
        int width, height;
        retex_exr_part_size(exr, part, &width, &height);
        if (!retex_exr_part_readable(exr, part, &reason) || width > 4096 || height > 4096)
            status = RETEX_EUNSUPPORTED;
        for (int c = 0; !status && c < 3; c++)
            if (retex_exr_has_channel(exr, part, channels[c]))
                strcpy(request.channels[c], channels[c]);
        if (!status)
            status = retex_image_alloc(&image, width, height, 4, &err);
        request.image = &image;
        if (!status)
            status = retex_exr_read(exr, &request, 1, 2, &err);
        retex_image_free(&image);
    }
    if (status && status != RETEX_EUNSUPPORTED) {
        assert_true(err.message[0] != 0);
        assert_int_equal(err.code, status);
    }
    retex_exr_close(&exr);
    retex_input_close(&input);
    return status;
}

static void test_damaged_files(void **state)
{
    (void)state;
    RetexExrPart parts[PARTS];
    RetexImage images[PARTS];
    make_parts(parts, images);
    for (int compress = 0; compress < 2; compress++) {
        uint32_t seed = 7;
        size_t bytes;
        /* the first part alone, so that every byte is asked for */
        write_parts(parts, 1, compress, 1);
        unsigned char *data = test_read_file(path, &bytes);
        assert_int_equal(read_anything(), 0);
        for (size_t length = 0; length < bytes; length += length < 700 ? 1 : 331) {
            store(data, length);
            assert_int_not_equal(read_anything(), 0);
        }
        for (int i = 0; i < 1500; i++) {
            const size_t range = i % 2 ? bytes : 1000; /* every other time the header and the table */
            const size_t place = (size_t)(test_random(&seed) * (double)range) % bytes;
            const unsigned char old = data[place];
            data[place] ^= (unsigned char)(1 + test_random(&seed) * 255);
            store(data, bytes);
            read_anything(); /* may well succeed: it must only not crash */
            data[place] = old;
        }
        free(data);
        write_parts(parts, PARTS, compress, 1);
        data = test_read_file(path, &bytes);
        for (int i = 0; i < 500; i++) {
            const size_t place = (size_t)(test_random(&seed) * 2500) % bytes;
            const unsigned char old = data[place];
            data[place] ^= (unsigned char)(1 + test_random(&seed) * 255);
            store(data, bytes);
            read_anything();
            data[place] = old;
        }
        free(data);
    }
    for (int i = 0; i < PARTS; i++)
        retex_image_free(&images[i]);
}

static void quiet(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

/* One part R, G of halves by OpenEXRCore alone, in scan lines or in tiles of 32 x 16. */
static void write_by_core(const uint16_t *planes[2], int width, int height, exr_compression_t compression, int tiled)
{
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t context;
    int part, lines = 0;
    settings.error_handler_fn = quiet;
    assert_int_equal(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &settings), 0);
    assert_int_equal(exr_add_part(context, "x", tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &part), 0);
    assert_int_equal(exr_initialize_required_attr_simple(context, part, width, height, compression), 0);
    if (tiled)
        assert_int_equal(exr_set_tile_descriptor(context, part, 32, 16, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN), 0);
    assert_int_equal(exr_add_channel(context, part, "R", EXR_PIXEL_HALF, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1), 0);
    assert_int_equal(exr_add_channel(context, part, "G", EXR_PIXEL_HALF, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1), 0);
    assert_int_equal(exr_write_header(context), 0);
    exr_get_scanlines_per_chunk(context, part, &lines);
    const int step_x = tiled ? 32 : width, step_y = tiled ? 16 : lines;
    for (int y = 0; y < height; y += step_y)
        for (int x = 0; x < width; x += step_x) {
            exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
            exr_chunk_info_t chunk;
            if (tiled)
                assert_int_equal(exr_write_tile_chunk_info(context, part, x / 32, y / 16, 0, 0, &chunk), 0);
            else
                assert_int_equal(exr_write_scanline_chunk_info(context, part, y, &chunk), 0);
            assert_int_equal(exr_encoding_initialize(context, part, &chunk, &pipeline), 0);
            for (int c = 0; c < 2; c++) { /* G comes first */
                pipeline.channels[c].user_pixel_stride = 2;
                pipeline.channels[c].user_line_stride = 2 * width;
                pipeline.channels[c].encode_from_ptr = (const uint8_t *)(planes[1 - c] + (size_t)y * (size_t)width + x);
            }
            assert_int_equal(exr_encoding_choose_default_routines(context, part, &pipeline), 0);
            assert_int_equal(exr_encoding_run(context, part, &pipeline), 0);
            exr_encoding_destroy(context, &pipeline);
        }
    assert_int_equal(exr_finish(&context), 0);
}

static void test_foreign_files_of_every_compression(void **state)
{
    (void)state;
    enum { WIDTH = 101, HEIGHT = 67, COUNT = WIDTH * HEIGHT };
    static uint16_t red[COUNT], green[COUNT];
    const uint16_t *planes[2] = {red, green};
    uint32_t seed = 3;
    for (int i = 0; i < COUNT; i++) {
        const float value = (float)(1 + i % WIDTH * 0.01 + i / WIDTH * 0.02), noisy = value + (float)test_random(&seed);
        retex_half_from_float(&red[i], &value, 1);
        retex_half_from_float(&green[i], &noisy, 1);
    }
    for (int kind = EXR_COMPRESSION_NONE; kind <= EXR_COMPRESSION_PXR24; kind++)
        for (int tiled = 0; tiled < 2; tiled++) {
            RetexImage image = {0};
            RetexError err = {0};
            write_by_core(planes, WIDTH, HEIGHT, (exr_compression_t)kind, tiled);
            test_must(retex_image_read(&image, path, NULL, 1, &err), &err);
            assert_true(image.width == WIDTH && image.height == HEIGHT);
            for (int i = 0; i < COUNT; i++) {
                float want[2];
                retex_half_to_float(&want[0], &red[i], 1);
                retex_half_to_float(&want[1], &green[i], 1);
                assert_true(image.pixels[4 * i] == want[0] && image.pixels[4 * i + 1] == want[1]);
                assert_true(image.pixels[4 * i + 2] == 0 && image.pixels[4 * i + 3] == 1);
            }
            retex_image_free(&image);
            size_t bytes;
            unsigned char *data = test_read_file(path, &bytes);
            for (int i = 0; i < 150; i++) {
                const size_t place = (size_t)(test_random(&seed) * (double)bytes);
                const unsigned char old = data[place];
                data[place] ^= (unsigned char)(1 + test_random(&seed) * 255);
                store(data, bytes);
                read_anything();
                data[place] = old;
            }
            free(data);
        }
}

/* Chunks are copied as they are from what write.c could have made: 16 lines, ZIP, or PXR24 of floats. */
static void test_chunks_that_can_be_copied(void **state)
{
    (void)state;
    enum { WIDTH = 40, HEIGHT = 33 };
    static uint16_t zeros[WIDTH * HEIGHT];
    const uint16_t *planes[2] = {zeros, zeros};
    const uint32_t bands[3] = {0};
    for (int kind = EXR_COMPRESSION_NONE; kind <= EXR_COMPRESSION_PXR24; kind++)
        for (int tiled = 0; tiled < 2; tiled++) {
            RetexExrRequest request = {.channels = {"R", "G"}, .bands = bands};
            RetexExrPlan plan = {0};
            RetexExrStored stored;
            RetexInput *input = NULL;
            RetexExr *exr = NULL;
            RetexError err = {0};
            write_by_core(planes, WIDTH, HEIGHT, (exr_compression_t)kind, tiled);
            test_must(retex_input_open(&input, path, &err), &err);
            test_must(retex_exr_open(&exr, input, &err), &err);
            test_must(retex_exr_plan_open(exr, &plan, &request, &err), &err);
            const int is_ours = kind == EXR_COMPRESSION_ZIP && !tiled;
            assert_int_equal(retex_exr_stored_find(&stored, exr, &plan, RETEX_HALF), is_ours);
            assert_int_equal(retex_exr_stored_find(&stored, exr, &plan, RETEX_FLOAT), 0);
            request.bands = NULL;
            assert_int_equal(retex_exr_stored_find(&stored, exr, &plan, RETEX_HALF), 0);
            retex_exr_plan_close(&plan);
            retex_exr_close(&exr);
            retex_input_close(&input);
        }
}

/* Put a chunk of this size and these bytes in place of a file's only one. */
static void replace_chunk(const unsigned char *file, size_t start, int32_t size, const unsigned char *data,
                          size_t bytes)
{
    unsigned char *changed = malloc(start + 8 + bytes);
    memcpy(changed, file, start + 4); /* the line */
    memcpy(changed + start + 4, &size, 4);
    memcpy(changed + start + 8, data, bytes);
    store(changed, start + 8 + bytes);
    free(changed);
}

/* What OpenEXR's ZIP deflates: the even bytes, then the odd ones, as differences. */
static void prepare_for_zip(unsigned char *out, const unsigned char *raw, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++)
        out[i % 2 ? (bytes + 1) / 2 + i / 2 : i / 2] = raw[i];
    for (size_t i = bytes - 1; i > 0; i--)
        out[i] = (unsigned char)(out[i] - out[i - 1] + 128);
}

/* A chunk is as long as its samples, which are then as they are, or compressed and shorter: nothing else is read. */
static void test_sizes_of_chunks(void **state)
{
    (void)state;
    enum { WIDTH = 50, RAW = 4 * WIDTH, ROOM = RAW + 64 };
    static const struct {
        int level;   /* of zlib; -1: not compressed */
        int32_t add; /* to the size that the chunk says */
        int right;   /* in a file without compression, with ZIPS */
    } cases[] = {{-1, 0, 3},       {-1, 1, 0}, {-1, -1, 0}, {-1, -RAW, 0}, {-1, -RAW - 1, 0},
                 {-1, 1 << 30, 0}, {9, 0, 2},  {9, -1, 0},  {9, -4, 0},    {0, 0, 0}};
    uint16_t samples[2][WIDTH]; /* G, R, as in the file */
    const uint16_t *planes[2] = {samples[1], samples[0]};
    unsigned char ready[RAW], chunk[ROOM];
    for (int i = 0; i < 2 * WIDTH; i++)
        samples[i / WIDTH][i % WIDTH] = (uint16_t)(0x3800 + i % WIDTH / 7);
    prepare_for_zip(ready, (const unsigned char *)samples, RAW);
    for (int zips = 0; zips < 2; zips++)
        for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
            write_by_core(planes, WIDTH, 1, zips ? EXR_COMPRESSION_ZIPS : EXR_COMPRESSION_NONE, 0);
            size_t bytes, start = 8;
            uLongf length = ROOM;
            uint64_t entry = 0;
            unsigned char *file = test_read_file(path, &bytes);
            for (; entry != start; start++)
                memcpy(&entry, file + start - 7, 8);
            memset(chunk, 0, sizeof chunk);
            if (cases[k].level >= 0)
                assert_int_equal(compress2(chunk, &length, ready, RAW, cases[k].level), Z_OK);
            else
                memcpy(chunk, samples, length = RAW);
            assert_true(cases[k].level != 0 || length > RAW); /* what is stored is longer */
            replace_chunk(file, start, (int32_t)length + cases[k].add, chunk, sizeof chunk);
            RetexImage image = {0};
            RetexError err = {0};
            const int status = read_anything();
            if (!(cases[k].right >> zips & 1)) {
                assert_int_equal(status, RETEX_EFORMAT);
            } else {
                assert_int_equal(status, 0);
                test_must(retex_image_read(&image, path, NULL, 1, &err), &err);
                for (int x = 0; x < WIDTH; x++) {
                    assert_true(image.pixels[4 * x] == (float)half_value(samples[1][x]));
                    assert_true(image.pixels[4 * x + 1] == (float)half_value(samples[0][x]));
                }
            }
            retex_image_free(&image);
            free(file);
        }
}

static void test_absurd_requests(void **state)
{
    (void)state;
    RetexExrPart parts[PARTS];
    RetexImage images[PARTS];
    RetexExrEncoding *encoding;
    RetexError err = {0};
    make_parts(parts, images);
    assert_int_equal(retex_exr_encode(&encoding, parts, 0, 1, 1, &err), RETEX_EINVAL);
    strcpy(parts[0].letters, "RG");
    assert_int_equal(retex_exr_encode(&encoding, parts, 1, 1, 1, &err), RETEX_EINVAL);
    strcpy(parts[0].letters, "RGB");
    strcpy(parts[1].name, "beauty"); /* two of one name */
    assert_int_equal(retex_exr_encode(&encoding, parts, 2, 1, 1, &err), RETEX_EINVAL);
    assert_null(encoding);
    for (int i = 0; i < PARTS; i++)
        retex_image_free(&images[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_half),
        cmocka_unit_test(test_rounding_to_half),
        cmocka_unit_test(test_vector_equals_scalar),
        cmocka_unit_test(test_parts_there_and_back),
        cmocka_unit_test(test_windows),
        cmocka_unit_test(test_checksums_of_bands),
        cmocka_unit_test(test_floats_of_24_bits),
        cmocka_unit_test(test_files_are_smaller_when_compressed),
        cmocka_unit_test(test_files_are_equal_for_every_thread_count),
        cmocka_unit_test(test_damaged_files),
        cmocka_unit_test(test_foreign_files_of_every_compression),
        cmocka_unit_test(test_chunks_that_can_be_copied),
        cmocka_unit_test(test_sizes_of_chunks),
        cmocka_unit_test(test_absurd_requests),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
