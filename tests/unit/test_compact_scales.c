/* How small images of a compact set are made: as small as the loss asked for allows, by what the set tells of itself in
 * one pass. */
#include "lib_compact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compact/detail.h"
#include "compact/light.h"

/* The scale of the gains of a set of which every footprint shows one place. Frees the set. */
static int scale_of_gains(RetexSet *set, double noise)
{
    RetexSet *compact;
    RetexCompactParams params = RETEX_COMPACT_INIT;
    RetexError err = {0};
    params.noise = noise;
    for (int i = 0; i < set->nfootprints; i++)
        for (int k = 0; k < WIDE * HIGH; k++)
            put(set, i, k % WIDE, k / WIDE, 0.3f, 0.4f, 1);
    test_must(retex_set_compact(&compact, set, &params, 2, &err), &err);
    const int gain = retex_set_find_part(compact, "gain_T0_sharp");
    assert_true(gain > 0);
    const int scale = retex_set_scale(compact, &compact->parts[gain].image);
    retex_set_close(&set);
    retex_set_close(&compact);
    return scale;
}

/* The grey world of gains that do not change goes into the smallest images; an edge in them does not. */
static void sizes_follow_the_loss(void **state)
{
    (void)state;
    for (int edge = 0; edge < 2; edge++) {
        RetexSet *set = whole_set(1, 1);
        for (int i = 1; i < set->nterms; i++)
            for (int y = 0; y < HIGH; y++)
                for (int x = 0; x < WIDE; x++) {
                    const float light = edge && set->terms[i].nfactors > 1 && (x / 5 + y / 5) % 2 ? 0 : 0.3f;
                    put_rgb(set, set->terms[i].radiance, x, y, light, light, light);
                }
        assert_int_equal(scale_of_gains(set, 1), edge ? 1 : 8);
    }
}

/* The scale of broad footprints, of so much light from the squares of a chequerboard. */
static int scale_of_squares(float light)
{
    RetexSet *set = start_set(WIDE, HIGH, 1), *compact;
    RetexError err = {0};
    const int broad = add_footprint(set, 0, RETEX_FOOTPRINT_BROAD, 1, "RGB"), part = add_term(set, 1, broad, 0);
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++) {
            put(set, broad, x, y, (x / 5 + y / 5) % 2 ? 0.3f : 0.31f, 0.4f, 1);
            put_spread(set, broad, x, y, 0.004f, 0.004f, 0);
            put_rgb(set, set->footprints[broad].albedo, x, y, 0.5f, 0.5f, 0.5f);
            put_rgb(set, part, x, y, light, light, light);
        }
    test_must(retex_set_compact(&compact, set, NULL, 2, &err), &err);
    const int uv = retex_set_find_part(compact, "uv_T0_broad1");
    assert_true(uv > 0);
    const int scale = retex_set_scale(compact, &compact->parts[uv].image);
    retex_set_close(&set);
    retex_set_close(&compact);
    return scale;
}

/* Broad footprints of little light are small; those of much, which show the squares, are not. */
static void sizes_follow_the_light(void **state)
{
    (void)state;
    assert_int_equal(scale_of_squares(1e-4f), 8);
    assert_int_equal(scale_of_squares(0.3f), 1);
}

/* Noise of a denoised wall may go, but not where it is asked to be kept. Gains are of dim further light, which has as
 * much noise for its light. */
static void noise_is_kept_where_it_is_asked_for(void **state)
{
    (void)state;
    for (int kept = 0; kept < 2; kept++) {
        RetexSet *set = whole_set(1, 1);
        uint32_t seed = 17;
        set->denoised = 1;
        for (int i = 1; i < set->nterms; i++)
            for (int y = 0; y < HIGH; y++)
                for (int x = 0; x < WIDE; x++) {
                    const float mean = set->terms[i].nfactors > 1 ? 0.06f : 0.3f;
                    const float light = mean * (1 + 0.5f * (float)(test_random(&seed) - 0.5));
                    put_rgb(set, set->terms[i].radiance, x, y, light, light, light);
                }
        assert_int_equal(scale_of_gains(set, kept ? 0 : 1), kept ? 1 : 8);
    }
}

/* ---- what a set tells of itself ---- */

enum { SIDE = 100 }; /* several strips of rows; no multiple of 8 */
#define LIGHT 0.3    /* of all terms */
#define ALBEDO 0.3   /* with which errors are looked at */

/* A set of one sharp footprint, with light of one hit and of a further one, which add up to LIGHT with
 * RETEX_COMPACT_GREY, and so much of it of the latter. */
static RetexSet *set_of_gains(float further(int x, int y, uint32_t *seed))
{
    RetexSet *set = start_set(SIDE, SIDE, 1);
    const int sharp = add_footprint(set, 0, RETEX_FOOTPRINT_SHARP, 1, "RGB");
    const int later = add_footprint(set, 0, RETEX_FOOTPRINT_INTERREFLECTION, 2, "RGB");
    const int one = add_term(set, 1, sharp, 0), two = add_term(set, 2, sharp, later);
    uint32_t seed = 3;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const float share = further(x, y, &seed), own = (float)LIGHT * (1 - share);
            const float second = (float)LIGHT * share / RETEX_COMPACT_GREY;
            for (int f = 0; f < 2; f++) {
                put(set, f, x, y, 0.3f, 0.4f, 1);
                put_spread(set, f, x, y, 0.1f, 0.1f, 0);
                put_rgb(set, set->footprints[f].albedo, x, y, 0.5f, 0.5f, 0.5f);
            }
            put_rgb(set, one, x, y, own, own, own);
            put_rgb(set, two, x, y, second, second, second);
        }
    set->denoised = 1;
    return set;
}

static RetexCompactDetails details_of(RetexSet *set, int nthreads)
{
    RetexCompactDetails details;
    RetexCompactLight light;
    RetexError err = {0};
    const char *unknown;
    test_must(retex_compact_light_open(&light, set, 1, &unknown, &err), &err);
    assert_null(unknown);
    test_must(retex_compact_details_open(&details, &light, nthreads, &err), &err);
    retex_compact_light_close(&light);
    return details;
}

static double encoded(double x)
{
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}

/* The mean square of what the picture with textures of ALBEDO changes by, if the share of further light is its mean in
 * every block: by brute force. The light is the same everywhere, so the mean of shares is that of light. */
static double brute_square(float further(int x, int y, uint32_t *seed), int scale)
{
    double *shares = calloc(SIDE * SIDE, sizeof *shares), sum = 0;
    uint32_t seed = 3;
    for (int i = 0; i < SIDE * SIDE; i++)
        shares[i] = (double)further(i % SIDE, i / SIDE, &seed);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const int x0 = i % SIDE / scale * scale, y0 = i / SIDE / scale * scale;
        double mean = 0;
        int count = 0;
        for (int y = y0; y < y0 + scale && y < SIDE; y++)
            for (int x = x0; x < x0 + scale && x < SIDE; x++)
                mean += shares[y * SIDE + x], count++;
        mean /= count;
        const double grey_albedo = (double)RETEX_COMPACT_GREY;
        const double is = LIGHT * ALBEDO * (1 - shares[i] + shares[i] * ALBEDO / grey_albedo);
        const double made = LIGHT * ALBEDO * (1 - mean + mean * ALBEDO / grey_albedo);
        sum += pow(encoded(made) - encoded(is), 2);
    }
    free(shares);
    return sum / (SIDE * SIDE);
}

static float random_share(int x, int y, uint32_t *seed)
{
    (void)x, (void)y;
    return 0.3f + 0.04f * (float)(test_random(seed) - 0.5);
}

static float slope_of_shares(int x, int y, uint32_t *seed)
{
    (void)seed;
    return 0.2f + 0.2f * (float)(x + y) / SIDE;
}

/* Errors are those of the picture; of numbers without neighbours that are like them they are noise, of a slope not. */
static void errors_are_those_of_the_picture(void **state)
{
    (void)state;
    for (int noisy = 0; noisy < 2; noisy++) {
        RetexSet *set = set_of_gains(noisy ? random_share : slope_of_shares);
        RetexCompactDetails details = details_of(set, 2);
        double most = 0;
        for (int step = 1; step < RETEX_COMPACT_STEPS; step++) {
            const double is = details.gains[0].squares[step];
            const double should = brute_square(noisy ? random_share : slope_of_shares, 1 << step);
            assert_true(fabs(is / should - 1) < 0.05);
            most = is;
        }
        assert_true(noisy ? fabs(details.gains[0].noise / most - 1) < 0.1 : details.gains[0].noise < 0.05 * most);
        retex_compact_details_close(&details);
        retex_set_close(&set);
    }
}

/* The same bits for every number of threads. */
static void threads_change_nothing(void **state)
{
    (void)state;
    RetexSet *set = whole_set(2, 2);
    RetexCompactDetails one = details_of(set, 1), many = details_of(set, 7);
    assert_true(one.gains[0].squares[3] > 0 && one.clusters[1].squares[3] > 0);
    assert_memory_equal(one.gains, many.gains, sizeof one.gains);
    assert_memory_equal(one.clusters, many.clusters, sizeof one.clusters);
    assert_memory_equal(one.mixed, many.mixed, sizeof one.mixed);
    assert_memory_equal(&one.noise, &many.noise, sizeof one.noise);
    retex_compact_details_close(&one);
    retex_compact_details_close(&many);
    retex_set_close(&set);
}

/* A broad footprint whose places are those of a chequerboard. Blocks of its squares have two places in one. */
static void clusters_lose_by_their_distance(void **state)
{
    (void)state;
    double squares[2];
    for (int far = 0; far < 2; far++) {
        RetexSet *set = start_set(SIDE, SIDE, 1);
        const int broad = add_footprint(set, 0, RETEX_FOOTPRINT_BROAD, 1, "RGB"), one = add_term(set, 1, broad, 0);
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                put(set, broad, x, y, (x / 2 + y / 2) % 2 ? 0.3f : far ? 0.5f : 0.31f, 0.4f, 1);
                put_spread(set, broad, x, y, 0.04f, 0.03f, 0);
                put_rgb(set, set->footprints[broad].albedo, x, y, 0.5f, 0.5f, 0.5f);
                put_rgb(set, one, x, y, (float)LIGHT, (float)LIGHT, (float)LIGHT);
            }
        RetexCompactDetails details = details_of(set, 2);
        const double slope = 1.055 / 2.4 * pow(LIGHT * ALBEDO, 1 / 2.4 - 1), d = far ? 0.1 : 0.005;
        assert_true(details.clusters[0].squares[1] < 1e-9);
        squares[far] = details.clusters[0].squares[2] / (LIGHT * LIGHT * slope * slope);
        assert_true(fabs(squares[far] / (d * d / (d * d + 0.0025)) - 1) < 0.01);
        retex_compact_details_close(&details);
        retex_set_close(&set);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_follow_the_loss),
        cmocka_unit_test(sizes_follow_the_light),
        cmocka_unit_test(noise_is_kept_where_it_is_asked_for),
        cmocka_unit_test(errors_are_those_of_the_picture),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(clusters_lose_by_their_distance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
