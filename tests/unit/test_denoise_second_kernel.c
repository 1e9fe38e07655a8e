/* One level of the second pass of denoising: vector and scalar code give the same bits, and the values of the formulas,
 * pixel by pixel. */
#include "lib_denoise_kernel.h"
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "denoise/second_kernel.h"

enum { SIGNALS = 3, VALUES = 9 /* planes of a signal */ };

/* Steps, and how far around the tile, as the second pass takes them. */
static const int levels[DENOISE_LEVELS][2] = {{1, 10}, {4, 6}, {8, -2}};
static const float unwritten = -7;

/* Several signals, as one level takes them and leaves them. */
typedef struct Lights {
    float planes[SIGNALS][VALUES][DENOISE_PLANE];
    RetexDenoiseLight of[SIGNALS];
} Lights;

static Lights *open_lights(void)
{
    Lights *l = malloc(sizeof *l);
    for (int s = 0; s < SIGNALS; s++) {
        for (int k = 0; k < VALUES; k++)
            for (int i = 0; i < DENOISE_PLANE; i++)
                l->planes[s][k][i] = unwritten;
        for (int c = 0; c < 3; c++) {
            l->of[s].half[0][c] = l->planes[s][c], l->of[s].half[1][c] = l->planes[s][3 + c];
            l->of[s].variance[c] = l->planes[s][6 + c];
        }
    }
    return l;
}

/* The room's features, and signals that differ in light, noise and kinds. */
typedef struct Input {
    Room *room;
    Lights *lights;
    float kinds[SIGNALS][DENOISE_PLANE], epsilons[SIGNALS];
    const float *kind_planes[SIGNALS];
} Input;

/* Light near enough to its neighbours' for weights between 0 and 1; features, too. */
static Input *open_input(uint32_t seed)
{
    Input *in = malloc(sizeof *in);
    in->room = open_room(seed);
    in->lights = open_lights();
    for (int k = 0; k < 2 * FEATURES; k++)
        for (int i = 0; i < DENOISE_PLANE; i++)
            in->room->scales[k][i] *= 0.5f;
    for (int s = 0; s < SIGNALS; s++) {
        in->epsilons[s] = 0.01f * (float)(s + 1);
        in->kind_planes[s] = in->kinds[s];
        for (int i = 0; i < DENOISE_PLANE; i++) {
            in->kinds[s][i] = s && test_random(&seed) < 0.2 ? -1 : 1;
            for (int c = 0; c < 3; c++) {
                in->lights->of[s].variance[c][i] = (float)(0.01 + 0.1 * test_random(&seed));
                for (int h = 0; h < 2; h++)
                    in->lights->of[s].half[h][c][i] = (float)(1 + s + 0.8 * test_random(&seed));
            }
        }
    }
    return in;
}

static void close_input(Input *in)
{
    free(in->room);
    free(in->lights);
    free(in);
}

static RetexDenoiseLevel level_of(const Input *in, int number, Lights *to)
{
    return (RetexDenoiseLevel){.step = levels[number][0],
                               .around = levels[number][1],
                               .features = &in->room->features,
                               .nsignals = SIGNALS,
                               .kinds = in->kind_planes,
                               .epsilons = in->epsilons,
                               .from = in->lights->of,
                               .to = to->of};
}

/* ---- scalar and vector ---- */

static void expect_bits(const Lights *a, const Lights *b)
{
    for (int s = 0; s < SIGNALS; s++)
        for (int k = 0; k < VALUES; k++)
            for (int i = 0; i < DENOISE_PLANE; i++)
                if (memcmp(&a->planes[s][k][i], &b->planes[s][k][i], sizeof(float)) != 0)
                    fail_msg("signal %d, plane %d, value %d is %a and %a", s, k, i, (double)a->planes[s][k][i],
                             (double)b->planes[s][k][i]);
}

/* Also of light that is dark, or far too bright. */
static void test_scalar_and_vector(void **state)
{
    (void)state;
    for (int rough = 0; rough < 2; rough++)
        for (int k = 0; k < DENOISE_LEVELS; k++) {
            Input *in = open_input(1 + (uint32_t)k);
            Lights *plain = open_lights(), *vector = open_lights();
            for (int i = 0; i < DENOISE_PLANE && rough; i++)
                for (int c = 0; c < 3; c++) {
                    in->lights->of[1].half[0][c][i] = in->room->half[0][c][i];
                    in->lights->of[1].half[1][c][i] = in->room->half[1][c][i];
                    in->lights->of[1].variance[c][i] = in->room->variance[c][i] + 1e-20f;
                }
            const RetexDenoiseLevel to_plain = level_of(in, k, plain), to_vector = level_of(in, k, vector);
            retex_denoise_level_kernel(&to_plain, 1);
            retex_denoise_level_kernel(&to_vector, 0);
            expect_bits(plain, vector);
            free(plain), free(vector);
            close_input(in);
        }
}

/* ---- the formulas ---- */

static double falloff(double x)
{
    return x < 8 ? pow(1 - x / 8, 8) : 0;
}

/* By the feature that differs most. */
static double alike_reference(const Room *r, size_t p, size_t q, int dx, int dy)
{
    double largest = 0;
    for (int g = 0; g < FEATURES; g++) {
        const RetexDenoiseFeature *feature = &r->features.of[g];
        double squares = 0, along = 0;
        for (int k = 0; k < feature->count; k++) {
            const double d = (double)r->planes[feature->first + k][q] - r->planes[feature->first + k][p];
            squares += d * d;
            along += feature->normal[0] ? feature->normal[k][p] * d : 0;
        }
        if (feature->normal[0])
            squares = along * along / fmax(1, dx * dx + dy * dy);
        largest = fmax(largest, squares * feature->strict[p]);
    }
    return falloff(largest);
}

/* By how much a half differs beyond its noise. */
static double similar_reference(const RetexDenoiseLight *l, int half, size_t p, size_t q)
{
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        const double d = (double)l->half[half][c][p] - l->half[half][c][q], a = l->variance[c][p],
                     b = l->variance[c][q];
        sum += (d * d - (a + fmin(a, b))) / (a + b);
    }
    return falloff(fmax(0, sum / 3));
}

/* Halves and variances of one pixel; counts the weights that are neither 0 nor the spline's. */
static int reference(double to[VALUES], const Input *in, const RetexDenoiseLevel *level, int s, int x, int y)
{
    static const double spline[3] = {0.25, 0.5, 0.25};
    const RetexDenoiseLight *from = &level->from[s];
    const size_t p = denoise_at(x, y);
    double norm[2] = {0}, variance[2][3] = {{0}};
    int between = 0;
    memset(to, 0, sizeof *to * VALUES);
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            const int dx = i * level->step, dy = j * level->step;
            const size_t q = denoise_at(x + dx, y + dy);
            if (!(in->room->valid[q] > 0) || in->kinds[s][p] != in->kinds[s][q])
                continue;
            const double shared = spline[i + 1] * spline[j + 1] * alike_reference(in->room, p, q, dx, dy);
            for (int h = 0; h < 2; h++) {
                const double similar = similar_reference(from, !h, p, q), w = shared * similar;
                between += similar > 0.01 && similar < 0.99 && shared > 1e-3;
                norm[h] += w;
                for (int c = 0; c < 3; c++) {
                    to[3 * h + c] += w * from->half[h][c][q];
                    variance[h][c] += w * w * from->variance[c][q];
                }
            }
        }
    for (int c = 0; c < 3; c++) {
        for (int h = 0; h < 2; h++)
            to[3 * h + c] = norm[h] > 0 ? to[3 * h + c] / norm[h] : from->half[h][c][p];
        to[6 + c] = norm[0] > 0 && norm[1] > 0
                        ? 0.5 * (variance[0][c] / (norm[0] * norm[0]) + variance[1][c] / (norm[1] * norm[1])) +
                              level->epsilons[s]
                        : from->variance[c][p];
    }
    return between;
}

/* Every pixel around the tile that a level is to write, and no other. */
static void test_reference(void **state)
{
    (void)state;
    for (int k = 0; k < DENOISE_LEVELS; k++) {
        Input *in = open_input(11 + (uint32_t)k);
        Lights *is = open_lights();
        const RetexDenoiseLevel level = level_of(in, k, is);
        int between = 0;
        retex_denoise_level_kernel(&level, 0);
        for (int s = 0; s < SIGNALS; s++)
            for (int y = -DENOISE_HALO; y < DENOISE_TILE + DENOISE_HALO; y++)
                for (int x = -DENOISE_HALO; x < DENOISE_TILE + DENOISE_HALO; x++) {
                    const int end = DENOISE_TILE + level.around,
                              inside = x >= -level.around && x < end && y >= -level.around && y < end;
                    double should[VALUES];
                    if (inside)
                        between += reference(should, in, &level, s, x, y);
                    for (int n = 0; n < VALUES; n++) {
                        const float value = is->planes[s][n][denoise_at(x, y)];
                        if (inside ? !(fabs(value - should[n]) < 3e-5) : value != unwritten)
                            fail_msg("level %d, signal %d, plane %d at %d,%d: %g instead of %g", k, s, n, x, y,
                                     (double)value, inside ? should[n] : (double)unwritten);
                    }
                }
        assert_true(between > 10000); /* or nothing was compared */
        free(is);
        close_input(in);
    }
}

/* ---- single pixels ---- */

/* Even light 1 of one kind, all of it valid and alike. */
static Input *even_input(void)
{
    Input *in = open_input(21);
    in->room->features.count = 0;
    for (int i = 0; i < DENOISE_PLANE; i++) {
        in->room->valid[i] = 1;
        for (int s = 0; s < SIGNALS; s++) {
            in->kinds[s][i] = 1;
            for (int c = 0; c < 3; c++) {
                in->lights->of[s].half[0][c][i] = in->lights->of[s].half[1][c][i] = 1;
                in->lights->of[s].variance[c][i] = 0.04f;
            }
        }
    }
    return in;
}

/* A signal that is said to be empty is left as it is. */
static void test_empty_signals(void **state)
{
    (void)state;
    static const unsigned char empty[SIGNALS] = {[1] = 1};
    Input *in = open_input(31);
    Lights *is = open_lights(), *all = open_lights();
    RetexDenoiseLevel level = level_of(in, 0, is);
    const RetexDenoiseLevel of_all = level_of(in, 0, all);
    level.empty = empty;
    retex_denoise_level_kernel(&level, 0);
    retex_denoise_level_kernel(&of_all, 0);
    for (int k = 0; k < VALUES; k++)
        for (int i = 0; i < DENOISE_PLANE; i++)
            all->planes[1][k][i] = unwritten;
    expect_bits(is, all);
    free(is), free(all);
    close_input(in);
}

/* The share of variance that the spline leaves: the sum of its squares, in two axes. */
static void test_variance_falls(void **state)
{
    (void)state;
    const double left = pow((1 + 4 + 1) / 16.0, 2);
    Input *in = even_input();
    Lights *is = open_lights();
    const RetexDenoiseLevel level = level_of(in, 1, is);
    retex_denoise_level_kernel(&level, 0);
    for (int s = 0; s < SIGNALS; s++) {
        assert_float_equal(is->of[s].half[0][0][denoise_at(30, 30)], 1, 1e-6);
        assert_float_equal(is->of[s].variance[1][denoise_at(30, 30)], 0.04 * left + in->epsilons[s], 1e-6);
    }
    free(is);
    close_input(in);
}

/* A pixel that is bright in one half: the other half, not this one, decides that its neighbours take of it. */
static void test_weights_of_the_other_half(void **state)
{
    (void)state;
    Input *in = even_input();
    Lights *is = open_lights();
    const RetexDenoiseLevel level = level_of(in, 0, is);
    for (int c = 0; c < 3; c++)
        in->lights->of[0].half[1][c][denoise_at(30, 30)] = 9;
    retex_denoise_level_kernel(&level, 0);
    for (int c = 0; c < 3; c++) {
        assert_float_equal(is->of[0].half[1][c][denoise_at(31, 30)], 1 + 8 * 2 / 16.0, 1e-5);
        assert_float_equal(is->of[0].half[1][c][denoise_at(30, 30)], 1 + 8 * 4 / 16.0, 1e-5);
        assert_float_equal(is->of[0].half[0][c][denoise_at(31, 30)], 1, 1e-6);
    }
    free(is);
    close_input(in);
}

/* Of another kind, or not valid: such a pixel gives nothing, and one that is alone stays as it is. */
static void test_pixels_that_do_not_count(void **state)
{
    (void)state;
    for (int valid = 0; valid < 2; valid++) {
        Input *in = even_input();
        Lights *is = open_lights();
        const RetexDenoiseLevel level = level_of(in, 0, is);
        const size_t p = denoise_at(30, 30);
        for (int h = 0; h < 2; h++)
            for (int c = 0; c < 3; c++)
                in->lights->of[0].half[h][c][p] = 1.2f;
        if (valid)
            in->kinds[0][p] = -1;
        else
            in->room->valid[p] = 0;
        retex_denoise_level_kernel(&level, 0);
        assert_float_equal(is->of[0].half[0][1][denoise_at(31, 30)], 1, 1e-6);
        assert_float_equal(is->of[0].half[0][1][p], valid ? 1.2 : 1, 1e-6);
        free(is);
        close_input(in);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scalar_and_vector),        cmocka_unit_test(test_reference),
        cmocka_unit_test(test_variance_falls),           cmocka_unit_test(test_weights_of_the_other_half),
        cmocka_unit_test(test_pixels_that_do_not_count), cmocka_unit_test(test_empty_signals),
    };
    return cmocka_run_group_tests_name("denoise_second_kernel", tests, NULL, NULL);
}
