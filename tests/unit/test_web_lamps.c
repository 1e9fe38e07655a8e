/* The lamps of a page: the dimmest join the rest, with all their light, and what shows nothing is left out. */
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compact/light.h"
#include "web/lamps.h"

enum { WIDTH = 22, HEIGHT = 17, LAMPS = 3 };
static const char *const lamp_names[LAMPS] = {"Lamp", "Window", "rest"};

/* A set whose light is divided among three lamps: parts lampK_T are the light of lamp K in term T. */
static RetexSet *lit_set(int off)
{
    RetexSet *set = test_set(WIDTH, HEIGHT, 4);
    test_add_lamp_terms(set, off, 0);
    return set;
}

static float *light_of(const RetexSet *set, int lamp, int term)
{
    char name[64];
    snprintf(name, sizeof name, "lamp%d_%d", lamp, term);
    const int part = retex_set_find_part(set, name);
    return part < 0 ? NULL : set->parts[part].image.pixels;
}

/* How bright a lamp is on grey textures: by its value as it is kept. */
static double brightness(const RetexSet *set, int lamp)
{
    const float *kept = set->parameters[retex_set_find_parameter(set, lamp_names[lamp])].kept;
    double sum = 0;
    for (int t = 0; t < set->nterms; t++) {
        const float *light = retex_term_is_light(&set->terms[t]) ? light_of(set, lamp, t) : NULL;
        const double grey = pow((double)RETEX_COMPACT_GREY, retex_term_hits(&set->terms[t]));
        for (int i = 0; light && i < 3 * WIDTH * HEIGHT; i += 3)
            sum += grey * (double)retex_luminance(kept[0] * light[i], kept[1] * light[i + 1], kept[2] * light[i + 2]);
    }
    return sum;
}

static int lamp_terms(const RetexSet *set)
{
    int count = 0;
    for (int t = 0; t < set->nterms; t++)
        count += set->terms[t].role == RETEX_ROLE_LAMP;
    return count;
}

/* Whether two terms are light by the same hits, whatever lamp it is of. */
static int is_by_same_hits(const RetexTerm *a, const RetexTerm *b)
{
    int at = 0;
    for (int k = 0; k < a->nfactors; k++) {
        if (a->factors[k].kind == RETEX_FACTOR_PARAMETER)
            continue;
        while (at < b->nfactors && b->factors[at].kind == RETEX_FACTOR_PARAMETER)
            at++;
        if (at == b->nfactors || memcmp(&a->factors[k], &b->factors[at++], sizeof *a->factors) != 0)
            return 0;
    }
    return retex_term_hits(a) == retex_term_hits(b);
}

/* All light of a lamp by the hits of a term; returns how many terms have it. */
static int sum_light(double sum[3 * WIDTH * HEIGHT], const RetexSet *set, int lamp, const RetexTerm *by)
{
    int count = 0;
    memset(sum, 0, 3 * WIDTH * HEIGHT * sizeof *sum);
    for (int t = 0; t < set->nterms; t++) {
        const RetexTerm *term = &set->terms[t];
        if (term->role != RETEX_ROLE_LAMP || retex_set_term_lamp(set, term) != lamp || !is_by_same_hits(term, by))
            continue;
        count++;
        for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
            sum[i] += (double)set->parts[term->radiance].image.pixels[i];
    }
    return count;
}

/* Prepares a copy of the set; the light of `joined` (a bit each) must have gone into that of the last lamp, times its
 * value, in one term where it goes by the same hits. */
static void expect_joined(int off, int most, int joined, const char *names)
{
    static double is[3 * WIDTH * HEIGHT], should[3 * WIDTH * HEIGHT], more[3 * WIDTH * HEIGHT];
    RetexSet *set = lit_set(off), *page = lit_set(off);
    RetexError err = {0};
    char found[256] = "x";
    test_must(retex_web_lamps_prepare(page, most, found, sizeof found, &err), &err);
    assert_string_equal(found, names);
    for (int t = 0; t < set->nterms; t++)
        for (int k = 0; k < LAMPS && retex_term_is_light(&set->terms[t]); k++) {
            const RetexTerm *by = &set->terms[t];
            const int before = sum_light(should, set, k, by), is_rest = joined && k == LAMPS - 1;
            assert_int_equal(sum_light(is, page, k, by), joined >> k & 1 ? 0 : is_rest ? 1 : before);
            for (int j = 0; is_rest && j < LAMPS - 1; j++) {
                if (!(joined >> j & 1))
                    continue;
                sum_light(more, set, j, by);
                for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
                    should[i] += (double)set->parameters[j].value[i % 3] * more[i];
            }
            for (int i = 0; i < 3 * WIDTH * HEIGHT && !(joined >> k & 1); i++)
                assert_float_equal(is[i], should[i], 1e-5 * fabs(should[i]) + 1e-6);
        }
    assert_true(!joined || page->parameters[LAMPS - 1].several);
    retex_set_close(&set);
    retex_set_close(&page);
}

static void the_dimmest_join_the_rest(void **state)
{
    (void)state;
    RetexSet *set = lit_set(0);
    const int dim = brightness(set, 0) < brightness(set, 1) ? 0 : 1;
    retex_set_close(&set);
    expect_joined(0, 2, 0, "");
    expect_joined(0, 1, 1 << dim, lamp_names[dim]);
    expect_joined(0, 0, 3, "Lamp, Window");
    expect_joined(1, 1, 1, "Lamp"); /* the window is off, and the rest shines */
}

static void lamps_that_are_off_stay_apart(void **state)
{
    (void)state;
    RetexSet *set = lit_set(1);
    RetexError err = {0};
    char names[64];
    assert_int_equal(retex_web_lamps_prepare(set, 0, names, sizeof names, &err), RETEX_EUNSUPPORTED);
    assert_non_null(strstr(err.message, "a page of 0 lamps has no room for all that are off in the picture"));
    retex_set_close(&set);
}

/* Black light is left out, and the rest where it is less than its percentage tells. */
static void dark_lamps_are_left_out(void **state)
{
    (void)state;
    for (int dark = 0; dark < LAMPS; dark++)
        for (int faint = 0; faint < 2; faint++) {
            RetexSet *set = lit_set(0);
            RetexError err = {0};
            char names[64];
            const double share = brightness(set, dark) / (brightness(set, 0) + brightness(set, 1) + brightness(set, 2));
            const int before = set->nterms, own = lamp_terms(set) / LAMPS;
            for (int t = 0; t < before; t++) {
                float *light = retex_term_is_light(&set->terms[t]) ? light_of(set, dark, t) : NULL;
                for (int i = 0; light && i < 3 * WIDTH * HEIGHT; i++)
                    light[i] = faint ? light[i] * (float)(3e-5 / share) : 0;
            }
            test_must(retex_web_lamps_prepare(set, 9, names, sizeof names, &err), &err);
            const int is_left_out = !faint || dark == LAMPS - 1;
            assert_int_equal(lamp_terms(set), (LAMPS - is_left_out) * own);
            assert_int_equal(set->nterms, before - is_left_out * own);
            for (int k = 0; k < LAMPS; k++)
                assert_int_equal(retex_web_has_light(set, k), !(is_left_out && k == dark));
            retex_set_close(&set);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_dimmest_join_the_rest),
        cmocka_unit_test(lamps_that_are_off_stay_apart),
        cmocka_unit_test(dark_lamps_are_left_out),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
