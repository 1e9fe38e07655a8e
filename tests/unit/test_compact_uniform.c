/* Compact sets: pixels that see one surface evenly. */
#include "lib_compact.h"

#include <math.h>
#include <string.h>

#include <cmocka.h>

/* The footprint of whole pixels, which is the last one. */
static const RetexFootprint *whole_of(const RetexSet *compact)
{
    const RetexFootprint *f = &compact->footprints[compact->nfootprints - 1];
    assert_string_equal(compact->parts[f->spread].letters, "RGBA");
    assert_int_equal(f->quadrant, 0);
    return f;
}

/* A pixel's clusters as one: their mean and variances with their weights; 0 where it is whole. */
static RetexUvStats all_clusters(const RetexSet *compact, int x, int y, int *count)
{
    static const int none[2] = {0};
    RetexUvStats sum = {.weight = 0};
    *count = 0;
    for (int k = 0; k < compact->nfootprints - 1; k++) {
        char name[] = "weight_T0_sharp1";
        RetexUvStats place;
        const RetexFootprint *f = &compact->footprints[k];
        const float *uv = pixel(compact, f->uv, x, y);
        name[sizeof name - 2] = (char)('1' + k);
        if (!(uv[2] > 0))
            continue;
        retex_uv_stats_load(&place, (double)*pixel(compact, retex_set_find_part(compact, name), x, y), uv,
                            pixel(compact, f->spread, x, y));
        retex_uv_stats_merge(&sum, &place, none);
        ++*count;
    }
    return sum;
}

/* How many pixels of a wall are whole once compact, and how many of those at x = 20 are where the set says. */
static int whole_pixels_of_wall(float noise, int samples, int *off)
{
    const float step = 1.0f / 64;
    RetexSet *set = set_of_wall(noise, samples), *compact = compacted(set, 4, 8, 1);
    const RetexFootprint *f = whole_of(compact);
    const int weight = retex_set_find_part(compact, "weight_T0_whole");
    int count = 0;
    *off = 0;
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++) {
            const float *uv = pixel(compact, f->uv, x, y), *axes = pixel(compact, f->spread, x, y);
            int clusters;
            const double mean = all_clusters(compact, x, y, &clusters).mean[0];
            *off += x == 20 && fabs(mean / (double)step - x + 0.1) < 0.04;
            count += uv[2] > 0 && fabsf(uv[0] / step - (float)x) < 0.012f + noise / 10 &&
                     fabsf(uv[1] / step - (float)y) < 0.012f + noise / 10 &&
                     fabsf(axes[0] / step - 1) < 0.02f + noise / 8 && fabsf(axes[3] / step - 1) < 0.02f + noise / 8 &&
                     *pixel(compact, weight, x, y) == 1 && clusters == 0;
        }
    retex_set_close(&set);
    retex_set_close(&compact);
    return count;
}

/* Pixels are whole, without noise, but of those off the map what the set says. */
static void even_pixels_are_whole(void **state)
{
    int off;
    (void)state;
    assert_true(whole_pixels_of_wall(0.04f, 1024, &off) > HIGH * WIDE * 9 / 10);
    assert_int_equal(off, HIGH);
}

/* Few samples are off by chance, and are no reason to doubt the map; many would be, and few that lie as evenly as those
 * of strata. */
static void few_samples_are_even_too(void **state)
{
    int off;
    (void)state;
    assert_true(whole_pixels_of_wall(0.04f, 20, &off) > HIGH * WIDE * 9 / 10);
    assert_int_equal(off, HIGH);
    assert_true(whole_pixels_of_wall(0.4f, 20, &off) > HIGH * WIDE * 8 / 10);
    assert_true(whole_pixels_of_wall(0.4f, 4096, &off) < HIGH * WIDE / 2);
}

/* A tenth of a pixel is chance for a pixel of twenty samples, and is none for one of a thousand in the same
 * picture. */
static void chance_is_of_each_pixels_samples(void **state)
{
    enum { OFF = 20, ROWS = HIGH / 2, NEAR = 2 /* rows that see both sorts */ };
    const float step = 1.0f / 64;
    RetexSet *set = set_of_wall(0.4f, 20), *fine = set_of_wall(0.056f, 1024);
    int whole = 0, count;
    (void)state;
    for (int i = 0; i < set->nparts; i++) {
        RetexImage *to = &set->parts[i].image;
        const size_t first = retex_image_index(to, 0, ROWS), end = retex_image_index(to, 0, HIGH);
        memcpy(to->pixels + first, fine->parts[i].image.pixels + first, (end - first) * sizeof *to->pixels);
    }
    RetexSet *compact = compacted(set, 4, 8, 1);
    for (int y = 0; y < ROWS - NEAR; y++)
        whole += pixel(compact, whole_of(compact)->uv, OFF, y)[2] > 0;
    assert_true(whole > (ROWS - NEAR) * 3 / 4);
    for (int y = ROWS + NEAR; y < HIGH; y++)
        assert_float_equal(all_clusters(compact, OFF, y, &count).mean[0] / (double)step, OFF - 0.1, 0.05);
    retex_set_close(&set);
    retex_set_close(&fine);
    retex_set_close(&compact);
}

/* In some rows places go to and fro over five pixels. Fitting quadratics keeps .836 of a wave of five, once: that is as
 * much as fits a map. Again it would take away more than the noise of the means. */
static void no_more_than_noise_is_smoothed(void **state)
{
    enum { FIRST = 10, END = 24, NEAR = 2 };
    const float step = 1.0f / 64, high = 0.08f;
    RetexSet *set = set_of_wall(0.04f, 1024);
    double along = 0, all = 0;
    (void)state;
    for (int k = 0; k < 4; k++)
        for (int y = FIRST; y < END; y++)
            for (int x = 0; x < WIDE; x++)
                pixel(set, set->footprints[k].uv, x, y)[0] += high * step * sinf((float)(2 * M_PI) * (float)x / 5);
    RetexSet *compact = compacted(set, 4, 8, 1);
    for (int y = FIRST + NEAR; y < END - NEAR; y++)
        for (int x = 24; x < WIDE - NEAR; x++) { /* the wall is off at 20 */
            const float *uv = pixel(compact, whole_of(compact)->uv, x, y);
            const double wave = sin(2 * M_PI * x / 5);
            along += uv[2] > 0 ? wave * (double)(uv[0] / step - (float)x) : 0;
            all += uv[2] > 0 ? wave * wave : 0;
        }
    assert_true(all > 50);
    assert_true(fabs(along / all / (double)high - 0.836) < 0.05);
    retex_set_close(&set);
    retex_set_close(&compact);
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
    const RetexFootprint *f = whole_of(compact);
    int right = 0;
    (void)state;
    for (int y = FIRST; y < FIRST + ROWS; y++)
        for (int x = 0; x < WIDE; x++) {
            const float below = (float)y + 2.5f, step = 20 / (below * below);
            right += fabsf(pixel(compact, f->spread, x, y)[3] - step) < 0.025f * step;
        }
    assert_true(right > ROWS * WIDE * 3 / 4);
    retex_set_close(&set);
    retex_set_close(&compact);
}

/* ---- pixels that the set says are parallelograms ---- */

enum { ODD_X = 30, ODD_Y = 9, OTHER_X = 12 };
static const float axes_of_odd[] = {0.04f, -0.01f, 0.005f, 0.03f};

/* u + .3 v = x / 40, v = y / 50, to the bit of floats, in four quadrants of light 1, 2, 3, 4; but at ODD larger than
 * the steps to its neighbours. At OTHER_X a mirror shows another place as well, with as much light as all of them. */
static RetexSet *set_of_quadrants(void)
{
    RetexSet *set = start_sharp_set();
    RetexError err;
    RetexFootprint f = {.target = 0, .kind = RETEX_FOOTPRINT_SHARP, .hit = 9};
    test_must(retex_set_add_part(set, "uv_T0_quadrants", "RGA", RETEX_FLOAT, WIDE, HIGH, &f.uv, &err), &err);
    test_must(retex_set_add_part(set, "axes_T0_quadrants", "RGBA", RETEX_HALF, WIDE, HIGH, &f.spread, &err), &err);
    f.albedo = set->footprints[0].albedo;
    for (f.quadrant = 1; f.quadrant <= RETEX_QUADRANTS; f.quadrant++) {
        int index;
        test_must(retex_set_add_footprint(set, &f, &index, &err), &err);
        const int light = add_term(set, 1, index, 0);
        for (int i = 0; i < WIDE * HIGH; i++)
            put_rgb(set, light, i % WIDE, i / WIDE, (float)f.quadrant, (float)f.quadrant, (float)f.quadrant);
    }
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++) {
            const float v = (float)y / 50, axes[] = {1.0f / 40, 0, -0.3f / 50, 1.0f / 50};
            put_rgb(set, f.albedo, x, y, 0.5f, 0.5f, 0.5f);
            put(set, 4, x, y, (float)x / 40 - 0.3f * v, v, 0.25f);
            memcpy(pixel(set, f.spread, x, y), x == ODD_X && y == ODD_Y ? axes_of_odd : axes, sizeof axes);
            if (x != OTHER_X)
                continue;
            put(set, 0, x, y, 0.9f, 0.1f, 1);
            put_spread(set, 0, x, y, 0.003f, 0.003f, 0);
            put_rgb(set, light_part(set, 0), x, y, 10, 10, 10);
        }
    return set;
}

/* They stay as they are, with the share of their light, but where their axes are not the steps to their neighbours:
 * there four clusters have the same mean and variances. */
static void parallelograms_stay(void **state)
{
    RetexSet *set = set_of_quadrants();
    const RetexFootprint *was = &set->footprints[4];
    (void)state;
    RetexSet *compact = compacted(set, 4, 8, 1);
    const RetexFootprint *f = whole_of(compact);
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++) {
            const float *uv = pixel(compact, f->uv, x, y);
            const float weight = *pixel(compact, retex_set_find_part(compact, "weight_T0_whole"), x, y);
            int count;
            const RetexUvStats others = all_clusters(compact, x, y, &count);
            if (x == ODD_X && y == ODD_Y) {
                const float *from = pixel(set, was->uv, x, y), *a = axes_of_odd;
                assert_true(uv[2] == 0 && weight == 0 && count == 4);
                for (int k = 0; k < 2; k++)
                    assert_float_equal(others.mean[k], from[k], 1e-4);
                assert_float_equal(others.m2[0] / others.weight, (a[0] * a[0] + a[2] * a[2]) / 12, 1e-6);
                assert_float_equal(others.m2[1] / others.weight, (a[0] * a[1] + a[2] * a[3]) / 12, 1e-6);
                assert_float_equal(others.m2[2] / others.weight, (a[1] * a[1] + a[3] * a[3]) / 12, 1e-6);
                continue;
            }
            assert_memory_equal(uv, pixel(set, was->uv, x, y), 2 * sizeof *uv);
            assert_memory_equal(pixel(compact, f->spread, x, y), pixel(set, was->spread, x, y), 4 * sizeof *uv);
            assert_float_equal(weight, x == OTHER_X ? 0.5f : 1, 0.002);
            assert_int_equal(count, x == OTHER_X);
            if (x == OTHER_X && !(fabs(others.mean[0] - 0.9) < 1e-4 && fabs(others.weight - 0.5) < 0.002))
                fail_msg("%d,%d: %g at %.9g", x, y, others.weight, others.mean[0]);
        }
    retex_set_close(&compact);
    retex_set_close(&set);
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
        cmocka_unit_test(even_pixels_are_whole),
        cmocka_unit_test(few_samples_are_even_too),
        cmocka_unit_test(chance_is_of_each_pixels_samples),
        cmocka_unit_test(no_more_than_noise_is_smoothed),
        cmocka_unit_test(even_pixels_run_to_a_horizon),
        cmocka_unit_test(parallelograms_stay),
        cmocka_unit_test(places_are_not_averaged_across_a_seam),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
