/* The noise of a picture, estimated from the picture alone: noise of known size, and detail that must not be taken for
 * noise. */
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>

#include "compact/image_noise.h"

enum { SIDE = 200, LEVELS = 255 };

static double gaussian(uint32_t *seed)
{
    const double radius = sqrt(-2 * log(1 - test_random(seed)));
    return radius * cos(6.283185307179586 * test_random(seed));
}

/* A shade over the picture, an edge straight across it, and noise of that many levels. */
static RetexImage make_image(double shade, double edge, double deviation)
{
    RetexImage im = {0};
    RetexError err = {0};
    uint32_t seed = 7;
    test_must(retex_image_alloc(&im, SIDE, SIDE, 3, &err), &err);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            for (int c = 0; c < 3; c++)
                im.pixels[retex_image_index(&im, x, y) + (size_t)c] =
                    (float)(0.3 + shade * (x + 2 * y) / (3 * SIDE) + (x > SIDE / 3 ? edge : 0) +
                            deviation / LEVELS * gaussian(&seed));
    return im;
}

static double noise_of(double shade, double edge, double deviation)
{
    RetexImage im = make_image(shade, edge, deviation);
    const double noise = retex_image_noise(&im, LEVELS);
    retex_image_free(&im);
    return noise;
}

static void noise_of_known_size_is_found(void **state)
{
    (void)state;
    for (double deviation = 0.25; deviation < 9; deviation *= 2) {
        assert_float_equal(noise_of(0, 0, deviation) / deviation, 1, 0.025);
        assert_float_equal(noise_of(0.4, 0.3, deviation) / deviation, 1, 0.025);
    }
}

/* Half of the first bin is what is told of none. */
static void shades_and_edges_are_no_noise(void **state)
{
    (void)state;
    assert_true(noise_of(0, 0, 0) < 0.005);
    assert_true(noise_of(0.4, 0.3, 0) < 0.005);
}

/* Pixels that are black do not count, however many; a few that break off do not either. */
static void black_and_odd_pixels_do_not_count(void **state)
{
    (void)state;
    RetexImage im = make_image(0.4, 0, 2);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            for (int c = 0; c < 3; c++) {
                float *value = &im.pixels[retex_image_index(&im, x, y) + (size_t)c];
                if (y > SIDE / 4)
                    *value = 0;
                else if (x % 30 == 0 && y % 30 == 0)
                    *value = 100;
            }
    assert_float_equal(retex_image_noise(&im, LEVELS) / 2, 1, 0.025);
    for (size_t i = 0; i < (size_t)SIDE * SIDE * 3; i++)
        im.pixels[i] = 0;
    assert_float_equal(retex_image_noise(&im, LEVELS), 0, 0);
    retex_image_free(&im);
}

/* Too small to have a pixel with neighbours all around; noise beyond what is counted ends, it does not overflow. */
static void the_smallest_and_the_noisiest(void **state)
{
    (void)state;
    float pixels[4] = {1, 2, 3, 4};
    const RetexImage small = {.width = 2, .height = 2, .channels = 1, .pixels = pixels};
    assert_float_equal(retex_image_noise(&small, LEVELS), 0, 0);
    assert_true(isfinite(noise_of(0, 0, 1e6)));
    assert_true(noise_of(0, 0, 1e6) > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_of_known_size_is_found),
        cmocka_unit_test(shades_and_edges_are_no_noise),
        cmocka_unit_test(black_and_odd_pixels_do_not_count),
        cmocka_unit_test(the_smallest_and_the_noisiest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
