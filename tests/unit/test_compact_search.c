/* How small images of a compact set are made: as small as the loss asked for allows, by trials in some tiles. */
#include "lib_compact.h"

#include <math.h>
#include <string.h>

#include <cmocka.h>

#include "compact/distortion.h"
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

/* The scale of broad footprints, of so little light from the squares of a chequerboard, on a wall that has so much
 * noise. */
static int scale_on_wall(float noise, float light)
{
    RetexSet *set = set_of_wall(noise, 1024), *compact;
    RetexError err = {0};
    const int broad = add_footprint(set, 0, RETEX_FOOTPRINT_BROAD, 5, "RGB"), part = add_term(set, 1, broad, 0);
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

/* What is lost already, if about as much as may be, takes nothing from what sizes may lose. */
static void sizes_may_lose_on_top(void **state)
{
    (void)state;
    assert_int_equal(scale_on_wall(0.005f, 0.022f), 8);
    assert_int_equal(scale_on_wall(0.038f, 0.022f), 8);
    assert_int_equal(scale_on_wall(0.038f, 0.08f), 1);
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

/* ---- the tiles that are tried ---- */

enum { SIDE = 64, TILES = 64, MARGIN = 16 /* around each tile that is tried */ };

/* Tiles side by side, whose light is their number; the last ones show places far apart in neighbouring pixels. */
static RetexSet *set_of_tiles(int difficult)
{
    RetexSet *set = start_set(SIDE * TILES, SIDE, 1);
    const int f = add_footprint(set, 0, RETEX_FOOTPRINT_SHARP, 1, "RGB"), light = add_term(set, 1, f, 0);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE * TILES; x++) {
            const int tile = x / SIDE, far = tile >= TILES - difficult && x % 2;
            put(set, f, x, y, far ? 0.9f : 0.1f, 0.5f, 1);
            put_spread(set, f, x, y, 0.001f, 0.001f, 0);
            put_rgb(set, set->footprints[f].albedo, x, y, 0.5f, 0.5f, 0.5f);
            put_rgb(set, light, x, y, (float)tile + 1, (float)tile + 1, (float)tile + 1);
        }
    return set;
}

/* The number of each tile that is tried, or -1 of none, and of how many it is. */
static void tried_tiles(int numbers[RETEX_COMPACT_TILES], double weights[RETEX_COMPACT_TILES], int difficult)
{
    RetexSet *set = set_of_tiles(difficult);
    RetexCompactLight light;
    RetexCompactReference reference;
    RetexError err = {0};
    const char *unknown;
    test_must(retex_compact_light_open(&light, set, 0, &unknown, &err), &err);
    assert_null(unknown);
    test_must(retex_compact_reference_open(&reference, &light, 2, &err), &err);
    assert_int_equal(reference.tile, SIDE + 2 * MARGIN);
    const int part = reference.set->terms[1].radiance, middle = MARGIN + SIDE / 2;
    for (int k = 0; k < RETEX_COMPACT_TILES; k++) {
        numbers[k] = (int)*pixel(reference.set, part, middle, k * reference.tile + middle) - 1;
        weights[k] = reference.weights[k];
    }
    retex_compact_reference_close(&reference);
    retex_compact_light_close(&light);
    retex_set_close(&set);
}

/* Of tiles that are alike every fourth one is tried, a middle one of the four for which it stands. */
static void tiles_stand_for_their_like(void **state)
{
    int numbers[RETEX_COMPACT_TILES];
    double weights[RETEX_COMPACT_TILES];
    (void)state;
    tried_tiles(numbers, weights, 0);
    for (int k = 0; k < RETEX_COMPACT_TILES; k++) {
        assert_int_equal(numbers[k], 4 * k + 1);
        assert_true(weights[k] == TILES / RETEX_COMPACT_TILES);
    }
}

/* Four tiles that are difficult stand for themselves; the others for some more each. */
static void difficult_tiles_are_all_tried(void **state)
{
    enum { DIFFICULT = 4 };
    int numbers[RETEX_COMPACT_TILES], found = 0;
    double weights[RETEX_COMPACT_TILES], sum = 0;
    (void)state;
    tried_tiles(numbers, weights, DIFFICULT);
    for (int k = 0; k < RETEX_COMPACT_TILES; k++) {
        const int is_difficult = numbers[k] >= TILES - DIFFICULT;
        sum += weights[k];
        assert_true(weights[k] <= (is_difficult ? 1 : 8));
        found += is_difficult && weights[k] > 0;
    }
    assert_int_equal(found, DIFFICULT);
    assert_true(sum == TILES);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_follow_the_loss),
        cmocka_unit_test(sizes_may_lose_on_top),
        cmocka_unit_test(noise_is_kept_where_it_is_asked_for),
        cmocka_unit_test(tiles_stand_for_their_like),
        cmocka_unit_test(difficult_tiles_are_all_tried),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
