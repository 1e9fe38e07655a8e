/* Fireflies of a tile: which halves of pixels are lowered, and how far. */
#include "denoise/fireflies.h"
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RADIUS = 5 };

/* A tile with what lies around it. */
typedef struct Tile {
    float half[2][3][DENOISE_PLANE], kept[2][DENOISE_PLANE], kind[DENOISE_PLANE], valid[DENOISE_PLANE];
} Tile;

/* Of even light; by colour 1, 2 and 4 times this. */
static Tile *even_tile(float light)
{
    Tile *t = malloc(sizeof *t);
    for (int i = 0; i < DENOISE_PLANE; i++) {
        t->kind[i] = t->valid[i] = 1;
        for (int h = 0; h < 2; h++)
            for (int c = 0; c < 3; c++)
                t->half[h][c][i] = light * (float)(1 << c);
    }
    return t;
}

static void brighten(Tile *t, int half, int x, int y, float by)
{
    for (int c = 0; c < 3; c++)
        t->half[half][c][denoise_at(x, y)] *= by;
}

static void lower_unknown(Tile *t, float unknown)
{
    float *half[2][3], *kept[2] = {t->kept[0], t->kept[1]};
    for (int h = 0; h < 2; h++)
        for (int c = 0; c < 3; c++)
            half[h][c] = t->half[h][c];
    retex_denoise_lower_fireflies(half, kept, t->kind, t->valid, unknown);
}

static void lower(Tile *t)
{
    lower_unknown(t, 0);
}

/* A half of a pixel has so many times the light 1, and this share of what it had. */
static void expect_light(const Tile *t, int half, int x, int y, float light, float kept)
{
    const size_t p = denoise_at(x, y);
    assert_float_equal(t->kept[half][p], kept, 1e-6 * kept);
    for (int c = 0; c < 3; c++)
        assert_float_equal(t->half[half][c][p], light * (float)(1 << c), 1e-5 * light);
}

/* Halves of which less than all is left. */
static int count_lowered(const Tile *t)
{
    int count = 0;
    for (int h = 0; h < 2; h++)
        for (int i = 0; i < DENOISE_PLANE; i++)
            count += t->kept[h][i] != 1;
    return count;
}

/* In each half, in every colour by the same share; and at the corners of the planes, which end there. */
static void test_a_lone_spike(void **state)
{
    (void)state;
    static const int places[][2] = {{30, 20},
                                    {0, 63},
                                    {-DENOISE_HALO, -DENOISE_HALO},
                                    {DENOISE_PITCH - DENOISE_HALO - 1, DENOISE_TILE + DENOISE_HALO - 1}};
    for (int k = 0; k < 4; k++)
        for (int half = 0; half < 2; half++) {
            Tile *t = even_tile(1);
            brighten(t, half, places[k][0], places[k][1], 100);
            lower(t);
            expect_light(t, half, places[k][0], places[k][1], 2, 0.02f);
            expect_light(t, !half, places[k][0], places[k][1], 1, 1);
            assert_int_equal(count_lowered(t), 1);
            free(t);
        }
}

static void test_what_is_less_than_twice_as_bright_is_kept(void **state)
{
    (void)state;
    Tile *t = even_tile(1);
    brighten(t, 0, 10, 10, 1.99f);
    brighten(t, 1, 40, 10, 2.02f);
    lower(t);
    expect_light(t, 0, 10, 10, 1.99f, 1);
    expect_light(t, 1, 40, 10, 2, 2 / 2.02f);
    assert_int_equal(count_lowered(t), 1);
    free(t);
}

/* Twice the third largest half around is the limit: up to three spikes beside each other are lowered, four stay. */
static void test_spikes_support_each_other(void **state)
{
    (void)state;
    static const float bright[] = {100, 90, 80, 70};
    for (int count = 1; count <= 4; count++) {
        Tile *t = even_tile(1);
        for (int k = 0; k < count; k++)
            brighten(t, k % 2, 20 + k, 20 + k % 2, bright[k]);
        lower(t);
        for (int k = 0; k < count; k++)
            expect_light(t, k % 2, 20 + k, 20 + k % 2, count < 4 ? 2 : bright[k], count < 4 ? 2 / bright[k] : 1);
        assert_int_equal(count_lowered(t), count < 4 ? count : 0);
        free(t);
    }
}

/* Neighbours count up to RADIUS pixels away, in rows and columns, as they were before any was lowered. */
static void test_how_far_neighbours_count(void **state)
{
    (void)state;
    for (int far = RADIUS; far <= RADIUS + 1; far++)
        for (int vertical = 0; vertical < 2; vertical++) {
            Tile *t = even_tile(1);
            for (int h = 0; h < 2; h++)
                brighten(t, h, 30 + (vertical ? 0 : far), 30 + (vertical ? far : 0), 60);
            brighten(t, 0, 30 - (vertical ? 0 : RADIUS), 30 - (vertical ? RADIUS : 0), 50);
            brighten(t, 1, 30, 30, 100);
            lower(t);
            expect_light(t, 1, 30, 30, far == RADIUS ? 100 : 2, far == RADIUS ? 1 : 0.02f);
            free(t);
        }
}

/* Both halves saw it: that is light of the scene, unless the other half is so small that it is not known. */
static void test_a_spike_in_both_halves(void **state)
{
    (void)state;
    static const struct {
        float unknown, other, left, other_left;
    } cases[] = {{0, 100, 100, 100},    {0, 60, 100, 60},       {0, 3, 100, 3},
                 {0, 1.5f, 2, 1.5f},    {0.125f, 60, 100, 60},  {0.125f, 12.6f, 100, 12.6f},
                 {0.125f, 12.4f, 2, 2}, {0.125f, 1.5f, 2, 1.5f}};
    for (int k = 0; k < 8; k++)
        for (int half = 0; half < 2; half++) {
            Tile *t = even_tile(1);
            brighten(t, half, 30, 30, 100);
            brighten(t, !half, 30, 30, cases[k].other);
            lower_unknown(t, cases[k].unknown);
            expect_light(t, half, 30, 30, cases[k].left, cases[k].left / 100);
            expect_light(t, !half, 30, 30, cases[k].other_left, cases[k].other_left / cases[k].other);
            free(t);
        }
}

/* Pixels of another kind, or outside of the picture, do not support; outside of it nothing is lowered. */
static void test_pixels_that_do_not_count(void **state)
{
    (void)state;
    for (int valid = 0; valid < 2; valid++) {
        Tile *t = even_tile(1);
        brighten(t, 0, 30, 30, 100);
        for (int n = 0; n < 9; n++)
            if (n != 4) {
                const int x = 29 + n % 3, y = 29 + n / 3;
                for (int h = 0; h < 2; h++)
                    brighten(t, h, x, y, 90);
                (valid ? t->kind : t->valid)[denoise_at(x, y)] = valid ? -1 : 0;
            }
        t->valid[denoise_at(10, 10)] = 0;
        brighten(t, 1, 10, 10, 100);
        lower(t);
        expect_light(t, 0, 30, 30, 2, 0.02f);
        expect_light(t, 1, 10, 10, 100, 1);
        assert_int_equal(count_lowered(t), 1);
        free(t);
    }
}

/* Where nothing around has light, nothing tells how much of it is right. Two such halves are no more. */
static void test_a_spike_among_zeros(void **state)
{
    (void)state;
    for (int supports = 0; supports <= 3; supports++) {
        Tile *t = even_tile(0);
        for (int k = 0; k < supports; k++)
            t->half[1][1][denoise_at(31 + k, 30)] = 1;
        t->half[0][1][denoise_at(30, 30)] = 100;
        lower(t);
        assert_float_equal(t->half[0][1][denoise_at(30, 30)], supports < 3 ? 100 : 2, 1e-5);
        assert_int_equal(count_lowered(t), supports == 3);
        free(t);
    }
}

/* ---- by sorting ---- */

static int falling(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x < y) - (x > y);
}

static float brightness(const Tile *t, int half, size_t p)
{
    return t->half[half][0][p] + t->half[half][1][p] + t->half[half][2][p];
}

/* The limit of a half that is a firefly, or 0. */
static float limit_reference(const Tile *t, int half, int x, int y, float unknown)
{
    const size_t p = denoise_at(x, y);
    const float value = brightness(t, half, p), other = brightness(t, !half, p);
    float around[2 * (2 * RADIUS + 1) * (2 * RADIUS + 1)] = {0};
    int count = 0;
    for (int v = y - RADIUS; v <= y + RADIUS; v++)
        for (int u = x - RADIUS; u <= x + RADIUS; u++) {
            const int in_planes = u >= -DENOISE_HALO && u < DENOISE_PITCH - DENOISE_HALO && v >= -DENOISE_HALO &&
                                  v < DENOISE_TILE + DENOISE_HALO;
            const size_t q = in_planes ? denoise_at(u, v) : p;
            if (q != p && t->valid[q] > 0 && t->kind[q] == t->kind[p])
                around[count++] = brightness(t, 0, q), around[count++] = brightness(t, 1, q);
        }
    qsort(around, (size_t)count, sizeof *around, falling);
    const float limit = 2 * around[2];
    const int is_brighter = value > 2 * other && value > limit, is_sure = limit > other || other < unknown * value;
    return t->valid[p] > 0 && is_brighter && is_sure ? limit : 0;
}

/* The share of a half that stays. */
static float kept_reference(const Tile *t, int half, int x, int y, float unknown)
{
    const float own = limit_reference(t, half, x, y, unknown), others = limit_reference(t, !half, x, y, unknown),
                limit = own > 0 ? own : others, value = brightness(t, half, denoise_at(x, y));
    return limit > 0 && value > limit ? limit / value : 1;
}

/* Light of many sizes, of two kinds, with and without pixels that do not count. */
static Tile *random_tile(uint32_t seed)
{
    Tile *t = even_tile(1);
    const double valid = seed % 2 ? 0.9 : 0.1;
    for (int i = 0; i < DENOISE_PLANE; i++) {
        t->kind[i] = test_random(&seed) < 0.7 ? 1 : -1;
        t->valid[i] = test_random(&seed) < valid;
        for (int h = 0; h < 2; h++)
            for (int c = 0; c < 3; c++) {
                const double u = test_random(&seed);
                t->half[h][c][i] = test_random(&seed) < 0.2 ? 0 : (float)exp(12 * pow(u, 8));
            }
    }
    return t;
}

static void test_as_sorted(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 4; seed++) {
        Tile *before = random_tile(seed), *t = random_tile(seed);
        const float unknown = seed > 2 ? DENOISE_UNKNOWN_HALF : 0;
        int lowered = 0;
        lower_unknown(t, unknown);
        for (int h = 0; h < 2; h++)
            for (int y = -DENOISE_HALO; y < DENOISE_TILE + DENOISE_HALO; y++)
                for (int x = -DENOISE_HALO; x < DENOISE_PITCH - DENOISE_HALO; x++) {
                    const size_t p = denoise_at(x, y);
                    const float kept = kept_reference(before, h, x, y, unknown);
                    lowered += kept < 1;
                    if (t->kept[h][p] != kept)
                        fail_msg("half %d at %d,%d: %g is left instead of %g", h, x, y, (double)t->kept[h][p],
                                 (double)kept);
                    for (int c = 0; c < 3; c++)
                        assert_true(t->half[h][c][p] == before->half[h][c][p] * kept);
                }
        print_message("# %d halves are lowered\n", lowered);
        assert_true(lowered > 100); /* or nothing was compared */
        free(before), free(t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_lone_spike),
        cmocka_unit_test(test_what_is_less_than_twice_as_bright_is_kept),
        cmocka_unit_test(test_spikes_support_each_other),
        cmocka_unit_test(test_how_far_neighbours_count),
        cmocka_unit_test(test_a_spike_in_both_halves),
        cmocka_unit_test(test_pixels_that_do_not_count),
        cmocka_unit_test(test_a_spike_among_zeros),
        cmocka_unit_test(test_as_sorted),
    };
    return cmocka_run_group_tests_name("denoise_fireflies", tests, NULL, NULL);
}
