/* Parallelograms: the filter for one agrees with a simple integral of the point look-up, the kernels for many agree
 * with it and among each other, and the quarters of a pixel make up the whole. */
#include "lib_filter.h"
#include "lib_test.h"
#include "texture/batch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { COUNT = 2000 };

typedef struct Footprints {
    float uv[3 * COUNT], axes[4 * COUNT], rgba[4 * COUNT], other[4 * COUNT];
} Footprints;
static Footprints footprints; /* of the test that runs */

static RetexTexture *make_texture(int width, int height, uint32_t seed, int wrap_u, int wrap_v, double rotate)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexImage im = {0};
    RetexTexture *texture;
    RetexError err = {0};
    spec.wrap[0] = (RetexWrap)wrap_u;
    spec.wrap[1] = (RetexWrap)wrap_v;
    spec.rotate = rotate;
    test_random_image(&im, width, height, 4, seed, 0, 1);
    test_must(retex_texture_create(&texture, &im, &spec, 0, &err), &err);
    retex_image_free(&im);
    return texture;
}

/* Two sides, in texels of an image of that size, turned against each other by at least a sixth of a half turn. */
static void random_sides(double sides[2][2], const int size[2], double least, double most, double aspect,
                         uint32_t *seed)
{
    double longer = least * pow(most / least, test_random(seed)), angle = 2 * M_PI * test_random(seed);
    const double shorter = longer * pow(aspect, -test_random(seed));
    for (int k = 0; k < 2; k++) {
        sides[k][0] = (k ? shorter : longer) * cos(angle) / size[0];
        sides[k][1] = (k ? shorter : longer) * sin(angle) / size[1];
        angle += M_PI * (1 + 4 * test_random(seed)) / 6 * (test_random(seed) < 0.5 ? -1 : 1);
    }
}

/* The point look-up averaged over a parallelogram: premultiplied. */
static void integrate(const RetexTexture *texture, double u, double v, const double sides[2][2], int side,
                      double rgba[4])
{
    double sum[4] = {0, 0, 0, 0};
    for (int i = 0; i < side; i++)
        for (int j = 0; j < side; j++) {
            const double s = (i + 0.5) / side - 0.5, t = (j + 0.5) / side - 0.5;
            float point[4];
            retex_texture_point(texture, u + s * sides[0][0] + t * sides[1][0], v + s * sides[0][1] + t * sides[1][1],
                                point);
            for (int k = 0; k < 4; k++)
                sum[k] += (double)point[k] * (k < 3 ? (double)point[3] : 1);
        }
    for (int k = 0; k < 4; k++)
        rgba[k] = sum[k] / (side * side);
}

/* White noise, all wraps, any orientation, upright too. */
static void test_integral(void **state)
{
    (void)state;
    static const int sizes[][2] = {{64, 64}, {45, 27}, {64, 9}, {128, 100}};
    uint32_t seed = 3;
    double worst = 0, sum = 0;
    int count = 0;
    for (int n = 0; n < 4 * 16; n++) {
        const int *size = sizes[n / 16];
        RetexTexture *t = make_texture(size[0], size[1], (uint32_t)n, n % 4, n / 4 % 4, n % 3 * 30);
        for (int i = 0; i < 12; i++) {
            double sides[2][2], u = 1.4 * test_random(&seed) - 0.2, v = 1.4 * test_random(&seed) - 0.2, want[4];
            float got[4];
            random_sides(sides, size, 0.3, 20, 6, &seed);
            if (i % 4 == 0)
                sides[0][1] = sides[1][0] = 0;
            if (i % 8 == 4)
                sides[0][0] = sides[1][1] = 0;
            filter_parallelogram(t, u, v, sides, got);
            integrate(t, u, v, sides, 100, want);
            for (int k = 0; k < 4; k++, count++) {
                const double e = fabs((double)got[k] * (k < 3 ? (double)got[3] : 1) - want[k]);
                worst = e > worst ? e : worst;
                sum += e;
            }
        }
        retex_texture_close(&t);
    }
    print_message("white noise of 0..1: off by %.5f, %.4f at worst\n", sum / count, worst);
    assert_true(sum / count < 0.0007);
    assert_true(worst < 0.02);
}

/* No parallelogram is the point; one without area is a line; however large it is, the result is a colour. */
static void test_limits(void **state)
{
    (void)state;
    static const int sizes[][2] = {{64, 64}, {37, 23}, {100, 1}, {1, 9}, {1, 1}};
    static const double large[] = {3, 500, 1e6, 1e30, 1e300};
    uint32_t seed = 11;
    for (int n = 0; n < 5 * 16; n++) {
        const int *size = sizes[n / 16], repeats = n % 4 <= RETEX_WRAP_MIRROR && n / 4 % 4 <= RETEX_WRAP_MIRROR;
        RetexTexture *t = make_texture(size[0], size[1], 7, n % 4, n / 4 % 4, 0);
        const double none[2][2] = {{0, 0}, {0, 0}}, unit = 3.0 / size[0];
        float a[4], b[4];
        for (int i = 0; i < 20; i++) {
            const double u = 0.2 + 0.6 * test_random(&seed), v = 0.2 + 0.6 * test_random(&seed);
            const double line[2][2] = {{unit, unit}, {0, 0}}, thin[2][2] = {{unit, unit}, {1e-9, -1e-9}};
            double want[4];
            retex_texture_point(t, u, v, a);
            filter_parallelogram(t, u, v, none, b);
            assert_memory_equal(a, b, sizeof a);
            filter_parallelogram(t, u, v, line, a);
            filter_parallelogram(t, u, v, thin, b);
            integrate(t, u, v, line, 60, want);
            for (int k = 0; k < 4 && repeats; k++) {
                assert_float_equal(a[k] * (k < 3 ? a[3] : 1), (float)want[k], 0.02f);
                assert_float_equal(a[k], b[k], 1e-3f);
            }
        }
        for (int i = 0; i < 5; i++) {
            filter_parallelogram(t, 0.3, 0.2, (const double[2][2]){{large[i], 0}, {large[i] / 3, large[i]}}, b);
            for (int k = 0; k < 4; k++)
                assert_true(isfinite(b[k]) && b[k] >= 0 && b[k] <= 1.0001f);
        }
        retex_texture_close(&t);
    }
}

static void scatter(const int size[2], double least, double most, double aspect, uint32_t seed)
{
    for (int i = 0; i < COUNT; i++) {
        double sides[2][2];
        random_sides(sides, size, least, most, aspect, &seed);
        for (int k = 0; k < 4; k++)
            footprints.axes[4 * i + k] = (float)sides[k / 2][k % 2];
        for (int k = 0; k < 2; k++)
            footprints.uv[3 * i + k] = (float)(2 * test_random(&seed) - 0.5);
        footprints.uv[3 * i + 2] = i % 10 ? 1 : 0;
    }
}

/* The kernels of all processors, in rows and alone. */
static void test_same_bits(void **state)
{
    (void)state;
    static const int sizes[][2] = {{64, 64}, {45, 27}, {300, 7}, {1, 40}, {1, 1}, {512, 256}};
    for (int n = 0; n < 6 * 16; n++) {
        const int *size = sizes[n / 16];
        RetexTexture *t = make_texture(size[0], size[1], (uint32_t)n, n % 4, n / 4 % 4, 0);
        const RetexTextureFilter shape = (RetexTextureFilter)(RETEX_TEXTURE_PARALLELOGRAM + n % 5);
        scatter(size, 0.1, 60, 40, (uint32_t)n);
        retex_texture_filter(t, shape, footprints.uv, footprints.axes, 4, COUNT, footprints.rgba, 4);
        for (int k = 0; k <= (int)retex_cpu_level(); k++) {
            retex_texture_filter_batches(retex_texture_batch_kernels[k], t, shape, footprints.uv, footprints.axes, 4,
                                         COUNT, footprints.other, 4);
            assert_memory_equal(footprints.rgba, footprints.other, sizeof footprints.rgba);
        }
        for (size_t f = 0; f < COUNT; f += 37) {
            float alone[4];
            retex_texture_filter(t, shape, footprints.uv + 3 * f, footprints.axes + 4 * f, 4, 1, alone, 4);
            assert_memory_equal(footprints.rgba + 4 * f, alone, sizeof alone);
        }
        retex_texture_close(&t);
    }
}

/* On white noise, which every coarse level shows, and where a texel is larger than the parallelograms. */
static void test_many_are_as_one(void **state)
{
    (void)state;
    static const int size[2] = {512, 384};
    static const double ranges[][2] = {{0.1, 2}, {2, 8}, {8, 120}};
    for (int n = 0; n < 3 * 4; n++) {
        RetexTexture *t = make_texture(size[0], size[1], 5, n % 4, n % 4, n % 2 * 20);
        double squares = 0;
        int count = 0;
        scatter(size, ranges[n / 4][0], ranges[n / 4][1], 8, (uint32_t)n);
        retex_texture_filter(t, RETEX_TEXTURE_PARALLELOGRAM, footprints.uv, footprints.axes, 4, COUNT, footprints.rgba,
                             4);
        for (int i = 0; i < COUNT; i++) {
            const float *uv = footprints.uv + 3 * i, *axes = footprints.axes + 4 * i, *is = footprints.rgba + 4 * i;
            const double sides[2][2] = {{(double)axes[0], (double)axes[1]}, {(double)axes[2], (double)axes[3]}};
            float should[4] = {0, 0, 0, 0};
            if (uv[2] > 0)
                filter_parallelogram(t, (double)uv[0], (double)uv[1], sides, should);
            for (int k = 0; k < 4; k++, count++) {
                const double e = (double)(is[k] - should[k]) * (k < 3 ? (double)should[3] : 1);
                squares += e * e;
            }
        }
        const double psnr = -10 * log10(squares / count + 1e-20);
        print_message("sides of %g to %g texels: %.1f dB\n", ranges[n / 4][0], ranges[n / 4][1], psnr);
        assert_true(psnr > 52);
        retex_texture_close(&t);
    }
}

/* The quarters of a pixel are its parts, in the order of RetexFootprint. */
static void test_quadrants(void **state)
{
    (void)state;
    static const int size[2] = {64, 64};
    RetexTexture *t = make_texture(size[0], size[1], 5, 0, 0, 0);
    scatter(size, 0.5, 12, 3, 1);
    for (int i = 1; i < COUNT; i += 7) {
        const float *uv = footprints.uv + 3 * i, *axes = footprints.axes + 4 * i;
        float rgba[5][4];
        if (!(uv[2] > 0))
            continue;
        for (int k = 0; k < 5; k++)
            retex_texture_filter(t, (RetexTextureFilter)(RETEX_TEXTURE_PARALLELOGRAM + k), uv, axes, 4, 1, rgba[k], 4);
        for (int c = 0; c < 4; c++) {
            float sum = 0;
            for (int k = 1; k < 5; k++)
                sum += rgba[k][c] * (c < 3 ? rgba[k][3] : 1) / 4;
            assert_float_equal(sum, rgba[0][c] * (c < 3 ? rgba[0][3] : 1), 0.02f);
        }
        for (int k = 1; k < 5; k++) {
            const double right = k % 2 ? -0.25 : 0.25, down = k > 2 ? 0.25 : -0.25;
            const double sides[2][2] = {{(double)axes[0] / 2, (double)axes[1] / 2},
                                        {(double)axes[2] / 2, (double)axes[3] / 2}};
            float want[4];
            filter_parallelogram(t, (double)uv[0] + right * (double)axes[0] + down * (double)axes[2],
                                        (double)uv[1] + right * (double)axes[1] + down * (double)axes[3], sides, want);
            for (int c = 0; c < 4; c++)
                assert_float_equal(rgba[k][c] * (c < 3 ? rgba[k][3] : 1), want[c] * (c < 3 ? want[3] : 1), 0.01f);
        }
    }
    retex_texture_close(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_integral),        cmocka_unit_test(test_limits),    cmocka_unit_test(test_same_bits),
        cmocka_unit_test(test_many_are_as_one), cmocka_unit_test(test_quadrants),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
