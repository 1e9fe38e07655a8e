/* How denoising treats noise, and detail that is not noise, on sets whose noise-free values are known. */
#include "lib_denoise.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lib_footprints.h"

static const char *const layouts[] = {"plain", "paper", "footprints"};

/* ---- how near to the truth ---- */

typedef enum { SMOOTH, SILHOUETTE, SHADOW, REGIONS } Region;

static Region region_of(const RetexSet *set, int x, int y)
{
    return fabs(denoise_from_silhouette(set, x, y)) < 2.5 ? SILHOUETTE
           : fabs(denoise_from_shadow(set, x, y)) < 3     ? SHADOW
                                                          : SMOOTH;
}

/* Mean squared errors of a signal's total, by region. */
static void find_errors(double errors[REGIONS], const RetexSet *set, const RetexSet *truth, const RetexSignal *signal)
{
    int counts[REGIONS] = {0};
    memset(errors, 0, sizeof *errors * REGIONS);
    for (int y = 0; y < set->height; y++)
        for (int x = 0; x < set->width; x++) {
            Region region = region_of(set, x, y);
            counts[region]++;
            for (int c = 0; c < 3; c++) {
                double d = denoise_total(set, signal, x, y, c) - denoise_total(truth, signal, x, y, c);
                errors[region] += d * d;
            }
        }
    for (int k = 0; k < REGIONS; k++)
        errors[k] /= 3 * counts[k];
}

static double decibels(double from, double to)
{
    return from > 0 ? 10 * log10(from / to) : 0;
}

static void test_noise_falls(void **state)
{
    (void)state;
    static const char *const names[REGIONS] = {"smooth", "silhouette", "shadow"};
    static const double least[REGIONS] = {6, -0.2, -0.2};
    for (int k = 0; k < 3; k++)
        for (int spp = 5; spp <= 32; spp += 27) {
            RetexSet *set = denoise_set(layouts[k], 150, 130), *truth = denoise_set(layouts[k], 150, 130);
            RetexSignals signals = denoise_signals(truth);
            double before[8][REGIONS], after[REGIONS];
            set->spp = spp;
            denoise_add_noise(set, 7);
            for (int s = 0; s < signals.count; s++)
                find_errors(before[s], set, truth, &signals.of[s]);
            denoise_all(set, NULL, 2);
            for (int s = 0; s < signals.count; s++) {
                find_errors(after, set, truth, &signals.of[s]);
                for (int r = 0; r < REGIONS; r++) {
                    double gain = decibels(before[s][r], after[r]);
                    printf("# %s, %d samples, %s, %s: %.1f dB\n", layouts[k], spp,
                           denoise_signal_name(truth, &signals.of[s]), names[r], gain);
                    if (before[s][r] > 0 && !(gain >= least[r]))
                        fail_msg("%g dB are less than %g", gain, least[r]);
                }
            }
            retex_signals_close(&signals);
            retex_set_close(&set);
            retex_set_close(&truth);
        }
}

/* ---- what is kept ---- */

/* Every pixel's light differs from the next one's by up to a half. */
static void add_detail(RetexSet *set)
{
    uint32_t seed = 9;
    RetexSignals signals = denoise_signals(set);
    for (int s = 0; s < signals.count; s++)
        for (int k = 0; k < signals.of[s].nmembers; k++) {
            float *to = set->parts[signals.of[s].members[k].part].image.pixels;
            for (int i = 0; i < 3 * set->width * set->height; i++)
                to[i] *= (float)(1 - 0.5 * test_random(&seed));
        }
    retex_signals_close(&signals);
}

/* How far one number is from another; relative, where there is anything. */
static double unlike(double is, double was)
{
    double far = fabs(is - was);
    return was > 0 ? far / was : far;
}

static void test_no_noise(void **state)
{
    (void)state;
    for (int detail = 0; detail < 2; detail++)
        for (int k = 0; k < 3; k++) {
            RetexSet *set = denoise_set(layouts[k], 150, 130), *truth = denoise_set(layouts[k], 150, 130);
            RetexSignals signals = denoise_signals(truth);
            double worst = 0, worst_part = 0;
            if (detail)
                add_detail(set), add_detail(truth);
            denoise_all(set, &denoise_exactly, 2);
            for (int s = 0; s < signals.count; s++)
                for (int y = 0; y < set->height; y++)
                    for (int x = 0; x < set->width; x++)
                        for (int c = 0; c < 3; c++) {
                            double is = denoise_total(set, &signals.of[s], x, y, c),
                                   was = denoise_total(truth, &signals.of[s], x, y, c);
                            worst = fmax(worst, unlike(is, was));
                            for (int m = 0; m < signals.of[s].nmembers; m++) {
                                int part = signals.of[s].members[m].part;
                                double a = pixel(set, part, x, y)[c], b = pixel(truth, part, x, y)[c];
                                worst_part = fmax(worst_part, unlike(a, b));
                            }
                        }
            printf("# %s, %s: differs by %.2g, terms by %.2g\n", layouts[k], detail ? "detail" : "smooth", worst,
                   worst_part);
            assert_true(worst < 1e-4);
            assert_true(worst_part < 1e-4 || k == 2); /* clusters share their light in other ways, see below */
            retex_signals_close(&signals);
            retex_set_close(&set);
            retex_set_close(&truth);
        }
}

static void expect_means(const RetexSet *set, const RetexSignals *signals, double before[8][3])
{
    for (int s = 0; s < signals->count; s++)
        for (int c = 0; c < 3; c++) {
            double after = denoise_mean(set, &signals->of[s], c);
            if (!(fabs(after - before[s][c]) <= 1e-4 * before[s][c]))
                fail_msg("the mean of %d, %d was %g and is %g", s, c, before[s][c], after);
        }
}

static void find_means(const RetexSet *set, const RetexSignals *signals, double means[8][3])
{
    for (int s = 0; s < signals->count; s++)
        for (int c = 0; c < 3; c++)
            means[s][c] = denoise_mean(set, &signals->of[s], c);
}

static void test_means(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        RetexSet *set = denoise_set(layouts[k], 150, 130), *truth = denoise_set(layouts[k], 150, 130);
        RetexSignals signals = denoise_signals(truth);
        double means[8][3];
        denoise_add_noise(set, 5);
        find_means(set, &signals, means);
        denoise_all(set, &denoise_exactly, 2);
        expect_means(set, &signals, means);
        retex_signals_close(&signals);
        retex_set_close(&set);
        retex_set_close(&truth);
    }
}

/* One half of a pixel of every signal saw a thousand times the light. */
static void test_firefly(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        RetexSet *set = denoise_set(layouts[k], 150, 130), *truth = denoise_set(layouts[k], 150, 130);
        RetexSignals signals = denoise_signals(truth);
        const int x = 100, y = 90, left = 70;
        double means[8][3], was[8];
        denoise_add_noise(set, 5);
        for (int s = 0; s < signals.count; s++) {
            const RetexSignal *signal = &signals.of[s];
            for (int m = 0; m < signal->nmembers; m++)
                for (int c = 0; c < 3; c++) {
                    float *to = pixel(set, signal->members[m].part, m ? x : left, y) + c,
                          *noise = pixel(set, signal->noise, m ? x : left, y) + c;
                    *noise += signal->members[m].weight * *to * 500, *to *= 501;
                }
            was[s] = denoise_total(set, signal, left, y, 0);
        }
        find_means(set, &signals, means);
        denoise_all(set, NULL, 2);
        expect_means(set, &signals, means);
        for (int s = 0; s < signals.count; s++) {
            double share = denoise_total(set, &signals.of[s], left, y, 0) / was[s];
            printf("# %s, %s: %.3f of the firefly is left\n", layouts[k], denoise_signal_name(truth, &signals.of[s]),
                   share);
            assert_true(share < 0.05);
        }
        retex_signals_close(&signals);
        retex_set_close(&set);
        retex_set_close(&truth);
    }
}

/* An emitter of radiance 100 beside a surface of 0.1, seen in so many samples by each half: what varies is how many of
 * them meet the emitter, and how much light the surface has. */
static void put_emitter(RetexSet *set, int emitter_varies)
{
    uint32_t seed = 3;
    for (int y = 0; y < set->height; y++)
        for (int x = 0; x < set->width; x++) {
            double share = fmin(1, fmax(0, denoise_from_silhouette(set, x, y) + 0.5)), halves[2] = {0, 0};
            for (int k = 0; k < set->spp; k++) {
                double bright = -log(1 - test_random(&seed));
                halves[k % 2] += test_random(&seed) < share ? 0.1 * bright : emitter_varies ? 100 * bright : 100;
            }
            float total = (float)((halves[0] + halves[1]) / set->spp),
                  noise = (float)((halves[0] - halves[1]) / set->spp);
            put_rgb(set, 0, x, y, total, total, total);
            put_rgb(set, retex_set_find_part(set, "noise_beauty"), x, y, noise, noise, noise);
        }
}

static void test_silhouette(void **state)
{
    (void)state;
    for (int varies = 0; varies < 2; varies++)
        for (int spp = 4; spp <= 64; spp *= 4) {
            RetexSet *set = denoise_set("plain", 150, 130);
            double worst[4] = {0}, sum[4] = {0}, least = 100;
            int count[4] = {0};
            set->spp = spp;
            put_emitter(set, varies);
            denoise_all(set, NULL, 2);
            for (int y = 0; y < 130; y++)
                for (int x = 0; x < 150; x++) {
                    double far = denoise_from_silhouette(set, x, y), is = pixel(set, 0, x, y)[0];
                    int ring = far < 1.5 ? 0 : far < 2.5 ? 1 : far < 3.5 ? 2 : 3;
                    if (far > 0.5 && far < 9)
                        worst[ring] = fmax(worst[ring], is), sum[ring] += is, count[ring]++;
                    if (far < -0.5 && far > -6)
                        least = fmin(least, is);
                }
            assert_true(least > 40);
            for (int k = 0; k < 4; k++) /* the pixel beside those that see both takes a little */
                assert_true(sum[k] / count[k] < (k ? spp < 16 ? 0.25 : 0.115 : 2.5) && (!k || worst[k] < 3));
            printf("# emitter %s, %d samples: at least %.3g of 100; of 0.1, by distance:", varies ? "varies" : "steady",
                   spp, least);
            for (int k = 0; k < 4; k++)
                printf(" %.3g (at most %.3g)", sum[k] / count[k], worst[k]);
            printf("\n");
            retex_set_close(&set);
        }
}

/* ---- members of a signal ---- */

static double brightness_of(const RetexSet *set, int footprint)
{
    const float *albedo = set->targets[set->footprints[footprint].target].mean_albedo;
    return fmin(1, fmax(0.5, 0.2126 * (double)albedo[0] + 0.7152 * (double)albedo[1] + 0.0722 * (double)albedo[2]));
}

/* Further hits count as bright as their targets in what is filtered, and by half in what there is noise of. */
static void test_weights_of_members(void **state)
{
    (void)state;
    static const float albedos[][3] = {{0.9f, 0.8f, 0.7f}, {0.2f, 0.3f, 0.1f}, {1.5f, 1.5f, 1.5f}};
    int bright = 0;
    for (int k = 1; k < 3; k++)
        for (int n = 0; n < 3; n++) {
            RetexSet *set = denoise_set(layouts[k], 40, 30);
            memcpy(set->targets[0].mean_albedo, albedos[n], sizeof albedos[n]);
            RetexSignals signals = denoise_signals(set);
            for (int s = 0; s < signals.count; s++)
                for (int m = 0; m < signals.of[s].nmembers; m++) {
                    const RetexSignalMember *member = &signals.of[s].members[m];
                    const RetexTerm *term = &set->terms[member->term];
                    double expected = member->weight;
                    int hits = 0;
                    for (int f = 0; f < term->nfactors; f++) {
                        double most = 0;
                        if (term->factors[f].kind == RETEX_FACTOR_FOOTPRINT)
                            most = brightness_of(set, term->factors[f].index);
                        if (term->factors[f].kind == RETEX_FACTOR_MIXTURE)
                            for (int i = 0; i < set->mixtures[term->factors[f].index].nshares; i++)
                                most =
                                    fmax(most,
                                         brightness_of(set, set->mixtures[term->factors[f].index].shares[i].footprint));
                        expected *= most > 0 && hits++ ? most / 0.5 : 1;
                    }
                    assert_float_equal(member->bright, expected, 1e-5);
                    bright += member->bright > member->weight;
                }
            retex_signals_close(&signals);
            retex_set_close(&set);
        }
    assert_true(bright > 4);
}

/* A set with and without noise, and after denoising. */
typedef struct Sets {
    RetexSet *truth, *noisy, *denoised;
    RetexSignals signals;
} Sets;

static Sets open_sets(const char *layout, int footprints)
{
    Sets sets = {denoise_set(layout, 150, 130), denoise_set(layout, 150, 130), denoise_set(layout, 150, 130), {0}};
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    params.footprints = footprints, params.full_precision = 1;
    sets.signals = denoise_signals(sets.truth);
    denoise_add_noise(sets.noisy, 5);
    denoise_add_noise(sets.denoised, 5);
    denoise_all(sets.denoised, &params, 2);
    return sets;
}

static void close_sets(Sets *sets)
{
    retex_signals_close(&sets->signals);
    retex_set_close(&sets->truth);
    retex_set_close(&sets->noisy);
    retex_set_close(&sets->denoised);
}

/* A member's share of its signal. */
static double share_of(const RetexSet *set, const RetexSignal *signal, int member, int x, int y)
{
    double total = denoise_total(set, signal, x, y, 1);
    const RetexSignalMember *m = &signal->members[member];
    return total > 0 ? m->weight * pixel(set, m->part, x, y)[1] / total : 0;
}

/* It is as noisy, and smooth in truth. Between clusters light stays as it was, or goes with them: of these below. */
static double share_error(const RetexSet *set, const Sets *sets, const RetexSignal *signal, int clusters)
{
    double sum = 0;
    for (int m = 0; m < signal->nmembers; m++)
        for (int i = 0; i < 150 * 130; i++) {
            const int x = i % 150, y = i / 150, cluster = sets->truth->terms[signal->members[m].term].nfactors == 1;
            double share = share_of(sets->truth, signal, m, x, y);
            if (region_of(set, x, y) == SMOOTH && share > 0 && (clusters || !cluster))
                sum += pow(share_of(set, signal, m, x, y) - share, 2);
        }
    return sum;
}

/* Noise is as large, relative to light, where further hits count more than in what there is noise of: light of the most
 * further hits alone, on a white target, in a smooth region. */
static void test_noise_of_white_targets(void **state)
{
    (void)state;
    double errors[2][REGIONS];
    int tested = 0;
    RetexSet *set = denoise_set("paper", 150, 130), *truth = denoise_set("paper", 150, 130);
    RetexSignals signals = denoise_signals(set);
    for (int k = 0; k < 2; k++) {
        RetexSet *to = k ? set : truth;
        for (int t = 0; t < to->ntargets; t++)
            for (int c = 0; c < 3; c++)
                to->targets[t].mean_albedo[c] = 1;
        for (int s = 0; s < signals.count; s++)
            for (int m = 0; m < signals.of[s].nmembers; m++)
                if (signals.of[s].members[m].weight > 0.26f)
                    memset(to->parts[signals.of[s].members[m].part].image.pixels, 0, sizeof(float) * 3 * 150 * 130);
    }
    denoise_add_noise(set, 7);
    RetexSet *noisy = denoise_set("paper", 150, 130);
    for (int part = 0; part < set->nparts; part++)
        memcpy(noisy->parts[part].image.pixels, set->parts[part].image.pixels,
               sizeof(float) * (size_t)set->parts[part].image.width * (size_t)set->parts[part].image.height *
                   (size_t)set->parts[part].image.channels);
    denoise_all(set, &denoise_exactly, 2);
    for (int s = 0; s < signals.count; s++) {
        find_errors(errors[0], noisy, truth, &signals.of[s]);
        find_errors(errors[1], set, truth, &signals.of[s]);
        const double gain = decibels(errors[0][SMOOTH], errors[1][SMOOTH]);
        printf("# %s: %.1f dB\n", denoise_signal_name(truth, &signals.of[s]), gain);
        if (errors[0][SMOOTH] > 0)
            assert_true(gain > 9), tested++;
    }
    assert_true(tested > 0);
    retex_signals_close(&signals);
    retex_set_close(&set);
    retex_set_close(&noisy);
    retex_set_close(&truth);
}

static void test_shares_of_members(void **state)
{
    (void)state;
    for (int k = 1; k < 3; k++) {
        Sets sets = open_sets(layouts[k], 1);
        for (int s = 0; s < sets.signals.count; s++) {
            const RetexSignal *signal = &sets.signals.of[s];
            double gain = decibels(share_error(sets.noisy, &sets, signal, k == 1),
                                   share_error(sets.denoised, &sets, signal, k == 1));
            printf("# %s, %s, shares of %d members: %.1f dB\n", layouts[k], denoise_signal_name(sets.truth, signal),
                   signal->nmembers, gain);
            assert_true(signal->nmembers == 1 || gain > 6);
        }
        close_sets(&sets);
    }
}

/* Light of broad clusters, where footprints are left alone, keeps its proportions; that of sharp ones is between these
 * and cover, which is the same for both. Footprints stay where there was light. */
static void test_proportions_of_clusters(void **state)
{
    (void)state;
    for (int footprints = 0; footprints < 2; footprints++) {
        Sets sets = open_sets("footprints", footprints);
        for (int kind = 0; kind < 2 - footprints; kind++)
            for (int i = 0; i < 150 * 130; i++) {
                const int x = i % 150, y = i / 150, first = sets.truth->terms[1 + 2 * kind].radiance,
                          second = sets.truth->terms[2 + 2 * kind].radiance;
                const float *a = pixel(sets.denoised, first, x, y), *b = pixel(sets.denoised, second, x, y),
                            *c = pixel(sets.noisy, first, x, y), *d = pixel(sets.noisy, second, x, y);
                for (int k = 0; k < 3 && c[k] + d[k] > 0 && a[k] + b[k] > 0; k++) {
                    float share = a[k] / (a[k] + b[k]), was = c[k] / (c[k] + d[k]);
                    float least = kind ? was : fminf(was, 0.5f), most = kind ? was : fmaxf(was, 0.5f);
                    float rounding = 1e-3f; /* of halves */
                    if (!(share >= least - rounding && share <= most + rounding))
                        fail_msg("%g : %g were %g : %g", (double)a[k], (double)b[k], (double)c[k], (double)d[k]);
                }
                const int uv = sets.truth->footprints[2 * kind].uv;
                if (c[0] + d[0] > 0)
                    assert_memory_equal(pixel(sets.denoised, uv, x, y), pixel(sets.noisy, uv, x, y), 12);
            }
        close_sets(&sets);
    }
}

/* Where the light of a sharp signal has a relative deviation of `noise`, its clusters' proportions are between those of
 * their light and of their cover: the more noise the nearer to these, but as if no sample's variance were more than its
 * light squared, or less than half of that. */
static double expected_share(const RetexSet *set, double noise, int x, int y)
{
    double light[2], cover[2], chance = 0, differs = 0;
    for (int k = 0; k < 2; k++) {
        light[k] = (double)pixel(set, set->terms[1 + k].radiance, x, y)[1];
        cover[k] = (double)pixel(set, set->footprints[k].uv, x, y)[2];
    }
    const double by_light = light[0] / (light[0] + light[1]), all = cover[0] + cover[1], by_cover = cover[0] / all;
    for (int k = 0; k < 2; k++) {
        const double samples = set->spp * cover[k], of_light = k ? 1 - by_light : by_light,
                     variance = fmin(1, fmax(0.5, noise * noise * all * set->spp)) / samples;
        chance += of_light * of_light * variance;
        differs += pow(by_light - by_cover, 2);
    }
    const double belief = differs > chance ? 1 - chance / differs : 0;
    return belief * by_light + (1 - belief) * by_cover;
}

static void test_clusters_are_believed_by_their_noise(void **state)
{
    (void)state;
    static const double noises[] = {0, 0.2, 0.42, 0.5, 1};
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    params.footprints = 0, params.full_precision = 1;
    for (int n = 0; n < 5; n++) {
        RetexSet *set = denoise_set("footprints", 60, 50), *before = denoise_set("footprints", 60, 50);
        int part = -1;
        for (int k = 0; k < 2; k++) {
            RetexSet *to = k ? set : before;
            RetexSignals signals = denoise_signals(to);
            for (int s = 0; s < signals.count; s++)
                if (signals.of[s].target == 0 && signals.of[s].kind == RETEX_FOOTPRINT_SHARP)
                    part = signals.of[s].noise;
            for (int i = 0; i < 60 * 50; i++) {
                float *light[2] = {to->parts[to->terms[1].radiance].image.pixels + 3 * i,
                                   to->parts[to->terms[2].radiance].image.pixels + 3 * i};
                for (int c = 0; c < 3; c++) {
                    light[0][c] *= 1.4f, light[1][c] *= 0.8f;
                    to->parts[part].image.pixels[3 * i + c] = (float)noises[n] * (light[0][c] + light[1][c]);
                }
                for (int f = 0; f < 2; f++)
                    to->parts[to->footprints[f].uv].image.pixels[3 * i + 2] *= 0.5f;
            }
            retex_signals_close(&signals);
        }
        denoise_all(set, &params, 1);
        int seen = 0;
        for (int i = 0; i < 60 * 50; i++) {
            const int x = i % 60, y = i / 60;
            const float a = pixel(set, set->terms[1].radiance, x, y)[1],
                        b = pixel(set, set->terms[2].radiance, x, y)[1];
            if (!(a + b > 0) || !(pixel(before, set->terms[1].radiance, x, y)[1] > 0))
                continue;
            const double share = expected_share(before, noises[n], x, y);
            seen++;
            if (!(fabs((double)(a / (a + b)) - share) < 2e-3))
                fail_msg("noise of %g: %d,%d has a share of %g, not %g", noises[n], x, y, (double)(a / (a + b)), share);
        }
        printf("# noise of %g: %d pixels\n", noises[n], seen);
        assert_true(seen > 500);
        retex_set_close(&set);
        retex_set_close(&before);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_noise_falls),
        cmocka_unit_test(test_no_noise),
        cmocka_unit_test(test_means),
        cmocka_unit_test(test_firefly),
        cmocka_unit_test(test_silhouette),
        cmocka_unit_test(test_weights_of_members),
        cmocka_unit_test(test_noise_of_white_targets),
        cmocka_unit_test(test_shares_of_members),
        cmocka_unit_test(test_proportions_of_clusters),
        cmocka_unit_test(test_clusters_are_believed_by_their_noise),
    };
    return cmocka_run_group_tests_name("denoise_noise", tests, NULL, NULL);
}
