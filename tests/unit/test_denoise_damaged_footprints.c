/* Denoising the footprints of whole sets: properties on random sets, inconsistent sets, repeatable results, and speed.
 * */
#include "lib_footprints.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* ---- damaged sets ---- */

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
            RetexNeighbour neighbours[25] = {{x, y, 1}};
            int count = 1;
            for (int dy = -6; dy <= 6; dy += 3)
                for (int dx = -6; dx <= 6; dx += 3)
                    if ((dx || dy) && x + dx >= 0 && y + dy >= 0 && x + dx < set->width && y + dy < set->height)
                        neighbours[count++] = (RetexNeighbour){x + dx, y + dy, 1.0f / (float)(1 + abs(dx) + abs(dy))};
            for (int s = 0; s < w->d.signals.count; s++)
                retex_denoise_share_light(w->footprints, &w->d, &w->d.signals.of[s], x, y, neighbours, count, light,
                                          &w->out);
            retex_denoise_share_later(w->footprints, &w->d, x, y, neighbours, count, &w->out);
        }
}

static int is_cluster(const RetexSet *set, const RetexSignalMember *m)
{
    const RetexTerm *term = &set->terms[m->term];
    return term->nfactors == 1 && term->factors[0].kind == RETEX_FACTOR_FOOTPRINT &&
           set->footprints[term->factors[0].index].kind != RETEX_FOOTPRINT_HIT;
}

/* Clusters hold the light, and whatever is written is a number. */
static void expect_whole(const Work *w, const float light[3])
{
    const RetexSet *set = w->d.set;
    for (int s = 0; s < w->d.signals.count; s++)
        for (size_t i = 0; i < 3 * (size_t)set->width * (size_t)set->height; i++) {
            const RetexSignal *signal = &w->d.signals.of[s];
            float sum = 0;
            int count = 0;
            for (int k = 0; k < signal->nmembers; k++)
                if (is_cluster(set, &signal->members[k]))
                    sum += w->out.parts[signal->members[k].part][i], count++;
            if (count && !(fabsf(sum - light[i % 3]) <= 1e-5f * light[i % 3]))
                fail_msg("signal %d has %g of %g", s, sum, light[i % 3]);
        }
    for (int k = 0; k < set->nparts; k++) {
        const RetexImage *im = &set->parts[k].image;
        for (int i = 0; i < im->width * im->height * im->channels && w->out.parts[k]; i++)
            assert_true(isfinite(w->out.parts[k][i]) && w->out.parts[k][i] != -7);
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
        add_footprint(set, k / 2, RETEX_FOOTPRINT_INTERREFLECTION, 7 + k % 2, "RGB");
    later = add_mixture(set, first, 4, "R");
    for (int t = 0; t < 2; t++)
        for (int kind = 0; kind < 2; kind++)
            for (int n = 2; n < 6; n++)
                add_term(set, n, kinds[t][kind], later);
    for (int k = 0; k < set->nparts; k++)
        random_pixels(set, k, &seed);
    for (int k = 0; k < set->nfootprints; k++) /* of different hits, at different places */
        for (int i = 0; i < width * height; i++)
            set->parts[set->footprints[k].uv].image.pixels[3 * i] *= 0.25f,
                set->parts[set->footprints[k].uv].image.pixels[3 * i] += (float)set->footprints[k].hit;
    return set;
}

/* Of broad clusters; those of interreflections stay. */
static void test_shares_sum_to_one(void **state)
{
    (void)state;
    static const float light[] = {0.25f, 1, 3};
    RetexSet *set = random_set(19, 11);
    Work w = open_work(set, 1);
    denoise_all(&w, light);
    expect_whole(&w, light);
    for (int m = 0; m < set->nmixtures; m++) {
        const struct RetexMixture *mixture = &set->mixtures[m];
        const RetexFootprintKind kind = set->footprints[mixture->shares[0].footprint].kind;
        for (int i = 0; i < 19 * 11 && kind != RETEX_FOOTPRINT_SHARP; i++) {
            float sum = 0, own = 0;
            for (int k = 0; k < mixture->nshares; k++) {
                sum += w.out.parts[mixture->shares[k].weight][i];
                own += set->parts[mixture->shares[k].weight].image.pixels[i];
            }
            assert_true(fabsf(sum - (kind == RETEX_FOOTPRINT_BROAD ? 1 : own)) <= 0.5f / 256 * 2);
        }
    }
    close_work(&w);
}

static void test_odd_sets(void **state)
{
    (void)state;
    static const float light[] = {0.25f, 1, 3};
    for (int damage = 0; damage < 10; damage++)
        for (int footprints = 0; footprints < 2; footprints++) {
            RetexSet *set = random_set(13, 9);
            RetexFootprint *f = set->footprints;
            struct RetexShare *share = set->mixtures[1].shares;
            RetexError err = {0};
            switch (damage) {
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
            assert_int_equal(damage && w.written[set->footprints[4].albedo], damage == 3 || damage == 4);
            denoise_all(&w, light);
            if (damage != 0 && damage != 6)
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
    static const float grey[] = {1, 1, 1};
    Work once = open_work(random_set(SIDE, SIDE), 1), twice = open_work(random_set(SIDE, SIDE), 1);
    const RetexSet *set = once.d.set;
    struct timespec start, end;
    denoise_all(&once, grey);
    denoise_all(&twice, grey);
    for (int k = 0; k < set->nparts; k++)
        if (once.out.parts[k])
            assert_memory_equal(once.out.parts[k], twice.out.parts[k],
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
        cmocka_unit_test(test_shares_sum_to_one),
        cmocka_unit_test(test_odd_sets),
        cmocka_unit_test(test_any_set),
        cmocka_unit_test(test_repeatable),
    };
    return cmocka_run_group_tests_name("denoise_odd_footprints", tests, NULL, NULL);
}
