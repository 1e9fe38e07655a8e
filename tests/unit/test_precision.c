/* How precisely numbers of sets are stored: errors against the fractions of noise that precision.h states. */
#include "lib_denoise.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/denoise.h>
#include <retex/set_file.h>

#include "precision/precision.h"
#include "set/parts.h"

enum { WIDTH = 70, HEIGHT = 52 };
static const char *const layouts[] = {"paper", "footprints"};

static RetexSet *noisy_set(const char *layout, uint32_t seed)
{
    RetexSet *set = denoise_set(layout, WIDTH, HEIGHT);
    set->spp = 16;
    denoise_add_noise(set, seed);
    return set;
}

static const float *at(const RetexSet *set, int part, int x, int y)
{
    const RetexImage *im = &set->parts[part].image;
    return im->pixels + retex_image_index(im, x, y);
}

static double white(const RetexSet *set, int x, int y)
{
    double sum[3] = {0, 0, 0};
    for (int t = 0; t < set->nterms; t++)
        for (int c = 0; c < 3; c++)
            sum[c] += (double)at(set, set->terms[t].radiance, x, y)[c];
    return fmax(sum[0], fmax(sum[1], sum[2]));
}

/* The noise of a signal: the geometric mean of what its part of `noise` tells of the pixel and of that of a light of 16
 * samples, each of which has half of the white pixel as its variance. */
static double noise_of(const RetexSet *was, const RetexSet *noise, const RetexSignal *signal, int x, int y)
{
    const float *n = at(noise, signal->noise, x, y);
    double light = 0;
    for (int m = 0; m < signal->nmembers; m++) {
        const float *v = at(was, was->terms[signal->members[m].term].radiance, x, y);
        light += (double)signal->members[m].weight * (double)(v[0] + v[1] + v[2]) / 3;
    }
    return sqrt((fabs((double)n[0]) + fabs((double)n[1]) + fabs((double)n[2])) / 3 *
                sqrt(0.5 * light * white(was, x, y) / 16));
}

static double noise_of_all(const RetexSet *set, const RetexSignals *signals, int x, int y)
{
    double sum = 0;
    for (int s = 0; s < signals->count; s++)
        sum += pow(noise_of(set, set, &signals->of[s], x, y), 2);
    return sqrt(sum);
}

/* The step of a signal's sum: a 128th of the white pixel, or of the brightest channel of light that no texture
 * multiplies, if that is less than the step of its noise. */
static double sum_step(const RetexSet *was, const RetexSignal *signal, double step, int x, int y)
{
    double own = 0;
    for (int m = 0; m < signal->nmembers; m++)
        for (int c = 0; c < 3 && signal->members[m].weight > 0; c++)
            own = fmax(own, (double)at(was, was->terms[signal->members[m].term].radiance, x, y)[c]);
    const double whole = white(was, x, y), share = signal->target < 0 ? own : whole;
    return fmin(step, fmax(1.001 * share / 128, 1.001 * whole / 8192));
}

/* One more hit counts as albedo 0.8 in a sum that is kept. */
static double weight_of(const RetexSet *set, const RetexSignalMember *member)
{
    return member->weight > 0 ? pow(0.8, fmax(set->terms[member->term].nfactors - 1, 0)) : 0;
}

/* The sum of a signal is rounded once: by half of a step. A single number also takes the error of another. `halves` is
 * the relative error of numbers that were stored as halves. */
static void expect_light(const RetexSet *is, const RetexSet *was, const RetexSet *noise, double fraction, double halves)
{
    RetexSignals signals = denoise_signals(noise);
    int rounded = 0;
    for (int s = 0; s < signals.count; s++)
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const int x = i % WIDTH, y = i / WIDTH;
            const double sigma = (1 + halves) * noise_of(was, noise, &signals.of[s], x, y);
            const double step = sigma > 0 ? fmax(fraction * sigma, 1.001 * white(was, x, y) / 8192) : 0;
            for (int c = 0; c < 3; c++) {
                double a = 0, b = 0, size = 0;
                for (int m = 0; m < signals.of[s].nmembers; m++) {
                    const RetexSignalMember *member = &signals.of[s].members[m];
                    const int part = was->terms[member->term].radiance, other = is->terms[member->term].radiance;
                    const double before = (double)at(was, part, x, y)[c], after = (double)at(is, other, x, y)[c];
                    const double weight = weight_of(was, member);
                    a += weight * after, b += weight * before;
                    size += fabs(before) * weight;
                    rounded += after != before;
                    if (!(fabs(after - before) <= 1.0001 * step + halves * fabs(before)))
                        fail_msg("%s: %g became %g, steps of %g", was->parts[part].name, before, after, step);
                }
                const double once = sum_step(was, &signals.of[s], step, x, y);
                if (!(fabs(a - b) <= 0.501 * once + (halves + 1e-6) * size))
                    fail_msg("signal %d: %g became %g, steps of %g", s, b, a, once);
            }
        }
    assert_true(rounded > WIDTH * HEIGHT);
    retex_signals_close(&signals);
}

static void light_is_rounded_to_its_noise(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        RetexSet *set = noisy_set(layouts[k], 1), *was = noisy_set(layouts[k], 1);
        RetexError err = {0};
        test_must(retex_set_round(set, NULL, 2, &err), &err);
        expect_light(set, was, was, 0.1, 0);
        retex_set_close(&set);
        retex_set_close(&was);
    }
}

/* Light that denoising leaves, to a third of that. */
static void denoised_light_is_rounded_to_less(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        RetexSet *set = noisy_set(layouts[k], 1), *exact = noisy_set(layouts[k], 1), *was = noisy_set(layouts[k], 1);
        denoise_all(set, NULL, 2);
        denoise_all(exact, &denoise_exactly, 2);
        expect_light(set, exact, was, 0.1 * 0.3, 1.0 / 1024);
        retex_set_close(&set);
        retex_set_close(&exact);
        retex_set_close(&was);
    }
}

/* A step that is a part of a scale, for what multiplies `light` of which `noise` is not known. */
static double step_of(double scale, double fraction, double finest, double coarsest, double noise, double light)
{
    const double relative = noise > 0 ? noise / light : 0;
    return 1.0001 * scale * fmin(fmax(fraction * relative, finest), coarsest);
}

static void expect_near(double is, double was, double step, const char *what)
{
    if (!(fabs(is - was) <= step))
        fail_msg("%s: %g became %g, further than %g", what, was, is, step);
}

/* The footprints of a synthetic set, and the light that each multiplies: that of its own term, and half of that of the
 * two terms with further hits of its kind, which two clusters share. */
static double light_of(const RetexSet *set, int footprint, int x, int y)
{
    double light = 0;
    for (int t = 0; t < set->nterms; t++) {
        const RetexTerm *term = &set->terms[t];
        const float *v = at(set, term->radiance, x, y);
        const double value = (double)(v[0] + v[1] + v[2]) / 3 * pow(0.5, term->nfactors - 1);
        for (int k = 0; k < term->nfactors; k++) {
            const int factor = test_factor_number(term->factors[k]);
            light += factor == footprint ? value : 0;
            for (int n = 0; factor < 0 && n < 2; n++)
                light += set->mixtures[MIXTURE(factor)].shares[n].footprint == footprint ? value / 2 : 0;
        }
    }
    return light;
}

static void expect_footprint(const RetexSet *is, const RetexSet *was, int number, double noise, int x, int y)
{
    const RetexFootprint *f = &was->footprints[number];
    const float *uv = at(was, f->uv, x, y), *got = at(is, f->uv, x, y);
    const double light = light_of(was, number, x, y);
    const int broad = f->kind >= RETEX_FOOTPRINT_BROAD;
    const RetexTarget *target = &was->targets[f->target];
    if (uv[2] == 0) {
        assert_memory_equal(uv, got, 12);
        return;
    }
    expect_near((double)got[2], (double)uv[2], step_of((double)uv[2], .5, 1. / 128, .125, noise, light) / 2,
                "coverage");
    for (int k = 0; k < 2; k++) {
        const double sd = (double)at(was, f->spread, x, y)[k], size = fabs((double)uv[k]);
        /* few samples are credited with half of the target's range; 16 significant bits are enough */
        const double samples = fmax((double)uv[2] * was->spp, 1), range = target->uv_max[k] - target->uv_min[k];
        const double wide = broad ? fmax(sd, range / 2 / samples) : sd;
        const double step = fmax(step_of(wide, broad ? 2 : .5, 1. / 1024, broad ? 1 : .5, noise, light),
                                 samples < 8 ? size / 32768 : fmin(size / 32768, sd / 2));
        expect_near((double)got[k], (double)uv[k], step / 2, "mean");
        expect_near((double)at(is, f->spread, x, y)[k], sd,
                    step_of(sd, broad ? 1.5 : .25, 1. / 1024, broad ? 1 : 1. / 16, noise, light) / 2, "deviation");
    }
    const double correlation = (double)at(was, f->spread, x, y)[2];
    expect_near((double)at(is, f->spread, x, y)[2], correlation,
                step_of(broad ? 1 : 1 - fabs(correlation), broad ? 1 : .25, 1. / 512, broad ? 1 : .125, noise, light) /
                    2,
                "correlation");
}

static void correlate_at_random(RetexSet *set)
{
    uint32_t seed = 7;
    for (int k = 0; k < set->nfootprints; k++)
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            set->parts[set->footprints[k].spread].image.pixels[3 * i + 2] = (float)(2 * test_random(&seed) - 1);
}

static void footprints_are_rounded_by_what_they_multiply(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("footprints", 1), *was = noisy_set("footprints", 1);
    RetexSignals signals = denoise_signals(was);
    RetexError err = {0};
    correlate_at_random(set);
    correlate_at_random(was);
    test_must(retex_set_round(set, NULL, 2, &err), &err);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const int x = i % WIDTH, y = i / WIDTH;
        for (int k = 0; k < was->nfootprints; k++) {
            const RetexFootprint *f = &was->footprints[k];
            double noise = noise_of_all(was, &signals, x, y), light = light_of(was, k, x, y);
            for (int s = 0; s < signals.count; s++)
                if (signals.of[s].target == f->target && signals.of[s].kind == f->kind)
                    noise = noise_of(was, was, &signals.of[s], x, y);
            expect_footprint(set, was, k, noise, x, y);
            if (at(was, f->uv, x, y)[2] == 0 || !(light > 0))
                continue;
            for (int c = 0; c < 3; c++)
                expect_near((double)at(set, f->albedo, x, y)[c], (double)at(was, f->albedo, x, y)[c],
                            step_of(1, .02, 1. / 4096, 1. / 64, noise, light) / 2, "albedo");
        }
    }
    retex_signals_close(&signals);
    retex_set_close(&set);
    retex_set_close(&was);
}

/* The light that a mixture multiplies. */
static double light_of_mixture(const RetexSet *set, int mixture, int x, int y)
{
    double light = 0;
    for (int t = 0; t < set->nterms; t++) {
        const RetexTerm *term = &set->terms[t];
        const float *v = at(set, term->radiance, x, y);
        for (int k = 0; k < term->nfactors; k++)
            if (test_factor_number(term->factors[k]) == MIXTURE(mixture))
                light += (double)(v[0] + v[1] + v[2]) / 3 * pow(0.5, term->nfactors - 1);
    }
    return light;
}

static void shares_are_rounded_by_what_their_mixture_multiplies(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("footprints", 1), *was = noisy_set("footprints", 1);
    RetexSet *both[2] = {set, was};
    RetexSignals signals = denoise_signals(was);
    RetexError err = {0};
    int rounded = 0;
    for (int b = 0; b < 2; b++) {
        uint32_t seed = 5;
        for (int m = 0; m < was->nmixtures; m++)
            for (int i = 0; i < WIDTH * HEIGHT; i++) {
                const float share = (float)test_random(&seed);
                both[b]->parts[was->mixtures[m].shares[0].weight].image.pixels[i] = share;
                both[b]->parts[was->mixtures[m].shares[1].weight].image.pixels[i] = 1 - share;
            }
    }
    test_must(retex_set_round(set, NULL, 2, &err), &err);
    for (int m = 0; m < was->nmixtures; m++)
        for (int i = 0; i < 2 * WIDTH * HEIGHT; i++) {
            const int x = i / 2 % WIDTH, y = i / 2 / WIDTH, part = was->mixtures[m].shares[i % 2].weight;
            const double a = (double)*at(was, part, x, y), b = (double)*at(set, part, x, y);
            const double step =
                step_of(1, .5, 1. / 512, .0625, noise_of_all(was, &signals, x, y), light_of_mixture(was, m, x, y));
            expect_near(b, a, step / 2 + 1e-5, "share");
            assert_true(b > 0);
            rounded += fabs(b - a) > step / 8;
        }
    assert_true(rounded > WIDTH * HEIGHT);
    retex_signals_close(&signals);
    retex_set_close(&set);
    retex_set_close(&was);
}

/* Broad footprints of few paths: their spread becomes as large as their means are moved, within the target's range. */
static void spread_gains_what_means_lose(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("footprints", 1), *was = noisy_set("footprints", 1);
    RetexSet *both[2] = {set, was};
    RetexError err = {0};
    int broad = 0;
    while (was->footprints[broad].kind != RETEX_FOOTPRINT_BROAD)
        broad++;
    const int uv = was->footprints[broad].uv, spread = was->footprints[broad].spread;
    for (int b = 0; b < 2; b++) {
        RetexTarget *target = &both[b]->targets[was->footprints[broad].target];
        uint32_t seed = 3;
        for (int k = 0; k < 2; k++)
            target->periodic[k] = 0, target->uv_min[k] = -0.03, target->uv_max[k] = 1.53;
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            float *mean = both[b]->parts[uv].image.pixels + 3 * i;
            for (int k = 0; k < 2; k++)
                mean[k] = (float)(-0.03 + 1.56 * test_random(&seed));
            mean[2] = 4.0f / 16;
            memset(both[b]->parts[spread].image.pixels + both[b]->parts[spread].image.channels * i, 0,
                   2 * sizeof(float));
        }
    }
    test_must(retex_set_round(set, NULL, 2, &err), &err);
    double moved = 0, gained = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        for (int k = 0; k < 2; k++) {
            const float *is = at(set, uv, i % WIDTH, i / WIDTH), *before = at(was, uv, i % WIDTH, i / WIDTH);
            const double s = (double)at(set, spread, i % WIDTH, i / WIDTH)[k], d = (double)(is[k] - before[k]);
            moved += d * d, gained += s * s;
            assert_true(fabs(d) <= 0.5 * 1.56 / 4 / 2); /* of a range of 1.56, by 4 samples */
            assert_true((double)is[k] >= -0.03 - 1e-7 && (double)is[k] <= 1.53 + 1e-7);
        }
    print_message("means moved by %g, spreads %g\n", sqrt(moved / (2 * WIDTH * HEIGHT)),
                  sqrt(gained / (2 * WIDTH * HEIGHT)));
    assert_true(moved > 1e-6 * 2 * WIDTH * HEIGHT);
    assert_true(fabs(moved / gained - 1) < 0.3); /* spreads of one bit are up to a sixth smaller */
    retex_set_close(&set);
    retex_set_close(&was);
}

/* Where a signal has no noise its light stays as it is. */
static void light_without_noise_is_exact(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("footprints", 1), *was = noisy_set("footprints", 1);
    RetexSignals signals = denoise_signals(set);
    RetexError err = {0};
    for (int s = 0; s < signals.count; s++) {
        RetexImage *im = &set->parts[signals.of[s].noise].image;
        memset(im->pixels + retex_image_index(im, 30, 20), 0, 12);
    }
    test_must(retex_set_round(set, NULL, 1, &err), &err);
    for (int t = 0; t < set->nterms; t++)
        assert_memory_equal(at(set, set->terms[t].radiance, 30, 20), at(was, was->terms[t].radiance, 30, 20), 12);
    retex_signals_close(&signals);
    retex_set_close(&set);
    retex_set_close(&was);
}

/* Without noise parts light is rounded to 1/8192 of the white pixel. Light that no texture multiplies is kept. */
static void a_set_without_noise_parts(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("footprints", 1), *was = noisy_set("footprints", 1);
    RetexError err = {0};
    retex_denoise_drop_data(set);
    test_must(retex_set_round(set, NULL, 1, &err), &err);
    for (int t = 0; t < was->nterms; t++)
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            for (int c = 0; c < 3; c++) {
                const int x = i % WIDTH, y = i / WIDTH;
                const double a = (double)at(was, was->terms[t].radiance, x, y)[c];
                expect_near((double)at(set, set->terms[t].radiance, x, y)[c], a,
                            was->terms[t].nfactors ? 1.001 * white(was, x, y) / 8192 : 0, "light");
            }
    retex_set_close(&set);
    retex_set_close(&was);
}

/* The picture in half precision, numbers of two bits, multiples of 1/256, and so on. */
static void data_of_denoising_are_rounded(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("footprints", 1), *was = noisy_set("footprints", 1);
    RetexError err = {0};
    test_must(retex_set_round(set, NULL, 2, &err), &err);
    retex_set_round_to_types(was, 2); /* which comes first */
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        expect_near((double)set->parts[0].image.pixels[i], (double)was->parts[0].image.pixels[i],
                    fabs((double)was->parts[0].image.pixels[i]) / 2048, "picture");
    for (int k = 1; k < set->nparts; k++) {
        const char *name = set->parts[k].name;
        const int noise = strncmp(name, "noise_", 6) == 0, guide = strncmp(name, "guide_", 6) == 0;
        const int position = guide && strstr(name, "position");
        const size_t count = retex_image_index(&set->parts[k].image, 0, HEIGHT);
        for (size_t i = 0; i < count && (noise || guide); i++) {
            const double a = (double)was->parts[k].image.pixels[i], b = (double)set->parts[k].image.pixels[i];
            int exponent;
            const double bits = frexp(b, &exponent) * (noise ? 4 : 4096);
            expect_near(b, a, noise ? fabs(a) / 4 : position ? fabs(a) / 4096 : 1. / 512, name);
            assert_true(noise || position ? bits == rint(bits) : b * 256 == rint(b * 256));
        }
    }
    retex_set_close(&set);
    retex_set_close(&was);
}

/* Of a band store, and with any number of threads, all is the same to the bit. */
static void a_band_store_and_threads_change_nothing(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("footprints", 1), *stored = noisy_set("footprints", 1);
    RetexBandStore *store = NULL;
    RetexError err = {0};
    for (int k = 1; k < stored->nparts; k++) {
        RetexPart *part = &stored->parts[k];
        int image;
        part->type = set->parts[k].type = RETEX_FLOAT; /* so that nothing else rounds */
        if (!store)
            test_must(retex_band_store_create(&store, WIDTH, HEIGHT, 0, NULL, &err), &err);
        test_must(retex_band_store_add(store, part->name, part->letters, part->type, &image, &err), &err);
        for (int y = 0; y < HEIGHT; y += RETEX_BAND_ROWS)
            test_must(retex_band_store_put(store, image, y / RETEX_BAND_ROWS,
                                           part->image.pixels + retex_image_index(&part->image, 0, y), &err),
                      &err);
        free(part->image.pixels);
        part->image.pixels = NULL;
        part->source_part = image;
    }
    test_must(retex_set_take_store(stored, store, &err), &err);
    test_must(retex_set_round(set, NULL, 1, &err), &err);
    test_must(retex_set_round(stored, NULL, 3, &err), &err);
    test_must(retex_set_load(stored, 2, &err), &err);
    denoise_expect_same(set, stored);
    retex_set_close(&set);
    retex_set_close(&stored);
}

/* A region is rounded as that part of the whole is, whatever lies around it. */
static void a_pixel_is_rounded_by_itself(void **state)
{
    (void)state;
    static const RetexRoi roi = {13, 21, 50, 40, 0, 3};
    RetexSet *set = noisy_set("footprints", 1), *other = noisy_set("footprints", 1);
    RetexPrecision *precision;
    RetexError err = {0};
    for (int k = 0; k < other->nparts; k++)
        for (int i = 0; i < WIDTH * HEIGHT && other->parts[k].image.width == WIDTH; i++) {
            const int x = i % WIDTH, y = i / WIDTH, channels = other->parts[k].image.channels;
            for (int c = 0; c < channels && (x < roi.x0 || x >= roi.x1 || y < roi.y0 || y >= roi.y1); c++)
                other->parts[k].image.pixels[i * channels + c] *= 0.3f;
        }
    retex_set_round_to_types(other, 2);
    test_must(retex_set_round(set, NULL, 2, &err), &err);
    test_must(retex_precision_open(&precision, other, 1, &err), &err);
    test_must(retex_precision_round(precision, other, &roi, 2, &err), &err);
    retex_precision_close(&precision);
    for (int k = 0; k < set->nparts; k++)
        for (int y = roi.y0; y < roi.y1 && set->parts[k].image.width == WIDTH; y++)
            assert_memory_equal(at(set, k, roi.x0, y), at(other, k, roi.x0, y),
                                sizeof(float) * (size_t)((roi.x1 - roi.x0) * set->parts[k].image.channels));
    retex_set_close(&set);
    retex_set_close(&other);
}

/* A file may have reduced shares: they stay as they are, and light is rounded. */
static void reduced_shares_are_left(void **state)
{
    (void)state;
    RetexSet *set = noisy_set("footprints", 1), *was = noisy_set("footprints", 1);
    RetexError err = {0};
    const int mixture = 0, part = set->mixtures[mixture].shares[0].weight;
    uint32_t seed = 4;
    for (int k = 0; k < set->mixtures[mixture].nshares; k++) {
        RetexImage *im = &set->parts[set->mixtures[mixture].shares[k].weight].image;
        retex_image_free(im);
        test_must(retex_image_alloc(im, WIDTH / 2, HEIGHT / 2, 1, &err), &err);
        for (int i = 0; i < im->width * im->height; i++)
            im->pixels[i] = (float)test_random(&seed);
    }
    RetexImage shares = {0};
    test_must(retex_image_copy(&shares, &set->parts[part].image, &err), &err);
    test_must(retex_set_round(set, NULL, 2, &err), &err);
    expect_light(set, was, was, 0.1, 0);
    assert_memory_equal(set->parts[part].image.pixels, shares.pixels, sizeof(float) * WIDTH / 2 * HEIGHT / 2);
    retex_image_free(&shares);
    retex_set_close(&set);
    retex_set_close(&was);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_is_rounded_to_its_noise),
        cmocka_unit_test(denoised_light_is_rounded_to_less),
        cmocka_unit_test(footprints_are_rounded_by_what_they_multiply),
        cmocka_unit_test(shares_are_rounded_by_what_their_mixture_multiplies),
        cmocka_unit_test(spread_gains_what_means_lose),
        cmocka_unit_test(light_without_noise_is_exact),
        cmocka_unit_test(a_set_without_noise_parts),
        cmocka_unit_test(data_of_denoising_are_rounded),
        cmocka_unit_test(a_band_store_and_threads_change_nothing),
        cmocka_unit_test(a_pixel_is_rounded_by_itself),
        cmocka_unit_test(reduced_shares_are_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
