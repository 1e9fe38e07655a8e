/* The polynomial of a path, compared with the product that it expands, and the terms of its monomials. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include "film/paper/expansion.h"
#include "film/paper/terms.h"

static float at_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) / (float)(1 << 24);
}

static void multiplies_out(void **state)
{
    (void)state;
    uint32_t seed = 1;
    for (int round = 0; round < 2000; round++) {
        Expansion e;
        expansion_reset(&e);
        int n = round % (RETEX_MAX_HITS + 1), targets[RETEX_MAX_HITS], index[RETEX_MAX_HITS];
        int seen[RETEX_MAX_TARGETS] = {0};
        double product = 1, a[RETEX_MAX_HITS];
        for (int j = 0; j < n; j++) {
            float d = at_random(&seed), i = at_random(&seed);
            if (at_random(&seed) < 0.4f)
                i = 0; /* diffuse */
            else if (at_random(&seed) < 0.2f)
                d = 0;
            targets[j] = (int)(at_random(&seed) * 3);
            for (int k = 3; k < RETEX_MAX_TARGETS && seen[targets[j]] == RETEX_MAX_ORDERS; k++)
                targets[j] = k;
            if (!target_counts_allow(&e.size, targets[j], RETEX_MAX_ORDERS, RETEX_MAX_HITS)) {
                assert_true(2 * e.size.nmonomials > MONOMIALS_MAX); /* eight with both parts, at least */
                n = j;
                break;
            }
            index[j] = seen[targets[j]]++;
            a[j] = at_random(&seed);
            product *= d * a[j] + i;
            expansion_push(&e, &(TargetVertex){.target = (unsigned char)targets[j]}, splat(d), splat(i));
            assert_int_equal(e.hits[j].index, index[j]);
        }
        double sum = 0;
        for (int k = 0; k < e.size.nmonomials; k++) {
            double term = (double)e.monomials[k].coefficient[1];
            for (int j = 0; j < n; j++)
                if (e.monomials[k].hits >> j & 1)
                    term *= a[j];
            sum += term;
        }
        assert_true(fabs(sum - product) < 1e-5 * (1 + product));
        assert_int_equal(e.size.nhits, n);
    }
}

static HitMask mask(int a, int b, int c)
{
    return (a ? hit_bit(0, a - 1) : 0) | (b ? hit_bit(0, b - 1) : 0) | (c ? hit_bit(1, c - 1) : 0);
}

static void monomials_find_their_terms(void **state)
{
    (void)state;
    assert_int_equal(term_key(0, 0, 0) >> 56, RETEX_ROLE_FULL);
    assert_int_equal(term_key(3, 0, 0) >> 56, RETEX_ROLE_INDEP);
    assert_true(term_key(2, 0, 0) != term_key(3, 0, 0));
    assert_int_equal(term_key(2, mask(1, 2, 0), 0) >> 56, RETEX_ROLE_DEP);
    assert_int_equal(term_key(2, mask(2, 0, 0), 0) >> 56, RETEX_ROLE_CROSS2);
    assert_int_equal(term_key(3, mask(1, 3, 0), 0) >> 56, RETEX_ROLE_CROSS3);
    /* four hits, mixed: as many factors of each target, from the first on */
    assert_true(term_key(4, mask(2, 3, 2), 0) == term_key(3, mask(1, 2, 1), 0));
    assert_true(term_key(4, mask(2, 3, 2), 1) == TERM_DROPPED);
}

static void any_number_of_targets_has_its_terms(void **state)
{
    (void)state;
    for (int targets = 1; targets <= RETEX_MAX_TARGETS; targets++) {
        double prefixes = 1; /* counts of factors of each target: targets + n over n */
        int n = expansion_most_hits(targets), cross = 8 * targets + 3 * targets * targets;
        for (int k = 1; k <= n; k++)
            prefixes = prefixes * (targets + k) / k;
        assert_true(n >= 4 && n <= RETEX_MAX_HITS);
        assert_true(prefixes + cross + n <= TERMS_MAX);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(multiplies_out), cmocka_unit_test(monomials_find_their_terms),
                                       cmocka_unit_test(any_number_of_targets_has_its_terms)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
