/* Pictures written strip by strip: the file does not depend on the order of strips and threads, the pixels are those of
 * the libraries that write such files in one call, and no file remains where writing fails. */
#include "lib_folder.h"
#include "lib_test.h"
#include <cmocka.h>

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <jpeglib.h>

#include "picture/bridge_load.h"
#include "exr/io.h"
#include "base/half.h"
#include "picture/png_filter.h"
#include "picture/srgb_codes.h"

typedef struct Bytes {
    unsigned char *data;
    size_t count;
} Bytes;

static Bytes load(const char *path)
{
    Bytes bytes = {NULL, 0};
    struct stat status;
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fstat(fileno(file), &status), 0);
    bytes.count = (size_t)status.st_size;
    bytes.data = malloc(bytes.count + 1);
    assert_int_equal(fread(bytes.data, 1, bytes.count, file), bytes.count);
    fclose(file);
    return bytes;
}

static void assert_same_file(const char *a, const char *b)
{
    Bytes x = load(a), y = load(b);
    assert_int_equal(x.count, y.count);
    assert_memory_equal(x.data, y.data, x.count);
    free(x.data);
    free(y.data);
}

/* Smooth light with noise, and some that is black, too bright or no number. */
static void paint(RetexImage *im, int width, int height, int channels)
{
    RetexError err = {0};
    uint32_t state = 7;
    test_must(retex_image_alloc(im, width, height, channels, &err), &err);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < channels; c++)
                im->pixels[retex_image_index(im, x, y) + (size_t)c] =
                    (float)(0.5 + 0.5 * sin(0.05 * x + c) * cos(0.03 * y) + 0.05 * test_random(&state));
    im->pixels[0] = NAN;
    if (width > 2) {
        im->pixels[channels] = INFINITY;
        im->pixels[2 * channels] = -1;
    }
}

typedef struct Job {
    RetexPicture *picture;
    const RetexImage *image;
    int nstrips, stride; /* strips are taken in the order 0, stride, 2 stride …, modulo their number */
} Job;

static void write_strip(void *context, int index, int thread)
{
    const Job *job = context;
    const int y0 = (int)((long)index * job->stride % job->nstrips) * RETEX_PICTURE_STRIP;
    const int y1 = y0 + RETEX_PICTURE_STRIP < job->image->height ? y0 + RETEX_PICTURE_STRIP : job->image->height;
    RetexError err = {0};
    (void)thread;
    /* in memory of its own: nothing beyond the strip may be looked at */
    const size_t values = retex_image_index(job->image, 0, y1) - retex_image_index(job->image, 0, y0);
    float *rows = malloc(values * sizeof *rows);
    memcpy(rows, job->image->pixels + retex_image_index(job->image, 0, y0), values * sizeof *rows);
    test_must(retex_picture_rows(job->picture, y0, y1, rows, &err), &err);
    free(rows);
}

static void write_strips(const RetexImage *im, const char *path, const RetexWriteParams *params, int nthreads,
                         int stride)
{
    Job job = {NULL, im, (im->height + RETEX_PICTURE_STRIP - 1) / RETEX_PICTURE_STRIP, stride};
    RetexError err = {0};
    test_must(retex_picture_open(&job.picture, path, im->width, im->height, im->channels, params, &err), &err);
    retex_parallel(nthreads, job.nstrips, write_strip, &job);
    test_must(retex_picture_close(&job.picture, 1, &err), &err);
    assert_null(job.picture);
}

static const int sizes[][2] = {{1, 1}, {3, 2}, {37, 63}, {64, 64}, {100, 65}, {203, 500}, {16, 1100}};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

/* The file as the bridge makes it in one go, OpenImageIO and the libraries behind it. */
static int append(void *file, const void *data, size_t bytes, RetexError *err)
{
    return fwrite(data, 1, bytes, file) == bytes ? 0 : retex_fail(err, RETEX_EIO, "cannot write");
}

static void write_in_one_go(const RetexImage *im, const char *path, const RetexWriteParams *params)
{
    RetexBridgePlan *plan = NULL;
    RetexBridgeStored stored;
    RetexError err = {0};
    const size_t pixels = (size_t)im->width * (size_t)im->height;
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    test_must(retex_bridge_plan(&plan, &stored, path, im->width, im->height, im->channels, params, &err), &err);
    void *samples = malloc(pixels * (size_t)(stored.channels * stored.bits / 8));
    test_must(retex_bridge_convert(plan, im->pixels, (long)pixels, samples, &err), &err);
    test_must(retex_bridge_write(plan, samples, append, file, &err), &err);
    free(samples);
    retex_bridge_plan_free(&plan);
    assert_int_equal(fclose(file), 0);
}

/* What OpenImageIO reads, its pixels untouched, must be the same of both. */
static void assert_same_pixels(const char *a, const char *b)
{
    RetexImage x = {0}, y = {0};
    RetexError err = {0};
    test_must(retex_bridge_read(&x, &(RetexBridgeFile){a, NULL, -1, "raw", 0, "", 1, NULL, NULL}, &err), &err);
    test_must(retex_bridge_read(&y, &(RetexBridgeFile){b, NULL, -1, "raw", 0, "", 1, NULL, NULL}, &err), &err);
    assert_int_equal(x.width, y.width);
    assert_int_equal(x.height, y.height);
    assert_memory_equal(x.pixels, y.pixels, retex_image_index(&x, 0, x.height) * sizeof(float));
    retex_image_free(&x);
    retex_image_free(&y);
}

static void test_any_order_and_threads(void **state)
{
    (void)state;
    static const char *const endings[] = {"jpg", "png", "exr", "tif", "bmp", "hdr"};
    for (int s = 0; s < SIZES; s++)
        for (size_t k = 0; k < sizeof endings / sizeof endings[0]; k++)
            for (int channels = 3; channels <= 4; channels++) {
                RetexImage im = {0};
                RetexError err = {0};
                char one[16], other[16];
                snprintf(one, sizeof one, "one.%s", endings[k]);
                snprintf(other, sizeof other, "other.%s", endings[k]);
                paint(&im, sizes[s][0], sizes[s][1], channels);
                test_must(retex_image_write(&im, test_in_folder(one), NULL, 1, &err), &err);
                /* strides prime to the numbers of strips: 1, 2, 8, 18 */
                static const int orders[][2] = {{1, 1}, {1, 17}, {2, 5}, {7, 1}, {7, 7}};
                for (int i = 0; i < 5; i++) {
                    write_strips(&im, test_in_folder(other), NULL, orders[i][0], orders[i][1]);
                    if (strcmp(endings[k], "tif") == 0) /* it says when it was written */
                        assert_same_pixels(test_in_folder(one), test_in_folder(other));
                    else
                        assert_same_file(test_in_folder(one), test_in_folder(other));
                }
                retex_image_free(&im);
            }
}

/* In memory there are the bytes of the file. */
static void test_memory_is_the_file(void **state)
{
    static const char *const formats[] = {"jpg", "png", "exr", "webp", "tif", "avif", "jxl"};
    RetexWriteParams params = RETEX_WRITE_INIT;
    RetexImage im = {0};
    (void)state;
    params.quality = 80;
    paint(&im, 150, 200, 3);
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        RetexError err = {0};
        Job job = {.image = &im, .nstrips = 4, .stride = 3};
        char name[64];
        void *data;
        size_t bytes;
        snprintf(name, sizeof name, "file.%s", formats[i]);
        const char *path = test_in_folder(name);
        test_must(retex_image_write(&im, path, &params, 1, &err), &err);
        test_must(retex_picture_open_memory(&job.picture, formats[i], 150, 200, 3, &params, &err), &err);
        for (int strip = 0; strip < job.nstrips; strip++)
            write_strip(&job, strip, 0);
        test_must(retex_picture_take(&job.picture, &data, &bytes, &err), &err);
        assert_null(job.picture);
        Bytes file = load(path);
        assert_int_equal(file.count, bytes);
        assert_memory_equal(file.data, data, bytes);
        free(file.data);
        free(data);
        unlink(path);
        /* rows are missing */
        test_must(retex_picture_open_memory(&job.picture, formats[i], 150, 200, 3, &params, &err), &err);
        write_strip(&job, 0, 0);
        assert_int_equal(retex_picture_take(&job.picture, &data, &bytes, &err), RETEX_EINVAL);
        assert_null(data);
        test_must(retex_picture_open_memory(&job.picture, formats[i], 150, 200, 3, &params, &err), &err);
        test_must(retex_picture_close(&job.picture, 0, &err), &err);
    }
    RetexPicture *none;
    assert_int_not_equal(retex_picture_open_memory(&none, "jpg", 70000, 2, 3, &params, NULL), 0);
    assert_null(none);
    retex_image_free(&im);
}

static void test_pixels_are_those_of_one_go(void **state)
{
    (void)state;
    static const struct {
        const char *ending, *view, *colorspace;
        int quality, depth;
    } ways[] = {{.ending = "jpg", .quality = 95},
                {.ending = "jpg", .quality = 89},
                {.ending = "jpg", .quality = 1},
                {.ending = "jpg", .colorspace = "ACEScct", .quality = 90},
                {.ending = "JPEG", .view = "Raw", .quality = 80},
                {.ending = "png", .quality = 95},
                {.ending = "png", .quality = 95, .depth = 8},
                {.ending = "png", .quality = 95, .depth = 16},
                {.ending = "png", .colorspace = "ACEScct", .quality = 95},
                {.ending = "png", .colorspace = "ACEScct", .quality = 95, .depth = 16},
                {.ending = "PNG", .view = "Raw", .quality = 95},
                {.ending = "PNG", .view = "Raw", .quality = 95, .depth = 16},
                {.ending = "tif", .quality = 95},
                {.ending = "tif", .quality = 95, .depth = 8},
                {.ending = "tif", .colorspace = "ACEScct", .quality = 95},
                {.ending = "tga", .quality = 95},
                {.ending = "bmp", .colorspace = "sRGB", .quality = 95},
                {.ending = "exr", .colorspace = "ACEScg", .quality = 95},
                {.ending = "pfm", .quality = 95},
                {.ending = "webp", .quality = 90}};
    for (int s = 0; s < SIZES; s++)
        for (size_t k = 0; k < sizeof ways / sizeof ways[0]; k++)
            for (int channels = 1; channels <= 4; channels += channels == 1 ? 2 : 1) {
                RetexImage im = {0};
                RetexWriteParams params = RETEX_WRITE_INIT;
                char ours[16], theirs[16];
                params.view = ways[k].view;
                params.colorspace = ways[k].colorspace;
                params.quality = ways[k].quality;
                params.depth = ways[k].depth;
                snprintf(ours, sizeof ours, "ours.%s", ways[k].ending);
                snprintf(theirs, sizeof theirs, "theirs.%s", ways[k].ending);
                paint(&im, sizes[s][0], sizes[s][1], channels);
                write_in_one_go(&im, test_in_folder(theirs), &params);
                write_strips(&im, test_in_folder(ours), &params, 2, 1);
                assert_same_pixels(test_in_folder(ours), test_in_folder(theirs));
                retex_image_free(&im);
            }
}

/* The same pixels as from the encoding of a whole image that sets are written with. */
static void test_exr_is_that_of_sets(void **state)
{
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        RetexImage im = {0};
        RetexError err = {0};
        RetexExrEncoding *encoding = NULL;
        paint(&im, sizes[s][0], sizes[s][1], 3);
        RetexExrPart part = {.name = "beauty", .letters = "RGB", .type = RETEX_HALF, .image = &im};
        test_must(retex_exr_encode(&encoding, &part, 1, 1, 1, &err), &err);
        test_must(retex_exr_write(encoding, im.width, im.height, NULL, NULL, test_in_folder("set.exr"), &err), &err);
        retex_exr_encoding_free(&encoding);
        write_strips(&im, test_in_folder("strips.exr"), NULL, 2, 1);
        assert_same_pixels(test_in_folder("set.exr"), test_in_folder("strips.exr"));
        retex_image_free(&im);
    }
}

/* Kinds of light: even, a slope, noise over all halves, a picture with little noise, and with much. */
enum { EVEN, SLOPE, ANY_HALF, LITTLE_NOISE, MUCH_NOISE, LIGHTS };

static void paint_light(RetexImage *im, int kind, int width, int height)
{
    RetexError err = {0};
    uint32_t state = 5;
    test_must(retex_image_alloc(im, width, height, 3, &err), &err);
    for (int i = 0; i < 3 * width * height; i++) {
        const double x = i / 3 % width, y = i / 3 / width, u = test_random(&state);
        im->pixels[i] = (float)(kind == EVEN       ? 0.25
                                : kind == SLOPE    ? x / width
                                : kind == ANY_HALF ? exp(30 * u - 17) /* 4e-8 to 4e5: as halves at most 65504 */
                                                   : 0.5 + 0.4 * sin(0.01 * x) * cos(0.02 * y) + 0.1 * sin(0.2 * x) +
                                                         (kind == LITTLE_NOISE ? 0.01 : 0.3) * u);
    }
}

/* OpenImageIO reads the very halves; at most 8 % more bytes than in a set. */
static void test_exr_of_any_light(void **state)
{
    (void)state;
    static const double most[LIGHTS] = {0.005, 0.2, 1.001, 0.8, 0.9}; /* of what halves take */
    for (int kind = 0; kind < LIGHTS; kind++) {
        RetexImage im = {0}, back = {0};
        RetexError err = {0};
        RetexExrEncoding *encoding = NULL;
        uint16_t halves[3 * 1000];
        paint_light(&im, kind, 1000, 100);
        RetexExrPart part = {.name = "beauty", .letters = "RGB", .type = RETEX_HALF, .image = &im};
        test_must(retex_exr_encode(&encoding, &part, 1, 1, 1, &err), &err);
        test_must(retex_exr_write(encoding, im.width, im.height, NULL, NULL, test_in_folder("set.exr"), &err), &err);
        retex_exr_encoding_free(&encoding);
        write_strips(&im, test_in_folder("light.exr"), NULL, 2, 1);
        test_must(
            retex_bridge_read(
                &back, &(RetexBridgeFile){test_in_folder("light.exr"), NULL, -1, "raw", 0, "", 1, NULL, NULL}, &err),
            &err);
        for (int y = 0; y < im.height; y++) {
            float *row = im.pixels + retex_image_index(&im, 0, y);
            retex_half_from_float(halves, row, 3000);
            retex_half_to_float(row, halves, 3000);
            for (int x = 0; x < im.width; x++)
                assert_memory_equal(back.pixels + retex_image_index(&back, x, y), row + 3 * x, 3 * sizeof(float));
        }
        Bytes set = load(test_in_folder("set.exr")), light = load(test_in_folder("light.exr"));
        const double raw = 600e3 + 1000;
        printf("# light %d: %.4f, in a set %.4f\n", kind, (double)light.count / raw, (double)set.count / raw);
        assert_true((double)light.count < most[kind] * raw);
        assert_true((double)light.count < 1.08 * (double)set.count + 2000); /* a head and less effort */
        free(set.data);
        free(light.data);
        retex_image_free(&im);
        retex_image_free(&back);
    }
}

/* Decode, saying no to anything that libjpeg would complain of. */
static unsigned decode_strictly(const char *path, int width, int height, unsigned *restart)
{
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_decompress(&jpeg);
    jpeg_stdio_src(&jpeg, file);
    jpeg_read_header(&jpeg, TRUE);
    jpeg_start_decompress(&jpeg);
    assert_int_equal(jpeg.output_width, width);
    assert_int_equal(jpeg.output_height, height);
    *restart = jpeg.restart_interval;
    JSAMPROW row = malloc((size_t)width * 3);
    while (jpeg.output_scanline < jpeg.output_height)
        jpeg_read_scanlines(&jpeg, &row, 1);
    free(row);
    jpeg_finish_decompress(&jpeg);
    const unsigned warnings = (unsigned)errors.num_warnings;
    const int rest = fgetc(file); /* libjpeg reads ahead: all of a small file */
    jpeg_destroy_decompress(&jpeg);
    fclose(file);
    return warnings + (rest != EOF);
}

static void test_jpeg_is_plain(void **state)
{
    (void)state;
    RetexImage im = {0};
    RetexWriteParams params = RETEX_WRITE_INIT;
    unsigned restart;
    paint(&im, 19, 1000, 3); /* 16 strips: markers 0 to 7 come twice */
    write_strips(&im, test_in_folder("p.jpg"), &params, 2, 7);
    assert_int_equal(decode_strictly(test_in_folder("p.jpg"), 19, 1000, &restart), 0);
    assert_int_equal(restart, 3 * 8);
    params.quality = 50; /* chroma at half the size: MCUs of 16 lines */
    write_strips(&im, test_in_folder("p.jpg"), &params, 2, 1);
    assert_int_equal(decode_strictly(test_in_folder("p.jpg"), 19, 1000, &restart), 0);
    assert_int_equal(restart, 2 * 4);
    retex_image_free(&im);
    paint(&im, 19, 64, 3);
    write_strips(&im, test_in_folder("p.jpg"), NULL, 1, 1);
    assert_int_equal(decode_strictly(test_in_folder("p.jpg"), 19, 64, &restart), 0);
    assert_int_equal(restart, 0);
    retex_image_free(&im);
    paint(&im, 65500, 65, 1); /* the largest there is, with the most MCUs a strip */
    write_strips(&im, test_in_folder("p.jpg"), NULL, 2, 1);
    assert_int_equal(decode_strictly(test_in_folder("p.jpg"), 65500, 65, &restart), 0);
    assert_int_equal(restart, 65504);
    retex_image_free(&im);
}

static unsigned long big_endian(const unsigned char *at)
{
    return (unsigned long)at[0] << 24 | (unsigned long)at[1] << 16 | (unsigned long)at[2] << 8 | at[3];
}

/* The data of a PNG's chunk, or NULL. */
static const unsigned char *find_chunk(const Bytes *png, const char *type, size_t bytes)
{
    for (size_t at = 8; at + 12 <= png->count; at += 12 + big_endian(png->data + at))
        if (memcmp(png->data + at + 4, type, 4) == 0) {
            assert_int_equal(big_endian(png->data + at), bytes);
            return png->data + at + 8;
        }
    return NULL;
}

/* What went through the display transform says that it is sRGB, for old readers too by its gamma and the primaries of
 * Rec. 709; what is in a space that was named says nothing. */
static void test_png_says_its_colors(void **state)
{
    (void)state;
    static const unsigned long xy[8] = {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
    for (int named = 0; named < 2; named++) {
        RetexImage im = {0};
        RetexError err = {0};
        RetexWriteParams params = RETEX_WRITE_INIT;
        params.colorspace = named ? "ACEScct" : NULL;
        paint(&im, 9, 7, 3);
        test_must(retex_image_write(&im, test_in_folder("said.png"), &params, 1, &err), &err);
        Bytes png = load(test_in_folder("said.png"));
        const unsigned char *gamma = find_chunk(&png, "gAMA", 4), *primaries = find_chunk(&png, "cHRM", 32);
        assert_int_equal(find_chunk(&png, "sRGB", 1) == NULL, named);
        assert_int_equal(gamma == NULL, named);
        assert_int_equal(primaries == NULL, named);
        for (int k = 0; k < 8 && !named; k++)
            assert_int_equal(big_endian(primaries + 4 * k), xy[k]);
        assert_true(named || big_endian(gamma) == 45455);
        free(png.data);
        retex_image_free(&im);
    }
}

static void test_png_filters_can_be_undone(void **state)
{
    (void)state;
    unsigned char line[60], above[60], out[61], trial[60];
    uint32_t seed = 3;
    int used[5] = {0};
    for (int round = 0; round < 2000; round++) {
        const size_t pixel = 1 + (size_t)round % 4;
        const int noise = round % 7 * 6 + 1;
        for (int i = 0; i < 60; i++) {
            above[i] = (unsigned char)(round + i * (round % 5) + noise * test_random(&seed));
            line[i] = (unsigned char)(round % 3 == 0   ? 255 * (round % 2) + 2 * test_random(&seed)
                                      : round % 3 == 1 ? above[i] + noise * test_random(&seed)
                                                       : round + i * (round % 5) + noise * test_random(&seed));
        }
        const int is_first = round % 11 == 0;
        retex_png_filter(out, trial, line, is_first ? NULL : above, 60, pixel);
        assert_true(out[0] < 5 && (!is_first || out[0] < 2));
        used[out[0]]++;
        for (size_t i = 0; i < 60; i++) { /* as the specification undoes them */
            const int a = i < pixel ? 0 : line[i - pixel], b = above[i], c = i < pixel ? 0 : above[i - pixel];
            const int p = a + b - c, pa = abs(p - a), pb = abs(p - b), pc = abs(p - c);
            const int paeth = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
            const int predicted[5] = {0, a, b, (a + b) / 2, paeth};
            assert_int_equal((unsigned char)(out[1 + i] + predicted[out[0]]), line[i]);
        }
    }
    for (int filter = 0; filter < 5; filter++)
        assert_true(used[filter] > 0);
}

/* The tables against the curve: around every step, and at floats all over the range. */
static void test_srgb_codes(void **state)
{
    (void)state;
    enum { COUNT = 1 << 16 };
    float *values = malloc(COUNT * sizeof *values);
    uint8_t *codes_8 = malloc(COUNT);
    uint16_t *codes_16 = malloc(COUNT * sizeof *codes_16);
    uint32_t bits = 0;
    for (int round = 0; round < 64; round++) {
        for (int i = 0; i < COUNT; i++)
            if (round < 4) { /* where the code changes, give or take */
                const double shown = (i + 0.5) / (COUNT - 1);
                const float near = (float)(shown <= 0.04045 ? shown / 12.92 : pow((shown + 0.055) / 1.055, 2.4));
                values[i] = round == 0 ? near : nextafterf(near, round == 1 ? 0 : 2);
            } else {
                bits += 1021; /* from 0 through all exponents, past NaN, to negative values */
                memcpy(&values[i], &bits, sizeof bits);
            }
        retex_srgb_codes_8(codes_8, values, COUNT);
        retex_srgb_codes_16(codes_16, values, COUNT);
        for (int i = 0; i < COUNT; i++) {
            assert_int_equal(codes_8[i], retex_srgb_code(values[i], 8));
            assert_int_equal(codes_16[i], retex_srgb_code(values[i], 16));
        }
        for (int i = 0; i + 7 <= COUNT; i += 7) { /* too few for vectors */
            uint8_t few[7];
            retex_srgb_codes_8(few, values + i, 7);
            assert_memory_equal(few, codes_8 + i, 7);
        }
    }
    assert_int_equal(retex_linear_code(NAN, 8), 0);
    assert_int_equal(retex_linear_code(2, 16), 65535);
    assert_int_equal(retex_linear_code(0.5f, 8), 128);
    free(values);
    free(codes_8);
    free(codes_16);
}

static void expect_old(const char *path)
{
    Bytes bytes = load(path);
    assert_int_equal(bytes.count, 3);
    assert_memory_equal(bytes.data, "old", 3);
    free(bytes.data);
}

static void test_given_up_or_failed(void **state)
{
    (void)state;
    static const char *const names[] = {"f.jpg", "f.png", "f.exr", "f.tif"};
    RetexImage im = {0};
    paint(&im, 50, 200, 3);
    for (int k = 0; k < 4; k++) {
        RetexPicture *picture;
        RetexError err = {0};
        const char *path = test_in_folder(names[k]), *full = test_in_folder("full");
        char other[600];
        test_must(retex_file_write(path, "old", 3, &err), &err);
        const int before = test_files_left();

        /* given up, after some strips */
        test_must(retex_picture_open(&picture, path, 50, 200, 3, NULL, &err), &err);
        test_must(retex_picture_rows(picture, 0, 64, im.pixels, &err), &err);
        test_must(retex_picture_close(&picture, 0, &err), &err);
        test_must(retex_picture_close(&picture, 1, &err), &err);
        expect_old(path);

        /* rows that are no strip, that come twice, that are missing */
        test_must(retex_picture_open(&picture, path, 50, 200, 3, NULL, &err), &err);
        test_must(retex_picture_rows(picture, 64, 128, im.pixels, &err), &err);
        assert_int_equal(retex_picture_close(&picture, 1, &err), RETEX_EINVAL);
        assert_non_null(strstr(err.message, "rows from 0 on are missing"));
        static const int wrong[][2] = {{1, 65}, {0, 63}, {192, 256}, {-64, 0}, {256, 320}, {0, 128}, {64, 128}};
        for (int i = 0; i < 7; i++) {
            test_must(retex_picture_open(&picture, path, 50, 200, 3, NULL, &err), &err);
            test_must(retex_picture_rows(picture, 64, 128, im.pixels, &err), &err);
            assert_int_equal(retex_picture_rows(picture, wrong[i][0], wrong[i][1], im.pixels, &err), RETEX_EINVAL);
            assert_int_equal(retex_picture_rows(picture, 0, 64, im.pixels, &err), RETEX_EINVAL);
            assert_int_equal(retex_picture_close(&picture, 1, &err), RETEX_EINVAL); /* what failed stays failed */
            assert_null(picture);
        }
        expect_old(path);
        assert_int_equal(test_files_left(), before);

        /* a full disk, and a folder that is not there */
        snprintf(other, sizeof other, "%s%s", full, strrchr(names[k], '.'));
        assert_int_equal(symlink("/dev/full", other), 0);
        assert_int_equal(retex_image_write(&im, other, NULL, 1, &err), RETEX_EIO);
        assert_non_null(strstr(err.message, "No space left on device"));
        assert_int_equal(unlink(other), 0);
        snprintf(other, sizeof other, "/nowhere/at/all/%s", names[k]);
        assert_int_equal(retex_picture_open(&picture, other, 50, 200, 3, NULL, &err), RETEX_EIO);
        assert_null(picture);
        assert_non_null(strstr(err.message, "No such file or directory"));
        assert_int_equal(test_files_left(), before);
    }
    retex_image_free(&im);
}

static void test_what_cannot_be(void **state)
{
    (void)state;
    RetexPicture *picture;
    RetexError err = {0};
    RetexWriteParams params = RETEX_WRITE_INIT;
    RetexImage im = {0};
    static const int shapes[][3] = {{0, 1, 3}, {1, 0, 3}, {65537, 1, 3}, {1, 65537, 3},
                                    {1, 1, 2}, {1, 1, 5}, {1, 1, 0}};
    for (int i = 0; i < 7; i++)
        assert_int_equal(
            retex_picture_open(&picture, test_in_folder("w.png"), shapes[i][0], shapes[i][1], shapes[i][2], NULL, &err),
            RETEX_EINVAL);
    assert_int_equal(retex_picture_open(&picture, test_in_folder("w.jpg"), 65501, 1, 3, NULL, &err), RETEX_EINVAL);
    assert_non_null(strstr(err.message, "a JPEG has at most 65500 x 65500 pixels"));
    params.quality = 0;
    assert_int_equal(retex_picture_open(&picture, test_in_folder("w.jpg"), 1, 1, 3, &params, &err), RETEX_EINVAL);
    assert_int_equal(retex_image_write(&im, test_in_folder("w.jpg"), NULL, 1, &err), RETEX_EINVAL);
    /* found out by whoever waits for the bridge */
    paint(&im, 2, 2, 3);
    params = (RetexWriteParams)RETEX_WRITE_INIT;
    params.view = "Bleu";
    assert_int_equal(retex_image_write(&im, test_in_folder("w.png"), &params, 1, &err), RETEX_ENOTFOUND);
    assert_non_null(strstr(err.message, "has no view 'Bleu'"));
    assert_int_equal(retex_image_write(&im, test_in_folder("w.xyz"), NULL, 1, &err), RETEX_EINVAL);
    assert_int_equal(access(test_in_folder("w.png"), F_OK), -1);
    retex_image_free(&im);
}

/* JPEG, PNG and EXR must not wait for OpenImageIO, unless their colours ask for it; in a child, with no bridge. */
static void test_no_bridge_is_needed(void **state)
{
    (void)state;
    pid_t child = fork();
    if (child == 0) {
        RetexImage im = {0};
        RetexWriteParams params = RETEX_WRITE_INIT;
        RetexError err = {0};
        int failed = 0;
        setenv("RETEX_BRIDGE", "/nowhere/at/all.so", 1);
        unsetenv("OCIO");
        paint(&im, 5, 5, 3);
        failed |= retex_image_write_check(test_in_folder("n.png"), NULL, &err);
        failed |= retex_image_write(&im, test_in_folder("n.png"), NULL, 1, &err);
        failed |= retex_image_write(&im, test_in_folder("n.jpg"), NULL, 1, &err);
        failed |= retex_image_write(&im, test_in_folder("n.exr"), NULL, 1, &err);
        failed |= retex_image_write(&im, test_in_folder("n.tif"), NULL, 1, &err);
        failed |= retex_image_write(&im, test_in_folder("n.tga"), NULL, 1, &err) != RETEX_EUNSUPPORTED;
        params.view = "Raw";
        failed |= retex_image_write(&im, test_in_folder("n.png"), &params, 1, &err) != RETEX_EUNSUPPORTED;
        setenv("OCIO", "/nowhere/config.ocio", 1);
        failed |= retex_image_write(&im, test_in_folder("n.jpg"), NULL, 1, &err) != RETEX_EUNSUPPORTED;
        _exit(failed != 0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_bridge_is_needed), /* first: nothing has loaded the bridge yet */
        cmocka_unit_test(test_any_order_and_threads),
        cmocka_unit_test(test_memory_is_the_file),
        cmocka_unit_test(test_pixels_are_those_of_one_go),
        cmocka_unit_test(test_exr_is_that_of_sets),
        cmocka_unit_test(test_exr_of_any_light),
        cmocka_unit_test(test_jpeg_is_plain),
        cmocka_unit_test(test_png_says_its_colors),
        cmocka_unit_test(test_png_filters_can_be_undone),
        cmocka_unit_test(test_srgb_codes),
        cmocka_unit_test(test_given_up_or_failed),
        cmocka_unit_test(test_what_cannot_be),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
