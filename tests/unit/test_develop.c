/* Exposure and white balance: Bradford's adaptation with the inverse matrices that Lindbloom published ("Chromatic
 * Adaptation", brucelindbloom.com), and what must hold of any. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <retex/develop.h>
#include <retex/lamp.h>

#include "retexture/develop.h"

static const double to_xyz[3][3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
static const double from_xyz[3][3] = {
    {3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}};
static const double to_cones[3][3] = {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}};
static const double from_cones[3][3] = {
    {0.9869929, -0.1470543, 0.1599627}, {0.4323053, 0.5183603, 0.0492912}, {-0.0085287, 0.0400428, 0.9684867}};

static void apply(const double m[3][3], double v[3])
{
    double out[3];
    for (int i = 0; i < 3; i++)
        out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    for (int i = 0; i < 3; i++)
        v[i] = out[i];
}

static RetexDeveloper developer_of(double kelvin, double exposure, double stops)
{
    RetexDevelop params = RETEX_DEVELOP_INIT;
    RetexDeveloper developer;
    RetexError err = {0};
    params.white_balance = kelvin, params.exposure = exposure;
    assert_int_equal(retex_developer_open(&developer, &params, stops, &err), RETEX_OK);
    return developer;
}

/* Each column is what becomes of one of the three colours. */
static void white_balance_is_bradfords(void **state)
{
    (void)state;
    static const double kelvins[] = {2000, 2856, 4000, 6500, 10000, 25000};
    for (size_t k = 0; k < sizeof kelvins / sizeof *kelvins; k++) {
        const RetexDeveloper developer = developer_of(kelvins[k], 0, 0);
        float light[3];
        retex_kelvin_color(light, kelvins[k]);
        double lit[3] = {(double)light[0], (double)light[1], (double)light[2]}, white[3] = {1, 1, 1};
        apply(to_xyz, lit), apply(to_cones, lit);
        apply(to_xyz, white), apply(to_cones, white);
        for (int j = 0; j < 3; j++) {
            double color[3] = {j == 0, j == 1, j == 2};
            apply(to_xyz, color), apply(to_cones, color);
            for (int i = 0; i < 3; i++)
                color[i] *= white[i] / lit[i];
            apply(from_cones, color), apply(from_xyz, color);
            for (int i = 0; i < 3; i++)
                assert_true(fabs((double)developer.matrix[i][j] - color[i]) < 1e-5 * (1 + fabs(color[i])));
        }
        retex_develop_kernel(&developer, light, 1);
        for (int i = 0; i < 3; i++)
            assert_float_equal(light[i], 1, 2e-5);
    }
}

static void exposures_are_stops(void **state)
{
    (void)state;
    const RetexDeveloper developer = developer_of(0, 1.5, -3);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            assert_float_equal(developer.matrix[i][j], i == j ? exp2(-1.5) : 0, 1e-6);
}

static void only_changes_are_needed(void **state)
{
    (void)state;
    assert_false(developer_of(0, 0, 0).is_needed);
    assert_false(developer_of(0, 2, -2).is_needed);
    assert_true(developer_of(0, 2, 0).is_needed);
    assert_true(developer_of(0, 0, -1).is_needed);
    assert_true(developer_of(4000, 0, 0).is_needed);
    assert_true(developer_of(4000, 1, 1).is_needed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(white_balance_is_bradfords),
                                       cmocka_unit_test(exposures_are_stops),
                                       cmocka_unit_test(only_changes_are_needed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
