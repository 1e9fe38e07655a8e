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

/* Levels come back within a step and a bit, also far above white, also where the size is no multiple of anything. */
static void test_jpeg_keeps_levels(void **state)
{
    (void)state;
    const RetexPackCurve curve = retex_pack_curve(1, 255);
    const int width = 75, height = 141;
    for (int channels = 1; channels <= 3; channels += 2)
        for (int bright = 0; bright < 2; bright++) {
            const size_t count = (size_t)(width * height * channels);
            float *values = malloc(count * sizeof *values), *levels = malloc(count * sizeof *levels);
            float *back = malloc((size_t)(width * 64 * channels) * sizeof *back);
            for (size_t i = 0; i < count; i++) {
                const double x = (double)(i / (size_t)channels % (size_t)width) / width;
                values[i] = (float)((bright ? 40 : 0.9) * (0.5 + 0.5 * sin(9 * x)) * (1 - 0.1 * (double)(i % 3)));
                levels[i] = (float)retex_pack_curve_level(&curve, 0, (double)values[i]);
                assert_true(fabs(retex_pack_curve_value(&curve, 0, (double)levels[i]) - (double)values[i]) <
                            1e-4 * fmax((double)values[i], 1));
            }
            RetexPackJpeg jpeg;
            RetexPackJpegDecoder *decoder;
            RetexError err = {0};
            test_must(retex_pack_jpeg_encode(&jpeg, levels, width, height, channels, 1, &err), &err);
            test_must(retex_pack_jpeg_decoder_create(&decoder, &err), &err);
            assert_int_equal(jpeg.nslices, 4);
            size_t at = jpeg.slice_bytes[0];
            double sum = 0;
            for (int strip = 0; strip < 3; strip++) {
                const int rows = strip < 2 ? 64 : height - 128;
                const size_t piece = jpeg.slice_bytes[1 + strip];
                unsigned char *file = malloc(jpeg.slice_bytes[0] + piece);
                memcpy(file, jpeg.data, jpeg.slice_bytes[0]);
                memcpy(file + jpeg.slice_bytes[0], jpeg.data + at, piece);
                at += piece;
                test_must(retex_pack_jpeg_open_strip(decoder, file, jpeg.slice_bytes[0], jpeg.slice_bytes[0] + piece,
                                                     width, rows, channels, &curve, &err),
                          &err);
                free(file);
                for (int row = 0; 8 * row < rows; row++)
                    test_must(retex_pack_jpeg_decode_blocks(decoder, row, back + 8 * row * width * channels, &err),
                              &err);
                assert_int_not_equal(retex_pack_jpeg_decode_blocks(decoder, (rows + 7) / 8, back, &err), 0);
                for (int i = 0; i < width * rows * channels; i++) {
                    const double off = retex_pack_curve_level(&curve, 0, (double)back[i]) -
                                       (double)levels[(size_t)strip * (size_t)(64 * width * channels) + (size_t)i];
                    assert_true(fabs(off) < 6);
                    sum += off * off;
                }
            }
            assert_true(sqrt(sum / (double)count) < 0.25);
            retex_pack_jpeg_decoder_close(&decoder);
            retex_pack_jpeg_free(&jpeg);
            free(values);
            free(levels);
            free(back);
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
        cmocka_unit_test(test_jpeg_keeps_levels),     cmocka_unit_test(test_jpeg_kernels_agree),
        cmocka_unit_test(test_planes_restored_alike), cmocka_unit_test(test_codes_are_the_nearest),
        cmocka_unit_test(test_planes_keep_numbers),
    };
    return cmocka_run_group_tests_name("pack codecs", tests, NULL, NULL);
}
