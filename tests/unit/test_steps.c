/* Steps of mean UV from pixel to pixel (set/steps.h): derivatives of second order, within strips. */
#include "lib_test.h"

#include <math.h>

#include <cmocka.h>

#include "set/steps.h"

enum { WIDE = 9, HIGH = 70, CUT = RETEX_STEPS_ROWS };

static void put(RetexImage *uv, int x, int y, double u, double v)
{
    float *pixel = uv->pixels + retex_image_index(uv, x, y);
    pixel[0] = (float)u, pixel[1] = (float)v, pixel[2] = 1;
}

static void remove_pixel(RetexImage *uv, int x, int y)
{
    uv->pixels[retex_image_index(uv, x, y) + 2] = 0;
}

/* u = x^2 / 8 + y, v = x y / 4 - y^2 / 16: exact in floats. */
static RetexImage parabolas(void)
{
    RetexImage uv = {0};
    RetexError err;
    test_must(retex_image_alloc(&uv, WIDE, HIGH, 3, &err), &err);
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++)
            put(&uv, x, y, x * x / 8.0 + y, x * y / 4.0 - y * y / 16.0);
    return uv;
}

static const int not_periodic[2] = {0, 0};

static void expect(const RetexImage *uv, int x, int y, double ux, double vx, double uy, double vy)
{
    double steps[4];
    retex_steps_at(steps, uv, x, y, not_periodic);
    const double should[] = {ux, vx, uy, vy};
    for (int k = 0; k < 4; k++)
        if (fabs(steps[k] - should[k]) > 1e-12)
            fail_msg("%d,%d: step %d is %g, should be %g", x, y, k, steps[k], should[k]);
}

/* Of parabolas they are exact at borders too: of the picture, of strips, of what has the footprint. */
static void parabolas_are_exact(void **state)
{
    RetexImage uv = parabolas();
    (void)state;
    for (int hole = 0; hole < 2; hole++) {
        for (int y = 0; y < HIGH; y++)
            for (int x = 0; x < WIDE; x++)
                if (uv.pixels[retex_image_index(&uv, x, y) + 2] > 0)
                    expect(&uv, x, y, x / 4.0, y / 4.0, 1, x / 4.0 - y / 8.0);
        for (int y = 0; y < HIGH; y++)
            remove_pixel(&uv, 4, y);
    }
    retex_image_free(&uv);
}

/* With one neighbour alone it is the difference to that, and without any 0. */
static void few_neighbours(void **state)
{
    RetexImage uv = parabolas();
    (void)state;
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++)
            if ((x != 4 && x != 5) || y != 7)
                remove_pixel(&uv, x, y);
    expect(&uv, 4, 7, (25 - 16) / 8.0, 7 / 4.0, 0, 0);
    expect(&uv, 5, 7, (25 - 16) / 8.0, 7 / 4.0, 0, 0);
    remove_pixel(&uv, 5, 7);
    expect(&uv, 4, 7, 0, 0, 0, 0);
    retex_image_free(&uv);
}

/* What is in another strip changes nothing. */
static void strips_stand_alone(void **state)
{
    RetexImage uv = parabolas();
    (void)state;
    for (int x = 0; x < WIDE; x++)
        put(&uv, x, CUT, 99, 99);
    for (int x = 0; x < WIDE; x++)
        expect(&uv, x, CUT - 1, x / 4.0, (CUT - 1) / 4.0, 1, x / 4.0 - (CUT - 1) / 8.0);
    retex_image_free(&uv);
}

/* On a periodic axis the shorter way round counts. */
static void periodic_steps(void **state)
{
    RetexImage uv = parabolas();
    static const int periodic[2] = {1, 0};
    (void)state;
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++)
            put(&uv, x, y, fmod(0.0625 * (x + 13), 1), 0.75 * x);
    for (int x = 0; x < WIDE; x++) {
        double steps[4];
        retex_steps_at(steps, &uv, x, 3, periodic);
        assert_float_equal(steps[0], 0.0625, 1e-12);
        assert_float_equal(steps[1], 0.75, 1e-12);
    }
    retex_image_free(&uv);
}

/* Axes fit that are off by at most the tolerance times their size along u, and along v. */
static void tolerance(void **state)
{
    const float axes[] = {3, 0.03f, 4, 0.04f};
    (void)state;
    assert_true(retex_steps_fit((const double[4]){3.2, 0.03, 4, 0.04}, axes, 0.05));
    assert_false(retex_steps_fit((const double[4]){3.3, 0.03, 4, 0.04}, axes, 0.05));
    assert_true(retex_steps_fit((const double[4]){3, 0.03, 4, 0.042}, axes, 0.05));
    assert_false(retex_steps_fit((const double[4]){3, 0.03, 4, 0.043}, axes, 0.05));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parabolas_are_exact), cmocka_unit_test(few_neighbours), cmocka_unit_test(strips_stand_alone),
        cmocka_unit_test(periodic_steps),      cmocka_unit_test(tolerance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
