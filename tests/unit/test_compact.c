/* A compact set gives the same pictures as its source, from fewer numbers. */
#include "lib_compact.h"

#include <math.h>
#include <string.h>

#include <cmocka.h>

#include <retex/color.h>

#include "compact/clusters.h"

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
        const int first = term->nfactors ? test_factor_number(term->factors[0]) : MIXTURE(-1);
        const RetexFootprintKind kind =
            term->nfactors && first >= 0 ? set->footprints[first].kind : RETEX_FOOTPRINT_HIT;
        const int again = term->nfactors > 1 && first == MIXTURE(0); /* of the sharp clusters */
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
        const int later = ntargets > 1 ? MIXTURE(set->nmixtures - 1) : MIXTURE(2);
        const int before = set->nterms;
        uint32_t seed = 3;
        for (int order = 3; order <= 11; order++)
            add_term(set, 1 + order, MIXTURE(0), later);
        for (int i = before; i < set->nterms; i++)
            fill_light(set, set->terms[i].radiance, &seed);
        RetexSet *compact = compacted(set, 4, 8, 1);
        int many = 0;
        for (int i = 0; i < compact->nterms; i++)
            many += retex_term_hits(&compact->terms[i]) > 3;
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

/* That part 0 is the picture of all originals is no light, and no longer true of what is stored with losses, be it made
 * compact or copied. */
static void the_picture_is_no_term(void **state)
{
    (void)state;
    const RetexTerm whole = {.role = RETEX_ROLE_PICTURE, .target = -1};
    RetexSet *set = whole_set(1, 2), *compact;
    RetexError err = {0};
    test_must(retex_set_add_term(set, &whole, NULL, &err), &err);
    for (int copied = 0; copied < 2; copied++) {
        strcpy(set->layout, copied ? "paper" : "footprints");
        test_must(retex_set_compact(&compact, set, NULL, 2, &err), &err);
        assert_int_equal(compact->nterms < set->nterms - 1, !copied);
        assert_int_equal(retex_set_has_role(compact, RETEX_ROLE_PICTURE), 0);
        retex_set_close(&compact);
    }
    retex_set_close(&set);
}

static int make_clusters(RetexCompactClusters *clusters, const RetexCompactLight *light, const RetexCompactKind *kind,
                         int scale, int nthreads, RetexError *err)
{
    int code = retex_compact_clusters_begin(clusters, light, kind, scale, err);
    if (!code)
        retex_compact_clusters_rows(clusters, light, kind, 0, nthreads);
    return code ? code : retex_compact_clusters_end(clusters, light, kind, nthreads, err);
}

/* Nor are corrections: footprints lie where light is, whatever sign and size these have. */
static void corrections_move_no_footprints(void **state)
{
    (void)state;
    RetexSet *set = whole_set(1, 2);
    RetexError err = {0};
    RetexTerm term = test_term(set, 0, 2, (int[]){MIXTURE(0), MIXTURE(2)});
    uint32_t seed = 5;
    RetexCompactLight light;
    const char *unknown;
    RetexCompactClusters clusters[2];
    for (int k = 0; k < 2; k++) {
        test_must(retex_compact_light_open(&light, set, 0, &unknown, &err), &err);
        assert_null(unknown);
        int kind = 0;
        while (light.kinds[kind].kind != RETEX_FOOTPRINT_INTERREFLECTION)
            kind++;
        test_must(make_clusters(&clusters[k], &light, &light.kinds[kind], 4, 1, &err), &err);
        retex_compact_light_close(&light);
        if (k)
            break;
        test_must(retex_set_add_part(set, "correction", "RGB", RETEX_HALF, 0, 0, &term.radiance, &err), &err);
        for (int i = 0; i < 3 * WIDE * HIGH; i++)
            set->parts[term.radiance].image.pixels[i] = (float)(20 * test_random(&seed) - 10);
        test_must(retex_set_add_correction(set, &term, NULL, &err), &err);
    }
    assert_int_equal(clusters[0].count, clusters[1].count);
    for (int k = 0; k < clusters[0].count; k++) {
        const RetexImage *a = &clusters[0].weight[k], *b = &clusters[1].weight[k];
        assert_memory_equal(a->pixels, b->pixels, sizeof(float) * retex_image_index(a, 0, a->height));
    }
    retex_compact_clusters_free(&clusters[0]);
    retex_compact_clusters_free(&clusters[1]);
    retex_set_close(&set);
}

/* They are rounded to 8 RMS errors of what is kept, of the picture's mean, and left out below 45 dB or where nothing
 * is left. */
static void corrections_are_as_fine_as_what_is_kept(void **state)
{
    (void)state;
    RetexSet *set = whole_set(1, 2);
    RetexError err = {0};
    RetexTerm term = test_term(set, 0, 2, (int[]){MIXTURE(0), MIXTURE(2)});
    uint32_t seed = 6;
    const double mean = 0.7;
    for (int i = 0; i < 3 * WIDE * HIGH; i++)
        set->parts[0].image.pixels[i] = i % 2 ? 1.5f * (float)mean : 0.5f * (float)mean;
    test_must(retex_set_add_part(set, "correction", "RGB", RETEX_HALF, 0, 0, &term.radiance, &err), &err);
    for (int i = 0; i < 3 * WIDE * HIGH; i++)
        set->parts[term.radiance].image.pixels[i] = (float)((test_random(&seed) - 0.5) * mean / 16);
    test_must(retex_set_add_correction(set, &term, NULL, &err), &err);
    for (int psnr = 44; psnr <= 80; psnr += 12) {
        RetexCompactParams params = RETEX_COMPACT_INIT;
        RetexSet *compact;
        params.broad = 4, params.interreflection = 8, params.gain = 1, params.psnr = psnr;
        test_must(retex_set_compact(&compact, set, &params, 2, &err), &err);
        const double step = 8 * mean * pow(10, -psnr / 20.0), from = step / 2;
        int found = 0;
        double worst = 0, finest = HUGE_VAL;
        for (int t = 0; t < compact->nterms; t++) {
            if (compact->terms[t].role != RETEX_ROLE_CORRECTION)
                continue;
            const float *is = compact->parts[compact->terms[t].radiance].image.pixels;
            const float *was = set->parts[term.radiance].image.pixels;
            found++;
            for (int i = 0; i < 3 * WIDE * HIGH; i++) {
                worst = fmax(worst, fabs((double)is[i] - (double)was[i]));
                finest = is[i] != 0 ? fmin(finest, fabs((double)is[i])) : finest;
            }
        }
        assert_int_equal(found, psnr >= 45 && mean / 32 > from);
        if (found) { /* the power of two at or below the step is taken */
            assert_true(worst <= from && finest >= step / 2.01);
            assert_true(worst > from / 4);
        }
        retex_set_close(&compact);
    }
    retex_set_close(&set);
}

/* Those of light from either of two targets have the textures of both. */
static void corrections_are_of_all_targets(void **state)
{
    (void)state;
    RetexSet *set = whole_set(2, 2);
    RetexError err = {0};
    const RetexMixture *last = &set->mixtures[set->nmixtures - 1];
    RetexTerm term = test_term(set, 0, 2, (int[]){MIXTURE(0), MIXTURE(set->nmixtures - 1)});
    int of_set = 0, found = 0;
    for (int k = 0; k < last->nshares; k++)
        of_set |= 1 << set->footprints[last->shares[k].footprint].target;
    assert_int_equal(of_set, 3);
    test_must(retex_set_add_part(set, "correction", "RGB", RETEX_HALF, 0, 0, &term.radiance, &err), &err);
    put_rgb(set, term.radiance, 3, 3, 1, 1, 1);
    test_must(retex_set_add_correction(set, &term, NULL, &err), &err);
    RetexSet *compact = compacted(set, 4, 8, 1);
    for (int t = 0; t < compact->nterms; t++) {
        if (compact->terms[t].role != RETEX_ROLE_CORRECTION)
            continue;
        const RetexFactor factor = compact->terms[t].factors[1];
        int targets = 0;
        found++;
        assert_int_equal(factor.kind, RETEX_FACTOR_MIXTURE);
        const RetexMixture *mixture = &compact->mixtures[factor.index];
        for (int k = 0; k < mixture->nshares; k++)
            targets |= 1 << compact->footprints[mixture->shares[k].footprint].target;
        assert_int_equal(targets, 3);
    }
    assert_int_equal(found, 1);
    retex_set_close(&set);
    retex_set_close(&compact);
}

static void one_cluster_needs_no_mixture(void **state)
{
    RetexSet *set = whole_set(1, 1), *compact = compacted(set, 4, 8, 2);
    (void)state;
    assert_int_equal(retex_set_find_part(compact, "weight_T0_sharp1"), -1);
    for (int i = 0; i < compact->nterms; i++)
        for (int k = 0; k < compact->terms[i].nfactors && retex_term_hits(&compact->terms[i]) == 1; k++)
            assert_true(compact->terms[i].factors[k].kind != RETEX_FACTOR_MIXTURE);
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

/* A block's clusters have the light of all clusters that were merged into them, of both kinds. */
static void merged_clusters_have_all_their_light(void **state)
{
    enum { CLUSTERS = 3, SCALE = 4 };
    RetexSet *set = whole_set(1, CLUSTERS);
    RetexCompactLight light;
    RetexCompactClusters clusters;
    RetexError err = {0};
    uint32_t seed = 11;
    const char *unknown;
    int sharp = 0;
    (void)state;
    for (int k = 0; k < CLUSTERS; k++)
        for (int y = 0; y < HIGH; y++)
            for (int x = 0; x < WIDE; x++) { /* far apart, and each at nearly the same place in all pixels */
                put(set, k, x, y, 0.1f + 0.4f * (float)k + 1e-3f * (float)test_random(&seed), 0.5f, 0.5f);
                put_spread(set, k, x, y, 1e-3f, 1e-3f, 0.5f);
            }
    test_must(retex_compact_light_open(&light, set, 0, &unknown, &err), &err);
    assert_null(unknown);
    while (light.kinds[sharp].kind != RETEX_FOOTPRINT_SHARP)
        sharp++;
    test_must(make_clusters(&clusters, &light, &light.kinds[sharp], SCALE, 1, &err), &err);
    assert_int_equal(clusters.count, CLUSTERS);
    for (int by = 0; by < HIGH / SCALE; by++)
        for (int bx = 16 / SCALE; bx < WIDE / SCALE; bx++) {
            double single[CLUSTERS] = {0}, further[CLUSTERS] = {0}, singles = 0, furthers = 0;
            for (int i = 0; i < SCALE * SCALE; i++) {
                const int x = SCALE * bx + i % SCALE, y = SCALE * by + i / SCALE;
                double all = 0, shares = 0;
                for (int n = 0; n < set->nterms; n++) {
                    const RetexTerm *term = &set->terms[n];
                    const float *rgb = at(set, term->radiance, x, y);
                    const double lum = retex_luminance((double)rgb[0], (double)rgb[1], (double)rgb[2]);
                    const int first = term->nfactors ? test_factor_number(term->factors[0]) : CLUSTERS;
                    if (term->nfactors == 1 && first < CLUSTERS)
                        single[first] += lum, singles += lum;
                    if (term->nfactors > 1 && first == MIXTURE(0))
                        all += pow(0.6, term->nfactors - 1) * lum;
                }
                for (int k = 0; k < CLUSTERS; k++)
                    shares += (double)*at(set, share_part(set, k), x, y);
                for (int k = 0; k < CLUSTERS; k++)
                    further[k] += all * (double)*at(set, share_part(set, k), x, y) / shares;
                furthers += all;
            }
            const size_t block = (size_t)by * (size_t)clusters.albedo.width + (size_t)bx;
            for (int k = 0; k < CLUSTERS; k++) {
                assert_float_equal(clusters.uv[k].pixels[3 * block], 0.1 + 0.4 * k, 2e-3);
                assert_float_equal(clusters.weight[k].pixels[block], single[k] / singles, 1.0 / 512);
                assert_float_equal(clusters.interreflected[k].pixels[block], further[k] / furthers, 1.0 / 512);
            }
        }
    retex_compact_clusters_free(&clusters);
    retex_compact_light_close(&light);
    retex_set_close(&set);
}

/* Two sharp clusters a pixel with a distance that differs from pixel to pixel, and three quarters of the light in the
 * first; how many footprints are left. */
static int left_of_pair(float distance, int spp, double noise)
{
    RetexSet *set = start_sharp_set(), *compact;
    RetexCompactParams params = RETEX_COMPACT_INIT;
    RetexError err = {0};
    uint32_t seed = 3;
    set->spp = spp;
    params.broad = 4, params.interreflection = 8, params.gain = 1, params.noise = noise;
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++)
            for (int k = 0; k < 2; k++) {
                const float turn = (float)(6.28 * test_random(&seed)), light = k ? 1 : 3;
                put(set, k, x, y, 0.5f + (float)k * distance * cosf(turn), 0.5f + (float)k * distance * sinf(turn),
                    0.5f);
                put_spread(set, k, x, y, 0.0005f, 0.0005f, 0);
                put_rgb(set, set->footprints[k].albedo, x, y, 0.5f, 0.5f, 0.5f);
                put_rgb(set, light_part(set, k), x, y, light, light, light);
            }
    test_must(retex_set_compact(&compact, set, &params, 2, &err), &err);
    int count = 0;
    for (int k = 0; k < compact->nfootprints; k++)
        count += pixel(compact, compact->footprints[k].uv, WIDE / 2, HIGH / 2)[2] > 0;
    retex_set_close(&set);
    retex_set_close(&compact);
    return count;
}

/* Together the variance of UV is 3/16 of the distance squared, V, and clusters alone have nearly none. The light of
 * both is 4, which merging changes by 4 (V / (V + .02^2))^1.5, and noise by the root of (9 + 1) / (spp / 2). */
static void clusters_merge_within_noise(void **state)
{
    static const float distances[] = {0.01f, 0.02f, 0.04f, 0.08f, 0.3f};
    static const int counts[] = {4, 16, 64, 256, 4096};
    (void)state;
    for (int d = 0; d < 5; d++)
        for (int n = 0; n < 5; n++) {
            const double v = 3.0 / 16 * pow((double)distances[d], 2), error = 4 * pow(v / (v + 0.0004), 1.5);
            const double chance = sqrt(10 / (0.5 * counts[n]));
            if (fabs(log(error / chance)) < 0.1)
                continue;
            assert_int_equal(left_of_pair(distances[d], counts[n], 1), error < chance ? 1 : 2);
            if (fabs(log(error / chance / 0.125)) > 0.1)
                assert_int_equal(left_of_pair(distances[d], counts[n], 0.5), error < 0.125 * chance ? 1 : 2);
        }
}

/* Light with further hits has weights of its own if it is a tenth of all light of sharp clusters or more. */
static void little_light_has_no_weights_of_its_own(void **state)
{
    (void)state;
    for (int little = 0; little < 2; little++) {
        RetexSet *set = whole_set(1, 3);
        for (int i = 0; i < set->nterms; i++)
            for (int k = 0; k < 3 * WIDE * HIGH && retex_term_hits(&set->terms[i]) > 1; k++)
                set->parts[set->terms[i].radiance].image.pixels[k] *= little ? 0.05f : 0.5f;
        RetexSet *compact = compacted(set, 4, 8, 1);
        assert_int_equal(retex_set_find_part(compact, "share_T0_sharp1") < 0, little);
        assert_true(retex_set_find_part(compact, "weight_T0_sharp1") >= 0);
        retex_set_close(&set);
        retex_set_close(&compact);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(grey_is_exact_at_all_scales),
        cmocka_unit_test(constants_are_exact_where_gains_are_whole),
        cmocka_unit_test(originals_are_exact),
        cmocka_unit_test(energy_is_kept_in_one_image),
        cmocka_unit_test(weights_are_shares),
        cmocka_unit_test(merged_clusters_have_all_their_light),
        cmocka_unit_test(clusters_merge_within_noise),
        cmocka_unit_test(little_light_has_no_weights_of_its_own),
        cmocka_unit_test(few_orders_tell_of_many),
        cmocka_unit_test(the_picture_is_no_term),
        cmocka_unit_test(corrections_move_no_footprints),
        cmocka_unit_test(corrections_are_as_fine_as_what_is_kept),
        cmocka_unit_test(corrections_are_of_all_targets),
        cmocka_unit_test(one_cluster_needs_no_mixture),
        cmocka_unit_test(empty_kinds_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
