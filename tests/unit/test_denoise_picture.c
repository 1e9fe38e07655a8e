/* What denoising a picture that is no set is made of: the noise of one render, guides, and names of layers. */
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "files/picture_guides.h"
#include "files/picture_layers.h"
#include "files/picture_noise.h"

/* A number of the normal distribution, as the sum of twelve. */
static double gaussian(uint32_t *state)
{
    double sum = -6;
    for (int k = 0; k < 12; k++)
        sum += test_random(state);
    return sum;
}

enum { WIDTH = 90, HEIGHT = 70 };

/* A slope, and with `edge` a step along a slanted line; standard deviations of the noise grow to the right. */
static double deviation(int x)
{
    return 0.02 + 0.08 * x / WIDTH;
}

static RetexImage noisy_picture(double slope, double edge, double noise)
{
    RetexImage im = {0};
    uint32_t state = 5;
    assert_int_equal(retex_image_alloc(&im, WIDTH, HEIGHT, 3, NULL), 0);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (size_t c = 0; c < 3; c++)
                im.pixels[retex_image_index(&im, x, y) + c] =
                    (float)(1 + slope * (x + 2 * y) + (x > 40 ? edge : 0) + noise * deviation(x) * gaussian(&state));
    return im;
}

/* The mean of estimated over true variance, where the edge is not nearer than `far`, or where it is. */
static double mean_ratio(const RetexImage *variance, int far, int inside)
{
    double sum = 0;
    int count = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (size_t c = 0; c < 3; c++)
                if ((abs(2 * x - 81) < 2 * far) == inside) {
                    sum += variance->pixels[retex_image_index(variance, x, y) + c] / (deviation(x) * deviation(x));
                    count++;
                }
    return sum / count;
}

static void estimate(RetexImage *variance, RetexImage *picture, const RetexImage *normal, const RetexImage *albedo)
{
    assert_int_equal(retex_picture_estimate_variance(variance, picture, normal, albedo, 2, NULL), 0);
    retex_image_free(picture);
}

/* Slopes are not noise, nor is a straight edge. */
static void test_variance_is_found(void **state)
{
    (void)state;
    static const double pictures[][2] = {{0, 0}, {0.05, 0}, {0.05, 3}};
    for (int k = 0; k < 3; k++) {
        RetexImage im = noisy_picture(pictures[k][0], pictures[k][1], 1), variance = {0};
        estimate(&variance, &im, NULL, NULL);
        assert_in_range((int)(100 * mean_ratio(&variance, 6, 0)), 90, 110);
        assert_in_range((int)(100 * mean_ratio(&variance, 6, 1)), 80, 140);
        retex_image_free(&variance);
    }
}

static void test_nothing_is_no_noise(void **state)
{
    (void)state;
    RetexImage im = noisy_picture(0.05, 0, 0), variance = {0};
    estimate(&variance, &im, NULL, NULL);
    for (size_t i = 0; i < retex_image_index(&variance, 0, HEIGHT); i++)
        assert_true(variance.pixels[i] < 1e-9f);
    retex_image_free(&variance);
}

/* What the albedo shows is not noise: here tiles of one pixel. */
static void test_albedo_is_divided_out(void **state)
{
    (void)state;
    RetexImage im = noisy_picture(0, 0, 0), albedo = {0}, with = {0}, without = {0}, copy = {0};
    assert_int_equal(retex_image_copy(&albedo, &im, NULL), 0);
    for (size_t i = 0; i < retex_image_index(&im, 0, HEIGHT); i++) {
        const size_t x = i / 3 % WIDTH, y = i / 3 / WIDTH;
        albedo.pixels[i] = (x + y) % 2 || y % 3 == 0 ? 0.5f : 0.4f;
        im.pixels[i] = 2 * albedo.pixels[i];
    }
    assert_int_equal(retex_image_copy(&copy, &im, NULL), 0);
    estimate(&with, &im, NULL, &albedo);
    estimate(&without, &copy, NULL, NULL);
    for (size_t i = 0; i < retex_image_index(&with, 0, HEIGHT); i++) {
        assert_true(with.pixels[i] < 1e-9f);
        assert_true(without.pixels[i] > 1e-4f);
    }
    retex_image_free(&albedo);
    retex_image_free(&with);
    retex_image_free(&without);
}

/* Drawn numbers have mean 0 and the variance asked for, and are the same for every number of threads. */
static void test_draws(void **state)
{
    (void)state;
    RetexImage one = {0}, two = {0};
    double sum = 0, squares = 0, product = 0;
    assert_int_equal(retex_image_alloc(&one, 200, 200, 3, NULL), 0);
    for (size_t i = 0; i < 200 * 200; i++)
        one.pixels[3 * i] = 4, one.pixels[3 * i + 1] = 1, one.pixels[3 * i + 2] = -1;
    assert_int_equal(retex_image_copy(&two, &one, NULL), 0);
    retex_picture_draw_noise(&one, 3, 1);
    retex_picture_draw_noise(&two, 3, 7);
    assert_memory_equal(one.pixels, two.pixels, sizeof(float) * 3 * 200 * 200);
    for (size_t i = 0; i < 200 * 200; i++) {
        sum += one.pixels[3 * i];
        squares += one.pixels[3 * i] * one.pixels[3 * i];
        product += i ? one.pixels[3 * i] * one.pixels[3 * i - 3] : 0;
        assert_true(one.pixels[3 * i + 2] == 0);
        assert_true(fabsf(one.pixels[3 * i] - 2 * one.pixels[3 * i + 1]) < 1e-5f);
    }
    assert_true(fabs(sum / 40000) < 0.04);
    assert_true(fabs(squares / 40000 - 4) < 0.12);
    assert_true(fabs(product / 40000) < 0.08);
    retex_picture_draw_noise(&two, 4, 1);
    assert_memory_not_equal(one.pixels, two.pixels, sizeof(float) * 3 * 200 * 200);
    retex_image_free(&one);
    retex_image_free(&two);
}

/* Positions on a slanted plane have its normal, up to the sign, and so have the pixels beside its edge. */
static void test_normals_of_positions(void **state)
{
    (void)state;
    RetexImage position = {0}, normal = {0};
    const double plane[3] = {0.6, 0, 0.8};
    assert_int_equal(retex_image_alloc(&position, 20, 10, 3, NULL), 0);
    for (int y = 0; y < 10; y++)
        for (int x = 0; x < 20; x++) {
            float *p = position.pixels + retex_image_index(&position, x, y);
            p[0] = (float)x, p[1] = (float)y, p[2] = -0.75f * (float)x;
            if (x >= 12)
                p[2] += 50;
        }
    assert_int_equal(retex_picture_derive_normals(&normal, &position, NULL), 0);
    for (size_t i = 0; i < 200; i++)
        for (size_t c = 0; c < 3; c++)
            assert_true(fabs(fabs(normal.pixels[3 * i + c]) - plane[c]) < 1e-4);
    retex_image_free(&position);
    retex_image_free(&normal);
}

/* A floor, whose depth is 1 / y, and a wall: as positions both are about plane. */
static void test_depths(void **state)
{
    (void)state;
    RetexImage depth = {0};
    assert_int_equal(retex_image_alloc(&depth, 8, 2, 3, NULL), 0);
    for (size_t i = 0; i < 16 * 3; i++)
        depth.pixels[i] = i / 3 == 5 ? INFINITY : i / 3 == 6 ? -1 : 7;
    retex_picture_depth_to_position(&depth);
    for (size_t i = 0; i < 16; i++) {
        assert_true(depth.pixels[3 * i] == (float)(i % 8) / 8);
        assert_true(depth.pixels[3 * i + 1] == (float)(i / 8) / 8);
        assert_true(i == 5 || i == 6 ? depth.pixels[3 * i + 2] > 20 : fabsf(depth.pixels[3 * i + 2] - logf(7)) < 1e-6f);
    }
    retex_image_free(&depth);
}

/* ---- names ---- */

static RetexPictureLayer layer_list[] = {{"ViewLayer.Combined", 0, 3, {0, 1, 2}},
                                         {"ViewLayer.Combined.A", 0, 1, {3}},
                                         {"Other.Combined", 0, 3, {4, 5, 6}},
                                         {"Other.Normal", 0, 3, {7, 8, 9}},
                                         {"ViewLayer.Normal", 0, 3, {10, 11, 12}},
                                         {"ViewLayer.Depth.Z", 0, 1, {13}},
                                         {"ViewLayer.DiffDir", 0, 3, {14, 15, 16}},
                                         {"ViewLayer.DiffCol", 0, 3, {17, 18, 19}},
                                         {"ViewLayer.Denoising Albedo", 0, 3, {20, 21, 22}},
                                         {"Composite.Combined", 0, 3, {23, 24, 25}}};

static void test_names(void **state)
{
    (void)state;
    RetexError err;
    RetexPictureLayers layers = {10, layer_list};
    assert_int_equal(retex_picture_layer_named(&layers, "ViewLayer.Combined", "x.exr", &err), 0);
    assert_int_equal(retex_picture_layer_named(&layers, "viewlayer.combined", "x.exr", &err), 0);
    assert_int_equal(retex_picture_layer_named(&layers, "Combined.A", "x.exr", &err), 1);
    assert_int_equal(retex_picture_layer_named(&layers, "Depth", "x.exr", &err), 5);
    assert_int_equal(retex_picture_layer_named(&layers, "bined", "x.exr", &err), RETEX_ENOTFOUND);
    assert_string_equal(err.message, "x.exr has no layer bined");
    assert_int_equal(retex_picture_layer_named(&layers, "Combined", "x.exr", &err), RETEX_ENOTFOUND);
    assert_string_equal(err.message,
                        "x.exr has several layers Combined, such as ViewLayer.Combined: give the whole name");
    assert_int_equal(retex_picture_layer_beauty(&layers, "x.exr", &err), RETEX_ENOTFOUND);
    assert_string_equal(err.message,
                        "x.exr has several pictures, ViewLayer.Combined and Other.Combined: choose by --layer");
    assert_int_equal(retex_picture_layer_known(&layers, RETEX_PICTURE_NORMAL, 0), 4);
    assert_int_equal(retex_picture_layer_known(&layers, RETEX_PICTURE_NORMAL, 2), 3);
    assert_int_equal(retex_picture_layer_known(&layers, RETEX_PICTURE_ALBEDO, 0), 8);
    assert_int_equal(retex_picture_layer_known(&layers, RETEX_PICTURE_DEPTH, 0), 5);
    assert_int_equal(retex_picture_layer_known(&layers, RETEX_PICTURE_POSITION, 0), -1);
    assert_int_equal(retex_picture_layer_color(&layers, 6), 7);
    assert_int_equal(retex_picture_layer_color(&layers, 0), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_variance_is_found),
        cmocka_unit_test(test_nothing_is_no_noise),
        cmocka_unit_test(test_albedo_is_divided_out),
        cmocka_unit_test(test_draws),
        cmocka_unit_test(test_normals_of_positions),
        cmocka_unit_test(test_depths),
        cmocka_unit_test(test_names),
    };
    return cmocka_run_group_tests_name("denoise_picture", tests, NULL, NULL);
}
