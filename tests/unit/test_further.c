/* Light that meets textures more often than a set keeps hits apart: the factor of quantity FURTHER against the
 * geometric series pixel by pixel, in sets, files, streams and packs; and the ratio that a render finds, against light
 * that falls by a known one. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include <retex/retex.h>

#include "lib_compact.h"
#include "lib_folder.h"
#include "lib_test.h"

static const float RATIO[3] = {0.25f, 0.9f, 1}, PAINT[3] = {0.125f, 0.9375f, 0.5f};

enum { HITS = 9 };

/* ---- the formula ---- */

static double series(double x)
{
    double sum = 0;
    for (int k = 0; k <= HITS; k++)
        sum += pow(x, k);
    return sum;
}

/* paint: of target 0; NULL: none. */
static double color_of(const RetexSet *set, int footprint, const float *paint, size_t i)
{
    const RetexFootprint *f = &set->footprints[footprint];
    const double covered = (double)set->parts[f->uv].image.pixels[3 * (i / 3) + 2] > 0;
    return paint && f->target == 0 ? covered * (double)paint[i % 3] : (double)set->parts[f->albedo].image.pixels[i];
}

static double factor_color(const RetexSet *set, RetexFactor factor, const float *paint, size_t i)
{
    if (factor.kind == RETEX_FACTOR_FOOTPRINT)
        return color_of(set, factor.index, paint, i);
    const RetexMixture *m = &set->mixtures[factor.index];
    double sum = 0, weights = 0;
    for (int k = 0; k < m->nshares; k++) {
        const RetexImage *weight = &set->parts[m->shares[k].weight].image;
        const double w = (double)weight->pixels[weight->channels == 3 ? i : i / 3];
        sum += w * color_of(set, m->shares[k].footprint, paint, i);
        weights += w;
    }
    return weights > 0 ? sum / weights : 0;
}

static double factor_value(const RetexSet *set, RetexFactor factor, const float *paint, size_t i)
{
    const double color = factor_color(set, factor, paint, i), q = (double)RATIO[i % 3];
    return factor.quantity == RETEX_QUANTITY_COLOR ? color
                                                   : series(q * color) / series(q * factor_color(set, factor, NULL, i));
}

static double picture_value(const RetexSet *set, const float *paint, size_t i)
{
    double sum = 0;
    for (int t = 0; t < set->nterms; t++) {
        double product = (double)set->parts[set->terms[t].radiance].image.pixels[i];
        for (int k = 0; k < set->terms[t].nfactors; k++)
            product *= factor_value(set, set->terms[t].factors[k], paint, i);
        sum += product;
    }
    return sum;
}

static RetexTextureSpec painted(const RetexSet *set, const float *paint)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    strcpy(spec.target, set->targets[0].name);
    spec.constant = 1;
    memcpy(spec.color, paint ? paint : spec.color, sizeof spec.color);
    return spec;
}

static RetexImage combined(const RetexSet *set, const float *paint)
{
    const RetexTextureSpec spec = painted(set, paint);
    RetexImage made = {0};
    test_combine(&made, set, &spec, paint != NULL, NULL);
    return made;
}

static void expect_picture(RetexImage made, const RetexSet *set, const float *paint, double tolerance)
{
    for (size_t i = 0; i < 3 * (size_t)set->width * (size_t)set->height; i++) {
        const double want = picture_value(set, paint, i);
        if (fabs((double)made.pixels[i] - want) > tolerance * fabs(want) + 1e-6)
            fail_msg("value %zu is %g, not %g", i, (double)made.pixels[i], want);
    }
    retex_image_free(&made);
}

/* A term for each footprint and mixture, of two hits and further ones. */
static RetexSet *further_set(void)
{
    RetexSet *set = test_set(37, 21, 3);
    RetexSetInfo info = retex_set_info(set);
    RetexError err = {0};
    test_make_footprints(set);
    info.further_hits = HITS;
    memcpy(info.further_ratio, RATIO, sizeof RATIO);
    test_must(retex_set_describe(set, &info, &err), &err);
    for (int n = 0; n < set->nfootprints + set->nmixtures; n++) {
        const int hit = n < set->nfootprints ? n : MIXTURE(n - set->nfootprints);
        RetexTerm term = test_term(set, set->terms[set->nterms - 1].radiance, 2, (int[]){hit, hit});
        term.factors[term.nfactors] = term.factors[1];
        term.factors[term.nfactors++].quantity = RETEX_QUANTITY_FURTHER;
        test_must(retex_set_add_term(set, &term, NULL, &err), &err);
    }
    return set;
}

static void further_hits_are_a_series(void **state)
{
    (void)state;
    RetexSet *set = further_set();
    assert_true(set->nmixtures > 0);
    expect_picture(combined(set, PAINT), set, PAINT, 2e-3); /* samples are halves */
    expect_picture(combined(set, NULL), set, NULL, 1e-5);
    retex_set_close(&set);
}

/* Originals reproduce the light exactly: as without the factor. */
static void originals_change_nothing(void **state)
{
    (void)state;
    RetexSet *set = further_set();
    RetexImage with = combined(set, NULL);
    for (int t = 0; t < set->nterms; t++) {
        RetexTerm *term = &set->terms[t];
        term->nfactors -= term->nfactors == 3 && term->factors[2].quantity == RETEX_QUANTITY_FURTHER;
    }
    RetexImage without = combined(set, NULL);
    assert_memory_equal(with.pixels, without.pixels, sizeof(float) * 3 * 37 * 21);
    retex_image_free(&with);
    retex_image_free(&without);
    retex_set_close(&set);
}

static void a_further_factor_is_no_hit(void **state)
{
    (void)state;
    RetexSet *set = further_set();
    assert_int_equal(retex_term_hits(&set->terms[set->nterms - 1]), 2);
    retex_set_close(&set);
}

/* ---- files ---- */

static void files_keep_it(void **state)
{
    (void)state;
    RetexSet *set = further_set(), *back;
    RetexError err = {0};
    for (int packed = 0; packed < 2; packed++) {
        const char *path = test_in_folder(packed ? "further.retex" : "further.exr");
        RetexPackParams params = RETEX_PACK_INIT;
        params.lossless = 1;
        test_must(packed ? retex_pack_write(set, path, &params, NULL, 2, &err)
                         : retex_set_write(set, path, NULL, 2, &err),
                  &err);
        test_must(retex_set_read(path, &back, 2, &err), &err);
        const RetexSetInfo info = retex_set_info(back);
        assert_int_equal(info.further_hits, HITS);
        assert_memory_equal(info.further_ratio, RATIO, sizeof RATIO);
        expect_picture(combined(back, PAINT), back, PAINT, 2e-3);
        retex_set_close(&back);
    }
    retex_set_close(&set);
}

/* Streams keep the original albedos that the factor needs. */
static void streams_keep_it(void **state)
{
    (void)state;
    RetexSet *set = further_set(), *back;
    const RetexTextureSpec spec = painted(set, PAINT);
    RetexImage made = {0};
    RetexError err = {0};
    const char *path = test_in_folder("stream.exr");
    test_must(retex_sample(set, &spec, 1, 1, &err), &err);
    test_must(retex_set_write(set, path, NULL, 2, &err), &err);
    test_must(retex_set_read(path, &back, 2, &err), &err);
    test_must(retex_combine(&made, back, NULL, NULL, 2, &err), &err);
    expect_picture(made, set, PAINT, 2e-3);
    retex_set_close(&back);
    retex_set_close(&set);
}

/* ---- the ratio ---- */

/* Light of `hits` hits of a footprint of one albedo: of exactly so many, and of all further ones with RATIO. */
static void add_falling_light(RetexSet *set, int footprint, int hits, float albedo)
{
    const RetexImage shape = set->parts[0].image; /* parts move when one is added */
    RetexError err = {0};
    RetexFactor factor = retex_factor(RETEX_FACTOR_FOOTPRINT, footprint);
    for (int last = 0; last < 2; last++) {
        RetexTerm term = {.role = RETEX_ROLE_DEP, .target = 0};
        const char *name = last ? "last" : "before";
        test_must(retex_set_add_part(set, name, "RGB", RETEX_HALF, 0, 0, &term.radiance, &err), &err);
        while (term.nfactors < hits - 1 + last)
            term.factors[term.nfactors++] = factor;
        if (last) {
            factor.quantity = RETEX_QUANTITY_FURTHER;
            term.factors[term.nfactors++] = factor;
        }
        float *light = set->parts[term.radiance].image.pixels;
        for (size_t i = 0; i < retex_image_index(&shape, 0, shape.height); i++) {
            const double q = (double)RATIO[i % 3], before = (double)(1 + i % 5);
            light[i] = (float)(last ? q * before * series(q * (double)albedo) : before);
        }
        test_must(retex_set_add_term(set, &term, NULL, &err), &err);
    }
    RetexImage *albedos = &set->parts[set->footprints[footprint].albedo].image;
    for (size_t i = 0; i < retex_image_index(albedos, 0, albedos->height); i++)
        albedos->pixels[i] = albedo;
}

static void the_ratio_is_that_of_light_that_falls(void **state)
{
    (void)state;
    for (int dark = 0; dark < 2; dark++) {
        RetexSet *set = test_set(37, 21, 3);
        RetexError err = {0};
        test_must(retex_set_find_further(set, &err), &err);
        assert_int_equal(set->further_hits, 0); /* without such a factor */
        add_falling_light(set, 0, 4, dark ? 0.125f : 0.75f);
        set->max_depth = 1 + 4 + HITS;
        test_must(retex_set_find_further(set, &err), &err);
        assert_int_equal(set->further_hits, HITS);
        for (int c = 0; c < 3; c++)
            assert_float_equal(set->further_ratio[c], RATIO[c], 5e-4); /* light is a half */
        set->max_depth = 4;
        test_must(retex_set_find_further(set, &err), &err);
        assert_int_equal(set->further_hits, 0); /* no path is that long */
        retex_set_close(&set);
    }
}

static void wrong_numbers_are_refused(void **state)
{
    (void)state;
    RetexSet *set = further_set();
    RetexError err = {0};
    RetexSetInfo info = retex_set_info(set);
    info.further_hits = RETEX_FURTHER_HITS_MAX + 1;
    assert_int_equal(retex_set_describe(set, &info, &err), RETEX_EINVAL);
    info.further_hits = -1;
    assert_int_equal(retex_set_describe(set, &info, &err), RETEX_EINVAL);
    for (int k = 0; k < 3; k++) {
        info = retex_set_info(set);
        info.further_ratio[k] = k == 0 ? -0.5f : k == 1 ? NAN : 2.5f;
        assert_int_equal(retex_set_describe(set, &info, &err), RETEX_EINVAL);
    }
    assert_int_equal(set->further_hits, HITS);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(further_hits_are_a_series),
        cmocka_unit_test(originals_change_nothing),
        cmocka_unit_test(a_further_factor_is_no_hit),
        cmocka_unit_test(files_keep_it),
        cmocka_unit_test(streams_keep_it),
        cmocka_unit_test(wrong_numbers_are_refused),
        cmocka_unit_test(the_ratio_is_that_of_light_that_falls),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
