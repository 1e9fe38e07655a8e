/* Compact sets: pixels that see one surface evenly. */
#include "lib_compact.h"

#include <math.h>

#include <cmocka.h>

/* How many clusters of a wall are the quarters of their pixel once compact, and of those at x = 20. */
static int quarters_of_wall(float noise, int samples, int *off)
{
    static const char *const weights[] = {"weight_T0_sharp1", "weight_T0_sharp2", "weight_T0_sharp3",
                                          "weight_T0_sharp4"};
    const float step = 1.0f / 64;
    RetexSet *set = set_of_wall(noise, samples);
    RetexSet *compact = compacted(set, 4, 8, 1);
    assert_int_equal(compact->nfootprints, 4);
    int quarters = 0;
    *off = 0;
    for (int k = 0; k < 4; k++) {
        const RetexFootprint *f = &compact->footprints[k];
        const int weight = retex_set_find_part(compact, weights[k]);
        for (int y = 0; y < HIGH; y++)
            for (int x = 0; x < WIDE; x++) {
                const float *uv = pixel(compact, f->uv, x, y), *spread = pixel(compact, f->spread, x, y);
                *off += x == 20 && fabsf(fabsf(uv[0] / step - (float)x + 0.1f) - 0.25f) < 0.04f;
                quarters += fabsf(fabsf(uv[0] / step - (float)x) - 0.25f) < 0.012f + noise / 10 &&
                            fabsf(fabsf(uv[1] / step - (float)y) - 0.25f) < 0.012f + noise / 10 &&
                            fabsf(spread[0] / step - 0.25f / sqrtf(3)) < 0.006f + noise / 32 &&
                            *pixel(compact, weight, x, y) == 0.25f;
            }
    }
    retex_set_close(&set);
    retex_set_close(&compact);
    return quarters;
}

/* The quarters of pixels are kept, without noise, but of those off the map what the set says. */
static void even_pixels_are_quarters(void **state)
{
    int off;
    (void)state;
    assert_true(quarters_of_wall(0.04f, 1024, &off) > 4 * HIGH * WIDE * 9 / 10);
    assert_int_equal(off, 4 * HIGH);
}

/* Few samples are off by chance, and are no reason to doubt the map; many would be. */
static void few_samples_are_even_too(void **state)
{
    int off;
    (void)state;
    assert_true(quarters_of_wall(0.4f, 20, &off) > 4 * HIGH * WIDE * 8 / 10);
    assert_true(quarters_of_wall(0.4f, 4096, &off) < 4 * HIGH * WIDE / 2);
}

/* Ground to a horizon two pixels above the picture, in quarters with a twentieth of noise. */
static RetexSet *set_of_ground(void)
{
    RetexSet *set = start_sharp_set();
    uint32_t seed = 5;
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++)
            for (int k = 0; k < 4; k++) {
                const float cut = 0.1f * (float)(test_random(&seed) - 0.5);
                const float below = (float)y + 2.5f + (k % 2 ? 0.25f : -0.25f) + cut;
                const float aside = (float)(x - WIDE / 2) + (k < 2 ? -0.25f : 0.25f);
                const float right = 0.1443f / below, down_u = 0.1443f * aside / (below * below),
                            down_v = 2.886f / (below * below), su = sqrtf(right * right + down_u * down_u);
                put(set, k, x, y, aside / below, -20 / below, 0.25f);
                put_spread(set, k, x, y, su, down_v, -down_u / su);
                put_rgb(set, set->footprints[k].albedo, x, y, 0.5f, 0.5f, 0.5f);
                put_rgb(set, set->terms[1 + k].radiance, x, y, 1, 1, 1);
            }
    return set;
}

/* Near the horizon pixels are as large as perspective has them, not as quadratics would. */
static void even_pixels_run_to_a_horizon(void **state)
{
    enum { FIRST = 4, ROWS = 5 };
    RetexSet *set = set_of_ground(), *compact = compacted(set, 4, 8, 1);
    int right = 0;
    (void)state;
    assert_int_equal(compact->nfootprints, 4);
    for (int y = FIRST; y < FIRST + ROWS; y++)
        for (int x = 0; x < WIDE; x++) {
            const float below = (float)y + 2.5f, step = 20 / (below * below);
            float least = INFINITY, most = -INFINITY;
            for (int k = 0; k < 4; k++) {
                const float v = pixel(compact, compact->footprints[k].uv, x, y)[1];
                least = fminf(least, v);
                most = fmaxf(most, v);
            }
            right += fabsf(2 * (most - least) - step) < 0.025f * step;
        }
    assert_true(right > ROWS * WIDE * 3 / 4);
    retex_set_close(&set);
    retex_set_close(&compact);
}

/* Light on both sides of a seam is one place there, not one in the middle. */
static void places_are_not_averaged_across_a_seam(void **state)
{
    RetexSet *set = start_set(WIDE, HIGH, 1);
    const int f = add_footprint(set, 0, RETEX_FOOTPRINT_BROAD, 1, "RGB"), light = add_term(set, 1, f, 0);
    (void)state;
    set->targets[0].periodic[0] = 1;
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++) {
            put(set, f, x, y, x % 2 ? 0.98f : 0.02f, 0.5f, 1);
            put_spread(set, f, x, y, 0.001f, 0.001f, 0);
            put_rgb(set, light, x, y, 1, 1, 1);
        }
    RetexSet *compact = compacted(set, 4, 8, 2);
    assert_int_equal(compact->nfootprints, 1);
    const RetexFootprint *to = &compact->footprints[0];
    const RetexImage *uv = &compact->parts[to->uv].image;
    assert_int_equal(uv->width, (WIDE + 3) / 4);
    for (int i = 0; i < uv->width * uv->height; i++) {
        const float u = uv->pixels[3 * i], distance = fminf(u, 1 - u);
        assert_true(distance < 1e-5f);
        assert_true(compact->parts[to->spread].image.pixels[3 * i] < 0.021f);
    }
    retex_set_close(&set);
    retex_set_close(&compact);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(even_pixels_are_quarters),
        cmocka_unit_test(few_samples_are_even_too),
        cmocka_unit_test(even_pixels_run_to_a_horizon),
        cmocka_unit_test(places_are_not_averaged_across_a_seam),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
