/* The inner loops of denoising: vector and scalar code give the same bits, and the values of the formulas. */
#include "lib_denoise_kernel.h"
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "denoise/falloff.h"

static const int displacements[][2] = {{0, 0}, {1, 0}, {0, -1}, {-3, 7}, {10, 10}, {-10, -10}, {-10, 10}, {5, -4}};
enum { DISPLACEMENTS = sizeof displacements / sizeof *displacements };

static void expect_bits(const float *a, const float *b, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (memcmp(&a[i], &b[i], sizeof *a) != 0)
            fail_msg("value %zu is %a and %a", i, (double)a[i], (double)b[i]);
}

static void test_features_scalar_and_vector(void **state)
{
    (void)state;
    Room *r = open_room(1);
    RetexDenoiseSimilarity *plain = malloc(sizeof *plain);
    for (int k = 0; k < DISPLACEMENTS; k++) {
        const int squared = displacements[k][0] * displacements[k][0] + displacements[k][1] * displacements[k][1];
        memset(plain, 1, sizeof *plain), memset(r->alike, 2, sizeof *r->alike);
        retex_denoise_features_kernel(plain, &r->features, displacements[k][0], displacements[k][1], 1);
        retex_denoise_features_kernel(r->alike, &r->features, displacements[k][0], displacements[k][1], 0);
        expect_bits(plain->strict, r->alike->strict, DENOISE_PIXELS);
        if (squared > 20) /* no candidate reads the others */
            continue;
        expect_bits(plain->valid, r->alike->valid, DENOISE_PIXELS);
        expect_bits(plain->loose, r->alike->loose, DENOISE_PIXELS);
    }
    free(plain);
    free(r);
}

/* What every other displacement weighs is kept. */
static void add_batch(const RetexDenoiseSignal *s, Room *r, Sums *sums, int dx, int dy, int count, int scalar)
{
    RetexDenoiseBatch batch = {.count = count};
    for (int n = 0; n < count; n++) {
        batch.of[n] = (RetexDenoiseDisplacement){dx + n, dy};
        retex_denoise_features_kernel(r->alike + n, &r->features, dx + n, dy, 1);
        batch.alike[n] = r->alike + n;
        batch.weights[n] = (dx + n) % 2 == 0 ? sums->weight[n] : NULL;
    }
    retex_denoise_signal_kernel(s, &batch, scalar);
}

static void expect_same_sums(const Sums *a, const Sums *b)
{
    expect_bits(&a->sum[0][0][0][0], &b->sum[0][0][0][0], sizeof a->sum / sizeof(float));
}

/* Sums go on from batch to batch. */
static void test_signals_scalar_and_vector(void **state)
{
    (void)state;
    static const int batches[][3] = {{0, 0, 1}, {-10, 10, 4}, {7, -10, 4}, {9, 3, 2}, {-3, 7, 3}, {-10, -10, 1}};
    Room *r = open_room(2);
    Sums *plain = calloc(1, sizeof *plain), *vector = calloc(1, sizeof *vector), *single = calloc(1, sizeof *single);
    RetexDenoiseSignal to_plain = signal_of(r, plain), to_vector = signal_of(r, vector),
                       to_single = signal_of(r, single);
    for (int k = 0; k < 6; k++) {
        const int dx = batches[k][0], dy = batches[k][1], count = batches[k][2];
        add_batch(&to_plain, r, plain, dx, dy, count, 1);
        add_batch(&to_vector, r, vector, dx, dy, count, 0);
        for (int n = 0; n < count; n++)
            add_batch(&to_single, r, single, dx + n, dy, 1, 0);
        expect_same_sums(plain, vector);
        expect_same_sums(plain, single);
        expect_bits(plain->weight[0], vector->weight[0], sizeof plain->weight / sizeof(float));
    }
    free(plain), free(vector), free(single), free(r);
}

/* ---- the formulas, pixel by pixel, in double precision ---- */

static double falloff(double x)
{
    return x < 8 ? pow(1 - x / 8, 8) : 0;
}

static double alike_reference(const Room *r, size_t p, size_t q, int dx, int dy, int loose)
{
    double largest = 0;
    for (int g = 0; g < FEATURES; g++) {
        const RetexDenoiseFeature *feature = &r->features.of[g];
        double squares = 0, along = 0;
        for (int k = 0; k < feature->count; k++) {
            double d = (double)r->planes[feature->first + k][q] - r->planes[feature->first + k][p];
            squares += d * d;
            along += feature->normal[0] ? feature->normal[k][p] * d : 0;
        }
        if (feature->normal[0])
            squares = along * along / fmax(1, dx * dx + dy * dy);
        largest = fmax(largest, squares * (loose ? feature->loose : feature->strict)[p]);
    }
    return r->valid[q] * falloff(largest);
}

static void test_features_reference(void **state)
{
    (void)state;
    Room *r = open_room(3);
    for (int k = 0; k < DISPLACEMENTS; k++) {
        const int dx = displacements[k][0], dy = displacements[k][1];
        retex_denoise_features_kernel(r->alike, &r->features, dx, dy, 0);
        for (int y = 0; y < DENOISE_TILE; y++)
            for (int x = 0; x < DENOISE_TILE; x++) {
                size_t p = denoise_at(x, y), q = denoise_at(x + dx, y + dy), i = (size_t)(y * DENOISE_TILE + x);
                assert_true(fabs(r->alike->strict[i] - alike_reference(r, p, q, dx, dy, 0)) < 1e-5);
                if (dx * dx + dy * dy > 20)
                    continue;
                assert_true(r->alike->valid[i] == r->valid[q]);
                assert_true(fabs(r->alike->loose[i] - alike_reference(r, p, q, dx, dy, 1)) < 1e-5);
            }
    }
    free(r);
}

/* How unlike two pixels' surroundings are in one half: the mean over the patch, of pairs of one kind, and over colours,
 * of squared differences beyond what noise explains, in units of it. */
static double distance_reference(const Room *r, const RetexDenoiseSignal *s, int half, int x, int y, int dx, int dy)
{
    double sum = 0, count = 0;
    if (r->kind[denoise_at(x, y)] != r->kind[denoise_at(x + dx, y + dy)])
        return INFINITY;
    for (int v = y - DENOISE_PATCH; v <= y + DENOISE_PATCH; v++)
        for (int u = x - DENOISE_PATCH; u <= x + DENOISE_PATCH; u++) {
            size_t p = denoise_at(u, v), q = denoise_at(u + dx, v + dy);
            if (r->kind[p] != r->kind[q])
                continue;
            count++;
            for (int c = 0; c < 3; c++) {
                double d = (double)r->half[half][c][p] - r->half[half][c][q], a = r->variance[c][p],
                       b = r->variance[c][q];
                sum += (d * d - (a + fmin(a, b))) / (s->epsilon + s->strength * (a + b));
            }
        }
    return fmax(0, sum / (3 * count));
}

/* The first candidate: what it adds to either half, by the weight that the other gives. */
static void test_signals_reference(void **state)
{
    (void)state;
    Room *r = open_room(4);
    for (int i = 0; i < DENOISE_PLANE; i++) /* near enough to each other for weights between 0 and 1 */
        for (int c = 0; c < 3; c++)
            for (int h = 0; h < 2; h++)
                r->half[h][c][i] = 1 + 0.3f * (r->planes[c + 3 * h][i]), r->variance[c][i] = 0.04f * r->modulation[i];
    int between = 0;
    for (int k = 0; k < DISPLACEMENTS; k++) {
        Sums *sums = calloc(1, sizeof *sums);
        RetexDenoiseSignal s = signal_of(r, sums);
        const int dx = displacements[k][0], dy = displacements[k][1];
        const double near = falloff(0.05 * (dx * dx + dy * dy));
        RetexDenoiseBatch batch = {.count = 1, .of = {{dx, dy}}, .alike = {r->alike}, .weights = {sums->weight[0]}};
        for (int i = 0; i < DENOISE_PIXELS; i++)
            r->alike->strict[i] = r->alike->loose[i] = r->alike->valid[i] = 1;
        retex_denoise_signal_kernel(&s, &batch, 0);
        for (int y = 0; y < DENOISE_TILE; y += 3)
            for (int x = 0; x < DENOISE_TILE; x += 3) {
                size_t q = denoise_at(x + dx, y + dy), i = (size_t)(y * DENOISE_TILE + x);
                double w[2];
                for (int h = 0; h < 2; h++) {
                    w[h] = fmin(falloff(distance_reference(r, &s, h, x, y, dx, dy)), near);
                    between += w[h] > 0.01 && w[h] < 0.99 * near;
                }
                for (int h = 0; h < 2; h++) {
                    double part = w[1 - h] * r->modulation[q];
                    assert_true(fabs(sums->sum[0][h][3][i] - part) < 1e-4);
                    for (int c = 0; c < 3; c++)
                        assert_true(fabs(sums->sum[0][h][c][i] - part * r->half[h][c][q]) < 2e-4);
                }
                assert_true(fabs(sums->weight[0][i] - 0.5 * (w[0] + w[1])) < 1e-4);
            }
        free(sums);
    }
    assert_true(between > 500); /* or nothing was compared */
    free(r);
}

/* Images are filtered with the weights that they are given, and sums go on from call to call: also of a number of
 * displacements that is no multiple of what one loop takes. */
static void test_images(void **state)
{
    (void)state;
    static const RetexDenoiseDisplacement of[DENOISE_BATCH + 3] = {{-4, 6}, {-10, 10}, {3, -7}, {10, -1},
                                                                   {-1, 2}, {0, 0},    {0, -10}};
    enum { COUNT = sizeof of / sizeof *of };
    Room *r = open_room(6);
    Sums *plain = calloc(1, sizeof *plain), *vector = calloc(1, sizeof *vector);
    const RetexDenoiseImages to_plain = images_of(r, plain), to_vector = images_of(r, vector);
    const float *weights[COUNT];
    for (int n = 0; n < COUNT; n++)
        weights[n] = r->half[0][0] + 64 * n; /* any */
    retex_denoise_images_kernel(&to_plain, of, weights, COUNT, 1);
    retex_denoise_images_kernel(&to_vector, of, weights, 4, 0);
    retex_denoise_images_kernel(&to_vector, of + 4, weights + 4, COUNT - 4, 0);
    expect_bits(plain->images[0], vector->images[0], sizeof plain->images / sizeof(float));
    for (int k = 0; k < IMAGES; k++)
        for (int i = 0; i < DENOISE_PIXELS; i += 7) {
            double sum = 0, size = 0;
            for (int n = 0; n < COUNT; n++) {
                const size_t q = denoise_at(i % DENOISE_TILE + of[n].dx, i / DENOISE_TILE + of[n].dy);
                sum += (double)weights[n][i] * (double)r->images[k][q];
                size += fabs((double)weights[n][i] * (double)r->images[k][q]);
            }
            assert_true(fabs(plain->images[k][i] - sum) <= 1e-5 * size);
        }
    free(plain), free(vector), free(r);
}

/* All but the first candidate look no further than a squared distance of 20, also in a batch that goes further. */
static void test_reach_of_candidates(void **state)
{
    (void)state;
    static const RetexDenoiseDisplacement all[] = {{4, 2}, {-1, 3}, {4, 3}, {0, -5}};
    for (int from = 0; from <= 2; from++) {
        Room *r = open_room(5);
        Sums *sums = calloc(1, sizeof *sums);
        RetexDenoiseSignal s = signal_of(r, sums);
        RetexDenoiseBatch batch = {.count = DENOISE_BATCH - from};
        s.strength = 1e9f; /* all is alike */
        for (int i = 0; i < DENOISE_PIXELS; i++)
            r->alike->strict[i] = r->alike->loose[i] = r->alike->valid[i] = 1;
        for (int i = 0; i < DENOISE_PLANE; i++)
            r->kind[i] = r->modulation[i] = 1;
        for (int n = 0; n < batch.count; n++)
            batch.of[n] = all[from + n], batch.alike[n] = r->alike;
        retex_denoise_signal_kernel(&s, &batch, 0);
        for (int k = 0; k < DENOISE_CANDIDATES; k++) {
            double weight = 0;
            for (int n = 0; n < batch.count; n++) {
                const int squared = batch.of[n].dx * batch.of[n].dx + batch.of[n].dy * batch.of[n].dy;
                weight += k == 0 ? falloff(0.05 * squared) : squared <= 20 ? falloff(0.1 * squared) : 0;
            }
            assert_float_equal(sums->sum[k][0][3][0], weight, 1e-5);
        }
        free(sums);
        free(r);
    }
}

static void test_reciprocal(void **state)
{
    (void)state;
    for (int e = -35; e <= 36; e++)
        for (int k = 0; k < 1000; k++) {
            const float x = (float)pow(10, e + k / 1000.0);
            assert_true(fabs(denoise_reciprocal(x) * (double)x - 1) < 1e-5);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_features_scalar_and_vector),
        cmocka_unit_test(test_signals_scalar_and_vector),
        cmocka_unit_test(test_features_reference),
        cmocka_unit_test(test_signals_reference),
        cmocka_unit_test(test_images),
        cmocka_unit_test(test_reach_of_candidates),
        cmocka_unit_test(test_reciprocal),
    };
    return cmocka_run_group_tests_name("denoise_kernel", tests, NULL, NULL);
}
