/* See lib_compact.h. */
#include "lib_compact.h"

#include <math.h>
#include <string.h>

#include <cmocka.h>

float *at(RetexSet *set, int part, int x, int y)
{
    return pixel(set, part, x, y);
}

void fill_light(RetexSet *set, int part, uint32_t *seed)
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

RetexSet *whole_set(int ntargets, int count)
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
            add_footprint(set, t, RETEX_FOOTPRINT_INTERREFLECTION, 1 + 2 * count + k, "RGB");
        later[t] = add_mixture(set, start, 2, "R");
        for (int k = 0; k < 2; k++)
            any.shares[any.nshares++] = set->mixtures[MIXTURE(later[t])].shares[k];
    }
    int all;
    test_must(retex_set_add_mixture(set, &any, &all, &err), &err);
    for (int t = 0; t < ntargets; t++)
        for (int kind = 0; kind < 2; kind++) {
            for (int b = 0; b < ntargets; b++)
                add_term(set, 2, first[t][kind], later[b]);
            add_term(set, 3, first[t][kind], MIXTURE(all));
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

RetexSet *compacted(const RetexSet *set, int broad, int later, int gain)
{
    RetexCompactParams params = RETEX_COMPACT_INIT;
    RetexError err = {0};
    RetexSet *compact;
    params.broad = broad, params.interreflection = later, params.gain = gain;
    test_must(retex_set_compact(&compact, set, &params, 2, &err), &err);
    return compact;
}

RetexImage picture(const RetexSet *set, const float *constant)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    RetexImage image = {0};
    for (int t = 0; t < set->ntargets && constant; t++) {
        specs[t] = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
        strcpy(specs[t].target, set->targets[t].name);
        specs[t].constant = 1;
        for (int c = 0; c < 3; c++)
            specs[t].color[c] = constant[c];
    }
    test_combine(&image, set, specs, constant ? set->ntargets : 0, NULL);
    return image;
}

void expect_same_image(RetexImage one, RetexImage other)
{
    float most = 0;
    for (int i = 0; i < 3 * WIDE * HIGH; i++)
        most = fmaxf(most, one.pixels[i]);
    assert_true(most > 0);
    for (int i = 0; i < 3 * WIDE * HIGH; i++)
        assert_float_equal(one.pixels[i], other.pixels[i], 1e-3f * most);
    retex_image_free(&one);
    retex_image_free(&other);
}

void expect_same_picture(const RetexSet *a, const RetexSet *b, const float *constant)
{
    expect_same_image(picture(a, constant), picture(b, constant));
}

RetexSet *start_sharp_set(void)
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

RetexSet *set_of_wall(float noise, int samples)
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
