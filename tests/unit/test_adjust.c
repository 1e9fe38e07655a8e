/* Adjustments of textures: each against its formula, texel by texel; their order; blurs against sums over the plane;
 * what is told of a colour that cannot be reached. */
#include "lib_test.h"
#include "texture/adjust.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color.h>

#include <cmocka.h>

enum { WIDTH = 40, HEIGHT = 24, COUNT = WIDTH * HEIGHT };

static RetexTexels random_texels(int narrow, int is_opaque)
{
    RetexTexels t = {WIDTH, HEIGHT, narrow, NULL};
    uint32_t seed = 5;
    assert_int_equal(retex_texels_alloc(&t), 0);
    for (size_t i = 0; i < COUNT; i++) {
        const float alpha = is_opaque ? 1 : i % 7 == 0 ? 0 : (float)test_random(&seed);
        float p[4] = {0, 0, 0, alpha};
        for (int c = 0; c < 3; c++)
            p[c] = alpha * (float)pow(test_random(&seed), 2);
        retex_texture_store_texel(&t, i, p);
    }
    return t;
}

static void add(RetexTextureSpec *spec, RetexAdjust kind, double a, double b, double c)
{
    spec->adjustments[spec->nadjustments++] = (RetexAdjustment){kind, {(float)a, (float)b, (float)c}};
}

/* Multiplies by the inverse, which Cramer's rule has. */
static void solve(const double m[3][3], const double right[3], double x[3])
{
    for (int k = 0; k < 3; k++) {
        double of[3][3], d[2];
        for (int n = 0; n < 2; n++) {
            memcpy(of, m, sizeof of);
            for (int i = 0; i < 3 && n; i++)
                of[i][k] = right[i];
            d[n] = of[0][0] * (of[1][1] * of[2][2] - of[1][2] * of[2][1]) -
                   of[0][1] * (of[1][0] * of[2][2] - of[1][2] * of[2][0]) +
                   of[0][2] * (of[1][0] * of[2][1] - of[1][1] * of[2][0]);
        }
        x[k] = d[1] / d[0];
    }
}

/* In polar coordinates of Oklab. */
static void turn(double c[3], double degrees)
{
    static const double lms[3][3] = {{0.4122214708, 0.5363325363, 0.0514459929},
                                     {0.2119034982, 0.6806995451, 0.1073969566},
                                     {0.0883024619, 0.2817188376, 0.6299787005}};
    static const double lab[3][3] = {{0.2104542553, 0.7936177850, -0.0040720468},
                                     {1.9779984951, -2.4285922050, 0.4505937099},
                                     {0.0259040371, 0.7827717662, -0.8086757660}};
    double roots[3], in[3] = {0};
    for (int i = 0; i < 3; i++)
        roots[i] = cbrt(lms[i][0] * c[0] + lms[i][1] * c[1] + lms[i][2] * c[2]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            in[i] += lab[i][j] * roots[j];
    const double chroma = hypot(in[1], in[2]), hue = atan2(in[2], in[1]) + degrees * M_PI / 180;
    solve(lab, (const double[3]){in[0], chroma * cos(hue), chroma * sin(hue)}, roots);
    solve(lms, (const double[3]){pow(roots[0], 3), pow(roots[1], 3), pow(roots[2], 3)}, c);
}

static double luminance(const double c[3])
{
    return retex_luminance(c[0], c[1], c[2]);
}

static void expect(const RetexAdjustment *by, double mean, double c[3])
{
    const double value = (double)by->value[0], y = luminance(c);
    if (by->kind == RETEX_ADJUST_HUE)
        turn(c, value);
    for (int k = 0; k < 3; k++)
        c[k] = by->kind == RETEX_ADJUST_SATURATION                              ? (1 - value) * y + value * c[k]
               : by->kind == RETEX_ADJUST_GAIN || by->kind == RETEX_ADJUST_TINT ? (double)by->value[k] * c[k]
               : by->kind == RETEX_ADJUST_GAMMA                                 ? pow(c[k], 1 / value)
               : by->kind == RETEX_ADJUST_CONTRAST ? exp(log(0.18) + value * (log(fmax(c[k], 1e-30)) - log(0.18)))
               : by->kind == RETEX_ADJUST_INVERT   ? retex_srgb_decode(1 - retex_srgb_encode(fmin(c[k], 1)))
               : by->kind == RETEX_ADJUST_COLORIZE ? (double)by->value[k] * y / mean
                                                   : c[k];
}

static double mean_luminance(const RetexTexels *t)
{
    double sum = 0, alpha = 0;
    float p[4];
    for (size_t i = 0; i < COUNT; i++) {
        retex_texture_read_texel(t->texels, i, t->narrow, p);
        sum += retex_luminance((double)p[0], (double)p[1], (double)p[2]);
        alpha += (double)p[3];
    }
    return sum / alpha;
}

static double adjust(const RetexTextureSpec *spec, RetexTexels *t, int nthreads)
{
    RetexError err = {0};
    double delta_e;
    test_must(retex_adjust_check(spec, &err), &err);
    test_must(retex_adjust_texels(spec, t, &delta_e, nthreads, &err), &err);
    return delta_e;
}

/* Of colours alone; the mean that COLORIZE needs is that of the image as it was. */
static void compare(const RetexTextureSpec *spec, int narrow, double tolerance)
{
    RetexTexels before = random_texels(narrow, 0), after = random_texels(narrow, 0);
    const double mean = mean_luminance(&before);
    adjust(spec, &after, 2);
    for (size_t i = 0; i < COUNT; i++) {
        float p[4], q[4];
        retex_texture_read_texel(before.texels, i, narrow, p);
        retex_texture_read_texel(after.texels, i, narrow, q);
        assert_true(p[3] == q[3]);
        if (p[3] < 0.1f) { /* integers say little of its colour */
            assert_true(p[3] > 0 || q[0] == 0);
            continue;
        }
        double c[3] = {(double)(p[0] / p[3]), (double)(p[1] / p[3]), (double)(p[2] / p[3])};
        for (int k = 0; k < spec->nadjustments; k++)
            expect(&spec->adjustments[k], mean, c);
        for (int k = 0; k < 3; k++)
            assert_float_equal((double)q[k], (double)p[3] * fmin(fmax(c[k], 0), 1), tolerance);
    }
    free(before.texels);
    free(after.texels);
}

static void test_formulas(void **state)
{
    (void)state;
    for (int kind = 0; kind < RETEX_ADJUSTS; kind++) {
        if (kind == RETEX_ADJUST_BLUR)
            continue;
        for (int n = 0; n < 3; n++) {
            RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
            const double value = kind == RETEX_ADJUST_HUE ? 70 * n - 50 : 0.5 + 0.4 * n;
            add(&spec, (RetexAdjust)kind, value, value * 0.7, value * 1.3);
            compare(&spec, 0, 2e-5);
            compare(&spec, 1, 1e-3);
        }
    }
}

/* What is brighter than white becomes black where it is turned over, and what is darker than black or no number becomes
 * white. */
static void test_out_of_range(void **state)
{
    (void)state;
    static const float colors[4][2] = {{1.5f, 0}, {-1, 1}, {NAN, 1}, {1, 0}};
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    add(&spec, RETEX_ADJUST_INVERT, 0, 0, 0);
    for (int k = 0; k < 4; k++) {
        float rgb[3] = {colors[k][0], 0.25f, colors[k][0]};
        retex_adjust_color(&spec, rgb);
        assert_true(fabsf(rgb[0] - colors[k][1]) < 1e-6f && rgb[2] == rgb[0]);
        assert_true(fabs((double)rgb[1] - retex_srgb_decode(1 - retex_srgb_encode(0.25))) < 1e-6);
    }
    float rgb[3] = {1.5f, 0.25f, 1.5f};
    add(&spec, RETEX_ADJUST_SATURATION, 0.5, 0, 0); /* of black, not of less */
    retex_adjust_color(&spec, rgb);
    const double green = retex_srgb_decode(1 - retex_srgb_encode(0.25)), grey = retex_luminance(0, green, 0);
    assert_true(fabs((double)rgb[0] - grey / 2) < 1e-6 && fabs((double)rgb[1] - (grey + green) / 2) < 1e-6);
}

/* Each begins where the one before ended. */
static void test_order(void **state)
{
    (void)state;
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT, other = RETEX_TEXTURE_SPEC_INIT;
    add(&spec, RETEX_ADJUST_SATURATION, 0.4, 0, 0);
    add(&spec, RETEX_ADJUST_GAIN, 0.9, 0.6, 0.3);
    add(&spec, RETEX_ADJUST_GAMMA, 1.5, 0, 0);
    compare(&spec, 0, 2e-5);
    for (int k = 0; k < 3; k++)
        other.adjustments[other.nadjustments++] = spec.adjustments[2 - k];
    compare(&other, 0, 2e-5);
    float a[3] = {0.2f, 0.5f, 0.1f}, b[3] = {0.2f, 0.5f, 0.1f};
    retex_adjust_color(&spec, a);
    retex_adjust_color(&other, b);
    assert_true(fabsf(a[0] - b[0]) > 0.02f);
}

static int inside(int i, int size, RetexWrap wrap)
{
    if (i >= 0 && i < size)
        return i;
    const int turned = ((i % (2 * size)) + 2 * size) % (2 * size);
    return wrap == RETEX_WRAP_BLACK    ? -1
           : wrap == RETEX_WRAP_CLAMP  ? (i < 0 ? 0 : size - 1)
           : wrap == RETEX_WRAP_REPEAT ? turned % size
                                       : (turned < size ? turned : 2 * size - 1 - turned);
}

/* A blur of colours and alpha is the sum over the plane; a wide one, which boxes stand for, is near it. */
static void test_blur(void **state)
{
    (void)state;
    for (int n = 0; n < 8; n++) {
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        const double sigma = n < 4 ? 0.05 * WIDTH : 0.25 * WIDTH;
        spec.wrap[0] = (RetexWrap)(n % 4), spec.wrap[1] = (RetexWrap)((n + 1) % 4);
        add(&spec, RETEX_ADJUST_BLUR, sigma / WIDTH, 0, 0);
        RetexTexels before = random_texels(0, 0), after = random_texels(0, 0);
        adjust(&spec, &after, 3);
        const float *from = before.texels, *to = after.texels;
        for (int at = 0; at < COUNT; at += 37) {
            double sum[4] = {0}, weights = 0;
            const int reach = (int)(6 * sigma);
            for (int dy = -reach; dy <= reach; dy++)
                for (int dx = -reach; dx <= reach; dx++) {
                    const double weight = exp(-0.5 * (dx * dx + dy * dy) / (sigma * sigma));
                    const int x = inside(at % WIDTH + dx, WIDTH, spec.wrap[0]),
                              y = inside(at / WIDTH + dy, HEIGHT, spec.wrap[1]);
                    weights += weight;
                    for (int c = 0; c < 4 && x >= 0 && y >= 0; c++)
                        sum[c] += weight * (double)from[4 * (y * WIDTH + x) + c];
                }
            for (int c = 0; c < 4; c++)
                assert_float_equal((double)to[4 * at + c], sum[c] / weights, 1e-5);
        }
        free(before.texels);
        free(after.texels);
    }
}

/* One line of a wide image, with a step: boxes have the Gaussian's variance, and differ little from it. */
static void test_wide_blur(void **state)
{
    (void)state;
    enum { LONG = 1000 };
    const double sigma = 30;
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexels t = {LONG, 1, 0, NULL};
    assert_int_equal(retex_texels_alloc(&t), 0);
    spec.wrap[0] = spec.wrap[1] = RETEX_WRAP_CLAMP;
    add(&spec, RETEX_ADJUST_BLUR, sigma / LONG, 0, 0);
    for (size_t i = 0; i < LONG; i++)
        retex_texture_store_texel(&t, i, i < LONG / 2 ? (const float[4]){0, 0, 0, 1} : (const float[4]){1, 1, 1, 1});
    adjust(&spec, &t, 1);
    const float *p = t.texels;
    double variance = 0;
    for (int i = 0; i < LONG; i++) {
        const double step = 0.5 * (1 + erf((i + 0.5 - LONG / 2) / sigma / sqrt(2)));
        assert_float_equal((double)p[4 * i], step, 8e-3);
        if (i)
            variance += (double)(p[4 * i] - p[4 * i - 4]) * (i - LONG / 2) * (i - LONG / 2);
    }
    assert_float_equal(variance, sigma * sigma, 0.01 * sigma * sigma);
    free(t.texels);
}

/* The mean becomes the colour where nothing is too bright; else it is told how far it is. */
static void test_colorize(void **state)
{
    (void)state;
    for (int bright = 0; bright < 2; bright++) {
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        const double color[3] = {bright ? 0.9 : 0.2, 0.1, 0.05};
        RetexTexels t = random_texels(0, 1);
        double mean[3] = {0};
        add(&spec, RETEX_ADJUST_CONTRAST, 0.5, 0, 0);
        add(&spec, RETEX_ADJUST_COLORIZE, color[0], color[1], color[2]);
        const double delta_e = adjust(&spec, &t, 2);
        for (size_t i = 0; i < 3 * (size_t)COUNT; i++)
            mean[i % 3] += (double)((float *)t.texels)[4 * (i / 3) + i % 3] / COUNT;
        assert_true(bright ? delta_e > 1 : delta_e < 0.1);
        for (int c = 1; c < 3; c++)
            assert_float_equal(mean[c], color[c], 2e-3);
        assert_true(bright ? mean[0] < 0.85 : fabs(mean[0] - 0.2) < 2e-3);
        free(t.texels);
    }
}

static void test_light_and_limits(void **state)
{
    (void)state;
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    float a[3] = {0.5f, 0.8f, 0}, b[3] = {0.5f, 0.8f, 0};
    RetexError err = {0};
    add(&spec, RETEX_ADJUST_GAIN, 4, 4, 4);
    retex_adjust_color(&spec, a);
    assert_true(a[0] == 1 && a[1] == 1 && a[2] == 0);
    spec.is_light = 1;
    retex_adjust_color(&spec, b);
    assert_true(b[0] == 2 && b[1] > 3);
    for (int kind = 0; kind < RETEX_ADJUSTS; kind++) {
        RetexTextureSpec wrong = RETEX_TEXTURE_SPEC_INIT;
        add(&wrong, (RetexAdjust)kind, kind == RETEX_ADJUST_HUE ? NAN : -1, 0, 0);
        assert_int_equal(retex_adjust_check(&wrong, &err), RETEX_EINVAL);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_formulas),
        cmocka_unit_test(test_out_of_range),
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_blur),
        cmocka_unit_test(test_wide_blur),
        cmocka_unit_test(test_colorize),
        cmocka_unit_test(test_light_and_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
