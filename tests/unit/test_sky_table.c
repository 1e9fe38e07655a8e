/* The table of the sky: sampling by a guide gives the cells that a search of all sums gives. */
#include <float.h>
#include <stdlib.h>
#include "lib_test.h"
#include <cmocka.h>
#include "light/sky_table.h"

#define WIDTH SKY_TABLE_WIDTH
#define HEIGHT SKY_TABLE_HEIGHT
#define BELOW_1 (1 - 0x1p-24f) /* the largest random number */

/* Skies that are hard to search. */
enum { EVEN, NOISE, DECADES, DARK_ROWS, SPARSE, SUN, SUN_AND_NOISE, LAST_CELL, NKINDS };

static float luminance(int kind, int x, int y, uint32_t *state)
{
    const int is_sun = x == 700 && y == 131;
    const double u = test_random(state);
    switch (kind) {
    case NOISE:
        return (float)u;
    case DECADES:
        return (float)pow(10, 8 * u - 4);
    case DARK_ROWS:
        return y % 7 < 3 || y < 40 || y > 300 ? 0 : (float)u;
    case SPARSE:
        return u < 0.01 ? 1 : 0;
    case SUN:
        return (float)is_sun;
    case SUN_AND_NOISE:
        return is_sun ? 1e5f : (float)u;
    case LAST_CELL:
        return x == WIDTH - 1 && y == HEIGHT - 1;
    default:
        return 2;
    }
}

/* Running sums as shares, and searching them, as plainly as can be. */
static void find_shares(const double *values, int count, float *shares)
{
    double sum = 0;
    shares[0] = 0;
    for (int k = 0; k < count; k++)
        shares[k + 1] = (float)(sum += values[k]);
    const float total = shares[count];
    for (int k = 1; k < count; k++)
        shares[k] = total > 0 ? shares[k] / total : (float)k / (float)count;
    shares[count] = 1;
}

static int search(const float *shares, int count, float u)
{
    int k = count - 1;
    while (k > 0 && shares[k] > u)
        k--;
    return k;
}

static double area(int y)
{
    return (cos(PI * y / HEIGHT) - cos(PI * (y + 1) / HEIGHT)) * 2 * PI / WIDTH;
}

typedef struct Reference {
    float rows[HEIGHT + 1], cells[HEIGHT][WIDTH + 1];
    double total;
} Reference;

static void set_reference(Reference *r, const float *luminances)
{
    double row[WIDTH], sums[HEIGHT];
    r->total = 0;
    for (int y = 0; y < HEIGHT; y++) {
        sums[y] = 0;
        for (int x = 0; x < WIDTH; x++)
            sums[y] += row[x] = (double)luminances[y * WIDTH + x];
        find_shares(row, WIDTH, r->cells[y]);
        r->total += sums[y] *= area(y);
    }
    find_shares(sums, HEIGHT, r->rows);
}

/* Random numbers, those at which sums and steps of the guide lie, and those just below. */
static float number(const float *shares, int count, uint32_t *state)
{
    const double which = test_random(state), u = test_random(state);
    const float at = which < 0.4   ? (float)u
                     : which < 0.7 ? shares[(int)(u * (count + 1))]
                     : which < 0.9 ? (float)(int)(u * 1025) / 1024
                                   : (float)((int)(u * 3) - 1);
    return fminf(fmaxf(test_random(state) < 0.5 ? at : at - 0x1p-24f, 0), BELOW_1);
}

static double share_below(const float *shares, int k, float u)
{
    const float width = shares[k + 1] - shares[k];
    return width > 0 ? (double)((u - shares[k]) / width) : 0.5;
}

static void expect_sample(const Reference *r, const SkyTable *table, const float *luminances, float u1, float u2)
{
    const int y = search(r->rows, HEIGHT, u2), x = search(r->cells[y], WIDTH, u1);
    const double top = cos(PI * y / HEIGHT), bottom = cos(PI * (y + 1) / HEIGHT);
    const double c = top + (bottom - top) * share_below(r->rows, y, u2), s = sqrt(fmax(0, 1 - c * c)),
                 phi = 2 * PI * (x + share_below(r->cells[y], x, u1)) / WIDTH;
    const float wanted = (float)((double)luminances[y * WIDTH + x] / r->total);
    float pdf;
    sky_table_prefetch(table, &u1, &u2, 1);
    const Vec3 d = sky_table_sample(table, u1, u2, &pdf);
    if (!(fabs(d.x - s * cos(phi)) < 1e-12 && fabs(d.y - c) < 1e-12 && fabs(d.z - s * sin(phi)) < 1e-12) ||
        !(fabsf(pdf - wanted) <= 2 * FLT_EPSILON * wanted))
        fail_msg("%.9g %.9g: not cell %d %d, but %g %g %g, density %g and not %g", (double)u1, (double)u2, x, y, d.x,
                 d.y, d.z, (double)pdf, (double)wanted);
    if (x > 0 && x < WIDTH - 1 && share_below(r->cells[y], x, u1) > 1e-3 && share_below(r->rows, y, u2) > 1e-3 &&
        share_below(r->cells[y], x, u1) < 0.999 && share_below(r->rows, y, u2) < 0.999)
        assert_true(sky_table_pdf(table, d) == pdf);
}

static double mean_up_to(const float *luminances, double most)
{
    double sum = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            sum += fmin((double)luminances[y * WIDTH + x], most) * area(y);
    return sum / (4 * PI);
}

/* What is left of luminances for light samples: half of the mean is left out, in which none counts above the mean; at
 * least a tenth stays, so that all of the sky that is not black is sampled. */
static void leave_out(float *luminances)
{
    const float half = 0.5f * (float)mean_up_to(luminances, (double)(float)mean_up_to(luminances, INFINITY));
    for (int k = 0; k < WIDTH * HEIGHT; k++)
        luminances[k] = fmaxf(luminances[k] - half, 0.1f * luminances[k]);
}

static void guide_finds_the_same_cells(void **unused)
{
    float *luminances = malloc(sizeof(float) * WIDTH * HEIGHT);
    Reference *r = malloc(sizeof *r);
    uint32_t state = 17;
    (void)unused;
    assert_true(luminances && r);
    for (int n = 0; n < 2 * NKINDS; n++) {
        const int kind = n / 2, for_mis = n % 2;
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++)
                luminances[y * WIDTH + x] = luminance(kind, x, y, &state);
        SkyTable *table = sky_table_create(luminances, for_mis);
        assert_non_null(table);
        assert_true(fabs((double)sky_table_mean(table) / mean_up_to(luminances, INFINITY) - 1) < 1e-6);
        if (for_mis)
            leave_out(luminances);
        set_reference(r, luminances);
        for (int k = 0; k < 50000; k++) {
            const float u2 = number(r->rows, HEIGHT, &state);
            expect_sample(r, table, luminances, number(r->cells[search(r->rows, HEIGHT, u2)], WIDTH, &state), u2);
        }
        sky_table_close(&table);
        assert_null(table);
    }
    free(luminances);
    free(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(guide_finds_the_same_cells),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
