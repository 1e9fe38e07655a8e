/* Numbers that a render may store: film/limits.h. */
#include <float.h>
#include <math.h>

#include "lib_test.h"
#include <cmocka.h>

#include "film/limits.h"

static void test_numbers(void **state)
{
    (void)state;
    static const struct {
        float from, to, to_if_infinite;
    } cases[] = {{0, 0, 0},
                 {-1, -1, -1},
                 {FLT_MIN / 4, FLT_MIN / 4, FLT_MIN / 4},
                 {65504, 65504, 65504},
                 {1e18f, 1e18f, 1e18f},
                 {-1e18f, -1e18f, -1e18f},
                 {1.001e18f, 1e18f, 1e18f},
                 {FLT_MAX, 1e18f, 1e18f},
                 {-FLT_MAX, -1e18f, -1e18f},
                 {INFINITY, 1e18f, INFINITY},
                 {-INFINITY, -1e18f, -INFINITY},
                 {NAN, 0, 0},
                 {-NAN, 0, 0}};
    enum { COUNT = sizeof cases / sizeof *cases, PLACES = 37 };
    for (int i = 0; i < COUNT; i++)
        for (int may = 0; may < 2; may++)
            for (int at = 0; at < PLACES; at++) {
                float numbers[PLACES + 1];
                for (int k = 0; k <= PLACES; k++)
                    numbers[k] = k == at ? cases[i].from : k < PLACES ? (float)k : NAN; /* the last is not to be seen */
                const float to = may ? cases[i].to_if_infinite : cases[i].to;
                const int same = cases[i].from == to;
                assert_int_equal(film_limit_numbers(numbers, PLACES, may), !same);
                for (int k = 0; k < PLACES; k++)
                    assert_true(numbers[k] == (k == at ? to : (float)k));
                assert_true(isnan(numbers[PLACES]));
            }
    assert_int_equal(film_limit_numbers(NULL, 0, 0), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
