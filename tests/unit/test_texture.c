/* Textures: wrap modes, the UV transform, and the Gaussian filter. The filter is compared with a simple numerical
 * integral of the point look-up, and with waves, whose filtered amplitude is known exactly. */
#include "lib_filter.h"
#include "lib_folder.h"
#include "lib_test.h"
#include "texture/pyramid.h"

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include <retex/host/texture_lookup.h>
#include <retex/image_file.h>

static RetexTexture *make_texture(const RetexImage *im, RetexWrap wrap_u, RetexWrap wrap_v)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *texture;
    RetexError err = {0};
    spec.wrap[0] = wrap_u;
    spec.wrap[1] = wrap_v;
    test_must(retex_texture_create(&texture, im, &spec, 0, &err), &err);
    return texture;
}

static RetexTexture *random_texture(int width, int height, int channels, uint32_t seed, RetexWrap wrap_u,
                                    RetexWrap wrap_v)
{
    RetexImage im = {0};
    test_random_image(&im, width, height, channels, seed, 0, 1);
    RetexTexture *texture = make_texture(&im, wrap_u, wrap_v);
    retex_image_free(&im);
    return texture;
}

/* The scalar reference: the integral over the footprint, 5 standard deviations each way, of the point look-up. */
static void integrate(const RetexTexture *texture, double u, double v, const double covariance[3], int steps,
                      double rgba[4])
{
    double a = sqrt(covariance[0]), b = a > 0 ? covariance[1] / a : 0, rest = covariance[2] - b * b;
    double c = rest > 0 ? sqrt(rest) : 0, total = 0, sum[4] = {0, 0, 0, 0};
    for (int i = 0; i < steps; i++)
        for (int j = 0; j < steps; j++) {
            double s = 10 * (i + 0.5) / steps - 5, t = 10 * (j + 0.5) / steps - 5, w = exp(-0.5 * (s * s + t * t));
            float point[4];
            retex_texture_point(texture, u + a * s, v + b * s + c * t, point);
            for (int k = 0; k < 3; k++)
                sum[k] += w * (double)point[k] * (double)point[3];
            sum[3] += w * (double)point[3];
            total += w;
        }
    for (int k = 0; k < 3; k++)
        rgba[k] = sum[3] > 0 ? sum[k] / sum[3] : 0;
    rgba[3] = sum[3] / total;
}

static void test_point(void **state)
{
    (void)state;
    /* top row: 0 1; bottom row: 2 3 */
    RetexImage im = {0};
    RetexError err = {0};
    float p[4];
    test_must(retex_image_alloc(&im, 2, 2, 1, &err), &err);
    for (int i = 0; i < 4; i++)
        im.pixels[i] = (float)i;
    RetexTexture *t = make_texture(&im, RETEX_WRAP_REPEAT, RETEX_WRAP_REPEAT);
    retex_texture_point(t, 0.25, 0.25, p); /* v = 0 is the bottom */
    assert_float_equal(p[0], 2, 1e-6);
    assert_float_equal(p[3], 1, 0);
    retex_texture_point(t, 0.75, 0.75, p);
    assert_float_equal(p[2], 1, 1e-6);
    retex_texture_point(t, 0.5, 0.25, p);
    assert_float_equal(p[0], 2.5, 1e-6);
    retex_texture_point(t, 1, 0.25, p); /* between the last texel and the first */
    assert_float_equal(p[0], 2.5, 1e-6);
    retex_texture_point(t, -7.75, 12.75, p);
    assert_float_equal(p[0], 0, 1e-6);
    retex_texture_close(&t);
    assert_null(t);

    t = make_texture(&im, RETEX_WRAP_MIRROR, RETEX_WRAP_CLAMP);
    retex_texture_point(t, 1.25, 0.25, p);
    assert_float_equal(p[0], 3, 1e-6);
    retex_texture_point(t, -0.75, -5, p);
    assert_float_equal(p[0], 3, 1e-6);
    retex_texture_point(t, 0.25, 50, p);
    assert_float_equal(p[0], 0, 1e-6);
    retex_texture_close(&t);

    t = make_texture(&im, RETEX_WRAP_BLACK, RETEX_WRAP_REPEAT);
    retex_texture_point(t, 1.001, 0.25, p);
    assert_float_equal(p[0], 0, 0);
    assert_float_equal(p[3], 0, 0);
    retex_texture_point(t, 0.999, 0.25, p);
    assert_float_equal(p[0], 3, 1e-6);
    assert_float_equal(p[3], 1, 0);
    retex_texture_close(&t);
    retex_image_free(&im);
}

/* One channel is grey; other numbers of channels than 1, 3 and 4 are refused. */
static void test_channels(void **state)
{
    (void)state;
    RetexImage grey = {0}, color = {0};
    RetexError err = {0};
    RetexTexture *texture;
    test_random_image(&grey, 6, 5, 1, 3, 0, 1);
    test_must(retex_image_alloc(&color, 6, 5, 3, &err), &err);
    for (int i = 0; i < 90; i++)
        color.pixels[i] = grey.pixels[i / 3];
    RetexTexture *one = make_texture(&grey, RETEX_WRAP_REPEAT, RETEX_WRAP_REPEAT),
                 *three = make_texture(&color, RETEX_WRAP_REPEAT, RETEX_WRAP_REPEAT);
    for (int i = 0; i < 30; i++) {
        float a[4], b[4];
        retex_texture_point(one, (i % 6 + 0.5) / 6, 1 - (i / 6 + 0.5) / 5, a);
        retex_texture_point(three, (i % 6 + 0.5) / 6, 1 - (i / 6 + 0.5) / 5, b);
        assert_true(memcmp(a, b, sizeof a) == 0 && fabsf(a[0] - grey.pixels[i]) < 1e-5f && a[3] == 1);
    }
    retex_texture_close(&one);
    retex_texture_close(&three);
    for (int channels = 0; channels < 7; channels++) {
        const int is_right = channels == 1 || channels == 3 || channels == 4;
        grey.channels = channels, grey.width = grey.height = 2;
        assert_int_equal(retex_texture_create(&texture, &grey, NULL, 0, &err), is_right ? RETEX_OK : RETEX_EINVAL);
        retex_texture_close(&texture);
    }
    retex_image_free(&grey);
    retex_image_free(&color);
}

/* The variance that a level tells is that of the texels that it has taken up, nearly where several levels of odd sizes
 * are halved: an image of one bright texel shows with
 * which weight, along both axes. */
static void test_blur_of_levels(void **state)
{
    (void)state;
    enum { WIDTH = 90, HEIGHT = 44 };
    static float weights[8][2][WIDTH][WIDTH]; /* by level, axis, its texel, and that of the image */
    int nlevels = 0, compared = 0;
    for (int axis = 0; axis < 2; axis++)
        for (int i = 0; i < (axis ? HEIGHT : WIDTH); i++) {
            RetexImage im = {0};
            RetexError err = {0};
            test_must(retex_image_alloc(&im, WIDTH, HEIGHT, 3, &err), &err);
            for (int k = 0; k < WIDTH * HEIGHT; k++)
                for (int c = 0; c < 3; c++)
                    im.pixels[3 * k + c] = (axis ? k / WIDTH : k % WIDTH) == i;
            RetexTexture *texture = make_texture(&im, RETEX_WRAP_REPEAT, RETEX_WRAP_REPEAT);
            assert_true(!texture->narrow && texture->nlevels <= 8);
            nlevels = texture->nlevels;
            for (int l = 0; l < nlevels; l++) {
                const RetexTextureLevel *level = &texture->levels[l];
                const float *texels = level->texels;
                for (int x = 0; x < (axis ? level->height : level->width); x++)
                    weights[l][axis][x][i] = texels[4 * x * (axis ? level->width : 1)];
                for (int of = 0; of < 2 && i == 0 && axis == 0; of++)
                    assert_true(fabs(level->scale[of] -
                                     (of ? HEIGHT / (double)level->height : WIDTH / (double)level->width)) < 1e-12);
            }
            for (int l = 1; l < nlevels && i == (axis ? HEIGHT : WIDTH) - 1; l++) {
                const RetexTextureLevel *level = &texture->levels[l];
                const int count = axis ? level->height : level->width;
                for (int x = 0; x < count; x++) {
                    double sum = 0, mean = 0, square = 0, p = (x + 0.5) / count;
                    for (int k = 0; k <= i; k++) {
                        const double w = (double)weights[l][axis][x][k];
                        sum += w, mean += w * k, square += w * k * k;
                    }
                    mean /= sum;
                    const double variance = square / sum - mean * mean,
                                 told = level->blur[axis][0] + level->blur[axis][1] * p * (1 - p);
                    if (fabs(told - variance) > 0.12 * variance)
                        fail_msg("level %d, axis %d, texel %d: variance %g, told %g", l, axis, x, variance, told);
                    compared++;
                }
            }
            retex_texture_close(&texture);
            retex_image_free(&im);
        }
    assert_true(nlevels == 7 && compared > 120);
}

/* Images of 8 bits are kept as integers. They are looked up and filtered as the same numbers in floats are. */
static void test_integers(void **state)
{
    (void)state;
    static const double covariances[][3] = {
        {0, 0, 0},       {1e-4, 0, 1e-4},  {0.01, 0.002, 0.004}, {0.002, -0.004, 0.05},
        {0.3, 0.1, 0.2}, {1e-6, 0, 0.002}, {0.02, 0.014, 0.0099}};
    static const int sizes[][2] = {{37, 23}, {64, 48}, {5, 3}, {1, 9}};
    uint32_t seed = 7;
    for (int n = 0; n < 4 * 4 * 2; n++) {
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        RetexImage im = {0}, read = {0};
        RetexTexture *integers, *floats;
        RetexError err = {0};
        const int channels = n < 16 ? 3 : 4;
        spec.wrap[0] = (RetexWrap)(n % 4), spec.wrap[1] = (RetexWrap)((n / 4 + n) % 4);
        snprintf(spec.image, sizeof spec.image, "%s", test_in_folder("integers.png"));
        test_random_image(&im, sizes[n / 4 % 4][0], sizes[n / 4 % 4][1], channels, 3 + (uint32_t)n, 0, 1);
        test_must(retex_image_write(&im, spec.image, NULL, 1, &err), &err);
        test_must(retex_texture_load(&integers, &spec, 1, &err), &err);
        test_must(retex_image_read(&read, spec.image, NULL, 1, &err), &err);
        test_must(retex_texture_create(&floats, &read, &spec, 1, &err), &err);
        assert_true(integers->narrow && !floats->narrow);
        for (int k = 0; k < 400; k++) {
            const double u = 3 * test_random(&seed) - 1, v = 3 * test_random(&seed) - 1;
            float a[4], b[4];
            filter_gaussian(integers, u, v, covariances[k % 7], a);
            filter_gaussian(floats, u, v, covariances[k % 7], b);
            for (int c = 0; c < 4; c++)
                if (fabsf(a[c] - b[c]) * (c < 3 ? b[3] : 1) > 2e-4f)
                    fail_msg("image %d, covariance %d, channel %d: %g, not %g", n, k % 7, c, (double)a[c],
                             (double)b[c]);
        }
        retex_texture_close(&integers);
        retex_texture_close(&floats);
        retex_image_free(&read);
        retex_image_free(&im);
    }
}

/* A texture that hears of its surface later lies as one that was made for it. */
static void test_surface(void **state)
{
    (void)state;
    RetexImage im = {0};
    RetexTexture *told, *made;
    RetexError err = {0};
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT, surface = RETEX_TEXTURE_SPEC_INIT;
    uint32_t seed = 4;
    test_random_image(&im, 12, 7, 3, 3, 0, 1);
    spec.width[0] = 0.5, spec.uv_scale[0] = spec.uv_scale[1] = 1;
    surface.uv_scale[0] = 2, surface.uv_scale[1] = 3, surface.unit = 0.1;
    test_must(retex_texture_create(&told, &im, &spec, 1, &err), &err);
    test_must(retex_texture_set_surface(told, &surface, &err), &err);
    spec.uv_scale[0] = 2, spec.uv_scale[1] = 3, spec.unit = 0.1;
    test_must(retex_texture_create(&made, &im, &spec, 1, &err), &err);
    for (int k = 0; k < 200; k++) {
        const double u = 3 * test_random(&seed) - 1, v = 3 * test_random(&seed) - 1;
        float a[4], b[4];
        retex_texture_point(told, u, v, a);
        retex_texture_point(made, u, v, b);
        assert_memory_equal(a, b, sizeof a);
    }
    surface.uv_scale[1] = 0; /* unknown: nothing has a width */
    assert_int_equal(retex_texture_set_surface(told, &surface, &err), RETEX_EINVAL);
    retex_texture_close(&told);
    retex_texture_close(&made);
    retex_image_free(&im);
}

/* Textures may share what is loaded only if their tiles are the same. */
static void test_tiles_alike(void **state)
{
    (void)state;
    static const struct {
        const char *a[2], *b[2];
        int alike;
    } cases[] = {{{"", ""}, {"", ""}, 1},     {{"x", ""}, {"x", ""}, 1},  {{"x", ""}, {"y", ""}, 0},
                 {{"x", ""}, {"", ""}, 0},    {{"x", "y"}, {"x", ""}, 0}, {{"x", "y"}, {"x", "y"}, 1},
                 {{"x", "y"}, {"y", "x"}, 0}, {{"x", "y"}, {"z", "y"}, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        RetexTextureSpec a = RETEX_TEXTURE_SPEC_INIT, b = RETEX_TEXTURE_SPEC_INIT;
        for (int k = 0; k < 2; k++) {
            strcpy(a.tiles[k], cases[i].a[k]);
            strcpy(b.tiles[k], cases[i].b[k]);
        }
        assert_int_equal(retex_texture_specs_alike(&a, &b), cases[i].alike);
    }
}

static void test_transform(void **state)
{
    (void)state;
    RetexImage im = {0};
    RetexError err = {0};
    test_random_image(&im, 16, 8, 3, 3, 0, 1);
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    spec.scale[0] = 2;
    spec.scale[1] = -3;
    spec.rotate = 30;
    spec.offset[0] = 0.1;
    spec.offset[1] = 0.7;
    RetexTexture *plain, *turned;
    test_must(retex_texture_create(&plain, &im, NULL, 0, &err), &err);
    test_must(retex_texture_create(&turned, &im, &spec, 0, &err), &err);
    uint32_t seed = 5;
    for (int i = 0; i < 200; i++) {
        double u = 4 * test_random(&seed) - 2, v = 4 * test_random(&seed) - 2, c = cos(M_PI / 6), s = sin(M_PI / 6);
        double tu = c * 2 * u + s * 3 * v + 0.1, tv = s * 2 * u - c * 3 * v + 0.7;
        double longer = 0.2 * test_random(&seed), angle = 3 * test_random(&seed), cov[3], tcov[3];
        float a[4], b[4];
        retex_texture_point(turned, u, v, a);
        retex_texture_point(plain, tu, tv, b);
        for (int k = 0; k < 4; k++)
            assert_float_equal(a[k], b[k], 1e-5);
        test_turned_covariance(cov, longer, 0.3 * longer, angle);
        double m[2][2] = {{2 * c, 3 * s}, {2 * s, -3 * c}};
        tcov[0] = m[0][0] * m[0][0] * cov[0] + 2 * m[0][0] * m[0][1] * cov[1] + m[0][1] * m[0][1] * cov[2];
        tcov[1] =
            m[0][0] * m[1][0] * cov[0] + (m[0][0] * m[1][1] + m[0][1] * m[1][0]) * cov[1] + m[0][1] * m[1][1] * cov[2];
        tcov[2] = m[1][0] * m[1][0] * cov[0] + 2 * m[1][0] * m[1][1] * cov[1] + m[1][1] * m[1][1] * cov[2];
        filter_gaussian(turned, u, v, cov, a);
        filter_gaussian(plain, tu, tv, tcov, b);
        for (int k = 0; k < 4; k++)
            assert_float_equal(a[k], b[k], 1e-4);
    }
    retex_texture_close(&plain);
    retex_texture_close(&turned);
    retex_image_free(&im);
}

/* No footprint is the point; a small one is near it; one as large as the texture, or larger, is the mean. */
static void test_limits(void **state)
{
    (void)state;
    static const int sizes[][2] = {{64, 64}, {37, 23}, {100, 1}, {1, 9}, {1, 1}, {255, 16}};
    uint32_t seed = 11;
    for (size_t n = 0; n < sizeof sizes / sizeof sizes[0]; n++)
        for (int wrap = 0; wrap < 4; wrap++) {
            RetexTexture *t = random_texture(sizes[n][0], sizes[n][1], 3, 7, (RetexWrap)wrap, (RetexWrap)wrap);
            for (int i = 0; i < 50; i++) {
                double u = 0.05 + 0.9 * test_random(&seed), v = 0.05 + 0.9 * test_random(&seed), none[3] = {0, 0, 0};
                double tiny = 1e-3 / sizes[n][0], small[3] = {tiny * tiny, 0, tiny * tiny};
                float a[4], b[4], c[4];
                retex_texture_point(t, u, v, a);
                filter_gaussian(t, u, v, none, b);
                assert_memory_equal(a, b, sizeof a);
                filter_gaussian(t, u, v, small, c);
                double texel_u = u * sizes[n][0], texel_v = v * sizes[n][1];
                int inside =
                    texel_u > 0.5 && texel_v > 0.5 && texel_u < sizes[n][0] - 0.5 && texel_v < sizes[n][1] - 0.5;
                for (int k = 0; k < 4 && (wrap != RETEX_WRAP_BLACK || inside); k++)
                    assert_float_equal(a[k], c[k], 5e-3);
            }
            retex_texture_close(&t);
        }
    RetexImage im = {0};
    test_random_image(&im, 300, 111, 3, 1, 0, 1);
    double mean[3] = {0, 0, 0};
    for (int i = 0; i < 300 * 111; i++)
        for (int k = 0; k < 3; k++)
            mean[k] += (double)im.pixels[3 * i + k] / (300 * 111);
    for (int wrap = 0; wrap < 2; wrap++) {
        RetexTexture *t = make_texture(&im, (RetexWrap)wrap, (RetexWrap)wrap);
        static const double sds[] = {1, 3, 20, 500, 1e6, 1e30};
        for (int i = 0; i < 6; i++) {
            double cov[3] = {sds[i] * sds[i], 0, sds[i] * sds[i]};
            float a[4];
            filter_gaussian(t, 0.3 + i, 0.2 * i, cov, a);
            for (int k = 0; k < 3; k++)
                assert_float_equal(a[k], mean[k], 2e-4);
            assert_float_equal(a[3], 1, 1e-5);
        }
        retex_texture_close(&t);
    }
    retex_image_free(&im);
}

/* Against the integral: noise, all wraps, any orientation. Black axes end sharply in the point look-up and within a
 * texel in the filter, so that their coverage may differ by a little more. */
static void test_integral(void **state)
{
    (void)state;
    static const int sizes[][2] = {{32, 32}, {45, 27}, {64, 9}};
    uint32_t seed = 17;
    double worst = 0, worst_black = 0;
    for (int wrap = 0; wrap < 16; wrap++)
        for (int n = 0; n < 3; n++) {
            RetexTexture *t = random_texture(sizes[n][0], sizes[n][1], 4, (uint32_t)(wrap + 16 * n),
                                             (RetexWrap)(wrap % 4), (RetexWrap)(wrap / 4));
            int black = wrap % 4 == RETEX_WRAP_BLACK || wrap / 4 == RETEX_WRAP_BLACK;
            for (int i = 0; i < 12; i++) {
                double longer = 0.01 * pow(60, test_random(&seed)), shorter = longer * pow(8, -test_random(&seed)),
                       cov[3];
                double u = 1.4 * test_random(&seed) - 0.2, v = 1.4 * test_random(&seed) - 0.2, want[4];
                float got[4];
                test_turned_covariance(cov, longer, shorter, M_PI * test_random(&seed));
                filter_gaussian(t, u, v, cov, got);
                integrate(t, u, v, cov, 200, want);
                for (int k = 0; k < 4; k++) {
                    double weight = k < 3 ? want[3] : 1, e = fabs((double)got[k] - want[k]) * weight;
                    double *where = black ? &worst_black : &worst;
                    if (e > *where)
                        *where = e;
                }
            }
            retex_texture_close(&t);
        }
    print_message("largest error on white noise of 0..1: %.4f, with black wraps %.4f\n", worst, worst_black);
    assert_true(worst < 0.03);
    assert_true(worst_black < 0.05);
}

/* A wave cos, sin of f texels^-1 as a picture; its filtered amplitude and phase follow from the covariance C alone:
 * sum over the aliases g of f of sinc(g)^2 (the bilinear tent) times exp(-2 pi^2 g^T C g). */
static void make_wave(RetexImage *im, int width, int height, const double f[2])
{
    RetexError err = {0};
    test_must(retex_image_alloc(im, width, height, 3, &err), &err);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double phase = 2 * M_PI * (f[0] * (x + 0.5) - f[1] * (y + 0.5));
            float *p = im->pixels + retex_image_index(im, x, y);
            p[0] = (float)(0.5 + 0.5 * cos(phase));
            p[1] = (float)(0.5 + 0.5 * sin(phase));
        }
}

static double sinc(double x)
{
    return x == 0 ? 1 : sin(M_PI * x) / (M_PI * x);
}

static double quadratic(const double cov[3], double x, double y)
{
    return cov[0] * x * x + 2 * cov[1] * x * y + cov[2] * y * y;
}

static double complex filtered_wave(const double f[2], const double cov[3], double x, double y)
{
    double complex sum = 0;
    for (int n = -3; n <= 3; n++)
        for (int m = -3; m <= 3; m++) {
            double gx = f[0] + n, gy = f[1] + m, tent = sinc(gx) * sinc(gy);
            double sign = (n + m) % 2 ? -1 : 1; /* texel centres lie at halves */
            sum += sign * tent * tent * exp(-2 * M_PI * M_PI * quadratic(cov, gx, gy)) *
                   cexp(2 * I * M_PI * (gx * x + gy * y));
        }
    return sum;
}

/* The variance realised along the longer and the shorter axis, from 0.3 texel to a fifth of the texture (where the wave
 * has no amplitude left to measure). Covariances here are in texels. */
static void measure_variance(int width, int height, double most_aspect, double *worst, double *rms)
{
    uint32_t seed = (uint32_t)(width * 31 + height);
    int smaller = width < height ? width : height, count = 0;
    double squares = 0;
    *worst = 0;
    for (int i = 0; i < 120; i++) {
        double shorter = 0.3 * pow(0.2 * smaller / 0.3, test_random(&seed)),
               aspect = pow(most_aspect, test_random(&seed));
        double angle = M_PI * test_random(&seed), longer = shorter * aspect, cov[3], uvcov[3];
        if (longer > 0.2 * smaller)
            longer = 0.2 * smaller;
        test_turned_covariance(cov, longer, shorter, angle);
        uvcov[0] = cov[0] / width / width;
        uvcov[1] = cov[1] / width / height;
        uvcov[2] = cov[2] / height / height;
        for (int axis = 0; axis < 2; axis++) {
            double sd = axis ? shorter : longer, along = angle + axis * M_PI / 2,
                   wanted = sqrt(0.4 / (2 * M_PI * M_PI)) / sd;
            wanted = wanted > 0.3 ? 0.3 : wanted;
            double f[2] = {rint(wanted * cos(along) * width) / width, rint(wanted * sin(along) * height) / height};
            double variance = quadratic(cov, f[0], f[1]), squared = f[0] * f[0] + f[1] * f[1];
            /* whole waves only: where none points along the axis, this footprint says nothing about it */
            if (squared == 0 || (axis && variance / squared > 1.5 * sd * sd) || 2 * M_PI * M_PI * variance > 1.5)
                continue;
            RetexImage im = {0};
            make_wave(&im, width, height, f);
            RetexTexture *t = make_texture(&im, RETEX_WRAP_REPEAT, RETEX_WRAP_REPEAT);
            for (int k = 0; k < 8; k++, count++) {
                double u = test_random(&seed), v = test_random(&seed);
                float p[4];
                filter_gaussian(t, u, v, uvcov, p);
                double complex got = (2 * (double)p[0] - 1) + I * (2 * (double)p[1] - 1);
                double complex want = filtered_wave(f, cov, u * width, (v - 1) * height);
                double e = -log(cabs(got) / cabs(want)) / (2 * M_PI * M_PI) / variance;
                squares += e * e;
                *worst = fabs(e) > *worst ? fabs(e) : *worst;
            }
            retex_texture_close(&t);
            retex_image_free(&im);
        }
    }
    *rms = sqrt(squares / count);
}

static void test_variance(void **state)
{
    (void)state;
    static const struct {
        int width, height;
        double aspect;
    } cases[] = {
        {256, 256, 1}, {256, 256, 8}, {301, 203, 4}, {500, 255, 8}, {128, 512, 2},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double worst, rms;
        measure_variance(cases[i].width, cases[i].height, cases[i].aspect, &worst, &rms);
        print_message("%d x %d, footprints up to %g : 1: variance off by %.1f%% rms, %.1f%% at worst\n", cases[i].width,
                      cases[i].height, cases[i].aspect, 100 * rms, 100 * worst);
        assert_true(rms < 0.015);
        assert_true(worst < 0.06); /* of a wave; texture_footprints measures the variance itself */
    }
}

static void test_alpha(void **state)
{
    (void)state;
    /* Left half: opaque red; right half: invisible green, which must not show. */
    RetexImage im = {0};
    RetexError err = {0};
    test_must(retex_image_alloc(&im, 16, 16, 4, &err), &err);
    for (int i = 0; i < 256; i++)
        memcpy(im.pixels + 4 * i, i % 16 < 8 ? (float[4]){1, 0, 0, 1} : (float[4]){0, 1, 0, 0}, 16);
    RetexTexture *t = make_texture(&im, RETEX_WRAP_REPEAT, RETEX_WRAP_REPEAT);
    float p[4];
    filter_gaussian(t, 0.4, 0.5, (double[3]){1, 0, 1}, p);
    assert_float_equal(p[0], 1, 1e-5);
    assert_float_equal(p[1], 0, 0);
    assert_float_equal(p[3], 0.5, 1e-3);
    retex_texture_close(&t);
    /* Half of a footprint on the border of a black texture lies outside. */
    for (int i = 0; i < 256; i++)
        im.pixels[4 * i + 3] = 1;
    t = make_texture(&im, RETEX_WRAP_BLACK, RETEX_WRAP_BLACK);
    for (double sd = 0.01; sd < 0.2; sd *= 2) {
        filter_gaussian(t, 0, 0.5, (double[3]){sd * sd, 0, 1e-4}, p);
        assert_float_equal(p[3], 0.5, 0.01);
        assert_float_equal(p[0], 1, 1e-2);
    }
    filter_gaussian(t, 40, 0.5, (double[3]){1, 0, 1}, p);
    assert_float_equal(p[3], 0, 0);
    retex_texture_close(&t);
    retex_image_free(&im);
}

static void test_bad_values(void **state)
{
    (void)state;
    RetexImage im = {0};
    test_random_image(&im, 20, 20, 3, 9, 0, 1);
    im.pixels[30] = NAN;
    im.pixels[100] = INFINITY;
    RetexTexture *t = make_texture(&im, RETEX_WRAP_REPEAT, RETEX_WRAP_REPEAT);
    const double bad[][3] = {{NAN, 0, 1},   {-1, 0, -1}, {1e-4, 5, 1e-4}, {INFINITY, 0, 1},
                             {1e300, 0, 0}, {0, 1, 0},   {1e-300, 0, 0}};
    const double places[] = {0.3, NAN, INFINITY, 1e18, -1e300};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        for (size_t j = 0; j < sizeof places / sizeof places[0]; j++) {
            float p[4];
            filter_gaussian(t, places[j], 0.5, bad[i], p);
            for (int k = 0; k < 4; k++)
                assert_true(isfinite(p[k]) && p[k] >= 0 && p[k] <= 1);
        }
    retex_texture_close(&t);
    retex_image_free(&im);

    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexError err = {0};
    strcpy(spec.image, "/nonexistent/oak.png");
    assert_int_equal(retex_texture_load(&t, &spec, 1, &err), RETEX_EIO);
    assert_null(t);
    assert_non_null(strstr(err.file[0] ? err.file : err.message, "oak.png"));
    spec.constant = 1;
    spec.color[1] = 0.5f;
    test_must(retex_texture_load(&t, &spec, 1, &err), &err);
    float p[4];
    filter_gaussian(t, 9, 9, (double[3]){1, 0, 1}, p);
    assert_memory_equal(p, ((float[4]){0, 0.5f, 0, 1}), sizeof p);
    retex_texture_close(&t);
    retex_texture_close(&t);
    retex_texture_close(NULL);
}

static void test_speed(void **state)
{
    (void)state;
    RetexTexture *t = random_texture(1024, 1024, 3, 1, RETEX_WRAP_REPEAT, RETEX_WRAP_REPEAT);
    static const struct {
        double longer, shorter, angle;
    } cases[] = {{0.4, 0.4, 0}, {1.5, 1, 0}, {3, 1, 0.5}, {30, 30, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double cov[3], seconds;
        float p[4], sum = 0;
        test_turned_covariance(cov, cases[i].longer / 1024, cases[i].shorter / 1024, cases[i].angle);
        clock_t began = clock();
        for (int k = 0; k < 200000; k++) {
            filter_gaussian(t, (k % 640) / 640.0, (k / 640) / 480.0, cov, p);
            sum += p[0];
        }
        seconds = (double)(clock() - began) / CLOCKS_PER_SEC;
        print_message("footprint of %g x %g texels: %.1f M look-ups a second (mean %.2f)\n", cases[i].longer,
                      cases[i].shorter, 0.2 / seconds, (double)sum / 200000);
    }
    retex_texture_close(&t);
}

/* A texture lets the original show through where it has alpha, or where it ends: on either axis. */
static void test_opaque(void **state)
{
    (void)state;
    RetexImage im = {0};
    RetexError err = {0};
    test_must(retex_image_alloc(&im, 4, 4, 4, &err), &err);
    for (int k = 0; k < 64; k++)
        im.pixels[k] = 1;
    for (int clear = 0; clear < 2; clear++)
        for (int u = 0; u < 4; u++)
            for (int v = 0; v < 4; v++) {
                RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
                RetexTexture *texture;
                im.pixels[63] = clear ? 0.5f : 1;
                spec.wrap[0] = (RetexWrap)u, spec.wrap[1] = (RetexWrap)v;
                test_must(retex_texture_create(&texture, &im, &spec, 1, &err), &err);
                assert_int_equal(retex_texture_is_opaque(texture),
                                 !clear && u != RETEX_WRAP_BLACK && v != RETEX_WRAP_BLACK);
                retex_texture_close(&texture);
            }
    retex_image_free(&im);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_channels),   cmocka_unit_test(test_blur_of_levels), cmocka_unit_test(test_tiles_alike),
        cmocka_unit_test(test_integers),   cmocka_unit_test(test_surface),        cmocka_unit_test(test_point),
        cmocka_unit_test(test_transform),  cmocka_unit_test(test_limits),         cmocka_unit_test(test_integral),
        cmocka_unit_test(test_variance),   cmocka_unit_test(test_alpha),          cmocka_unit_test(test_opaque),
        cmocka_unit_test(test_bad_values), cmocka_unit_test(test_speed),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
