/* Control variates: moments are compared with sums by hand, and estimates with known results. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>
#include "render/control_variate.h"
#include "lib_test.h"

enum { WIDTH = 8, HEIGHT = 6, SAMPLES = 10 };

static void expect(double value, double wanted, double tolerance, const char *what)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%s: %.8f, should be %.8f within %g", what, value, wanted, tolerance);
}

/* A film of random light, that comes in two parts: variant 1 is x, variant 0 is 2 x, variant 2, if any, y / 2. */
static ControlFilm *fill(int nvariants, int nhalves, float sums[HEIGHT][WIDTH])
{
    ControlFilm *film;
    ControlPixel *pixel;
    uint32_t state = 7;
    assert_int_equal(control_film_create(&film, WIDTH, HEIGHT, SAMPLES, nvariants, nhalves, NULL), 0);
    assert_int_equal(control_pixel_create(&pixel, film, NULL), 0);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            sums[y][x] = 0;
            for (int s = 0; s < SAMPLES; s++) {
                float value = (float)test_random(&state), other = (float)test_random(&state);
                ControlPath path;
                control_start(&path, nvariants);
                for (int part = 0; part < 2; part++) {
                    float share = part ? 0.75f : 0.25f;
                    Rgb light[3] = {rgb(2 * share * value, 2 * share * value, 0), rgb(share * value, share * value, 0),
                                    rgb_grey(share * other * 0.5f)};
                    control_add(pixel, &path, &(Contribution){.variants = light}, color4(light[0]));
                }
                control_end(pixel, &path, nhalves == 2 ? s % 2 : 0);
                sums[y][x] += value;
            }
            control_pixel_end(pixel, x, y);
        }
    control_pixel_close(&pixel);
    return film;
}

static void moments_are_those_of_the_samples(void **state)
{
    (void)state;
    float sums[HEIGHT][WIDTH];
    ControlFilm *film = fill(2, 1, sums);
    const ControlMoments *m = control_film_moments(film, 0);
    double spread = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            size_t at = retex_image_index(&m->mean[0], x, y);
            double v1 = m->covariance[control_pair(1, 1)].pixels[at];
            expect(m->mean[1].pixels[at], sums[y][x] / SAMPLES, 1e-6, "mean");
            expect(control_film_picture(film, 0)->pixels[at], 2 * sums[y][x] / SAMPLES, 1e-6, "picture");
            expect(m->covariance[control_pair(0, 1)].pixels[at], 2 * v1, 1e-6, "covariance");
            expect(m->covariance[control_pair(0, 0)].pixels[at], 4 * v1, 1e-6, "variance");
            assert_true(m->covariance[control_pair(0, 0)].pixels[at + 2] == 0);
            spread += v1 / (WIDTH * HEIGHT);
        }
    expect(spread, 1.0 / 12 / SAMPLES, 2e-3, "variance of the mean of uniform numbers");
    control_film_close(&film);
}

static void not_finite_is_left_out(void **state)
{
    (void)state;
    ControlFilm *film;
    ControlPixel *pixel;
    ControlPath path;
    Rgb light[2] = {{1, 1, 1}, {NAN, 1, 1}};
    assert_int_equal(control_film_create(&film, 1, 1, 1, 2, 0, NULL), 0);
    assert_int_equal(control_pixel_create(&pixel, film, NULL), 0);
    control_start(&path, 2);
    control_add(pixel, &path, &(Contribution){.variants = light}, color4(light[0]));
    control_end(pixel, &path, 0);
    control_pixel_end(pixel, 0, 0);
    control_pixel_close(&pixel);
    assert_int_equal(control_film_dropped(film), 1);
    assert_true(control_film_picture(film, 0)->pixels[0] == 1 && control_film_picture(film, 1)->pixels[0] == 0);
    control_film_close(&film);
}

static RetexSet *make_set(int spp)
{
    RetexSet *set;
    assert_int_equal(retex_set_create(&set, WIDTH, HEIGHT, NULL), 0);
    if (set->nparts == 0)
        assert_int_equal(retex_set_add_part(set, "beauty", "RGB", RETEX_FLOAT, 0, 0, NULL, NULL), 0);
    for (size_t i = 0; i < WIDTH * HEIGHT * 3; i++)
        set->parts[0].image.pixels[i] = 0.5f;
    set->spp = spp;
    return set;
}

static void what_is_known_is_found(void **state)
{
    (void)state;
    /* F1 is twice F0: with G all but certain the answer is 2 G; with G as good as the samples alpha is halved */
    static const ControlMode modes[] = {CONTROL_UNBIASED, CONTROL_HALVES, CONTROL_BIASED};
    for (int k = 0; k < 3; k++)
        for (int certain = 0; certain < 2; certain++) {
            float sums[HEIGHT][WIDTH];
            int halves = modes[k] == CONTROL_HALVES ? 2 : 1, samples[2] = {SAMPLES / halves, SAMPLES / 2};
            ControlFilm *film = fill(2, halves, sums);
            ControlMoments *moments[2] = {control_film_moments(film, 0), control_film_moments(film, 1)};
            RetexSet *set = make_set(certain ? 1 << 30 : SAMPLES);
            RetexImage found = {0};
            assert_int_equal(control_variate(&found, moments, samples, set, NULL, modes[k], NULL), 0);
            for (int y = 0; y < HEIGHT; y++)
                for (int x = 0; x < WIDTH; x++) {
                    size_t at = retex_image_index(&found, x, y);
                    expect(found.pixels[at], certain ? 1 : 0.5 + sums[y][x] / SAMPLES, 1e-4, "estimate");
                    expect(found.pixels[at + 2], 0, 0, "black");
                }
            retex_image_free(&found);
            retex_set_close(&set);
            control_film_close(&film);
        }
}

static void the_better_control_is_taken(void **state)
{
    (void)state;
    /* of two controls one tells nothing, here of independent numbers; what it is said to be does not matter much */
    for (int certain = 0; certain < 2; certain++) { /* with G as good as the samples both alphas are halved */
        float sums[HEIGHT][WIDTH];
        int samples = SAMPLES;
        ControlFilm *film = fill(3, 1, sums);
        ControlMoments *moments = control_film_moments(film, 0);
        RetexSet *set = make_set(certain ? 1 << 30 : SAMPLES);
        RetexImage found = {0}, combined = {0};
        assert_int_equal(retex_image_copy(&combined, &moments->mean[2], NULL), 0);
        assert_int_equal(control_variate(&found, &moments, &samples, set, &combined, CONTROL_UNBIASED, NULL), 0);
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++)
                expect(found.pixels[retex_image_index(&found, x, y)], certain ? 1 : 0.5 + sums[y][x] / SAMPLES, 0.01,
                       "estimate");
        retex_image_free(&found);
        retex_image_free(&combined);
        retex_set_close(&set);
        control_film_close(&film);
    }
}

static void stored_data_is_used(void **state)
{
    (void)state;
    /* what is written is the variance of the mean of all samples, from one half or two */
    float sums[HEIGHT][WIDTH];
    double mean[2] = {0, 0};
    for (int halves = 1; halves <= 2; halves++) {
        ControlFilm *film = fill(1, halves, sums);
        ControlMoments *moments[2] = {control_film_moments(film, 0), control_film_moments(film, 1)};
        int samples[2] = {SAMPLES / halves, SAMPLES / 2};
        RetexSet *set = make_set(SAMPLES);
        assert_int_equal(control_data_add(set, moments, samples, halves, NULL), 0);
        int part = retex_set_find_part(set, "variance");
        assert_true(part > 0);
        assert_int_equal(retex_set_find_part(set, "beauty_b") > 0, halves == 2);
        for (size_t i = 0; i < WIDTH * HEIGHT * 3; i += 3)
            mean[halves - 1] += set->parts[part].image.pixels[i] / (WIDTH * HEIGHT);
        retex_set_close(&set);
        control_film_close(&film);
    }
    expect(mean[0], 4.0 / 12 / SAMPLES, 6e-3, "variance of all");
    expect(mean[1], mean[0], 4e-3, "variance of two halves");
}

static RetexImage constant(float value)
{
    RetexImage im = {0};
    assert_int_equal(retex_image_alloc(&im, WIDTH, HEIGHT, 3, NULL), 0);
    for (size_t i = 0; i < WIDTH * HEIGHT * 3; i++)
        im.pixels[i] = value;
    return im;
}

/* The sum of the difference over its standard deviation, for numbers that are the same everywhere: the set has noise
 * too, as much as its samples are fewer, and the three channels are counted as one. */
static void the_distance_is_in_standard_deviations(void **state)
{
    (void)state;
    for (int nhalves = 1; nhalves < 3; nhalves++) {
        ControlMoments halves[2] = {{{{0}}, {{0}}}, {{{0}}, {{0}}}}, *moments[2] = {&halves[0], &halves[1]};
        const int samples[2] = {12, 4}, total = nhalves > 1 ? 16 : 12;
        RetexSet *set = make_set(8); /* of 0.5 */
        for (int h = 0; h < nhalves; h++) {
            halves[h].mean[1] = constant(h ? 0.7f : 0.6f);
            halves[h].covariance[control_pair(1, 1)] = constant(h ? 0.05f : 0.02f);
        }
        const double count = WIDTH * HEIGHT * 3, share = (double)samples[0] / total;
        const double difference = 0.6 * share + 0.7 * (1 - share) - 0.5;
        const double variance = (0.02 * share * share + 0.05 * (1 - share) * (1 - share)) * (1 + total / 8.0);
        expect(control_distance(moments, samples, nhalves, set), count * difference / sqrt(3 * count * variance), 1e-4,
               "distance");
        for (int h = 0; h < nhalves; h++) {
            retex_image_free(&halves[h].mean[1]);
            retex_image_free(&halves[h].covariance[control_pair(1, 1)]);
        }
        retex_set_close(&set);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(moments_are_those_of_the_samples),
                                       cmocka_unit_test(not_finite_is_left_out),
                                       cmocka_unit_test(what_is_known_is_found),
                                       cmocka_unit_test(the_better_control_is_taken),
                                       cmocka_unit_test(stored_data_is_used),
                                       cmocka_unit_test(the_distance_is_in_standard_deviations)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
