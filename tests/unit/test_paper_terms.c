/* The parts and terms of layout paper, compared with the supplement's formulas (4.2 and 4.3), hit by hit. The hits of
 * the path differ in both parts of the light, in every channel and in position. Names, values and factors are
 * compared. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdio.h>
#include <string.h>
#include "film/paper/paper.h"
#include "film/paper/terms.h"
#include "lib_film.h"

static const Rgb LIGHT = {4, 2, 3};

/* Hit j, from 1: what it does, where it is. All are powers of two, so that halves hold the products. */
static Split split_of(int j)
{
    static const Split splits[] = {{{0.5f, 0.25f, 1}, {0.25f, 1, 0.125f}},
                                   {{1, 0.5f, 0.125f}, {0.5f, 0.25f, 1}},
                                   {{0.25f, 1, 0.5f}, {1, 0.125f, 0.25f}}};

    return splits[j - 1];
}

static double u_of(int j)
{
    return 0.125 + 0.25 * (j - 1);
}

static void begin(Fixture *f, int ntargets)
{
    begin_film(f, ntargets, 1, 6, 1, 1);
    f->params.layout = &paper_layout;
    create_film(f);
}

/* One path that hits a target for each letter of targets, first the one nearest to the camera. */
static void one_path(Fixture *f, const char *targets)
{
    begin_path(f);
    for (int j = 1; targets[j - 1]; j++)
        split_hit(f, targets[j - 1] - 'a', u_of(j), 0.5, rgb_grey(0.5f), 1, split_of(j));
    connect_light(f, LIGHT);
    end_path(f);
    finish_film(f);
}

/* "did": d of hit 1, i of hit 2, d of hit 3, times the light. */
static Rgb product(const char *parts)
{
    Rgb value = LIGHT;

    for (int j = 1; parts[j - 1]; j++)
        value = rgb_mul(value, parts[j - 1] == 'd' ? split_of(j).d : split_of(j).i);
    return value;
}

static const RetexTerm *term_of(const Fixture *f, const char *name)
{
    const int number = retex_set_find_part(f->set, name);

    for (int k = 0; k < f->set->nterms; k++)
        if (f->set->terms[k].radiance == number)
            return &f->set->terms[k];
    fail_msg("there is no term %s", name);
    return NULL;
}

/* The part has that product, and its term multiplies the textures at the hits that are d, and no others. */
static void expect_term(const Fixture *f, const char *name, RetexRole role, const char *parts)
{
    const Rgb value = product(parts);
    const RetexTerm *term = term_of(f, name);
    char hits[8] = "", want[8] = "";

    expect_rgb(part(f, name), value.r, value.g, value.b, 0);
    assert_int_equal(term->role, role);
    for (int k = 0; k < term->nfactors; k++) {
        const RetexFootprint *at = &f->set->footprints[test_factor_number(term->factors[k])];
        const double u = f->set->parts[at->uv].image.pixels[0];
        int j = 1;
        while (j < 4 && fabs(u_of(j) - u) > 1e-6)
            j++;
        int place = k; /* in order: how factors are listed says nothing */
        for (; place > 0 && hits[place - 1] > '0' + j; place--)
            hits[place] = hits[place - 1];
        hits[place] = (char)('0' + j);
    }
    for (int j = 1, k = 0; parts[j - 1] && role != RETEX_ROLE_INDEP; j++)
        if (parts[j - 1] == 'd')
            want[k++] = (char)('0' + j);
    if (strcmp(hits, want) != 0)
        fail_msg("%s multiplies the textures at hits %s, should be %s", name, hits, want);
}

/* Light of this pixel is in the parts named, and nowhere else. */
static void expect_no_others(const Fixture *f, const char *const *names)
{
    for (int k = 0; k < f->set->nterms; k++) {
        const RetexPart *p = &f->set->parts[f->set->terms[k].radiance];
        int is_named = 0;
        for (int i = 0; names[i]; i++)
            is_named |= strcmp(names[i], p->name) == 0;
        for (int c = 0; c < 3 && !is_named && f->set->terms[k].role != RETEX_ROLE_PICTURE; c++)
            if (p->image.pixels[c] != 0)
                fail_msg("%s has light", p->name);
    }
}

static void one_hit_has_two_parts(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 1);
    one_path(&f, "a");
    expect_term(&f, "dep_1", RETEX_ROLE_DEP, "d");
    expect_term(&f, "indep_1", RETEX_ROLE_INDEP, "i");
    expect_no_others(&f, (const char *const[]){"dep_1", "indep_1", NULL});
    end_film(&f);
}

/* A pixel's footprint of a hit is the mean and the standard deviation of the places of its paths. */
static void footprints_are_means_and_deviations(void **state)
{
    (void)state;
    static const double u[] = {0.125, 0.375, 0.875, 0.25, 0.75}, v[] = {0.5, 0.25, 0.625, 0.75, 0.125};
    enum { COUNT = sizeof u / sizeof *u };
    double mean[2] = {0, 0}, square[2] = {0, 0};
    Fixture f;
    begin_film(&f, 1, COUNT, 6, 1, 1);
    f.params.layout = &paper_layout;
    create_film(&f);
    for (int k = 0; k < COUNT; k++) {
        begin_path(&f);
        split_hit(&f, 0, u[k], v[k], rgb_grey(0.5f), 1, split_of(1));
        connect_light(&f, LIGHT);
        end_path(&f);
        mean[0] += u[k] / COUNT, mean[1] += v[k] / COUNT;
        square[0] += u[k] * u[k] / COUNT, square[1] += v[k] * v[k] / COUNT;
    }
    finish_film(&f);
    for (int a = 0; a < 2; a++) {
        assert_float_equal(part(&f, "uv_Floor_1")[a], mean[a], 1e-5);
        assert_float_equal(part(&f, "spread_Floor_1")[a], sqrt(square[a] - mean[a] * mean[a]), 2e-4);
    }
    end_film(&f);
}

/* The last hit that is kept apart of a single target also stands for all further hits: its term has one more factor, of
 * its place. Where hits are not kept apart, or there are other targets, none has. */
static void the_last_hit_stands_for_further_ones(void **state)
{
    (void)state;
    for (int ntargets = 1; ntargets <= 2; ntargets++)
        for (int orders = 1; orders <= 3; orders++) {
            Fixture f;
            begin_film(&f, ntargets, 1, orders, 1, 1);
            f.params.layout = &paper_layout;
            create_film(&f);
            one_path(&f, "aaa" + 3 - orders);
            int further = 0;
            for (int k = 0; k < f.set->nterms; k++) {
                const RetexTerm *term = &f.set->terms[k];
                const int count = term->nfactors;
                for (int i = 0; i < count; i++)
                    further += term->factors[i].quantity == RETEX_QUANTITY_FURTHER;
                if (count && term->factors[count - 1].quantity == RETEX_QUANTITY_FURTHER)
                    assert_int_equal(test_factor_number(term->factors[count - 1]), orders - 1);
            }
            assert_int_equal(further, ntargets == 1 && orders > 1);
            end_film(&f);
        }
}

static void two_hits_have_the_supplements_cross_terms(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 1);
    one_path(&f, "aa");
    expect_term(&f, "dep_2", RETEX_ROLE_DEP, "dd");
    expect_term(&f, "indep_2", RETEX_ROLE_INDEP, "ii");
    expect_term(&f, "cross2_1", RETEX_ROLE_CROSS2, "di");
    expect_term(&f, "cross2_2", RETEX_ROLE_CROSS2, "id");
    expect_no_others(&f, (const char *const[]){"dep_2", "indep_2", "cross2_1", "cross2_2", NULL});
    end_film(&f);
}

static void three_hits_have_them_in_the_supplements_order(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 1);
    one_path(&f, "aaa");
    expect_term(&f, "dep_3", RETEX_ROLE_DEP, "ddd");
    expect_term(&f, "indep_3", RETEX_ROLE_INDEP, "iii");
    expect_term(&f, "cross3_1", RETEX_ROLE_CROSS3, "ddi");
    expect_term(&f, "cross3_2", RETEX_ROLE_CROSS3, "did");
    expect_term(&f, "cross3_3", RETEX_ROLE_CROSS3, "dii");
    expect_term(&f, "cross3_4", RETEX_ROLE_CROSS3, "idd");
    expect_term(&f, "cross3_5", RETEX_ROLE_CROSS3, "idi");
    expect_term(&f, "cross3_6", RETEX_ROLE_CROSS3, "iid");
    expect_no_others(&f, (const char *const[]){"dep_3", "indep_3", "cross3_1", "cross3_2", "cross3_3", "cross3_4",
                                               "cross3_5", "cross3_6", NULL});
    end_film(&f);
}

/* Letters say the target, digits which of its hits: the hits of each count on their own. */
static void two_targets_are_named_by_their_hits(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 2);
    one_path(&f, "aba");
    expect_term(&f, "dep_a2b1", RETEX_ROLE_DEP, "ddd");
    expect_term(&f, "indep_3", RETEX_ROLE_INDEP, "iii");
    expect_term(&f, "cross3_a1b1", RETEX_ROLE_CROSS3, "ddi");
    expect_term(&f, "cross3_a12", RETEX_ROLE_CROSS3, "did");
    expect_term(&f, "cross3_a1", RETEX_ROLE_CROSS3, "dii");
    expect_term(&f, "cross3_a2b1", RETEX_ROLE_CROSS3, "idd");
    expect_term(&f, "cross3_b1", RETEX_ROLE_CROSS3, "idi");
    expect_term(&f, "cross3_a2", RETEX_ROLE_CROSS3, "iid");
    end_film(&f);
}

/* A term is of the target of its first factor. */
static void terms_are_of_their_first_target(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 2);
    one_path(&f, "aba");
    for (int k = 0; k < f.set->nterms; k++) {
        const RetexTerm *term = &f.set->terms[k];
        if (term->role != RETEX_ROLE_CORRECTION)
            assert_int_equal(term->target, term->nfactors ? f.set->footprints[term->factors[0].index].target : -1);
    }
    end_film(&f);
}

/* The term of a random subset of the hits of a random path. */
static TermKey random_key(unsigned *seed, int ntargets, int orders)
{
    int indices[RETEX_MAX_TARGETS] = {0}, nhits = 0;
    const int most = 1 + (int)(test_random(seed) * 7);
    HitMask hits = 0;
    for (int tries = 0; tries < most; tries++) {
        const int target = (int)(test_random(seed) * ntargets);
        if (indices[target] == orders)
            continue;
        if (test_random(seed) < 0.6)
            hits |= hit_bit(target, indices[target]);
        indices[target]++, nhits++;
    }
    return term_key(nhits, hits, 0);
}

/* Images of terms that another render left in a band store become the same terms again, whatever paths made them. */
static void terms_are_found_again_by_the_names_of_their_images(void **state)
{
    (void)state;
    static const int orders[] = {6, 3};
    unsigned seed = 1;
    for (int k = 0; k < 2 * (RETEX_MAX_TARGETS - 1); k++) {
        const int ntargets = 2 + k / 2;
        RetexError err = {0};
        RetexBandStore *store = NULL;
        Bands *bands = NULL;
        TermTable made = {0}, again = {0};
        TermCache cache = {{0}, {0}};
        const char *name;
        test_must(retex_band_store_create(&store, 1, 1, 0, NULL, &err), &err);
        test_must(bands_create(&bands, 1, 1, store, 0, &err), &err);
        test_must(terms_create(&made, bands, ntargets, orders[k % 2], &err), &err);
        for (int i = 0; i < 2000 && made.count < 900; i++)
            assert_true(terms_find(&made, &cache, random_key(&seed, ntargets, orders[k % 2])) >= 0);
        assert_true(made.count > 30);
        test_must(terms_create(&again, bands, ntargets, orders[k % 2], &err), &err);
        for (int i = 1; (name = retex_band_store_image_name(store, i)); i++)
            test_must(terms_resume(&again, name, &err), &err);
        assert_int_equal(again.count, made.count);
        assert_memory_equal(again.keys, made.keys, (size_t)made.count * sizeof *made.keys);
        terms_close(&again);
        terms_close(&made);
        bands_close(&bands);
    }
}

/* All hits but the first weigh as their targets are bright. */
static void terms_weigh_as_targets_are_bright(void **state)
{
    (void)state;
    static const float brightness[] = {0.5f, 0.75f, 1};
    const struct {
        int role;
        HitMask hits;
        int first;
        double weight;
    } cases[] = {{RETEX_ROLE_DEP, hit_bit(0, 0), 0, 1},
                 {RETEX_ROLE_DEP, hit_bit(1, 0) | hit_bit(1, 1) | hit_bit(1, 2), 1, 0.5625},
                 {RETEX_ROLE_DEP, hit_bit(0, 0) | hit_bit(1, 0), 0, 0.75},
                 {RETEX_ROLE_DEP, hit_bit(0, 0) | hit_bit(0, 1) | hit_bit(2, 0), 0, 0.5},
                 {RETEX_ROLE_CROSS3, hit_bit(1, 1) | hit_bit(2, 0), 1, 1},
                 {RETEX_ROLE_CROSS2, hit_bit(2, 1), 2, 1},
                 {RETEX_ROLE_INDEP, 3, -1, 1}};
    RetexError err = {0};
    Bands *bands = NULL;
    TermTable table = {0};
    TermCache cache = {{0}, {0}};
    test_must(bands_create(&bands, 1, 1, NULL, 1, &err), &err);
    test_must(terms_create(&table, bands, 3, 3, &err), &err);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const int term = terms_find(&table, &cache, (TermKey)cases[k].role << 56 | cases[k].hits);
        assert_int_equal(terms_first_target(&table, term), cases[k].first);
        assert_float_equal(terms_weight(&table, term, brightness), cases[k].weight, 1e-12);
    }
    terms_close(&table);
    bands_close(&bands);
}

/* Names of other images, and of terms that this render cannot have. */
static void no_terms_have_other_names(void **state)
{
    (void)state;
    static const char *const names[] = {"beauty",     "depth",     "dep_",       "dep_a",    "dep_a4",
                                        "dep_c1",     "dep_b1a1",  "dep_a0",     "dep_a1x",  "dep_1",
                                        "indep_",     "indep_2x",  "indep_1001", "cross2_3", "cross3_a21",
                                        "cross2_a1b", "cross4_a1", "uv_dep_a1",  "full_0",   ""};
    RetexError err = {0};
    Bands *bands = NULL;
    TermTable table = {0};
    test_must(bands_create(&bands, 1, 1, NULL, 1, &err), &err);
    test_must(terms_create(&table, bands, 2, 3, &err), &err);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        test_must(terms_resume(&table, names[k], &err), &err);
        if (table.count != 1)
            fail_msg("%s is a term", names[k]);
    }
    terms_close(&table);
    bands_close(&bands);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(one_hit_has_two_parts),
                                       cmocka_unit_test(footprints_are_means_and_deviations),
                                       cmocka_unit_test(the_last_hit_stands_for_further_ones),
                                       cmocka_unit_test(two_hits_have_the_supplements_cross_terms),
                                       cmocka_unit_test(three_hits_have_them_in_the_supplements_order),
                                       cmocka_unit_test(two_targets_are_named_by_their_hits),
                                       cmocka_unit_test(terms_are_of_their_first_target),
                                       cmocka_unit_test(terms_are_found_again_by_the_names_of_their_images),
                                       cmocka_unit_test(no_terms_have_other_names),
                                       cmocka_unit_test(terms_weigh_as_targets_are_bright)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
