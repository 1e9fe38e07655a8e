/* Transforms of retex-import: what is written for POV-Ray is applied to points, as its documentation says. */
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "import/base/affine.h"

/* Numbers that follow a word, at least one, the rest 0; returns how many. */
static int numbers_after(const char *text, const char *word, double *out, int most)
{
    const char *at = strstr(text, word);
    int count = 0;
    memset(out, 0, (size_t)most * sizeof *out);
    if (!at)
        return 0;
    for (at += strlen(word); count < most; count++) {
        char *end;
        at += strspn(at, " <,");
        out[count] = strtod(at, &end);
        if (end == at)
            break;
        at = end;
    }
    return count;
}

/* As POV-Ray does: a matrix is of row vectors, its fourth row moves; then scale, then translate. */
static void apply_text(const char *text, const double p[3], double out[3])
{
    double m[12], scale[3], by[3];
    memcpy(out, p, 3 * sizeof *out);
    if (numbers_after(text, "matrix", m, 12)) {
        for (int i = 0; i < 3; i++)
            out[i] = p[0] * m[i] + p[1] * m[3 + i] + p[2] * m[6 + i] + m[9 + i];
        return;
    }
    const int count = numbers_after(text, "scale", scale, 3);
    for (int i = 0; i < 3 && count; i++)
        out[i] *= scale[count == 1 ? 0 : i];
    numbers_after(text, "translate", by, 3);
    for (int i = 0; i < 3; i++)
        out[i] += by[i];
}

static void transforms_are_written(void **state)
{
    (void)state;
    static const struct {
        const char *begins; /* with this; "": nothing is written */
        Affine a;
    } cases[] = {
        {"", {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}},
        {"", {{{1, 1e-9, 0, 1e-9}, {0, 1 + 5e-8, 0, 0}, {0, -1e-9, 1, 0}}}},
        {" scale 2", {{{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}}}},
        {" scale <", {{{2, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 3, 0}}}},
        {" scale <", {{{2, 0, 0, 1}, {0, 2, 0, 0}, {0, 0, -2, 5}}}},
        {" scale <", {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 0}}}},
        {" translate", {{{1, 0, 0, 4}, {0, 1, 0, 5}, {0, 0, 1, -6}}}},
        {" translate", {{{1, 0, 0, 0}, {0, 1, 0, 5}, {0, 0, 1, 0}}}},
        {" matrix", {{{0, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}}, /* a scale of 0 is none there */
        {" matrix", {{{1, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 1, 0}}}},
        {" matrix", {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 0}}}},
        {" scale <", {{{.0027, 0, 0, 0}, {0, 2.7e-8, 0, 0}, {0, 0, .0027, 0}}}}, /* small is not 0 */
        {" matrix", {{{1, .5, 0, 7}, {0, 1, 0, 8}, {0, 0, 1, 9}}}},
        {" matrix", {{{.6, 0, .8, 0}, {0, 1, 0, 0}, {-.8, 0, .6, 0}}}},
        {" matrix", {{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}}}},
        {" matrix", {{{1, 0, .25, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}},
        {" matrix", {{{1, 0, 0, 0}, {.25, 1, 0, 0}, {0, 0, 1, 0}}}},
        {" matrix", {{{1, 0, 0, 0}, {0, 1, .25, 0}, {0, 0, 1, 0}}}},
        {" matrix", {{{1, 0, 0, 0}, {0, 1, 0, 0}, {.25, 0, 1, 0}}}},
        {" matrix", {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, .25, 1, 0}}}},
    };
    static const double points[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {3, -2, 5}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char *text = NULL;
        size_t size;
        FILE *out = open_memstream(&text, &size);
        assert_non_null(out);
        affine_print(out, &cases[k].a);
        assert_int_equal(fclose(out), 0);
        assert_true(*cases[k].begins ? !strncmp(text, cases[k].begins, strlen(cases[k].begins)) : !*text);
        for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
            double to[3], expected[3];
            apply_text(text, points[i], to);
            affine_point(&cases[k].a, points[i], expected);
            for (int c = 0; c < 3; c++)
                assert_float_equal(to[c], expected[c], 1e-6);
        }
        free(text);
    }
}

/* What is flat gets an inverse, and stays where it is; lines and points are told. */
static void flat_ones_get_thick(void **state)
{
    (void)state;
    const struct {
        Affine a;
        int is_seen, is_flat;
    } cases[] = {
        {{{{2, 0, 0, 1}, {0, 0, 0, 2}, {0, 0, 3, 4}}}, 1, 1},
        {{{{.0027, 0, 0, 1}, {0, -0., -0., 2}, {0, 0, .0027, 4}}}, 1, 1},
        {{{{1, 1, 0, 0}, {1, 1, 0, 0}, {0, 0, 5, 0}}}, 1, 1},
        {{{{1, 2, 3, 0}, {4, 5, 6, 0}, {7, 8, 9, 1}}}, 1, 1},
        {{{{1, 2, 3, 0}, {4, 5, 6, 0}, {7, 8, 10, 1}}}, 1, 0},
        {{{{1000, 0, 0, 0}, {0, .5, 0, 0}, {0, 0, 1000, 0}}}, 1, 0},
        {{{{0, 0, 0, 5}, {0, 0, 0, 6}, {0, 0, 7, 8}}}, 0, 0},
        {{{{1, 2, 3, 0}, {2, 4, 6, 0}, {3, 6, 9, 1}}}, 0, 0},
        {{{{0}}}, 0, 0},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Affine a = cases[k].a;
        double size = 0, det = 0, change = 0;
        assert_int_equal(affine_thicken(&a), cases[k].is_seen);
        for (int i = 0; i < 12; i++) {
            size = fmax(size, fabs(a.m[i / 4][i % 4]) * (i % 4 < 3));
            change = fmax(change, fabs(a.m[i / 4][i % 4] - cases[k].a.m[i / 4][i % 4]));
        }
        for (int i = 0; i < 3; i++)
            det += a.m[0][i] * (a.m[1][(i + 1) % 3] * a.m[2][(i + 2) % 3] - a.m[1][(i + 2) % 3] * a.m[2][(i + 1) % 3]);
        assert_true(change <= 1.01e-5 * size);
        assert_int_equal(change > 0, cases[k].is_flat);
        assert_true(!cases[k].is_seen || fabs(det) > 1e-7 * size * size * size);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(transforms_are_written), cmocka_unit_test(flat_ones_get_thick)};
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
