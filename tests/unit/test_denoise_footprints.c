/* What becomes of a pixel's footprints when its light was filtered: kept, borrowed or pooled; by hand on sets of few
 * pixels, and as facts on random ones. */
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "denoise_footprints.h"

enum { WIDTH = 8, HEIGHT = 4 };
static const float grey[3] = {1, 1, 1}, black[3] = {0, 0, 0};

/* ---- sets ---- */

static int add_part(RetexSet *set, const char *letters, const char *what, int number)
{
    RetexError err = {0};
    char name[64];
    int part;
    snprintf(name, sizeof name, "%s-%d", what, number);
    test_must(retex_set_add_part(set, name, letters, RETEX_FLOAT, 0, 0, &part, &err), &err);
    return part;
}

static int add_footprint(RetexSet *set, int target, RetexFootprintKind kind, int hit, const char *spread)
{
    RetexFootprint footprint = {.target = target, .kind = kind, .hit = hit};
    RetexError err = {0};
    int index, number = set->nfootprints;
    footprint.uv = add_part(set, "RGA", "uv", number);
    footprint.spread = add_part(set, spread, "spread", number);
    footprint.albedo = add_part(set, "RGB", "albedo", number);
    test_must(retex_set_add_footprint(set, &footprint, &index, &err), &err);
    return index;
}

/* Its factors: the first once, the second for all others. */
static int add_term(RetexSet *set, int nfactors, int first, int others)
{
    RetexTerm term = {.kind = nfactors ? RETEX_TERM_DEP : RETEX_TERM_INDEP, .nfactors = nfactors, .factors = {first}};
    RetexError err = {0};
    for (int k = 1; k < nfactors; k++)
        term.factors[k] = others;
    term.radiance = add_part(set, "RGB", "term", set->nterms);
    test_must(retex_set_add_term(set, &term, NULL, &err), &err);
    return term.radiance;
}

/* A mixture of so many footprints from `first` on, whose weights are new parts if there are any letters. */
static int add_mixture(RetexSet *set, int first, int count, const char *letters)
{
    RetexMixture mixture = {.nshares = count};
    RetexError err = {0};
    int index;
    for (int k = 0; k < count; k++)
        mixture.shares[k] = (struct RetexShare){first + k, add_part(set, letters, "share", first + k)};
    test_must(retex_set_add_mixture(set, &mixture, &index, &err), &err);
    return RETEX_MIXTURE(index);
}

static RetexSet *start_set(int width, int height, int ntargets)
{
    RetexSet *set;
    RetexError err = {0};
    test_must(retex_set_create(&set, width, height, &err), &err);
    strcpy(set->layout, "footprints");
    set->spp = 16, set->orders = 6, set->ntargets = ntargets;
    for (int t = 0; t < ntargets; t++) {
        snprintf(set->targets[t].name, sizeof set->targets[t].name, "T%d", t);
        set->targets[t].original = -1;
    }
    test_must(retex_set_add_part(set, "beauty", "RGB", RETEX_FLOAT, 0, 0, NULL, &err), &err);
    add_term(set, 0, 0, 0);
    return set;
}

/* One target with so many clusters, footprints 0..count-1, whose terms are 1..count. */
static RetexSet *cluster_set(RetexFootprintKind kind, int count)
{
    RetexSet *set = start_set(WIDTH, HEIGHT, 1);
    for (int k = 0; k < count; k++)
        add_footprint(set, 0, kind, 1 + k, "RGB");
    for (int k = 0; k < count; k++)
        add_term(set, 1, k, 0);
    return set;
}

/* The same, and light that meets the target again, twice: the last term, on two later footprints. Mixtures: the
 * clusters', the later ones'. */
static RetexSet *again_set(RetexFootprintKind kind, int count)
{
    RetexSet *set = cluster_set(kind, count);
    for (int k = 0; k < 2; k++)
        add_footprint(set, 0, RETEX_FOOTPRINT_LATER, 1 + count + k, "RGB");
    int first = count > 1 ? add_mixture(set, 0, count, "R") : 0;
    int later = add_mixture(set, count, 2, "R");
    add_term(set, 3, first, later);
    return set;
}

static float *pixel(const RetexSet *set, int part, int x, int y)
{
    const RetexImage *im = &set->parts[part].image;
    return im->pixels + retex_image_index(im, x, y);
}

static int share_part(const RetexSet *set, int footprint)
{
    for (int m = 0; m < set->nmixtures; m++)
        for (int k = 0; k < set->mixtures[m].nshares; k++)
            if (set->mixtures[m].shares[k].footprint == footprint)
                return set->mixtures[m].shares[k].weight;
    return -1;
}

static void put(RetexSet *set, int footprint, int x, int y, float u, float v, float coverage)
{
    float *uv = pixel(set, set->footprints[footprint].uv, x, y);
    uv[0] = u, uv[1] = v, uv[2] = coverage;
}

static void put_spread(RetexSet *set, int footprint, int x, int y, float su, float sv, float correlation)
{
    int part = set->footprints[footprint].spread;
    float *spread = pixel(set, part, x, y);
    spread[0] = su, spread[1] = sv;
    if (set->parts[part].image.channels == 3)
        spread[2] = correlation;
}

static void put_rgb(RetexSet *set, int part, int x, int y, float r, float g, float b)
{
    float *to = pixel(set, part, x, y);
    to[0] = r, to[1] = g, to[2] = b;
}

static int light_part(const RetexSet *set, int cluster)
{
    return set->terms[1 + cluster].radiance;
}

static void put_light(RetexSet *set, int cluster, int x, int y, float light)
{
    put_rgb(set, light_part(set, cluster), x, y, light, light, light);
}

static void put_share(RetexSet *set, int footprint, int x, int y, float share)
{
    *pixel(set, share_part(set, footprint), x, y) = share;
}

static void put_again(RetexSet *set, int x, int y, float light)
{
    put_rgb(set, set->terms[set->nterms - 1].radiance, x, y, light, light, light);
}

/* ---- calls ---- */

/* A set, and a band that holds all its rows; what has not been written is -7. */
typedef struct Work {
    Denoiser d;
    Footprints *footprints;
    Band band;
    unsigned char *written;
} Work;

static Work open_work(RetexSet *set, int footprints)
{
    Work w = {.d = {.set = set, .params = RETEX_DENOISE_INIT}};
    RetexError err = {0};
    test_add_denoise_data(set);
    w.d.params.footprints = footprints;
    w.d.roi = (RetexRoi){0, 0, set->width, set->height, 0, 3};
    test_must(signals_open(&w.d.signals, set, &err), &err);
    test_must(denoise_footprints_open(&w.footprints, &w.d, &err), &err);
    w.written = calloc((size_t)set->nparts, 1);
    footprints_mark_written(w.footprints, &w.d, w.written);
    w.band = (Band){.rows = set->height, .parts = calloc((size_t)set->nparts, sizeof(float *))};
    for (int k = 0; k < set->nparts; k++) {
        const RetexImage *im = &set->parts[k].image;
        size_t n = (size_t)im->width * (size_t)im->height * (size_t)im->channels;
        if (!w.written[k])
            continue;
        w.band.parts[k] = malloc(n * sizeof(float));
        for (size_t i = 0; i < n; i++)
            w.band.parts[k][i] = -7;
    }
    return w;
}

static void close_work(Work *w)
{
    for (int k = 0; k < w->d.set->nparts; k++)
        free(w->band.parts[k]);
    free(w->band.parts);
    free(w->written);
    denoise_footprints_close(&w->footprints);
    assert_null(w->footprints);
    signals_close(&w->d.signals);
    retex_set_close(&w->d.set);
}

static const Signal *find_signal(const Work *w, int target, RetexFootprintKind kind)
{
    for (int s = 0; s < w->d.signals.count; s++)
        if (w->d.signals.of[s].target == target && w->d.signals.of[s].kind == kind)
            return &w->d.signals.of[s];
    fail();
    return NULL;
}

/* To pixel (1,1), with neighbours to its right of these weights. */
static void share_light(Work *w, RetexFootprintKind kind, const float *weights, int count, const float light[3])
{
    Neighbour neighbours[WIDTH];
    for (int k = 0; k < count; k++)
        neighbours[k] = (Neighbour){1 + k, 1, weights[k]};
    footprints_share_light(w->footprints, &w->d, find_signal(w, 0, kind), 1, 1, neighbours, count, light, &w->band);
}

static void pool_later(Work *w, const float *weights, int count)
{
    Neighbour neighbours[WIDTH];
    for (int k = 0; k < count; k++)
        neighbours[k] = (Neighbour){1 + k, 1, weights[k]};
    footprints_pool_later(w->footprints, &w->d, 1, 1, neighbours, count, &w->band);
}

static const float *result(const Work *w, int part)
{
    int channels = w->d.set->parts[part].image.channels;
    assert_non_null(w->band.parts[part]);
    return w->band.parts[part] + (w->d.set->width + 1) * channels;
}

static const float *result_uv(const Work *w, int footprint)
{
    return result(w, w->d.set->footprints[footprint].uv);
}

static const float *result_spread(const Work *w, int footprint)
{
    return result(w, w->d.set->footprints[footprint].spread);
}

static const float *result_albedo(const Work *w, int footprint)
{
    return result(w, w->d.set->footprints[footprint].albedo);
}

static void expect_values(const float *is, int count, const float *should, float tolerance)
{
    for (int k = 0; k < count; k++)
        if (!(fabsf(is[k] - should[k]) <= tolerance))
            fail_msg("value %d is %.9g, not %.9g", k, is[k], should[k]);
}
#define EXPECT(tolerance, is, ...)                                                                                     \
    do {                                                                                                               \
        const float should[] = {__VA_ARGS__};                                                                          \
        expect_values(is, sizeof should / sizeof *should, should, tolerance);                                          \
    } while (0)

/* Footprint and share of a pixel are those of another in the set. */
static void expect_copied(const Work *w, int footprint, int x, int y)
{
    const RetexSet *set = w->d.set;
    const int parts[] = {set->footprints[footprint].uv, set->footprints[footprint].spread,
                         set->footprints[footprint].albedo, share_part(set, footprint)};
    for (int k = 0; k < 4; k++)
        if (parts[k] >= 0)
            expect_values(result(w, parts[k]), set->parts[parts[k]].image.channels, pixel(set, parts[k], x, y), 0);
}

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

static void expect_proportions(RetexFootprintKind kind, int footprints)
{
    static const float weights[] = {1, 1, 1, 1}, light[] = {2, 4, 8};
    RetexSet *set = sharp_set(kind);
    put_rgb(set, light_part(set, 0), 1, 1, 0.5f, 0.5f, 0.5f);
    put_rgb(set, light_part(set, 2), 1, 1, 1 / 0.2126f, 0.5f / 0.7152f, 0); /* luminance 1.5 */
    Work w = open_work(set, footprints);
    share_light(&w, kind, weights, 4, light);
    EXPECT(1e-6f, result(&w, light_part(set, 0)), 0.5f, 1, 2);
    EXPECT(0, result(&w, light_part(set, 1)), 0, 0, 0);
    EXPECT(1e-5f, result(&w, light_part(set, 2)), 1.5f, 3, 6);
    for (int k = 0; k < 3; k++)
        expect_copied(&w, k, 1, 1);
    close_work(&w);
}

static void test_proportions_are_kept(void **state)
{
    (void)state;
    expect_proportions(RETEX_FOOTPRINT_SHARP, 0);
    expect_proportions(RETEX_FOOTPRINT_SHARP, 1);
    expect_proportions(RETEX_FOOTPRINT_BROAD, 0);
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
        int lender = dark == 1 ? 1 : 4;
        for (int k = 0; k < 3; k++) {
            put(set, k, 1, 1, 0, 0, 0);
            put_light(set, k, 4, 1, (float)k);
            if (dark == 2) /* pixel 4 has nothing either, and 3 is too far off to be one of two neighbours */
                put(set, k, 4, 1, 0, 0, 0);
        }
        Work w = open_work(set, 1);
        share_light(&w, RETEX_FOOTPRINT_SHARP, weights, dark == 2 ? 2 : 4, dark == 1 ? black : light);
        float f = dark ? 0 : 1;
        EXPECT(0, result(&w, light_part(set, 0)), 0, 0, 0);
        EXPECT(1e-6f, result(&w, light_part(set, 1)), f * 2 / 3, f * 4 / 3, f * 8 / 3);
        EXPECT(1e-6f, result(&w, light_part(set, 2)), f * 4 / 3, f * 8 / 3, f * 16 / 3);
        for (int k = 0; k < 3; k++)
            expect_copied(&w, k, dark == 2 ? 1 : lender, 1);
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
        EXPECT(1e-6f, result_spread(&w, k), 0.125f, 0.25f, -0.5f);
        EXPECT(1e-6f, result_albedo(&w, k), 0.25f, 0.5f, 0.125f * (float)k);
        EXPECT(1e-6f, result(&w, light_part(set, k)), f, 2 * f, 3 * f);
        EXPECT(0, result(&w, share_part(set, k)), k == 2 ? 0.5f : 0.25f);
        /* (sum of weights)^2 / sum of squares */
        EXPECT(1e-6f, result_uv(&w, k) + 2, 0.03125f * 4.375f * 4.375f / (3 + 0.25f + 0.5625f + 0.015625f));
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
    EXPECT(1e-6f, result_uv(&w, 0) + 2, 16 / (1 / 0.0625f + 9 / 0.125f));
    EXPECT(1e-6f, result_spread(&w, 0), su, sv, covariance / (su * sv));
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
    EXPECT(1e-6f, result_spread(&w, 0), 0.5f, 0, 0);
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
        EXPECT(1e-6f, result_spread(&w, 0), periodic ? 0.09375f : 0.40625f, 0, 0);
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
    share_light(&w, RETEX_FOOTPRINT_BROAD, weights, 2, grey);
    EXPECT(0, result(&w, light_part(set, 0)), 0, 0, 0);
    EXPECT(0, result(&w, light_part(set, 1)), 1, 1, 1);
    expect_copied(&w, 0, 2, 1);
    EXPECT(0, result_uv(&w, 1), 0.5f, 0.5f, 0.0625f);
    EXPECT(0, result(&w, share_part(set, 1)), 1);
    share_light(&w, RETEX_FOOTPRINT_BROAD, weights, 1, grey);
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

static void test_later(void **state)
{
    (void)state;
    static const float weights[] = {1, 0.5f};
    RetexSet *set = start_set(WIDTH, HEIGHT, 2);
    for (int t = 0; t < 2; t++)
        add_footprint(set, t, RETEX_FOOTPRINT_SHARP, 1, "RGB");
    for (int k = 2; k < 5; k++)
        add_footprint(set, k == 4, RETEX_FOOTPRINT_LATER, 2 + k % 2, "RGB");
    add_term(set, 1, 0, 0);
    add_term(set, 2, 1, add_mixture(set, 2, 3, "R"));
    /* luminance 2 and 4 of light that goes on, halved: 1 * 1 and 0.5 * 2 */
    put_again(set, 1, 1, 2);
    put_again(set, 2, 1, 4);
    put(set, 2, 1, 1, 0.75f, 0.25f, 0.25f);
    put(set, 4, 1, 1, 0, 0, 0.25f);
    put(set, 2, 2, 1, 0.125f, 0.25f, 0.25f);
    put(set, 3, 2, 1, 0.75f, 0.25f, 0.25f);
    put_share(set, 2, 1, 1, 0.75f);
    put_share(set, 4, 1, 1, 0.25f);
    put_share(set, 2, 2, 1, 0.5f);
    put_share(set, 3, 2, 1, 0.5f);
    put_rgb(set, set->footprints[2].albedo, 1, 1, 1, 0, 0);
    Work w = open_work(set, 1);
    pool_later(&w, weights, 2);
    EXPECT(0, result_uv(&w, 2), 0.125f, 0.25f, 0.25f);
    EXPECT(1e-6f, result_uv(&w, 3), 0.75f, 0.25f, 0.25f * 1.25f * 1.25f / (0.75f * 0.75f + 0.25f));
    EXPECT(0, result_uv(&w, 4), 0, 0, 0.25f);
    EXPECT(1e-6f, result_albedo(&w, 3), 0.6f, 0, 0);
    EXPECT(1.0f / 1024, result(&w, share_part(set, 2)), 0.25f);
    EXPECT(1.0f / 1024, result(&w, share_part(set, 3)), 0.625f);
    EXPECT(1.0f / 1024, result(&w, share_part(set, 4)), 0.125f);
    put_share(set, 2, 1, 1, 0); /* nobody has any: as it was */
    put_share(set, 4, 1, 1, 0);
    pool_later(&w, weights, 1);
    for (int k = 2; k < 5; k++)
        expect_copied(&w, k, 1, 1);
    close_work(&w);
}

static void test_paper(void **state)
{
    (void)state;
    static const float weights[] = {1, 0.5f, 0.5f};
    RetexSet *set = start_set(WIDTH, HEIGHT, 1);
    strcpy(set->layout, "paper");
    for (int k = 0; k < 2; k++)
        add_footprint(set, 0, RETEX_FOOTPRINT_HIT, 1 + k, "RG");
    add_term(set, 2, 0, 1);
    put(set, 1, 1, 1, 0, 0.5f, 0.5f);
    put(set, 1, 2, 1, 4, 0.5f, 1);
    put_spread(set, 1, 1, 1, 1, 0.25f, 0);
    put_spread(set, 1, 2, 1, 1, 0.25f, 0);
    put_rgb(set, set->footprints[1].albedo, 1, 1, 0, 0.5f, 1);
    put_rgb(set, set->footprints[1].albedo, 2, 1, 1, 0.5f, 0);
    Work w = open_work(set, 1);
    assert_false(w.written[set->footprints[0].uv]);
    assert_false(w.written[set->terms[1].radiance]); /* no cluster */
    pool_later(&w, weights, 3);
    EXPECT(2.24f / 64, result_uv(&w, 1), 2);
    EXPECT(0.25f / 64, result_uv(&w, 1) + 1, 0.5f);
    EXPECT(1e-6f, result_uv(&w, 1) + 2, 0.5f); /* (0.5 + 0.5 * 1 + 0.5 * 0) / 2 */
    EXPECT(1e-6f, result_spread(&w, 1), sqrtf(5), 0.25f);
    EXPECT(1e-6f, result_albedo(&w, 1), 0.5f, 0.5f, 0.5f);
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

/* ---- odd sets ---- */

static float *random_pixels(RetexSet *set, int part, uint32_t *seed)
{
    RetexImage *im = &set->parts[part].image;
    for (size_t i = 0; i < (size_t)im->width * (size_t)im->height * (size_t)im->channels; i++)
        im->pixels[i] = (float)test_random(seed);
    return im->pixels;
}

/* All of a set's pixels, with a window of stride 3. */
static void denoise_all(Work *w, const float light[3])
{
    const RetexSet *set = w->d.set;
    for (int y = 0; y < set->height; y++)
        for (int x = 0; x < set->width; x++) {
            Neighbour neighbours[25] = {{x, y, 1}};
            int count = 1;
            for (int dy = -6; dy <= 6; dy += 3)
                for (int dx = -6; dx <= 6; dx += 3)
                    if ((dx || dy) && x + dx >= 0 && y + dy >= 0 && x + dx < set->width && y + dy < set->height)
                        neighbours[count++] = (Neighbour){x + dx, y + dy, 1.0f / (float)(1 + abs(dx) + abs(dy))};
            for (int s = 0; s < w->d.signals.count; s++)
                footprints_share_light(w->footprints, &w->d, &w->d.signals.of[s], x, y, neighbours, count, light,
                                       &w->band);
            footprints_pool_later(w->footprints, &w->d, x, y, neighbours, count, &w->band);
        }
}

static int is_cluster(const RetexSet *set, const SignalMember *m)
{
    const RetexTerm *term = &set->terms[m->term];
    return term->nfactors == 1 && term->factors[0] >= 0 &&
           set->footprints[term->factors[0]].kind != RETEX_FOOTPRINT_HIT;
}

/* Clusters hold the light, and whatever is written is a number. */
static void expect_whole(const Work *w, const float light[3])
{
    const RetexSet *set = w->d.set;
    for (int s = 0; s < w->d.signals.count; s++)
        for (size_t i = 0; i < 3 * (size_t)set->width * (size_t)set->height; i++) {
            const Signal *signal = &w->d.signals.of[s];
            float sum = 0;
            int count = 0;
            for (int k = 0; k < signal->nmembers; k++)
                if (is_cluster(set, &signal->members[k]))
                    sum += w->band.parts[signal->members[k].part][i], count++;
            if (count && !(fabsf(sum - light[i % 3]) <= 1e-5f * light[i % 3]))
                fail_msg("signal %d has %g of %g", s, sum, light[i % 3]);
        }
    for (int k = 0; k < set->nparts; k++) {
        const RetexImage *im = &set->parts[k].image;
        for (int i = 0; i < im->width * im->height * im->channels && w->band.parts[k]; i++)
            assert_true(isfinite(w->band.parts[k][i]) && w->band.parts[k][i] != -7);
    }
}

/* As the film makes sets, of many clusters, all over the place. */
static RetexSet *random_set(int width, int height)
{
    RetexSet *set = start_set(width, height, 2);
    int kinds[2][2], later, first;
    uint32_t seed = 11;
    for (int t = 0; t < 2; t++)
        for (int kind = 0; kind < 2; kind++) {
            first = set->nfootprints;
            for (int k = 0; k < 3; k++)
                add_term(set, 1,
                         add_footprint(set, t, kind ? RETEX_FOOTPRINT_BROAD : RETEX_FOOTPRINT_SHARP, 1 + k, "RGB"), 0);
            kinds[t][kind] = add_mixture(set, first, 3, "R");
        }
    first = set->nfootprints;
    for (int k = 0; k < 4; k++)
        add_footprint(set, k / 2, RETEX_FOOTPRINT_LATER, 7 + k % 2, "RGB");
    later = add_mixture(set, first, 4, "R");
    for (int t = 0; t < 2; t++)
        for (int kind = 0; kind < 2; kind++)
            for (int n = 2; n < 6; n++)
                add_term(set, n, kinds[t][kind], later);
    for (int k = 0; k < set->nparts; k++)
        random_pixels(set, k, &seed);
    return set;
}

static void test_shares_sum_to_one(void **state)
{
    (void)state;
    static const float light[] = {0.25f, 1, 3};
    RetexSet *set = random_set(19, 11);
    Work w = open_work(set, 1);
    denoise_all(&w, light);
    expect_whole(&w, light);
    for (int m = 0; m < set->nmixtures; m++) {
        if (set->footprints[set->mixtures[m].shares[0].footprint].kind == RETEX_FOOTPRINT_SHARP)
            continue;
        for (int i = 0; i < 19 * 11; i++) {
            float sum = 0;
            for (int k = 0; k < set->mixtures[m].nshares; k++)
                sum += w.band.parts[set->mixtures[m].shares[k].weight][i];
            assert_true(fabsf(sum - 1) <= 0.5f / 256 * 2);
        }
    }
    close_work(&w);
}

static void test_odd_sets(void **state)
{
    (void)state;
    static const float light[] = {0.25f, 1, 3};
    for (int odd = 0; odd < 10; odd++)
        for (int footprints = 0; footprints < 2; footprints++) {
            RetexSet *set = random_set(13, 9);
            RetexFootprint *f = set->footprints;
            struct RetexShare *share = set->mixtures[1].shares;
            RetexError err = {0};
            switch (odd) {
            case 0: /* samples only */
                for (int k = 0; k < set->nfootprints; k++)
                    f[k].uv = f[k].spread = f[k].albedo = -1;
                break;
            case 1:
                f[4].uv = f[3].uv;
                break;
            case 2:
                f[4].spread = f[12].spread;
                break;
            case 3: /* of three channels */
                share[0].weight = add_part(set, "RGB", "colours", 0);
                random_pixels(set, share[0].weight, &(uint32_t){1});
                break;
            case 4: /* no shares of broad ones, nor of later ones */
                set->mixtures[1].nshares = set->mixtures[4].nshares = 1;
                break;
            case 5: /* a footprint twice, with different shares */
                share[1].footprint = share[0].footprint;
                break;
            case 6: /* light of two clusters in one part */
                set->terms[5].radiance = set->terms[4].radiance;
                break;
            case 7: /* two terms of one cluster */
                set->terms[5].factors[0] = set->terms[4].factors[0];
                break;
            case 8: /* more than there is room for */
                for (int k = 0; k < 2 * RETEX_SHARES_MAX; k++)
                    random_pixels(set, add_term(set, 1, add_footprint(set, k % 2, RETEX_FOOTPRINT_BROAD, 9, "RG"), 0),
                                  &(uint32_t){(uint32_t)k});
                break;
            case 9: /* an image of another size */
                test_must(retex_set_add_part(set, "small", "RGA", RETEX_FLOAT, 2, 2, &f[5].uv, &err), &err);
                break;
            }
            Work w = open_work(set, footprints);
            assert_int_equal(odd && w.written[set->footprints[4].albedo], odd == 3 || odd == 4);
            denoise_all(&w, light);
            if (odd != 0 && odd != 6)
                expect_whole(&w, light);
            close_work(&w);
        }
}

/* Sets with everything that may be in them, as a file may say it. */
static void test_any_set(void **state)
{
    (void)state;
    static const float light[] = {0.25f, 1, 3};
    for (uint32_t seed = 1; seed < 9; seed++) {
        RetexSet *set = test_set(20, 11, seed);
        if (seed % 2)
            test_make_footprints(set);
        for (int k = 0; k < set->nfootprints && seed % 2; k++)
            set->footprints[k].kind = (RetexFootprintKind)((uint32_t)k * seed / 2 % 4);
        Work w = open_work(set, seed % 3 > 0);
        denoise_all(&w, light);
        close_work(&w);
    }
}

/* ---- twice, and how fast ---- */

static void test_repeatable(void **state)
{
    (void)state;
    enum { SIDE = 96 };
    Work once = open_work(random_set(SIDE, SIDE), 1), twice = open_work(random_set(SIDE, SIDE), 1);
    const RetexSet *set = once.d.set;
    struct timespec start, end;
    denoise_all(&once, grey);
    denoise_all(&twice, grey);
    for (int k = 0; k < set->nparts; k++)
        if (once.band.parts[k])
            assert_memory_equal(once.band.parts[k], twice.band.parts[k],
                                SIDE * SIDE * (size_t)set->parts[k].image.channels * sizeof(float));
    clock_gettime(CLOCK_MONOTONIC, &start);
    denoise_all(&once, grey);
    clock_gettime(CLOCK_MONOTONIC, &end);
    print_message("# %.2f microseconds a pixel: 2 sharp signals, 2 broad ones and later footprints\n",
                  (1e6 * (double)(end.tv_sec - start.tv_sec) + 1e-3 * (double)(end.tv_nsec - start.tv_nsec)) /
                      (SIDE * SIDE));
    close_work(&once);
    close_work(&twice);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_proportions_are_kept),
        cmocka_unit_test(test_light_by_coverage),
        cmocka_unit_test(test_borrowing),
        cmocka_unit_test(test_shares_are_mended),
        cmocka_unit_test(test_identical_neighbours),
        cmocka_unit_test(test_exact_pooling),
        cmocka_unit_test(test_two_clusters),
        cmocka_unit_test(test_weight_of_light_that_goes_on),
        cmocka_unit_test(test_periodic),
        cmocka_unit_test(test_broad_without_any),
        cmocka_unit_test(test_what_is_no_number),
        cmocka_unit_test(test_later),
        cmocka_unit_test(test_paper),
        cmocka_unit_test(test_which_parts_are_written),
        cmocka_unit_test(test_shares_sum_to_one),
        cmocka_unit_test(test_odd_sets),
        cmocka_unit_test(test_any_set),
        cmocka_unit_test(test_repeatable),
    };
    return cmocka_run_group_tests_name("denoise_footprints", tests, NULL, NULL);
}
