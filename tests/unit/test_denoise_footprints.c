/* The footprints of a pixel after its light was filtered: kept, borrowed or pooled. The sets have few pixels, filled
 * by hand. */
#include "lib_footprints.h"
#include "denoise/pools.h"

/* Half a unit in the last place that coverages and spreads up to 1 keep. */
#define COVERAGE_STEP (1.0f / 512)
#define SPREAD_STEP (1.0f / 256)
#include <cmocka.h>

#include <math.h>
#include <string.h>

static const float grey[3] = {1, 1, 1}, black[3] = {0, 0, 0};

/* ---- sharp ---- */

static RetexSet *sharp_set(RetexFootprintKind kind)
{
    RetexSet *set = again_set(kind, 3);
    uint32_t seed = 5;
    for (int k = 0; k < set->nfootprints; k++)
        for (int x = 0; x < WIDTH; x++) {
            if (x != 1 && x != 3 && x != 4)
                continue;
            put(set, k, x, 1, (float)test_random(&seed), (float)test_random(&seed), 0.5f);
            put_spread(set, k, x, 1, 0.1f, 0.2f, 0.3f);
            put_rgb(set, set->footprints[k].albedo, x, 1, 0.1f, 0.2f, (float)test_random(&seed));
            put_share(set, k, x, 1, 0.25f * (float)(1 + k % 2));
        }
    return set;
}

/* noise: of all pixels. of_light: how far proportions are believed, 0..1; the rest goes by cover, which is the same for
 * both. */
static void expect_proportions(RetexFootprintKind kind, int footprints, int spp, float noise, float of_light)
{
    static const float weights[] = {1, 1, 1, 1}, light[] = {2, 4, 8};
    RetexSet *set = sharp_set(kind);
    set->spp = spp;
    put_rgb(set, light_part(set, 0), 1, 1, 0.5f, 0.5f, 0.5f);
    put_rgb(set, light_part(set, 2), 1, 1, 1.5f, 0.5f, 0); /* of red 3/4, of green half, of blue nothing */
    Work w = open_work(set, footprints);
    for (int x = 0; x < WIDTH; x++)
        put_rgb(set, retex_set_find_part(set, kind == RETEX_FOOTPRINT_SHARP ? "noise_T0_sharp" : "noise_T0_broad"), x,
                1, noise, noise, noise);
    share_light(&w, kind, weights, 4, light);
    float red = of_light * 0.25f + (1 - of_light) * 0.5f, blue = of_light + (1 - of_light) * 0.5f;
    EXPECT(1e-3f, result(&w, light_part(set, 0)), 2 * red, 4 * 0.5f, 8 * blue);
    EXPECT(0, result(&w, light_part(set, 1)), 0, 0, 0);
    EXPECT(1e-3f, result(&w, light_part(set, 2)), 2 * (1 - red), 4 * 0.5f, 8 * (1 - blue));
    for (int k = 0; k < 3; k++)
        expect_copied(&w, k, 1, 1);
    close_work(&w);
}

static void test_proportions_are_kept(void **state)
{
    (void)state;
    expect_proportions(RETEX_FOOTPRINT_SHARP, 0, 1 << 20, 2, 1);
    expect_proportions(RETEX_FOOTPRINT_SHARP, 1, 1 << 20, 2, 1);
    expect_proportions(RETEX_FOOTPRINT_SHARP, 1, 2, 2, 0); /* so few samples tell nothing of it */
    expect_proportions(RETEX_FOOTPRINT_BROAD, 0, 2, 2, 1);
}

/* Clusters without light take it by coverage. */
static void test_light_by_coverage(void **state)
{
    (void)state;
    static const float weights[] = {1, 1, 1, 1}, light[] = {2, 4, 8};
    RetexSet *set = sharp_set(RETEX_FOOTPRINT_SHARP);
    pixel(set, set->footprints[0].uv, 1, 1)[2] = 0.25f;
    pixel(set, set->footprints[1].uv, 1, 1)[2] = 0.75f;
    pixel(set, set->footprints[2].uv, 1, 1)[2] = 0;
    put_light(set, 0, 3, 1, 5);
    Work w = open_work(set, 1);
    share_light(&w, RETEX_FOOTPRINT_SHARP, weights, 4, light);
    EXPECT(0, result(&w, light_part(set, 0)), 0.5f, 1, 2);
    EXPECT(0, result(&w, light_part(set, 1)), 1.5f, 3, 6);
    EXPECT(0, result(&w, light_part(set, 2)), 0, 0, 0);
    for (int k = 0; k < 3; k++)
        expect_copied(&w, k, 1, 1);
    close_work(&w);
}

static void test_borrowing(void **state)
{
    (void)state;
    static const float weights[] = {1, 0.9f, 0.3f, 0.5f}, light[] = {2, 4, 8};
    for (int dark = 0; dark < 3; dark++) {
        RetexSet *set = sharp_set(RETEX_FOOTPRINT_SHARP);
        set->spp = 1 << 20;
        int lender = dark == 0 ? 4 : dark == 1 ? 1 : 3;
        for (int k = 0; k < 3; k++) {
            put(set, k, 1, 1, 0, 0, 0);
            put_light(set, k, 4, 1, (float)k);
            if (dark == 2) /* pixel 4 has nothing either, and 3, which has no light, is none of two neighbours */
                put(set, k, 4, 1, 0, 0, 0);
        }
        Work w = open_work(set, 1);
        share_light(&w, RETEX_FOOTPRINT_SHARP, weights, dark == 2 ? 2 : 4, dark == 1 ? black : light);
        float zero = dark == 2 ? 1 / 3.0f : 0, first = dark == 1 ? 0 : 1 / 3.0f, second = dark == 0 ? 2 * first : first;
        EXPECT(1e-3f, result(&w, light_part(set, 0)), 2 * zero, 4 * zero, 8 * zero);
        EXPECT(1e-3f, result(&w, light_part(set, 1)), 2 * first, 4 * first, 8 * first);
        EXPECT(1e-3f, result(&w, light_part(set, 2)), 2 * second, 4 * second, 8 * second);
        for (int k = 0; k < 3; k++)
            expect_copied(&w, k, lender, 1);
        close_work(&w);
    }
}

/* The four quadrants of a pixel share UV, axes and albedo. They are lent all the same; UV goes on along the axes. */
static void test_quadrants_are_lent(void **state)
{
    (void)state;
    static const float weights[] = {1, 0.9f, 0.3f, 0.5f}, light[] = {2, 4, 8};
    static const float axes[] = {0.01f, 0.002f, -0.003f, 0.04f};
    RetexSet *set = again_set(RETEX_FOOTPRINT_SHARP, 4);
    const RetexFootprint *first = &set->footprints[0];
    set->footprints[0].spread = add_part(set, "RGBA", "axes", 0);
    for (int k = 0; k < 4; k++) {
        set->footprints[k].uv = first->uv, set->footprints[k].spread = first->spread;
        set->footprints[k].albedo = first->albedo, set->footprints[k].quadrant = 1 + k;
        put_light(set, k, 4, 1, (float)k);
        put_share(set, k, 4, 1, 0.25f);
    }
    put(set, 0, 4, 1, 0.5f, 0.7f, 1);
    put_rgb(set, first->albedo, 4, 1, 0.1f, 0.2f, 0.3f);
    memcpy(pixel(set, first->spread, 4, 1), axes, sizeof axes);
    set->spp = 1 << 20;
    Work w = open_work(set, 1);
    share_light(&w, RETEX_FOOTPRINT_SHARP, weights, 4, light);
    for (int k = 0; k < 4; k++) {
        const float part = (float)k / 6;
        EXPECT(1e-3f, result(&w, light_part(set, k)), part * light[0], part * light[1], part * light[2]);
        EXPECT(0, result(&w, share_part(set, k)), 0.25f);
        EXPECT(1e-6f, result_uv(&w, k), 0.5f - 3 * axes[0], 0.7f - 3 * axes[1], 1); /* from three pixels to the right */
        EXPECT(0, result_spread(&w, k), axes[0], axes[1], axes[2], axes[3]);
        EXPECT(0, result_albedo(&w, k), 0.1f, 0.2f, 0.3f);
    }
    close_work(&w);
}

/* Light of clusters that is their weight in a mixture, as for lamps, moves with them. */
static void test_light_as_a_weight(void **state)
{
    (void)state;
    for (int kind = RETEX_FOOTPRINT_SHARP; kind <= RETEX_FOOTPRINT_BROAD; kind++) {
        RetexSet *set = cluster_set((RetexFootprintKind)kind, 2);
        RetexMixture mixture = {.nshares = 2};
        RetexError err = {0};
        for (int k = 0; k < 2; k++)
            mixture.shares[k] = (struct RetexShare){k, light_part(set, k)};
        test_must(retex_set_add_mixture(set, &mixture, NULL, &err), &err);
        Work w = open_work(set, 1);
        assert_int_equal(w.written[set->footprints[0].uv], 1);
        assert_int_equal(w.written[set->footprints[1].albedo], 1);
        close_work(&w);
    }
}

/* Light with two further hits, each as albedo 1/2; that of lamps is the same light once more. */
static void test_light_of_lamps_is_counted_once(void **state)
{
    (void)state;
    for (int lamps = 0; lamps < 2; lamps++) {
        RetexSet *set = again_set(RETEX_FOOTPRINT_SHARP, 2);
        put_again(set, 1, 1, 3);
        if (lamps)
            test_add_lamp_terms(set, 0, 0);
        Work w = open_work(set, 1);
        const RetexDenoiseFootprints *f = w.footprints;
        assert_float_equal(f->interreflected[f->nsignals][WIDTH + 1], 0.25f * 3, 1e-6f);
        close_work(&w);
    }
}

/* A part that something else uses is not written: then light goes by what the pixel itself has. */
static void test_shared_parts_stay(void **state)
{
    (void)state;
    static const float weights[] = {1, 0.9f, 0.3f, 0.5f}, light[] = {2, 4, 8};
    for (int kind = RETEX_FOOTPRINT_SHARP; kind <= RETEX_FOOTPRINT_BROAD; kind++) {
        RetexSet *set = again_set((RetexFootprintKind)kind, 2);
        const int other = kind == RETEX_FOOTPRINT_SHARP ? 2 : 1; /* an interreflection; another cluster */
        set->footprints[other].uv = set->footprints[0].uv;
        put(set, 0, 4, 1, 0.5f, 0.7f, 1);
        put_light(set, 0, 4, 1, 1);
        Work w = open_work(set, 1);
        share_light(&w, (RetexFootprintKind)kind, weights, 4, light);
        assert_int_equal(w.written[set->footprints[0].uv], 0);
        EXPECT(0, result(&w, light_part(set, 0)), 0, 0, 0);
        close_work(&w);
    }
}

/* Where no light met targets again, light that does so next to it finds shares. */
static void test_shares_are_mended(void **state)
{
    (void)state;
    static const float weights[] = {1};
    RetexSet *set = sharp_set(RETEX_FOOTPRINT_SHARP);
    for (int k = 0; k < 3; k++)
        put_share(set, k, 1, 1, 0);
    put_light(set, 0, 1, 1, 1);
    put_light(set, 1, 1, 1, 3);
    Work w = open_work(set, 1);
    share_light(&w, RETEX_FOOTPRINT_SHARP, weights, 1, grey);
    EXPECT(0, result(&w, share_part(set, 0)), 0.25f);
    EXPECT(0, result(&w, share_part(set, 1)), 0.75f);
    EXPECT(0, result(&w, share_part(set, 2)), 0);
    close_work(&w);
}

/* ---- broad ---- */

/* A pooled albedo is that of the light that it reflected, each channel by itself. */
static void test_albedo_is_of_the_light(void **state)
{
    (void)state;
    static const float weights[] = {1, 1}, light[] = {1, 1, 1};
    RetexSet *set = cluster_set(RETEX_FOOTPRINT_BROAD, 1);
    for (int x = 1; x < 3; x++) {
        put(set, 0, x, 1, 0.5f, 0.5f, 0.125f);
        put_spread(set, 0, x, 1, 0.125f, 0.125f, 0);
    }
    put_rgb(set, light_part(set, 0), 1, 1, 1, 0.25f, 0.5f);
    put_rgb(set, light_part(set, 0), 2, 1, 0.25f, 1, 0.5f);
    put_rgb(set, set->footprints[0].albedo, 1, 1, 0.2f, 0.4f, 0.6f);
    put_rgb(set, set->footprints[0].albedo, 2, 1, 0.8f, 0.6f, 0.4f);
    Work w = open_work(set, 1);
    share_light(&w, RETEX_FOOTPRINT_BROAD, weights, 2, light);
    EXPECT(1e-6f, result_albedo(&w, 0), (1 * 0.2f + 0.25f * 0.8f) / 1.25f, (0.25f * 0.4f + 1 * 0.6f) / 1.25f, 0.5f);
    close_work(&w);
}

static void test_identical_neighbours(void **state)
{
    (void)state;
    static const float weights[] = {1, 0.5f, 0.75f, 0.125f, 1, 1}, light[] = {1, 2, 3};
    RetexSet *set = again_set(RETEX_FOOTPRINT_BROAD, 3);
    for (int x = 1; x < WIDTH; x++) {
        for (int k = 0; k < 3; k++) {
            put(set, k, x, 1, 0.25f * (float)k, 0.5f, 0.03125f);
            put_spread(set, k, x, 1, 0.125f, 0.25f, -0.5f);
            put_rgb(set, set->footprints[k].albedo, x, 1, 0.25f, 0.5f, 0.125f * (float)k);
            put_light(set, k, x, 1, (float)(1 + k));
            put_share(set, k, x, 1, k == 2 ? 0.5f : 0.25f);
        }
        put_again(set, x, 1, 3);
    }
    Work w = open_work(set, 1);
    share_light(&w, RETEX_FOOTPRINT_BROAD, weights, 6, light);
    for (int k = 0; k < 3; k++) {
        float f = (float)(1 + k) / 6;
        EXPECT(0.125f / 64, result_uv(&w, k), 0.25f * (float)k, 0.5f);
        EXPECT(SPREAD_STEP, result_spread(&w, k), 0.125f, 0.25f, -0.5f);
        EXPECT(1e-6f, result_albedo(&w, k), 0.25f, 0.5f, 0.125f * (float)k);
        EXPECT(1e-6f, result(&w, light_part(set, k)), f, 2 * f, 3 * f);
        EXPECT(0, result(&w, share_part(set, k)), k == 2 ? 0.5f : 0.25f);
        /* (sum of weights)^2 / sum of squares */
        EXPECT(COVERAGE_STEP, result_uv(&w, k) + 2, 0.03125f * 4.375f * 4.375f / (3 + 0.25f + 0.5625f + 0.015625f));
    }
    close_work(&w);
}

/* The only cluster image takes all: its mean and covariance are those of both together. */
static void test_exact_pooling(void **state)
{
    (void)state;
    static const float weights[] = {1, 0.5f};
    RetexSet *set = cluster_set(RETEX_FOOTPRINT_BROAD, 1);
    put(set, 0, 1, 1, 0, 1, 0.0625f);
    put(set, 0, 2, 1, 4, 3, 0.125f);
    put_spread(set, 0, 1, 1, 1, 0.5f, 0.5f);
    put_spread(set, 0, 2, 1, 2, 1, 0);
    put_rgb(set, light_part(set, 0), 1, 1, 1, 1, 0);                     /* luminance 0.9278 */
    put_rgb(set, light_part(set, 0), 2, 1, 6 * 0.9278f, 6 * 0.9278f, 0); /* weighs 3 times as much */
    put_rgb(set, set->footprints[0].albedo, 1, 1, 0, 0.5f, 0.25f);
    put_rgb(set, set->footprints[0].albedo, 2, 1, 0.5f, 0.5f, 0.75f);
    for (int c = 0; c < 3; c++)
        pixel(set, light_part(set, 0), 2, 1)[c] /= 0.9278f;
    Work w = open_work(set, 1);
    share_light(&w, RETEX_FOOTPRINT_BROAD, weights, 2, grey);
    const float variance_u = 0.25f * 1 + 0.75f * 4 + 0.25f * 9 + 0.75f * 1;
    const float variance_v = 0.25f * 0.25f + 0.75f * 1 + 0.25f * 2.25f + 0.75f * 0.25f;
    const float covariance = 0.25f * 0.25f + 0.25f * 3 * 1.5f + 0.75f * 1 * 0.5f;
    const float su = sqrtf(variance_u), sv = sqrtf(variance_v);
    EXPECT(su / 64, result_uv(&w, 0), 3);
    EXPECT(sv / 64, result_uv(&w, 0) + 1, 2.5f);
    EXPECT(COVERAGE_STEP, result_uv(&w, 0) + 2, 16 / (1 / 0.0625f + 9 / 0.125f));
    EXPECT(SPREAD_STEP, result_spread(&w, 0), su, sv, covariance / (su * sv));
    EXPECT(1e-6f, result_albedo(&w, 0), 0.375f, 0.5f, 0.625f); /* no blue light: all that is known */
    EXPECT(0, result(&w, light_part(set, 0)), 1, 1, 1);
    close_work(&w);
}

/* What is near goes together, what is far off opens a second one; the order is that of places. */
static void test_two_clusters(void **state)
{
    (void)state;
    static const float weights[] = {1, 1, 1}, light[] = {4, 8, 16};
    RetexSet *set = again_set(RETEX_FOOTPRINT_BROAD, 3);
    put(set, 2, 1, 1, 0.75f, 0.75f, 0.0625f);
    put(set, 0, 2, 1, 0.125f, 0.125f, 0.0625f);
    put(set, 1, 2, 1, 0.765625f, 0.75f, 0.0625f);
    put(set, 1, 3, 1, 0.125f, 0.125f, 0.0625f);
    put_light(set, 2, 1, 1, 1);
    put_light(set, 1, 2, 1, 1);
    put_light(set, 0, 2, 1, 1);
    put_light(set, 1, 3, 1, 5);
    put_share(set, 2, 1, 1, 1);
    put_share(set, 0, 2, 1, 0.5f);
    put_share(set, 1, 2, 1, 0.5f);
    put_again(set, 2, 1, 4);
    Work w = open_work(set, 1);
    share_light(&w, RETEX_FOOTPRINT_BROAD, weights, 3, light);
    EXPECT(0, result_uv(&w, 0), 0.125f, 0.125f);
    EXPECT(0.016f, result_uv(&w, 1), 0.76f, 0.75f);
    EXPECT(0, result_uv(&w, 2), 0, 0, 0);
    EXPECT(0, result_spread(&w, 2), 0, 0, 0);
    EXPECT(1e-6f, result(&w, light_part(set, 0)), 3, 6, 12);
    EXPECT(1e-6f, result(&w, light_part(set, 1)), 1, 2, 4);
    EXPECT(0, result(&w, light_part(set, 2)), 0, 0, 0);
    EXPECT(0, result(&w, share_part(set, 0)), 0.5f);
    EXPECT(0, result(&w, share_part(set, 1)), 0.5f);
    EXPECT(0, result(&w, share_part(set, 2)), 0);
    close_work(&w);
}

/* Light that meets targets again weighs as in the film: two more hits make it a quarter. */
static void test_weight_of_light_that_goes_on(void **state)
{
    (void)state;
    static const float weights[] = {1, 1};
    RetexSet *set = again_set(RETEX_FOOTPRINT_BROAD, 1);
    put(set, 0, 1, 1, 0, 0, 0.0625f);
    put(set, 0, 2, 1, 1, 0, 0.0625f);
    put_light(set, 0, 1, 1, 1);
    put_light(set, 0, 2, 1, 0.5f);
    put_again(set, 2, 1, 2);
    Work w = open_work(set, 1);
    share_light(&w, RETEX_FOOTPRINT_BROAD, weights, 2, grey);
    EXPECT(1.0f / 64, result_uv(&w, 0), 0.5f, 0);
    EXPECT(SPREAD_STEP, result_spread(&w, 0), 0.5f, 0, 0);
    close_work(&w);
}

static void test_periodic(void **state)
{
    (void)state;
    static const float weights[] = {1, 1};
    for (int periodic = 0; periodic < 2; periodic++) {
        RetexSet *set = cluster_set(RETEX_FOOTPRINT_BROAD, 1);
        set->targets[0].periodic[0] = periodic;
        put(set, 0, 1, 1, 0.9375f, 0.5f, 0.0625f);
        put(set, 0, 2, 1, 0.125f, 0.5f, 0.0625f);
        put_light(set, 0, 1, 1, 1);
        put_light(set, 0, 2, 1, 1);
        Work w = open_work(set, 1);
        share_light(&w, RETEX_FOOTPRINT_BROAD, weights, 2, grey);
        EXPECT(0.4f / 64, result_uv(&w, 0), periodic ? 0.03125f : 0.53125f, 0.5f);
        EXPECT(SPREAD_STEP, result_spread(&w, 0), periodic ? 0.09375f : 0.40625f, 0, 0);
        close_work(&w);
    }
}

/* No pixel around has any cluster that counts: as of sharp ones. */
static void test_broad_without_any(void **state)
{
    (void)state;
    static const float weights[] = {1, 1};
    RetexSet *set = again_set(RETEX_FOOTPRINT_BROAD, 2);
    put(set, 1, 2, 1, 0.5f, 0.5f, 0.0625f); /* without light: it can only be borrowed */
    Work w = open_work(set, 1);
    for (int count = 2; count > 0; count--) { /* as a neighbour, then as another pixel of the window */
        share_light(&w, RETEX_FOOTPRINT_BROAD, weights, count, grey);
        EXPECT(0, result(&w, light_part(set, 0)), 0, 0, 0);
        EXPECT(0, result(&w, light_part(set, 1)), 1, 1, 1);
        expect_copied(&w, 0, 2, 1);
        EXPECT(0, result_uv(&w, 1), 0.5f, 0.5f, 0.0625f);
        EXPECT(0, result(&w, share_part(set, 1)), 1);
    }
    put(set, 1, 2, 1, 0, 0, 0);
    share_light(&w, RETEX_FOOTPRINT_BROAD, weights, 2, grey);
    EXPECT(0, result(&w, light_part(set, 1)), 0, 0, 0);
    expect_copied(&w, 1, 1, 1);
    close_work(&w);
}

static void test_what_is_no_number(void **state)
{
    (void)state;
    static const float weights[] = {1, 1, NAN, 1, 1, 1, INFINITY};
    RetexSet *set = cluster_set(RETEX_FOOTPRINT_BROAD, 1);
    for (int x = 1; x < WIDTH; x++) {
        put(set, 0, x, 1, x == 1 ? 0.25f : 1, 0.5f, 0.0625f);
        put_light(set, 0, x, 1, 1);
    }
    put(set, 0, 2, 1, NAN, 0.5f, 1);
    put_spread(set, 0, 4, 1, INFINITY, 0, 0);
    put_light(set, 0, 5, 1, NAN);
    put_light(set, 0, 6, 1, -INFINITY);
    Work w = open_work(set, 1);
    share_light(&w, RETEX_FOOTPRINT_BROAD, weights, 7, grey);
    EXPECT(0, result_uv(&w, 0), 0.25f, 0.5f, 0.0625f);
    EXPECT(0, result(&w, light_part(set, 0)), 1, 1, 1);
    close_work(&w);
}

/* ---- later, and layout paper ---- */

/* Two hits of layout paper. */
static RetexSet *paper_set(void)
{
    RetexSet *set = start_set(WIDTH, HEIGHT, 1);
    strcpy(set->layout, "paper");
    for (int k = 0; k < 2; k++)
        add_footprint(set, 0, RETEX_FOOTPRINT_HIT, 1 + k, "RG");
    add_term(set, 2, 0, 1);
    return set;
}

/* Interreflections of two targets: where the pixel has any, of whichever target, all stay, however much light the
 * neighbours have of theirs. */
static RetexSet *later_set(void)
{
    RetexSet *set = start_set(WIDTH, HEIGHT, 2);
    for (int t = 0; t < 2; t++)
        add_footprint(set, t, RETEX_FOOTPRINT_SHARP, 1, "RGB");
    for (int k = 2; k < 5; k++)
        add_footprint(set, k == 4, RETEX_FOOTPRINT_INTERREFLECTION, 2 + k % 2, "RGB");
    add_term(set, 1, 0, 0);
    add_term(set, 2, 1, add_mixture(set, 2, 3, "R"));
    for (int x = 2; x < 5; x++) { /* the second neighbour has the most */
        put_again(set, x, 1, x == 3 ? 8 : 4);
        put(set, 2, x, 1, 0.125f * (float)x, 0.25f, 0.25f);
        put(set, 3, x, 1, 0.75f, 0.25f, 0.125f * (float)x);
        put_share(set, 2, x, 1, 0.25f);
        put_share(set, 3, x, 1, 0.75f);
        put_rgb(set, set->footprints[2].albedo, x, 1, 1, (float)x, 0);
    }
    return set;
}

static void test_later(void **state)
{
    (void)state;
    static const float weights[] = {1, 0.75f, 1, 0.5f};
    for (int of = 2; of < 5; of += 2) { /* the first target, and the second */
        RetexSet *set = later_set();
        put_again(set, 1, 1, 2);
        put(set, of, 1, 1, 0.0625f, 0.25f, 0.25f);
        put_spread(set, of, 1, 1, 0.25f, 0.375f, 0.5f);
        put_share(set, of, 1, 1, 0.75f);
        put_rgb(set, set->footprints[of].albedo, 1, 1, 1, 0, 0);
        Work w = open_work(set, 1);
        share_later(&w, weights, 4);
        for (int k = 2; k < 5; k++)
            expect_copied(&w, k, 1, 1);
        close_work(&w);
    }
}

/* A share of nothing, and light that no cluster has a share of, are none. Nor is a neighbour's that is no number. */
static void test_later_of_none(void **state)
{
    (void)state;
    static const float weights[] = {1, 0.5f, 0.25f, 0.75f};
    for (int none = 0; none < 5; none++) {
        RetexSet *set = later_set();
        put_again(set, 1, 1, none == 1 ? 0 : 2);
        if (none)
            put(set, 2, 1, 1, none == 4 ? NAN : 0.0625f, 0.25f, none == 2 ? 0 : 0.25f);
        put_share(set, 2, 1, 1, none == 3 ? 0 : 0.75f);
        Work w = open_work(set, 1);
        share_later(&w, weights, 4);
        for (int k = 2; k < 5; k++)
            expect_copied(&w, k, 4, 1);
        for (int k = 2; k < 4; k++)
            put(set, k, 4, 1, NAN, 0.25f, 0.25f);
        share_later(&w, weights, 4);
        for (int k = 2; k < 5; k++)
            expect_copied(&w, k, 2, 1);
        share_later(&w, weights, 1); /* nobody has any: as it was */
        for (int k = 2; k < 5 && none != 4; k++)
            expect_copied(&w, k, 1, 1);
        close_work(&w);
    }
}

/* A hit's width is what a neighbour's may be away by a tenth of, the short way round where the texture is periodic;
 * beyond, it is as if the neighbour had none. */
static void test_hits_near_and_far(void **state)
{
    (void)state;
    static const float weights[] = {1, 1}, near[] = {0.03125f, -0.03125f, 1.03125f, 0.0625f, 0.5f, 4.5f};
    for (int k = 0; k < 6; k++)
        for (int periodic = 0; periodic < 2; periodic++) {
            const float u = near[k];
            const int pooled = fabsf(u) < 0.04f || (periodic && k == 2);
            RetexSet *set = paper_set();
            set->targets[0].periodic[0] = periodic;
            for (int x = 1; x < 3; x++) {
                put(set, 1, x, 1, x == 1 ? 0 : u, 0.5f, 0.25f);
                put_spread(set, 1, x, 1, 0.25f, 0.375f, 0); /* 0.45 wide */
                put_rgb(set, set->footprints[1].albedo, x, 1, (float)(x - 1), 0.5f, 0);
            }
            Work w = open_work(set, 1);
            share_later(&w, weights, 2);
            const float half = 0.03125f / 2, su = sqrtf(0.0625f + (pooled ? half * half : 0));
            const float middle = k != 1 ? half : periodic ? 1 - half : -half;
            EXPECT(0.25f / 64, result_uv(&w, 1), pooled ? middle : 0, 0.5f, pooled ? 0.25f : 0.125f);
            EXPECT(SPREAD_STEP, result_spread(&w, 1), su, 0.375f);
            EXPECT(1e-6f, result_albedo(&w, 1), pooled ? 0.5f : 0, 0.5f, 0);
            close_work(&w);
        }
}

/* Where the pixel itself has none, a neighbour's is what others are near to. */
static void test_hits_of_none(void **state)
{
    (void)state;
    static const float weights[] = {1, 1, 0.5f, 0.5f};
    RetexSet *set = paper_set();
    for (int x = 2; x < 5; x++) {
        put(set, 1, x, 1, x == 3 ? 3 : 0.25f, 0.5f, 0.5f);
        put_spread(set, 1, x, 1, 0.25f, 0.25f, 0);
    }
    Work w = open_work(set, 1);
    share_later(&w, weights, 4);
    EXPECT(COVERAGE_STEP, result_uv(&w, 1), 0.25f, 0.5f, 0.25f); /* 1.5 of 3 pixels */
    EXPECT(SPREAD_STEP, result_spread(&w, 1), 0.25f, 0.25f);
    close_work(&w);
}

static void test_paper(void **state)
{
    (void)state;
    static const float weights[] = {1, 0.5f, 0.5f, 0.5f};
    RetexSet *set = paper_set();
    put(set, 1, 1, 1, 0, 0.5f, 0.5f);
    put(set, 1, 2, 1, 0.0625f, 0.5f, 1); /* near: a tenth of the width is 0.1 */
    put(set, 1, 4, 1, 4, 0.5f, 1);       /* far */
    for (int x = 1; x < 5; x++)
        put_spread(set, 1, x, 1, 1, 0.25f, 0);
    put_rgb(set, set->footprints[1].albedo, 1, 1, 0, 0.5f, 1);
    put_rgb(set, set->footprints[1].albedo, 2, 1, 1, 0.5f, 0);
    put_rgb(set, set->footprints[1].albedo, 4, 1, 9, 9, 9);
    Work w = open_work(set, 1);
    assert_false(w.written[set->footprints[0].uv]);
    assert_false(w.written[set->terms[1].radiance]); /* no cluster */
    for (int far = 0; far < 2; far++) {
        share_later(&w, weights, far ? 4 : 3);
        EXPECT(1.0f / 64, result_uv(&w, 1), 0.03125f);
        EXPECT(0.25f / 64, result_uv(&w, 1) + 1, 0.5f);
        if (!far)
            EXPECT(COVERAGE_STEP, result_uv(&w, 1) + 2, 0.5f); /* (0.5 + 0.5 * 1 + 0.5 * 0) / 2 */
        EXPECT(SPREAD_STEP, result_spread(&w, 1), sqrtf(1 + 0.03125f * 0.03125f), 0.25f);
        EXPECT(1e-6f, result_albedo(&w, 1), 0.5f, 0.5f, 0.5f);
    }
    close_work(&w);
}

/* Without smoothing only what may be borrowed is written. */
static void test_which_parts_are_written(void **state)
{
    (void)state;
    for (int footprints = 0; footprints < 2; footprints++) {
        RetexSet *set = again_set(RETEX_FOOTPRINT_BROAD, 2);
        Work w = open_work(set, footprints);
        for (int k = 0; k < 4; k++) {
            const int written = k < 2 || footprints;
            assert_int_equal(w.written[set->footprints[k].uv], written);
            assert_int_equal(w.written[set->footprints[k].spread], written);
            assert_int_equal(w.written[set->footprints[k].albedo], written);
            assert_int_equal(w.written[share_part(set, k)], written);
        }
        assert_true(w.written[light_part(set, 0)] && w.written[light_part(set, 1)]);
        assert_false(w.written[set->terms[0].radiance] || w.written[set->terms[3].radiance] || w.written[0]);
        close_work(&w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_proportions_are_kept),
        cmocka_unit_test(test_light_by_coverage),
        cmocka_unit_test(test_borrowing),
        cmocka_unit_test(test_quadrants_are_lent),
        cmocka_unit_test(test_light_as_a_weight),
        cmocka_unit_test(test_light_of_lamps_is_counted_once),
        cmocka_unit_test(test_shared_parts_stay),
        cmocka_unit_test(test_shares_are_mended),
        cmocka_unit_test(test_albedo_is_of_the_light),
        cmocka_unit_test(test_identical_neighbours),
        cmocka_unit_test(test_exact_pooling),
        cmocka_unit_test(test_two_clusters),
        cmocka_unit_test(test_weight_of_light_that_goes_on),
        cmocka_unit_test(test_periodic),
        cmocka_unit_test(test_broad_without_any),
        cmocka_unit_test(test_what_is_no_number),
        cmocka_unit_test(test_later),
        cmocka_unit_test(test_hits_near_and_far),
        cmocka_unit_test(test_hits_of_none),
        cmocka_unit_test(test_later_of_none),
        cmocka_unit_test(test_paper),
        cmocka_unit_test(test_which_parts_are_written),
    };
    return cmocka_run_group_tests_name("denoise_footprints", tests, NULL, NULL);
}
