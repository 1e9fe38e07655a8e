/* The codecs of packs: JPEG of levels, planes. */
#include "lib_test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "pack/open.h"
#include "pack/strips.h"
#include "pack/jpeg_kernel.h"
#include "pack/plan.h"
#include "pack/restore.h"

enum { JPEG_WIDTH = 75, JPEG_HEIGHT = 141 }; /* no multiples of a block, nor of a strip */

/* Waves of colours up to 0.9, or far above white. */
static void make_waves(float *values, int channels, int is_bright)
{
    for (size_t i = 0; i < (size_t)JPEG_WIDTH * JPEG_HEIGHT * (size_t)channels; i++) {
        const double x = (double)(i / (size_t)channels % JPEG_WIDTH) / JPEG_WIDTH;
        values[i] = (float)((is_bright ? 40 : 0.9) * (0.5 + 0.5 * sin(9 * x)) * (1 - 0.1 * (double)(i % 3)));
    }
}

/* A level of the curve is that of the value which it came from. */
static void test_curve_there_and_back(void **state)
{
    (void)state;
    const RetexPackCurve curve = retex_pack_curve(1, 255);
    for (double value = 0; value < 100; value += 0.37) {
        const double level = retex_pack_curve_level(&curve, 0, value);
        assert_float_equal(retex_pack_curve_value(&curve, 0, level), value, 1e-4 * fmax(value, 1));
    }
}

/* Decodes the rows of one strip: a file of the header, and of its slice, which begins at `at`. */
static void decode_strip(RetexPackJpegDecoder *decoder, const RetexPackJpeg *jpeg, int strip, size_t at, int rows,
                         int channels, const RetexPackCurve *curve, float *values)
{
    RetexError err = {0};
    const size_t header = jpeg->slice_bytes[0], bytes = jpeg->slice_bytes[1 + strip];
    unsigned char *file = malloc(header + bytes);
    memcpy(file, jpeg->data, header);
    memcpy(file + header, jpeg->data + at, bytes);
    test_must(retex_pack_jpeg_open_strip(decoder, file, header, header + bytes, JPEG_WIDTH, rows, channels, curve,
                                         &err), &err);
    free(file);
    for (int row = 0; 8 * row < rows; row++)
        test_must(retex_pack_jpeg_decode_blocks(decoder, row, values + 8 * row * JPEG_WIDTH * channels, &err), &err);
    assert_int_not_equal(retex_pack_jpeg_decode_blocks(decoder, (rows + 7) / 8, values, &err), 0); /* there is none */
}

/* Coefficients are rounded to levels, so by at most 1/2. The transform is orthonormal: levels are off by 1/sqrt(12) in
 * the mean, and by at most 1/2 times 8, where all 64 errors of a block add up. */
static void expect_levels(int channels, int is_bright)
{
    const RetexPackCurve curve = retex_pack_curve(1, 255);
    const int strips = (JPEG_HEIGHT + RETEX_PACK_STRIP_ROWS - 1) / RETEX_PACK_STRIP_ROWS;
    const size_t row = (size_t)JPEG_WIDTH * (size_t)channels, count = row * JPEG_HEIGHT;
    float *levels = malloc(count * sizeof *levels), *back = malloc(count * sizeof *back);
    RetexPackJpeg jpeg;
    RetexPackJpegDecoder *decoder;
    RetexError err = {0};
    double sum = 0;
    make_waves(levels, channels, is_bright);
    for (size_t i = 0; i < count; i++)
        levels[i] = (float)retex_pack_curve_level(&curve, 0, (double)levels[i]);
    test_must(retex_pack_jpeg_encode(&jpeg, levels, JPEG_WIDTH, JPEG_HEIGHT, channels, 1, &err), &err);
    test_must(retex_pack_jpeg_decoder_create(&decoder, &err), &err);
    assert_int_equal(jpeg.nslices, 1 + strips);
    size_t at = jpeg.slice_bytes[0];
    for (int strip = 0; strip < strips; at += jpeg.slice_bytes[1 + strip++]) {
        const int y = strip * RETEX_PACK_STRIP_ROWS, left = JPEG_HEIGHT - y;
        decode_strip(decoder, &jpeg, strip, at, left < RETEX_PACK_STRIP_ROWS ? left : RETEX_PACK_STRIP_ROWS, channels,
                     &curve, back + (size_t)y * row);
    }
    for (size_t i = 0; i < count; i++) {
        const double off = retex_pack_curve_level(&curve, 0, (double)back[i]) - (double)levels[i];
        assert_true(fabs(off) < 4);
        sum += off * off;
    }
    assert_true(sqrt(sum / (double)count) < 1 / sqrt(12));
    retex_pack_jpeg_decoder_close(&decoder);
    retex_pack_jpeg_free(&jpeg);
    free(levels);
    free(back);
}

static void test_jpeg_keeps_levels(void **state)
{
    (void)state;
    for (int channels = 1; channels <= 3; channels += 2) {
        expect_levels(channels, 0);
        expect_levels(channels, 1);
    }
}

/* Coefficients of all sizes, and blocks that have only their first, by every kernel: the bits of the reference. */
static void test_jpeg_kernels_agree(void **state)
{
    (void)state;
    enum { BLOCKS = 9, WIDTH = 8 * BLOCKS, MOST = 3 * WIDTH };
    static int16_t coefficients[64 * BLOCKS];
    static float steps[64], samples[2][8 * WIDTH], values[2][8 * MOST];
    static float share[RETEX_PACK_LEVEL_ENTRIES + 2];
    const RetexPackLevels levels = {.scale = 3.7f, .white = {1.3f, 0.8f, 2.1f}, .share = share};
    uint32_t seed = 7;
    for (int i = 0; i < RETEX_PACK_LEVEL_ENTRIES + 2; i++)
        share[i] = (float)(i * i) / 1000;
    const RetexPackJpegKernels *plain = &retex_pack_jpeg_kernels[RETEX_CPU_BASELINE];
    for (int round = 0; round < 200; round++) {
        for (int i = 0; i < 64 * BLOCKS; i++)
            coefficients[i] = (int16_t)(i % 64 && (i / 64 + round) % 2 ? 0 : exp(8 * test_random(&seed)) - 40);
        for (int i = 0; i < 64; i++)
            steps[i] = (float)(1 + (int)(40 * test_random(&seed)));
        plain->inverse(samples[0], WIDTH, coefficients, BLOCKS, steps);
        const int width = WIDTH - round % 9; /* not only whole vectors */
        const float *planes = samples[0];
        plain->colors(values[0], planes, planes + WIDTH, planes + 2 * WIDTH, width, &levels);
        plain->greys(values[0] + MOST, planes, width, &levels);
        for (int k = 0; k <= (int)retex_cpu_level(); k++) {
            const RetexPackJpegKernels *kernel = &retex_pack_jpeg_kernels[k];
            kernel->inverse(samples[1], WIDTH, coefficients, BLOCKS, steps);
            for (int i = 0; i < 8 * WIDTH; i++)
                assert_true(samples[1][i] == samples[0][i]); /* zeros may have a sign */
            memset(values[1], 0, sizeof values[1]);
            kernel->colors(values[1], planes, planes + WIDTH, planes + 2 * WIDTH, width, &levels);
            kernel->greys(values[1] + MOST, planes, width, &levels);
            assert_memory_equal(values[1], values[0], 3 * (size_t)width * sizeof(float));
            assert_memory_equal(values[1] + MOST, values[0] + MOST, (size_t)width * sizeof(float));
        }
    }
}

/* The fast way to restore planes against the plain one, of every predictor, whatever is missing. */
static void test_planes_restored_alike(void **state)
{
    (void)state;
    enum { WIDTH = 83, ROWS = 17, ALL = WIDTH * ROWS };
    static int32_t numbers[2][ALL];
    static unsigned char present[ALL], shift[ALL], residuals[4 * ALL + 4], codes[ALL];
    static RetexRowSpan run[(WIDTH / 2 + 1) * ROWS];
    RetexPackRuns runs = {.run = run};
    uint32_t seed = 7;
    assert_int_equal(retex_pack_runs_bound(WIDTH, ROWS), sizeof run / sizeof *run);
    for (int round = 0; round < 3 * 3 * 4 * PREDICTORS * 3; round++) {
        const int bits = 8 << round % 3, bytes = 1 << round / 3 % 3, holes = round / 9 % 2, steps = round / 18 % 2;
        if (bits == 8 && (bytes > 1 || steps)) /* there is no such plane */
            continue;
        const RetexPackPredictor predictor = (RetexPackPredictor)(round / 36 % PREDICTORS);
        const int rare = round / (36 * PREDICTORS); /* how often a run of what matters ends */
        for (int i = 0; i < ALL; i++) {
            const int change = i % WIDTH == 0 || test_random(&seed) < (rare == 0 ? 0.5 : rare == 1 ? 0.05 : 0.0);
            present[i] = change || i == 0 ? test_random(&seed) < 0.6 : present[i - 1];
            shift[i] = (unsigned char)(test_random(&seed) * 12);
        }
        for (size_t i = 0; i < sizeof residuals; i++)
            residuals[i] = (unsigned char)(test_random(&seed) * 256);
        retex_pack_find_runs(&runs, present, WIDTH, ROWS);
        for (int k = 0; k < 2; k++) {
            RetexPackPlane plane = {WIDTH,      ROWS,  bits, holes ? present : NULL, steps ? shift : NULL,
                                    numbers[k], &runs, codes};
            memset(numbers[k], 0x5a, sizeof numbers[k]); /* what does not matter stays */
            memset(codes, 0x5a, sizeof codes);
            (k ? retex_pack_restore : retex_pack_restore_reference)(&plane, predictor, residuals, bytes);
        }
        for (int i = 0; i < ALL && bits == 8; i++)
            if (holes && !present[i])
                assert_int_equal(codes[i], 0x5a);
            else
                numbers[1][i] = codes[i];
        assert_memory_equal(numbers[0], numbers[1], sizeof numbers[0]);
        size_t count = 0;
        for (int i = 0; i < ALL; i++) {
            count += present[i];
            assert_true(!holes || present[i] || numbers[1][i] == 0x5a5a5a5a);
        }
        assert_int_equal(runs.pixels, count);
    }
}

/* Any numbers come back, whatever is missing and whatever their steps, by every width. */
/* Codes are the nearest ones: by the logarithm, the value or the angle. Only 0 has the code that means 0. */
static void test_codes_are_the_nearest(void **state)
{
    (void)state;
    RetexPackMap log_map = {RETEX_PACK_MAP_LOG, 0x1p-10, 16, {0}}, linear = {RETEX_PACK_MAP_LINEAR, 1.0 / 200, 0, {0}},
                 angle = {RETEX_PACK_MAP_ANGLE, 0, 100, {0}};
    retex_pack_map_fill(&log_map);
    retex_pack_map_fill(&linear);
    retex_pack_map_fill(&angle);
    for (int k = 0; k < 2000; k++) {
        const float values[3] = {(float)(0x1p-10 * exp2(15.0 * k / 2000)), (float)((k + 0.3) / 2000),
                                 (float)(k / 1000.0 - 1)};
        const RetexPackMap *const maps[3] = {&log_map, &linear, &angle};
        for (int m = 0; m < 3; m++) {
            int32_t code;
            float back;
            retex_pack_map_numbers(&code, &values[m], 1, 1, maps[m], RETEX_HALF);
            retex_pack_map_samples(&back, 1, &code, 1, maps[m], RETEX_HALF);
            const double v = (double)values[m], b = (double)back;
            const double off = m == 0   ? fabs(log2(b / v)) * 16
                               : m == 1 ? fabs(b - v) * 200
                                        : fabs(asin(b) - asin(v)) * 2 / acos(-1) * 100;
            assert_true(code >= 0 && code < RETEX_PACK_CODES && (m == 2 || code > 0));
            assert_true(off < 0.5001 || (m == 1 && code == 1)); /* what is not 0 is not coded so */
        }
    }
    const float none = 0;
    int32_t code;
    retex_pack_map_numbers(&code, &none, 1, 1, &log_map, RETEX_HALF);
    assert_int_equal(code, 0);
    retex_pack_map_numbers(&code, &none, 1, 1, &linear, RETEX_HALF);
    assert_int_equal(code, 0);
}

static void test_planes_keep_numbers(void **state)
{
    (void)state;
    enum { WIDTH = 37, ROWS = 29, ALL = WIDTH * ROWS };
    uint32_t seed = 1;
    int32_t numbers[ALL], back[ALL];
    unsigned char present[ALL], shift[ALL], codes[ALL];
    RetexRowSpan run[(WIDTH / 2 + 1) * ROWS];
    RetexPackRuns runs = {.run = run};
    for (int round = 0; round < 60; round++) {
        const int bits = round % 3 == 0 ? 8 : round % 3 == 1 ? 16 : 32, smooth = round / 3 % 2;
        for (int i = 0; i < ALL; i++) {
            present[i] = test_random(&seed) < 0.7;
            shift[i] = (unsigned char)(test_random(&seed) * 12);
            const double wide = ldexp(test_random(&seed), bits == 32 ? 30 : bits);
            const double value = smooth ? 40 + i % WIDTH + i / WIDTH + 3 * test_random(&seed) : wide;
            numbers[i] = bits == 8 ? (int32_t)value : (int32_t)(value - ldexp(1, bits == 32 ? 29 : bits - 1));
        }
        const int holes = round / 6 % 2, steps = bits == 32 && round / 12 % 2;
        retex_pack_find_runs(&runs, present, WIDTH, ROWS);
        RetexPackPlane plane = {WIDTH, ROWS, bits, holes ? present : NULL, steps ? shift : NULL, numbers, &runs, NULL};
        const size_t room = retex_pack_plane_bound(&plane);
        unsigned char *data = malloc(room), *scratch = malloc(2 * room);
        const long bytes = retex_pack_plane_encode(data, &plane, scratch, 5);
        assert_true(bytes > 0);
        plane.numbers = back;
        plane.codes = codes;
        assert_true(retex_pack_plane_decode(&plane, data, (size_t)bytes, scratch));
        for (int i = 0; i < ALL && bits == 8; i++)
            back[i] = codes[i];
        for (int i = 0; i < ALL; i++) /* encoding rounds them to their steps, and clears what is missing */
            assert_int_equal(holes && !present[i] ? 0 : back[i], numbers[i]);
        assert_false(retex_pack_plane_decode(&plane, data, (size_t)bytes - 1, scratch));
        free(data);
        free(scratch);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_curve_there_and_back),  cmocka_unit_test(test_jpeg_keeps_levels),
        cmocka_unit_test(test_jpeg_kernels_agree),
        cmocka_unit_test(test_planes_restored_alike), cmocka_unit_test(test_codes_are_the_nearest),
        cmocka_unit_test(test_planes_keep_numbers),
    };
    return cmocka_run_group_tests_name("pack codecs", tests, NULL, NULL);
}
