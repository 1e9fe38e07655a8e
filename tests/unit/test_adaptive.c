/* Adaptive sampling: how many samples a tile gets, by the formula of render/adaptive.h from the pilot's values. */
#include "lib_test.h"

#include <math.h>

#include <cmocka.h>

#include "film/film.h"
#include "render/adaptive.h"

enum { PIXELS = 6, MOST = 1 << 20 };

/* Values of a pilot's samples: of grey, so that they are their own luminance. */
static double value_of(int pixel, int sample)
{
    return pixel == 0 ? 0 : 0.3 * pixel + 0.1 * ((sample * sample + pixel) % 3);
}

/* The root mean square over the pixels of deviation over the square root of the value, for one sample a pixel; dark
 * pixels count as 5 % of the mean at least. The deviation is estimated without bias. */
static double expected_noise(void)
{
    double mean[PIXELS], variance[PIXELS], all = 0, sum = 0;
    for (int p = 0; p < PIXELS; p++) {
        mean[p] = variance[p] = 0;
        for (int s = 0; s < ADAPTIVE_PILOT; s++)
            mean[p] += value_of(p, s) / ADAPTIVE_PILOT;
        for (int s = 0; s < ADAPTIVE_PILOT; s++)
            variance[p] += (value_of(p, s) - mean[p]) * (value_of(p, s) - mean[p]) / (ADAPTIVE_PILOT - 1);
        all += mean[p] / PIXELS;
    }
    for (int p = 0; p < PIXELS; p++)
        sum += variance[p] / (mean[p] + 0.05 * all + 1e-4) / PIXELS;
    return sqrt(sum);
}

static void show_tile(Adaptive *adaptive)
{
    for (int p = 0; p < PIXELS; p++) {
        PathResult paths[ADAPTIVE_PILOT];
        for (int s = 0; s < ADAPTIVE_PILOT; s++)
            paths[s].light[0] = paths[s].light[1] = paths[s].light[2] = value_of(p, s);
        adaptive_pixel_end(adaptive, paths);
    }
}

static void tiles_get_what_their_noise_asks_for(void **state)
{
    const Scene scene = {.width = 1, .height = 1};
    const PathContext context = {.scene = &scene};
    const double one = expected_noise();
    Adaptive *adaptive;
    RetexError err = {0};

    (void)state;
    test_must(adaptive_create(&adaptive, &context, NULL, &err), &err);
    for (double noise = 0.1; noise > 1e-3; noise *= 0.6) { /* each tile begins anew */
        const double wanted = ceil(one * one / (noise * noise) / ACCEL_PACKET) * ACCEL_PACKET;
        show_tile(adaptive);
        const int given = adaptive_tile_samples(adaptive, noise, MOST);
        assert_true(fabs(given - fmax(wanted, ADAPTIVE_LEAST)) <= ACCEL_PACKET * (wanted > 1000));
    }
    show_tile(adaptive);
    assert_int_equal(adaptive_tile_samples(adaptive, 1e-3, 100), 100);
    show_tile(adaptive);
    assert_int_equal(adaptive_tile_samples(adaptive, 10, MOST), ADAPTIVE_LEAST);
    show_tile(adaptive);
    assert_int_equal(adaptive_tile_samples(adaptive, 10, 5), 5);
    adaptive_close(&adaptive);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(tiles_get_what_their_noise_asks_for)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
