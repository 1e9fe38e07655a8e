/* Enlarging reduced images, against interpolation of one number at a time. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "lib_test.h"
#include "retexture/enlarge.h"

/* Between the centres of pixels of the small image; beyond the outermost it is constant. */
static double interpolated(const RetexImage *image, int scale, int x, int y, int c)
{
    const int size[2] = {image->width, image->height}, pixel[2] = {x, y};
    int low[2], high[2];
    double t[2];
    for (int k = 0; k < 2; k++) {
        const double at = fmin(fmax((pixel[k] + 0.5) / scale - 0.5, 0), size[k] - 1);
        low[k] = (int)floor(at), t[k] = at - low[k];
        high[k] = low[k] + 1 < size[k] ? low[k] + 1 : low[k];
    }
    const float *p = image->pixels + c;
    const double ll = (double)p[retex_image_index(image, low[0], low[1])];
    const double hl = (double)p[retex_image_index(image, high[0], low[1])];
    const double lh = (double)p[retex_image_index(image, low[0], high[1])];
    const double hh = (double)p[retex_image_index(image, high[0], high[1])];
    return (1 - t[1]) * (ll + t[0] * (hl - ll)) + t[1] * (lh + t[0] * (hh - lh));
}

/* The picture may be narrower and less high than the enlarged image, and wider than the kernel's working memory. */
static void check(int width, int height, int channels, int scale, uint32_t *seed)
{
    RetexError err = {0};
    RetexImage image = {0};
    const int large = width * scale - (scale > 1 ? scale / 2 : 0), rows = height * scale;
    const int y0 = rows / 3, y1 = rows;
    const size_t row = (size_t)large * (size_t)channels, count = row * (size_t)(y1 - y0);
    float *out = malloc((count + 1) * sizeof *out);
    assert_non_null(out);
    out[count] = -7; /* what stands behind stays */
    test_must(retex_image_alloc(&image, width, height, channels, &err), &err);
    for (int k = 0; k < width * height * channels; k++)
        image.pixels[k] = (float)test_random(seed);
    retex_enlarge_rows(&image, scale, large, y0, y1, out);
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < large; x++)
            for (int c = 0; c < channels; c++) {
                const double got = (double)out[row * (size_t)(y - y0) + (size_t)(x * channels + c)];
                if (!(fabs(got - interpolated(&image, scale, x, y, c)) < 1e-6))
                    fail_msg("%d x %d x %d times %d: %d,%d,%d is %g", width, height, channels, scale, x, y, c, got);
            }
    assert_true(out[count] == -7);
    retex_image_free(&image);
    free(out);
}

static void images_are_interpolated(void **state)
{
    (void)state;
    uint32_t seed = 1;
    for (int channels = 1; channels <= 4; channels++)
        for (int scale = 1; scale <= 8; scale *= 2) {
            check(1, 1, channels, scale, &seed);
            check(5, 4, channels, scale, &seed);
            check(700, 3, channels, scale, &seed);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(images_are_interpolated)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
