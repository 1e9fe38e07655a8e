/* Metrics: known values, FLIP compared with a direct two-dimensional filter, threads, and refused input. */
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "metrics/flip.h"

static RetexMetrics compare(const RetexImage *a, const RetexImage *b)
{
    RetexMetrics m;
    RetexError err = {0};
    test_must(retex_metrics(&m, a, b, 2, &err), &err);
    return m;
}

static void fill(RetexImage *im, float value)
{
    for (size_t i = 0; i < (size_t)im->width * (size_t)im->height * (size_t)im->channels; i++)
        im->pixels[i] = value;
}

static void test_identical_pictures_do_not_differ(void **state)
{
    (void)state;
    RetexImage a = {0};
    test_random_image(&a, 61, 47, 3, 1, 0, 4);
    RetexMetrics m = compare(&a, &a);
    assert_true(m.psnr == 120 && m.relmse == 0 && m.mae == 0 && m.max_abs == 0 && m.max_rel == 0);
    assert_true(m.flip_mean == 0 && m.flip_p99 == 0 && m.nonfinite == 0);
    retex_image_free(&a);
}

static void test_figures_of_a_constant_difference(void **state)
{
    (void)state;
    RetexImage a = {0}, b = {0};
    test_random_image(&a, 16, 16, 3, 1, 0, 0);
    test_random_image(&b, 16, 16, 3, 1, 0, 0);
    fill(&a, 0.003f); /* in the straight part of the sRGB curve: encodes as 12.92 * 0.003 */
    RetexMetrics m = compare(&a, &b);
    assert_float_equal(m.psnr, -20 * log10(12.92 * 0.003), 1e-4);
    assert_float_equal(m.relmse, 0.003 * 0.003 / 0.01, 1e-8);
    assert_float_equal(m.mae, 0.003, 1e-8);
    assert_float_equal(m.max_rel, 3, 1e-5);
    fill(&a, 1);
    fill(&b, 0.5f); /* sRGB 0.735357 */
    m = compare(&a, &b);
    assert_float_equal(m.psnr, -20 * log10(1 - 0.7353570), 1e-4);
    assert_float_equal(m.relmse, 0.25 / 0.26, 1e-7);
    assert_float_equal(m.max_rel, 1, 1e-7);
    fill(&a, 7); /* clipped for psnr only */
    m = compare(&a, &b);
    assert_float_equal(m.psnr, -20 * log10(1 - 0.7353570), 1e-4);
    assert_float_equal(m.mae, 6.5, 1e-6);
    retex_image_free(&a);
    retex_image_free(&b);
}

static void test_worst_pixel_is_found(void **state)
{
    (void)state;
    RetexImage a = {0}, b = {0};
    RetexError err = {0};
    test_random_image(&a, 40, 30, 3, 9, 0.2, 0.8);
    test_must(retex_image_copy(&b, &a, &err), &err);
    b.pixels[retex_image_index(&b, 31, 17) + 2] += 0.5f;
    b.pixels[retex_image_index(&b, 3, 20) + 1] += 0.4f;
    RetexMetrics m = compare(&a, &b);
    assert_int_equal(m.worst.x, 31);
    assert_int_equal(m.worst.y, 17);
    assert_int_equal(m.worst.channel, 'B');
    assert_float_equal(m.max_abs, 0.5, 1e-6);
    retex_image_free(&a);
    retex_image_free(&b);
}

static void test_nonfinite_samples_are_counted_and_left_out(void **state)
{
    (void)state;
    RetexImage a = {0}, b = {0};
    RetexError err = {0};
    test_random_image(&a, 40, 30, 3, 9, 0.2, 0.8);
    test_must(retex_image_copy(&b, &a, &err), &err);
    a.pixels[5] = NAN;
    b.pixels[100] = INFINITY;
    a.pixels[200] = b.pixels[200] = -INFINITY;
    RetexMetrics m = compare(&a, &b);
    assert_int_equal(m.nonfinite, 3);
    assert_true(m.psnr == 120 && m.relmse == 0 && m.mae == 0 && m.flip_mean == 0);
    retex_image_free(&a);
    retex_image_free(&b);
}

static void test_sizes_and_channels_must_agree(void **state)
{
    (void)state;
    RetexImage a = {0}, b = {0}, c = {0};
    RetexMetrics m;
    RetexError err = {0};
    test_random_image(&a, 8, 8, 3, 1, 0, 1);
    test_random_image(&b, 8, 9, 3, 1, 0, 1);
    test_random_image(&c, 8, 8, 4, 1, 0, 1);
    assert_int_equal(retex_metrics(&m, &a, &b, 1, &err), RETEX_EINVAL);
    assert_string_equal(err.message, "the pictures' sizes differ: 8 x 8 and 8 x 9");
    assert_int_equal(retex_metrics(&m, &a, &c, 1, &err), RETEX_EINVAL);
    retex_image_free(&a);
    retex_image_free(&b);
    retex_image_free(&c);
}

/* --- FLIP as the paper writes it: two-dimensional kernels, double precision --- */

enum { REACH = 10 };

static void reference_lab(double lab[3], const double rgb[3])
{
    static const double m[3][3] = {{0.4123865632529917, 0.35759149092062537, 0.18045049120356368},
                                   {0.21263682167732384, 0.7151829818412507, 0.07218019648142547},
                                   {0.019330620152483987, 0.11919716364020845, 0.9503725870054354}};
    double f[3];
    for (int i = 0; i < 3; i++) {
        double white = m[i][0] + m[i][1] + m[i][2];
        double t = (m[i][0] * rgb[0] + m[i][1] * rgb[1] + m[i][2] * rgb[2]) / white;
        f[i] = t > pow(6 / 29.0, 3) ? cbrt(t) : t / (3 * pow(6 / 29.0, 2)) + 4 / 29.0;
    }
    lab[0] = 116 * f[1] - 16;
    lab[1] = 0.01 * lab[0] * 500 * (f[0] - f[1]);
    lab[2] = 0.01 * lab[0] * 200 * (f[1] - f[2]);
}

static double reference_hyab(const double a[3], const double b[3])
{
    return fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]);
}

static double csf(double a1, double b1, double a2, double b2, int x, int y)
{
    double z = (x * x + y * y) / (67.0 * 67.0);
    return a1 * sqrt(M_PI / b1) * exp(-M_PI * M_PI * z / b1) + a2 * sqrt(M_PI / b2) * exp(-M_PI * M_PI * z / b2);
}

/* Weighted mean around (px, py) of one opponent channel; the filter is linear, so filtering linear RGB with that
 * channel's kernel and converting after is the same as the paper's order. */
static void filtered_rgb(double rgb[3], const RetexImage *im, int px, int py, const double s[5])
{
    double sum = 0;
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int y = -REACH; y <= REACH; y++)
        for (int x = -REACH; x <= REACH; x++) {
            int qx = px + x, qy = py + y;
            qx = qx < 0 ? 0 : qx >= im->width ? im->width - 1 : qx;
            qy = qy < 0 ? 0 : qy >= im->height ? im->height - 1 : qy;
            double w = csf(s[0], s[1], s[2], s[3], x, y);
            for (int c = 0; c < 3; c++)
                rgb[c] += w * fmin(fmax((double)im->pixels[retex_image_index(im, qx, qy) + (size_t)c], 0), 1);
            sum += w;
        }
    for (int c = 0; c < 3; c++)
        rgb[c] /= sum;
}

static void reference_color(double lab[3], const RetexImage *im, int px, int py)
{
    static const double kernels[3][5] = {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
    static const double m[3][3] = {{0.4123865632529917, 0.35759149092062537, 0.18045049120356368},
                                   {0.21263682167732384, 0.7151829818412507, 0.07218019648142547},
                                   {0.019330620152483987, 0.11919716364020845, 0.9503725870054354}};
    double n[3][3]; /* XYZ / white, filtered with each kernel */
    for (int k = 0; k < 3; k++) {
        double rgb[3];
        filtered_rgb(rgb, im, px, py, kernels[k]);
        for (int i = 0; i < 3; i++)
            n[k][i] = (m[i][0] * rgb[0] + m[i][1] * rgb[1] + m[i][2] * rgb[2]) / (m[i][0] + m[i][1] + m[i][2]);
    }
    double y = n[0][1], x = y + (n[1][0] - n[1][1]), z = y - (n[2][1] - n[2][2]);
    double xyz[3] = {x * 0.950428545, y, z * 1.088900371};
    double rgb[3] = {3.241003232976358 * xyz[0] - 1.537398969488785 * xyz[1] - 0.498615881996363 * xyz[2],
                     -0.969224252202516 * xyz[0] + 1.875929983695176 * xyz[1] + 0.041554226340085 * xyz[2],
                     0.055639419851975 * xyz[0] - 0.204011206123910 * xyz[1] + 1.057148977187533 * xyz[2]};
    for (int c = 0; c < 3; c++)
        rgb[c] = fmin(fmax(rgb[c], 0), 1);
    reference_lab(lab, rgb);
}

/* Length of the gradient that the paper's edge (0) or point (1) detector finds. */
static double reference_feature(const RetexImage *im, int px, int py, int point)
{
    double sd = 0.5 * 0.082 * 67, gradient[2] = {0, 0};
    int radius = (int)ceil(3 * sd);
    for (int axis = 0; axis < 2; axis++) {
        double positive = 0, negative = 0, sum[2] = {0, 0};
        for (int y = -radius; y <= radius; y++)
            for (int x = -radius; x <= radius; x++) {
                int along = axis ? y : x;
                double g = exp(-(x * x + y * y) / (2 * sd * sd));
                double w = point ? (along * along / (sd * sd) - 1) * g : -along * g;
                int qx = px + x, qy = py + y;
                qx = qx < 0 ? 0 : qx >= im->width ? im->width - 1 : qx;
                qy = qy < 0 ? 0 : qy >= im->height ? im->height - 1 : qy;
                const float *p = im->pixels + retex_image_index(im, qx, qy);
                double value = 0;
                static const double luminance[3] = {0.21263682167732384, 0.7151829818412507, 0.07218019648142547};
                for (int c = 0; c < 3; c++)
                    value += luminance[c] * fmin(fmax((double)p[c], 0), 1);
                positive += fmax(w, 0);
                negative += fmax(-w, 0);
                sum[w > 0] += fabs(w) * value;
            }
        gradient[axis] = sum[1] / positive - sum[0] / negative;
    }
    return hypot(gradient[0], gradient[1]);
}

static double reference_flip(const RetexImage *a, const RetexImage *b, int x, int y)
{
    double lab[2][3], green[3], blue[3];
    reference_color(lab[0], a, x, y);
    reference_color(lab[1], b, x, y);
    reference_lab(green, (const double[3]){0, 1, 0});
    reference_lab(blue, (const double[3]){0, 0, 1});
    double most = pow(reference_hyab(green, blue), 0.7), e = pow(reference_hyab(lab[0], lab[1]), 0.7);
    e = e < 0.4 * most ? e * 0.95 / (0.4 * most) : 0.95 + (e - 0.4 * most) / (most - 0.4 * most) * 0.05;
    double edge = fabs(reference_feature(a, x, y, 0) - reference_feature(b, x, y, 0));
    double point = fabs(reference_feature(a, x, y, 1) - reference_feature(b, x, y, 1));
    return pow(e, 1 - sqrt(fmax(edge, point) / sqrt(2)));
}

static void test_flip_equals_two_dimensional_filters(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 3; seed++) {
        RetexImage a = {0}, b = {0}, map = {0};
        RetexError err = {0};
        test_random_image(&a, 45, 37, 3, seed, -0.1, 1.1);
        test_random_image(&b, 45, 37, 3, seed + 7, 0, seed == 3 ? 0.05 : 0.9);
        for (int y = 10; y < 25; y++) /* something larger than a pixel */
            for (int x = 12; x < 30; x++)
                a.pixels[retex_image_index(&a, x, y) + 2] = 0.9f;
        test_must(retex_flip_map(&map, &a, &b, 2, &err), &err);
        for (int y = 0; y < 37; y += 3)
            for (int x = 0; x < 45; x += 2)
                assert_float_equal(map.pixels[y * 45 + x], reference_flip(&a, &b, x, y), 2e-4);
        retex_image_free(&a);
        retex_image_free(&b);
        retex_image_free(&map);
    }
}

static void test_flip_of_black_and_white(void **state)
{
    (void)state;
    RetexImage a = {0}, b = {0};
    test_random_image(&a, 33, 33, 3, 1, 0, 0);
    test_random_image(&b, 33, 33, 3, 1, 0, 0);
    fill(&b, 1);
    /* A lightness difference of 100 against green to blue, 203.3: (100/203.3)^0.7 = 0.6086, above the knee at 0.4. */
    RetexMetrics m = compare(&a, &b), back = compare(&b, &a);
    assert_float_equal(m.flip_mean, 0.95 + (0.6086 - 0.4) / 0.6 * 0.05, 5e-4);
    assert_float_equal(m.flip_p99, m.flip_mean, 5e-4);
    assert_true(m.flip_mean == back.flip_mean);
    retex_image_free(&a);
    retex_image_free(&b);
}

static void test_flip_grows_with_the_difference_and_stays_local(void **state)
{
    (void)state;
    double before = 0;
    for (int step = 1; step <= 4; step++) {
        RetexImage a = {0}, b = {0}, map = {0};
        RetexError err = {0};
        test_random_image(&a, 80, 60, 3, 1, 0.5, 0.5);
        test_must(retex_image_copy(&b, &a, &err), &err);
        for (int c = 0; c < 3; c++)
            b.pixels[retex_image_index(&b, 40, 30) + (size_t)c] += 0.1f * (float)step;
        test_must(retex_flip_map(&map, &a, &b, 2, &err), &err);
        assert_true(map.pixels[30 * 80 + 40] > before);
        before = map.pixels[30 * 80 + 40];
        assert_true(map.pixels[30 * 80 + 40 + 11] == 0 && map.pixels[(30 - 11) * 80 + 40] == 0);
        retex_image_free(&a);
        retex_image_free(&b);
        retex_image_free(&map);
    }
}

static void test_percentile_is_of_pixels(void **state)
{
    (void)state;
    RetexImage a = {0}, b = {0};
    RetexError err = {0};
    test_random_image(&a, 100, 100, 3, 1, 0, 0);
    test_must(retex_image_copy(&b, &a, &err), &err);
    for (int x = 0; x < 300; x++) /* 3 rows of 100, blurred over some more: over 1%, so p99 lies inside */
        b.pixels[x] = 1;
    RetexMetrics m = compare(&a, &b);
    assert_true(m.flip_p99 > 0.3 && m.flip_p99 > 5 * m.flip_mean && m.flip_p99 <= 1);
    retex_image_free(&a);
    retex_image_free(&b);
}

static void test_every_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    RetexImage a = {0}, b = {0}, maps[2] = {{0}};
    RetexError err = {0};
    test_random_image(&a, 101, 173, 3, 5, 0, 1);
    test_random_image(&b, 101, 173, 3, 6, 0, 1);
    RetexMetrics m[3];
    const int threads[3] = {1, 2, 7};
    for (int i = 0; i < 3; i++) {
        memset(&m[i], 0, sizeof m[i]);
        test_must(retex_metrics(&m[i], &a, &b, threads[i], &err), &err);
        assert_memory_equal(&m[i], &m[0], sizeof m[0]);
    }
    test_must(retex_flip_map(&maps[0], &a, &b, 1, &err), &err);
    test_must(retex_flip_map(&maps[1], &a, &b, 7, &err), &err);
    assert_memory_equal(maps[0].pixels, maps[1].pixels, 101 * 173 * sizeof(float));
    retex_image_free(&a);
    retex_image_free(&b);
    retex_image_free(&maps[0]);
    retex_image_free(&maps[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_identical_pictures_do_not_differ),
        cmocka_unit_test(test_figures_of_a_constant_difference),
        cmocka_unit_test(test_worst_pixel_is_found),
        cmocka_unit_test(test_nonfinite_samples_are_counted_and_left_out),
        cmocka_unit_test(test_sizes_and_channels_must_agree),
        cmocka_unit_test(test_flip_equals_two_dimensional_filters),
        cmocka_unit_test(test_flip_of_black_and_white),
        cmocka_unit_test(test_flip_grows_with_the_difference_and_stays_local),
        cmocka_unit_test(test_percentile_is_of_pixels),
        cmocka_unit_test(test_every_number_of_threads_gives_the_same_bits),
    };
    return cmocka_run_group_tests_name("metrics", tests, NULL, NULL);
}
