/* Weighted means with one weight per pixel, compared with those with one weight per colour, which are the reference.
 * */
#include "lib_test.h"

#include <string.h>

#include <cmocka.h>

#include "retexture/mixture_kernel.h"

enum { MOST = 61, SHARES = 3 };

static void test_same_means(void **state)
{
    (void)state;
    uint32_t seed = 1;
    for (int round = 0; round < 400; round++) {
        const int width = 1 + round % MOST;
        float sums[2][3 * MOST] = {{0}}, weights[MOST] = {0}, color_weights[3 * MOST] = {0};
        for (int k = 0; k < SHARES; k++) {
            float w[MOST], factor[3 * MOST];
            for (int i = 0; i < width; i++)
                w[i] = test_random(&seed) < 0.5 ? 0 : (float)test_random(&seed);
            for (int i = 0; i < 3 * width; i++)
                factor[i] = (float)test_random(&seed);
            const float *colors = test_random(&seed) < 0.2 ? NULL : factor;
            retex_mixture_add(sums[0], weights, w, colors, width);
            retex_mixture_add_colors(sums[1], color_weights, w, 1, colors, width);
        }
        int without = 0;
        for (int i = 0; i < 3 * width; i++) {
            assert_true(weights[i / 3] == color_weights[i]);
            without += weights[i / 3] == 0;
        }
        retex_mixture_divide(sums[0], weights, width);
        retex_mixture_divide_colors(sums[1], color_weights, width);
        assert_memory_equal(sums[0], sums[1], 3 * (size_t)width * sizeof(float));
        assert_true(width < MOST || without > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_same_means)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
