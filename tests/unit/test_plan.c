/* Which coefficients clusters keep: all combinations of few hits, mixtures for more, and the limits between them. */
#include "lib_test.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>
#include "film/footprints/plan.h"

static int hits_of(const PlanCoefficient *c)
{
    int sum = c->mixed;
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        sum += c->powers[t];
    return sum;
}

static void one_target_has_all_powers(void **state)
{
    (void)state;
    for (int orders = 1; orders <= RETEX_MAX_ORDERS; orders++) {
        Plan plan;
        plan_make(&plan, 1, orders, RETEX_MAX_HITS);
        assert_int_equal(plan.count, orders);
        for (int k = 0; k < orders; k++) {
            assert_int_equal(plan.coefficients[k].powers[0], k);
            assert_int_equal(plan.coefficients[k].mixed, 0);
            assert_int_equal(plan.coefficients[k].next[0], k + 1 < orders ? k + 1 : -1);
        }
    }
}

/* However hits follow one another, each step counts one more, until no coefficient has so many. */
static void steps_count_hits(void **state)
{
    (void)state;
    uint32_t seed = 5;
    for (int round = 0; round < 2000; round++) {
        int ntargets = 2 + (int)(test_random(&seed) * (RETEX_MAX_TARGETS - 1)), at = 0;
        int factors = 2 + (int)(test_random(&seed) * (RETEX_MAX_HITS - 1));
        unsigned char met[RETEX_MAX_TARGETS] = {0};
        Plan plan;
        plan_make(&plan, ntargets, RETEX_MAX_ORDERS, factors);
        assert_in_range(plan.count, 1, PLAN_COEFFICIENTS_MAX);
        for (int hits = 1; hits < factors; hits++) {
            int t = (int)(test_random(&seed) * ntargets);
            met[t]++;
            at = plan.coefficients[at].next[t];
            assert_in_range(at, 1, plan.count - 1);
            assert_int_equal(hits_of(&plan.coefficients[at]), hits);
            if (!plan.coefficients[at].mixed)
                assert_memory_equal(plan.coefficients[at].powers, met, sizeof met);
        }
        for (int t = 0; t < ntargets; t++)
            assert_int_equal(plan.coefficients[at].next[t], -1);
    }
}

/* What a mixture stands for was too much to keep in combinations, never less than they are. */
static void few_hits_are_combined(void **state)
{
    (void)state;
    static const int combinations[RETEX_MAX_TARGETS + 1] = {0, 6, 15, 10, 15, 6, 7, 8, 9};
    for (int ntargets = 2; ntargets <= RETEX_MAX_TARGETS; ntargets++) {
        Plan plan;
        int combined = 0, most_combined = 0, least_mixed = 99;
        plan_make(&plan, ntargets, RETEX_MAX_ORDERS, RETEX_MAX_HITS);
        for (int k = 0; k < plan.count; k++) {
            const PlanCoefficient *c = &plan.coefficients[k];
            if (c->mixed && c->mixed < least_mixed)
                least_mixed = c->mixed;
            combined += !c->mixed;
            if (!c->mixed && hits_of(c) > most_combined)
                most_combined = hits_of(c);
            for (int j = 0; j < k; j++)
                assert_true(memcmp(c->powers, plan.coefficients[j].powers, sizeof c->powers) != 0 ||
                            c->mixed != plan.coefficients[j].mixed);
        }
        assert_int_equal(combined, combinations[ntargets]);
        assert_int_equal(least_mixed, most_combined + 1);
    }
}

/* Each further hit weighs as its target is bright, one of whatever target as the brightest. */
static void coefficients_weigh_as_targets_are_bright(void **state)
{
    (void)state;
    static const float brightness[RETEX_MAX_TARGETS] = {0.5f, 0.9f, 1, 0.75f, 0.6f, 0.5f, 0.8f, 0.95f};
    for (int ntargets = 1; ntargets <= RETEX_MAX_TARGETS; ntargets++) {
        Plan plan;
        plan_make(&plan, ntargets, RETEX_MAX_ORDERS, RETEX_MAX_HITS);
        plan_weigh(&plan, ntargets, brightness);
        assert_true(plan.coefficients[0].weight == 1);
        for (int k = 0; k < plan.count; k++)
            for (int t = 0; t < ntargets; t++) {
                const PlanCoefficient *c = &plan.coefficients[k];
                const int next = c->next[t];
                const float most = ntargets == 1 ? 0.5f : ntargets == 2 ? 0.9f : 1;
                if (next < 0)
                    continue;
                if (!plan.coefficients[next].mixed)
                    assert_float_equal(plan.coefficients[next].weight, c->weight * (double)brightness[t], 1e-9);
                else if (c->mixed)
                    assert_float_equal(plan.coefficients[next].weight, c->weight * (double)most, 1e-9);
                else
                    assert_float_equal(plan.coefficients[next].weight, pow((double)most, hits_of(c) + 1), 1e-9);
            }
    }
}

/* Shorter and shorter plans: each keeps less than the one before, all combinations of the fewest further hits last, and
 * a hit beyond leads nowhere. */
static void plans_are_shortened(void **state)
{
    (void)state;
    for (int ntargets = 1; ntargets <= RETEX_MAX_TARGETS; ntargets++)
        for (int together = 1; together <= 2; together++) {
            Plan plan, least;
            int steps = 0, most = 0;
            plan_make(&plan, ntargets, RETEX_MAX_ORDERS, RETEX_MAX_HITS);
            for (int before = plan.count; plan_shorten(&plan, ntargets, together); before = plan.count, steps++)
                assert_true(plan.count < before);
            least = plan;
            assert_false(plan_shorten(&plan, ntargets, together));
            assert_memory_equal(&plan, &least, sizeof plan);
            for (int k = 0; k < plan.count; k++) {
                most = hits_of(&plan.coefficients[k]) > most ? hits_of(&plan.coefficients[k]) : most;
                for (int t = 0; t < ntargets; t++) {
                    const int next = plan.coefficients[k].next[t];
                    assert_true(next < plan.count);
                    assert_true(next < 0 || hits_of(&plan.coefficients[next]) == hits_of(&plan.coefficients[k]) + 1);
                    assert_int_equal(next < 0, hits_of(&plan.coefficients[k]) == plan.most);
                }
            }
            assert_int_equal(most, plan.most);
            assert_true(steps >= 3);
            assert_true(ntargets != 2 || together != 1 || steps == 12);
            const int kept = ntargets > 4 ? 1 : together; /* they have no other combinations to begin with */
            assert_int_equal(most, ntargets == 1 ? together : kept + 1);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(one_target_has_all_powers), cmocka_unit_test(steps_count_hits),
                                       cmocka_unit_test(few_hits_are_combined),
                                       cmocka_unit_test(coefficients_weigh_as_targets_are_bright),
                                       cmocka_unit_test(plans_are_shortened)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
