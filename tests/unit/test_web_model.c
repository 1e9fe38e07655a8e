/* The polynomial of a page: with a number in the place of each image and texture, it is that of the compact set. */
#include "lib_test.h"
#include "lib_compact.h"
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "set/parts.h"
#include "set/set.h"
#include "web/model.h"

enum { LAMPS = 3 };

/* The number of a part, of a footprint's texture, of a parameter: from 0.5 to 1.5. */
static double number(int kind, int index)
{
    uint32_t seed = (uint32_t)(1 + 7919 * kind + 104729 * index);
    test_random(&seed);
    return .5 + test_random(&seed);
}

static double of_part(int part)
{
    return number(0, part);
}

static double of_footprint(int footprint)
{
    return number(1, footprint);
}

static double of_parameter(int parameter)
{
    return number(2, parameter);
}

/* ---- the set ---- */

static double of_factor(const RetexSet *set, RetexFactor factor)
{
    double sum = 0;
    switch (factor.kind) {
    case RETEX_FACTOR_FOOTPRINT:
        return of_footprint(factor.index);
    case RETEX_FACTOR_IMAGE:
        return of_part(factor.index);
    case RETEX_FACTOR_PARAMETER:
        return of_parameter(factor.index);
    case RETEX_FACTOR_MIXTURE:
        for (int i = 0; i < set->mixtures[factor.index].nshares; i++) {
            const int weight = set->mixtures[factor.index].shares[i].weight;
            sum += of_part(weight) * of_footprint(set->mixtures[factor.index].shares[i].footprint);
        }
        return sum;
    default:
        fail_msg("a factor of another kind");
        return 0;
    }
}

/* All light (lamp -1), or that of a lamp. */
static double of_set(const RetexSet *set, int lamp)
{
    double sum = 0;
    for (int t = 0; t < set->nterms; t++) {
        const RetexTerm *term = &set->terms[t];
        double product = of_part(term->radiance);
        if (lamp < 0 ? !retex_term_is_light(term)
                     : term->role != RETEX_ROLE_LAMP || retex_set_term_lamp(set, term) != lamp)
            continue;
        for (int k = 0; k < term->nfactors; k++)
            product *= of_factor(set, term->factors[k]);
        sum += product;
    }
    return sum;
}

/* ---- the page ---- */

static double of_mixture(const RetexWebModel *model, int index)
{
    const RetexWebMixture *mixture = &model->mixtures[index];
    double sum = 0;
    for (int i = 0; i < mixture->nclasses; i++) {
        const RetexWebClass *c = &model->classes[mixture->classes[i].index];
        for (int k = 0; k < c->nfootprints; k++) {
            const int weight = c->weights[mixture->classes[i].weighting][k];
            sum += (weight == RETEX_WEB_WEIGHT_NONE  ? 0
                    : weight == RETEX_WEB_WEIGHT_ONE ? 1
                                                     : of_part(weight)) *
                   of_footprint(c->footprints[k]);
        }
    }
    return sum;
}

/* As the header says: light times parameters times mixture times the sum over terms of gain times factors; of a lamp
 * the sum of its terms, times its parameter. */
static double of_model(const RetexWebModel *model, int lamp)
{
    double sum = 0;
    for (int g = 0; g < model->ngroups; g++) {
        const RetexWebGroup *group = &model->groups[g];
        double terms = 0, product = of_part(group->light);
        for (int t = 0; t < model->nterms; t++) {
            const RetexWebTerm *term = &model->terms[t];
            double factor = term->gain >= 0 ? of_part(term->gain) : 1;
            for (int k = 0; k < term->nfactors; k++)
                factor *= of_mixture(model, term->factors[k]);
            terms += term->group == g && term->lamp == lamp ? factor : 0;
        }
        for (int k = 0; k < group->nparameters; k++)
            product *= of_parameter(group->parameters[k]);
        product *= group->mixture >= 0 ? of_mixture(model, group->mixture) : 1;
        sum += product * terms * (lamp >= 0 ? of_parameter(lamp) : 1);
    }
    return sum;
}

static void expect_classes(const RetexWebModel *model, const RetexSet *set)
{
    int count = 0;
    for (int i = 0; i < model->nclasses; i++) {
        const RetexWebClass *c = &model->classes[i];
        count += c->nfootprints;
        assert_in_range(c->nweightings, 0, RETEX_WEB_WEIGHTINGS);
        for (int k = 0; k < c->nfootprints; k++) {
            const RetexFootprint *f = &set->footprints[c->footprints[k]];
            assert_true(f->target == c->target && f->kind == c->kind && f->albedo == c->albedo);
            assert_int_equal(retex_set_footprint_scale(set, c->footprints[k]), c->scale);
            assert_int_equal(retex_footprint_has_axes(set, f), c->has_axes);
        }
        for (int k = 0; k < i; k++) /* one class of each */
            assert_true(c->target != model->classes[k].target || c->kind != model->classes[k].kind ||
                        c->has_axes != model->classes[k].has_axes);
    }
    assert_int_equal(count, set->nfootprints);
}

static void the_polynomial_is_that_of_the_set(void **state)
{
    (void)state;
    static const int scales[][3] = {{4, 4, 4}, {4, 8, 2}, {2, 4, 1}};
    for (int ntargets = 1; ntargets < 3; ntargets++)
        for (int lamps = 0; lamps < 2; lamps++)
            for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
                RetexSet *set = whole_set(ntargets, 2), *compact;
                RetexCompactParams params = RETEX_COMPACT_INIT;
                RetexWebModel model;
                RetexError err = {0};
                if (lamps)
                    test_add_lamp_terms(set, 0, 0);
                params.broad = scales[i][0], params.interreflection = scales[i][1], params.gain = scales[i][2];
                test_must(retex_set_compact(&compact, set, &params, 2, &err), &err);
                test_must(retex_web_model_open(&model, compact, &err), &err);
                expect_classes(&model, compact);
                for (int lamp = -1; lamp < (lamps ? LAMPS : 0); lamp++) {
                    const double is = of_model(&model, lamp), should = of_set(compact, lamp);
                    if (!(should > 0 && fabs(is - should) < 1e-9 * should))
                        fail_msg("lamp %d of %d targets: %.9g, not %.9g", lamp, ntargets, is, should);
                }
                retex_web_model_close(&model);
                retex_set_close(&compact);
                retex_set_close(&set);
            }
}

/* Light that meets no target is a term as well, also where there is no other. */
static void light_without_hits_is_a_group(void **state)
{
    (void)state;
    RetexSet *set;
    RetexWebModel model;
    RetexTerm term = {.role = RETEX_ROLE_INDEP, .target = -1};
    RetexError err = {0};
    test_must(retex_set_create(&set, 8, 6, &err), &err);
    test_must(retex_set_add_part(set, "light", "RGB", RETEX_HALF, 0, 0, &term.radiance, &err), &err);
    test_must(retex_set_add_term(set, &term, NULL, &err), &err);
    test_must(retex_web_model_open(&model, set, &err), &err);
    assert_int_equal(model.nclasses, 0);
    assert_int_equal(model.nterms, 1);
    assert_int_equal(model.ngroups, 1);
    assert_true(model.groups[0].light == term.radiance && model.groups[0].mixture < 0 && model.terms[0].gain < 0);
    retex_web_model_close(&model);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_polynomial_is_that_of_the_set),
                                       cmocka_unit_test(light_without_hits_is_a_group)};
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
