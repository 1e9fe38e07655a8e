/* The inner loops of denoising: vector and plain code give the same bits, and what the formulas say. */
#include "denoise_kernel.h"
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PLANES = 9, GROUPS = 4, IMAGES = 6 };

static const int displacements[][2] = {{0, 0}, {1, 0}, {0, -1}, {-3, 7}, {10, 10}, {-10, -10}, {-10, 10}, {5, -4}};
enum { DISPLACEMENTS = sizeof displacements / sizeof *displacements };

/* What both kernels read, of random numbers. */
typedef struct Room {
    float planes[PLANES][DENOISE_PLANE], scales[2 * GROUPS][DENOISE_PLANE], valid[DENOISE_PLANE];
    float half[2][3][DENOISE_PLANE], variance[3][DENOISE_PLANE], kind[DENOISE_PLANE], modulation[DENOISE_PLANE];
    float images[IMAGES][DENOISE_PLANE], scratch[DENOISE_SCRATCH];
    const float *image_planes[IMAGES];
    DenoiseFeatures features;
    DenoiseAlike alike;
} Room;

/* What the signal kernel writes. */
typedef struct Sums {
    float sum[DENOISE_CANDIDATES][2][4][DENOISE_PIXELS], images[IMAGES][DENOISE_PIXELS], weight[DENOISE_PIXELS];
    float *image_sums[IMAGES];
} Sums;

static void fill(float *plane, double low, double high, uint32_t *seed)
{
    for (int i = 0; i < DENOISE_PLANE; i++)
        plane[i] = (float)(low + (high - low) * test_random(seed));
}

/* Three groups of features and one of positions; weights from 0 to 1 come of it. */
static Room *open_room(uint32_t seed)
{
    static const int counts[GROUPS] = {3, 1, 3, 2};
    Room *r = calloc(1, sizeof *r);
    int first = 0;
    for (int k = 0; k < PLANES; k++) {
        fill(r->planes[k], -1, 1, &seed);
        r->features.planes[k] = r->planes[k];
    }
    for (int k = 0; k < GROUPS; k++) {
        fill(r->scales[2 * k], 0.1, 3, &seed);
        fill(r->scales[2 * k + 1], 0.01, 0.3, &seed);
        r->features.groups[k] = (DenoiseGroup){
            .first = first, .count = counts[k], .strict = r->scales[2 * k], .loose = r->scales[2 * k + 1]};
        first += counts[k];
    }
    for (int k = 0; k < 3; k++)
        r->features.groups[2].normal[k] = r->planes[k];
    r->features.ngroups = GROUPS;
    r->features.valid = r->valid;
    for (int h = 0; h < 2; h++)
        for (int c = 0; c < 3; c++)
            fill(r->half[h][c], 0, 2, &seed);
    for (int c = 0; c < 3; c++)
        fill(r->variance[c], 0, 0.5, &seed);
    fill(r->modulation, 0.02, 1, &seed);
    for (int i = 0; i < DENOISE_PLANE; i++) {
        r->valid[i] = test_random(&seed) < 0.9;
        r->kind[i] = test_random(&seed) < 0.9 ? 1 : -1;
        if (test_random(&seed) < 0.1) /* dark */
            for (int c = 0; c < 3; c++)
                r->half[0][c][i] = r->half[1][c][i] = r->variance[c][i] = 0;
        if (test_random(&seed) < 0.01)
            r->half[0][1][i] *= 1e20f;
    }
    for (int k = 0; k < IMAGES; k++) {
        fill(r->images[k], 0, 1, &seed);
        r->image_planes[k] = r->images[k];
    }
    return r;
}

static DenoiseSignal signal_of(Room *r, Sums *sums)
{
    DenoiseSignal s = {.kind = r->kind,
                       .modulation = r->modulation,
                       .epsilon = 1e-6f,
                       .strength = 0.2f,
                       .nplanes = IMAGES,
                       .planes = r->image_planes,
                       .sums = sums->image_sums,
                       .scratch = r->scratch};
    for (int c = 0; c < 3; c++) {
        s.variance[c] = r->variance[c];
        s.half[0][c] = r->half[0][c], s.half[1][c] = r->half[1][c];
    }
    for (int k = 0; k < DENOISE_CANDIDATES; k++)
        for (int h = 0; h < 2; h++) {
            s.candidates[k].norm[h] = sums->sum[k][h][3];
            for (int c = 0; c < 3; c++)
                s.candidates[k].sum[h][c] = sums->sum[k][h][c];
        }
    for (int k = 0; k < IMAGES; k++)
        sums->image_sums[k] = sums->images[k];
    return s;
}

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
    DenoiseAlike *plain = malloc(sizeof *plain);
    for (int k = 0; k < DISPLACEMENTS; k++) {
        memset(plain, 1, sizeof *plain), memset(&r->alike, 2, sizeof r->alike);
        denoise_features_kernel(plain, &r->features, displacements[k][0], displacements[k][1], 1);
        denoise_features_kernel(&r->alike, &r->features, displacements[k][0], displacements[k][1], 0);
        expect_bits(plain->valid, r->alike.valid, DENOISE_PIXELS);
        expect_bits(plain->strict, r->alike.strict, DENOISE_PIXELS);
        expect_bits(plain->loose, r->alike.loose, DENOISE_PIXELS);
    }
    free(plain);
    free(r);
}

/* Sums go on from displacement to displacement. */
static void test_signals_scalar_and_vector(void **state)
{
    (void)state;
    for (int images = 0; images <= IMAGES; images += 3) {
        Room *r = open_room(2);
        Sums *plain = calloc(1, sizeof *plain), *vector = calloc(1, sizeof *vector);
        DenoiseSignal to_plain = signal_of(r, plain), to_vector = signal_of(r, vector);
        to_plain.nplanes = to_vector.nplanes = images;
        for (int k = 0; k < DISPLACEMENTS; k++) {
            const int dx = displacements[k][0], dy = displacements[k][1], kept = k % 3 > 0;
            denoise_features_kernel(&r->alike, &r->features, dx, dy, 1);
            denoise_signal_kernel(&to_plain, &r->alike, dx, dy, kept ? plain->weight : NULL, 1);
            denoise_signal_kernel(&to_vector, &r->alike, dx, dy, kept ? vector->weight : NULL, 0);
            expect_bits(&plain->sum[0][0][0][0], &vector->sum[0][0][0][0], sizeof plain->sum / sizeof(float));
            expect_bits(&plain->images[0][0], &vector->images[0][0], sizeof plain->images / sizeof(float));
            expect_bits(plain->weight, vector->weight, DENOISE_PIXELS);
        }
        free(plain), free(vector), free(r);
    }
}

/* ---- the formulas, pixel by pixel, in double precision ---- */

static double falloff(double x)
{
    return x < 8 ? pow(1 - x / 8, 8) : 0;
}

static double alike_reference(const Room *r, size_t p, size_t q, int dx, int dy, int loose)
{
    double largest = 0;
    for (int g = 0; g < GROUPS; g++) {
        const DenoiseGroup *group = &r->features.groups[g];
        double squares = 0, along = 0;
        for (int k = 0; k < group->count; k++) {
            double d = (double)r->planes[group->first + k][q] - r->planes[group->first + k][p];
            squares += d * d;
            along += group->normal[0] ? group->normal[k][p] * d : 0;
        }
        if (group->normal[0])
            squares = along * along / fmax(1, dx * dx + dy * dy);
        largest = fmax(largest, squares * (loose ? group->loose : group->strict)[p]);
    }
    return r->valid[q] * falloff(largest);
}

static void test_features_reference(void **state)
{
    (void)state;
    Room *r = open_room(3);
    for (int k = 0; k < DISPLACEMENTS; k++) {
        const int dx = displacements[k][0], dy = displacements[k][1];
        denoise_features_kernel(&r->alike, &r->features, dx, dy, 0);
        for (int y = 0; y < DENOISE_TILE; y++)
            for (int x = 0; x < DENOISE_TILE; x++) {
                size_t p = denoise_at(x, y), q = denoise_at(x + dx, y + dy), i = (size_t)(y * DENOISE_TILE + x);
                assert_true(r->alike.valid[i] == r->valid[q]);
                assert_true(fabs(r->alike.strict[i] - alike_reference(r, p, q, dx, dy, 0)) < 1e-5);
                assert_true(fabs(r->alike.loose[i] - alike_reference(r, p, q, dx, dy, 1)) < 1e-5);
            }
    }
    free(r);
}

/* How unlike two pixels' surroundings are in one half: the mean over the patch, of pairs of one kind, and over colours,
 * of squared differences beyond what noise explains, in units of it. */
static double distance_reference(const Room *r, const DenoiseSignal *s, int half, int x, int y, int dx, int dy)
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
        DenoiseSignal s = signal_of(r, sums);
        const int dx = displacements[k][0], dy = displacements[k][1];
        const double near = falloff(0.05 * (dx * dx + dy * dy));
        denoise_features_kernel(&r->alike, &r->features, dx, dy, 0);
        for (int i = 0; i < DENOISE_PIXELS; i++)
            r->alike.strict[i] = 1;
        denoise_signal_kernel(&s, &r->alike, dx, dy, sums->weight, 0);
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
                assert_true(fabs(sums->weight[i] - 0.5 * (w[0] + w[1])) < 1e-4);
                for (int n = 0; n < IMAGES; n++)
                    assert_true(fabs(sums->images[n][i] - 0.5 * (w[0] + w[1]) * r->images[n][q]) < 1e-4);
            }
        free(sums);
    }
    assert_true(between > 500); /* or nothing was compared */
    free(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_features_scalar_and_vector),
        cmocka_unit_test(test_signals_scalar_and_vector),
        cmocka_unit_test(test_features_reference),
        cmocka_unit_test(test_signals_reference),
    };
    return cmocka_run_group_tests_name("denoise_kernel", tests, NULL, NULL);
}
