/* Which coefficients clusters keep: limits, steps from hit to hit, and what a survey asks for. */
#include "lib_test.h"

#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "film/expansion.h"
#include "film/plan.h"

static PlanLimits limits_of(int ntargets, int orders, int coefficients)
{
    return (PlanLimits){orders, expansion_most_hits(ntargets), coefficients};
}

static int sum_of(const unsigned char powers[RETEX_MAX_TARGETS])
{
    int sum = 0;
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        sum += powers[t];
    return sum;
}

static int find(const Plan *plan, int first, const unsigned char powers[RETEX_MAX_TARGETS])
{
    for (int k = 0; k < plan->count[first]; k++)
        if (!memcmp(plan->powers[first][k], powers, RETEX_MAX_TARGETS))
            return k;
    return -1;
}

static void one_target_keeps_all_powers(void **state)
{
    (void)state;
    for (int orders = 1; orders <= RETEX_MAX_ORDERS; orders++) {
        PlanLimits limits = limits_of(1, orders, 1000);
        PlanSurvey survey = {0};
        Plan plan;
        plan_survey_total(&survey, 1);
        plan_make(&plan, 1, &limits, orders % 2 ? &survey : NULL); /* it is not looked at */
        assert_int_equal(plan.ntargets, 1);
        assert_int_equal(plan.count[0], orders);
        assert_int_equal(plan_least(1, orders), orders);
        for (int k = 0; k < orders; k++) {
            assert_int_equal(plan.powers[0][k][0], k);
            assert_int_equal(sum_of(plan.powers[0][k]), k);
            assert_int_equal(plan.next[0][k][0], k + 1 < orders ? k + 1 : -1);
            for (int t = 1; t < RETEX_MAX_TARGETS; t++)
                assert_int_equal(plan.next[0][k][t], -1);
        }
    }
}

/* Every coefficient differs from the others, keeps the limits, and is reached from the first hit by hit, in whatever
 * order the hits come. */
static void expect_sound(const Plan *plan, int ntargets, const PlanLimits *limits)
{
    int most = limits->coefficients < PLAN_COEFFICIENTS_MAX ? limits->coefficients : PLAN_COEFFICIENTS_MAX;
    for (int first = 0; first < ntargets; first++) {
        assert_in_range(plan->count[first], 1, most);
        assert_int_equal(sum_of(plan->powers[first][0]), 0);
        for (int k = 0; k < plan->count[first]; k++) {
            const unsigned char *powers = plan->powers[first][k];
            assert_int_equal(find(plan, first, powers), k);
            assert_true(1 + sum_of(powers) <= limits->factors);
            for (int t = 0; t < RETEX_MAX_TARGETS; t++) {
                unsigned char one[RETEX_MAX_TARGETS];
                assert_true(powers[t] + (t == first) <= limits->orders);
                assert_true(t < ntargets || (powers[t] == 0 && plan->next[first][k][t] == -1));
                memcpy(one, powers, sizeof one);
                one[t]++;
                assert_int_equal(plan->next[first][k][t], t < ntargets ? find(plan, first, one) : -1);
                if (!powers[t])
                    continue;
                one[t] = (unsigned char)(powers[t] - 1);
                int before = find(plan, first, one);
                assert_true(before >= 0);
                assert_int_equal(plan->next[first][before][t], k);
            }
        }
    }
}

/* Light of every combination there can be, from bright to dim or the other way round. */
static void survey_everything(PlanSurvey *survey, int ntargets, uint32_t seed)
{
    memset(survey, 0, sizeof *survey);
    for (int i = 0; i < 800; i++) {
        unsigned char powers[RETEX_MAX_TARGETS] = {0};
        int first = (int)(test_random(&seed) * ntargets), later = (int)(test_random(&seed) * RETEX_MAX_FACTORS);
        for (int k = 0; k < later; k++) {
            int t = (int)(test_random(&seed) * ntargets);
            if (powers[t] < 7)
                powers[t]++;
        }
        float light = (float)(1e-3 + test_random(&seed));
        plan_survey_total(survey, light);
        plan_survey_add(survey, plan_key(first, powers), light);
    }
}

static void limits_hold(void **state)
{
    (void)state;
    static PlanSurvey survey;
    static const int room[] = {1, 2, 5, 17, 32, 1000};
    Plan plan;
    for (int targets = 1; targets <= RETEX_MAX_TARGETS; targets++)
        for (int orders = 1; orders <= RETEX_MAX_ORDERS; orders++)
            for (size_t r = 0; r < sizeof room / sizeof room[0]; r++) {
                PlanLimits limits = limits_of(targets, orders, room[r]);
                survey_everything(&survey, targets, (uint32_t)(targets * 100 + orders * 10) + (uint32_t)r);
                plan_make(&plan, targets, &limits, &survey);
                expect_sound(&plan, targets, &limits);
                limits.factors = targets == 1 ? 6 : 5;
                plan_make(&plan, targets, &limits, &survey);
                expect_sound(&plan, targets, &limits);
            }
}

/* Without light in the survey there is still what plan_least says. */
static void some_are_kept_unseen(void **state)
{
    (void)state;
    static const PlanSurvey nothing;
    Plan plan;
    for (int targets = 1; targets <= RETEX_MAX_TARGETS; targets++)
        for (int orders = 1; orders <= RETEX_MAX_ORDERS; orders++) {
            PlanLimits limits = limits_of(targets, orders, 1000);
            plan_make(&plan, targets, &limits, &nothing);
            expect_sound(&plan, targets, &limits);
            for (int first = 0; first < targets; first++)
                assert_int_equal(plan.count[first], plan_least(targets, orders));
        }
    assert_int_equal(plan_least(2, 6), 15);
    assert_int_equal(plan_least(3, 6), 20);
    assert_int_equal(plan_least(4, 6), 15);
    assert_int_equal(plan_least(8, 6), 9);
    assert_int_equal(plan_least(8, 1), 1);
}

static void what_is_bright_is_kept(void **state)
{
    (void)state;
    PlanSurvey survey = {0};
    PlanLimits limits = limits_of(2, 6, 1000);
    Plan plan;
    static const unsigned char bright[RETEX_MAX_TARGETS] = {3, 4}, dim[RETEX_MAX_TARGETS] = {5, 0},
                               many[RETEX_MAX_TARGETS] = {2, 6}, less[RETEX_MAX_TARGETS] = {2, 4};
    plan_survey_total(&survey, 1000);
    plan_survey_add(&survey, plan_key(1, bright), 1);
    plan_survey_add(&survey, plan_key(1, dim), 0.001f); /* a millionth of the light */
    plan_survey_add(&survey, plan_key(1, many), 100);   /* more factors than are kept */
    plan_make(&plan, 2, &limits, &survey);
    expect_sound(&plan, 2, &limits);
    assert_true(find(&plan, 1, bright) >= 0);
    assert_true(find(&plan, 1, less) >= 0);
    assert_int_equal(find(&plan, 0, bright), -1);
    assert_int_equal(find(&plan, 1, dim), -1);
    assert_int_equal(find(&plan, 1, many), -1);
    assert_int_equal(plan.count[0], plan_least(2, 6));
}

/* Where there is no room for all, the brighter ones come first. */
static void the_brighter_ones_come_first(void **state)
{
    (void)state;
    static const unsigned char one[RETEX_MAX_TARGETS] = {5, 0}, other[RETEX_MAX_TARGETS] = {0, 5};
    PlanLimits limits = limits_of(2, 6, 16); /* one more than are always kept */
    for (int k = 0; k < 2; k++) {
        PlanSurvey survey = {0};
        Plan plan;
        plan_survey_total(&survey, 10);
        plan_survey_add(&survey, plan_key(0, one), k ? 1 : 2);
        plan_survey_add(&survey, plan_key(0, other), k ? 2 : 1);
        plan_make(&plan, 2, &limits, &survey);
        expect_sound(&plan, 2, &limits);
        assert_int_equal(plan.count[0], 16);
        assert_true(find(&plan, 0, k ? other : one) >= 0);
        assert_int_equal(find(&plan, 0, k ? one : other), -1);
    }
}

static void keys_hold_all_powers(void **state)
{
    (void)state;
    uint32_t seen[2000], seed = 5;
    unsigned char all[2000][RETEX_MAX_TARGETS + 1];
    for (int i = 0; i < 2000; i++) {
        for (int t = 0; t < RETEX_MAX_TARGETS; t++)
            all[i][t] = (unsigned char)(test_random(&seed) * 8);
        all[i][RETEX_MAX_TARGETS] = (unsigned char)(test_random(&seed) * RETEX_MAX_TARGETS);
        seen[i] = plan_key(all[i][RETEX_MAX_TARGETS], all[i]);
        assert_int_equal(seen[i] >> 24, all[i][RETEX_MAX_TARGETS]);
        for (int t = 0; t < RETEX_MAX_TARGETS; t++)
            assert_int_equal(seen[i] >> (3 * t) & 7, all[i][t]);
        assert_true(seen[i] + 1 != 0);
    }
}

static uint64_t energy_of(const PlanSurvey *survey, uint32_t key)
{
    uint64_t energy = 0;
    int found = 0;
    for (int k = 0; k < PLAN_SURVEY_SLOTS; k++)
        if (survey->keys[k] == key + 1)
            energy += survey->energy[k], found++;
    assert_true(found <= 1);
    return energy;
}

/* What two threads saw adds up to the same whoever comes first, and to what one would have seen. */
static void surveys_add_up_in_any_order(void **state)
{
    (void)state;
    static PlanSurvey a, b, ab, ba, all;
    uint32_t seed = 9;
    memset(&all, 0, sizeof all);
    memset(&a, 0, sizeof a);
    memset(&b, 0, sizeof b);
    for (int i = 0; i < 5000; i++) {
        unsigned char powers[RETEX_MAX_TARGETS] = {0};
        for (int t = 0; t < 4; t++)
            powers[t] = (unsigned char)(test_random(&seed) * 5);
        uint32_t key = plan_key((int)(test_random(&seed) * 4), powers);
        float light = (float)(test_random(&seed) * test_random(&seed));
        PlanSurvey *one = i % 3 ? &a : &b;
        plan_survey_add(one, key, light);
        plan_survey_total(one, 2 * light);
        plan_survey_add(&all, key, light);
        plan_survey_total(&all, 2 * light);
    }
    ab = a, ba = b;
    plan_survey_merge(&ab, &b);
    plan_survey_merge(&ba, &a);
    assert_true(ab.total == ba.total && ab.total == all.total);
    for (int k = 0; k < PLAN_SURVEY_SLOTS; k++)
        for (const PlanSurvey *s = &all; s; s = s == &all ? &ab : s == &ab ? &ba : NULL)
            if (s->keys[k]) {
                uint64_t want = energy_of(&all, s->keys[k] - 1);
                assert_true(energy_of(&ab, s->keys[k] - 1) == want && energy_of(&ba, s->keys[k] - 1) == want);
            }
    PlanLimits limits = limits_of(4, 6, 1000);
    Plan plan, same;
    plan_make(&plan, 4, &limits, &ab);
    plan_make(&same, 4, &limits, &ba);
    assert_memory_equal(plan.count, same.count, sizeof plan.count);
    assert_memory_equal(plan.powers, same.powers, sizeof plan.powers);
    assert_memory_equal(plan.next, same.next, sizeof plan.next);
}

/* Light that is no number, or too much of it, must not spoil the sums. */
static void odd_light_is_survived(void **state)
{
    (void)state;
    PlanSurvey survey = {0};
    const unsigned char none[RETEX_MAX_TARGETS] = {0};
    uint32_t key = plan_key(0, none);
    plan_survey_add(&survey, key, __builtin_nanf(""));
    plan_survey_add(&survey, key, -5);
    plan_survey_add(&survey, key, 0);
    assert_true(energy_of(&survey, key) == 0);
    plan_survey_add(&survey, key, __builtin_inff());
    plan_survey_total(&survey, __builtin_inff());
    assert_true(energy_of(&survey, key) == survey.total && survey.total > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_target_keeps_all_powers),  cmocka_unit_test(limits_hold),
        cmocka_unit_test(some_are_kept_unseen),         cmocka_unit_test(what_is_bright_is_kept),
        cmocka_unit_test(the_brighter_ones_come_first), cmocka_unit_test(keys_hold_all_powers),
        cmocka_unit_test(surveys_add_up_in_any_order),  cmocka_unit_test(odd_light_is_survived),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
