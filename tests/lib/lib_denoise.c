/* See lib_denoise.h. */
#include "lib_denoise.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lib_footprints.h"
#include "set/parts.h"

#define SLANT 0.15 /* of the silhouette */

/* ---- the scene ---- */

double denoise_from_silhouette(const RetexSet *set, int x, int y)
{
    return (x + 0.5 - 0.55 * set->width - SLANT * (y + 0.5 - 0.5 * set->height)) / hypot(1, SLANT);
}

double denoise_from_shadow(const RetexSet *set, int x, int y)
{
    double radius = 0.2 * (set->width < set->height ? set->width : set->height);
    return hypot(x + 0.5 - 0.25 * set->width, y + 0.5 - 0.5 * set->height) - radius;
}

static double clamp(double x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

/* The share of the pixel that the right surface covers. */
static double right_share(const RetexSet *set, int x, int y)
{
    return clamp(denoise_from_silhouette(set, x, y) + 0.5);
}

/* Light of each surface, smooth except for the shadow. */
static double light(const RetexSet *set, int x, int y, double left, double right)
{
    double lit = 1 - 0.9 * clamp(0.5 - denoise_from_shadow(set, x, y)), share = right_share(set, x, y);
    left *= lit * (1 + 0.3 * sin(x / 17.0) + 0.2 * cos(y / 23.0));
    right *= 1 + 0.3 * cos(x / 19.0 + y / 31.0);
    return (1 - share) * left + share * right;
}

static void fill_light(RetexSet *set, int part, double left, double right)
{
    for (int y = 0; y < set->height; y++)
        for (int x = 0; x < set->width; x++) {
            float l = (float)light(set, x, y, left, right);
            put_rgb(set, part, x, y, l, 0.8f * l, 0.6f * l);
        }
}

/* The UVs of the left surface are those of a floor. The right surface sees the texture blurred, or not at all. */
static void fill_footprint(RetexSet *set, int footprint, int right)
{
    double middle[2] = {0.5 * set->width, 0.5 * set->height};
    for (int y = 0; y < set->height; y++)
        for (int x = 0; x < set->width; x++) {
            double share = right_share(set, x, y), u = 0.3 * footprint + (x - middle[0]) / 90;
            put_rgb(set, set->footprints[footprint].albedo, x, y, 0.5f, 0.25f, 0.75f);
            put(set, footprint, x, y, (float)u, (float)((y - middle[1]) / 80), share == 1 && !right ? 0 : 0.5f);
            put_spread(set, footprint, x, y, 0.01f * (float)(1 + footprint), 0.02f, 0.25f);
        }
}

static void fill_guide(RetexSet *set, const char *name, const float left[3], const float right[3])
{
    int part = retex_set_find_part(set, name);
    for (int y = 0; y < set->height; y++)
        for (int x = 0; x < set->width; x++) {
            float share = (float)right_share(set, x, y), *to = pixel(set, part, x, y);
            for (int c = 0; c < set->parts[part].image.channels; c++)
                to[c] = (1 - share) * left[c] + share * right[c];
        }
}

/* A plane that faces the camera, and in front of it one that is turned away. */
static void fill_positions(RetexSet *set, const char *name)
{
    int part = retex_set_find_part(set, name);
    for (int y = 0; y < set->height; y++)
        for (int x = 0; x < set->width; x++) {
            float share = (float)right_share(set, x, y);
            put_rgb(set, part, x, y, 0.02f * (float)x, 0.02f * (float)y, share * (-1 + 0.02f * (float)x));
        }
}

static void fill_guides(RetexSet *set)
{
    static const float facing[] = {0, 0, -1}, turned[] = {0.7071f, 0, -0.7071f}, white[] = {1, 1, 1},
                       grey[] = {0.5f, 0.4f, 0.3f}, rough[] = {1, 0, 0}, black[3] = {0};
    char name[RETEX_NAME_MAX];
    test_add_denoise_data(set);
    for (int k = 0; k < set->nparts; k++) {
        RetexImage *im = &set->parts[k].image;
        if (retex_name_is_noise(set->parts[k].name))
            memset(im->pixels, 0, (size_t)im->width * (size_t)im->height * (size_t)im->channels * sizeof(float));
    }
    fill_guide(set, retex_feature_info(RETEX_FEATURE_NORMAL)->name, facing, turned);
    fill_guide(set, retex_feature_info(RETEX_FEATURE_SEEN_NORMAL)->name, facing, turned);
    fill_positions(set, retex_feature_info(RETEX_FEATURE_POSITION)->name);
    fill_positions(set, retex_feature_info(RETEX_FEATURE_SEEN_POSITION)->name);
    fill_guide(set, retex_feature_info(RETEX_FEATURE_SPECULAR)->name, black, black);
    fill_guide(set, retex_feature_info(RETEX_FEATURE_SEEN_ALBEDO)->name, white, set->ntargets ? grey : white);
    fill_guide(set, retex_feature_info(RETEX_FEATURE_SEEN_MATERIAL)->name, rough, rough);
    for (int t = 0; t < set->ntargets; t++) {
        retex_cover_part_name(name, set->targets[t].name);
        fill_guide(set, name, t ? black : white, black);
    }
}

/* ---- the layouts ---- */

static void fill_footprints_layout(RetexSet *set)
{
    static const double shares[] = {0.7, 0.3};
    int first[2], mixtures[3];
    fill_light(set, set->terms[0].radiance, 0.1, 0.3);
    for (int kind = 0; kind < 2; kind++) {
        first[kind] = set->nfootprints;
        for (int k = 0; k < 2; k++) {
            int f = add_footprint(set, 0, kind ? RETEX_FOOTPRINT_BROAD : RETEX_FOOTPRINT_SHARP, 1 + k, "RGB");
            int part = add_term(set, 1, f, 0);
            fill_light(set, part, shares[k] * (kind ? 0.1 : 0.8), kind ? shares[k] * 0.2 : 0);
        }
    }
    for (int k = 0; k < 2; k++)
        add_footprint(set, 0, RETEX_FOOTPRINT_INTERREFLECTION, 3 + k, "RGB");
    mixtures[0] = add_mixture(set, first[0], 2, "R");
    mixtures[1] = add_mixture(set, first[1], 2, "R");
    mixtures[2] = add_mixture(set, 4, 2, "R");
    for (int kind = 0; kind < 2; kind++)
        for (int n = 2; n < 4; n++)
            fill_light(set, add_term(set, n, mixtures[kind], mixtures[2]), (kind ? 0.05 : 0.2) / n, kind ? 0.1 / n : 0);
    for (int k = 0; k < 6; k++) {
        fill_footprint(set, k, k > 1);
        for (int i = 0; i < set->width * set->height; i++)
            set->parts[share_part(set, k)].image.pixels[i] = 0.5f;
    }
}

/* Three hits of each target: dep, indep and cross terms. */
static void fill_paper_layout(RetexSet *set)
{
    static const int nfactors[] = {1, 2, 3, 0, 0, 0, 1, 1, 2, 2};
    RetexError err = {0};
    strcpy(set->layout, "paper");
    fill_light(set, set->terms[0].radiance, 0.1, 0.3);
    for (int t = 0; t < 2; t++) {
        for (int k = 0; k < 3; k++)
            fill_footprint(set, add_footprint(set, t, RETEX_FOOTPRINT_HIT, 1 + k, "RG"), 1);
        for (int k = 0; k < 10; k++) {
            int numbers[3];
            for (int n = 0; n < nfactors[k]; n++)
                numbers[n] = 3 * t + (k < 6 ? n : (k + n) % 3);
            RetexTerm term = test_term(set, add_part(set, "RGB", "term", set->nterms), nfactors[k], numbers);
            term.role = k < 6 ? term.role : RETEX_ROLE_CROSS2;
            test_must(retex_set_add_term(set, &term, NULL, &err), &err);
            fill_light(set, term.radiance, (t ? 0.05 : 0.4) / (1 + k), 0.1 / (1 + k));
        }
    }
}

RetexSet *denoise_set(const char *layout, int width, int height)
{
    RetexSet *set = start_set(width, height, strcmp(layout, "plain") == 0 ? 0 : strcmp(layout, "paper") == 0 ? 2 : 1);
    if (strcmp(layout, "plain") == 0) {
        strcpy(set->layout, "plain");
        set->nterms = 0;
        retex_set_remove_part(set, 1);
        fill_light(set, 0, 0.8, 0.3);
    } else if (strcmp(layout, "paper") == 0) {
        fill_paper_layout(set);
    } else {
        fill_footprints_layout(set);
    }
    fill_guides(set);
    return set;
}

/* ---- noise ---- */

/* The mean of this number of samples. */
static double draw(int samples, uint32_t *seed)
{
    double sum = 0;
    for (int k = 0; k < samples; k++)
        sum -= log(1 - test_random(seed));
    return sum / samples;
}

void denoise_add_noise(RetexSet *set, uint32_t seed)
{
    RetexSignals signals = denoise_signals(set);
    int n = set->spp, first = n / 2;
    for (int s = 0; s < signals.count; s++)
        for (int k = 0; k < signals.of[s].nmembers; k++) {
            const RetexSignalMember *m = &signals.of[s].members[k];
            float *to = set->parts[m->part].image.pixels, *noise = set->parts[signals.of[s].noise].image.pixels;
            for (int i = 0; i < 3 * set->width * set->height; i += 3) {
                double a = draw(first, &seed), b = draw(n - first, &seed);
                for (int c = i; c < i + 3; c++) {
                    noise[c] += m->weight * to[c] * (float)(0.5 * (a - b));
                    to[c] *= (float)((first * a + (n - first) * b) / n);
                }
            }
        }
    retex_signals_close(&signals);
}

/* ---- what is in a set ---- */

RetexSignals denoise_signals(const RetexSet *set)
{
    RetexSignals signals;
    RetexError err = {0};
    test_must(retex_signals_open(&signals, set, &err), &err);
    return signals;
}

const char *denoise_signal_name(const RetexSet *set, const RetexSignal *signal)
{
    return set->parts[signal->noise].name + 6;
}

double denoise_total(const RetexSet *set, const RetexSignal *signal, int x, int y, int channel)
{
    double sum = 0;
    for (int k = 0; k < signal->nmembers; k++)
        sum += signal->members[k].weight * pixel(set, signal->members[k].part, x, y)[channel];
    return sum;
}

double denoise_mean(const RetexSet *set, const RetexSignal *signal, int channel)
{
    double sum = 0;
    for (int y = 0; y < set->height; y++)
        for (int x = 0; x < set->width; x++)
            sum += denoise_total(set, signal, x, y, channel);
    return sum / (set->width * set->height);
}

/* ---- calls ---- */

void denoise_add_original(RetexSet *set, const double min[2], const double max[2])
{
    enum { TEXELS = 512 };
    RetexError err = {0};
    RetexTarget *t = &set->targets[0];
    test_must(retex_set_add_part(set, "original_T0", "RGB", RETEX_FLOAT, TEXELS, 4, &t->original, &err), &err);
    memcpy(t->original_min, min, sizeof t->original_min);
    memcpy(t->original_max, max, sizeof t->original_max);
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < TEXELS; x++) {
            const float red = 0.25f + 0.5f * ((float)x + 0.5f) / TEXELS;
            put_rgb(set, t->original, x, y, red, 0.5f * red, 0);
        }
}

const RetexDenoiseParams denoise_exactly = {
    .size = sizeof denoise_exactly, .strength = 1, .radius = 5, .footprints = 1, .full_precision = 1};

void denoise_all(RetexSet *set, const RetexDenoiseParams *params, int nthreads)
{
    RetexError err = {0};
    test_must(retex_denoise(set, params, NULL, nthreads, &err), &err);
}

void denoise_expect_same(const RetexSet *a, const RetexSet *b)
{
    assert_int_equal(a->nparts, b->nparts);
    for (int k = 0; k < a->nparts; k++) {
        const RetexImage *im = &a->parts[k].image;
        size_t bytes = sizeof(float) * (size_t)im->width * (size_t)im->height * (size_t)im->channels;
        assert_string_equal(a->parts[k].name, b->parts[k].name);
        if (memcmp(im->pixels, b->parts[k].image.pixels, bytes) != 0)
            fail_msg("%s differs", a->parts[k].name);
    }
}

void denoise_expect_finite(const RetexSet *set)
{
    for (int k = 0; k < set->nparts; k++) {
        const RetexImage *im = &set->parts[k].image;
        for (int i = 0; i < im->width * im->height * im->channels; i++)
            if (!isfinite(im->pixels[i]))
                fail_msg("%s has %g at value %d", set->parts[k].name, (double)im->pixels[i], i);
    }
}
