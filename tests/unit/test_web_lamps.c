/* The lamps of a page: the dimmest join the rest, with all their light, and what shows nothing is left out. */
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compact/light.h"
#include "retexture/enlarge.h"
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

/* ---- shares of light ---- */

enum { MOST_TERMS = 64 };

/* A set whose lamps have a share of each light, an image that is so many times smaller; it has none where that is 0.
 * names[lamp][term]: numbers of the parts. */
static RetexSet *shared_set(const int scales[LAMPS], int shares[LAMPS][MOST_TERMS])
{
    static const float kept[LAMPS][3] = {{1, .5f, 2}, {.7f, .7f, .7f}, {1, 1, 1}};
    RetexSet *set = test_set(WIDTH, HEIGHT, 4);
    RetexError err = {0};
    uint32_t seed = 9;
    const int nterms = set->nterms;
    assert_true(nterms < MOST_TERMS);
    for (int k = 0; k < LAMPS; k++) {
        RetexParameter lamp = {.target = -1};
        int number;
        snprintf(lamp.name, sizeof lamp.name, "%s", lamp_names[k]);
        memcpy(lamp.value, kept[k], sizeof lamp.value);
        memcpy(lamp.kept, kept[k], sizeof lamp.kept);
        test_must(retex_set_add_parameter(set, &lamp, &number, &err), &err);
        for (int t = 0; t < nterms; t++) {
            RetexTerm term = set->terms[t];
            char name[64];
            const int scale = scales[k];
            if (!retex_term_is_light(&term) || !scale)
                continue;
            snprintf(name, sizeof name, "share%d_%d", k, t);
            test_must(retex_set_add_part(set, name, "RGB", RETEX_HALF, (WIDTH + scale - 1) / scale,
                                         (HEIGHT + scale - 1) / scale, &shares[k][t], &err),
                      &err);
            RetexImage *share = &set->parts[shares[k][t]].image;
            for (size_t i = 0; i < retex_image_index(share, 0, share->height); i++)
                share->pixels[i] = (float)(.05 + .3 * test_random(&seed));
            term.role = RETEX_ROLE_LAMP;
            test_must(retex_term_add_factor(&term, retex_factor(RETEX_FACTOR_PARAMETER, number), &err), &err);
            test_must(retex_term_add_factor(&term, retex_factor(RETEX_FACTOR_IMAGE, shares[k][t]), &err), &err);
            test_must(retex_set_add_term(set, &term, NULL, &err), &err);
        }
    }
    return set;
}

/* The share of a lamp in the light of the set's term, which one term has; NULL: the page has none. */
static const RetexImage *share_on_page(const RetexSet *page, int lamp, const RetexSet *set, const RetexTerm *by)
{
    const RetexImage *found = NULL;
    for (int t = 0; t < page->nterms; t++) {
        const RetexTerm *term = &page->terms[t];
        if (term->role != RETEX_ROLE_LAMP || retex_set_term_lamp(page, term) != lamp ||
            strcmp(page->parts[term->radiance].name, set->parts[by->radiance].name) != 0)
            continue;
        assert_null(found);
        assert_true(is_by_same_hits(by, term));
        found = &page->parts[retex_term_image(term)].image;
    }
    return found;
}

/* Means of blocks of 2 x 2 by the light that they are shares of; plain ones where there is none. */
static double halved(const RetexImage *share, const RetexImage *light, int x, int y, int c)
{
    double sum = 0, weights = 0, plain = 0, count = 0;
    for (int py = 2 * y; py < 2 * y + 2 && py < share->height; py++)
        for (int px = 2 * x; px < 2 * x + 2 && px < share->width; px++) {
            const double value = (double)share->pixels[retex_image_index(share, px, py) + (size_t)c];
            const double weight = fmax((double)light->pixels[retex_image_index(light, px, py) + (size_t)c], 0);
            sum += weight * value, weights += weight, plain += value, count++;
        }
    return weights > 0 ? sum / weights : plain / count;
}

/* The same for a whole image. Enlarged, they have the light of the blocks. */
static void halve(RetexImage *half, const RetexImage *share, const RetexImage *light)
{
    RetexImage rows = {0};
    RetexError err = {0};
    double wanted[3] = {0}, made[3] = {0};
    test_must(retex_image_alloc(half, (share->width + 1) / 2, (share->height + 1) / 2, 3, &err), &err);
    test_must(retex_image_alloc(&rows, share->width, share->height, 3, &err), &err);
    for (size_t i = 0; i < retex_image_index(half, 0, half->height); i++) {
        const int at = (int)(i / 3);
        half->pixels[i] = (float)halved(share, light, at % half->width, at / half->width, (int)(i % 3));
    }
    retex_enlarge_rows(half, 2, share->width, 0, share->height, rows.pixels);
    for (size_t i = 0; i < retex_image_index(share, 0, share->height); i++) {
        wanted[i % 3] += (double)share->pixels[i] * (double)light->pixels[i];
        made[i % 3] += (double)rows.pixels[i] * (double)light->pixels[i];
    }
    for (size_t i = 0; i < retex_image_index(half, 0, half->height); i++)
        half->pixels[i] = (float)((double)half->pixels[i] * wanted[i % 3] / made[i % 3]);
    retex_image_free(&rows);
}

/* The sum of the shares of lamps first to last in the light of a term, each times its value; the last one's own where
 * they are the same. */
static void expect_share(const RetexImage *is, const RetexSet *set, int first, int last, int t, const int scales[LAMPS],
                         int shares[LAMPS][MOST_TERMS])
{
    RetexImage sum = {0}, rows = {0}, half = {0};
    RetexError err = {0};
    int finest = scales[last];
    for (int k = first; k < last; k++)
        finest = scales[k] < finest ? scales[k] : finest;
    const int width = (WIDTH + finest - 1) / finest, height = (HEIGHT + finest - 1) / finest;
    test_must(retex_image_alloc(&sum, width, height, 3, &err), &err);
    test_must(retex_image_alloc(&rows, width, height, 3, &err), &err);
    for (int k = first; k <= last; k++) {
        retex_enlarge_rows(&set->parts[shares[k][t]].image, scales[k] / finest, width, 0, height, rows.pixels);
        for (size_t i = 0; i < retex_image_index(&sum, 0, height); i++)
            sum.pixels[i] += rows.pixels[i] * (first < last ? set->parameters[k].value[i % 3] : 1);
    }
    const int on_page = finest < 2 ? 2 : finest;
    assert_int_equal(is->width, (WIDTH + on_page - 1) / on_page);
    assert_int_equal(is->height, (HEIGHT + on_page - 1) / on_page);
    if (finest < 2)
        halve(&half, &sum, &set->parts[set->terms[t].radiance].image);
    for (size_t i = 0; i < retex_image_index(is, 0, is->height); i++)
        assert_float_equal(is->pixels[i], (finest < 2 ? &half : &sum)->pixels[i], 1e-5);
    retex_image_free(&half);
    retex_image_free(&sum);
    retex_image_free(&rows);
}

/* Those that join `rest` are added up, at the finest size of them; those of the picture's size become half as large. */
static void shares_are_halved_and_added(void **state)
{
    (void)state;
    static const int cases[][LAMPS] = {{1, 2, 4}, {2, 2, 2}, {4, 2, 4}, {4, 4, 2}, {1, 1, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int joins = 0; joins < 2; joins++) {
            int shares[LAMPS][MOST_TERMS];
            RetexSet *set = shared_set(cases[i], shares), *page = shared_set(cases[i], shares);
            RetexError err = {0};
            char names[64];
            int compared = 0;
            test_must(retex_web_lamps_prepare(page, joins ? 0 : 9, names, sizeof names, &err), &err);
            assert_string_equal(names, joins ? "Lamp, Window" : "");
            for (int t = 0; t < set->nterms; t++)
                for (int k = 0; k < LAMPS && retex_term_is_light(&set->terms[t]); k++) {
                    const RetexImage *is = share_on_page(page, k, set, &set->terms[t]);
                    assert_int_equal(!is, joins && k < LAMPS - 1);
                    if (is)
                        expect_share(is, set, joins ? 0 : k, k, t, cases[i], shares), compared++;
                }
            assert_true(compared > 3);
            retex_set_close(&set);
            retex_set_close(&page);
        }
}

/* Light that meets textures counts as it is on grey; all pixels count. */
static void brightness_is_on_grey(void **state)
{
    (void)state;
    RetexSet *set = lit_set(0);
    RetexError err = {0};
    char names[64];
    int direct = -1, deep = -1;
    for (int t = 0; t < set->nterms; t++)
        if (retex_term_is_light(&set->terms[t])) {
            const int hits = retex_term_hits(&set->terms[t]);
            direct = direct < 0 && !hits ? t : direct;
            deep = deep < 0 || hits > retex_term_hits(&set->terms[deep]) ? t : deep;
        }
    assert_true(direct >= 0 && retex_term_hits(&set->terms[deep]) >= 2);
    for (int k = 0; k < 2; k++)
        for (int t = 0; t < set->nterms; t++)
            for (int i = 0; light_of(set, k, t) && i < 3 * WIDTH * HEIGHT; i++)
                light_of(set, k, t)[i] = t == (k ? deep : direct) && i % (3 * WIDTH) >= 3 ? k ? 1.2f : 1 : 0;
    assert_true(brightness(set, 1) < brightness(set, 0)); /* though its light is brighter */
    test_must(retex_web_lamps_prepare(set, 1, names, sizeof names, &err), &err);
    assert_string_equal(names, lamp_names[1]);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_dimmest_join_the_rest), cmocka_unit_test(lamps_that_are_off_stay_apart),
        cmocka_unit_test(dark_lamps_are_left_out),   cmocka_unit_test(shares_are_halved_and_added),
        cmocka_unit_test(brightness_is_on_grey),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
