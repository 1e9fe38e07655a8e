/* Albedos by the original texture: as far as the difference is no more than noise explains. The original is a ramp
 * along u, so that means and variances are known. */
#include "lib_denoise.h"
#include "lib_footprints.h"
#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "denoise/originals.h"

enum { SPP = 64 };
#define COVER 0.25f
#define U 0.4f
#define SPREAD 0.05f
#define WIDENED 1.25f /* the variance of what the filter of broad footprints averages, in units of the footprint's */

/* A set of one footprint whose albedo's red differs by d from the mean. */
static RetexSet *ramp_set(RetexFootprintKind kind, int is_whole, float d)
{
    static const double min[2] = {0, 0}, max[2] = {1, 1};
    RetexSet *set = cluster_set(kind, 1);
    set->spp = SPP;
    if (is_whole)
        set->footprints[0].spread = add_part(set, "RGBA", "axes", 0);
    denoise_add_original(set, min, max);
    put(set, 0, 2, 1, U, 0.5f, COVER);
    float *spread = pixel(set, set->footprints[0].spread, 2, 1);
    spread[0] = SPREAD, spread[1] = is_whole ? 0 : 0.01f, spread[2] = 0;
    if (is_whole)
        spread[3] = 0.01f;
    put_rgb(set, set->footprints[0].albedo, 2, 1, 0.25f + 0.5f * U + d, 0.5f * (0.25f + 0.5f * U), 0);
    put_rgb(set, set->footprints[0].albedo, 3, 1, 0.9f, 0.9f, 0.9f); /* where there is no footprint */
    return set;
}

static void use(RetexSet *set)
{
    RetexDenoiseOriginals *originals = NULL;
    RetexError err = {0};
    const RetexRoi all = {0, 0, set->width, set->height, 0, 3};
    test_must(retex_denoise_originals_open(&originals, set, NULL, 1, &err), &err);
    test_must(retex_denoise_use_originals(originals, set, &all, 2, &err), &err);
    retex_denoise_originals_close(&originals);
    assert_null(originals);
}

/* The red of the albedo, beyond the mean of the original. */
static float difference(const RetexSet *set)
{
    return pixel(set, set->footprints[0].albedo, 2, 1)[0] - (0.25f + 0.5f * U);
}

/* How far a difference stays: 2 / r of it are taken where it is r times what noise explains, squared, and 0.6 / m where
 * that is m in the mean of the pixels around, each at most 10. */
static float left(double difference, double around)
{
    const double squared = difference * difference;
    return (float)(difference * (1 - fmin(1, fmin(2 / squared, 0.6 / around))));
}

/* variance: of red and green within the footprint; explained: so many of it are noise of one sample. The pixel is the
 * only one of its row. */
static void expect_limit(RetexFootprintKind kind, int is_whole, float variance, float explained)
{
    const float limit = sqrtf(explained * variance / SPP);
    static const float before[] = {0, 0.7f, -0.7f, 0.9f, 2, -2, 10};
    for (size_t k = 0; k < sizeof before / sizeof *before; k++) {
        RetexSet *set = ramp_set(kind, is_whole, before[k] * limit);
        use(set);
        assert_float_equal(difference(set) / limit, left((double)before[k], fmin(10, before[k] * before[k])), 0.06);
        assert_float_equal(pixel(set, set->footprints[0].albedo, 3, 1)[1], 0.9, 0);
        retex_set_close(&set);
    }
}

static void test_limits(void **state)
{
    (void)state;
    const float slopes = 0.25f + 0.0625f, gaussian = slopes * SPREAD * SPREAD, even = gaussian / 12;
    expect_limit(RETEX_FOOTPRINT_BROAD, 0, WIDENED * gaussian, 4 / COVER);
    expect_limit(RETEX_FOOTPRINT_INTERREFLECTION, 0, WIDENED * gaussian, 4 / COVER);
    expect_limit(RETEX_FOOTPRINT_SHARP, 0, gaussian, 1 / COVER);
    expect_limit(RETEX_FOOTPRINT_SHARP, 1, even, 6 * 0.1f); /* a quarter is all that a quadrant can cover */
}

/* The pixels around tell noise, which differs from pixel to pixel, from what is no noise. */
static void test_pixels_around(void **state)
{
    (void)state;
    const float limit = sqrtf(4 / COVER * WIDENED * (0.25f + 0.0625f) * SPREAD * SPREAD / SPP);
    static const float own[] = {0.6f, 1.3f, 2}, others[] = {0, 1, 2, 100};
    for (int k = 0; k < 3; k++)
        for (int n = 0; n < 4; n++) {
            RetexSet *set = ramp_set(RETEX_FOOTPRINT_BROAD, 0, own[k] * limit);
            int count = 1;
            for (int x = 0; x < set->width && x <= 2 + 3; x++, count++)
                if (x != 2) {
                    put(set, 0, x, 1, U, 0.5f, COVER);
                    put_spread(set, 0, x, 1, SPREAD, 0.01f, 0);
                    put_rgb(set, set->footprints[0].albedo, x, 1, 0.25f + 0.5f * U + others[n] * limit,
                            0.5f * (0.25f + 0.5f * U), 0);
                } else
                    count--;
            const double around = (own[k] * own[k] + (count - 1) * fmin(10, others[n] * others[n])) / count;
            use(set);
            assert_float_equal(difference(set) / limit, left((double)own[k], around), 0.06);
            retex_set_close(&set);
        }
}

/* The less even the light, the more noise. */
static void test_uneven_light(void **state)
{
    (void)state;
    const float even = (0.25f + 0.0625f) * SPREAD * SPREAD / 12, limit = sqrtf(6 * 1.1f * even / SPP);
    RetexSet *set = ramp_set(RETEX_FOOTPRINT_SHARP, 1, 2 * limit);
    pixel(set, set->footprints[0].uv, 2, 1)[2] = COVER / 2;
    use(set);
    assert_float_equal(difference(set) / limit, left(2, 4), 0.06);
    retex_set_close(&set);
}

/* The rectangle of UV that the original covers; beyond its ends is its edge, without variance that explains noise. */
static void test_rectangle(void **state)
{
    (void)state;
    static const double min[2] = {-1, 2}, max[2] = {3, 4};
    for (int beyond = 0; beyond < 2; beyond++)
        for (int target = 0; target < 2; target++) {
            const float u = beyond ? 3.5f : U, mean = beyond ? 0.75f : 0.25f + 0.5f * (U + 1) / 4;
            RetexSet *set = cluster_set(RETEX_FOOTPRINT_BROAD, 1);
            set->spp = 2;
            denoise_add_original(set, min, max);
            if (target) { /* a second one that has an original too */
                set->targets[set->ntargets++] = set->targets[0];
                set->footprints[0].target = set->ntargets - 1;
            }
            put(set, 0, 2, 1, u, 2.5f, 0.5f);
            put_spread(set, 0, 2, 1, 0.2f, 0.01f, 0);
            put_rgb(set, set->footprints[0].albedo, 2, 1, mean + 0.01f, 0.5f * mean, 0);
            use(set);
            assert_float_equal(pixel(set, set->footprints[0].albedo, 2, 1)[0], beyond ? mean + 0.01f : mean, 0.001);
            retex_set_close(&set);
        }
}

/* A footprint whose albedo is another one's, too, keeps it; quadrants of a pixel have one. */
static void test_shared_albedos(void **state)
{
    (void)state;
    for (int quadrants = 0; quadrants < 2; quadrants++) {
        RetexSet *set = ramp_set(RETEX_FOOTPRINT_SHARP, 1, 0.008f);
        const int other = add_footprint(set, 0, RETEX_FOOTPRINT_SHARP, 2, "RGB");
        pixel(set, set->footprints[0].uv, 2, 1)[2] = 0.01f;
        set->footprints[other].albedo = set->footprints[0].albedo;
        if (quadrants)
            set->footprints[other] = set->footprints[0];
        for (int k = 0; quadrants && k < 2; k++)
            set->footprints[k ? other : 0].quadrant = 1 + k;
        use(set);
        assert_float_equal(difference(set), quadrants ? 0 : 0.008, 0.001);
        retex_set_close(&set);
    }
}

static void test_no_original(void **state)
{
    (void)state;
    RetexDenoiseOriginals *originals = NULL;
    RetexError err = {0};
    RetexSet *set = cluster_set(RETEX_FOOTPRINT_BROAD, 1);
    test_must(retex_denoise_originals_open(&originals, set, NULL, 1, &err), &err);
    assert_null(originals);
    retex_denoise_originals_close(&originals);
    retex_set_close(&set);
}

/* Denoising does so, in memory. */
static void test_denoising(void **state)
{
    (void)state;
    static const double min[2] = {-1, -1}, max[2] = {1, 1};
    RetexSet *set = denoise_set("footprints", 40, 32);
    const int albedo = set->footprints[0].albedo;
    set->spp = 2;
    denoise_add_original(set, min, max);
    for (int y = 0; y < set->height; y++)
        for (int x = 0; x < set->width; x++) {
            const float red = 0.5f + 0.25f * pixel(set, set->footprints[0].uv, x, y)[0];
            put_rgb(set, albedo, x, y, red + 0.001f, 0.5f * red, 0);
        }
    denoise_all(set, &denoise_exactly, 1);
    for (int y = 4; y < set->height - 4; y++) { /* where the target is seen, away from the ends of its UV */
        const float *uv = pixel(set, set->footprints[0].uv, 8, y);
        assert_float_equal(pixel(set, albedo, 8, y)[0], 0.5f + 0.25f * uv[0], 0.0005);
    }
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_limits),    cmocka_unit_test(test_pixels_around),  cmocka_unit_test(test_uneven_light),
        cmocka_unit_test(test_rectangle), cmocka_unit_test(test_shared_albedos), cmocka_unit_test(test_no_original),
        cmocka_unit_test(test_denoising),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
