/* The bands of a film, while many threads write to them at once. `make tsan` checks this for data races. */
#include "lib_test.h"
#include <cmocka.h>
#include <retex/parallel.h>
#include "film/bands.h"

enum { WIDTH = 40, HEIGHT = 2 * BAND_LINES + 5, ROUNDS = 20, THREADS = 4, IMAGES = 3 };

typedef struct Work {
    Bands *bands;
    int images[IMAGES], failed;
} Work;

static float value_at(int image, int x, int y)
{
    return (float)(1 + image + 10 * x + 1000 * y);
}

/* Two columns of one band, as the tiles of a band are: each opens the band anew. */
static void fill_columns(void *context, int job, int thread)
{
    Work *work = context;
    int band = job * 2 / WIDTH, x0 = job * 2 % WIDTH;

    (void)thread;
    for (int y = band * BAND_LINES; y < (band + 1) * BAND_LINES && y < HEIGHT; y++)
        for (int x = x0; x < x0 + 2; x++) {
            BandRows *rows = bands_open(work->bands, band);
            if (!rows) {
                work->failed = 1;
                return;
            }
            for (int k = 0; k < IMAGES; k++)
                *bands_pixel(rows, work->images[k], x, y) = value_at(k, x, y);
        }
}

static void threads_share_a_band(void **state)
{
    RetexError err = {0};

    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        Work work = {0};
        test_must(bands_create(&work.bands, WIDTH, HEIGHT, NULL, 1, &err), &err);
        for (int k = 0; k < IMAGES; k++)
            test_must(bands_add(work.bands, k ? "again" : "first", "R", RETEX_FLOAT, &work.images[k], &err), &err);
        retex_parallel(THREADS, bands_count(work.bands) * WIDTH / 2, fill_columns, &work);
        assert_false(work.failed);
        for (int band = 0; band < bands_count(work.bands); band++) {
            BandRows *rows = bands_open(work.bands, band);
            for (int y = band * BAND_LINES; y < (band + 1) * BAND_LINES && y < HEIGHT; y++)
                for (int x = 0; x < WIDTH; x++)
                    for (int k = 0; k < IMAGES; k++)
                        assert_true(*bands_pixel(rows, work.images[k], x, y) == value_at(k, x, y));
            test_must(bands_finish(rows, &err), &err);
        }
        bands_close(&work.bands);
    }
}

/* An image is filled by any one number, the very first and the very last of a band too. */
static void one_number_fills_an_image(void **state)
{
    RetexError err = {0};

    (void)state;
    for (int last = 0; last < 2; last++)
        for (int band = 0; band < 3; band++) {
            Bands *bands;
            int none, one, y = band * BAND_LINES, end = y + BAND_LINES < HEIGHT ? y + BAND_LINES : HEIGHT;
            test_must(bands_create(&bands, WIDTH, HEIGHT, NULL, 1, &err), &err);
            test_must(bands_add(bands, "none", "RGB", RETEX_FLOAT, &none, &err), &err);
            test_must(bands_add(bands, "one", "RGB", RETEX_FLOAT, &one, &err), &err);
            BandRows *rows = bands_open(bands, band);
            float *zero = bands_pixel(rows, none, 0, y),
                  *pixel = last ? bands_pixel(rows, one, WIDTH - 1, end - 1) : bands_pixel(rows, one, 0, y);
            zero[0] = 0, pixel[last ? 2 : 0] = 1;
            test_must(bands_finish(rows, &err), &err);
            assert_int_equal(bands_is_empty(bands, none), 1);
            assert_int_equal(bands_is_empty(bands, one), 0);
            bands_close(&bands);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(threads_share_a_band),
                                       cmocka_unit_test(one_number_fills_an_image)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
