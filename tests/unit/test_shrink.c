/* Parts of pictures at smaller sizes, against means by small steps, and where a cut lies. */
#include "lib_test.h"
#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include <retex/retex.h>

/* The mean of what lies between these places, pixel by pixel. */
static double mean(const RetexImage *im, double x0, double x1, double y0, double y1, int channel)
{
    double sum = 0, area = 0;
    for (int y = 0; y < im->height; y++)
        for (int x = 0; x < im->width; x++) {
            const double w = (x + 1 < x1 ? x + 1 : x1) - (x > x0 ? x : x0),
                         h = (y + 1 < y1 ? y + 1 : y1) - (y > y0 ? y : y0);
            if (w > 0 && h > 0) {
                sum += w * h * (double)im->pixels[retex_image_index(im, x, y) + (size_t)channel];
                area += w * h;
            }
        }
    return sum / area;
}

static void expect_cut(const RetexImage *im, const RetexCut *cut)
{
    const double step = (double)cut->width / cut->scaled_width, down = (double)cut->height / cut->scaled_height;
    RetexShrink *shrink = NULL;
    RetexImage small = {0};
    RetexError err = {0};
    test_must(retex_shrink_open(&shrink, cut, im->width, &err), &err);
    for (int y = im->height; y > 0; y -= 5) /* in any order, and rows outside of the cut too */
        test_must(retex_shrink_rows(shrink, y > 5 ? y - 5 : 0, y,
                                    im->pixels + retex_image_index(im, 0, y > 5 ? y - 5 : 0), &err),
                  &err);
    test_must(retex_shrink_take(&shrink, &small, 2, &err), &err);
    assert_null(shrink);
    assert_true(small.width == cut->scaled_width && small.height == cut->scaled_height && small.channels == 3);
    for (int y = 0; y < small.height; y++)
        for (int x = 0; x < small.width; x++)
            for (int c = 0; c < 3; c++)
                assert_float_equal(
                    small.pixels[retex_image_index(&small, x, y) + (size_t)c],
                    mean(im, cut->x + x * step, cut->x + (x + 1) * step, cut->y + y * down, cut->y + (y + 1) * down, c),
                    1e-4);
    retex_image_free(&small);
}

static void test_means(void **state)
{
    static const int sizes[][2] = {{31, 23}, {30, 22}, {16, 12}, {1, 1}, {7, 23}, {31, 5}};
    RetexImage im = {0};
    (void)state;
    test_random_image(&im, 40, 29, 3, 3, 0, 10);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        expect_cut(&im, &(RetexCut){4, 3, 31, 23, sizes[i][0], sizes[i][1]});
        expect_cut(&im, &(RetexCut){0, 0, 40, 29, sizes[i][0], sizes[i][1]});
    }
    retex_image_free(&im);
}

/* A sum of large numbers may not become infinite where their mean is a number. */
static void test_large(void **state)
{
    const float rows[12] = {3e38f, 3e38f, 3e38f, 3e38f, 3e38f, 3e38f, 3e38f, 3e38f, 3e38f, 3e38f, 3e38f, 3e38f};
    const RetexCut cut = {0, 0, 2, 2, 1, 1};
    RetexShrink *shrink = NULL;
    RetexImage small = {0};
    RetexError err = {0};
    (void)state;
    test_must(retex_shrink_open(&shrink, &cut, 2, &err), &err);
    test_must(retex_shrink_rows(shrink, 0, 2, rows, &err), &err);
    test_must(retex_shrink_take(&shrink, &small, 1, &err), &err);
    assert_true(small.pixels[0] == 3e38f && small.pixels[2] == 3e38f);
    retex_image_free(&small);
}

static void test_fit(void **state)
{
    static const struct {
        int crop[4], width, height;
        RetexCut cut; /* without width: refused */
    } rows[] = {
        {{0, 0, 0, 0}, 0, 0, {0, 0, 100, 60, 100, 60}},   {{5, 6, 20, 10}, 0, 0, {5, 6, 20, 10, 20, 10}},
        {{0, 0, 0, 0}, 50, 0, {0, 0, 100, 60, 50, 30}},   {{0, 0, 0, 0}, 0, 20, {0, 0, 100, 60, 33, 20}},
        {{0, 0, 0, 0}, 30, 30, {20, 0, 60, 60, 30, 30}},  {{0, 0, 0, 0}, 50, 20, {0, 10, 100, 40, 50, 20}},
        {{10, 20, 40, 40}, 1, 0, {10, 20, 40, 40, 1, 1}}, {{90, 50, 10, 10}, 10, 0, {90, 50, 10, 10, 10, 10}},
        {{0, 0, 100, 1}, 1, 0, {0, 0, 100, 1, 1, 1}},     {{0, 0, 0, 0}, 100, 60, {0, 0, 100, 60, 100, 60}},
        {{91, 50, 10, 10}, 0, 0, {0, 0, 0, 0, 0, 0}},     {{0, 51, 10, 10}, 0, 0, {0, 0, 0, 0, 0, 0}},
        {{-1, 0, 10, 10}, 0, 0, {0, 0, 0, 0, 0, 0}},      {{0, 0, 10, 0}, 0, 0, {0, 0, 0, 0, 0, 0}},
        {{0, 0, 0, 0}, 101, 0, {0, 0, 0, 0, 0, 0}},       {{0, 0, 0, 0}, 50, 61, {0, 0, 0, 0, 0, 0}},
        {{0, 0, 0, 0}, -1, 0, {0, 0, 0, 0, 0, 0}},        {{50, 0, 2147483647, 5}, 0, 0, {0, 0, 0, 0, 0, 0}},
        {{0, 0, 10, 10}, 11, 0, {0, 0, 0, 0, 0, 0}},      {{0, 0, 10, 10}, 65536, 1, {0, 0, 0, 0, 0, 0}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        RetexCut cut = {0};
        RetexError err = {0};
        const int code = retex_cut_fit(&cut, 100, 60, rows[i].crop, rows[i].width, rows[i].height, &err);
        assert_int_equal(code, rows[i].cut.width ? RETEX_OK : RETEX_EINVAL);
        if (code)
            assert_true(err.message[0]);
        else
            assert_memory_equal(&cut, &rows[i].cut, sizeof cut);
    }
    assert_true(retex_cut_is_whole(&(RetexCut){0, 0, 100, 60, 100, 60}, 100, 60));
    assert_false(retex_cut_is_whole(&(RetexCut){0, 0, 100, 60, 99, 60}, 100, 60));
    assert_false(retex_cut_is_whole(&(RetexCut){0, 0, 100, 59, 100, 59}, 100, 60));
}

static void test_refused(void **state)
{
    static const RetexCut cuts[] = {{-1, 0, 5, 5, 5, 5}, {0, -1, 5, 5, 5, 5}, {6, 0, 5, 5, 5, 5}, {0, 0, 5, 5, 6, 5},
                                    {0, 0, 5, 5, 5, 6},  {0, 0, 5, 5, 0, 5},  {0, 0, 5, 5, 5, 0}};
    RetexShrink *shrink;
    (void)state;
    for (size_t i = 0; i < sizeof cuts / sizeof cuts[0]; i++) {
        assert_int_equal(retex_shrink_open(&shrink, &cuts[i], 10, NULL), RETEX_EINVAL);
        assert_null(shrink);
    }
    retex_shrink_close(&shrink);
    retex_shrink_close(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_means),
        cmocka_unit_test(test_large),
        cmocka_unit_test(test_fit),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
