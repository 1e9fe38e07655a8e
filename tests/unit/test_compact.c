/* A compact set shows what the set does, in fewer numbers. */
#include "lib_footprints.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "set_parts.h"

enum { WIDE = 50, HIGH = 37 }; /* no multiple of 8 */

/* ---- sets ---- */

static float *at(RetexSet *set, int part, int x, int y)
{
    return pixel(set, part, x, y);
}

/* Light of two decades, with a part that has none, and a gradient. */
static void fill_light(RetexSet *set, int part, uint32_t *seed)
{
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++)
            for (int c = 0; c < 3; c++)
                at(set, part, x, y)[c] = x < 12 ? 0 : (float)(0.02 + test_random(seed) * 0.3 * x / WIDE);
}

static void fill_footprint(RetexSet *set, int f, uint32_t *seed)
{
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++) {
            const float u = (float)(0.1 * set->footprints[f].hit + 0.3 * test_random(seed));
            put(set, f, x, y, u, (float)y / HIGH, 0.5f);
            put_spread(set, f, x, y, 0.01f, 0.02f, 0.5f);
            put_rgb(set, set->footprints[f].albedo, x, y, 0.25f, 0.5f, 0.75f);
        }
}

static void fill_share(RetexSet *set, int part, uint32_t *seed)
{
    for (int i = 0; i < WIDE * HIGH; i++)
        set->parts[part].image.pixels[i] = (float)(0.1 + test_random(seed));
}

/* For each target: so many sharp and broad clusters, two later footprints, and light that goes on once and twice; with
 * several, once more to any of them. */
static RetexSet *whole_set(int ntargets, int count)
{
    RetexSet *set = start_set(WIDE, HIGH, ntargets);
    int first[RETEX_MAX_TARGETS][2], later[RETEX_MAX_TARGETS];
    RetexMixture any = {0};
    RetexError err;
    uint32_t seed = 7;
    for (int t = 0; t < ntargets; t++) {
        for (int kind = 0; kind < 2; kind++) {
            const int start = set->nfootprints;
            for (int k = 0; k < count; k++)
                add_footprint(set, t, kind ? RETEX_FOOTPRINT_BROAD : RETEX_FOOTPRINT_SHARP, 1 + k + kind * count,
                              "RGB");
            for (int k = 0; k < count; k++)
                add_term(set, 1, start + k, 0);
            first[t][kind] = count > 1 ? add_mixture(set, start, count, "R") : start;
        }
        const int start = set->nfootprints;
        for (int k = 0; k < 2; k++)
            add_footprint(set, t, RETEX_FOOTPRINT_LATER, 1 + 2 * count + k, "RGB");
        later[t] = add_mixture(set, start, 2, "R");
        for (int k = 0; k < 2; k++)
            any.shares[any.nshares++] = set->mixtures[RETEX_MIXTURE(later[t])].shares[k];
    }
    int all;
    test_must(retex_set_add_mixture(set, &any, &all, &err), &err);
    for (int t = 0; t < ntargets; t++)
        for (int kind = 0; kind < 2; kind++) {
            for (int b = 0; b < ntargets; b++)
                add_term(set, 2, first[t][kind], later[b]);
            add_term(set, 3, first[t][kind], RETEX_MIXTURE(all));
        }
    for (int i = 0; i < set->nfootprints; i++)
        fill_footprint(set, i, &seed);
    for (int i = 0; i < set->nterms; i++)
        fill_light(set, set->terms[i].radiance, &seed);
    for (int m = 0; m < set->nmixtures; m++)
        for (int k = 0; k < set->mixtures[m].nshares; k++)
            fill_share(set, set->mixtures[m].shares[k].weight, &seed);
    return set;
}

static RetexSet *compacted(const RetexSet *set, int broad, int later, int gain)
{
    RetexCompactParams params = RETEX_COMPACT_INIT;
    RetexError err = {0};
    RetexSet *compact;
    params.broad = broad, params.later = later, params.gain = gain;
    test_must(retex_set_compact(&compact, set, &params, 2, &err), &err);
    return compact;
}

/* The set's picture with constant textures, or the originals. */
static RetexImage picture(const RetexSet *set, const float *constant)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    RetexSamples *samples = NULL;
    RetexImage image = {0};
    RetexError err = {0};
    for (int t = 0; t < set->ntargets && constant; t++) {
        specs[t] = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
        strcpy(specs[t].target, set->targets[t].name);
        specs[t].constant = 1;
        for (int c = 0; c < 3; c++)
            specs[t].color[c] = constant[c];
    }
    if (constant)
        test_must(retex_sample(&samples, set, specs, set->ntargets, 1, &err), &err);
    test_must(retex_combine(&image, set, samples, NULL, NULL, 1, &err), &err);
    retex_samples_close(&samples);
    return image;
}

/* Within a thousandth of the brightest. */
static void expect_same_picture(const RetexSet *a, const RetexSet *b, const float *constant)
{
    RetexImage one = picture(a, constant), other = picture(b, constant);
    float most = 0;
    for (int i = 0; i < 3 * WIDE * HIGH; i++)
        most = fmaxf(most, one.pixels[i]);
    assert_true(most > 0);
    for (int i = 0; i < 3 * WIDE * HIGH; i++)
        assert_float_equal(one.pixels[i], other.pixels[i], 1e-3f * most);
    retex_image_free(&one);
    retex_image_free(&other);
}

/* ---- tests ---- */

/* What further hits are taken to meet where gains are too small to tell: see retex-set(5). */
static const float grey[] = {0.6f, 0.6f, 0.6f};
static const float white[] = {1, 1, 1}, bright[] = {0.9f, 0.6f, 0.1f};

static void grey_is_exact_at_all_scales(void **state)
{
    (void)state;
    for (int ntargets = 1; ntargets <= 3; ntargets++)
        for (int scale = 1; scale <= 8; scale *= 2) {
            RetexSet *set = whole_set(ntargets, 3), *compact = compacted(set, scale, scale, scale);
            expect_same_picture(set, compact, grey);
            retex_set_close(&set);
            retex_set_close(&compact);
        }
}

static void constants_are_exact_where_gains_are_whole(void **state)
{
    (void)state;
    for (int ntargets = 1; ntargets <= 2; ntargets++)
        for (int count = 1; count <= 4; count += 3) {
            RetexSet *set = whole_set(ntargets, count), *compact = compacted(set, 4, 8, 1);
            expect_same_picture(set, compact, bright);
            retex_set_close(&set);
            retex_set_close(&compact);
        }
}

static void originals_are_exact(void **state)
{
    RetexSet *set = whole_set(2, 2), *compact = compacted(set, 4, 8, 1);
    (void)state;
    expect_same_picture(set, compact, NULL);
    retex_set_close(&set);
    retex_set_close(&compact);
}

static double sum_of(const RetexSet *set, int part)
{
    double sum = 0;
    for (int i = 0; i < 3 * WIDE * HIGH; i++)
        sum += (double)set->parts[part].image.pixels[i];
    return sum;
}

static void energy_is_kept_in_one_image(void **state)
{
    RetexSet *set = whole_set(1, 3), *compact = compacted(set, 4, 8, 2);
    double should = 0;
    (void)state;
    for (int i = 0; i < set->nterms; i++) {
        const RetexTerm *term = &set->terms[i];
        const RetexFootprintKind kind =
            term->nfactors && term->factors[0] >= 0 ? set->footprints[term->factors[0]].kind : RETEX_FOOTPRINT_HIT;
        const int again = term->nfactors > 1 && term->factors[0] == RETEX_MIXTURE(0); /* of the sharp clusters */
        if (kind == RETEX_FOOTPRINT_SHARP || again)
            should += sum_of(set, term->radiance) * pow(0.6, term->nfactors - 1);
    }
    const int part = retex_set_find_part(compact, "dep_T0_sharp");
    assert_true(part > 0);
    assert_float_equal(sum_of(compact, part) / should, 1, 1e-5);
    assert_true(retex_set_find_part(compact, "gain_T0_sharp") > 0);
    assert_true(retex_set_find_part(compact, "weight_T0_sharp2") > 0);
    assert_true(retex_set_find_part(compact, "albedo_T0_broad") > 0);
    retex_set_close(&set);
    retex_set_close(&compact);
}

/* A cluster's weight is its share of the block's light: codes that pack it have nothing above 1. */
static void weights_are_shares(void **state)
{
    (void)state;
    RetexSet *set = whole_set(1, 3), *compact = compacted(set, 4, 8, 2);
    int seen = 0;
    for (int m = 0; m < compact->nmixtures; m++)
        for (int k = 0; k < compact->mixtures[m].nshares; k++) {
            const RetexPart *part = &compact->parts[compact->mixtures[m].shares[k].weight];
            const RetexImage *weight = &part->image;
            if (strncmp(part->name, "weight_", 7) != 0)
                continue;
            for (size_t i = 0; i < (size_t)weight->width * (size_t)weight->height; i++, seen++)
                assert_true(weight->pixels[i] >= 0 && weight->pixels[i] <= 1);
        }
    assert_true(seen > 0);
    retex_set_close(&compact);
    retex_set_close(&set);
}

/* Of eleven orders six are kept: white is exact, and so is the grey that all light was made for. */
static void few_orders_tell_of_many(void **state)
{
    const float light[] = {0.7f, 0.7f, 0.7f};
    (void)state;
    for (int ntargets = 1; ntargets <= 2; ntargets++) {
        RetexSet *set = whole_set(ntargets, 2);
        const int later = ntargets > 1 ? RETEX_MIXTURE(set->nmixtures - 1) : RETEX_MIXTURE(2);
        const int before = set->nterms;
        uint32_t seed = 3;
        for (int order = 3; order <= 11; order++)
            add_term(set, 1 + order, RETEX_MIXTURE(0), later);
        for (int i = before; i < set->nterms; i++)
            fill_light(set, set->terms[i].radiance, &seed);
        RetexSet *compact = compacted(set, 4, 8, 1);
        int many = 0;
        for (int i = 0; i < compact->nterms; i++)
            many += compact->terms[i].nfactors > 3;
        assert_int_equal(many, 4); /* 3, 5, 8 and 11 */
        expect_same_picture(set, compact, white);
        expect_same_picture(set, compact, grey);
        RetexImage is = picture(compact, light), should = picture(set, light);
        for (int i = 0; i < 3 * WIDE * HIGH; i++)
            assert_float_equal(is.pixels[i], should.pixels[i], 0.05f * should.pixels[i] + 1e-6f);
        retex_image_free(&is);
        retex_image_free(&should);
        retex_set_close(&set);
        retex_set_close(&compact);
    }
}

/* Seen through a box filter, four sharp clusters a pixel. */
static RetexSet *start_sharp_set(void)
{
    RetexSet *set = start_set(WIDE, HIGH, 1);
    strcpy(set->filter, "box");
    set->spp = 1024;
    for (int k = 0; k < 4; k++)
        add_footprint(set, 0, RETEX_FOOTPRINT_SHARP, 1 + k, "RGB");
    for (int k = 0; k < 4; k++)
        add_term(set, 1, k, 0);
    return set;
}

/* A wall, each pixel in quarters whose places and light are off by so many pixels and shares, as so many samples of
 * equal light tell; at x = 20 all are off by a tenth of a pixel. */
static RetexSet *set_of_wall(float noise, int samples)
{
    const float step = 1.0f / 64;
    RetexSet *set = start_sharp_set();
    uint32_t seed = 5;
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++)
            for (int k = 0; k < 4; k++) {
                const float cut = noise * (float)(test_random(&seed) - 0.5), side = x == 20 ? -0.1f : 0;
                const float u = (float)x + side + (k < 2 ? -0.25f : 0.25f) + cut,
                            v = (float)y + (k % 2 ? 0.25f : -0.25f);
                const float light = 1 + noise * (float)(test_random(&seed) - 0.5);
                put(set, k, x, y, u * step, v * step, (float)samples / 4 / 1024);
                put_spread(set, k, x, y, 0.1443f * step, 0.1443f * step, 0);
                put_rgb(set, set->footprints[k].albedo, x, y, 0.5f, 0.5f, 0.5f);
                put_rgb(set, set->terms[1 + k].radiance, x, y, light, light, light);
            }
    return set;
}

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

static void one_cluster_needs_no_mixture(void **state)
{
    RetexSet *set = whole_set(1, 1), *compact = compacted(set, 4, 8, 2);
    (void)state;
    assert_int_equal(retex_set_find_part(compact, "weight_T0_sharp1"), -1);
    for (int i = 0; i < compact->nterms; i++)
        if (compact->terms[i].nfactors == 1)
            assert_true(compact->terms[i].factors[0] >= 0);
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
        assert_true(distance < 0.01f);
        assert_true(compact->parts[to->spread].image.pixels[3 * i] < 0.03f);
    }
    retex_set_close(&set);
    retex_set_close(&compact);
}

/* Where a kind, or a target's later hits, have no light, all else is as it was. */
static void empty_kinds_do_no_harm(void **state)
{
    RetexSet *set = whole_set(2, 2);
    (void)state;
    for (int i = 0; i < set->nfootprints; i++)
        if (set->footprints[i].target == 1 && set->footprints[i].kind != RETEX_FOOTPRINT_BROAD)
            memset(set->parts[set->footprints[i].uv].image.pixels, 0, sizeof(float) * 3 * WIDE * HIGH);
    for (int m = 0; m < set->nmixtures; m++)
        for (int k = 0; k < set->mixtures[m].nshares; k++) {
            const RetexFootprint *f = &set->footprints[set->mixtures[m].shares[k].footprint];
            if (f->target == 1 && f->kind != RETEX_FOOTPRINT_BROAD)
                memset(set->parts[set->mixtures[m].shares[k].weight].image.pixels, 0, sizeof(float) * WIDE * HIGH);
        }
    RetexSet *compact = compacted(set, 4, 8, 1);
    expect_same_picture(set, compact, bright);
    retex_set_close(&set);
    retex_set_close(&compact);
}

/* The grey world of gains that do not change goes into the smallest images; an edge in them does not. */
static void sizes_follow_the_loss(void **state)
{
    (void)state;
    for (int edge = 0; edge < 2; edge++) {
        RetexSet *set = whole_set(1, 1), *compact;
        RetexError err = {0};
        for (int i = 1; i < set->nterms; i++)
            for (int y = 0; y < HIGH; y++)
                for (int x = 0; x < WIDE; x++) {
                    const float light = edge && set->terms[i].nfactors > 1 && (x / 5 + y / 5) % 2 ? 0 : 0.3f;
                    put_rgb(set, set->terms[i].radiance, x, y, light, light, light);
                }
        for (int i = 0; i < set->nfootprints; i++)
            for (int k = 0; k < WIDE * HIGH; k++)
                put(set, i, k % WIDE, k / WIDE, 0.3f, 0.4f, 1);
        test_must(retex_set_compact(&compact, set, NULL, 2, &err), &err);
        const int gain = retex_set_find_part(compact, "gain_T0_sharp");
        assert_true(gain > 0);
        assert_int_equal(retex_set_scale(compact, &compact->parts[gain].image), edge ? 1 : 8);
        retex_set_close(&set);
        retex_set_close(&compact);
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

static void expect_equal(const RetexSet *one, const RetexSet *other)
{
    assert_int_equal(one->nparts, other->nparts);
    for (int i = 0; i < one->nparts; i++) {
        const RetexImage *a = &one->parts[i].image, *b = &other->parts[i].image;
        assert_string_equal(one->parts[i].name, other->parts[i].name);
        assert_int_equal(a->width, b->width);
        assert_int_equal(a->height, b->height);
        assert_memory_equal(a->pixels, b->pixels,
                            sizeof(float) * (size_t)a->width * (size_t)a->height * (size_t)a->channels);
    }
}

static void threads_do_not_matter(void **state)
{
    RetexSet *set = whole_set(2, 3), *one, *many;
    RetexError err = {0};
    (void)state;
    test_must(retex_set_compact(&one, set, NULL, 1, &err), &err);
    test_must(retex_set_compact(&many, set, NULL, 7, &err), &err);
    expect_equal(one, many);
    retex_set_close(&set);
    retex_set_close(&one);
    retex_set_close(&many);
}

/* So many of it, one below the other, with more light in each. */
static void stack(RetexSet *set, int copies)
{
    for (int i = 0; i < set->nparts; i++) {
        RetexImage *image = &set->parts[i].image, tall = {0};
        const size_t count = retex_image_index(image, 0, image->height);
        RetexError err = {0};
        int radiance = 0;
        if (image->width != WIDE || image->height != HIGH)
            continue;
        for (int k = 0; k < set->nterms; k++)
            radiance |= set->terms[k].radiance == i;
        test_must(retex_image_alloc(&tall, WIDE, copies * HIGH, image->channels, &err), &err);
        for (size_t k = 0; k < (size_t)copies * count; k++)
            tall.pixels[k] = image->pixels[k % count] * (radiance ? 1 + 0.01f * (float)(k / count) : 1);
        retex_image_free(image);
        *image = tall;
    }
    set->height = copies * HIGH;
}

/* In bands of rows, and trials on tiles, for it is large. */
static void file_and_memory_are_the_same(void **state)
{
    RetexSet *set = whole_set(1, 2), *memory, *file, *one, *other;
    RetexError err = {0};
    char path[] = "/tmp/test_compact_XXXXXX";
    (void)state;
    const int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    close(descriptor);
    stack(set, 86);
    test_must(retex_set_write(set, NULL, path, NULL, &err), &err);
    test_must(retex_set_read(path, &memory, NULL, 2, &err), &err);
    test_must(retex_set_open(path, &file, NULL, 2, &err), &err);
    remove(path);
    assert_null(file->parts[1].image.pixels);
    test_must(retex_set_compact(&one, memory, NULL, 2, &err), &err);
    test_must(retex_set_compact(&other, file, NULL, 2, &err), &err);
    expect_equal(one, other);
    assert_null(file->parts[1].image.pixels);
    retex_set_close(&set);
    retex_set_close(&memory);
    retex_set_close(&file);
    retex_set_close(&one);
    retex_set_close(&other);
}

static void expect_copy(const RetexSet *set, const RetexSet *copy)
{
    int parts = 0;
    for (int i = 0; i < set->nparts; i++) {
        if (part_is_denoise_data(set, i))
            continue;
        const RetexImage *a = &set->parts[i].image, *b = &copy->parts[parts].image;
        assert_string_equal(set->parts[i].name, copy->parts[parts++].name);
        assert_memory_equal(a->pixels, b->pixels,
                            sizeof(float) * (size_t)a->width * (size_t)a->height * (size_t)a->channels);
    }
    assert_int_equal(copy->nparts, parts);
    assert_int_equal(copy->nterms, set->nterms);
    assert_int_equal(copy->nfootprints, set->nfootprints);
    assert_int_equal(copy->nmixtures, set->nmixtures);
}

static void others_come_out_as_they_are(void **state)
{
    RetexSet *paper = test_set(24, 16, 3), *set = whole_set(1, 2), *compact = compacted(set, 4, 8, 2), *again, *copy;
    RetexError err = {0};
    (void)state;
    test_add_denoise_data(paper);
    test_must(retex_set_compact(&copy, paper, NULL, 1, &err), &err);
    assert_true(copy->nparts < paper->nparts);
    expect_copy(paper, copy);
    test_must(retex_set_compact(&again, compact, NULL, 1, &err), &err);
    expect_copy(compact, again);
    retex_set_close(&paper);
    retex_set_close(&copy);
    retex_set_close(&set);
    retex_set_close(&compact);
    retex_set_close(&again);
}

static void survives_writing(void **state)
{
    RetexSet *set = whole_set(2, 3), *compact = compacted(set, 4, 8, 2), *read = NULL;
    RetexError err = {0};
    char path[] = "/tmp/test_compact_XXXXXX";
    (void)state;
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    test_must(retex_set_write(compact, NULL, path, NULL, &err), &err);
    test_must(retex_set_read(path, &read, NULL, 1, &err), &err);
    expect_same_picture(compact, read, bright);
    remove(path);
    retex_set_close(&set);
    retex_set_close(&compact);
    retex_set_close(&read);
}

static void wrong_params_are_refused(void **state)
{
    static const RetexCompactParams wrong[] = {{sizeof *wrong, 55, 3, 0, 0, 1},
                                               {sizeof *wrong, 55, 0, 16, 0, 1},
                                               {sizeof *wrong, 55, 0, 0, -1, 1},
                                               {sizeof *wrong, 10, 0, 0, 0, 1},
                                               {sizeof *wrong, NAN, 0, 0, 0, 1},
                                               {sizeof *wrong, 55, 0, 0, 0, 1.5}};
    RetexSet *set = whole_set(1, 1), *compact;
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        RetexError err = {0};
        assert_int_equal(retex_set_compact(&compact, set, &wrong[i], 1, &err), RETEX_EINVAL);
        assert_null(compact);
    }
    retex_set_close(&set);
}

/* Two clusters have one albedo: that one of them is empty does not take it from the other. */
static void pruning_keeps_what_is_shared(void **state)
{
    RetexSet *set = whole_set(1, 2), *compact = compacted(set, 4, 8, 2);
    char empty[256] = {0};
    (void)state;
    const int count = compact->nfootprints, parts = compact->nparts;
    empty[compact->footprints[1].uv] = 1;
    retex_set_prune(compact, empty);
    assert_int_equal(compact->nfootprints, count - 1);
    assert_true(compact->nparts < parts);
    const int albedo = compact->footprints[0].albedo;
    assert_string_equal(compact->parts[albedo].name, "albedo_T0_sharp");
    assert_true(retex_set_find_part(compact, "dep_T0_sharp") > 0);
    RetexImage shown = picture(compact, bright);
    retex_image_free(&shown);

    /* A gain that is empty takes its term away, but not the radiance of the others. */
    memset(empty, 0, sizeof empty);
    const int terms = compact->nterms, gain = compact->terms[compact->nterms - 1].gain;
    const int radiance = compact->terms[compact->nterms - 1].radiance;
    char name[RETEX_NAME_MAX], kept[RETEX_NAME_MAX];
    strcpy(name, compact->parts[gain].name);
    strcpy(kept, compact->parts[radiance].name);
    empty[gain] = 1;
    retex_set_prune(compact, empty);
    assert_int_equal(compact->nterms, terms - 1);
    assert_int_equal(retex_set_find_part(compact, name), -1);
    assert_true(retex_set_find_part(compact, kept) > 0);
    retex_set_close(&set);
    retex_set_close(&compact);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(grey_is_exact_at_all_scales),
        cmocka_unit_test(constants_are_exact_where_gains_are_whole),
        cmocka_unit_test(originals_are_exact),
        cmocka_unit_test(energy_is_kept_in_one_image),
        cmocka_unit_test(weights_are_shares),
        cmocka_unit_test(few_orders_tell_of_many),
        cmocka_unit_test(even_pixels_are_quarters),
        cmocka_unit_test(few_samples_are_even_too),
        cmocka_unit_test(even_pixels_run_to_a_horizon),
        cmocka_unit_test(one_cluster_needs_no_mixture),
        cmocka_unit_test(places_are_not_averaged_across_a_seam),
        cmocka_unit_test(empty_kinds_do_no_harm),
        cmocka_unit_test(sizes_follow_the_loss),
        cmocka_unit_test(sizes_may_lose_on_top),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(file_and_memory_are_the_same),
        cmocka_unit_test(others_come_out_as_they_are),
        cmocka_unit_test(survives_writing),
        cmocka_unit_test(wrong_params_are_refused),
        cmocka_unit_test(pruning_keeps_what_is_shared),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
