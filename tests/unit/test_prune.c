/* Parts that are 0 in all pixels are removed from a set, and the other parts keep their order. */
#include "lib_test.h"
#include <cmocka.h>

#include <stdio.h>
#include <string.h>

#include "set/signals.h"

/* A target with two sharp clusters, one broad one and two later footprints, as layout footprints describes it before
 * anything is known of its pixels; light of sharp ones that goes on, and noise. */
typedef struct Fixture {
    RetexSet *set;
    char empty[64];
} Fixture;

static int add_part(Fixture *f, const char *name, const char *letters)
{
    RetexError err;
    int part;
    test_must(retex_set_add_part(f->set, name, letters, RETEX_HALF, 0, 0, &part, &err), &err);
    return part;
}

static void add_footprint(Fixture *f, const char *name, RetexFootprintKind kind, int hit, RetexMixture *mixture)
{
    RetexFootprint footprint = {.hit = hit, .kind = kind};
    RetexError err;
    char part[32];
    int index;
    snprintf(part, sizeof part, "uv_%s", name);
    footprint.uv = add_part(f, part, "RGA");
    snprintf(part, sizeof part, "spread_%s", name);
    footprint.spread = add_part(f, part, "RGB");
    snprintf(part, sizeof part, "albedo_%s", name);
    footprint.albedo = add_part(f, part, "RGB");
    test_must(retex_set_add_footprint(f->set, &footprint, &index, &err), &err);
    if (kind != RETEX_FOOTPRINT_INTERREFLECTION) {
        snprintf(part, sizeof part, "dep_%s", name);
        const RetexTerm term = test_term(f->set, add_part(f, part, "RGB"), 1, &index);
        test_must(retex_set_add_term(f->set, &term, NULL, &err), &err);
    }
    snprintf(part, sizeof part, "share_%s", name);
    mixture->shares[mixture->nshares++] = (struct RetexShare){index, add_part(f, part, "R")};
}

static void begin(Fixture *f)
{
    RetexMixture sharp = {0}, broad = {0}, later = {0};
    RetexError err;
    *f = (Fixture){.set = NULL};
    test_must(retex_set_create(&f->set, 2, 1, &err), &err);
    add_part(f, "beauty", "RGB");
    f->set->ntargets = 1;
    strcpy(f->set->targets[0].name, "T");
    RetexTerm term = test_term(f->set, add_part(f, "indep", "RGB"), 0, NULL);
    test_must(retex_set_add_term(f->set, &term, NULL, &err), &err);
    add_footprint(f, "sharp1", RETEX_FOOTPRINT_SHARP, 1, &sharp);
    add_footprint(f, "sharp2", RETEX_FOOTPRINT_SHARP, 2, &sharp);
    test_must(retex_set_add_mixture(f->set, &sharp, NULL, &err), &err);
    add_footprint(f, "broad1", RETEX_FOOTPRINT_BROAD, 3, &broad);
    test_must(retex_set_add_mixture(f->set, &broad, NULL, &err), &err);
    add_footprint(f, "interreflection1", RETEX_FOOTPRINT_INTERREFLECTION, 4, &later);
    add_footprint(f, "interreflection2", RETEX_FOOTPRINT_INTERREFLECTION, 5, &later);
    test_must(retex_set_add_mixture(f->set, &later, NULL, &err), &err);
    const int numbers[] = {MIXTURE(0), MIXTURE(2), MIXTURE(2)};
    term = test_term(f->set, add_part(f, "dep_sharp_a2", "RGB"), 3, numbers);
    test_must(retex_set_add_term(f->set, &term, NULL, &err), &err);
    add_part(f, "noise_indep", "RGB");
    add_part(f, "noise_T_sharp", "RGB");
    add_part(f, "noise_T_broad", "RGB");
    add_part(f, "depth", "R");
}

static void make_empty(Fixture *f, const char *name)
{
    const int part = retex_set_find_part(f->set, name);
    assert_true(part > 0);
    f->empty[part] = 1;
}

static int has(const Fixture *f, const char *name)
{
    return retex_set_find_part(f->set, name) >= 0;
}

/* Every reference is to the part of the name that it should have. */
static void expect_names(const Fixture *f)
{
    static const char *const names[] = {"", "sharp1", "sharp2", "broad1", "interreflection1", "interreflection2"};
    for (int i = 0; i < f->set->nfootprints; i++) {
        const RetexFootprint *footprint = &f->set->footprints[i];
        const char *name = names[footprint->hit];
        assert_string_equal(strchr(f->set->parts[footprint->uv].name, '_') + 1, name);
        assert_string_equal(strchr(f->set->parts[footprint->spread].name, '_') + 1, name);
        assert_string_equal(strchr(f->set->parts[footprint->albedo].name, '_') + 1, name);
    }
    for (int m = 0; m < f->set->nmixtures; m++)
        for (int k = 0; k < f->set->mixtures[m].nshares; k++) {
            const struct RetexShare *share = &f->set->mixtures[m].shares[k];
            assert_string_equal(strchr(f->set->parts[share->weight].name, '_') + 1,
                                names[f->set->footprints[share->footprint].hit]);
        }
    for (int t = 1; t < f->set->nterms; t++)
        if (f->set->terms[t].nfactors == 1 && retex_term_hits(&f->set->terms[t]))
            assert_string_equal(strchr(f->set->parts[f->set->terms[t].radiance].name, '_') + 1,
                                names[f->set->footprints[test_factor_number(f->set->terms[t].factors[0])].hit]);
}

static void a_full_set_stays(void **state)
{
    (void)state;
    Fixture f;
    begin(&f);
    const int parts = f.set->nparts;
    retex_set_prune(f.set, f.empty);
    assert_int_equal(f.set->nparts, parts - 1); /* the share of the only broad cluster says nothing */
    assert_false(has(&f, "share_broad1"));
    assert_int_equal(f.set->nfootprints, 5);
    assert_int_equal(f.set->nterms, 5);
    assert_int_equal(f.set->nmixtures, 2);
    expect_names(&f);
    retex_set_close(&f.set);
}

static void footprints_take_along_what_hangs_on_them(void **state)
{
    (void)state;
    Fixture f;
    begin(&f);
    make_empty(&f, "uv_sharp2");
    make_empty(&f, "uv_broad1");
    make_empty(&f, "uv_interreflection1");
    make_empty(&f, "dep_sharp2");
    make_empty(&f, "indep"); /* light without hits stays */
    make_empty(&f, "spread_sharp1");
    retex_set_prune(f.set, f.empty);
    assert_int_equal(f.set->nfootprints, 2);
    assert_int_equal(f.set->nmixtures, 0);
    assert_int_equal(f.set->nterms, 3);
    const RetexTerm *again = &f.set->terms[2];
    assert_int_equal(test_factor_number(again->factors[0]), 0); /* mixtures of one are that one */
    assert_int_equal(test_factor_number(again->factors[1]), 1);
    assert_int_equal(test_factor_number(again->factors[2]), 1);
    assert_string_equal(f.set->parts[again->radiance].name, "dep_sharp_a2");
    assert_true(has(&f, "indep") && has(&f, "spread_sharp1") && has(&f, "depth"));
    assert_true(has(&f, "noise_indep") && has(&f, "noise_T_sharp") && !has(&f, "noise_T_broad"));
    assert_true(!has(&f, "albedo_sharp2") && !has(&f, "share_sharp1") && !has(&f, "share_interreflection1"));
    assert_true(has(&f, "share_interreflection2")); /* it says how much of later light is of no target */
    expect_names(&f);
    retex_set_close(&f.set);
}

static void terms_go_without_light(void **state)
{
    (void)state;
    Fixture f;
    begin(&f);
    make_empty(&f, "dep_sharp1");
    make_empty(&f, "dep_sharp_a2");
    retex_set_prune(f.set, f.empty);
    assert_int_equal(f.set->nfootprints, 5);
    assert_int_equal(f.set->nterms, 3);
    assert_true(!has(&f, "dep_sharp1") && has(&f, "uv_sharp1") && !has(&f, "dep_sharp_a2"));
    expect_names(&f);
    retex_set_close(&f.set);
}

/* A term needs its gain too; radiance that another term uses stays. */
static void terms_go_without_their_gain(void **state)
{
    (void)state;
    for (int empty = 0; empty < 2; empty++) {
        Fixture f;
        RetexError err;
        begin(&f);
        const int light = retex_set_find_part(f.set, "dep_sharp1"), parts = f.set->nparts;
        RetexTerm term = test_term(f.set, light, 1, (int[]){1});
        test_must(retex_term_add_factor(&term, retex_factor(RETEX_FACTOR_IMAGE, add_part(&f, "gain", "R")), &err),
                  &err);
        test_must(retex_set_add_term(f.set, &term, NULL, &err), &err);
        if (empty)
            make_empty(&f, "gain");
        retex_set_prune(f.set, f.empty);
        assert_int_equal(f.set->nterms, empty ? 5 : 6);
        assert_int_equal(has(&f, "gain"), !empty);
        assert_true(has(&f, "dep_sharp1") && f.set->nparts == parts - empty);
        retex_set_close(&f.set);
    }
}

static void a_target_that_no_pixel_has_leaves_nothing(void **state)
{
    (void)state;
    static const char *const gone[] = {"uv_sharp1", "uv_sharp2", "uv_broad1", "uv_interreflection1",
                                       "uv_interreflection2"};
    Fixture f;
    begin(&f);
    for (int k = 0; k < 5; k++)
        make_empty(&f, gone[k]);
    retex_set_prune(f.set, f.empty);
    assert_int_equal(f.set->nfootprints + f.set->nmixtures, 0);
    assert_int_equal(f.set->nterms, 1);
    assert_int_equal(f.set->nparts, 4); /* beauty, indep, its noise, depth */
    retex_set_close(&f.set);
}

static void noise_of_the_picture_stays_where_it_has_no_terms(void **state)
{
    (void)state;
    Fixture f = {.set = NULL};
    RetexError err;
    test_must(retex_set_create(&f.set, 2, 1, &err), &err);
    add_part(&f, "beauty", "RGB");
    add_part(&f, "noise_beauty", "RGB");
    add_part(&f, "noise_indep", "RGB"); /* of no term */
    retex_set_prune(f.set, f.empty);
    assert_true(has(&f, "noise_beauty") && !has(&f, "noise_indep"));
    retex_set_close(&f.set);
}

/* Terms of lamps go, with what they alone have: mixture 1 of three, a part of light, its noise. Another parameter of
 * another kind stays, under its new number. */
static void lamps_are_left_out(void **state)
{
    (void)state;
    Fixture f;
    RetexError err;
    RetexParameter lamp = {
        .name = "Sun", .kind = RETEX_PARAMETER_COLOR, .target = -1, .value = {1, 2, 3}, .kept = {1, 2, 3}};
    int sun, correction;
    begin(&f);
    test_must(retex_set_add_parameter(f.set, &lamp, &sun, &err), &err);
    const RetexTerm corrects = {.target = 0, .radiance = f.set->terms[0].radiance};
    test_must(retex_set_add_correction(f.set, &corrects, &correction, &err), &err);
    const int nterms = f.set->nterms, nparts = f.set->nparts;
    RetexTerm term = test_term(f.set, add_part(&f, "lamp_Sun", "RGB"), 1, (int[]){MIXTURE(1)});
    term.role = RETEX_ROLE_LAMP;
    test_must(retex_term_add_factor(&term, retex_factor(RETEX_FACTOR_PARAMETER, sun), &err), &err);
    test_must(retex_set_add_term(f.set, &term, NULL, &err), &err);
    char noise[RETEX_NAME_MAX];
    retex_signal_noise_name(f.set, &f.set->terms[f.set->nterms - 1], noise);
    add_part(&f, noise, "RGB");

    f.set->parameters[sun].value[1] = 0; /* off in the picture */
    assert_int_equal(retex_set_drop_lamps(f.set, &err), RETEX_EINVAL);
    f.set->parameters[sun].value[1] = 2;
    test_must(retex_set_drop_lamps(f.set, &err), &err);
    assert_int_equal(f.set->nterms, nterms);
    assert_true(!has(&f, "lamp_Sun") && !has(&f, noise) && has(&f, "noise_indep") && has(&f, "noise_T_broad"));
    assert_int_equal(f.set->nparts, nparts - 1);
    assert_false(has(&f, "share_broad1")); /* of mixture 1 */
    assert_int_equal(f.set->nmixtures, 2);
    assert_int_equal(f.set->nparameters, 1);
    assert_int_equal(f.set->parameters[0].kind, RETEX_PARAMETER_CORRECTION);
    assert_int_equal(f.set->terms[correction].factors[0].index, 0);
    const int again = correction - 1;
    assert_string_equal(f.set->parts[f.set->terms[again].radiance].name, "dep_sharp_a2");
    for (int k = 0; k < 3; k++)
        assert_int_equal(test_factor_number(f.set->terms[again].factors[k]), MIXTURE(k > 0));
    expect_names(&f);
    test_must(retex_set_drop_lamps(f.set, &err), &err); /* there are none */
    assert_int_equal(f.set->nterms, nterms);
    retex_set_close(&f.set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_full_set_stays),
        cmocka_unit_test(footprints_take_along_what_hangs_on_them),
        cmocka_unit_test(terms_go_without_light),
        cmocka_unit_test(terms_go_without_their_gain),
        cmocka_unit_test(a_target_that_no_pixel_has_leaves_nothing),
        cmocka_unit_test(noise_of_the_picture_stays_where_it_has_no_terms),
        cmocka_unit_test(lamps_are_left_out),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
